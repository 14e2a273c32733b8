#include <span>
#include <sstream>

#include <tiny_obj_loader.h>

#include "cage/faces.h"
#include "cage/obj.h"

namespace relief {

namespace {

/// What tinyobjloader calls back into, a statement at a time: its interface without the 255-corner limit, repeated tags
/// and triangulation.
struct Builder {
    Cage cage;
    bool hasTexCoords = false, hasNormals = false;
    std::size_t positionCount = 0; ///< so far
    std::string name, material;    ///< of the faces to come

    void addFace(const tinyobj::index_t* corners, int count);
    void addFaceToPart();
};

/// OBJ counts from 1, or back from the latest value.
std::uint32_t fromZero(int index, std::size_t count) {
    return std::uint32_t(index > 0 ? std::size_t(index) - 1 : count - std::size_t(-std::int64_t(index)));
}

void Builder::addFace(const tinyobj::index_t* corners, int count) {
    cage.faceSizes.push_back(std::uint32_t(count));
    for (int i = 0; i < count; ++i) {
        cage.corners.push_back(fromZero(corners[i].vertex_index, positionCount));
        if (hasTexCoords) cage.texCorners.push_back(fromZero(corners[i].texcoord_index, cage.texCoords.size()));
        if (hasNormals) cage.normalCorners.push_back(fromZero(corners[i].normal_index, cage.normals.size()));
    }
    addFaceToPart();
}

void Builder::addFaceToPart() {
    std::vector<CagePart>& parts = cage.parts;
    if (parts.empty() || parts.back().name != name || parts.back().material != material)
        parts.push_back({.name = name, .material = material, .firstFace = std::uint32_t(cage.faceCount() - 1)});
    ++parts.back().faceCount;
}

Builder& builder(void* data) { return *static_cast<Builder*>(data); }

std::string joinWords(const char** words, int count) { return fmt::format("{}", fmt::join(words, words + count, " ")); }

tinyobj::callback_t makeCallbacks() {
    tinyobj::callback_t on;
    on.vertex_cb = [](void* data, float, float, float, float) { ++builder(data).positionCount; };
    on.texcoord_cb = [](void* data, float s, float t, float) { builder(data).cage.texCoords.emplace_back(s, t); };
    on.normal_cb = [](void* data, float x, float y, float z) { builder(data).cage.normals.emplace_back(x, y, z); };
    on.index_cb = [](void* data, tinyobj::index_t* corners, int count) { builder(data).addFace(corners, count); };
    on.object_cb = [](void* data, const char* name) { builder(data).name = name; };
    on.group_cb = [](void* data, const char** names, int count) { builder(data).name = joinWords(names, count); };
    on.usemtl_cb = [](void* data, const char* name, int) { builder(data).material = name; };
    return on;
}

Cage buildArrays(ObjScan& scan, const std::string& name) {
    Builder builder{.cage = {},
                    .hasTexCoords = scan.hasTexCoords,
                    .hasNormals = scan.hasNormals,
                    .positionCount = 0,
                    .name = "",
                    .material = ""};
    // The scan has counted everything: each array is allocated once.
    Cage& cage = builder.cage;
    cage.faceSizes.reserve(scan.faceCount);
    cage.corners.reserve(scan.cornerCount);
    cage.texCoords.reserve(scan.texCoordCount);
    if (scan.hasTexCoords) cage.texCorners.reserve(scan.cornerCount);

    // tinyobjloader must find what the scan has found, or line numbers in messages would be wrong.
    std::istringstream stream(std::move(scan.text));
    tinyobj::LoadObjWithCallback(stream, makeCallbacks(), &builder);
    if (builder.positionCount != scan.vertexCount || cage.texCoords.size() != scan.texCoordCount ||
        cage.faceCount() != scan.faceCount || cage.corners.size() != scan.cornerCount)
        fail(Failure::internal, "{}: tinyobjloader read {} vertices and {} faces of {} and {}", name,
             builder.positionCount, cage.faceCount(), scan.vertexCount, scan.faceCount);

    // Values that only some faces name are dropped; a single part without a name says nothing.
    if (!scan.hasTexCoords) cage.texCoords.clear();
    if (!scan.hasNormals) cage.normals.clear();
    const bool isOneNamelessPart = cage.parts.size() == 1 && builder.name.empty() && builder.material.empty();
    if (isOneNamelessPart) cage.parts.clear();
    return std::move(builder.cage);
}

/// Vertices without a face, often at the origin, do not say where the cage is.
Coordinates coordinatesOf(const Cage& cage, std::span<const dvec3> positions) {
    return coordinatesFor(computeBounds(cage.corners, [&](std::uint32_t corner) { return positions[corner]; }));
}

} // namespace

Cage parseObj(const std::string& text, const std::string& name, const Warn& warn,
              const std::optional<Coordinates>& coordinates) {
    ObjScan scan = scanObj(text, name, warn);
    Cage cage = buildArrays(scan, name);
    cage.coordinates = coordinates ? *coordinates : coordinatesOf(cage, scan.positions);
    cage.positions.reserve(scan.positions.size());
    for (const dvec3& p : scan.positions) cage.positions.emplace_back(cage.coordinates.toLocal(p));
    applyObjTags(scan.tags, cage, name, warn);
    removeDegenerateFaces(cage); // tags count them
    cage.missingTexCoords = scan.missingTexCoords;
    validateCage(cage, name);
    return cage;
}

} // namespace relief
