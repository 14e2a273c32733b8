// Internal: the panels over the picture, made of the same tables of words as the command line.
#pragma once

#include <array>
#include <map>

#include "view/shown_scene.h"

namespace relief {

/// What the right side of a split view shows.
enum class SplitKind { off, smooth, bump, coarse, dense, limitNormals };

inline constexpr Word<SplitKind> kSplits[] = {
    {"off", SplitKind::off, "one picture"},
    {"smooth", SplitKind::smooth, "the surface without heights"},
    {"bump", SplitKind::bump, "heights bend normals alone"},
    {"coarse", SplitKind::coarse, "segments four times as long"},
    {"dense", SplitKind::dense, "segments of half a pixel: what a dense mesh shows"},
    {"limit normals", SplitKind::limitNormals, "normals of the smooth surface"},
};

/// The latest times of something, in milliseconds.
class Times {
public:
    void add(double milliseconds);
    [[nodiscard]] double median() const { return quantile(0.5); }
    [[nodiscard]] double high() const { return quantile(0.95); } ///< 95 % are below it

private:
    [[nodiscard]] double quantile(double share) const;
    std::array<double, 128> values_{};
    std::size_t count_ = 0;
};

/// Everything that the panels and keys change.
struct ViewState {
    Look look;
    bool showsCage = false, showsPanels = true, showsHelp = false;
    bool isPlaying = false, loops = true;
    bool isFrozen = false; ///< rates are measured from where the camera was
    SplitKind split = SplitKind::off;
    bool showsDifference = false;
    double divider = 0.5;            ///< of the split view, 0..1 from the left
    std::string error;               ///< of the latest files that could not be read
    std::string notice;              ///< what was done last, such as a screenshot
    std::string certificate;         ///< the latest one, until it is closed
    std::string reveals;             ///< label of a widget that the panel is to scroll to, or empty
    std::vector<std::string> recent; ///< paths of cages shown before, the latest first
};

inline constexpr const char* kMakingCertificate = "making the certificate ...";

/// What the panels report.
struct ViewFacts {
    std::string device;
    const ShownScene* scene = nullptr;
    const FrameStats* stats = nullptr; ///< of the latest picture
    const Times* pictureTimes = nullptr;
    std::array<std::pair<const char*, const Times*>, 4> passes{};
    std::uint64_t deviceBytes = 0, heapBytes = 0;
    bool isLoading = false, isCoarse = false;
    std::string command; ///< of this picture
};

/// A rectangle of the window, pixels from its upper left corner.
struct Place {
    dvec2 low{0}, high{0};
};

/// What a panel asks for.
struct PanelWishes {
    bool changesPicture = false, changesObject = false;
    bool frames = false, copies = false, shoots = false, reloads = false, exports = false, checks = false;
    bool plays = false; ///< or stops
    bool togglesParallel = false;
    std::optional<dvec2> looksFrom;      ///< azimuth and elevation of an axis view
    std::optional<int> seeks;            ///< frame of the time line
    std::string opens;                   ///< path of the cage to show, or empty
    std::string reveals;                 ///< ViewState's
    std::map<std::string, Place> places; ///< of all widgets, by their labels; rows of lists: "label: word"
};

/// Makes all panels of one frame; `size`: of the window in pixels.
PanelWishes makePanels(ViewState& state, const ViewFacts& facts, const ivec2& size);

/// Where panels are: the width of the one at the left edge, and what is left free around them, pixels.
inline constexpr float kPanelWidth = 310, kMargin = 12;

/// Keeps where the latest widget is, under its name. A frame has its label at its right: `frameWidth` is without that.
void keepPlace(PanelWishes& wishes, const std::string& name, float frameWidth = 0);
/// Makes what lies over the picture besides the panel: the time line, messages, the certificate, help.
void makeOverlays(ViewState& state, const ViewFacts& facts, const ivec2& size, PanelWishes& wishes);

/// Draws the cage over the picture: edges in white, creases from yellow to red by sharpness.
void drawCage(const ShownScene& scene, const Camera& camera, const ivec2& size);
/// Draws the divider of a split view and what is on its two sides.
void drawDivider(const ViewState& state, const ivec2& size);

} // namespace relief
