// The window: what `relief render` draws, turned, changed and played while it is looked at.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace relief {

// --- what is shown ------------------------------------------------------------------------------------------------

/// Everything of a picture that the window can change.
struct Look {
    SceneDesc scene;          ///< its size is that of the window in pixels
    std::optional<Path> path; ///< default: what suits the device
    TriangleOptions triangles;
    Show show = Show::shaded;
    Raster raster = Raster::automatic;
    Filter filter = Filter::mipmap;
    Finish finish;
    int frame = 0; ///< of an object that moves: it stands at frame / fps seconds
};

/// An option as it stands on a command line; the name of the cage is "".
struct GivenOption {
    std::string name;  ///< with its dashes
    std::string value; ///< "" for a flag
};

/// The words of a command that draws `look`: `given`, with what differs in `look` from `first` in its place. A
/// `verb` of "animate" draws the frame of an object that moves, "render" any other picture.
std::vector<std::string> toCommandWords(const std::string& verb, std::vector<GivenOption> given, const Look& first,
                                        const Look& look);
/// The words as one line for a POSIX shell.
std::string toShellLine(const std::vector<std::string>& words);

// --- the window ---------------------------------------------------------------------------------------------------

/// What the window is opened with.
struct ViewDesc {
    Look look;
    std::string device; ///< part of its name, or empty
    /// What a picture shows: camera, bounds and environment are set by the window.
    std::function<RenderOptions(const Look&, const LoadedObject&, const Device&)> makeOptions;
    /// The frames of what moves; null where that is a height function alone.
    std::function<std::vector<int>(const Animation*)> listFrames;
    bool hasFrames = false;                ///< they are named, so that a height function moves, too
    std::vector<GivenOption> given;        ///< what `look` was made of, without what is the window's own
    std::vector<std::string> checkOptions; ///< options that `relief check` takes, with their dashes
    bool playsAtOnce = false;              ///< the time line runs from the start
    std::optional<int> quitAfter;          ///< closes after so many frames, which are drawn without waiting for events
    std::string screenshot;                ///< file that the first picture at rest is written to, or empty
    std::string record;                    ///< file that events are written to, or empty
    std::string play;                      ///< file of events that are played before those of the user, or empty
    std::function<void(const std::string&)> report; ///< takes a line of JSON per `report` of a played file
};

/// What happened until the window was closed.
struct ViewReport {
    std::string device;
    std::uint64_t frameCount = 0;   ///< shown by the window
    std::uint64_t pictureCount = 0; ///< drawn of the surface
    std::uint64_t coarseCount = 0;  ///< of them with fewer pixels, while something moved
    std::uint64_t reloadCount = 0;
    std::uint64_t deviceBytes = 0; ///< at the end
};

/// Opens the window and returns when it is closed. Warnings while it is open are shown in it.
/// Throws Failure::device where there is no display or no device that presents to it, Failure::input for lines of
/// `play` that are no events, and as load() and the device do while the first picture is made.
ViewReport runWindow(const ViewDesc& desc, const Warn& warn);

} // namespace relief
