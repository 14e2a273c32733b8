// What events and panels do.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <malloc.h>
#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "geometry_image/geometry_image.h"
#include "view/keys.h"
#include "view/viewer.h"

namespace relief {
namespace {

constexpr double kDividerPixels = 8; ///< how near the cursor takes the divider
constexpr double kZoomPerStep = 0.9, kRatePerKey = 1.25;

/// The first of name-1.png, name-2.png, ... that does not exist.
std::string freeName(const std::string& name, const std::string& extension) {
    for (int i = 1;; ++i) {
        std::string path = fmt::format("{}-{}{}", name, i, extension);
        if (!std::filesystem::exists(path)) return path;
    }
}

/// Bytes that the process has of the heap.
std::uint64_t hostBytes() {
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

/// False also for a file that cannot be read, which is an error once it is loaded.
bool isGeometryImage(const std::string& path) {
    try {
        return isGeometryImageFile(path);
    } catch (const Error&) {
        return false;
    }
}

template <typename Value, std::size_t kCount>
Value nextOf(const Word<Value> (&table)[kCount], Value value) {
    for (std::size_t i = 0; i < kCount; ++i)
        if (table[i].value == value) return table[(i + 1) % kCount].value;
    return table[0].value;
}

} // namespace

// --- events --------------------------------------------------------------------------------------------------------

void Viewer::apply(const Event& event) {
    // Panels come first: what they take does not turn the camera below them.
    const bool isTaken = ui_->take(event);
    switch (event.kind) {
    case EventKind::move: move(event.at); break;
    case EventKind::press:
        if (!isTaken) press(event);
        break;
    case EventKind::release: drag_.reset(), dragsDivider_ = false; break;
    case EventKind::wheel:
        if (!isTaken) setOrbit(zoom(orbit(), std::pow(kZoomPerStep, event.at.x), cursor_, state_.look.scene.size));
        break;
    case EventKind::key:
        if (!isTaken) pressKey(event.key);
        break;
    case EventKind::drop: drop(event.text); break;
    case EventKind::size: {
        const ivec2 size(event.at);
        if (window_.size() == size) break;
        window_.resize(size);
        waitFor([&] { return window_.size() == size; });
        break;
    }
    case EventKind::minimise:
    case EventKind::restore: {
        const bool isMinimised = event.kind == EventKind::minimise;
        if (window_.isMinimised() == isMinimised) break;
        window_.minimise(isMinimised);
        waitFor([&] { return window_.isMinimised() == isMinimised; });
        break;
    }
    case EventKind::frame: seek(int(event.at.x)); break;
    case EventKind::screenshot: shoot(event.text); break;
    case EventKind::report: report(); break;
    case EventKind::close: isClosed_ = true; break;
    default: break;
    }
}

/// The window system does what it is asked for when it likes, or never: later events count on it.
void Viewer::waitFor(const std::function<bool()>& isSo) {
    for (int i = 0; i < 200 && !isSo(); ++i) window_.waitForEvents(0.01);
}

// --- mouse ---------------------------------------------------------------------------------------------------------

void Viewer::press(const Event& event) {
    drag_ = event;
    const double divider = state_.divider * state_.look.scene.size.x;
    dragsDivider_ = state_.split != SplitKind::off && std::abs(cursor_.x - divider) < kDividerPixels;
}

void Viewer::move(const dvec2& to) {
    const dvec2 moved = to - cursor_;
    cursor_ = to;
    if (!drag_ || moved == dvec2(0)) return;
    const ivec2& size = state_.look.scene.size;
    if (dragsDivider_) {
        state_.divider = std::clamp(to.x / size.x, 0.02, 0.98);
        changePicture();
    } else if (drag_->isControlled && drag_->button == Button::right) {
        double& azimuth = state_.look.scene.lighting.environmentAzimuth;
        azimuth = std::remainder(azimuth + 0.5 * moved.x, 360);
        changePicture();
    } else if (drag_->isControlled) {
        LightingDesc& lighting = state_.look.scene.lighting;
        const Lighting now = makeLighting(lighting, state_.look.scene.camera.azimuth, nullptr);
        lighting.key = dvec2(std::remainder(now.keyAzimuth + 0.5 * moved.x, 360),
                             std::clamp(now.keyElevation - 0.5 * moved.y, -90.0, 90.0));
        changePicture();
    } else if (drag_->button == Button::middle || drag_->isShifted) {
        setOrbit(pan(orbit(), moved, size.y));
    } else if (drag_->button == Button::right) {
        setOrbit(zoom(orbit(), std::exp(0.01 * moved.y), 0.5 * dvec2(size), size));
    } else {
        setOrbit(turn(orbit(), moved));
    }
}

Orbit Viewer::orbit() const {
    const SceneDesc& scene = state_.look.scene;
    return makeOrbit(scene.camera, scene_->makeCamera(state_.look, scene.size), scene_->coordinates());
}

void Viewer::setOrbit(const Orbit& orbit) {
    state_.look.scene.camera = toOptions(orbit);
    changePicture();
}

void Viewer::look(double azimuth, double elevation) {
    Orbit turned = orbit();
    turned.azimuth = azimuth, turned.elevation = elevation;
    setOrbit(turned);
}

/// From a perspective to a view of one degree, and back to the default one.
void Viewer::toggleParallel() {
    const bool isParallel = state_.look.scene.camera.fieldOfView == kParallelView;
    setOrbit(widen(orbit(), isParallel ? CameraOptions().fieldOfView : kParallelView));
}

void Viewer::frameObject() {
    CameraOptions& camera = state_.look.scene.camera;
    camera.distance.reset(), camera.lookAt.reset();
    changePicture();
}

// --- keys ----------------------------------------------------------------------------------------------------------

void Viewer::pressKey(int key) {
    switch (key) {
    case GLFW_KEY_SPACE: playOrStop(); break;
    case GLFW_KEY_LEFT: step(-1); break;
    case GLFW_KEY_RIGHT: step(1); break;
    case GLFW_KEY_R: changeObject(); break;
    case GLFW_KEY_K: obey({.checks = true}); break;
    case GLFW_KEY_C: obey({.copies = true}); break;
    case GLFW_KEY_F12: obey({.shoots = true}); break;
    case GLFW_KEY_TAB: state_.showsPanels = !state_.showsPanels; break;
    case GLFW_KEY_SLASH: state_.showsHelp = !state_.showsHelp; break;
    case GLFW_KEY_ESCAPE:
        state_.showsHelp = false, state_.error.clear(), state_.notice.clear(), state_.certificate.clear();
        break;
    case GLFW_KEY_Q: isClosed_ = true; break;
    default: pressViewKey(key); break;
    }
}

void Viewer::pressViewKey(int key) {
    const CameraOptions& camera = state_.look.scene.camera;
    Show& show = state_.look.show;
    const auto isAt = [&](double azimuth) { return std::abs(std::remainder(camera.azimuth - azimuth, 360)) < 1e-9; };
    // The keys of Blender's numeric pad: a second press looks from the other side.
    switch (key) {
    case GLFW_KEY_F: return frameObject();
    case GLFW_KEY_1: return look(isAt(0) && camera.elevation == 0 ? 180 : 0, 0);
    case GLFW_KEY_3: return look(isAt(90) && camera.elevation == 0 ? -90 : 90, 0);
    case GLFW_KEY_7: return look(0, camera.elevation == 90 ? -90 : 90);
    case GLFW_KEY_5: return toggleParallel();
    case GLFW_KEY_W:
        show = show == Show::shaded ? Show::wireframe : show == Show::wireframe ? Show::faces : Show::shaded;
        return changePicture();
    case GLFW_KEY_N: show = nextOf(kShows, show); return changePicture();
    case GLFW_KEY_H: state_.showsCage = !state_.showsCage; return;
    case GLFW_KEY_X: state_.split = nextOf(kSplits, state_.split); return changePicture();
    case GLFW_KEY_Z: state_.isFrozen = !state_.isFrozen; return changePicture();
    case GLFW_KEY_D: {
        Detail& detail = state_.look.scene.object.height.detail;
        detail = nextOf(kDetails, detail);
        return changeObject();
    }
    default: return pressTriangleKey(key);
    }
}

void Viewer::pressTriangleKey(int key) {
    TriangleOptions& triangles = state_.look.triangles;
    const auto refine = [&](double factor) {
        if (triangles.rate)
            triangles.rate = std::clamp(*triangles.rate + (factor < 1 ? 1 : -1), 1, 64);
        else
            triangles.edgePixels = std::clamp(triangles.edgePixels * factor, 0.25, 256.0);
    };
    switch (key) {
    case GLFW_KEY_EQUAL: refine(1 / kRatePerKey); break;
    case GLFW_KEY_MINUS: refine(kRatePerKey); break;
    case GLFW_KEY_T: triangles.spacing = nextOf(kSpacings, triangles.spacing); break;
    case GLFW_KEY_V: triangles.rate = triangles.rate ? std::nullopt : std::optional(8); break;
    default: return;
    }
    changePicture();
}

// --- files ---------------------------------------------------------------------------------------------------------

void Viewer::open(const std::string& cage) {
    state_.look.scene.object.cage = cage;
    frameObject();
    changeObject();
}

/// A mesh or a geometry image is the new cage, .hdr the environment, any other picture the height map.
void Viewer::drop(const std::string& path) {
    const std::string extension = lowerExtension(path);
    ObjectDesc& object = state_.look.scene.object;
    const auto isOneOf = [&](std::initializer_list<const char*> list) {
        return std::ranges::any_of(list, [&](const char* each) { return extension == each; });
    };
    if (isOneOf({".obj", ".gltf", ".glb"}) || isGeometryImage(path)) return open(path);
    if (extension == ".hdr") {
        state_.look.scene.lighting.environment = path;
    } else if (isOneOf({".exr", ".tif", ".tiff", ".png", ".jpg", ".jpeg"})) {
        object.height.path = path;
        object.height.function.clear(), object.height.functionBound.reset();
    } else if (extension == ".glsl") {
        object.height.function = path;
        object.height.path.clear(), object.height.layers.clear();
    } else {
        state_.error = onOneLine(path + ": a cage, an environment (.hdr), a height map or a height function (.glsl) "
                                        "can be dropped");
        return;
    }
    changeObject();
}

void Viewer::shoot(const std::string& path) {
    const std::vector<std::string> inputs = listFiles(shownLook().scene);
    if (std::ranges::find(inputs, path) != inputs.end())
        fail(Failure::usage, "{}: the screenshot would replace what is shown", path);
    if (!pacing_.isAtRest()) drawPicture(Quality::full);
    writePicture(path, picture_, state_.look.finish);
    state_.notice = path + " is written";
}

void Viewer::exportTurntable() {
    if (export_) return;
    const std::string target = freeName("turntable", ".mp4");
    std::vector<std::string> words = toCommandWords("animate", desc_.given, desc_.look, shownLook());
    std::erase_if(words, [](const std::string& word) { return word.starts_with("--frames"); });
    for (const char* word : {"--turntable=72", "--progress=never", "-o"}) words.emplace_back(word);
    words.push_back(target);
    export_.emplace(words, false);
    state_.notice = "writing " + target + " ...";
}

/// The certificate of what is shown: of its options those that `relief check` takes, with the time of this frame.
void Viewer::startCheck() {
    if (check_) return;
    std::vector<std::string> words = toCommandWords("check", desc_.given, desc_.look, shownLook());
    std::erase_if(words, [&](const std::string& word) {
        return word.starts_with("--") &&
               std::ranges::find(desc_.checkOptions, word.substr(0, word.find('='))) == desc_.checkOptions.end();
    });
    std::erase_if(words, [](const std::string& word) { return word.starts_with("--time="); });
    if (scene_->isMoving())
        words.push_back(fmt::format("--time={}", state_.look.frame / state_.look.scene.object.motion.cache.fps));
    words.emplace_back("--progress=never");
    check_.emplace(words, true);
    state_.notice = kMakingCertificate;
}

void Viewer::report() {
    std::vector<std::string> widgets;
    for (const auto& [label, place] : places_) widgets.push_back(label);
    const nlohmann::json counts{{"frames", report_.frameCount},
                                {"pictures", report_.pictureCount},
                                {"coarse", report_.coarseCount},
                                {"reloads", report_.reloadCount},
                                {"device_bytes", device_->allocatedBytes()},
                                {"host_bytes", hostBytes()},
                                {"frame", state_.look.frame},
                                {"minimised", window_.isMinimised()},
                                {"triangles", stats_.triangleCount},
                                {"error", state_.error},
                                {"notice", state_.notice},
                                {"certificate", state_.certificate},
                                {"widgets", widgets},
                                {"command", command()}};
    desc_.report(counts.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

// --- panels --------------------------------------------------------------------------------------------------------

void Viewer::obey(const PanelWishes& wishes) {
    if (wishes.changesPicture) changePicture();
    if (wishes.changesObject || wishes.reloads) changeObject();
    if (wishes.frames) frameObject();
    if (wishes.plays) playOrStop();
    if (wishes.togglesParallel) toggleParallel();
    if (wishes.looksFrom) look(wishes.looksFrom->x, wishes.looksFrom->y);
    if (wishes.seeks) seek(*wishes.seeks);
    if (!wishes.opens.empty()) open(wishes.opens);
    if (wishes.copies) {
        window_.copyText(toShellLine(command()));
        state_.notice = "copied: " + toShellLine(command());
    }
    try {
        if (wishes.shoots) shoot(freeName("relief", ".png"));
        if (wishes.exports) exportTurntable();
        if (wishes.checks) startCheck();
    } catch (const Error& error) {
        state_.error = onOneLine(error.what());
    }
    const bool isAny = !wishes.opens.empty() || wishes.changesPicture || wishes.changesObject || wishes.frames ||
                       wishes.copies || wishes.shoots || wishes.exports || wishes.checks || wishes.looksFrom ||
                       wishes.togglesParallel || wishes.plays || wishes.seeks;
    if (isAny) uiFrames_ = kFramesAfterEvent;
}

void Viewer::playOrStop() {
    state_.isPlaying = !state_.isPlaying && scene_->isMoving();
    playStart_ = secondsNow(), playStartFrame_ = state_.look.frame;
}

void Viewer::seek(int frame) {
    if (!scene_->isMoving()) return;
    state_.isPlaying = false;
    state_.look.frame = std::clamp(frame, scene_->frames().front(), scene_->frames().back());
    changePicture();
}

void Viewer::step(int frames) { seek(state_.look.frame + frames); }

Look Viewer::shownLook() const { return withFilesOf(scene_->look(), state_.look); }

std::vector<std::string> Viewer::command() const {
    return toCommandWords(scene_->isMoving() ? "animate" : "render", desc_.given, desc_.look, shownLook());
}

} // namespace relief
