#include "cage/cage.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "cage/edges.h"
#include "cage/gltf.h"

namespace relief {

namespace {

constexpr std::uint64_t kMaxCount = std::numeric_limits<std::int32_t>::max(); // OpenSubdiv counts with int

template <typename T>
std::uint64_t bytesOf(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

template <typename Vector>
void checkFinite(const std::vector<Vector>& values, const char* what, const std::string& name) {
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int k = 0; k < Vector::length(); ++k)
            if (!std::isfinite(values[i][k]))
                fail(Failure::input, "{}: {} {} is not finite ({}); give it numbers", name, what, i, values[i][k]);
}

void checkIndices(std::span<const std::uint32_t> indices, std::size_t count, const char* what,
                  const std::string& name) {
    for (const std::uint32_t index : indices)
        if (index >= count)
            fail(Failure::input, "{}: {} {} does not exist; there are {} (from 0)", name, what, index, count);
}

void checkSize(std::size_t size, std::size_t expected, const char* what, const std::string& name) {
    if (size != expected) fail(Failure::input, "{}: {} {}, {} expected", name, size, what, expected);
}

void checkSharpness(const std::vector<float>& sharpness, const char* what, const std::string& name) {
    for (std::size_t i = 0; i < sharpness.size(); ++i)
        if (!std::isfinite(sharpness[i]) || sharpness[i] < 0)
            fail(Failure::input, "{}: {} {} has sharpness {}; it must be 0 or more (10 is infinitely sharp)", name,
                 what, i, sharpness[i]);
}

void checkFaces(const Cage& cage, const std::string& name) {
    std::uint64_t first = 0;
    std::vector<std::uint32_t> sorted;
    for (std::size_t face = 0; face < cage.faceCount(); ++face) {
        const std::uint32_t size = cage.faceSizes[face];
        if (size < 3) fail(Failure::input, "{}: face {} has {} corners; a face needs 3 or more", name, face, size);
        if (first + size > cage.corners.size())
            fail(Failure::input, "{}: face {} ends at corner {}, there are {}", name, face, first + size,
                 cage.corners.size());
        sorted.assign(cage.corners.begin() + std::ptrdiff_t(first),
                      cage.corners.begin() + std::ptrdiff_t(first + size));
        std::sort(sorted.begin(), sorted.end());
        const auto twin = std::adjacent_find(sorted.begin(), sorted.end());
        if (twin != sorted.end())
            fail(Failure::input, "{}: face {} uses vertex {} twice; each corner needs a vertex of its own", name, face,
                 *twin);
        first += size;
    }
    checkSize(cage.corners.size(), first, "corners", name);
}

void checkCreases(const Cage& cage, const std::string& name) {
    checkSize(cage.creaseEdges.size(), 2 * cage.creaseSharpness.size(), "crease vertices", name);
    checkSharpness(cage.creaseSharpness, "crease", name);
    if (cage.creaseEdges.empty()) return;
    const std::vector<EdgeUse> uses = sortedEdgeUses(cage);
    for (std::size_t i = 0; i < cage.creaseEdges.size(); i += 2)
        if (!hasEdge(uses, cage.creaseEdges[i], cage.creaseEdges[i + 1]))
            fail(Failure::input, "{}: crease {} joins vertices {} and {}, which no face has as an edge", name, i / 2,
                 cage.creaseEdges[i], cage.creaseEdges[i + 1]);
}

void checkParts(const Cage& cage, const std::string& name) {
    std::uint64_t face = 0;
    for (const CagePart& part : cage.parts) {
        if (part.firstFace != face)
            fail(Failure::input, "{}: part '{}' starts at face {}, {} expected", name, part.name, part.firstFace, face);
        face += part.faceCount;
    }
    if (!cage.parts.empty()) checkSize(face, cage.faceCount(), "faces in parts", name);
}

} // namespace

bool Cage::isAllTriangles() const {
    return std::all_of(faceSizes.begin(), faceSizes.end(), [](std::uint32_t size) { return size == 3; });
}

std::uint64_t Cage::byteCount() const {
    return bytesOf(positions) + bytesOf(faceSizes) + bytesOf(corners) + bytesOf(texCoords) + bytesOf(texCorners) +
           bytesOf(creaseEdges) + bytesOf(creaseSharpness) + bytesOf(sharpVertices) + bytesOf(vertexSharpness) +
           bytesOf(holes);
}

void validateCage(const Cage& cage, const std::string& name) {
    if (cage.faceSizes.empty()) fail(Failure::input, "{}: there are no faces; a cage needs at least one", name);
    const std::uint64_t largest = std::max({cage.positions.size(), cage.corners.size(), cage.texCoords.size()});
    if (largest > kMaxCount)
        fail(Failure::input, "{}: {} vertices or corners; up to {} are possible", name, largest, kMaxCount);
    checkFinite(cage.positions, "vertex", name);
    checkFinite(cage.texCoords, "texture coordinate", name);
    checkFinite(cage.normals, "normal", name);
    checkIndices(cage.corners, cage.positions.size(), "vertex", name);
    checkFaces(cage, name);
    if (cage.hasTexCoords()) checkSize(cage.texCorners.size(), cage.corners.size(), "texture corners", name);
    checkIndices(cage.texCorners, cage.texCoords.size(), "texture coordinate", name);
    if (!cage.normalCorners.empty()) checkSize(cage.normalCorners.size(), cage.corners.size(), "normal corners", name);
    checkIndices(cage.normalCorners, cage.normals.size(), "normal", name);
    checkIndices(cage.creaseEdges, cage.positions.size(), "crease vertex", name);
    checkCreases(cage, name);
    checkIndices(cage.sharpVertices, cage.positions.size(), "sharp vertex", name);
    checkSize(cage.vertexSharpness.size(), cage.sharpVertices.size(), "vertex sharpnesses", name);
    checkSharpness(cage.vertexSharpness, "sharp vertex", name);
    checkIndices(cage.holes, cage.faceCount(), "hole face", name);
    checkParts(cage, name);
}

void recenter(Cage& cage) {
    const Bounds bounds = computeBounds(cage.corners, [&](std::uint32_t corner) { return cage.positions[corner]; });
    const dvec3 shift = coordinatesFor(bounds).origin;
    if (shift == dvec3(0)) return;
    for (vec3& p : cage.positions) p = dvec3(p) - shift;
    cage.coordinates.origin += cage.coordinates.unit * shift;
}

Cage readCage(const std::string& path, const Warn& warn) {
    const std::string extension = lowerExtension(path);
    if (extension == ".gltf" || extension == ".glb") return readGltfCage(path, warn);
    if (extension != ".obj")
        fail(Failure::input, "{}: unknown kind of cage '{}'; use .obj, .gltf or .glb", path, extension);
    return parseObj(readFile(path), path, warn);
}

} // namespace relief
