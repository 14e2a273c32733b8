#include <fstream>
#include <thread>

#include <fcntl.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/files_together.h"
#include "support.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

TEST(WriteWhole, replacesTheFile) {
    const TemporaryFolder folder;
    putFile(folder / "a.txt", "old");
    writeFile(folder / "a.txt", "new");
    EXPECT_EQ(readFile(folder / "a.txt"), "new");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WriteWhole, givesATemporaryFileThatHasNoNameInTheFolder) {
    const TemporaryFolder folder;
    writeWhole(folder / "a.exr", [&](const std::string& temporary) {
        EXPECT_EQ(fs::file_size(temporary), 0u);
        EXPECT_EQ(folder.fileCount(), 0u);
        putFile(temporary, "new");
    });
    EXPECT_EQ(readFile(folder / "a.exr"), "new");
    EXPECT_EQ(folder.fileCount(), 1u);
}

// Where the system does not show open files by name, the file needs one of its own. (A folder is mounted over those
// names for a process of its own.)
TEST(WriteWholeDeathTest, givesANamedTemporaryFileWhereThereAreNoOthers) {
    const TemporaryFolder folder;
    const auto write = [&] {
        if (unshare(CLONE_NEWNS) != 0 || mount("", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            mount("tmpfs", "/proc", "tmpfs", 0, nullptr) != 0)
            _exit(77);
        std::size_t during = 0;
        writeWhole(folder / "a.exr", [&](const std::string& temporary) {
            during = folder.fileCount();
            putFile(temporary, "new");
        });
        _exit(during == 1 && readFile(folder / "a.exr") == "new" && folder.fileCount() == 1 ? 0 : 1);
    };
    const pid_t child = fork();
    if (child == 0) write();
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << "needs the right to mount";
    EXPECT_EQ(status, 0);
}

TEST(WriteWhole, leavesEverythingAsItWasWhenTheCallThrows) {
    const TemporaryFolder folder;
    putFile(folder / "a.txt", "old");
    const auto write = [&] {
        writeWhole(folder / "a.txt", [](const std::string& temporary) {
            putFile(temporary, "half of the n");
            fail(Failure::device, "device lost");
        });
    };
    expectFailure(Failure::device, {"device lost"}, write);
    EXPECT_EQ(readFile(folder / "a.txt"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(FilesTogether, appearWhenAllOfThemAreThere) {
    const TemporaryFolder folder;
    putFile(folder / "a.txt", "old");
    {
        FilesTogether files;
        writeFile(folder / "a.txt", "new");
        writeFile(folder / "b.txt", "new");
        EXPECT_EQ(readFile(folder / "a.txt"), "old");
        EXPECT_EQ(folder.fileCount(), 1u);
        files.takePlaces();
        EXPECT_EQ(readFile(folder / "a.txt"), "new");
        EXPECT_EQ(readFile(folder / "b.txt"), "new");
    }
    writeFile(folder / "b.txt", "at once");
    EXPECT_EQ(readFile(folder / "b.txt"), "at once");
}

// The last of many does not go: those before it have not taken their places either.
TEST(FilesTogether, leaveEverythingAsItWasWhereOneFails) {
    const TemporaryFolder folder;
    constexpr int kCount = 300; // more than are kept open
    EXPECT_THROW(
        {
            const FilesTogether files;
            for (int i = 0; i < kCount; ++i) {
                putFile(folder / fmt::format("{}.txt", i), "old");
                writeFile(folder / fmt::format("{}.txt", i), "new");
            }
            writeFile(folder / "missing/x.txt", "new");
        },
        Error);
    EXPECT_EQ(folder.fileCount(), std::size_t(kCount));
    for (int i = 0; i < kCount; ++i) EXPECT_EQ(readFile(folder / fmt::format("{}.txt", i)), "old") << i;
}

TEST(WriteWhole, refusesFoldersThatCannotBeWritten) {
    const TemporaryFolder folder;
    putFile(folder / "file", "");
    for (const std::string& path : {folder / "none/a.txt", folder / "file/a.txt", std::string("/proc/a.txt")})
        expectFailure(Failure::file, {path}, [&] { writeFile(path, "x"); });
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WriteWhole, refusesToReplaceDevicesAndFolders) {
    const TemporaryFolder folder;
    expectFailure(Failure::file, {"/dev/full"}, [] { writeFile("/dev/full", "x"); });
    expectFailure(Failure::file, {"ordinary file"}, [&] { writeFile(folder.path.string(), "x"); });
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(WriteWhole, skipsTemporaryNamesThatAreTaken) {
    const TemporaryFolder folder;
    for (int i = 0; i < 300; ++i) putFile(folder / fmt::format(".relief-{}-{}", getpid(), i), "other");
    writeFile(folder / "a.txt", "new");
    EXPECT_EQ(readFile(folder / "a.txt"), "new");
    EXPECT_EQ(folder.fileCount(), 301u);
}

TEST(WriteWhole, refusesAnEmptyName) {
    expectFailure(Failure::usage, {"no name"}, [] { writeFile("", "x"); });
}

TEST(WriteWhole, writesThroughLinks) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "real");
    putFile(folder / "real/a.txt", "old");
    fs::create_symlink(folder / "real/a.txt", folder / "link.txt");
    writeFile(folder / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(readFile(folder / "real/a.txt"), "new");
}

TEST(WriteWhole, makesWhatALinkPointsTo) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "real");
    fs::create_symlink("real/second", folder / "first");
    fs::create_symlink("a.txt", folder / "real/second");
    writeFile(folder / "first", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "first"));
    EXPECT_TRUE(fs::is_symlink(folder / "real/second"));
    EXPECT_EQ(readFile(folder / "real/a.txt"), "new");
}

TEST(WriteWhole, refusesLinksThatLeadNowhere) {
    const TemporaryFolder folder;
    fs::create_symlink("b", folder / "a");
    fs::create_symlink("a", folder / "b");
    fs::create_symlink("none/c", folder / "c");
    expectFailure(Failure::file, {folder / "a", "symbolic links"}, [&] { writeFile(folder / "a", "x"); });
    expectFailure(Failure::file, {folder / "none/c"}, [&] { writeFile(folder / "c", "x"); });
    for (const char* link : {"a", "b", "c"}) EXPECT_TRUE(fs::is_symlink(folder / link)) << link;
    EXPECT_EQ(folder.fileCount(), 3u);
}

TEST(WriteWhole, keepsTheFilesPermissions) {
    const TemporaryFolder folder;
    putFile(folder / "a.txt", "old");
    fs::permissions(folder / "a.txt", fs::perms(0640));
    writeFile(folder / "a.txt", "new");
    EXPECT_EQ(fs::status(folder / "a.txt").permissions(), fs::perms(0640));
}

TEST(WriteWhole, refusesNamesThatAreTooLongAtOnce) {
    const TemporaryFolder folder;
    bool isReached = false;
    expectFailure(Failure::file, {"too long"},
                  [&] { writeWhole(folder / std::string(300, 'n'), [&](const std::string&) { isReached = true; }); });
    EXPECT_FALSE(isReached);
}

TEST(WriteWhole, saysThatTheDiskIsFull) {
    const TemporaryFolder folder;
    if (mount("tmpfs", folder.path.c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "needs the right to mount";
    expectFailure(Failure::file, {folder / "a", "No space left"},
                  [&] { writeFile(folder / "a", std::string(100'000, 'x')); });
    EXPECT_EQ(folder.fileCount(), 0u);
    umount(folder.path.c_str());
}

TEST(WriteWhole, takesTheLongestNames) {
    const TemporaryFolder folder;
    const std::string path = folder / (std::string(251, 'n') + ".png");
    writeFile(path, "x");
    EXPECT_EQ(readFile(path), "x");
}

TEST(CheckWritable, saysWhatWritingWouldSayAndLeavesNothing) {
    const TemporaryFolder folder;
    putFile(folder / "file", "old");
    for (const std::string& path : {folder / "none/a.txt", folder / "file/a.txt", std::string("/proc/a.txt")})
        expectFailure(Failure::file, {path}, [&] { checkWritable(path); });
    expectFailure(Failure::file, {"ordinary file"}, [&] { checkWritable(folder.path.string()); });
    expectFailure(Failure::usage, {"no name"}, [] { checkWritable(""); });
    EXPECT_NO_THROW(checkWritable(folder / "new"));
    EXPECT_NO_THROW(checkWritable(folder / "file"));
    EXPECT_EQ(readFile(folder / "file"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(ReadFile, givesAllBytes) {
    const TemporaryFolder folder;
    const std::string bytes("a\0b\r\n\xff", 6);
    putFile(folder / "a", bytes);
    EXPECT_EQ(readFile(folder / "a"), bytes);
    putFile(folder / "empty", "");
    EXPECT_EQ(readFile(folder / "empty"), "");
}

TEST(ReadFile, namesAMissingFile) {
    expectFailure(Failure::file, {"/nowhere/cage.obj", "No such file"}, [] { readFile("/nowhere/cage.obj"); });
}

TEST(ReadFile, refusesAFolder) {
    const TemporaryFolder folder;
    expectFailure(Failure::file, {folder.path.string(), "directory"}, [&] { readFile(folder.path.string()); });
}

TEST(ReadFile, refusesMoreThanTheLimit) {
    const TemporaryFolder folder;
    putFile(folder / "a", std::string(100, 'x'));
    EXPECT_EQ(readFile(folder / "a", 100).size(), 100u);
    expectFailure(Failure::input, {folder / "a", "99 B"}, [&] { readFile(folder / "a", 99); });
}

/// A socket that has a name.
struct NamedSocket {
    int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);

    explicit NamedSocket(const std::string& path) {
        sockaddr_un name{.sun_family = AF_UNIX, .sun_path = {}};
        path.copy(name.sun_path, sizeof(name.sun_path) - 1);
        EXPECT_EQ(bind(socket, reinterpret_cast<const sockaddr*>(&name), sizeof(name)), 0);
    }
    NamedSocket(const NamedSocket&) = delete;
    NamedSocket& operator=(const NamedSocket&) = delete;
    ~NamedSocket() { close(socket); }
};

TEST(ReadFile, refusesAtOnceWhatIsNoFile) {
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    const NamedSocket socket(folder / "socket");
    fs::create_symlink("/dev/zero", folder / "zero");
    for (const auto& [name, kind] : {std::pair("pipe", "pipe"), {"socket", "socket"}, {"zero", "device"}}) {
        expectFailure(Failure::file, {folder / name, kind, "regular files"}, [&] { readFile(folder / name); });
        expectFailure(Failure::file, {folder / name, kind}, [&] { readImageInfo(folder / name); });
    }
}

TEST(ReadFile, doesNotOpenPipesThatAWriterWaitsFor) {
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    const pid_t writer = fork();
    if (writer == 0) _exit(open((folder / "pipe").c_str(), O_WRONLY) >= 0 ? 0 : 1); // waits for a reader
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    expectFailure(Failure::file, {"pipe"}, [&] { readFile(folder / "pipe"); });
    EXPECT_EQ(waitpid(writer, nullptr, WNOHANG), 0) << "somebody was there to read";
    kill(writer, SIGKILL);
    waitpid(writer, nullptr, 0);
}

TEST(ReadFile, readsFilesThatHaveNoSize) { EXPECT_TRUE(readFile("/proc/self/status").starts_with("Name:")); }

TEST(InputFile, readsPartsUpToTheEnd) {
    const TemporaryFolder folder;
    putFile(folder / "a", "0123456789");
    const InputFile file(folder / "a");
    std::string part(4, ' ');
    EXPECT_EQ(file.size(), 10u);
    EXPECT_EQ(file.read(3, part.data(), 4), 4u);
    EXPECT_EQ(part, "3456");
    EXPECT_EQ(file.read(8, part.data(), 4), 2u);
    EXPECT_EQ(file.read(10, part.data(), 4), 0u);
}

} // namespace
} // namespace relief::test
