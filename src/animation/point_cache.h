// The bytes of .pc2 (little endian: magic, version, points, start frame, sample rate, samples, positions) and .mdd (big
// endian: frames, points, one time per frame, positions); all numbers have 32 bits.
#pragma once

#include <bit>

#include "animation/animation.h"

namespace relief {

inline constexpr std::string_view kPc2Magic{"POINTCACHE2\0", 12};
inline constexpr std::uint64_t kPc2HeaderBytes = 32;
inline constexpr std::endian kPc2Order = std::endian::little, kMddOrder = std::endian::big;

/// A word of a file as the processor has it, or the other way round.
inline std::uint32_t inOrder(std::uint32_t word, std::endian order) {
    return order == std::endian::native ? word : __builtin_bswap32(word);
}

} // namespace relief
