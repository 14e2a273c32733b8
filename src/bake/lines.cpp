#include "bake/lines.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

/// A unit vector along a sum of normals; empty where they cancel.
std::optional<dvec3> directionOf(const dvec3& sum) {
    const double length = glm::length(sum);
    if (!(length > 1e-9)) return {};
    return sum / length;
}

/// Where (u,v) lies along a side of its face; empty beside the side.
std::optional<double> placeOnSide(int sideCount, int side, const dvec2& uv) {
    if (sideCount == 3) {
        if (side == 0) return uv.y == 0 ? std::optional(uv.x) : std::nullopt;
        if (side == 1) return uv.x + uv.y == 1 ? std::optional(uv.y) : std::nullopt;
        return uv.x == 0 ? std::optional(1 - uv.y) : std::nullopt;
    }
    if (side == 0) return uv.y == 0 ? std::optional(uv.x) : std::nullopt;
    if (side == 1) return uv.x == 1 ? std::optional(uv.y) : std::nullopt;
    if (side == 2) return uv.y == 1 ? std::optional(1 - uv.x) : std::nullopt;
    return uv.x == 0 ? std::optional(1 - uv.y) : std::nullopt;
}

} // namespace

DisplacementDirections::DisplacementDirections(const Surface& surface, const ReferenceSurface& reference)
    : surface_(surface), reference_(reference) {
    if (surface.incidences.empty()) return;
    sides_.resize(surface.faces.size() * 4);
    const auto sideOf = [&](const Incidence& incidence) -> SharedSide& {
        return sides_[4 * std::size_t(incidence.face) + incidence.side];
    };
    for (std::uint32_t e = 0; e < surface.edges.size(); ++e) {
        const Edge& edge = surface.edges[e];
        for (std::uint32_t i = 0; i < edge.incidenceCount; ++i) {
            const Incidence& incidence = surface.incidences[edge.firstIncidence + i];
            SharedSide& side = sideOf(incidence);
            side.stretches[side.stretches[0].edge == kNoPatch ? 0 : 1] = {e, incidence.start, incidence.end};
        }
    }
    for (std::uint32_t c = 0; c < surface.corners.size(); ++c) {
        const Corner& corner = surface.corners[c];
        for (std::uint32_t i = 0; i < corner.incidenceCount; ++i) {
            const Incidence& incidence = surface.incidences[corner.firstIncidence + i];
            (incidence.start == 0 ? sideOf(incidence).corner : sideOf(incidence).middle) = c;
        }
    }
}

std::optional<dvec3> DisplacementDirections::ofCorner(std::uint32_t corner) const {
    if (corner == kNoPatch) return {};
    const Corner& shared = surface_.corners[corner];
    dvec3 sum(0);
    for (std::uint32_t i = shared.firstIncidence; i < shared.firstIncidence + shared.incidenceCount; ++i) {
        const Incidence& incidence = surface_.incidences[i];
        const dvec2 uv = sidePoint(surface_.sideCount, int(incidence.side), double(incidence.start));
        sum += reference_.normal(int(incidence.face), uv) / double(surface_.sectorFaces[i]);
    }
    return directionOf(sum);
}

std::optional<dvec3> DisplacementDirections::onSide(int face, int side, double x) const {
    const SharedSide& shared = sides_[4 * std::size_t(face) + std::size_t(side)];
    if (x == 0) return ofCorner(shared.corner);
    if (x == 1) return ofCorner(sides_[4 * std::size_t(face) + std::size_t((side + 1) % surface_.sideCount)].corner);
    if (x == 0.5 && shared.middle != kNoPatch) return ofCorner(shared.middle);
    for (const auto& [edge, start, end] : shared.stretches) {
        if (edge == kNoPatch || x < std::min(start, end) || x > std::max(start, end)) continue;
        const double t = (x - double(start)) / (double(end) - double(start));
        const Edge& whole = surface_.edges[edge];
        dvec3 sum(0);
        for (std::uint32_t i = whole.firstIncidence; i < whole.firstIncidence + whole.incidenceCount; ++i) {
            const Incidence& incidence = surface_.incidences[i];
            const double at = std::lerp(double(incidence.start), double(incidence.end), t);
            sum += reference_.normal(int(incidence.face), sidePoint(surface_.sideCount, int(incidence.side), at));
        }
        return directionOf(sum);
    }
    return {};
}

dvec3 DisplacementDirections::at(int face, const dvec2& uv) const {
    for (int side = 0; !sides_.empty() && side < surface_.sideCount; ++side)
        if (const std::optional<double> x = placeOnSide(surface_.sideCount, side, uv))
            if (const std::optional<dvec3> direction = onSide(face, side, *x)) return *direction;
    return reference_.normal(face, uv);
}

SculptLines::Line SculptLines::lineAt(int face, const dvec2& uv) const {
    Line line{.frame = surface_.limit(face, uv)};
    if (search_.directions != nullptr)
        line.direction = search_.directions->at(face, uv);
    else if (line.frame.hasTangentPlane())
        line.direction = glm::normalize(glm::cross(line.frame.pu, line.frame.pv));
    else
        line.direction = surface_.normal(face, uv);
    if (search_.cage != nullptr) line.start = glm::dot(search_.cage->limit(face, uv).p - line.frame.p, line.direction);
    return line;
}

std::optional<LineHit> SculptLines::find(const Line& line, Facing facing) const {
    if (search_.cage == nullptr || line.start < 0)
        return sculpt_.nearestOnLine(line.frame.p, line.direction, search_.reach, facing);
    std::optional<LineHit> hit = sculpt_.nearestOnLine(line.frame.p + line.start * line.direction, line.direction,
                                                       {.front = 0, .back = line.start + search_.reach.back}, facing);
    if (hit) hit->height += line.start;
    return hit;
}

Cage inflateCage(const Cage& cage, double distance) {
    std::vector<dvec3> normals(cage.positions.size(), dvec3(0));
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        // Newell's normal of a polygon, which need not be flat, is as long as twice its area.
        const auto at = [&](std::uint32_t k) { return dvec3(cage.positions[cage.corners[first + k % size]]); };
        dvec3 normal(0);
        for (std::uint32_t k = 1; k + 1 < size; ++k) normal += glm::cross(at(k) - at(0), at(k + 1) - at(0));
        for (std::uint32_t k = 0; k < size; ++k) normals[cage.corners[first + k]] += normal;
        first += size;
    }
    Cage inflated = cage;
    for (std::size_t i = 0; i < normals.size(); ++i)
        if (glm::length(normals[i]) > 0)
            inflated.positions[i] = vec3(dvec3(cage.positions[i]) + distance * glm::normalize(normals[i]));
    return inflated;
}

} // namespace relief
