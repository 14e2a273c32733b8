// Internal: which vertices a diced mesh has: topology, whatever the rates.
#pragma once

#include "shared/dice.h"
#include "triangles/triangles.h"

namespace relief {

/// Which samples of an edge surely lie in bicubic patches: those at low < t < high. None do where low >= high.
struct BicubicSpan {
    float low = 1, high = 0;
};

/// The samples of an edge of n segments that lie in a span: the first one, and one past the last.
std::pair<std::uint32_t, std::uint32_t> samplesIn(const BicubicSpan& span, std::uint32_t n, float rate);

struct DiceTable {
    std::vector<VertexRun> runs; ///< those of corners first
    std::uint32_t cornerRunCount = 0;
    std::uint32_t firstSmoothRun = 0;      ///< from here on: of smooth edges whose owner is one bicubic patch
    std::vector<BicubicSpan> bicubicSpans; ///< one per run before the smooth ones
    std::vector<FaceRuns> faceRuns;        ///< one per face
    TexelBuffer texels;                    ///< runs, then those around faces
    std::uint32_t firstFaceRuns = 0;
};

/// Makes the table of a model. Vertices of an edge or corner are repeated where its faces' normals or texture
/// coordinates differ.
DiceTable makeDiceTable(Device& device, const SurfaceModel& model);

/// How the vertices of each face are numbered, by the first vertices of runs and of the insides of faces.
std::vector<DicedFacePush> facePushes(const DiceTable& table, const SurfaceModel& model, const EdgeRates& rates,
                                      std::span<const std::uint32_t> runFirsts,
                                      std::span<const std::uint32_t> firstInsides);

/// One per vertex of a diced mesh: whether it lies on an edge of the cage that has one drawn face.
std::vector<char> boundaryVertices(const DiceTable& table, const SurfaceModel& model, const DicedMesh& mesh);

} // namespace relief
