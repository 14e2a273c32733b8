// Patch table to flat patch records, and the tree of patches of each face.
#include "surface/far.h"

namespace relief {
namespace {

/// Walks from a face's (u,v) to the child that holds it; (u,v) become the child's own coordinates.
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

} // namespace

void fillPatches(Surface& surface, const FarTables& tables) {
    fillFaces(surface, tables);
    const Far::PatchTable& table = *tables.patches;
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
            for (const int point : table.GetPatchVertices(array, i)) surface.patchPoints.push_back(point);
            // Its texture coordinates have a patch of their own, which may be of another type.
            if (tables.hasTexCoords) {
                const Far::PatchParam texParam = table.GetPatchFVarPatchParam(array, i);
                patch.texFirstPoint = std::uint32_t(surface.texPatchPoints.size());
                patch.texParam1 = texParam.field1;
                patch.texType = (texParam.IsRegular() ? table.GetFVarPatchDescriptorRegular()
                                                      : table.GetFVarPatchDescriptorIrregular())
                                    .GetType();
                for (const int point : table.GetPatchFVarValues(array, i)) surface.texPatchPoints.push_back(point);
            }
            // Its leaf in the tree of its face.
            insertPatch(surface, param, std::uint32_t(surface.patches.size()));
            surface.patches.push_back(patch);
        }
    }
}

} // namespace relief
