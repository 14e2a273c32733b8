#include "app/clip.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace relief::app {
namespace {

using Words = std::vector<std::string>;

constexpr int kCannotRun = 127; ///< exit code of shells for a program that cannot be started

/// Runs in the forked process, where only async-signal-safe calls are allowed: `input` becomes its stdin, and ffmpeg
/// replaces it.
[[noreturn]] void runFfmpeg(char* const* arguments, int input, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL); // it ends with this process, however that ends
    if (getppid() != parent) _exit(kCannotRun);
    setpgid(0, 0); // Ctrl-C on the terminal goes to this program alone
    sigset_t none; // an interrupt is blocked here, where a thread waits for it: not in the child
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    dup2(input, STDIN_FILENO);
    dup2(open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
    execvp(arguments[0], arguments);
    _exit(kCannotRun);
}

/// Starts ffmpeg so that it prints nothing on the terminal.
pid_t start(const Words& arguments, int input) {
    Words words{"ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "quiet", "-y", "-xerror"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const pid_t self = getpid(), process = fork();
    if (process == 0) runFfmpeg(pointers.data(), input, self);
    if (process < 0)
        fail(Failure::device, "ffmpeg, which makes clips, cannot be started: {}",
             std::generic_category().message(errno));
    return process;
}

int exitCodeOf(pid_t process) {
    int status = 0;
    waitpid(process, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The options of each format, which ffmpeg cannot see from the temporary file's name. Players expect even sides and
/// 4:2:0 in an .mp4; a .gif gets a palette of its own colors.
Words encoding(const std::string& extension) {
    if (extension == ".mp4")
        return {"-f",   "mp4",     "-vf",       "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                "-c:v", "libx264", "-pix_fmt",  "yuv420p",
                "-crf", "17",      "-movflags", "+faststart"};
    if (extension == ".webm")
        return {"-f",      "webm",       "-vf",      "pad=ceil(iw/2)*2:ceil(ih/2)*2",
                "-c:v",    "libvpx-vp9", "-pix_fmt", "yuv420p",
                "-crf",    "24",         "-b:v",     "0",
                "-row-mt", "1"};
    if (extension == ".webp") return {"-f", "webp", "-c:v", "libwebp_anim", "-quality", "80", "-loop", "0"};
    return {"-f",    "gif",
            "-vf",   "split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=bayer:bayer_scale=4",
            "-loop", "0"};
}

} // namespace

bool isClipPath(const std::string& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".mp4" || extension == ".webm" || extension == ".gif" || extension == ".webp";
}

void checkClipWriter() {
    const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    const int code = exitCodeOf(start({"-version"}, nothing));
    close(nothing);
    if (code == kCannotRun)
        fail(Failure::file, "clips are made by ffmpeg, which is not installed (on Debian: apt-get install ffmpeg); "
                            "write frames instead: -o 'frame.{{frame:4}}.png'");
    if (code != 0) fail(Failure::file, "ffmpeg, which makes clips, cannot be run: it ends with {}", code);
}

ClipWriter::ClipWriter(const ClipDesc& desc) : desc_(desc) {
    std::signal(SIGPIPE, SIG_IGN); // write() reports an ffmpeg that ends early
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) fail(Failure::file, "{}: no pipe to ffmpeg can be made", desc_.path);
    pipe_ = ends[1];
    Words words{"-f",       "rawvideo",
                "-pix_fmt", "rgb24",
                "-s",       fmt::format("{}x{}", desc.width, desc.height),
                "-r",       fmt::format("{}", desc.fps),
                "-i",       "-"};
    for (const std::string& word : encoding(lowerExtension(desc.path))) words.push_back(word);
    words.push_back("file:" + desc.temporary);
    process_ = start(words, ends[0]);
    close(ends[0]);
}

ClipWriter::~ClipWriter() {
    if (pipe_ >= 0) close(pipe_);
    if (process_ < 0) return;
    kill(process_, SIGKILL);
    exitCodeOf(process_);
}

void ClipWriter::write(const Image& frame) {
    std::vector<std::uint8_t> bytes(frame.texels.size());
    std::ranges::transform(frame.texels, bytes.begin(),
                           [](float x) { return std::uint8_t(std::lround(255 * std::clamp(x, 0.0f, 1.0f))); });
    for (std::size_t done = 0; done < bytes.size();) {
        const ssize_t count = ::write(pipe_, &bytes[done], bytes.size() - done);
        if (count < 0) finish(); // says why
        if (count < 0) fail(Failure::file, "{}: ffmpeg stopped reading", desc_.path);
        done += std::size_t(count);
    }
}

void ClipWriter::finish() {
    close(std::exchange(pipe_, -1));
    const int code = exitCodeOf(std::exchange(process_, -1));
    if (code != 0)
        fail(Failure::file,
             "{}: cannot be written: ffmpeg ends with {} (disk full, or a codec that it was built without)", desc_.path,
             code);
}

} // namespace relief::app
