#include "distance/closest.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relief {
namespace {

struct Query {
    const ClosestPoints* points;
    dvec3 p;
    double squared; ///< of the shortest distance so far
    double slack;   ///< Embree searches around a rounded point
    NearestPoint nearest;
};

/// A radius that, rounded to float, still contains everything that is nearer.
float radiusOf(double distance) { return float(distance) * 1.000001f + std::numeric_limits<float>::min(); }

bool visitTriangle(RTCPointQueryFunctionArguments* arguments) {
    Query& query = *static_cast<Query*>(arguments->userPtr);
    const std::uint32_t* corner = &query.points->indices()[3 * std::size_t(arguments->primID)];
    const auto at = [&](std::uint32_t i) { return dvec3(query.points->positions()[corner[i]]); };
    const dvec3 point = nearestInTriangle(query.p, at(0), at(1), at(2)), away = query.p - point;
    const double squared = glm::dot(away, away);
    if (squared >= query.squared) return false;
    query.squared = squared, query.nearest = {point, arguments->primID};
    arguments->query->radius = std::min(arguments->query->radius, radiusOf(std::sqrt(squared) + query.slack));
    return true;
}

/// Searches within a limit around a point.
Query ask(RTCScene scene, const ClosestPoints& points, const dvec3& p, double limit) {
    RTCPointQuery at{};
    at.x = float(p.x), at.y = float(p.y), at.z = float(p.z);
    const double slack = glm::length(p - dvec3(at.x, at.y, at.z));
    at.radius = radiusOf(limit + slack);
    Query query{&points, p, std::numeric_limits<double>::infinity(), slack, {}};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &at, &context, nullptr, &query);
    return query;
}

/// A line, and the nearest hit so far. Embree calls back with each triangle that it meets.
struct LineQuery : RTCIntersectContext {
    const ClosestPoints* points = nullptr;
    dvec3 p{0}, direction{0};
    LineReach reach;
    Facing facing = Facing::front;
    LineHit best{.height = kNowhere};
    double nearestBack[2] = {kNowhere,
                             kNowhere}; ///< to triangles that may not be met, along the direction and against it
    bool hasHit = false;

    static constexpr double kNowhere = std::numeric_limits<double>::infinity();
};

/// Decides about a triangle in double precision: Embree's own distance is as coarse as its floats.
void takeHit(const RTCFilterFunctionNArguments* arguments) {
    if (arguments->valid[0] == 0) return;
    arguments->valid[0] = 0; // rejected, unless it is the nearest so far
    LineQuery& query = static_cast<LineQuery&>(*arguments->context);
    const unsigned int triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
    const std::uint32_t* corner = &query.points->indices()[3 * std::size_t(triangle)];
    const auto at = [&](std::uint32_t i) { return dvec3(query.points->positions()[corner[i]]); };
    const dvec3 a = at(0), normal = glm::cross(at(1) - a, at(2) - a);
    const double slope = glm::dot(normal, query.direction);
    if (slope == 0) return;
    const double height = glm::dot(normal, a - query.p) / slope, distance = std::abs(height);
    if (!(height <= query.reach.front && -height <= query.reach.back)) return;
    if (query.facing != Facing::any && (slope > 0) != (query.facing == Facing::front)) {
        double& nearest = query.nearestBack[height >= 0 ? 0 : 1];
        nearest = std::min(nearest, distance);
        return;
    }
    // At one distance the triangle with the lowest number stays, so that the result does not depend on the tree.
    const bool isNearer = distance < std::abs(query.best.height) ||
                          (distance == std::abs(query.best.height) && triangle < query.best.triangle);
    if (!isNearer) return;
    query.best.height = height, query.best.triangle = triangle;
    query.hasHit = true;
    arguments->valid[0] = -1;
}

void checkTriangles(const TriangleView& triangles) {
    for (std::size_t i = 0; i < triangles.positions.size(); ++i) {
        const vec3& p = triangles.positions[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            fail(Failure::input, "vertex {} of the surface is not finite", i);
    }
    for (std::size_t i = 0; i < triangles.indices.size(); ++i)
        if (triangles.indices[i] >= triangles.positions.size())
            fail(Failure::input, "triangle {} of the surface names vertex {}; vertices 0 to {} exist", i / 3,
                 triangles.indices[i], std::ptrdiff_t(triangles.positions.size()) - 1);
    if (triangles.indices.empty() || triangles.indices.size() % 3 != 0)
        fail(Failure::input,
             "a surface to measure has three indices per triangle and a triangle at least, not {} indices",
             triangles.indices.size());
}

} // namespace

dvec3 nearestInTriangle(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
                 d6 = dot(ac, cp);
    // A triangle without area has its sides and corners only: every quotient below has a divisor above zero.
    if (d1 <= 0 && d2 <= 0) return a;
    if (d3 >= 0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0 && d1 > d3) return a + d1 / (d1 - d3) * ab;
    if (d6 >= 0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0 && d2 > d6) return a + d2 / (d2 - d6) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 >= d3 && d5 >= d6 && d4 - d3 + d5 - d6 > 0) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
    const double sum = va + vb + vc;
    return sum > 0 ? a + vb / sum * ab + vc / sum * ac : a;
}

ClosestPoints::ClosestPoints(std::vector<vec3> positions, std::vector<std::uint32_t> indices, TreeUse use)
    : positions_(std::move(positions)), indices_(std::move(indices)) {
    // Embree reads 16 bytes per vertex: one more vertex lies behind the last.
    checkTriangles({positions_, indices_});
    positions_.reserve(positions_.size() + 1);
    positions_.emplace_back(0.0f);
    if (!device_)
        fail(Failure::device, "Embree does not start (error {}); is there memory for it?",
             int(rtcGetDeviceError(nullptr)));
    scene_.reset(rtcNewScene(device_.get()));
    // As many trees are built as measured; lines are many more than trees.
    const RTCBuildQuality quality = use == TreeUse::lines ? RTC_BUILD_QUALITY_MEDIUM : RTC_BUILD_QUALITY_LOW;
    rtcSetSceneBuildQuality(scene_.get(), quality);
    if (use == TreeUse::lines)
        rtcSetSceneFlags(scene_.get(), RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION |
                                                     RTC_SCENE_FLAG_COMPACT));

    // The geometry shares our arrays and answers point queries by visitTriangle.
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions_.data(), 0,
                               sizeof(vec3), positions_.size() - 1);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices_.data(), 0,
                               3 * sizeof(std::uint32_t), indices_.size() / 3);
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcSetGeometryPointQueryFunction(geometry, visitTriangle);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);

    double largest = 0;
    for (const vec3& p : positions_) largest = std::max(largest, glm::length(dvec3(p)));
    constexpr double kFloatsMayBeOff = 1e-6; // of coordinates: some of their last bits
    overlap_ = kFloatsMayBeOff * largest;

    // Errors of building show only here.
    rtcCommitScene(scene_.get());
    if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
        error == RTC_ERROR_OUT_OF_MEMORY
            ? fail(Failure::device, "there is too little memory for a tree of {} triangles", indices_.size() / 3)
            : fail(Failure::internal, "Embree builds no tree of {} triangles: error {}", indices_.size() / 3,
                   int(error));
}

std::optional<LineHit> ClosestPoints::nearestOnLine(const dvec3& p, const dvec3& direction, const LineReach& reach,
                                                    Facing facing) const {
    LineQuery query;
    query.points = this, query.p = p, query.direction = direction, query.reach = reach, query.facing = facing;
    rtcInitIntersectContext(&query);
    query.filter = takeHit;
    // Forwards, then backwards no farther than what is there already. Both halves begin a little on the other side, so
    // that none misses a surface which floats put there.
    for (const bool isForwards : {true, false}) {
        const double limit = isForwards ? reach.front : std::min(reach.back, std::abs(query.best.height));
        if (limit < 0) continue;
        const dvec3 along = isForwards ? direction : -direction, origin = p - overlap_ * along;
        RTCRayHit ray{};
        ray.ray.org_x = float(origin.x), ray.ray.org_y = float(origin.y), ray.ray.org_z = float(origin.z);
        ray.ray.dir_x = float(along.x), ray.ray.dir_y = float(along.y), ray.ray.dir_z = float(along.z);
        ray.ray.tfar = float(limit + 2 * overlap_);
        ray.ray.mask = ~0u;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(scene_.get(), &query, &ray);
    }
    if (!query.hasHit) return {};
    const double passed = query.best.height >= 0 ? query.nearestBack[0] : query.nearestBack[1];
    query.best.isBehindBack = passed < std::abs(query.best.height);
    return query.best;
}

bool ClosestPoints::isBlocked(const dvec3& p, const dvec3& direction, double reach) const {
    constexpr double kApart = 16; // from the surface that the line begins on, in what floats may be off
    RTCRay ray{};
    ray.org_x = float(p.x), ray.org_y = float(p.y), ray.org_z = float(p.z);
    ray.dir_x = float(direction.x), ray.dir_y = float(direction.y), ray.dir_z = float(direction.z);
    ray.tnear = float(kApart * overlap_), ray.tfar = float(reach);
    ray.mask = ~0u;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene_.get(), &context, &ray);
    return ray.tfar < 0;
}

double ClosestPoints::distance(const dvec3& p, double limit) const {
    return std::sqrt(ask(scene_.get(), *this, p, limit).squared);
}

NearestPoint ClosestPoints::nearest(const dvec3& p) const {
    return ask(scene_.get(), *this, p, std::numeric_limits<double>::infinity()).nearest;
}

} // namespace relief
