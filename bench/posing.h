// Posing a cage: the device's stencils beside those of OpenSubdiv on the processor.
#pragma once

namespace relief::bench {

/// Poses several cages in interleaved rounds and prints how long that takes on the device, with CpuEvaluator and with
/// OmpEvaluator.
void benchPosing();

} // namespace relief::bench
