#include "view/viewer.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "base/clock.h"
#include "view/recent.h"

namespace relief {
namespace {

constexpr double kSecondsBetweenWatches = 0.5;

std::string titleOf(const Look& look) {
    return "relief - " + std::filesystem::path(look.scene.object.cage).filename().string();
}

/// The last line of what a child process has complained of.
std::string lastLineOf(std::string text) {
    while (text.ends_with('\n')) text.pop_back();
    return text.substr(text.rfind('\n') + 1);
}

/// The lines in which a child process has warned of something.
std::string warningsIn(const std::string& complaints) {
    std::string warnings;
    std::istringstream lines(complaints);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("warning: ")) warnings += (warnings.empty() ? "" : "\n") + line;
    return warnings;
}

} // namespace

Viewer::Viewer(const ViewDesc& desc, const Warn& warn)
    : desc_(desc), state_{.look = desc.look}, window_(titleOf(desc.look), desc.look.scene.size), loader_(desc),
      otherLoader_(desc) {
    if (!desc.play.empty()) {
        const std::vector<Event> events = readEvents(desc.play);
        played_.assign(events.begin(), events.end());
    }
    if (!desc.record.empty()) {
        checkWritable(desc.record);
        record_.open(desc.record);
    }
    wantsFirstShot_ = !desc.screenshot.empty();
    state_.isPlaying = desc.playsAtOnce;

    // Files are read before the device is opened: their mistakes are the more common ones.
    Prepared prepared = prepareScene(desc, state_.look);
    for (const std::string& line : prepared.warnings) warn(line);
    device_ = std::make_unique<Device>(DeviceDesc{
        .name = desc.device, .surfaceExtensions = Window::listExtensions(), .makeSurface = [this](VkInstance instance) {
            return window_.makeSurface(instance);
        }});
    for (Loader* loader : {&loader_, &otherLoader_}) loader->useDevice(device_->traits().name);
    const ivec2 size = glm::max(window_.size(), ivec2(1));
    swapchain_ = std::make_unique<Swapchain>(*device_, size.x, size.y);
    ui_ = std::make_unique<Ui>(*device_, *swapchain_);
    renderer_ = std::make_unique<Renderer>(*device_, RendererDesc{.width = size.x, .height = size.y});
    useScene(std::move(prepared));
    if (scene_->isMoving()) state_.look.frame = scene_->frames().front();
    fitToWindow();
}

/// The last frame may still be drawn, and reads what ends with the window.
Viewer::~Viewer() {
    if (device_) vkDeviceWaitIdle(device_->handle());
}

bool Viewer::isDone() const {
    return isClosed_ || window_.isClosing() ||
           (desc_.quitAfter && report_.frameCount >= std::uint64_t(*desc_.quitAfter));
}

ViewReport Viewer::run() {
    report_.device = device_->traits().name;
    lastFrameAt_ = playStart_ = secondsNow();
    pacing_.change(lastFrameAt_);
    while (!isDone()) step();
    window_.hide(); // gone at once for the user, though shaders that are being compiled have to be waited for
    report_.deviceBytes = device_->allocatedBytes();
    if (!device_->validationMessages().empty())
        fail(Failure::internal, "the Vulkan validation layer has {} complaints", device_->validationMessages().size());
    return report_;
}

void Viewer::step() {
    window_.waitForEvents(secondsToWait(secondsNow()));
    const double now = secondsNow();
    takeEvents(now);
    advanceTime(now);
    takeLoaded();
    watchFiles(now);
    watchProcesses();
    draw(now);
}

/// How long nothing needs to be done unless the user does something.
double Viewer::secondsToWait(double now) const {
    double seconds = kSecondsBetweenWatches;
    const ivec2 size = window_.size();
    if (size.x < 1 || size.y < 1) return seconds; // minimised: nothing is drawn
    if (uiFrames_ > 0 || desc_.quitAfter || framesToPlay_ > 0) return 0;
    const double rest = pacing_.secondsOfRest(now);
    if (pacing_.next(now) != Quality::none) seconds = 0;
    if (rest >= 0) seconds = std::min(seconds, rest);
    if (!played_.empty()) seconds = std::min(seconds, std::max(0.0, playedUntil_ - now));
    if (loader_.isBusy() || otherLoader_.isBusy() || export_ || check_) seconds = std::min(seconds, 0.02);
    if (state_.isPlaying) seconds = std::min(seconds, 0.5 / desc_.look.scene.object.motion.cache.fps);
    return seconds;
}

void Viewer::changePicture() { pacing_.change(secondsNow()); }

/// Files and the surface anew: in the background, the picture of before stays meanwhile.
void Viewer::changeObject() {
    loader_.ask(state_.look);
    uiFrames_ = kFramesAfterEvent;
}

void Viewer::advanceTime(double now) {
    if (!state_.isPlaying || !scene_->isMoving()) return;
    const std::vector<int>& frames = scene_->frames();
    const double fps = state_.look.scene.object.motion.cache.fps;
    const int count = frames.back() - frames.front() + 1;
    int frame = playStartFrame_ + int((now - playStart_) * fps);
    if (frame > frames.back() && !state_.loops) state_.isPlaying = false, frame = frames.back();
    frame = frames.front() + (frame - frames.front()) % count;
    if (frame == state_.look.frame) return;
    state_.look.frame = frame;
    changePicture();
    uiFrames_ = std::max(uiFrames_, 1);
}

void Viewer::useScene(Prepared prepared) {
    auto scene = std::make_unique<ShownScene>(*device_, desc_, std::move(prepared));
    scene_ = std::move(scene);
    loader_.setShown(scene_->pipelineKey());
    other_.reset();
    watch_.watch(listFiles(scene_->look().scene));
    if (scene_->isMoving())
        state_.look.frame = std::clamp(state_.look.frame, scene_->frames().front(), scene_->frames().back());
    window_.setTitle(titleOf(scene_->look()));
    addRecent(scene_->look().scene.object.cage);
    state_.recent = readRecent();
}

void Viewer::takeLoaded() {
    // What the device says of a height function is an error of its file, too.
    const auto use = [&](Loader::Result& result, const auto& take) {
        uiFrames_ = kFramesAfterEvent;
        if (result.prepared) {
            try {
                take(std::move(*result.prepared));
            } catch (const Error& error) {
                result.error = error.what();
            }
        }
        state_.error = onOneLine(result.error);
        if (result.error.empty()) changePicture();
        return result.error.empty();
    };
    // The scene that is shown, and the one of the right side, which is not needed where it cannot be had.
    if (auto result = loader_.take()) {
        const auto take = [&](Prepared prepared) { useScene(std::move(prepared)); };
        if (use(*result, take)) ++report_.reloadCount;
    }
    if (auto result = otherLoader_.take()) {
        const auto take = [&](Prepared prepared) {
            other_ = std::make_unique<ShownScene>(*device_, desc_, std::move(prepared));
            otherLoader_.setShown(other_->pipelineKey());
        };
        if (!use(*result, take)) state_.split = SplitKind::off, changePicture();
    }
}

void Viewer::watchFiles(double now) {
    if (now - lastWatchAt_ < kSecondsBetweenWatches) return;
    lastWatchAt_ = now;
    if (watch_.hasChanged()) changeObject();
}

/// Polls the child processes and shows the results of those that have ended.
void Viewer::watchProcesses() {
    if (const std::optional<int> code = export_ ? export_->poll() : std::nullopt) {
        const std::string complaints = export_->complaints(), last = lastLineOf(complaints);
        const std::string warnings = warningsIn(complaints);
        export_.reset();
        state_.notice = *code == 0 ? "the turntable is written" + (warnings.empty() ? "" : "\n" + warnings) : "";
        if (*code != 0)
            state_.error = last.empty() ? fmt::format("the turntable ended with exit code {}", *code)
                                        : "the turntable was not written: " + last;
        uiFrames_ = kFramesAfterEvent;
    }
    if (const std::optional<int> code = check_ ? check_->poll() : std::nullopt) {
        const std::string text = check_->output(), complaints = check_->complaints(), last = lastLineOf(complaints);
        check_.reset();
        if (state_.notice == kMakingCertificate) state_.notice.clear();
        state_.certificate = text;
        // Without a certificate it has said why, in its last line.
        if (text.empty())
            state_.error = last.empty() ? fmt::format("the certificate ended with exit code {}", *code) : last;
        else if (const std::string warnings = warningsIn(complaints); !warnings.empty())
            state_.notice = warnings;
        uiFrames_ = kFramesAfterEvent;
    }
}

// --- pictures ------------------------------------------------------------------------------------------------------

/// The images of the window and what is copied to them, for the size that it has now.
void Viewer::fitToWindow() {
    const ivec2 size = window_.size();
    if (size.x < 1 || size.y < 1) return; // minimised
    swapchain_->resize(std::uint32_t(size.x), std::uint32_t(size.y));
    const VkExtent2D extent = swapchain_->extent();
    state_.look.scene.size = {int(extent.width), int(extent.height)};
    canvas_ = {};
    canvas_ = makeTexture(*device_, {.name = "shown picture",
                                     .width = extent.width,
                                     .height = extent.height,
                                     .format = VK_FORMAT_R8G8B8A8_UNORM,
                                     .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                              VK_IMAGE_USAGE_SAMPLED_BIT});
    staging_ = makeBuffer(*device_, {.name = "codes",
                                     .bytes = std::uint64_t(extent.width) * extent.height * 4,
                                     .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                     .memory = MemoryUse::upload});
    changePicture();
    uiFrames_ = kFramesAfterEvent;
}

void Viewer::draw(double now) {
    const ivec2 size = window_.size();
    if (size.x < 1 || size.y < 1) { // minimised; once it is back everything is to be seen
        uiFrames_ = kFramesAfterEvent;
        return;
    }
    if (uvec2(size) != uvec2(swapchain_->extent().width, swapchain_->extent().height)) fitToWindow();
    const Quality quality = pacing_.next(now);
    if (quality != Quality::none) drawPicture(quality);
    const bool isAsked = desc_.quitAfter || framesToPlay_ > 0;
    if (quality == Quality::none && uiFrames_ == 0 && !isAsked) return;
    present(now);
    if (pacing_.isAtRest() && std::exchange(wantsFirstShot_, false)) shoot(desc_.screenshot);
}

void Viewer::drawPicture(Quality quality) {
    const double start = secondsNow();
    isCoarse_ = quality == Quality::coarse;
    const ivec2 whole = state_.look.scene.size;
    const ivec2 size = isCoarse_ ? glm::max(whole / pacing_.divisor(), ivec2(1)) : whole;
    // Coarse pictures have a smaller size and a smaller shadow map: both cost by the pixel.
    renderer_->resize({.width = size.x,
                       .height = size.y,
                       .shadowSide = isCoarse_ ? RendererDesc().shadowSide / 2 : RendererDesc().shadowSide});
    // A frozen camera still decides about rates, while the picture is seen from elsewhere.
    if (state_.isFrozen && !frozenCamera_) frozenCamera_ = scene_->makeCamera(state_.look, whole);
    if (!state_.isFrozen) frozenCamera_.reset();
    Picture picture = scene_->draw(*renderer_, state_.look, size, frozenCamera_);
    stats_ = picture.stats;
    develop(picture, !isCoarse_);
    ++report_.pictureCount;
    if (isCoarse_)
        ++report_.coarseCount;
    else
        picture_ = std::move(picture);

    // What it took decides how coarse the next picture is, and is what the panel shows.
    const double seconds = secondsNow() - start;
    pacing_.drew(quality, seconds);
    pictureTimes_.add(1e3 * seconds);
    rateTimes_.add(stats_.rateMs + stats_.diceMs);
    shadowTimes_.add(stats_.shadowMs);
    colorTimes_.add(stats_.colorMs);
    lightTimes_.add(stats_.lightMs);
    uiFrames_ = std::max(uiFrames_, 1);
}

void Viewer::develop(const Picture& picture, bool isExact) {
    const Finish& finish = state_.look.finish;
    Codes codes = isExact ? developExactly(picture, finish) : developer_.develop(picture, finish);
    if (state_.split != SplitKind::off) addOtherSide(codes, {picture.width, picture.height}, isExact);
    upload(codes);
}

/// Draws the right side of a split view. Its heights may differ: then it is a scene of its own, read when first needed.
void Viewer::addOtherSide(Codes& codes, const ivec2& size, bool isExact) {
    Look other = shownLook();
    // The look of the right side: that of the left one with one thing changed.
    switch (state_.split) {
    case SplitKind::smooth: other.scene.object.height.detail = Detail::none; break;
    case SplitKind::bump: other.scene.object.height.detail = Detail::bump; break;
    case SplitKind::coarse:
        other.triangles.edgePixels *= 4;
        if (other.triangles.rate) other.triangles.rate = std::max(1, *other.triangles.rate / 4);
        break;
    case SplitKind::dense: other.triangles.rate.reset(), other.triangles.edgePixels = isExact ? 0.5 : 2; break;
    case SplitKind::limitNormals: other.triangles.normal = NormalKind::limit; break;
    case SplitKind::off: return;
    }
    // Another technique needs another scene, which is read in the background: until then the left side fills the
    // window.
    const bool isSame = other.scene.object.height.detail == scene_->look().scene.object.height.detail;
    if (!isSame && (!other_ || other_->look().scene.object.height.detail != other.scene.object.height.detail)) {
        if (!otherLoader_.isBusy()) otherLoader_.ask(other);
        return;
    }
    // Developed as the left side was, and joined at the divider.
    ShownScene& scene = isSame ? *scene_ : *other_;
    const Picture picture = scene.draw(*renderer_, other, size, frozenCamera_);
    const Finish& finish = state_.look.finish;
    const Codes right = isExact ? developExactly(picture, finish) : developer_.develop(picture, finish);
    const int divider = int(state_.divider * size.x);
    if (state_.showsDifference)
        joinDifference(codes, right, divider, 8);
    else
        joinColumns(codes, right, divider);
}

void Viewer::upload(const Codes& codes) {
    RELIEF_CHECK(codes.rgba.size() <= staging_.bytes);
    std::memcpy(staging_.mapped, codes.rgba.data(), codes.rgba.size());
    canvasPart_ = {std::uint32_t(codes.width), std::uint32_t(codes.height)};
    VkBufferImageCopy region{};
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageExtent = {canvasPart_.width, canvasPart_.height, 1};
    device_->submitAndWait([&](VkCommandBuffer commands) {
        barrier(commands); // a frame that is still drawn reads the picture of before
        vkCmdCopyBufferToImage(commands, staging_.handle.get(), canvas_.handle.get(), VK_IMAGE_LAYOUT_GENERAL, 1,
                               &region);
        barrier(commands);
    });
}

void Viewer::present(double now) {
    // The panels, and what lies between them and the picture.
    const ivec2 size = state_.look.scene.size;
    ui_->begin(std::uint32_t(size.x), std::uint32_t(size.y), now - lastFrameAt_);
    lastFrameAt_ = now;
    if (state_.showsCage) drawCage(*scene_, scene_->makeCamera(state_.look, size), size);
    drawDivider(state_, size);
    const PanelWishes wishes = makePanels(
        state_,
        {.device = device_->traits().name,
         .scene = scene_.get(),
         .stats = &stats_,
         .pictureTimes = &pictureTimes_,
         .passes =
             {{{"rates", &rateTimes_}, {"shadow", &shadowTimes_}, {"color", &colorTimes_}, {"light", &lightTimes_}}},
         .deviceBytes = device_->allocatedBytes(),
         .heapBytes = device_->traits().heapBytes,
         .isLoading = loader_.isBusy() || otherLoader_.isBusy(),
         .isCoarse = isCoarse_,
         .command = toShellLine(command())},
        size);
    places_ = wishes.places;
    ui_->end();
    if (uiFrames_ > 0) --uiFrames_;
    if (framesToPlay_ > 0) --framesToPlay_;

    // A window that was resized meanwhile shows nothing; the next frame has its size.
    const bool isShown = swapchain_->show(canvas_, canvasPart_, [&](VkCommandBuffer c) { ui_->draw(c); });
    ++report_.frameCount;
    if (!isShown) fitToWindow();
    obey(wishes);
}

// --- module --------------------------------------------------------------------------------------------------------

ViewReport runWindow(const ViewDesc& desc, const Warn& warn) { return Viewer(desc, warn).run(); }

} // namespace relief
