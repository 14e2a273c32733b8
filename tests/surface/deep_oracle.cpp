#include "surface/deep_oracle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace relief {
namespace {

using Real = DeepOracle::Real;
using RealPoint = DeepOracle::RealPoint;

constexpr Real kInfinite = 10, kHalf = Real(1) / 2, kQuarter = Real(1) / 4, kEighth = Real(1) / 8;

bool isSharp(Real s) { return s > 0; }
Real less(Real s) { return s >= kInfinite ? s : std::max(s - 1, Real(0)); }

} // namespace

DeepOracle::DeepOracle(const Cage& cage, Scheme scheme, std::uint32_t vertex)
    : sideCount_(scheme == Scheme::loop ? 3 : 4), vertex_(int(vertex)) {
    for (const vec3& p : cage.positions) positions_.emplace_back(p);
    std::map<EdgeKey, int> counts;
    std::size_t first = 0;
    int number = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        Face face;
        for (std::uint32_t i = 0; i < size; ++i) face.vertices.push_back(int(cage.corners[first + i]));
        for (std::uint32_t i = 0; i < size; ++i) ++counts[keyOf(face.vertices[i], face.vertices[(i + 1) % size])];
        face.face = number;
        number += int(size) == sideCount_ ? 1 : int(size);
        faces_.push_back(face);
        first += size;
    }
    for (std::size_t i = 0; i < cage.creaseSharpness.size(); ++i)
        sharpness_[keyOf(int(cage.creaseEdges[2 * i]), int(cage.creaseEdges[2 * i + 1]))] = cage.creaseSharpness[i];
    for (std::size_t i = 0; i < cage.vertexSharpness.size(); ++i)
        vertexSharpness_[int(cage.sharpVertices[i])] = cage.vertexSharpness[i];
    std::map<int, int> faceCounts;
    for (const auto& [edge, count] : counts)
        if (count == 1) boundary_.insert(edge), sharpness_[edge] = kInfinite;
    for (const Face& face : faces_)
        for (const int v : face.vertices) ++faceCounts[v];
    if (cage.boundaryRule == BoundaryRule::edgeAndCorner)
        for (const auto& [v, count] : faceCounts)
            if (count == 1) vertexSharpness_[v] = kInfinite;
    origin_ = restOfVertex();
    for (RealPoint& p : positions_) p -= origin_;
}

RealPoint DeepOracle::restOfVertex() const {
    constexpr int kAtRest = 120; // refinements: each multiplies the distance from the limit by 2/3 at most
    DeepOracle follower = *this;
    while (follower.level() < kAtRest) follower.refine(1);
    return follower.positions_[follower.vertex_];
}

void DeepOracle::refine(int rings) {
    // Who meets whom.
    struct EdgeFaces {
        std::vector<int> faces, opposite;
    };
    std::map<EdgeKey, EdgeFaces> edges;
    std::map<int, std::vector<int>> facesOf;
    std::map<int, std::set<int>> neighbours;
    for (int f = 0; f < int(faces_.size()); ++f) {
        const auto& v = faces_[f].vertices;
        const int n = int(v.size());
        for (int i = 0; i < n; ++i) {
            EdgeFaces& e = edges[keyOf(v[i], v[(i + 1) % n])];
            e.faces.push_back(f), e.opposite.push_back(v[(i + 2) % n]);
            facesOf[v[i]].push_back(f);
            neighbours[v[i]].insert(v[(i + 1) % n]), neighbours[v[(i + 1) % n]].insert(v[i]);
        }
    }
    const auto sharpnessOf = [&](const EdgeKey& e) { return sharpness_.contains(e) ? sharpness_.at(e) : Real(0); };
    const auto isCut = [&](const EdgeKey& e) { return edges.at(e).faces.size() == 1 && !boundary_.contains(e); };

    // New points; a missing one depends on what is forgotten.
    std::vector<RealPoint> points;
    const auto addPoint = [&](const RealPoint& p) { return points.push_back(p), int(points.size()) - 1; };
    std::vector<int> facePoints(faces_.size(), -1);
    std::vector<RealPoint> centers(faces_.size(), RealPoint(0));
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        for (const int v : faces_[f].vertices) centers[f] += positions_[v] / Real(faces_[f].vertices.size());
        if (sideCount_ == 4) facePoints[f] = addPoint(centers[f]);
    }
    std::map<EdgeKey, int> edgePoints;
    std::map<EdgeKey, Real> newSharpness;
    std::set<EdgeKey> newBoundary;
    for (const auto& [key, e] : edges) {
        if (isCut(key)) continue;
        const RealPoint a = positions_[key.first], b = positions_[key.second];
        const Real sharp = std::min(sharpnessOf(key), Real(1));
        RealPoint p = kHalf * (a + b);
        if (sharp < 1) {
            RealPoint smooth = 3 * kEighth * (a + b);
            if (sideCount_ == 4)
                smooth = kQuarter * (a + b + centers[e.faces[0]] + centers[e.faces[1]]);
            else
                for (const int v : e.opposite) smooth += kEighth * positions_[v];
            p = sharp * p + (1 - sharp) * smooth;
        }
        edgePoints[key] = addPoint(p);
    }
    std::map<int, int> vertexPoints;
    std::map<int, Real> newVertexSharpness;
    for (const auto& [v, around] : neighbours) {
        const bool isComplete = std::ranges::none_of(around, [&](int w) { return isCut(keyOf(v, w)); });
        if (!isComplete) continue;
        const auto masked = [&](const std::vector<int>& sharpEnds, bool isCorner) {
            if (isCorner || sharpEnds.size() > 2) return positions_[v];
            if (sharpEnds.size() == 2)
                return 3 * kQuarter * positions_[v] + kEighth * (positions_[sharpEnds[0]] + positions_[sharpEnds[1]]);
            const Real n = Real(around.size());
            RealPoint ends(0), middles(0);
            for (const int w : around) ends += positions_[w];
            if (sideCount_ == 3) {
                const Real c = 3 * kEighth + kQuarter * std::cos(2 * std::numbers::pi_v<Real> / n);
                const Real beta = (5 * kEighth - c * c) / n;
                return (1 - n * beta) * positions_[v] + beta * ends;
            }
            for (const int f : facesOf[v]) middles += centers[f];
            return (n - 2) / n * positions_[v] + (ends + middles) / (n * n);
        };
        std::vector<int> now, later;
        Real sum = 0;
        int fading = 0;
        for (const int w : around) {
            const Real s = sharpnessOf(keyOf(v, w));
            if (isSharp(s)) now.push_back(w);
            if (isSharp(less(s))) later.push_back(w);
            if (isSharp(s) && !isSharp(less(s))) sum += s, ++fading;
        }
        const Real own = vertexSharpness_.contains(v) ? vertexSharpness_.at(v) : 0;
        if (isSharp(own) && !isSharp(less(own))) sum += own, ++fading;
        // DeRose, Kass and Truong: rules of two levels are blended where sharpness ends between them.
        const RealPoint before = masked(now, isSharp(own)), after = masked(later, isSharp(less(own)));
        const Real blend = fading > 0 ? sum / Real(fading) : 1;
        vertexPoints[v] = addPoint(blend * before + (1 - blend) * after);
        if (isSharp(less(own))) newVertexSharpness[vertexPoints[v]] = less(own);
    }
    for (const auto& [key, e] : edges) {
        if (!edgePoints.contains(key)) continue;
        for (const int end : {key.first, key.second}) {
            if (!vertexPoints.contains(end)) continue;
            const EdgeKey half = keyOf(vertexPoints.at(end), edgePoints.at(key));
            if (isSharp(less(sharpnessOf(key)))) newSharpness[half] = less(sharpnessOf(key));
            if (boundary_.contains(key)) newBoundary.insert(half);
        }
    }

    // New faces, of which only those with all points are kept.
    std::vector<Face> newFaces;
    const auto pointOf = [](const auto& map, const auto& key) { return map.contains(key) ? map.at(key) : -1; };
    for (std::size_t f = 0; f < faces_.size(); ++f) {
        const Face& face = faces_[f];
        const int n = int(face.vertices.size());
        const auto vertex = [&](int i) { return pointOf(vertexPoints, face.vertices[i % n]); };
        const auto middle = [&](int i) {
            return pointOf(edgePoints, keyOf(face.vertices[i % n], face.vertices[(i + 1) % n]));
        };
        const bool isNgon = n != sideCount_;
        const auto add = [&](std::vector<int> vertices, int number, Place origin, int sign) {
            if (std::ranges::find(vertices, -1) == vertices.end())
                newFaces.push_back({std::move(vertices), number, origin, sign, isNgon ? 0 : face.depth + 1});
        };
        if (sideCount_ == 3) {
            const Place o = std::int64_t(2) * face.origin, u(face.sign, 0), v(0, face.sign);
            add({vertex(0), middle(0), middle(2)}, face.face, o, face.sign);
            add({middle(0), vertex(1), middle(1)}, face.face, o + u, face.sign);
            add({middle(2), middle(1), vertex(2)}, face.face, o + v, face.sign);
            add({middle(1), middle(2), middle(0)}, face.face, o + u + v, -face.sign);
        } else if (n == 4) {
            for (int i = 0; i < 4; ++i) {
                // Corner 0 of the child is the one that lies where the face's own is.
                const int ring[] = {vertex(i), middle(i), facePoints[f], middle(i + 3)};
                std::vector<int> vertices(4);
                for (int k = 0; k < 4; ++k) vertices[(i + k) % 4] = ring[k];
                add(vertices, face.face, std::int64_t(2) * face.origin + Place(i == 1 || i == 2, i >= 2), 1);
            }
        } else {
            for (int i = 0; i < n; ++i)
                add({vertex(i), middle(i), facePoints[f], middle(i + n - 1)}, face.face + i, Place(0), 1);
        }
    }
    vertex_ = vertexPoints.at(vertex_);
    positions_ = points, faces_ = newFaces, sharpness_ = newSharpness, boundary_ = newBoundary;
    vertexSharpness_ = newVertexSharpness;
    ++level_;
    keepNear(rings);
}

/// Rings of faces around the vertex.
void DeepOracle::keepNear(int rings) {
    std::set<int> near{vertex_};
    std::vector<bool> isKept(faces_.size());
    for (int ring = 0; ring < rings; ++ring) {
        std::set<int> next = near;
        for (std::size_t f = 0; f < faces_.size(); ++f) {
            const auto& v = faces_[f].vertices;
            if (std::ranges::none_of(v, [&](int w) { return near.contains(w); })) continue;
            isKept[f] = true;
            next.insert(v.begin(), v.end());
        }
        near = next;
    }
    std::vector<Face> kept;
    for (std::size_t f = 0; f < faces_.size(); ++f)
        if (isKept[f]) kept.push_back(faces_[f]);
    faces_ = kept;
}

std::vector<DeepOracle::Sample> DeepOracle::samples() const {
    std::map<int, std::map<std::pair<std::int64_t, std::int64_t>, RealPoint>> lattices; // by face
    std::map<int, int> depths;
    for (const Face& face : faces_) {
        if (int(face.vertices.size()) != sideCount_) continue;
        constexpr int kQuad[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, kTriangle[][2] = {{0, 0}, {1, 0}, {0, 1}};
        for (int k = 0; k < sideCount_; ++k) {
            const int* step = sideCount_ == 4 ? kQuad[k] : kTriangle[k];
            const Place at = face.origin + std::int64_t(face.sign) * Place(step[0], step[1]);
            lattices[face.face][{at.x, at.y}] = positions_[face.vertices[k]];
        }
        depths[face.face] = face.depth;
    }
    std::vector<Sample> found;
    for (const auto& [face, lattice] : lattices) {
        const Real n = std::ldexp(Real(1), depths.at(face));
        for (const auto& [at, center] : lattice) {
            const auto [x, y] = at;
            RealPoint p[3][3]; // by row
            bool isWhole = true;
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i) {
                    if (sideCount_ == 3 && i == j && i != 1) continue; // no neighbours
                    const auto found = lattice.find({x + i - 1, y + j - 1});
                    isWhole = isWhole && found != lattice.end();
                    if (isWhole) p[j][i] = found->second;
                }
            if (!isWhole) continue;
            Sample sample{face, dvec2(glm::vec<2, Real>(x, y) / n), {}};
            LimitFrame& f = sample.frame;
            if (sideCount_ == 4) {
                const auto sum = [&](const RealPoint& u, const RealPoint& v) {
                    RealPoint s(0);
                    for (int j = 0; j < 3; ++j)
                        for (int i = 0; i < 3; ++i) s += u[i] * v[j] * p[j][i];
                    return s;
                };
                // The uniform cubic B-spline and its derivatives at a knot.
                const RealPoint w = RealPoint(1, 4, 1) / Real(6), d = kHalf * RealPoint(-1, 0, 1), dd(1, -2, 1);
                f = {dvec3(origin_ + sum(w, w)), dvec3(n * sum(d, w)),     dvec3(n * sum(w, d)),
                     dvec3(n * n * sum(dd, w)),  dvec3(n * n * sum(d, d)), dvec3(n * n * sum(w, dd))};
            } else {
                const RealPoint e = p[1][2], ne = p[2][1], nw = p[2][0], west = p[1][0], sw = p[0][1], se = p[0][2];
                f.p = dvec3(origin_ + (Real(6) * center + e + ne + nw + west + sw + se) / Real(12));
                f.pu = dvec3(n / 6 * (Real(2) * (e - west) + ne - nw - sw + se));
                f.pv = dvec3(n / 6 * (Real(2) * (ne - sw) + e + nw - west - se));
            }
            found.push_back(sample);
        }
    }
    return found;
}

DeepOracle::Sample DeepOracle::vertex() const {
    for (const Face& face : faces_) {
        const auto at = std::ranges::find(face.vertices, vertex_) - face.vertices.begin();
        if (at == std::ptrdiff_t(face.vertices.size()) || int(face.vertices.size()) != sideCount_) continue;
        constexpr int kQuad[][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, kTriangle[][2] = {{0, 0}, {1, 0}, {0, 1}};
        const int* step = sideCount_ == 4 ? kQuad[at] : kTriangle[at];
        const Place place = face.origin + std::int64_t(face.sign) * Place(step[0], step[1]);
        Sample sample{face.face, dvec2(place) / std::ldexp(1.0, face.depth), {}};
        sample.frame.p = dvec3(origin_);
        return sample;
    }
    return {-1, dvec2(0), {}};
}

} // namespace relief
