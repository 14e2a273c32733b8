// Points of a posed cage: the device's stencils next to those of OpenSubdiv on the processor.
#pragma once

namespace relief::bench {

/// Prints what posing takes on several cages, in interleaved rounds.
void benchPosing();

} // namespace relief::bench
