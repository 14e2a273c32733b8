// Evaluators of subdivision surfaces on the processor, by other projects: limit points with both first derivatives.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "cage/cage.h"

namespace relief::bench {

/// A point of a face of the cage; u and v are 0 at the face's first corner and run along its first and last edge.
struct PatchPoint {
    std::uint32_t face = 0;
    float u = 0, v = 0;
};

/// Makes (rate + 1)^2 points per face, borders included, face by face.
std::vector<PatchPoint> makeGridPoints(const Cage& cage, int rate);

/// The times of one evaluator, and its errors against the double-precision reference at a few hundred of the points, as
/// fractions of the longest side of the bounding box.
struct EvaluatorTime {
    std::string name;
    std::vector<double> rounds; ///< milliseconds, of 5 rounds
    double pointError = 0;      ///< largest distance of points where patches are exact
    double slopeError = 0;      ///< largest error of both derivatives there
    double endCapError = 0;     ///< largest distance in end caps at extraordinary vertices, which are approximations
};

/// Times OpenSubdiv's OmpEvaluator and CpuEvaluator, a loop over its Far patches, and Embree's rtcInterpolateN, each on
/// all cores (CpuEvaluator on one). Tables, refined points, patch coordinates and threads are ready before the clock
/// starts. Rounds are interleaved; `others` is called in each round, and once before.
/// Throws Failure::input unless all faces are quads and there are no holes (Embree numbers other faces in its own way),
/// and Failure::check where an evaluator's results are not the limit surface.
std::vector<EvaluatorTime> timeEvaluators(const Cage& cage, int isolation, std::span<const PatchPoint> points,
                                          const std::function<void()>& others);

} // namespace relief::bench
