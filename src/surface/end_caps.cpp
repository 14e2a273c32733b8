// Which patches are end caps whose vertex has rules that stay, and the points around them.
#include <algorithm>
#include <map>

#include "surface/far.h"

namespace relief {
namespace {

using Far::TopologyLevel;
using Rule = OpenSubdiv::Sdc::Crease;

/// A corner of a face of a level.
struct FaceCorner {
    int face = 0, corner = 0;
};

/// The faces around a vertex between two sharp edges, or all of them, counter-clockwise.
struct Sector {
    CapPattern pattern;            ///< `face` is the one that was asked for
    std::vector<FaceCorner> faces; ///< around a smooth vertex from the one that was asked for on

    [[nodiscard]] bool isRegularInside() const {
        const int n = pattern.sideCount == 4 ? 4 : 6;
        return pattern.isClosed && pattern.rule == VertexRule::smooth && !pattern.hasDart && pattern.faceCount == n;
    }
    [[nodiscard]] bool isRegularCrease() const {
        const int n = pattern.sideCount == 4 ? 2 : 3;
        return !pattern.isClosed && pattern.rule == VertexRule::crease && pattern.faceCount == n;
    }
};

/// OpenSubdiv's own patch builder reads the rules of face-varying values there; Far does not offer them.
struct RefinerAccess : Far::TopologyRefiner {
    static const OpenSubdiv::Vtr::internal::FVarLevel& valuesOf(const Far::TopologyRefiner& refiner, int level) {
        using Levels = const OpenSubdiv::Vtr::internal::Level& (Far::TopologyRefiner::*)(int) const;
        const Levels levels = &RefinerAccess::getLevel;
        return (refiner.*levels)(level).getFVarLevel(0);
    }
};

/// Walks over the faces of a level: those of the surface, or of the texture coordinates, which end at their seams.
class LevelWalker {
public:
    LevelWalker(const TopologyLevel& level, int sideCount,
                const OpenSubdiv::Vtr::internal::FVarLevel* texture = nullptr)
        : level_(level), texture_(texture), sideCount_(sideCount) {}

    [[nodiscard]] int vertexAt(FaceCorner at) const { return level_.GetFaceVertices(at.face)[at.corner]; }
    [[nodiscard]] int texValueAt(FaceCorner at) const { return level_.GetFaceFVarValues(at.face)[at.corner]; }
    [[nodiscard]] FaceCorner turned(FaceCorner at, int step) const { return {at.face, next(at.corner, step)}; }

    /// The vertex of a corner, in the face on the other side of the edge that leaves the corner: clockwise around it.
    [[nodiscard]] std::optional<FaceCorner> before(FaceCorner at) const {
        const auto other = across(at, 0);
        if (!other) return {};
        return turned(*other, 1);
    }
    /// The vertex of a corner, in the face on the other side of the edge that arrives at the corner.
    [[nodiscard]] std::optional<FaceCorner> after(FaceCorner at) const { return across(at, -1); }

    /// Nothing where rules are semi-sharp or the level ends.
    [[nodiscard]] std::optional<Sector> sectorAt(FaceCorner start) const {
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
        if (!addFaces(sector, first, start, isClosed)) return {};
        pattern.isClosed = isClosed;
        if (!isClosed && isOneSharpEdge(sector)) pattern.isClosed = pattern.hasDart = true;
        const bool fits = pattern.rule == VertexRule::crease   ? !pattern.isClosed
                          : pattern.rule == VertexRule::smooth ? pattern.isClosed
                                                               : true;
        if (!fits) return {};
        return sector;
    }

    /// The face beyond the edge that leaves the corner `step` corners on, named by its corner at the end of that edge.
    [[nodiscard]] std::optional<FaceCorner> across(FaceCorner at, int step) const {
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

private:
    [[nodiscard]] int next(int corner, int step) const { return (corner + step + sideCount_) % sideCount_; }

    [[nodiscard]] bool isSharp(int edge) const {
        return level_.IsEdgeInfSharp(edge) || level_.IsEdgeBoundary(edge) || level_.IsEdgeNonManifold(edge) ||
               isSeam(edge);
    }
    [[nodiscard]] bool isSeam(int edge) const { return texture_ && !level_.DoesEdgeFVarTopologyMatch(edge); }

    /// The rule of a texture coordinate, where it is not the vertex's.
    bool setTextureRule(CapPattern& pattern, FaceCorner at) const {
        const int vertex = vertexAt(at);
        const int number = level_.GetVertexFaces(vertex).FindIndex(at.face);
        const auto tag = texture_->getVertexValueTags(vertex)[texture_->getVertexFaceSiblings(vertex)[number]];
        if (tag.isSemiSharp()) return false;
        pattern.rule = tag.isCrease() ? VertexRule::crease : VertexRule::corner;
        return true;
    }

    bool setRule(CapPattern& pattern, FaceCorner at) const {
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

    [[nodiscard]] bool addFaces(Sector& sector, FaceCorner first, FaceCorner start, bool isClosed) const {
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

    /// The sharp edges at both ends of a sector are one: a dart. The texture coordinates along a seam are two.
    [[nodiscard]] bool isOneSharpEdge(const Sector& sector) const {
        const FaceCorner first = sector.faces.front(), last = sector.faces.back();
        const int edge = level_.GetFaceEdges(first.face)[first.corner];
        return edge == level_.GetFaceEdges(last.face)[next(last.corner, -1)] && !isSeam(edge);
    }

    const TopologyLevel& level_;
    const OpenSubdiv::Vtr::internal::FVarLevel* texture_;
    int sideCount_;
};

/// The corners of faces whose vertices are the points around a cap.
class CapWalker {
public:
    explicit CapWalker(const LevelWalker& level) : level_(level) {}

    /// Finds the one corner of a face that is not regular, and the points around it.
    bool find(int face, int sideCount, int levelCount) {
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
        if (pattern.faceCount > kMostCapFaces) {
            if (pattern.rule != VertexRule::smooth || pattern.hasDart) return false;
            const int window = levelCount + 1;
            if (2 * window + 2 < pattern.faceCount) pattern.window = window;
        }

        // What the lattice takes the other corners for.
        const auto fits = [&](int step, bool isOnCrease) {
            const Sector& sector = *sectors[(at_.corner + step) % sideCount];
            return isOnCrease ? sector.isRegularCrease() : sector.isRegularInside();
        };
        if (!fits(1, pattern.isSharpBefore()) || !fits(sideCount - 1, pattern.isSharpAfter())) return false;
        if (sideCount == 4 && !fits(2, false)) return false;
        return collect();
    }

    [[nodiscard]] const CapPattern& pattern() const { return sector_.pattern; }
    [[nodiscard]] int corner() const { return at_.corner; }
    /// The points around the cap, without the sums.
    [[nodiscard]] const std::vector<FaceCorner>& points() const { return points_; }
    /// The vertex, the other ends of all edges, and the far corners of all faces if they have four sides.
    [[nodiscard]] std::vector<FaceCorner> ring() const {
        std::vector<FaceCorner> ring{at_};
        for (const int step : {1, 2})
            for (const FaceCorner& face : sector_.faces)
                if (step < sector_.pattern.sideCount - 1) ring.push_back(level_.turned(face, step));
        return ring;
    }

private:
    bool collect() {
        points_.assign(1, at_);
        const CapPattern& pattern = sector_.pattern;
        const auto faceAt = [&](int i) { return sector_.faces[(i + pattern.faceCount) % pattern.faceCount]; };
        const int first = pattern.firstSpoke(), last = first + pattern.windowFaceCount();
        for (int i = first; i < last; ++i) points_.push_back(level_.turned(faceAt(i), 1));
        if (pattern.window > 0)
            points_.push_back(level_.turned(faceAt(last), 1));
        else if (!pattern.isClosed)
            points_.push_back(level_.turned(sector_.faces.back(), -1));
        if (pattern.sideCount == 4)
            for (int i = first; i < last; ++i) points_.push_back(level_.turned(faceAt(i), 2));
        return pattern.sideCount == 4 ? collectOuterOfQuads() : collectOuterOfTriangles();
    }

    /// Appends the vertex `step` corners on from a corner, by which a face is named.
    void add(FaceCorner face, int step) { points_.push_back(level_.turned(face, step)); }

    /// In lattice coordinates: the cap's corners are (0,0), (1,0), (1,1), (0,1).
    bool collectOuterOfQuads() {
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

    /// In lattice coordinates: the cap's corners are (0,0), (1,0), (0,1).
    bool collectOuterOfTriangles() {
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

    const LevelWalker& level_;
    Sector sector_;
    FaceCorner at_;
    std::vector<FaceCorner> points_;
};

/// The face of a refinement level that a patch covers.
struct LevelFace {
    int level = 0, face = 0;
};

class CapFinder {
public:
    CapFinder(FarTables& tables, int levelCount) : tables_(tables), levelCount_(levelCount) {
        const Far::TopologyRefiner& refiner = *tables.refiner;
        sideCount_ = refiner.GetSchemeType() == OpenSubdiv::Sdc::SCHEME_LOOP ? 3 : 4;
        const Far::PtexIndices ptex(refiner);
        const TopologyLevel& cage = refiner.GetLevel(0);
        for (int face = 0; face < cage.GetNumFaces(); ++face) {
            const int size = cage.GetFaceVertices(face).size();
            for (int i = 0; i < (size == sideCount_ ? 1 : size); ++i)
                roots_.push_back({face, size == sideCount_ ? -1 : i});
        }
        int first = 0, firstTex = 0;
        for (int level = 0; level < refiner.GetNumLevels(); ++level) {
            firstPoints_.push_back(first), firstTexPoints_.push_back(firstTex);
            first += refiner.GetLevel(level).GetNumVertices();
            if (tables.hasTexCoords) firstTex += refiner.GetLevel(level).GetNumFVarValues();
        }
    }

    void find() {
        const Far::PatchTable& table = *tables_.patches;
        EndCaps& caps = tables_.caps;
        caps.surface.resize(std::size_t(table.GetNumPatchesTotal()));
        caps.texture.resize(caps.surface.size());
        const bool isTextureCap = tables_.hasTexCoords && isCapType(table.GetFVarPatchDescriptorIrregular().GetType());
        std::size_t patch = 0;
        for (int array = 0; array < table.GetNumPatchArrays(); ++array) {
            const bool isCap = isCapType(table.GetPatchArrayDescriptor(array).GetType());
            for (int i = 0; i < table.GetNumPatches(array); ++i, ++patch) {
                if (isCap) addSurface(patch, faceOf(table.GetPatchParam(array, i)));
                if (isTextureCap && !table.GetPatchFVarPatchParam(array, i).IsRegular())
                    addTexture(patch, faceOf(table.GetPatchParam(array, i)));
            }
        }
    }

private:
    static bool isCapType(int type) {
        return type == Far::PatchDescriptor::GREGORY_BASIS || type == Far::PatchDescriptor::GREGORY_TRIANGLE;
    }

    [[nodiscard]] LevelFace faceOf(const Far::PatchParam& param) const {
        const Far::TopologyRefiner& refiner = *tables_.refiner;
        const auto [cageFace, corner] = roots_[std::size_t(param.GetFaceId())];
        LevelFace at{0, cageFace};
        if (corner >= 0) at = {1, refiner.GetLevel(0).GetFaceChildFaces(cageFace)[corner]};
        dvec2 uv = patchCenter(param, sideCount_);
        while (at.level < int(param.GetDepth())) {
            const int child = sideCount_ == 4 ? enterQuadChild(uv) : enterTriangleChild(uv);
            constexpr int kQuadOrder[] = {0, 1, 3, 2}; // OpenSubdiv goes around the face
            at.face =
                refiner.GetLevel(at.level).GetFaceChildFaces(at.face)[sideCount_ == 4 ? kQuadOrder[child] : child];
            ++at.level;
        }
        return at;
    }

    void addSurface(std::size_t patch, const LevelFace& at) {
        const LevelWalker walker(tables_.refiner->GetLevel(at.level), sideCount_);
        const auto pointAt = [&](FaceCorner corner) { return firstPoints_[at.level] + walker.vertexAt(corner); };
        tables_.caps.surface[patch] =
            capAt(walker, at.face, pointAt, {limits_, tables_.caps.limits, int(pointCount(tables_))});
    }

    void addTexture(std::size_t patch, const LevelFace& at) {
        const LevelWalker walker(tables_.refiner->GetLevel(at.level), sideCount_,
                                 &RefinerAccess::valuesOf(*tables_.refiner, at.level));
        const auto pointAt = [&](FaceCorner corner) { return firstTexPoints_[at.level] + walker.texValueAt(corner); };
        tables_.caps.texture[patch] =
            capAt(walker, at.face, pointAt, {texLimits_, tables_.caps.texLimits, int(texPointCount(tables_))});
    }

    /// The points that are sums of a table's points: limit points and rings of large vertices.
    struct Sums {
        std::map<int, std::uint32_t>& known; ///< limit points by the vertex's point
        std::vector<EndCaps::Limit>& all;
        int first; ///< index of the first sum

        int append(std::vector<int> points, const Eigen::RowVectorXd& weights) {
            all.push_back({std::move(points), weights});
            return first + int(all.size()) - 1;
        }
    };

    template <typename PointAt>
    std::optional<EndCap> capAt(const LevelWalker& walker, int face, const PointAt& pointAt, Sums sums) {
        CapWalker found(walker);
        if (!found.find(face, sideCount_, levelCount_)) return {};
        EndCap cap;
        cap.pattern = patternIndex(found.pattern()), cap.corner = std::uint32_t(found.corner());
        for (const FaceCorner& point : found.points()) cap.points.push_back(pointAt(point));
        if (found.pattern().window > 0) addRingSums(cap, found, pointAt, sums);
        cap.limit = limitIndex(sums, cap);
        return cap;
    }

    /// Means are one per vertex, in the order of the faces around whichever cap comes first; tangents are the cap's
    /// own.
    template <typename PointAt>
    void addRingSums(EndCap& cap, const CapWalker& found, const PointAt& pointAt, Sums& sums) {
        std::vector<int> ring;
        for (const FaceCorner& point : found.ring()) ring.push_back(pointAt(point));
        const Eigen::MatrixXd rows = ringSums(found.pattern());
        const int meanCount = int(rows.rows()) - 2;
        const auto [mean, isNew] = means_.try_emplace({&sums.all, cap.points[0]}, 0);
        for (int i = 0; i < meanCount && isNew; ++i) {
            const int sum = sums.append(ring, rows.row(i));
            if (i == 0) mean->second = sum;
        }
        for (int i = 0; i < meanCount; ++i) cap.points.push_back(mean->second + i);
        for (int i = 0; i < 2; ++i) cap.points.push_back(sums.append(ring, rows.row(meanCount + i)));
    }

    std::uint32_t patternIndex(const CapPattern& pattern) {
        std::vector<std::shared_ptr<const CapMatrices>>& patterns = tables_.caps.patterns;
        const auto [found, isNew] = patterns_.try_emplace(pattern, std::uint32_t(patterns.size()));
        if (isNew) patterns.push_back(std::make_shared<const CapMatrices>(pattern, levelCount_));
        return found->second;
    }

    /// One limit point per vertex, whichever of its caps comes first.
    std::uint32_t limitIndex(Sums& sums, const EndCap& cap) {
        const auto [found, isNew] = sums.known.try_emplace(cap.points[0], std::uint32_t(sums.all.size()));
        if (isNew) sums.append(cap.points, tables_.caps.patterns[cap.pattern]->limitWeights());
        return found->second;
    }

    FarTables& tables_;
    int levelCount_, sideCount_ = 4;
    std::vector<std::pair<int, int>> roots_; ///< per ptex face: face of the cage, and its corner in an n-gon or -1
    std::vector<int> firstPoints_, firstTexPoints_; ///< per level
    std::map<CapPattern, std::uint32_t> patterns_;
    std::map<int, std::uint32_t> limits_, texLimits_; ///< by the vertex's point
    std::map<std::pair<const void*, int>, int>
        means_; ///< the first mean of a ring, by the array of sums and the vertex
};

} // namespace

void findEndCaps(FarTables& tables, int levelCount) { CapFinder(tables, levelCount).find(); }

} // namespace relief
