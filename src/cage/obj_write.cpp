#include "cage/cage.h"

#include <iterator>

namespace relief {

namespace {

using Text = fmt::memory_buffer;

template <typename... Args>
void put(Text& text, fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
}

/// A name must stay on its line.
std::string oneLine(std::string name) {
    for (char& letter : name)
        if (static_cast<unsigned char>(letter) < ' ' || letter == '\\') letter = '_';
    return name;
}

void putValues(Text& text, const Cage& cage) {
    for (const vec3& local : cage.positions) {
        const dvec3 p = cage.coordinates.toWorld(local);
        if (cage.coordinates.isIdentity())
            put(text, "v {} {} {}\n", local.x, local.y, local.z); // fewest digits that read back to the same float
        else
            put(text, "v {} {} {}\n", p.x, p.y, p.z);
    }
    for (const vec2& st : cage.texCoords) put(text, "vt {} {}\n", st.x, st.y);
    for (const vec3& n : cage.normals) put(text, "vn {} {} {}\n", n.x, n.y, n.z);
}

void putCorner(Text& text, const Cage& cage, std::size_t corner) {
    const bool hasNormal = !cage.normalCorners.empty();
    put(text, " {}", cage.corners[corner] + 1);
    if (cage.hasTexCoords() || hasNormal) put(text, "/");
    if (cage.hasTexCoords()) put(text, "{}", cage.texCorners[corner] + 1);
    if (hasNormal) put(text, "/{}", cage.normalCorners[corner] + 1);
}

void putFaces(Text& text, const Cage& cage) {
    std::size_t corner = 0, part = 0;
    for (std::size_t face = 0; face < cage.faceCount(); ++face) {
        for (; part < cage.parts.size() && cage.parts[part].firstFace <= face; ++part)
            put(text, "o {}\nusemtl {}\n", oneLine(cage.parts[part].name), oneLine(cage.parts[part].material));
        put(text, "f");
        for (std::uint32_t k = 0; k < cage.faceSizes[face]; ++k) putCorner(text, cage, corner++);
        put(text, "\n");
    }
}

void putTags(Text& text, const Cage& cage) {
    const Cage unset;
    for (std::size_t i = 0; i < cage.creaseSharpness.size(); ++i)
        put(text, "t crease 2/1/0 {} {} {}\n", cage.creaseEdges[2 * i], cage.creaseEdges[2 * i + 1],
            cage.creaseSharpness[i]);
    for (std::size_t i = 0; i < cage.sharpVertices.size(); ++i)
        put(text, "t corner 1/1/0 {} {}\n", cage.sharpVertices[i], cage.vertexSharpness[i]);
    for (const std::uint32_t hole : cage.holes) put(text, "t hole 1/0/0 {}\n", hole);
    if (cage.boundaryRule != unset.boundaryRule) put(text, "t interpolateboundary 1/0/0 {}\n", int(cage.boundaryRule));
    if (cage.texBoundaryRule != unset.texBoundaryRule)
        put(text, "t facevaryinginterpolateboundary 1/0/0 {}\n", int(cage.texBoundaryRule));
    if (cage.creaseMethod == CreaseMethod::chaikin) put(text, "t creasemethod 0/0/1 chaikin\n");
}

} // namespace

void writeObj(const std::string& path, const Cage& cage) {
    Text text;
    putValues(text, cage);
    putFaces(text, cage);
    putTags(text, cage);
    writeFile(path, {text.data(), text.size()});
}

} // namespace relief
