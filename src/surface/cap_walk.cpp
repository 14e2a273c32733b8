#include "surface/cap_walk.h"

#include <algorithm>
#include <array>

namespace relief {

using Rule = OpenSubdiv::Sdc::Crease;

std::optional<Sector> LevelWalker::sectorAt(FaceCorner start) const {
    Sector sector;
    CapPattern& pattern = sector.pattern;
    pattern.sideCount = sideCount_;
    if (level_.IsVertexSemiSharp(vertexAt(start)) || !setRule(pattern, start)) return {};

    // Clockwise to a sharp edge or back to the start; a closed fan with one sharp edge starts behind that edge.
    FaceCorner first = start;
    bool isClosed = false;
    for (int steps = 0;; ++steps) {
        const int edge = level_.GetFaceEdges(first.face)[first.corner];
        if (level_.IsEdgeSemiSharp(edge) || steps > 2 * kMostRingFaces) return {};
        if (isSharp(edge)) break;
        const auto other = before(first);
        if (!other) return {};
        if (other->face == start.face) {
            isClosed = true;
            first = start;
            break;
        }
        first = *other;
    }
    // Counterclockwise from there: the faces and edges of the sector. One sharp edge in a closed fan is a dart.
    if (!addFaces(sector, first, start, isClosed)) return {};
    pattern.isClosed = isClosed;
    if (!isClosed && isOneSharpEdge(sector)) pattern.isClosed = pattern.hasDart = true;
    // Faces close around a smooth vertex, and end at both sides of a crease; corners have either.
    const bool fits = pattern.rule == VertexRule::crease   ? !pattern.isClosed
                      : pattern.rule == VertexRule::smooth ? pattern.isClosed
                                                           : true;
    if (!fits) return {};
    return sector;
}

std::optional<FaceCorner> LevelWalker::across(FaceCorner at, int step) const {
    const FaceCorner from = turned(at, step);
    const int edge = level_.GetFaceEdges(from.face)[from.corner];
    const auto faces = level_.GetEdgeFaces(edge);
    if (faces.size() != 2 || level_.IsEdgeNonManifold(edge)) return {};
    const int other = faces[0] == at.face ? faces[1] : faces[0];
    if (other == at.face || level_.GetFaceVertices(other).size() != sideCount_) return {};
    const FaceCorner found{other, level_.GetFaceEdges(other).FindIndex(edge)};
    // Faces that go the same way along an edge do not continue each other.
    if (found.corner < 0 || vertexAt(found) != vertexAt(turned(from, 1))) return {};
    return found;
}

bool LevelWalker::setTextureRule(CapPattern& pattern, FaceCorner at) const {
    const int vertex = vertexAt(at);
    const int number = level_.GetVertexFaces(vertex).FindIndex(at.face);
    const auto tag = texture_->getVertexValueTags(vertex)[texture_->getVertexFaceSiblings(vertex)[number]];
    if (tag.isSemiSharp()) return false;
    pattern.rule = tag.isCrease() ? VertexRule::crease : VertexRule::corner;
    return true;
}

bool LevelWalker::setRule(CapPattern& pattern, FaceCorner at) const {
    const int vertex = vertexAt(at);
    if (texture_ && !level_.DoesVertexFVarTopologyMatch(vertex)) return setTextureRule(pattern, at);
    switch (level_.GetVertexRule(vertex)) {
    case Rule::RULE_SMOOTH:
    case Rule::RULE_DART: pattern.rule = VertexRule::smooth; return true;
    case Rule::RULE_CREASE: pattern.rule = VertexRule::crease; return true;
    case Rule::RULE_CORNER: pattern.rule = VertexRule::corner; return true;
    default: return false;
    }
}

bool LevelWalker::addFaces(Sector& sector, FaceCorner first, FaceCorner start, bool isClosed) const {
    FaceCorner at = first;
    while (true) {
        if (at.face == start.face && !isClosed) sector.pattern.face = int(sector.faces.size());
        sector.faces.push_back(at);
        const int edge = level_.GetFaceEdges(at.face)[next(at.corner, -1)];
        if (level_.IsEdgeSemiSharp(edge) || sector.faces.size() > std::size_t(kMostRingFaces)) return false;
        if (isSharp(edge)) break;
        const auto other = after(at);
        if (!other) return false;
        if (other->face == first.face) break;
        at = *other;
    }
    sector.pattern.faceCount = int(sector.faces.size());
    return true;
}

bool LevelWalker::isOneSharpEdge(const Sector& sector) const {
    const FaceCorner first = sector.faces.front(), last = sector.faces.back();
    const int edge = level_.GetFaceEdges(first.face)[first.corner];
    return edge == level_.GetFaceEdges(last.face)[next(last.corner, -1)] && !isSeam(edge);
}

bool CapWalker::find(int face, int sideCount, int levelCount) {
    int irregularCount = 0;
    std::array<std::optional<Sector>, 4> sectors;
    for (int corner = 0; corner < sideCount; ++corner) {
        sectors[corner] = level_.sectorAt({face, corner});
        if (!sectors[corner]) return false;
        const Sector& sector = *sectors[corner];
        if (sector.isRegularInside() || sector.isRegularCrease()) continue;
        ++irregularCount;
        at_ = {face, corner};
    }
    if (irregularCount != 1) return false;
    sector_ = *sectors[at_.corner];
    CapPattern& pattern = sector_.pattern;
    // Two triangles around a vertex lie on each other.
    if (pattern.isClosed && pattern.faceCount < (sideCount == 4 && !pattern.hasDart ? 2 : 3)) return false;
    const int window = levelCount + 1;
    if (pattern.faceCount > kMostCapFaces && (!pattern.isClosed || 2 * window + 2 < pattern.faceCount))
        pattern.window = window;

    // What the lattice takes the other corners for.
    const auto fits = [&](int step, bool isOnCrease) {
        const Sector& sector = *sectors[(at_.corner + step) % sideCount];
        return isOnCrease ? sector.isRegularCrease() : sector.isRegularInside();
    };
    if (!fits(1, pattern.isSharpBefore()) || !fits(sideCount - 1, pattern.isSharpAfter())) return false;
    if (sideCount == 4 && !fits(2, false)) return false;
    return collect();
}

std::vector<FaceCorner> CapWalker::ring() const {
    std::vector<FaceCorner> ring{at_};
    for (const FaceCorner& face : sector_.faces) ring.push_back(level_.turned(face, 1));
    if (!sector_.pattern.isClosed) ring.push_back(level_.turned(sector_.faces.back(), -1));
    if (sector_.pattern.sideCount == 4)
        for (const FaceCorner& face : sector_.faces) ring.push_back(level_.turned(face, 2));
    return ring;
}

bool CapWalker::collect() {
    points_.assign(1, at_);
    const CapPattern& pattern = sector_.pattern;
    const auto faceAt = [&](int i) { return sector_.faces[(i + pattern.faceCount) % pattern.faceCount]; };
    const int first = pattern.firstSpoke(), last = first + pattern.windowFaceCount();
    for (int i = first; i < last; ++i) points_.push_back(level_.turned(faceAt(i), 1));
    const bool isWhole = pattern.window == 0 && pattern.isClosed;
    if (!isWhole) points_.push_back(level_.turned(faceAt(last - 1), -1)); // behind the last face
    if (pattern.sideCount == 4)
        for (int i = first; i < last; ++i) points_.push_back(level_.turned(faceAt(i), 2));
    return pattern.sideCount == 4 ? collectOuterOfQuads() : collectOuterOfTriangles();
}

bool CapWalker::collectOuterOfQuads() {
    const CapPattern& pattern = sector_.pattern;
    const auto right = level_.across(at_, 1); // (1,1), (1,0), (2,0), (2,1)
    const auto upper = level_.across(at_, 2); // (0,1), (1,1), (1,2), (0,2)
    if (!right || !upper) return false;
    const auto diagonal = level_.across(*right, 3); // (1,1), (2,1), (2,2), (1,2)
    if (!diagonal) return false;
    if (!pattern.isSharpBefore()) {
        const auto lower = level_.across(*right, 1); // (2,0), (1,0), (1,-1), (2,-1)
        if (!lower) return false;
        add(*lower, 3);
    }
    add(*right, 2), add(*right, 3), add(*diagonal, 2), add(*upper, 2), add(*upper, 3);
    if (!pattern.isSharpAfter()) {
        const auto left = level_.across(*upper, 3); // (0,1), (0,2), (-1,2), (-1,1)
        if (!left) return false;
        add(*left, 2);
    }
    return true;
}

bool CapWalker::collectOuterOfTriangles() {
    const CapPattern& pattern = sector_.pattern;
    const auto opposite = level_.across(at_, 1); // (0,1), (1,0), (1,1)
    if (!opposite) return false;
    const auto right = level_.across(*opposite, 1); // (1,1), (1,0), (2,0)
    const auto upper = level_.across(*opposite, 2); // (0,1), (1,1), (0,2)
    if (!right || !upper) return false;
    if (!pattern.isSharpBefore()) {
        const auto lower = level_.across(*right, 1); // (2,0), (1,0), (2,-1)
        if (!lower) return false;
        add(*lower, 2);
    }
    add(*right, 2), add(*opposite, 2), add(*upper, 2);
    if (!pattern.isSharpAfter()) {
        const auto left = level_.across(*upper, 2); // (0,1), (0,2), (-1,2)
        if (!left) return false;
        add(*left, 2);
    }
    return true;
}

} // namespace relief
