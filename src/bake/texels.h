// Where the samples of a map's texels lie on a surface.
#pragma once

#include <array>
#include <mutex>
#include <optional>

#include "displacement/displacement.h"

namespace relief {

/// One sample of a texel: a point of a face, and how much it counts. The height of a texel is the sum of weight times
/// height over the sum of the weights, of its samples that meet the sculpt.
struct TexelSample {
    std::uint32_t texel = 0; ///< row * width + column, rows from the top
    std::int32_t face = 0;
    vec2 uv{0};
    float weight = 1;
    bool isInside = true; ///< false beyond the borders of islands, in the margin that bilinear lookups need
};

/// Texels beside a texel.
struct TexelNeighbours {
    std::uint32_t count = 0;
    std::array<std::uint32_t, 4> texels{};

    void add(std::uint32_t texel) { texels[count++] = texel; }
};

/// The texels of a map. Several threads list samples of different rows at a time.
class TexelSource {
public:
    virtual ~TexelSource() = default;
    [[nodiscard]] virtual int width() const = 0;
    [[nodiscard]] virtual int height() const = 0;
    /// Appends the samples of rows first..first+count-1: the same ones, in the same order, in every run.
    virtual void listSamples(int first, int count, std::vector<TexelSample>& samples) const = 0;
    /// The texels around one, four at most, in the same order in every run.
    [[nodiscard]] virtual TexelNeighbours neighboursOf(std::uint32_t texel) const = 0;
    /// True where texels that are neighbours in rows and columns are neighbours on the surface, but for islands.
    [[nodiscard]] virtual bool isPicture() const { return true; }
};

/// The unit squares of texture coordinates that faces lie in, row after row from the lowest (s,t) on: MapTile::place of
/// the tiles of a set.
std::vector<ivec2> findTilesOfFaces(const ReferenceSurface& reference);

/// Islands of texture coordinates that lie over each other.
struct IslandOverlap {
    std::uint64_t sampleCount = 0;
    std::int32_t faces[2] = {0, 0}; ///< the two with the lowest numbers
};

struct UvTexelOptions {
    int width = 1024, height = 1024;
    int samplesPerSide = 1;   ///< of a texel: its samples are a grid of so many rows and columns
    double margin = 2;        ///< texels beyond the border of an island that get samples
    Wrap wrap = Wrap::repeat; ///< what lies outside of the map
    dvec2 origin{0};          ///< (s,t) of the map's lower left corner: the tile of a set of maps
};

/// The texels under the texture coordinates of a surface. A sample that no face covers, but whose distance from the
/// border of an island is within the margin, lies on the face across that edge of the surface, as far from the edge:
/// texels on both sides of a seam show the same surface. At a boundary of the surface two samples continue heights
/// linearly. Where islands lie over each other the face with the lowest number counts.
class UvTexels : public TexelSource {
public:
    /// The surfaces have to outlive it and must be of one cage. Throws Failure::input for a surface without texture
    /// coordinates.
    UvTexels(const Surface& surface, const ReferenceSurface& reference, const UvTexelOptions& options);

    [[nodiscard]] int width() const override { return options_.width; }
    [[nodiscard]] int height() const override { return options_.height; }
    void listSamples(int first, int count, std::vector<TexelSample>& samples) const override;
    [[nodiscard]] TexelNeighbours neighboursOf(std::uint32_t texel) const override;
    /// Of all samples listed so far.
    [[nodiscard]] IslandOverlap overlap() const;
    /// Faces whose texture coordinates have no area, so that no texel shows them.
    [[nodiscard]] const std::vector<std::int32_t>& flatFaces() const { return flatFaces_; }

private:
    struct Node {
        dvec2 uv, at; ///< `at`: in samples, from the centre of the first one
    };
    struct Claims;

    [[nodiscard]] dvec2 toSamples(const dvec2& st) const;
    void measureFaces();
    void findSeams();
    [[nodiscard]] std::vector<Node> nodesOf(int face, int steps) const;
    [[nodiscard]] int stepsOf(int face) const;
    void claimFace(int face, Claims& claims) const;
    void claimMargin(int face, Claims& claims) const;
    void claimTriangle(const Node (&corners)[3], int face, int side, Claims& claims) const;
    void addSample(const Claims& claims, std::size_t index, int row, std::vector<TexelSample>& samples) const;
    struct FacePoint {
        int face;
        dvec2 uv;
    };
    [[nodiscard]] std::optional<FacePoint> crossSide(int face, int side, const dvec2& uv) const;
    void addBeyond(int face, int side, const dvec2& uv, const TexelSample& base,
                   std::vector<TexelSample>& samples) const;
    [[nodiscard]] dvec2 refine(int face, dvec2 uv, const dvec2& st) const;

    const Surface& surface_;
    const ReferenceSurface& reference_;
    UvTexelOptions options_;
    EdgeIncidences incidences_;
    struct Extent {
        dvec2 lower{1e300}, upper{-1e300}; ///< in samples
    };
    std::vector<Extent> extents_;         ///< by face
    std::vector<std::uint8_t> seamSides_; ///< by face: bit per side
    std::vector<std::int32_t> flatFaces_;
    mutable std::mutex mutex_;
    mutable IslandOverlap overlap_;
};

} // namespace relief
