// Which patches are end caps whose vertex has rules that stay, and the points around them.
#include <map>

#include "surface/cap_walk.h"

namespace relief {
namespace {

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
        if (found.pattern().window > 0) {
            std::vector<int> ring;
            for (const FaceCorner& point : found.ring()) ring.push_back(pointAt(point));
            addRingSums(cap, found.pattern(), ring, sums);
        }
        cap.limit = limitIndex(sums, cap);
        return cap;
    }

    /// Means and the limit point are one per vertex, in the order of the faces around whichever cap comes first;
    /// tangents are the cap's own.
    void addRingSums(EndCap& cap, const CapPattern& pattern, const std::vector<int>& ring, Sums& sums) {
        const auto [mean, isNew] = means_.try_emplace({&sums.all, cap.points[0]}, 0);
        if (isNew) {
            const Eigen::RowVectorXd limit = ringLimit(pattern);
            const Eigen::MatrixXd rows = ringMeans(pattern, limit);
            if (sums.known.emplace(cap.points[0], std::uint32_t(sums.all.size())).second) sums.append(ring, limit);
            mean->second = sums.first + int(sums.all.size());
            for (const auto& row : rows.rowwise()) sums.append(ring, row);
        }
        for (int i = 0; i < pattern.meanCount(); ++i) cap.points.push_back(mean->second + i);
        if (pattern.tangentCount() == 0) return;
        const Eigen::MatrixXd rows = ringTangents(pattern).rowwise() + ringLimit(pattern);
        for (const auto& row : rows.rowwise()) cap.points.push_back(sums.append(ring, row));
    }

    std::uint32_t patternIndex(const CapPattern& full) {
        const CapPattern pattern = full.ofWindow();
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
