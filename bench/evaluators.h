// The CPU evaluators of subdivision surfaces that others offer, as opponents: limit points with both first derivatives.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "cage/cage.h"

namespace relief::bench {

/// A point of a face of the cage; (u,v) runs from the face's first corner along its first and last edge.
struct PatchPoint {
    std::uint32_t face = 0;
    float u = 0, v = 0;
};

/// (rate + 1)^2 points a face, borders included, face by face.
std::vector<PatchPoint> gridPoints(const Cage& cage, int rate);

/// What one evaluator took and how far it is from the double-precision reference, at a few hundred of the points.
struct EvaluatorTime {
    std::string name;
    std::vector<double> rounds; ///< milliseconds, of 5 rounds
    double pointError =
        0; ///< worst distance as a share of the longest side of the bounding box, where patches are exact
    double slopeError = 0;  ///< the same for both derivatives
    double endCapError = 0; ///< worst distance in end caps at extraordinary vertices, where evaluators approximate
};

/// OpenSubdiv's OmpEvaluator and CpuEvaluator, its Far patches walked by a loop of our own, and Embree's
/// rtcInterpolateN, each on all cores (CpuEvaluator on one). Tables, refined points, patch coordinates and threads are
/// ready before the clock starts; rounds are interleaved, and `others` runs in each, and once before. Throws
/// Failure::input unless the cage is all quads without holes (Embree numbers other faces in its own way),
/// Failure::check when an evaluator computes something else than the limit surface.
std::vector<EvaluatorTime> timeEvaluators(const Cage& cage, int isolation, std::span<const PatchPoint> points,
                                          const std::function<void()>& others);

} // namespace relief::bench
