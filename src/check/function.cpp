// Height functions as the reference sees them.
#include <algorithm>
#include <cmath>

#include "check/check.h"

namespace relief {
namespace {

constexpr std::size_t kQueriesAtOnce = 1u << 16;

/// How far along u or v a slope is taken.
double slopeStep(const dvec3& tangent, double step) {
    const double size = glm::length(tangent);
    return size > 0 ? std::min(step / size, 1.0 / 64) : 1.0 / 64;
}

} // namespace

FunctionReference::FunctionReference(Device& device, const FunctionHeights& heights, const ReferenceSurface& rest,
                                     double seconds)
    : heights_(heights), rest_(rest), seconds_(seconds), evaluator_(device, *heights.function) {}

FunctionPoint FunctionReference::pointAt(const dvec3& p, const dvec2& st) const {
    return {.p = vec3(heights_.unit * p), .st = rest_.hasTexCoords() ? vec2(st) : vec2(0), .t = float(seconds_)};
}

std::vector<double> FunctionReference::evaluate(std::span<const FunctionPoint> points) {
    std::vector<double> heights;
    heights.reserve(points.size());
    for (const FunctionValue& found : evaluator_.evaluate(points)) {
        const double h = heights_.scale * (double(found.value) - heights_.mid), bound = heights_.bound;
        heights.push_back(std::isnan(h) ? 0 : std::clamp(h, -bound, bound));
    }
    return heights;
}

std::vector<FaceHeight> FunctionReference::heights(std::span<const SampleQuery> queries) {
    std::vector<FaceHeight> heights;
    heights.reserve(queries.size());
    for (std::size_t first = 0; first < queries.size(); first += kQueriesAtOnce) {
        const auto part = queries.subspan(first, std::min(kQueriesAtOnce, queries.size() - first));
        // Five points per query: itself, on both sides along u, on both sides along v.
        std::vector<FunctionPoint> points;
        std::vector<dvec2> steps;
        for (const SampleQuery& query : part) {
            const LimitFrame f = rest_.limit(int(query.face), dvec2(query.uv));
            const TexFrame tex = rest_.texture(int(query.face), dvec2(query.uv));
            const dvec2 d(slopeStep(f.pu, heights_.step), slopeStep(f.pv, heights_.step));
            points.push_back(pointAt(f.p, tex.st));
            for (const double side : {d.x, -d.x})
                points.push_back(pointAt(f.p + side * f.pu, tex.st + side * tex.jacobian[0]));
            for (const double side : {d.y, -d.y})
                points.push_back(pointAt(f.p + side * f.pv, tex.st + side * tex.jacobian[1]));
            steps.push_back(d);
        }
        // All points of the part in one evaluation: each is a submission that is waited for.
        const std::vector<double> h = evaluate(points);
        for (std::size_t i = 0; i < part.size(); ++i) {
            const double* of = &h[5 * i];
            heights.push_back({of[0], (of[1] - of[2]) / (2 * steps[i].x), (of[3] - of[4]) / (2 * steps[i].y)});
        }
    }
    return heights;
}

std::vector<double> FunctionReference::heightsAt(std::span<const std::pair<int, dvec2>> points) {
    std::vector<FunctionPoint> given;
    given.reserve(points.size());
    for (const auto& [face, uv] : points) given.push_back(pointAt(rest_.limit(face, uv).p, rest_.texture(face, uv).st));
    return evaluate(given);
}

} // namespace relief
