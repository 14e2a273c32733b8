#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/frame_maker.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/output.h"
#include "view/view.h"

namespace relief::app {
namespace {

/// Sizes of a window where none is asked for.
constexpr ivec2 kWindowSize{1280, 720};

struct ViewArgs {
    AnimationArgs animation;
    Output output;
    std::string screenshot, record, play;
    std::optional<int> quitAfter;
    bool playsAtOnce = false;
};

/// Options of the window alone: no other verb has them.
constexpr const char* kOwnOptions[] = {"--screenshot", "--record", "--play",    "--quit-after", "--run",
                                       "--json",       "--quiet",  "--verbose", "--progress",   "--help"};

/// The options as they were given, for the command line of a picture.
std::vector<GivenOption> listGiven(const CLI::App& app) {
    std::vector<GivenOption> given;
    for (const CLI::Option* option : app.get_options()) {
        if (option->count() == 0) continue;
        const std::string name = option->get_positional() ? "" : "--" + option->get_lnames().front();
        if (std::ranges::find(kOwnOptions, name) != std::end(kOwnOptions)) continue;
        const bool isFlag = option->get_expected_max() == 0;
        if (option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll && option->get_delimiter() == 0)
            for (const std::string& value : option->results()) given.push_back({name, value}); // as --light
        else
            given.push_back({name, isFlag ? "" : fmt::format("{}", fmt::join(option->results(), ","))});
    }
    return given;
}

/// The names of all options of `relief check`.
std::vector<std::string> listCheckOptions(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_parent()->get_subcommand("check")->get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

Look toLook(const AnimationArgs& args) {
    const PictureArgs& picture = args.picture;
    return {.scene = args.scene,
            .path = picture.triangles.path,
            .triangles = picture.triangles.options,
            .show = picture.show,
            .raster = picture.raster,
            .filter = picture.filter,
            .finish = picture.finish};
}

/// What the window changes, in place of what the command line asked for.
PictureArgs toPictureArgs(const Look& look, const PictureArgs& asked) {
    PictureArgs picture = asked;
    picture.triangles = {look.path, look.triangles};
    picture.show = look.show;
    picture.raster = look.raster;
    picture.filter = look.filter;
    picture.finish = look.finish;
    return picture;
}

void print(const ViewArgs& args, const ViewReport& report) {
    if (args.output.isJson)
        printJson({{"device", report.device},
                   {"frames", report.frameCount},
                   {"pictures", report.pictureCount},
                   {"coarse", report.coarseCount},
                   {"reloads", report.reloadCount},
                   {"device_bytes", report.deviceBytes}});
}

int view(const ViewArgs& args, const CLI::App& app) {
    const AnimationArgs& animation = args.animation;
    const std::vector<std::string> inputs = listFiles(animation.scene);
    if (!args.screenshot.empty()) {
        checkPicturePath(args.screenshot, animation.picture);
        checkOutput(args.screenshot, inputs);
    }
    if (!args.record.empty()) checkOutput(args.record, inputs);
    if (!animation.picture.layers.empty()) fail(Failure::usage, "a window shows no layers; relief render writes them");
    // The window knows no command line: what it needs of one comes as functions.
    const ViewDesc desc{.look = toLook(animation),
                        .device = animation.picture.device,
                        .makeOptions =
                            [&](const Look& look, const LoadedObject& object, const Device& device) {
                                return toRenderOptions(toPictureArgs(look, animation.picture), look.scene, object,
                                                       device);
                            },
                        .listFrames = [&](const Animation* moving) { return listFrames(animation, moving); },
                        .hasFrames = !animation.frames.empty(),
                        .given = listGiven(app),
                        .checkOptions = listCheckOptions(app),
                        .playsAtOnce = args.playsAtOnce,
                        .quitAfter = args.quitAfter,
                        .screenshot = args.screenshot,
                        .record = args.record,
                        .play = args.play,
                        .report = [](const std::string& line) { std::cout << line << std::endl; }};
    print(args, runWindow(desc, makeWarn(args.output.isQuiet)));
    return 0;
}

void addWindow(CLI::App& app, ViewArgs& args) {
    const char* group = "window";
    listIn(group, "PICTURE",
           app.add_option("--screenshot", args.screenshot,
                          "write the first full picture as relief render does: .png or .exr"));
    listIn(group, "N",
           app.add_option("--quit-after", args.quitAfter, "close after N frames, which follow each other without rest")
               ->check(CLI::Range(1, 1'000'000)));
    listIn(group, "FILE", app.add_option("--record", args.record, "write all events, one per line"));
    listIn(group, "FILE", app.add_option("--play", args.play, "play events that --record wrote, or that you write"));
    app.add_flag("--run", args.playsAtOnce, "the time line runs from the start")->group(group);
}

} // namespace

Run addView(CLI::App& app) {
    auto args = std::make_shared<ViewArgs>();
    args->animation.scene.size = kWindowSize;
    addObject(app, args->animation.scene.object);
    addWindow(app, *args);
    listIn("pose", "A:BxS",
           app.add_option("--frames", args->animation.frames,
                          "frames of the time line: first:last (default: from the first key to the last)"));
    addPicture(app, args->animation.scene, args->animation.picture);
    addTime(app, args->animation.scene.object.motion);
    addOutput(app, args->output);
    app.footer("keys: ? lists them; drag to turn, shift-drag to move, wheel to zoom; drop files to show them\n"
               "events: move X Y, point SHARE WIDGET, press left|middle|right [shift|control], release BUTTON, wheel "
               "STEPS, key NAME,\n"
               "        text WORDS, drop FILE, size W H, frame K, rest, wait SECONDS, frames N, screenshot FILE, "
               "report, close\n"
               "examples:\n"
               "  relief view cage.obj --height map.exr\n"
               "  relief view cage.obj --skin walk.glb --run\n"
               "  relief view cage.obj --height-function swell.glsl --frames 0:47 --run\n"
               "  relief view cage.obj --height map.exr --play session.txt --screenshot view.png --quit-after 100");
    return [args, &app] { return view(*args, app); };
}

} // namespace relief::app
