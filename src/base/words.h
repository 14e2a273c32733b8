// Tables of the words by which enumerations are named: on the command line, in messages and in reports.
#pragma once

#include <cstddef>

namespace relief {

/// One row of such a table. Each enumeration has one table, and defaults are named nowhere else.
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

} // namespace relief
