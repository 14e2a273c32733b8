// Internal: a loaded scene, first on the host, then on the device, and its pictures.
#pragma once

#include "pose/pose.h"
#include "view/view.h"

namespace relief {

/// What needs no device: it may be made on another thread while a picture is drawn.
struct Prepared {
    Look look;
    LoadedScene loaded;
    std::vector<int> frames;   ///< of an object that moves; empty for one that stands still
    std::vector<dvec3> points; ///< that outline the object; empty where its height function is not measured yet
    std::vector<std::string> warnings;
};

/// Reads the files of `look`. Throws as load() does.
Prepared prepareScene(const ViewDesc& desc, const Look& look);

/// Measures the height function, which the device alone knows, and with it the outline. Throws as measureFunction().
void measure(Device& device, Prepared& prepared);

/// What pipelines with a height function are made for.
struct PipelineKey {
    std::uint32_t function = 0; ///< HeightFunction::number(), or 0
    Detail detail{};
    std::string cage; ///< its path: pipelines have the kinds of its patches

    bool operator==(const PipelineKey&) const = default;
};
PipelineKey keyOf(const Prepared& prepared);

/// `look` with what files and surfaces are made of as in `loaded`: what can be drawn before they are read anew.
Look withFilesOf(const Look& loaded, const Look& look);

/// An edge of the cage for the overlay.
struct CageEdge {
    std::uint32_t a = 0, b = 0; ///< positions
    float sharpness = 0;        ///< of a crease; 0 elsewhere
};
/// Every edge of the cage once.
std::vector<CageEdge> listCageEdges(const Cage& cage);

/// A scene on the device. The pictures are those of `relief render`, and of `relief animate` where the object moves.
class ShownScene {
public:
    /// Throws as the functions of module scene that measure a height function and make a model.
    ShownScene(Device& device, const ViewDesc& desc, Prepared prepared);

    [[nodiscard]] const Look& look() const { return look_; } ///< that its files were read for
    [[nodiscard]] const PipelineKey& pipelineKey() const { return key_; }
    [[nodiscard]] double mid() const { return mid_; } ///< the stored height that displaces nothing
    [[nodiscard]] bool isMoving() const { return !frames_.empty(); }
    [[nodiscard]] const std::vector<int>& frames() const { return frames_; }
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
    [[nodiscard]] const Cage& cage() const { return loaded_.object.cage; }
    [[nodiscard]] const Coordinates& coordinates() const { return loaded_.object.coordinates(); }
    [[nodiscard]] const std::vector<CageEdge>& edges() const { return edges_; }
    /// Cage points of the pose that was drawn last, in the object's coordinates.
    [[nodiscard]] const std::vector<vec3>& cagePoints() const { return cagePoints_; }
    [[nodiscard]] std::uint64_t modelBytes() const { return byteCountOf(*model_); }
    [[nodiscard]] std::uint64_t mapBytes() const; ///< of modelBytes(): heights, slopes, colours and normals
    [[nodiscard]] std::uint64_t uploadedBytes() const { return uploadedBytes_; } ///< for the latest pose
    [[nodiscard]] double poseMs() const { return poseMs_; }

    /// The camera of a picture of that size, in the object's coordinates.
    [[nodiscard]] Camera makeCamera(const Look& look, const ivec2& size) const;
    /// Draws a picture of the size that `renderer` makes. `rateCamera`: what rates are measured from, where that is not
    /// the camera. Of `look` the object and the environment are those that it was made for.
    Picture draw(Renderer& renderer, const Look& look, const ivec2& size, const std::optional<Camera>& rateCamera = {});

private:
    void poseAt(int frame);
    [[nodiscard]] Bounds boundsNow() const;
    [[nodiscard]] double secondsOf(int frame) const;

    Device& device_;
    const ViewDesc& desc_;
    Look look_;
    PipelineKey key_;
    double mid_ = 0;
    LoadedScene loaded_;
    std::vector<int> frames_;
    std::vector<dvec3> points_;
    std::vector<std::string> warnings_;
    std::vector<CageEdge> edges_;
    std::vector<vec3> cagePoints_;
    std::optional<MovingPolygons> polygons_;
    Bounds polygonBounds_;
    std::optional<GpuEnvironment> environment_;
    std::optional<GpuMatcap> matcap_;
    std::unique_ptr<Model> model_;
    std::unique_ptr<Poser> poser_;
    std::unique_ptr<MeshPoser> meshPoser_;
    std::optional<int> posedFrame_;
    std::uint64_t uploadedBytes_ = 0;
    double poseMs_ = 0;
};

} // namespace relief
