#include "bake/texels.h"

#include <algorithm>
#include <cmath>

#include "displacement/neighbours.h"

namespace relief {
namespace {

constexpr double kSameTexture = 1e-9; ///< texture coordinates nearer than this are the same
constexpr double kOnBorder = 1e-9;    ///< samples that are so little outside of a triangle, by its weights, are inside
constexpr int kInside = -1;           ///< in place of a side

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// How far (u,v) is outside of a face beyond a side, in face coordinates; below 0 inside.
double beyondSide(int sideCount, int side, const dvec2& uv) {
    if (sideCount == 3) return side == 0 ? -uv.y : side == 1 ? uv.x + uv.y - 1 : -uv.x;
    return side == 0 ? -uv.y : side == 1 ? uv.x - 1 : side == 2 ? uv.y - 1 : -uv.x;
}

/// Where along a side a point beside it is: 0..1, or beyond the ends.
double alongSide(int sideCount, int side, const dvec2& uv) {
    const dvec2 first = sidePoint(sideCount, side, 0), way = sidePoint(sideCount, side, 1) - first;
    return glm::dot(uv - first, way) / glm::dot(way, way);
}

/// The direction into a face, across a side, by face coordinates.
dvec2 inward(int sideCount, int side) {
    if (sideCount == 4)
        return side == 0 ? dvec2(0, 1) : side == 1 ? dvec2(-1, 0) : side == 2 ? dvec2(0, -1) : dvec2(1, 0);
    return side == 0 ? dvec2(0, 1) : side == 1 ? dvec2(-0.5, -0.5) : dvec2(1, 0);
}

bool isInFace(int sideCount, const dvec2& uv, double slack) {
    for (int side = 0; side < sideCount; ++side)
        if (beyondSide(sideCount, side, uv) > -slack) return false;
    return true;
}

dvec2 clampToFace(int sideCount, dvec2 uv) {
    uv = glm::clamp(uv, dvec2(0), dvec2(1));
    const double over = uv.x + uv.y - 1;
    if (sideCount == 3 && over > 0) uv = glm::max(uv - 0.5 * over, dvec2(0));
    return uv;
}

std::int64_t floorMod(std::int64_t a, std::int64_t b) { return (a % b + b) % b; }

} // namespace

/// Which face each sample of some rows belongs to.
struct UvTexels::Claims {
    struct Claim {
        std::int32_t face = -1;
        std::int32_t side = kInside; ///< that the sample is beyond
        dvec2 uv{0};
        dvec2 at{0}; ///< the sample's own, before it wraps
    };
    std::int64_t firstRow = 0, rowCount = 0, columnCount = 0;
    std::vector<Claim> claims;
    IslandOverlap overlap;

    void addOverlap(std::int32_t a, std::int32_t b) {
        if (overlap.sampleCount++ == 0) overlap.faces[0] = std::min(a, b), overlap.faces[1] = std::max(a, b);
    }
};

UvTexels::UvTexels(const Surface& surface, const ReferenceSurface& reference, const UvTexelOptions& options)
    : surface_(surface), reference_(reference), options_(options), incidences_(edgeIncidences(surface)) {
    if (!reference.hasTexCoords()) fail(Failure::input, "the surface has no texture coordinates");
    measureFaces();
    findSeams();
}

dvec2 UvTexels::toSamples(const dvec2& st) const {
    const dvec2 size = dvec2(options_.width, options_.height) * double(options_.samplesPerSide);
    const dvec2 own = st - options_.origin;
    return dvec2(own.x, 1 - own.y) * size - 0.5;
}

void UvTexels::measureFaces() {
    constexpr int kSteps = 4;
    const int sideCount = surface_.sideCount;
    extents_.resize(surface_.faces.size());
    for (int face = 0; face < int(extents_.size()); ++face) {
        if (reference_.isHole(face)) continue;
        double area = 0;
        for (int j = 0; j <= kSteps; ++j)
            for (int i = 0; i <= (sideCount == 3 ? kSteps - j : kSteps); ++i) {
                const TexFrame tex = reference_.texture(face, dvec2(i, j) / double(kSteps));
                const dvec2 at = toSamples(tex.st);
                if (!std::isfinite(at.x + at.y)) continue;
                extents_[face].lower = glm::min(extents_[face].lower, at);
                extents_[face].upper = glm::max(extents_[face].upper, at);
                area = std::max(area, std::abs(glm::determinant(tex.jacobian)));
            }
        if (!(area > 1e-14)) flatFaces_.push_back(face);
        // Between the points that were asked the coordinates may bulge a little.
        const dvec2 slack = 0.1 * (extents_[face].upper - extents_[face].lower) + 1.0;
        extents_[face].lower -= slack, extents_[face].upper += slack;
    }
}

/// A side is a seam where the face across it has other texture coordinates, or where there is none.
void UvTexels::findSeams() {
    seamSides_.assign(surface_.faces.size(), 0);
    const auto textureAt = [&](const Incidence& incidence, double t) {
        const double x = std::lerp(double(incidence.start), double(incidence.end), t);
        return reference_.texture(int(incidence.face), sidePoint(surface_.sideCount, int(incidence.side), x)).st;
    };
    for (std::size_t edge = 0; edge < surface_.edges.size(); ++edge) {
        const std::span<const Incidence> around = incidences_.of(edge);
        bool isSeam = around.size() != 2;
        for (const double t : {0.0, 0.5, 1.0})
            isSeam = isSeam || glm::length(textureAt(around[0], t) - textureAt(around[1], t)) > kSameTexture;
        if (!isSeam) continue;
        for (const Incidence& incidence : around) seamSides_[incidence.face] |= std::uint8_t(1u << incidence.side);
    }
}

/// Cells of about eight samples: between their corners the texture is refined.
int UvTexels::stepsOf(int face) const {
    const dvec2 size = extents_[std::size_t(face)].upper - extents_[std::size_t(face)].lower;
    return int(std::clamp(std::ceil(std::max(size.x, size.y) / 8), 2.0, 16.0));
}

/// A grid over the face; of a triangle the lower left half is used.
std::vector<UvTexels::Node> UvTexels::nodesOf(int face, int steps) const {
    std::vector<Node> nodes;
    for (int j = 0; j <= steps; ++j)
        for (int i = 0; i <= steps; ++i) {
            const dvec2 uv = dvec2(i, j) / double(steps);
            const bool isInside = surface_.sideCount == 4 || i + j <= steps;
            nodes.push_back({uv, isInside ? toSamples(reference_.texture(face, uv).st) : dvec2(0)});
        }
    return nodes;
}

void UvTexels::claimFace(int face, Claims& claims) const {
    const int steps = stepsOf(face);
    const std::vector<Node> nodes = nodesOf(face, steps);
    const auto at = [&](int i, int j) -> const Node& {
        return nodes[std::size_t(j) * std::size_t(steps + 1) + std::size_t(i)];
    };
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            if (surface_.sideCount == 3 && i + j >= steps) break;
            claimTriangle({at(i, j), at(i + 1, j), at(i, j + 1)}, face, kInside, claims);
            if (surface_.sideCount == 3 && i + j + 1 >= steps) break;
            claimTriangle({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)}, face, kInside, claims);
        }
}

/// A strip along each seam, as wide as the margin, with a fan around both ends.
void UvTexels::claimMargin(int face, Claims& claims) const {
    const int steps = stepsOf(face), sideCount = surface_.sideCount;
    const double width = options_.margin * options_.samplesPerSide;
    for (int side = 0; side < sideCount; ++side) {
        if ((seamSides_[std::size_t(face)] >> side & 1) == 0) continue;
        const dvec2 in = inward(sideCount, side) / double(2 * steps);
        Node border[2], outer[2];
        for (int i = 0; i <= steps; ++i) {
            const dvec2 uv = sidePoint(sideCount, side, double(i) / steps);
            // Beyond the border the map goes on as it does over the last half step inside, linearly.
            border[1] = {uv, toSamples(reference_.texture(face, uv).st)};
            const dvec2 inner = toSamples(reference_.texture(face, clampToFace(sideCount, uv + in)).st);
            const double share = width / std::max(1e-6, glm::length(border[1].at - inner));
            outer[1] = {uv - share * in, border[1].at + share * (border[1].at - inner)};
            if (i > 0) {
                claimTriangle({border[0], border[1], outer[0]}, face, side, claims);
                claimTriangle({border[1], outer[1], outer[0]}, face, side, claims);
            }
            // Beside the ends the strip goes on, so that the corner of an island has its margin too.
            if (i == 0 || i == steps) {
                const dvec2 beside = sidePoint(sideCount, side, i == 0 ? 0.5 / steps : 1 - 0.5 / steps);
                const dvec2 step = border[1].at - toSamples(reference_.texture(face, beside).st);
                const double reach = width / std::max(1e-6, glm::length(step));
                const dvec2 uvStep = reach * (uv - beside), atStep = reach * step;
                const Node farBorder{uv + uvStep, border[1].at + atStep},
                    farOuter{outer[1].uv + uvStep, outer[1].at + atStep};
                claimTriangle({border[1], farBorder, outer[1]}, face, side, claims);
                claimTriangle({farBorder, farOuter, outer[1]}, face, side, claims);
            }
            border[0] = border[1], outer[0] = outer[1];
        }
    }
}

void UvTexels::claimTriangle(const Node (&corners)[3], int face, int side, Claims& claims) const {
    const dvec2 &a = corners[0].at, b = corners[1].at - a, c = corners[2].at - a;
    const double area = cross(b, c);
    if (!(std::abs(area) > 1e-12)) return;
    const dvec2 low = a + glm::min(dvec2(0), glm::min(b, c)) - kOnBorder,
                high = a + glm::max(dvec2(0), glm::max(b, c)) + kOnBorder;
    const std::int64_t height = std::int64_t(options_.height) * options_.samplesPerSide;
    const bool repeats = options_.wrap == Wrap::repeat;
    // A repeated map is met once per turn in which the triangle comes into these rows.
    const auto firstTurn = repeats ? std::int64_t(std::floor(low.y / double(height))) : 0;
    const auto lastTurn = repeats ? std::int64_t(std::floor(high.y / double(height))) : 0;
    for (std::int64_t turn = firstTurn; turn <= lastTurn; ++turn) {
        const std::int64_t shift = turn * height;
        const auto firstRow = std::max(std::int64_t(std::ceil(low.y)), claims.firstRow + shift);
        const auto lastRow = std::min(std::int64_t(std::floor(high.y)), claims.firstRow + claims.rowCount - 1 + shift);
        for (std::int64_t y = firstRow; y <= lastRow; ++y)
            for (auto x = std::int64_t(std::ceil(low.x)); double(x) <= high.x; ++x) {
                const dvec2 at(x, y), from = at - a;
                // The barycentric coordinates of the sample in texture space are those of its point of the face.
                const double v = cross(from, c) / area, w = cross(b, from) / area;
                if (std::min({v, w, 1 - v - w}) < -kOnBorder) continue;
                if (!repeats && (x < 0 || x >= claims.columnCount)) continue;
                const std::int64_t column = floorMod(x, claims.columnCount);
                Claims::Claim& claim =
                    claims.claims[std::size_t((y - shift - claims.firstRow) * claims.columnCount + column)];
                const dvec2 uv = (1 - v - w) * corners[0].uv + v * corners[1].uv + w * corners[2].uv;
                const int sideCount = surface_.sideCount;
                // Insides win over margins; of margins the one nearest to its face wins. Two insides overlap.
                if (side == kInside) {
                    constexpr double kSlack = 0.02; // neighbours touch, and cells are straight where borders bend
                    if (claim.face < 0)
                        claim = {face, kInside, uv, at};
                    else if (claim.face != face && isInFace(sideCount, uv, kSlack) &&
                             isInFace(sideCount, claim.uv, kSlack))
                        claims.addOverlap(claim.face, face);
                } else if (claim.face < 0 ||
                           (claim.side != kInside &&
                            beyondSide(sideCount, side, uv) < beyondSide(sideCount, claim.side, claim.uv))) {
                    claim = {face, side, uv, at};
                }
            }
    }
}

void UvTexels::listSamples(int first, int count, std::vector<TexelSample>& samples) const {
    const int n = options_.samplesPerSide;
    Claims claims{.firstRow = std::int64_t(first) * n,
                  .rowCount = std::int64_t(count) * n,
                  .columnCount = std::int64_t(options_.width) * n,
                  .claims = {},
                  .overlap = {}};
    claims.claims.resize(std::size_t(claims.rowCount * claims.columnCount));

    // Faces whose box, with its margin, comes into these rows; of repeated maps any turn of it.
    const double margin = 2 * options_.margin * n + 1, height = double(options_.height) * n;
    const double low = double(claims.firstRow) - margin, high = double(claims.firstRow + claims.rowCount) + margin;
    std::vector<int> faces;
    for (int face = 0; face < int(extents_.size()); ++face) {
        const Extent& extent = extents_[std::size_t(face)];
        if (extent.lower.y > extent.upper.y) continue;
        double turn = 0;
        if (options_.wrap == Wrap::repeat) turn = std::ceil((extent.lower.y - high) / height);
        if (extent.upper.y >= low + turn * height && extent.lower.y <= high + turn * height) faces.push_back(face);
    }
    // Insides first: a margin takes only what no inside has.
    for (const int face : faces) claimFace(face, claims);
    for (const int face : faces)
        if (seamSides_[std::size_t(face)] != 0) claimMargin(face, claims);
    for (std::int64_t row = 0; row < claims.rowCount; ++row)
        for (std::int64_t column = 0; column < claims.columnCount; ++column)
            addSample(claims, std::size_t(row * claims.columnCount + column), first, samples);

    // Blocks of rows run in parallel: of overlaps the pair with the least numbers is kept, whatever the order.
    if (claims.overlap.sampleCount == 0) return;
    const std::lock_guard lock(mutex_);
    if (overlap_.sampleCount == 0 ||
        std::pair(claims.overlap.faces[0], claims.overlap.faces[1]) < std::pair(overlap_.faces[0], overlap_.faces[1]))
        std::ranges::copy(claims.overlap.faces, overlap_.faces);
    overlap_.sampleCount += claims.overlap.sampleCount;
}

TexelNeighbours UvTexels::neighboursOf(std::uint32_t texel) const {
    const int x = int(texel % std::uint32_t(options_.width)), y = int(texel / std::uint32_t(options_.width));
    const auto at = [&](int column, int row) {
        return std::uint32_t(std::size_t(row) * std::size_t(options_.width) + std::size_t(column));
    };
    TexelNeighbours neighbours;
    for (const std::uint32_t other :
         {at(beside(x, -1, options_.width, options_.wrap), y), at(beside(x, 1, options_.width, options_.wrap), y),
          at(x, beside(y, -1, options_.height, options_.wrap)), at(x, beside(y, 1, options_.height, options_.wrap))})
        if (other != texel) neighbours.add(other);
    return neighbours;
}

IslandOverlap UvTexels::overlap() const {
    const std::lock_guard lock(mutex_);
    return overlap_;
}

/// Newton's method: the point of the face whose texture coordinates are those of the sample.
dvec2 UvTexels::refine(int face, dvec2 uv, const dvec2& at) const {
    constexpr int kMostSteps = 3;
    constexpr double kClose = 1e-4; // samples
    const dvec2 size = dvec2(options_.width, options_.height) * double(options_.samplesPerSide);
    for (int step = 0; step < kMostSteps; ++step) {
        const TexFrame tex = reference_.texture(face, uv);
        const dvec2 off = toSamples(tex.st) - at;
        const double determinant = glm::determinant(tex.jacobian);
        if (std::abs(off.x) + std::abs(off.y) < kClose || std::abs(determinant) < 1e-14) break;
        const dvec2 st = dvec2(off.x, -off.y) / size;
        const dvec2 move(cross(st, tex.jacobian[1]) / determinant, cross(tex.jacobian[0], st) / determinant);
        if (!(glm::length(move) < 0.25)) break; // too far from where the grid put it
        uv = clampToFace(surface_.sideCount, uv - move);
    }
    return uv;
}

void UvTexels::addSample(const Claims& claims, std::size_t index, int firstTexelRow,
                         std::vector<TexelSample>& samples) const {
    const Claims::Claim& claim = claims.claims[index];
    if (claim.face < 0) return;
    const auto n = std::size_t(options_.samplesPerSide);
    const std::size_t row = index / std::size_t(claims.columnCount), column = index % std::size_t(claims.columnCount);
    TexelSample sample{
        .texel = std::uint32_t((std::size_t(firstTexelRow) + row / n) * std::size_t(options_.width) + column / n),
        .face = claim.face};
    if (claim.side != kInside) {
        sample.isInside = false;
        return addBeyond(claim.face, claim.side, claim.uv, sample, samples);
    }
    sample.uv = vec2(refine(claim.face, clampToFace(surface_.sideCount, claim.uv), claim.at));
    samples.push_back(sample);
}

/// The point of the neighbour that lies as far beyond a side as (u,v) does, in the units of the surface. It is outside
/// of the neighbour where (u,v) is beyond an end of the side.
std::optional<UvTexels::FacePoint> UvTexels::crossSide(int face, int side, const dvec2& uv) const {
    const int sideCount = surface_.sideCount;
    const double raw = alongSide(sideCount, side, uv), along = std::clamp(raw, 0.0, 1.0);
    const double beyond = std::max(0.0, beyondSide(sideCount, side, uv));
    const std::uint32_t entry = surface_.faces[std::size_t(face)].sides[side];
    for (std::uint32_t piece = 0; piece < ((entry & kSideSplit) != 0 ? 2u : 1u); ++piece) {
        const std::span<const Incidence> around = incidences_.of((entry & kSideEdgeMask) + piece);
        if (around.size() != 2) continue;
        const bool isFirst = around[0].face == std::uint32_t(face) && int(around[0].side) == side;
        const Incidence &own = around[isFirst ? 0 : 1], &other = around[isFirst ? 1 : 0];
        const double start = own.start, length = double(own.end) - start, t = (along - start) / length;
        constexpr double kSlack = 1e-6;
        if (t < -kSlack || t > 1 + kSlack) continue;
        const auto onOther = [&](double at) {
            const double x = std::lerp(double(other.start), double(other.end), (at - start) / length);
            return sidePoint(sideCount, int(other.side), x);
        };
        // How fast both faces run away from the edge.
        const dvec2 in = inward(sideCount, int(other.side)), out = -inward(sideCount, side);
        const LimitFrame here = reference_.limit(face, sidePoint(sideCount, side, along)),
                         there = reference_.limit(int(other.face), clampToFace(sideCount, onOther(along)));
        const double speed = glm::length(out.x * here.pu + out.y * here.pv),
                     speedThere = glm::length(in.x * there.pu + in.y * there.pv);
        constexpr double kMostScale = 4, kFarthest = 0.5; // of a face: what is farther away is elsewhere
        const double scale = speedThere > 1e-12 * speed ? std::min(speed / speedThere, kMostScale) : 1;
        return FacePoint{int(other.face), onOther(raw) + std::min(beyond * scale, kFarthest) * in};
    }
    return {};
}

/// Across the edge lies the same surface. Without a face there the heights go on linearly: h(e) = 2 h(0) - h(-e).
void UvTexels::addBeyond(int face, int side, const dvec2& uv, const TexelSample& base,
                         std::vector<TexelSample>& samples) const {
    const int sideCount = surface_.sideCount;
    const auto addAt = [&](const FacePoint& point, float weight) {
        TexelSample sample = base;
        sample.face = point.face, sample.uv = vec2(clampToFace(sideCount, point.uv)), sample.weight = weight;
        samples.push_back(sample);
    };
    if (std::optional<FacePoint> point = crossSide(face, side, uv)) {
        // Beyond an end of the side a second one is crossed, if there is a face.
        int farthest = 0;
        for (int other = 1; other < sideCount; ++other)
            if (beyondSide(sideCount, other, point->uv) > beyondSide(sideCount, farthest, point->uv)) farthest = other;
        if (beyondSide(sideCount, farthest, point->uv) > 0)
            point = crossSide(point->face, farthest, point->uv).value_or(*point);
        return addAt(*point, 1);
    }
    const dvec2 border = sidePoint(sideCount, side, std::clamp(alongSide(sideCount, side, uv), 0.0, 1.0));
    const dvec2 in = inward(sideCount, side);
    constexpr double kBesideBorder = 1e-4, kFarthest = 0.5; // where a sculpt may end as well
    const double beyond = std::max(0.0, beyondSide(sideCount, side, uv));
    addAt({face, border + kBesideBorder * in}, 2);
    addAt({face, border + std::min(kBesideBorder + beyond, kFarthest) * in}, -1);
}

} // namespace relief
