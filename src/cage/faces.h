// Faces that cannot be subdivided, and what of a cage remains without them.
#pragma once

#include <span>

#include "cage/cage.h"

namespace relief {

/// Fills `kept` with the corners (0 ... size - 1) that do not repeat the vertex of the corner before them. None are
/// kept where fewer than 3 remain or where a vertex still comes twice: such a face is degenerate.
void findSoundCorners(std::span<const std::uint32_t> vertices, std::vector<std::uint32_t>& kept);

/// Removes repeated corners and degenerate faces. Holes and parts keep their faces, creases their edges; those of
/// removed faces go with them. Arrays agree in size beforehand, and crease edges exist.
void removeDegenerateFaces(Cage& cage);

} // namespace relief
