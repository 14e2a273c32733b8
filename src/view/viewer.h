// Internal: the window's loop: events, files, pictures, panels.
#pragma once

#include <deque>
#include <fstream>

#include "view/developer.h"
#include "view/loader.h"
#include "view/orbit.h"
#include "view/pacing.h"
#include "view/panels.h"
#include "view/process.h"
#include "view/ui.h"
#include "view/window.h"

namespace relief {

/// Panels follow an event within so many frames.
inline constexpr int kFramesAfterEvent = 3;

class Viewer {
public:
    Viewer(const ViewDesc& desc, const Warn& warn);
    ~Viewer();
    Viewer(const Viewer&) = delete;
    Viewer& operator=(const Viewer&) = delete;
    ViewReport run();

private:
    // The loop: viewer.cpp.
    [[nodiscard]] double secondsToWait(double now) const;
    [[nodiscard]] bool isDone() const;
    void step();
    void advanceTime(double now);
    void takeLoaded();
    void watchFiles(double now);
    void draw(double now);
    void drawPicture(Quality quality);
    void develop(const Picture& picture, bool isExact);
    void addOtherSide(Codes& codes, const ivec2& size, bool isExact);
    void upload(const Codes& codes);
    void present(double now);
    void fitToWindow();
    void watchProcesses();

    // What users do: playing.cpp, actions.cpp.
    void takeEvents(double now);
    bool takePlayed(double now);
    Event toMove(const Event& event);
    void record(const Event& event);
    void apply(const Event& event);
    void waitFor(const std::function<bool()>& isSo);
    void press(const Event& event);
    void move(const dvec2& to);
    void pressKey(int key);
    void pressViewKey(int key);
    void pressTriangleKey(int key);
    void open(const std::string& cage);
    void drop(const std::string& path);
    void obey(const PanelWishes& wishes);
    void playOrStop();
    void seek(int frame);
    void step(int frames);
    void look(double azimuth, double elevation);
    void toggleParallel();
    void frameObject();
    void exportTurntable();
    void startCheck();
    void shoot(const std::string& path);
    void report();

    void changePicture();
    void changeObject();
    [[nodiscard]] Orbit orbit() const;
    void setOrbit(const Orbit& orbit);
    [[nodiscard]] std::vector<std::string> command() const;
    [[nodiscard]] Look shownLook() const; ///< with the files that are shown
    void useScene(Prepared prepared);

    const ViewDesc& desc_;
    ViewState state_;
    Window window_;
    std::unique_ptr<Device> device_;
    std::unique_ptr<Swapchain> swapchain_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<Ui> ui_;
    Loader loader_, otherLoader_;
    FileWatch watch_;
    std::unique_ptr<ShownScene> scene_, other_; ///< other_: the right side of a split view that has other heights
    Pacing pacing_;
    Developer developer_;

    // What is shown.
    Picture picture_; ///< the latest full one
    FrameStats stats_;
    Times pictureTimes_, shadowTimes_, colorTimes_, lightTimes_, rateTimes_;
    Texture canvas_;
    Buffer staging_;
    VkExtent2D canvasPart_{1, 1};
    std::optional<Camera> frozenCamera_;
    bool isCoarse_ = false;

    // Events.
    std::ofstream record_;
    std::uint64_t recordedPictures_ = 0; ///< drawn when it was last recorded that the picture was at rest
    std::deque<Event> played_;
    double playedUntil_ = 0;              ///< of a wait
    int framesToPlay_ = 0;                ///< of `frames`
    std::map<std::string, Place> places_; ///< of widgets, as they were drawn last
    dvec2 cursor_{0};
    std::optional<Event> drag_; ///< its press
    bool dragsDivider_ = false;
    int uiFrames_ = 3; ///< that panels need to come to rest after an event
    double lastFrameAt_ = 0, lastWatchAt_ = 0, playStart_ = 0;
    int playStartFrame_ = 0;
    bool isClosed_ = false, wantsFirstShot_ = false;
    std::optional<Process> export_, check_;
    ViewReport report_;
};

} // namespace relief
