// Draws the frames of a cage that moves, or that the camera turns around.
#pragma once

#include "app/picture_options.h"
#include "pose/pose.h"

namespace relief::app {

/// What the pictures of an animation show.
struct AnimationArgs {
    SceneDesc scene;
    PictureArgs picture;
    std::string frames;     ///< a list for parseFrames; empty: all keys, or one turn
    int turntableCount = 0; ///< frames of one turn of the camera; 0: it stands still
};

/// The time of a frame: frame k is at k / fps seconds.
double toSeconds(int frame, const MotionDesc& motion);

/// The frames that are asked for, else all from the first key to the last, or one turn. Throws Failure::usage where
/// nothing moves and Failure::input where keys are so late that their frames have no numbers.
std::vector<int> listFrames(const AnimationArgs& args, const Animation* animation);

/// A finished picture and what posing took.
struct DrawnFrame {
    int frame = 0;
    Picture picture;
    std::uint64_t uploadedBytes = 0;
    double poseMs = 0;
};

/// Draws any frame of an animation, the same way whatever was drawn before it.
class FrameMaker {
public:
    /// Loads the scene and opens the device. The arguments have to outlive it.
    FrameMaker(const AnimationArgs& args, const Warn& warn);

    [[nodiscard]] const std::vector<int>& frames() const { return frames_; }
    [[nodiscard]] const Device& device() const { return *device_; }
    DrawnFrame draw(int frame);
    /// Says why there is nothing to see in a frame; empty where there is something.
    [[nodiscard]] std::string findComplaint(const DrawnFrame& drawn) const;

private:
    [[nodiscard]] std::vector<double> measuredTimes() const;
    void placeScene();
    void makeModel();
    [[nodiscard]] Bounds boundsNow() const;
    [[nodiscard]] CameraOptions cameraAt(int frame) const;
    [[nodiscard]] RenderOptions optionsAt(int frame) const;
    [[nodiscard]] Pose poseAt(int frame) const;
    void posePolygons(int frame, DrawnFrame& drawn);

    const AnimationArgs& args_;
    Warn warn_;
    bool hasWarned_ = false; ///< of long segments, in any frame
    std::vector<int> frames_;
    LoadedScene loaded_;
    CameraOptions camera_;                   ///< holds all poses; in the object's coordinates
    Bounds bounds_;                          ///< of the object in all poses
    std::optional<MovingPolygons> polygons_; ///< polygons that move, instead of a surface
    Bounds polygonBounds_;                   ///< in the pose that is drawn
    bool isDense_ = false;
    std::unique_ptr<Device> device_;
    std::optional<GpuEnvironment> environment_; ///< default: the built-in studio
    std::optional<GpuMatcap> matcap_;           ///< default: of the object's own material and lights
    std::unique_ptr<Model> model_;
    std::unique_ptr<Poser> poser_;
    std::unique_ptr<MeshPoser> meshPoser_; ///< of the polygons
    std::unique_ptr<Renderer> renderer_;
};

} // namespace relief::app
