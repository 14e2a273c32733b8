// The limit surface close to one vertex of a cage, by refinement alone: a mesh is refined again and again, and all that
// is far from the vertex is forgotten. It uses neither OpenSubdiv nor the library's own rules and matrices.
#pragma once

#include <limits>
#include <map>
#include <set>

#include "surface/surface.h"

namespace relief {

/// Computes with as many digits as the processor has, since tangents are differences of points that lie close together.
class DeepOracle {
public:
    using Real = long double;
    static_assert(std::numeric_limits<Real>::digits >= 64,
                  "tolerances of the tests are for more than double precision");
    using RealPoint = glm::vec<3, Real>;

    /// Follows a vertex of the cage, whose limit point is where the numbers begin: what points near it are differences
    /// of is as small as they are, and all their digits count.
    DeepOracle(const Cage& cage, Scheme scheme, std::uint32_t vertex);

    void refine() { refine(kSampledRings); }
    [[nodiscard]] int level() const { return level_; }

    /// A point of the limit surface; of triangles without second derivatives.
    struct Sample {
        int face = 0; ///< OpenSubdiv's
        dvec2 uv{0};
        LimitFrame frame;
    };
    /// The regular points inside faces near the vertex: some steps of 2^-level away.
    [[nodiscard]] std::vector<Sample> samples() const;
    /// The vertex itself, as one of its faces has it: only `p`, its limit point.
    [[nodiscard]] Sample vertex() const;

private:
    using Place = glm::vec<2, std::int64_t>;
    struct Face {
        std::vector<int> vertices;
        int face = -1;   ///< OpenSubdiv's, once it has one
        Place origin{0}; ///< of its corner 0, in steps of 2^-depth
        int sign = 1;    ///< -1 in turned triangles
        int depth = 0;   ///< levels below OpenSubdiv's face
    };
    using EdgeKey = std::pair<int, int>;
    static EdgeKey keyOf(int a, int b) { return {std::min(a, b), std::max(a, b)}; }
    static constexpr int kSampledRings =
        4; ///< of faces: samples lie on corners of pieces of end caps and in the middle of their sides
    void refine(int rings);
    void keepNear(int rings);
    /// Where the vertex comes to rest, which depends on its own faces alone.
    [[nodiscard]] RealPoint restOfVertex() const;

    int sideCount_, level_ = 0, vertex_;
    RealPoint origin_{0}; ///< of positions: the vertex's limit point
    std::vector<RealPoint> positions_;
    std::vector<Face> faces_;
    std::map<EdgeKey, Real> sharpness_; ///< of sharp edges; boundary edges are infinitely sharp
    std::map<int, Real> vertexSharpness_;
    std::set<EdgeKey> boundary_;
};

} // namespace relief
