// The tables of a surface in the bits of shared/records.h.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <span>

#include "model/records.h"

namespace relief {
namespace {

constexpr std::uint32_t kMostFaces = 1u << 28, kMostCorners = 1u << 30, kMostEdgeIncidences = 1u << 24;

void append(std::vector<std::uint32_t>& words, std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t w) {
    words.insert(words.end(), {x, y, z, w});
}

/// face:28 side:2 flags:2
std::uint32_t ownerWord(const Incidence& owner, std::uint32_t flags) {
    return owner.face | owner.side << 28 | flags << 30;
}

std::uint32_t spanOf(const Incidence& owner) {
    if (owner.start == 0 && owner.end == 1) return kSpanWhole;
    if (owner.start == 0 && owner.end == 0.5f) return kSpanFirstHalf;
    if (owner.start == 0.5f && owner.end == 1) return kSpanSecondHalf;
    fail(Failure::internal, "an edge goes from {} to {} of its owner's side", owner.start, owner.end);
}

std::uint32_t partnerOf(const Surface& surface, std::uint32_t edge) {
    const std::uint32_t partner = surface.edges[edge].partner;
    if (partner == edge) return kPartnerNone;
    if (partner == edge + 1) return kPartnerNext;
    if (partner + 1 == edge) return kPartnerBefore;
    fail(Failure::internal, "edge {} has its other half at {}", edge, partner);
}

void appendEdges(std::vector<std::uint32_t>& words, const Surface& surface) {
    for (std::uint32_t i = 0; i < surface.edges.size(); ++i) {
        const Edge& edge = surface.edges[i];
        append(words, ownerWord(edge.owner, edge.flags), edge.corners[0] | spanOf(edge.owner) << 30,
               edge.corners[1] | partnerOf(surface, i) << 30,
               edge.incidenceCount > 0 ? edge.firstIncidence : kNoIncidence);
    }
}

void appendCorners(std::vector<std::uint32_t>& words, const Surface& surface) {
    for (const Corner& corner : surface.corners)
        append(words, ownerWord(corner.owner, corner.flags),
               (corner.owner.start > 0 ? 1 : 0) | corner.incidenceCount << 1, corner.firstIncidence, 0);
}

void appendIncidences(std::vector<std::uint32_t>& words, const Surface& surface) {
    std::vector<std::uint32_t> counts = surface.sectorFaces;
    for (const Edge& edge : surface.edges)
        if (edge.incidenceCount > 0) counts[edge.firstIncidence] = edge.incidenceCount;
    for (std::size_t i = 0; i < surface.incidences.size(); ++i) {
        const Incidence& incidence = surface.incidences[i];
        append(words, incidence.face, incidence.side | counts[i] << 8, std::bit_cast<std::uint32_t>(incidence.start),
               std::bit_cast<std::uint32_t>(incidence.end));
    }
}

/// The records of patches and the indices of their control points; those of each patch begin at a whole texel.
class PatchWriter {
public:
    /// `firstCapTexel`: where the weights of exact caps begin.
    PatchWriter(const Surface& surface, std::uint32_t firstCapTexel)
        : surface_(surface), firstCapTexel_(firstCapTexel) {
        for (const Patch& patch : surface.patches)
            isWide_ = isWide_ || isFar(pointsOf(patch)) || isFar(texPointsOf(patch));
    }

    [[nodiscard]] bool isWide() const { return isWide_; }

    /// Appends the patches, and after them the indices of their control points.
    void append(std::vector<std::uint32_t>& words) const {
        auto texel = std::uint32_t(words.size() / 4 + surface_.patches.size());
        for (const Patch& patch : surface_.patches) {
            const PointIndices points = pointsOf(patch), texPoints = texPointsOf(patch);
            const std::uint32_t texels = texelsOf(points);
            // An exact cap has a texel before its indices.
            const std::uint32_t header = isExact(patch.type) ? 1 : 0, texHeader = isExact(patch.texType) ? 1 : 0;
            const std::uint32_t texelsToTexture = texels + texHeader;
            RELIEF_CHECK(texelsToTexture < 64);
            texel += header;
            relief::append(words, texel, baseOf(points), baseOf(texPoints),
                           patch.type | patch.texType << 4 | (patch.param1 >> 7 & 31) << 8 |
                               (patch.texParam1 >> 7 & 31) << 13 | texelsToTexture << 18 | patch.straightCorners << 24);
            texel += texelsToTexture + texelsOf(texPoints);
        }
        for (const Patch& patch : surface_.patches) {
            if (isExact(patch.type)) appendCap(words, patch.cap);
            appendIndices(words, pointsOf(patch));
            if (isExact(patch.texType)) appendCap(words, surface_.texCaps[&patch - surface_.patches.data()]);
            appendIndices(words, texPointsOf(patch));
        }
    }

private:
    using PointIndices = std::span<const std::uint32_t>;

    [[nodiscard]] PointIndices pointsOf(const Patch& patch) const {
        const int cornerPoints = 2 * std::popcount(patch.straightCorners);
        return PointIndices(surface_.patchPoints).subspan(patch.firstPoint, patch.pointCount + cornerPoints);
    }
    [[nodiscard]] PointIndices texPointsOf(const Patch& patch) const {
        if (!surface_.hasTexCoords()) return {};
        return PointIndices(surface_.texPatchPoints).subspan(patch.texFirstPoint, patch.texPointCount);
    }
    static bool isExact(std::uint32_t type) { return type == kPatchExactQuad || type == kPatchExactTriangle; }
    void appendCap(std::vector<std::uint32_t>& words, std::uint32_t cap) const {
        const CapTable& table = surface_.capTables[cap / 4];
        relief::append(words, firstCapTexel_ + table.firstWeight / 4, table.pointCount, cap % 4, 0);
    }
    static bool isFar(const PointIndices& indices) {
        if (indices.empty()) return false;
        const auto [lowest, highest] = std::ranges::minmax(indices);
        return highest - lowest > 0xffff;
    }
    [[nodiscard]] std::uint32_t baseOf(const PointIndices& indices) const {
        return isWide_ || indices.empty() ? 0 : std::ranges::min(indices);
    }
    [[nodiscard]] std::uint32_t texelsOf(const PointIndices& indices) const {
        const std::size_t perTexel = isWide_ ? 4 : 8;
        return std::uint32_t((indices.size() + perTexel - 1) / perTexel);
    }
    void appendIndices(std::vector<std::uint32_t>& words, const PointIndices& indices) const {
        const std::size_t first = words.size();
        const std::uint32_t base = baseOf(indices);
        words.resize(first + 4 * std::size_t(texelsOf(indices)), 0);
        for (std::size_t k = 0; k < indices.size(); ++k) {
            if (isWide_)
                words[first + k] = indices[k];
            else
                words[first + k / 2] |= (indices[k] - base) << (16 * (k % 2));
        }
    }

    const Surface& surface_;
    std::uint32_t firstCapTexel_;
    bool isWide_ = false;
};

} // namespace

SurfaceRecords recordsOf(const Surface& surface) {
    const auto mostIncidences = [](std::uint32_t most, const Edge& edge) {
        return std::max(most, edge.incidenceCount);
    };
    // Numbers share words with flags: more would run into them.
    if (surface.faces.size() >= kMostFaces || surface.corners.size() >= kMostCorners ||
        std::accumulate(surface.edges.begin(), surface.edges.end(), 0u, mostIncidences) >= kMostEdgeIncidences)
        fail(Failure::input,
             "a surface of {} faces and {} corners is more than {} faces, {} corners or {} faces per edge",
             surface.faces.size(), surface.corners.size(), kMostFaces, kMostCorners, kMostEdgeIncidences);

    // One table of words: the records of each kind begin at a texel that shaders get as an input.
    SurfaceRecords records;
    std::vector<std::uint32_t>& words = records.words;
    const auto texel = [&] { return std::uint32_t(words.size() / 4); };
    records.firstFace = appendRecords<kFaceTexels>(words, surface.faces);
    // Patches name the weights of their caps, which therefore come before them.
    const std::uint32_t firstCapTexel = texel();
    for (const float weight : surface.capWeights) words.push_back(std::bit_cast<std::uint32_t>(weight));
    const PatchWriter patches(surface, firstCapTexel);
    records.firstPatch = texel();
    records.hasWideIndices = patches.isWide();
    patches.append(words);
    records.hasStraightCorners =
        std::ranges::any_of(surface.patches, [](const Patch& p) { return p.straightCorners != 0; });
    for (const Patch& patch : surface.patches) {
        records.patchTypes |= 1u << patch.type;
        if (surface.hasTexCoords()) records.patchTypes |= 1u << patch.texType;
    }
    records.firstEdge = texel();
    appendEdges(words, surface);
    records.firstCorner = texel();
    appendCorners(words, surface);
    records.firstIncidence = texel();
    appendIncidences(words, surface);
    return records;
}

vec4 packPoint(const dvec3& point) {
    const vec3 nearest(point);
    const vec3 sizes = glm::abs(nearest);
    const int exponent = std::ilogb(std::max({sizes.x, sizes.y, sizes.z, 0x1p-63F}));
    const dvec3 remainder = (point - dvec3(nearest)) / std::ldexp(double(kRemainderStep), exponent);
    const glm::uvec3 steps(glm::clamp(glm::round(remainder) + 512.0, 12.0, 1012.0));
    return vec4(nearest, std::bit_cast<float>(steps.x | steps.y << 10 | steps.z << 20));
}

} // namespace relief
