// Words: tables of the names of enumerations, "did you mean", file extensions, amounts of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace relief {

/// One row of the table of an enumeration's names, as the command line, messages and reports use them. Each
/// enumeration has one table.
template <typename Value>
struct Word {
    const char* word; ///< as a user types it
    Value value;
    const char* help; ///< what the value means, a few words for --help
};

/// The word of a value; "" for a value that the table does not have.
template <typename Value, std::size_t kCount>
constexpr const char* wordOf(const Word<Value> (&table)[kCount], Value value) {
    for (const Word<Value>& row : table)
        if (row.value == value) return row.word;
    return "";
}

/// The extension of a file name with its dot, in lower case: ".obj" for "A/Cage.OBJ".
std::string lowerExtension(const std::string& path);

/// The candidate nearest to `word` by edit distance, for "did you mean"; "" when none is near.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

/// "4.2 MB": decimal units as file managers print them.
std::string humanBytes(std::uint64_t bytes);

} // namespace relief
