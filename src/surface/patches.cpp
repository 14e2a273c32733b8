// Patch table to flat patch records, and the tree of patches of each face.
#include "surface/far.h"

namespace relief {
namespace {

void insertPatch(Surface& surface, const Far::PatchParam& param, std::uint32_t patch) {
    dvec2 uv = patchCenter(param, surface.sideCount);
    std::uint32_t* entry = &surface.faces[param.GetFaceId()].root;
    for (int depth = depthInFace(param); depth > 0; --depth) {
        std::uint32_t children = *entry;
        if (children == kNoPatch) {
            *entry = children = std::uint32_t(surface.tree.size());
            surface.tree.insert(surface.tree.end(), 4, kNoPatch); // moves the entries: `entry` is not used below
        }
        const int child = surface.sideCount == 4 ? enterQuadChild(uv) : enterTriangleChild(uv);
        entry = &surface.tree[children + child];
    }
    *entry = kLeafBit | patch;
}

void fillFaces(Surface& surface, const FarTables& tables) {
    const Far::PtexIndices ptex(*tables.refiner);
    const auto& level = tables.refiner->GetLevel(0);
    surface.faces.assign(ptex.GetNumFaces(), Face{kNoPatch, {kNoPatch, kNoPatch, kNoPatch, kNoPatch}, 0});
    for (int cageFace = 0; cageFace < level.GetNumFaces(); ++cageFace) {
        const int size = level.GetFaceVertices(cageFace).size();
        const int faceCount = size == surface.sideCount ? 1 : size;
        for (int i = 0; i < faceCount; ++i) surface.faces[ptex.GetFaceId(cageFace) + i].cageFace = cageFace;
    }
}

const EndCap* capOf(const std::vector<std::optional<EndCap>>& caps, std::size_t patch) {
    return patch < caps.size() && caps[patch] ? &*caps[patch] : nullptr;
}

void addPoints(const EndCap& cap, std::uint32_t firstLimit, std::vector<std::uint32_t>& points) {
    points.push_back(firstLimit + cap.limit);
    points.insert(points.end(), cap.points.begin(), cap.points.end());
    for (std::size_t count = cap.points.size() + 1; count % 4 != 0; ++count) points.push_back(firstLimit + cap.limit);
}

void addCap(Patch& patch, const EndCap& cap, std::uint32_t firstLimit, std::vector<std::uint32_t>& points) {
    patch.type = patch.type == kPatchGregory ? kPatchExactQuad : kPatchExactTriangle;
    patch.cap = 4 * cap.pattern + cap.corner;
    addPoints(cap, firstLimit, points);
}

/// Appends a pattern's weights in the order of shared/surface.h.
void addCapTable(Surface& surface, const CapMatrices& matrices) {
    const Eigen::Index ringCount = matrices.pattern().pointCount();
    const auto pointCount = std::uint32_t((ringCount + 1 + 3) / 4 * 4);
    surface.capTables.push_back({std::uint32_t(surface.capWeights.size()), pointCount});
    std::vector<float>& weights = surface.capWeights;
    // The limit point is what the others are counted from: it has no weight, where it stands first and where it fills
    // up.
    const auto isOnRing = [&](Eigen::Index point) { return point >= 1 && point <= ringCount; };
    const auto add = [&](int level, int piece, Eigen::Index row, Eigen::Index point) {
        weights.push_back(isOnRing(point) ? float(matrices.pieceWeights(level, piece)(row, point - 1)) : 0);
    };
    for (int level = 1; level <= int(kCapLevels); ++level)
        for (Eigen::Index point = 0; point < pointCount; ++point) {
            if (surface.sideCount == 3) {
                for (int piece = 0; piece < int(kCapPieces); ++piece)
                    for (int row = 0; row < 12; ++row) add(level, piece, row, point);
                continue;
            }
            for (int x = 0; x < 4; ++x) add(level, 0, x, point);
            for (int i = 0; i < 16; ++i) add(level, 1, i, point);
            for (int y = 0; y < 4; ++y) add(level, 2, 4 * y, point);
        }
    const Eigen::MatrixXd& tangents = matrices.tangentWeights();
    for (Eigen::Index point = 0; point < pointCount; ++point)
        for (Eigen::Index j = 0; j < 4; ++j)
            weights.push_back(isOnRing(point) && j < 2 ? float(tangents(j, point - 1)) : 0);
}

void fillCapTables(Surface& surface, const EndCaps& caps) {
    for (const auto& pattern : caps.patterns) addCapTable(surface, *pattern);
}

} // namespace

int enterQuadChild(dvec2& uv) {
    const int right = uv.x >= 0.5, upper = uv.y >= 0.5;
    uv = 2.0 * uv - dvec2(right, upper);
    return right + 2 * upper;
}

int enterTriangleChild(dvec2& uv) {
    uv *= 2.0;
    if (uv.x >= 1) {
        uv.x -= 1;
        return 1;
    }
    if (uv.y >= 1) {
        uv.y -= 1;
        return 2;
    }
    if (uv.x + uv.y < 1) return 0;
    uv = dvec2(1) - uv; // the middle triangle is rotated
    return 3;
}

dvec2 patchCenter(const Far::PatchParam& param, int sideCount) {
    double u = 0.5, v = 0.5;
    if (sideCount == 4) {
        param.Unnormalize(u, v);
    } else {
        u = v = 1.0 / 3;
        param.UnnormalizeTriangle(u, v);
    }
    return {u, v};
}

void fillPatches(Surface& surface, const FarTables& tables) {
    fillFaces(surface, tables);
    fillCapTables(surface, tables.caps);
    const auto firstLimit = std::uint32_t(pointCount(tables)), firstTexLimit = texPointCount(tables);
    const Far::PatchTable& table = *tables.patches;
    if (tables.hasTexCoords) surface.texCaps.resize(std::size_t(table.GetNumPatchesTotal()));
    surface.patches.reserve(table.GetNumPatchesTotal());
    surface.patchPoints.reserve(table.GetNumControlVerticesTotal());
    for (int array = 0; array < table.GetNumPatchArrays(); ++array) {
        const std::uint32_t type = table.GetPatchArrayDescriptor(array).GetType();
        for (int i = 0; i < table.GetNumPatches(array); ++i) {
            // The patch, whose points follow those of the patches before it.
            const Far::PatchParam param = table.GetPatchParam(array, i);
            Patch patch{};
            patch.firstPoint = std::uint32_t(surface.patchPoints.size());
            patch.param0 = param.field0;
            patch.param1 = param.field1;
            patch.type = type;
            const std::size_t number = surface.patches.size();
            const EndCap* cap = capOf(tables.caps.surface, number);
            if (cap)
                addCap(patch, *cap, firstLimit, surface.patchPoints);
            else
                for (const int point : table.GetPatchVertices(array, i)) surface.patchPoints.push_back(point);
            patch.pointCount = std::uint32_t(surface.patchPoints.size()) - patch.firstPoint;
            // Its texture coordinates have a patch of their own, which may be of another type.
            if (tables.hasTexCoords) {
                const Far::PatchParam texParam = table.GetPatchFVarPatchParam(array, i);
                patch.texFirstPoint = std::uint32_t(surface.texPatchPoints.size());
                patch.texParam1 = texParam.field1;
                patch.texType = (texParam.IsRegular() ? table.GetFVarPatchDescriptorRegular()
                                                      : table.GetFVarPatchDescriptorIrregular())
                                    .GetType();
                if (const EndCap* texCap = capOf(tables.caps.texture, number)) {
                    patch.texType = surface.sideCount == 4 ? kPatchExactQuad : kPatchExactTriangle;
                    surface.texCaps[number] = 4 * texCap->pattern + texCap->corner;
                    addPoints(*texCap, firstTexLimit, surface.texPatchPoints);
                } else {
                    for (const int point : table.GetPatchFVarValues(array, i)) surface.texPatchPoints.push_back(point);
                }
                patch.texPointCount = std::uint32_t(surface.texPatchPoints.size()) - patch.texFirstPoint;
            }
            // Its leaf in the tree of its face.
            insertPatch(surface, param, std::uint32_t(surface.patches.size()));
            surface.patches.push_back(patch);
        }
    }
}

} // namespace relief
