// The steps of reading an OBJ text, in order: scanObj checks lines, parseObj has tinyobjloader make arrays of them,
// applyObjTags adds what tinyobjloader cannot be asked for.
#pragma once

#include "cage/cage.h"

namespace relief {

/// One `t` line: its words by type. What they mean is not checked yet.
struct ObjTag {
    std::size_t line = 0;
    std::string name;
    std::vector<int> ints;
    std::vector<float> floats;
    std::vector<std::string> strings;
};

/// An OBJ text whose every line has been checked; after that tinyobjloader, which accepts anything, can be trusted.
struct ObjScan {
    std::string text; ///< only v, vt, vn, f, o, g and usemtl; one statement per line, comments and continuations gone
    std::vector<ObjTag> tags;
    std::vector<dvec3> positions; ///< of the v lines, whose numbers are not in the text
    std::size_t vertexCount = 0, texCoordCount = 0, normalCount = 0, faceCount = 0, cornerCount = 0;
    bool hasTexCoords = false;    ///< all faces name texture coordinates
    bool hasNormals = false;      ///< all faces name normals
    std::string missingTexCoords; ///< as Cage::missingTexCoords
};

/// Throws Failure::input, naming the line, for numbers that are not finite numbers, indices of vertices and texture
/// coordinates out of range, lines of more than 16 MB and files in which all faces are degenerate. Warns once each, of
/// the first on its line, of degenerate faces, of repeated corners (both still in the text) and of normals that are
/// missing.
ObjScan scanObj(std::string_view text, const std::string& name, const Warn& warn);

/// Adds creases, corners, holes and rules to the cage. Throws Failure::input, naming the line, for wrong sizes, indices
/// out of range, creases that are no edge of a face and values that do not exist. Unknown tags and hierarchical edits
/// are warned of once per name.
void applyObjTags(const std::vector<ObjTag>& tags, Cage& cage, const std::string& name, const Warn& warn);

/// A word of the file as it may stand in a message: short and printable.
std::string inQuotes(std::string_view word);

/// Throws Failure::input as "NAME:LINE: ...".
template <typename... Args>
[[noreturn]] void failAtLine(const std::string& name, std::size_t line, fmt::format_string<Args...> format,
                             Args&&... args) {
    fail(Failure::input, "{}:{}: {}", name, line, fmt::format(format, std::forward<Args>(args)...));
}

} // namespace relief
