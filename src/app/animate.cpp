#include <filesystem>
#include <future>
#include <iostream>

#include <malloc.h>

#include <nlohmann/json.hpp>

#include "app/clip.h"
#include "app/commands.h"
#include "app/empty.h"
#include "app/frames.h"
#include "app/output.h"
#include "app/weld.h"

namespace relief::app {
namespace {

struct AnimateArgs {
    SurfaceArgs surface;
    PictureArgs picture;
    Output output;
    std::string target, frames;
    int turntable = 0; ///< pictures of one turn; 0: the camera stands still
    bool resumes = false;
};

bool isCachePath(const std::string& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".pc2" || extension == ".mdd";
}

void checkTarget(const AnimateArgs& args) {
    const std::vector<std::string> inputs = inputsOf(args.surface, args.picture);
    if (isClipPath(args.target) || isCachePath(args.target)) {
        if (args.resumes)
            fail(Failure::usage, "{}: --resume goes on with pictures, one a frame: -o 'frame.{{frame:4}}.png'",
                 args.target);
        if (!args.picture.layers.empty())
            fail(Failure::usage, "{}: layers go into pictures, one a frame: -o 'frame.{{frame:4}}.exr'", args.target);
        checkOutput(args.target, inputs);
        return;
    }
    if (!args.target.ends_with(".png") && !args.target.ends_with(".exr"))
        fail(Failure::usage,
             "{}: an animation is written as pictures ('frame.{{frame:4}}.png', .exr), a clip (.mp4 .webm .gif .webp) "
             "or a point cache (.pc2 .mdd)",
             args.target);
    checkPicturePath(args.target, args.picture);
    checkOutput(frameName(args.target, 0), inputs);
}

// --- what moves ----------------------------------------------------------------------------------------------------

constexpr double kLargestFrame = 1e9;

const std::string& movedBy(const AnimateArgs& args) {
    const PoseArgs& pose = args.surface.pose;
    return !pose.cache.empty() ? pose.cache : !pose.skin.empty() ? pose.skin : args.surface.cage;
}

/// Frames that are asked for, or all that there are.
std::vector<int> framesOf(const AnimateArgs& args, const Animation* animation) {
    if (!args.frames.empty()) return parseFrames(args.frames);
    dvec2 range(1, args.turntable);
    if (args.turntable == 0) {
        if (animation == nullptr)
            fail(Failure::usage, "{}: nothing moves; name --cache, --skin, --deform or --turntable", args.surface.cage);
        range = animation->keyRange() * args.surface.pose.fps;
        if (!(std::max(std::abs(range.x), std::abs(range.y)) <= kLargestFrame))
            fail(Failure::input, "{}: its keys are from {} to {} seconds; name the --frames{}", movedBy(args),
                 animation->keyRange().x, animation->keyRange().y,
                 args.surface.pose.cache.empty() ? "" : ", or take its own with --cache-frames");
    }
    return parseFrames(fmt::format("{}:{}", int(std::ceil(range.x - 1e-6)), int(std::floor(range.y + 1e-6))));
}

double secondsOf(int frame, const PoseArgs& pose) { return frame / pose.fps; }

// --- frames --------------------------------------------------------------------------------------------------------

/// A finished picture and what it took.
struct DrawnFrame {
    int frame = 0;
    Picture picture;
    std::uint64_t uploadedBytes = 0;
    double poseMs = 0;
};

/// Draws any frame of the animation, the same way whatever was drawn before it.
class FrameMaker {
public:
    FrameMaker(const AnimateArgs& args, const Output& output);

    [[nodiscard]] const std::vector<int>& frames() const { return frames_; }
    [[nodiscard]] const Device& device() const { return *device_; }
    DrawnFrame draw(int frame);
    /// Why there is nothing to see; "" where there is something.
    [[nodiscard]] std::string complaintOf(const DrawnFrame& drawn) const;

private:
    [[nodiscard]] RenderOptions optionsAt(int frame) const;
    void posePolygons(int frame, DrawnFrame& drawn);
    [[nodiscard]] Pose poseAt(int frame) const { return loaded_.animation->pose(secondsOf(frame, args_.surface.pose)); }

    const AnimateArgs& args_;
    PictureArgs picture_; ///< with a camera that holds everything
    std::vector<int> frames_;
    Loaded loaded_;
    Shading shading_;
    Bounds bounds_;                          ///< of the object in all poses that the camera holds
    std::optional<MovingPolygons> polygons_; ///< instead of a surface that moves
    Bounds polygonBounds_;                   ///< in the pose that is drawn
    bool isDense_ = false;
    std::unique_ptr<Device> device_;
    std::unique_ptr<Model> model_;
    std::unique_ptr<Poser> poser_;
    std::unique_ptr<MeshPoser> meshPoser_; ///< of the polygons
    std::unique_ptr<Renderer> renderer_;
};

FrameMaker::FrameMaker(const AnimateArgs& args, const Output& output) : args_(args), picture_(args.picture) {
    SurfaceArgs surface = args.surface;
    surface.pose.staysAtRest = true;
    loaded_ = load(surface, output, picture_.albedo);
    warnOfPlainTags(loaded_, surface, output.warn());
    if (loaded_.dense && loaded_.animation) {
        if (wantsMotion(picture_))
            fail(Failure::usage, "{}: no motion is known of plain polygons; name their --scheme", surface.cage);
        polygons_.emplace(loaded_.cage, *loaded_.animation);
    }
    frames_ = framesOf(args, loaded_.animation.get());
    shading_ = loadShading(picture_, surface, loaded_.cage, output.warn());
    isDense_ = loaded_.dense.has_value();
    const std::vector<dvec3> points = outlineOfAll(loaded_);
    enter(loaded_.coordinates(), picture_.camera);
    holdCamera(picture_.camera, points, args.turntable > 0);
    for (const dvec3& p : points) bounds_.add(p);
    if (polygons_) loaded_.dense = polygons_->at(secondsOf(frames_.front(), surface.pose));

    device_ = std::make_unique<Device>(DeviceDesc{.name = picture_.device});
    model_ = std::make_unique<Model>(*device_, ModelDesc{.surface = &loaded_.surface,
                                                         .cagePositions = loaded_.cage.positions,
                                                         .height = loaded_.heightMap(),
                                                         .encoding = &loaded_.heightEncoding,
                                                         .dense = loaded_.dense ? &*loaded_.dense : nullptr,
                                                         .albedo = shading_.albedo ? &*shading_.albedo : nullptr});
    if (polygons_)
        meshPoser_ = std::make_unique<MeshPoser>(*device_, *model_, *loaded_.dense, Rig());
    else if (loaded_.animation)
        poser_ = std::make_unique<Poser>(*device_, *model_,
                                         PoserDesc{.surface = &loaded_.surface,
                                                   .rig = loaded_.animation->rig(),
                                                   .heightSpace = heightSpaceOf(picture_.heightSpace),
                                                   .restPositions = loaded_.cage.positions,
                                                   .keepsBefore = wantsMotion(picture_)});
    loaded_.surface = {}; // all of it is on the device now
    loaded_.height.reset();
    loaded_.heightEncoding = {};
    loaded_.dense.reset();
    shading_.albedo.reset();
    malloc_trim(0);
    renderer_ = std::make_unique<Renderer>(
        *device_, RendererDesc{.width = picture_.camera.size[0], .height = picture_.camera.size[1]});
}

/// A turn's light goes round with the camera, unless it was put somewhere.
RenderOptions FrameMaker::optionsAt(int frame) const {
    const auto at = [&](int number) {
        PictureArgs picture = picture_;
        if (args_.turntable > 0) picture.camera.options.azimuth += 360.0 * (number - 1) / args_.turntable;
        RenderOptions options = renderOptions(picture, *device_, {bounds_.lower, bounds_.upper});
        options.unit = loaded_.coordinates().unit;
        if (poser_) options.bounds = poser_->bounds();
        if (meshPoser_) options.bounds = polygonBounds_;
        if (poser_ || meshPoser_) fitDepth(options.camera, options.bounds);
        return options;
    };
    RenderOptions options = at(frame);
    options.cameraBefore = at(frame - 1).camera;
    if (shading_.environment) options.lighting.environment = &*shading_.environment;
    return options;
}

void FrameMaker::posePolygons(int frame, DrawnFrame& drawn) {
    const double start = secondsNow();
    const DenseMesh mesh = polygons_->at(secondsOf(frame, args_.surface.pose));
    drawn.uploadedBytes = meshPoser_->upload(mesh.positions, mesh.normals);
    drawn.poseMs = 1e3 * (secondsNow() - start);
    polygonBounds_ = {};
    for (const vec3& p : mesh.positions) polygonBounds_.add(dvec3(p));
}

DrawnFrame FrameMaker::draw(int frame) {
    DrawnFrame drawn{.frame = frame};
    if (poser_) {
        std::optional<Pose> before;
        if (wantsMotion(picture_)) before = poseAt(frame - 1);
        poser_->pose(poseAt(frame), before ? &*before : nullptr);
        drawn.uploadedBytes = poser_->stats().uploadedBytes;
        drawn.poseMs = poser_->stats().milliseconds;
    }
    if (meshPoser_) posePolygons(frame, drawn);
    drawn.picture = renderer_->render(*model_, optionsAt(frame));
    return drawn;
}

std::string FrameMaker::complaintOf(const DrawnFrame& drawn) const {
    if (!isSparse(drawn.picture)) return "";
    std::vector<dvec3> points(loaded_.cage.positions.begin(), loaded_.cage.positions.end());
    if (polygons_) {
        const DenseMesh mesh = polygons_->at(secondsOf(drawn.frame, args_.surface.pose));
        points.assign(mesh.positions.begin(), mesh.positions.end());
    } else if (!isDense_) {
        ReferenceSurface coarse(loaded_.cage, {.scheme = loaded_.options.scheme, .isolation = 2});
        if (poser_) coarse.pose(posedPositions(loaded_.animation->rig(), poseAt(drawn.frame)));
        points = outline(coarse, nullptr);
    }
    const Camera camera = optionsAt(drawn.frame).camera;
    const std::vector<int>& size = picture_.camera.size;
    return app::complaintOf(drawn.picture, {points, camera, size[0], size[1], loaded_.coordinates()});
}

/// What is told at the end.
struct Report {
    nlohmann::json frames = nlohmann::json::array();
    std::uint64_t uploadedBytes = 0; ///< of one frame
    std::string device;
    double seconds = 0;
    std::size_t skippedCount = 0;
    bool hasComplained = false; ///< of the first frame in which there is nothing to see

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

/// Draws the frames one after another while the last one is being written: `write` runs beside, one at a time, in
/// order.
void drawAll(FrameMaker& maker, std::span<const int> frames, const AnimateArgs& args, Report& report,
             const std::function<void(const DrawnFrame&)>& write) {
    Progress progress("animating", frames.size(), args.output.progress, "frames");
    std::future<void> writing;
    for (const int frame : frames) {
        auto drawn = std::make_shared<DrawnFrame>(maker.draw(frame));
        checkValidation(maker.device());
        if (writing.valid()) writing.get();
        report.add(*drawn);
        const std::string complaint = report.hasComplained ? "" : maker.complaintOf(*drawn);
        if (!complaint.empty())
            args.output.warn()(fmt::format("{}: frame {}: {}", args.surface.cage, frame, complaint));
        report.hasComplained = report.hasComplained || !complaint.empty();
        writing = std::async([drawn, &write] { write(*drawn); });
        progress.advance();
    }
    if (writing.valid()) writing.get();
}

void writeClip(FrameMaker& maker, const AnimateArgs& args, Report& report) {
    writeWhole(args.target, [&](const std::string& temporary) {
        ClipWriter clip({.path = args.target,
                         .temporary = temporary,
                         .width = args.picture.camera.size[0],
                         .height = args.picture.camera.size[1],
                         .fps = args.surface.pose.fps});
        Finish finish = finishOf(args.picture);
        if (finish.background == Background::transparent) finish.background = Background::studio; // clips have no alpha
        drawAll(maker, maker.frames(), args, report,
                [&](const DrawnFrame& drawn) { clip.write(displayed(drawn.picture, finish)); });
        clip.finish();
    });
}

void writePictures(FrameMaker& maker, const AnimateArgs& args, Report& report) {
    std::vector<int> frames = maker.frames();
    if (args.resumes) // files appear whole, so those that are there are done
        report.skippedCount =
            std::erase_if(frames, [&](int frame) { return std::filesystem::exists(frameName(args.target, frame)); });
    for (const int frame : frames) checkOutput(frameName(args.target, frame), inputsOf(args.surface, args.picture));
    const Finish finish = finishOf(args.picture);
    drawAll(maker, frames, args, report,
            [&](const DrawnFrame& drawn) { writePicture(frameName(args.target, drawn.frame), drawn.picture, finish); });
}

/// The posed cage itself: no device is needed.
void writeCache(const AnimateArgs& args, Report& report) {
    const Cage cage = readCage(args.surface.cage, args.output.warn());
    const PoseArgs& pose = args.surface.pose;
    const std::unique_ptr<Animation> animation = animationOf(pose, cage, args.output);
    if (!animation)
        fail(Failure::usage, "{}: a point cache holds a cage that moves; name --cache, --skin or --deform",
             args.surface.cage);
    const std::vector<int> frames = framesOf(args, animation.get());
    for (std::size_t i = 0; i < frames.size(); ++i)
        if (frames[i] != frames[0] + int(i))
            fail(Failure::usage, "{}: a point cache has every frame of a range; --frames {} leaves some out",
                 args.target, args.frames);
    warnOfCoarseFloats(args.target, cage, animation->coordinates().origin, args.output.warn());
    const CacheHeader header{std::uint32_t(cage.positions.size()), std::uint32_t(frames.size()), double(frames[0]),
                             pose.fps};
    writePointCache(args.target, header, [&](std::uint32_t k) {
        report.frames.push_back({{"frame", frames[k]}});
        std::vector<vec3> positions = posedPositions(animation->rig(), animation->pose(secondsOf(frames[k], pose)));
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
        std::cerr << fmt::format("{}: {} frames{} in {:.1f} s", args.target, count,
                                 report.skippedCount > 0 ? fmt::format(" ({} were there)", report.skippedCount) : "",
                                 report.seconds);
        if (report.uploadedBytes > 0)
            std::cerr << fmt::format(", {} uploaded a frame", humanBytes(report.uploadedBytes));
        std::cerr << (report.device.empty() ? "\n" : fmt::format(", on {}\n", report.device));
    }
}

int animate(const AnimateArgs& args) {
    checkTarget(args);
    if (!args.frames.empty()) parseFrames(args.frames);
    if (isClipPath(args.target)) checkClipWriter();
    const double start = secondsNow();
    Report report;
    if (isCachePath(args.target)) {
        writeCache(args, report);
    } else {
        FrameMaker maker(args, args.output);
        report.device = maker.device().traits().name;
        if (isClipPath(args.target))
            writeClip(maker, args, report);
        else
            writePictures(maker, args, report);
    }
    report.seconds = secondsNow() - start;
    print(args, report);
    return 0;
}

} // namespace

Run addAnimate(CLI::App& app) {
    auto args = std::make_shared<AnimateArgs>();
    addSurface(app, args->surface);
    app.add_option("-o,--output", args->target,
                   "'frame.{frame:4}.png' or .exr; clip .mp4 .webm .gif .webp (ffmpeg); point cache .pc2 .mdd")
        ->required()
        ->option_text("FRAMES");
    app.add_option("--frames", args->frames, "first:last, first:lastxstep, commas between several (all keys)")
        ->option_text("A:BxS")
        ->group("pose");
    app.add_option("--turntable", args->turntable, "the camera goes round once in N frames, the light with it")
        ->check(CLI::Range(1, 1'000'000))
        ->option_text("N")
        ->group("camera");
    app.add_flag("--resume", args->resumes, "leave out frames whose pictures are there")->group("output");
    addPicture(app, args->picture);
    addOutput(app, args->output);
    app.footer("Frame k is the pose at k / fps seconds, the same bits whichever frames are drawn with it.\n"
               "deformers:\n" +
               deformerHelp() +
               "examples:\n"
               "  relief animate cage.obj --height map.exr --cache walk.mdd --frames 1:48 -o 'walk.{frame:4}.png'\n"
               "  relief animate cage.obj --skin walk.glb --fps 30 -o walk.mp4\n"
               "  relief animate cage.obj --deform \"twist(axis=y, angle=60*sin(pi*t))\" --frames 0:47 -o twist.webp\n"
               "  relief animate cage.obj --height map.exr --turntable 72 -o turn.gif");
    return [args] { return animate(*args); };
}

} // namespace relief::app
