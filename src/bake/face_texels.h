// The nodes of a map per face.
#pragma once

#include "bake/texels.h"

namespace relief {

struct FaceTexelOptions {
    std::vector<ivec2> segments; ///< per face: MapTile::segments
    int samplesPerSide = 1;      ///< of the square around a node that it stands for
};

/// The nodes of a map per face as texels: face after face, row after row from v = 0, in rows of a picture that means
/// nothing. A node inside of a face has a grid of samples around it, one on a side samples along the side, and one in a
/// corner a single sample: faces agree on what they share. Holes have none.
class FaceTexels : public TexelSource {
public:
    /// The surfaces have to outlive it and must be of one cage. Throws as linkFaces does, and Failure::input for more
    /// than 2^31 nodes.
    FaceTexels(const Surface& surface, const ReferenceSurface& reference, FaceTexelOptions options);

    [[nodiscard]] int width() const override { return width_; }
    [[nodiscard]] int height() const override { return height_; }
    void listSamples(int first, int count, std::vector<TexelSample>& samples) const override;
    [[nodiscard]] TexelNeighbours neighboursOf(std::uint32_t texel) const override;
    [[nodiscard]] bool isPicture() const override { return false; }

    [[nodiscard]] const std::vector<ivec2>& segments() const { return options_.segments; }
    /// The texel of the node nearest to a point of a face.
    [[nodiscard]] std::uint32_t texelAt(int face, const dvec2& uv) const;

private:
    [[nodiscard]] ivec2 countOf(std::size_t face) const; ///< segments along u and v
    [[nodiscard]] std::size_t faceOf(std::uint32_t texel) const;
    void addNode(int face, const ivec2& node, std::uint32_t texel, std::vector<TexelSample>& samples) const;
    void addAcross(std::size_t face, int side, double x, TexelNeighbours& neighbours) const;

    const ReferenceSurface& reference_;
    FaceTexelOptions options_;
    FaceLinks links_;
    std::vector<std::uint32_t> firsts_; ///< per face, and the end
    int width_ = 0, height_ = 0;
};

/// Chooses segments of all faces that are about as long as `length`, in the unit of the surface: powers of two, at most
/// 2^12 a side.
std::vector<ivec2> chooseSegments(const ReferenceSurface& reference, double length);

/// The area of the limit surface without holes.
double computeArea(const ReferenceSurface& reference);

} // namespace relief
