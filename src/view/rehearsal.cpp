#include "view/rehearsal.h"

namespace relief {
namespace {

/// Pixels of the window per pixel of the picture, each way: shaders are what is wanted of it.
constexpr int kDivisor = 4;

void drawSmallPicture(Device& device, const ViewDesc& desc, const Prepared& prepared) {
    // A scene keeps what it is made of: its files are read once more.
    Prepared own = prepareScene(desc, prepared.look);
    own.loaded.object.function = prepared.loaded.object.function;
    own.points = prepared.points;
    const ivec2 size = glm::max(prepared.look.scene.size / kDivisor, ivec2(1));
    Renderer renderer(device, {.width = size.x, .height = size.y});
    ShownScene(device, desc, std::move(own)).draw(renderer, prepared.look, size);
}

} // namespace

void rehearse(const ViewDesc& desc, const std::string& device, const PipelineKey& shown, Prepared& prepared,
              const std::atomic<bool>& isEnding) {
    if (!prepared.loaded.object.function || isEnding) return;
    std::unique_ptr<Device> own;
    try {
        own = std::make_unique<Device>(DeviceDesc{.name = device});
    } catch (const Error&) { // there is no room for a second one
        return;
    }
    try {
        measure(*own, prepared);
    } catch (const Error& error) {
        if (error.failure != Failure::device) throw;
        return; // the window's own device may have the room
    }
    if (keyOf(prepared) == shown || isEnding) return;
    try {
        drawSmallPicture(*own, desc, prepared);
    } catch (const Error&) { // the window will see
    }
}

} // namespace relief
