#include <filesystem>
#include <future>
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/clip.h"
#include "app/commands.h"
#include "app/frame_maker.h"
#include "app/frames.h"
#include "app/object_options.h"
#include "app/output.h"
#include "base/clock.h"

namespace relief::app {
namespace {

struct AnimateArgs {
    AnimationArgs animation;
    Output output;
    std::string target;
    bool resumes = false;

    [[nodiscard]] const ObjectDesc& object() const { return animation.scene.object; }
};

bool isCachePath(const std::string& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".pc2" || extension == ".mdd";
}

void checkTarget(const AnimateArgs& args) {
    const std::vector<std::string> inputs = listFiles(args.animation.scene);
    const bool isOneFile = isClipPath(args.target) || isCachePath(args.target);
    if (isOneFile && args.resumes)
        fail(Failure::usage, "{}: --resume continues pictures, one per frame: -o 'frame.{{frame:4}}.png'", args.target);
    if (isOneFile && !args.animation.picture.layers.empty())
        fail(Failure::usage, "{}: layers are written to pictures, one per frame: -o 'frame.{{frame:4}}.exr'",
             args.target);
    if (!isOneFile && !isPicturePath(args.target))
        fail(Failure::usage,
             "{}: an animation is written as pictures ('frame.{{frame:4}}.png', .exr), a clip (.mp4 .webm .gif .webp) "
             "or a point cache (.pc2 .mdd)",
             args.target);
    if (!isOneFile) checkPicturePath(args.target, args.animation.picture);
    checkOutput(isOneFile ? args.target : frameName(args.target, 0), inputs);
}

/// What is reported at the end.
struct Report {
    nlohmann::json frames = nlohmann::json::array();
    std::uint64_t uploadedBytes = 0; ///< of the last frame
    std::string device;
    double seconds = 0;
    std::size_t skippedCount = 0;
    bool hasComplained = false; ///< a frame in which there is nothing to see is warned of once

    void add(const DrawnFrame& drawn) {
        const FrameStats& stats = drawn.picture.stats;
        uploadedBytes = drawn.uploadedBytes;
        frames.push_back({{"frame", drawn.frame},
                          {"triangles", stats.triangleCount},
                          {"uploaded_bytes", drawn.uploadedBytes},
                          {"pose_ms", drawn.poseMs},
                          {"rate_ms", stats.rateMs},
                          {"frame_ms", stats.wallMs}});
    }
};

/// Where frames are written and warnings are reported.
struct Sink {
    const Warn& warn;
    std::function<void(const DrawnFrame&)> write;
};

/// Draws the frames one after another while the frame before is being written: `write` is called on another thread, for
/// one frame at a time, in order.
void drawAll(FrameMaker& maker, std::span<const int> frames, const AnimateArgs& args, Report& report,
             const Sink& sink) {
    Progress progress("animating", frames.size(), args.output.progress, "frames");
    std::future<void> writing;
    for (const int frame : frames) {
        auto drawn = std::make_shared<DrawnFrame>(maker.draw(frame));
        checkValidation(maker.device());
        // Errors of the writer end the loop here, a frame late.
        if (writing.valid()) writing.get();
        report.add(*drawn);
        const std::string complaint = report.hasComplained ? "" : maker.findComplaint(*drawn);
        if (!complaint.empty()) sink.warn(fmt::format("{}: frame {}: {}", args.object().cage, frame, complaint));
        report.hasComplained = report.hasComplained || !complaint.empty();
        writing = std::async([drawn, &sink] { sink.write(*drawn); });
        progress.advance();
    }
    if (writing.valid()) writing.get();
}

void writeClip(FrameMaker& maker, const AnimateArgs& args, Report& report, const Warn& warn) {
    writeWhole(args.target, [&](const std::string& temporary) {
        ClipWriter clip({.path = args.target,
                         .temporary = temporary,
                         .width = args.animation.scene.size.x,
                         .height = args.animation.scene.size.y,
                         .fps = args.object().motion.cache.fps});
        Finish finish = args.animation.picture.finish;
        if (finish.background == Background::transparent) finish.background = Background::studio; // clips have no alpha
        drawAll(maker, maker.frames(), args, report,
                {warn, [&](const DrawnFrame& drawn) { clip.write(displayed(drawn.picture, finish)); }});
        clip.finish();
    });
}

void writePictures(FrameMaker& maker, const AnimateArgs& args, Report& report, const Warn& warn) {
    std::vector<int> frames = maker.frames();
    if (args.resumes) // pictures are written whole or not at all, so those that exist are finished
        report.skippedCount =
            std::erase_if(frames, [&](int frame) { return std::filesystem::exists(frameName(args.target, frame)); });
    const std::vector<std::string> inputs = listFiles(args.animation.scene);
    for (const int frame : frames) checkOutput(frameName(args.target, frame), inputs);
    const auto write = [&](const DrawnFrame& drawn) {
        writePicture(frameName(args.target, drawn.frame), drawn.picture, args.animation.picture.finish);
    };
    drawAll(maker, frames, args, report, {warn, write});
}

/// Writes the posed cage itself, for which no device is needed.
void writeCache(const AnimateArgs& args, Report& report, const Warn& warn) {
    const MotionDesc& motion = args.object().motion;
    if (lowerExtension(args.object().cage) == ".exr")
        fail(
            Failure::usage,
            "{}: a point cache holds the vertices of a cage file, which a geometry image is not; relief export makes a "
            "mesh of it",
            args.object().cage);
    const Cage cage = readCage(args.object().cage, warn);
    const std::unique_ptr<Animation> animation = loadAnimation(motion, cage, warn);
    if (!animation)
        fail(Failure::usage, "{}: a point cache holds a cage that moves; name --cache, --skin or --deform",
             args.object().cage);

    // A cache has frames in a row and no numbers of them.
    const std::vector<int> frames = listFrames(args.animation, animation.get());
    for (std::size_t i = 0; i < frames.size(); ++i)
        if (frames[i] != frames[0] + int(i))
            fail(Failure::usage, "{}: a point cache has every frame of a range; --frames {} skips some", args.target,
                 args.animation.frames);

    // Caches hold floats in world coordinates: far from the origin they are coarse, which is said.
    warnOfCoarseFloats(args.target, cage, animation->coordinates().origin, warn);
    const CacheHeader header{std::uint32_t(cage.positions.size()), std::uint32_t(frames.size()), double(frames[0]),
                             motion.cache.fps};
    writePointCache(args.target, header, [&](std::uint32_t k) {
        report.frames.push_back({{"frame", frames[k]}});
        std::vector<vec3> positions = posedPositions(animation->rig(), animation->pose(toSeconds(frames[k], motion)));
        for (vec3& p : positions) p = animation->coordinates().toWorld(p);
        return positions;
    });
}

void print(const AnimateArgs& args, const Report& report) {
    const std::size_t count = report.frames.size();
    if (args.output.isJson) {
        printJson({{"output", args.target},
                   {"device", report.device},
                   {"seconds", report.seconds},
                   {"skipped_frames", report.skippedCount},
                   {"frames", report.frames}});
    } else if (!args.output.isQuiet) {
        std::cerr << fmt::format(
            "{}: {} frames{} in {:.1f} s", args.target, count,
            report.skippedCount > 0 ? fmt::format(" ({} existed already)", report.skippedCount) : "", report.seconds);
        if (report.uploadedBytes > 0)
            std::cerr << fmt::format(", {} uploaded per frame", humanBytes(report.uploadedBytes));
        std::cerr << (report.device.empty() ? "\n" : fmt::format(", on {}\n", report.device));
    }
}

int animate(const AnimateArgs& args) {
    checkTarget(args);
    if (!args.animation.frames.empty()) parseFrames(args.animation.frames); // mistakes in it come before those in files
    if (isClipPath(args.target)) checkClipWriter();
    const double start = secondsNow();
    const Warn warn = makeWarn(args.output.isQuiet);
    Report report;
    if (isCachePath(args.target)) {
        writeCache(args, report, warn);
    } else {
        FrameMaker maker(args.animation, warn);
        report.device = maker.device().traits().name;
        if (isClipPath(args.target))
            writeClip(maker, args, report, warn);
        else
            writePictures(maker, args, report, warn);
    }
    report.seconds = secondsNow() - start;
    print(args, report);
    return 0;
}

} // namespace

Run addAnimate(CLI::App& app) {
    auto args = std::make_shared<AnimateArgs>();
    AnimationArgs& animation = args->animation;
    // Which frames of what.
    addObject(app, animation.scene.object);
    app.add_option("-o,--output", args->target,
                   "pictures 'frame.{frame:4}.png' or .exr, numbered with at least 4 digits; a clip .mp4 .webm .gif "
                   ".webp (by ffmpeg); or a point cache .pc2 .mdd of the cage that moves")
        ->required()
        ->option_text("FRAMES");
    app.add_option(
           "--frames", animation.frames,
           "frames to draw: first:last, first:lastxstep, or several of these with commas between them (default: "
           "from the first key to the last)")
        ->option_text("A:BxS")
        ->group("pose");
    app.add_option("--turntable", animation.turntableCount,
                   "the camera turns around the object once in N frames, and the default light with it")
        ->check(CLI::Range(1, 1'000'000))
        ->option_text("N")
        ->group("camera");
    app.add_flag("--resume", args->resumes, "skip frames whose pictures exist")->group("output");
    // What each frame shows.
    addPicture(app, animation.scene, animation.picture);
    addOutput(app, args->output);
    app.footer("Frame k is the pose at k / fps seconds, the same bits whichever frames are drawn with it.\n"
               "deformers:\n" +
               deformerHelp() +
               "examples:\n"
               "  relief animate cage.obj --height map.exr --cache walk.mdd --frames 1:48 -o 'walk.{frame:4}.png'\n"
               "  relief animate cage.obj --skin walk.glb --fps 30 -o walk.mp4\n"
               "  relief animate cage.obj --deform \"twist(axis=y, angle=60*sin(pi*t))\" --frames 0:47 -o twist.webp\n"
               "  relief animate cage.obj --height-function waves --frames 0:47 -o waves.mp4\n"
               "  relief animate cage.obj --height map.exr --turntable 72 -o turn.gif");
    return [args] { return animate(*args); };
}

} // namespace relief::app
