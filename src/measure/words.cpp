#include "measure/words.h"

#include <algorithm>
#include <array>
#include <stdexcept>

namespace relief {
namespace {

// clang-format off
constexpr MetricInfo kMetrics[] = {
    {Metric::frameTime, "frame time", Unit::milliseconds, "From the rates to the pixels on the host, with the pose where there is one."},
    {Metric::trianglePassTime, "triangle passes", Unit::milliseconds, "The dice pass and the color pass together, timed by the device."},
    {Metric::ratePassTime, "rate pass", Unit::milliseconds, "Computing the segments per edge, timed by the device."},
    {Metric::dicePassTime, "dice pass", Unit::milliseconds, "Writing the triangles of the surface to memory, timed by the device."},
    {Metric::colorPassTime, "color pass", Unit::milliseconds, "Drawing the triangles, timed by the device."},
    {Metric::lightPassTime, "light pass", Unit::milliseconds, "Shading the pixels, timed by the device."},
    {Metric::poseTime, "pose time", Unit::milliseconds, "Moving the cage or the mesh to a new pose, part of the frame time."},
    {Metric::triangles, "triangles", Unit::number, "Triangles of the whole object."},
    {Metric::distinctVertices, "distinct vertices", Unit::number, "Distinct samples of the surface: the vertices that a dense mesh stores."},
    {Metric::vertexInvocations, "vertex invocations", Unit::number, "Invocations of the vertex shader, counted by the device."},
    {Metric::tessellationInvocations, "tessellation invocations", Unit::number, "Invocations of the tessellation evaluation shader, counted by the device."},
    {Metric::primitives, "primitives", Unit::number, "Primitives that the draws submit, counted by the device."},
    {Metric::clippedPrimitives, "primitives after clipping", Unit::number, "Primitives that are left after clipping and culling, counted by the device."},
    {Metric::fragmentInvocations, "fragment invocations", Unit::number, "Invocations of the fragment shader, counted by the device."},
    {Metric::residentBytes, "resident bytes", Unit::bytes, "Memory of the device that holds the surface with its map, or the mesh."},
    {Metric::diskBytes, "bytes on disk", Unit::bytes, "The files of cage and map, or of the mesh."},
    {Metric::bytesReadCached, "bytes read per frame, cached", Unit::bytes, "Every resident byte once: caches hold everything."},
    {Metric::bytesReadUncached, "bytes read per frame, uncached", Unit::bytes, "Every fetch of every shader invocation: no caches."},
    {Metric::uploadedBytes, "bytes uploaded per pose", Unit::bytes, "What a new pose sends to the device."},
    {Metric::rmsError, "RMS error", Unit::diagonal, "Root mean square distance to the reference surface, both ways."},
    {Metric::hausdorffError, "Hausdorff error", Unit::diagonal, "Largest distance to the reference surface, both ways."},
    {Metric::pictureRmse, "picture RMSE", Unit::white, "Root mean square difference of display values over the pixels of the object, two views."},
    {Metric::picturePsnr, "picture PSNR", Unit::decibels, "Peak signal-to-noise ratio of the display values over the pixels of the object; 99 for equal pictures."},
    {Metric::mapColumns, "map columns", Unit::number, "Columns of the height map."},
    {Metric::rate, "rate", Unit::number, "Segments per edge of the cage."},
    {Metric::isolation, "isolation", Unit::number, "Depth of the refinement around extraordinary vertices."},
    {Metric::positionBits, "position bits", Unit::number, "Bits per coordinate of a position."},
    {Metric::imageColumns, "image columns", Unit::number, "Columns of the geometry image."},
    {Metric::mapFileExrZip, "map file, EXR zip", Unit::bytes, "The height map as EXR with zip compression."},
    {Metric::mapFileExrPiz, "map file, EXR piz", Unit::bytes, "The height map as EXR with piz compression."},
    {Metric::mapFilePng, "map file, PNG", Unit::bytes, "The height map as PNG."},
    {Metric::mapFileBlocks, "map file, blocks", Unit::bytes, "The height map as BC4 blocks."},
    {Metric::costPerTriangle, "cost per triangle", Unit::nanoseconds, "The triangle passes divided by the triangles."},
    {Metric::costPerAdditionalTriangle, "cost per additional triangle", Unit::nanoseconds, "The growth of the triangle passes since the fewest triangles, divided by the growth of the triangles."},
    {Metric::tableTime, "building tables", Unit::milliseconds, "OpenSubdiv's tables of the cage, on the host."},
    {Metric::uploadTime, "uploading tables", Unit::milliseconds, "Making the model on the device."},
    {Metric::preparationPerFace, "preparation per cage face", Unit::microseconds, "Building and uploading the tables, divided by the faces of the cage."},
    {Metric::surfaceAndMapBytes, "surface and map", Unit::bytes, "Buffers of the surface and of its map."},
    {Metric::bufferBytes, "all buffers", Unit::bytes, "Buffers and images of the frame at most."},
    {Metric::bufferBytesAtRate1, "all buffers, rate 1", Unit::bytes, "Buffers and images at most of a frame with one segment per edge."},
    {Metric::processBytes, "peak memory", Unit::bytes, "Resident memory of the process at most."},
    {Metric::processBytesAtRate1, "peak memory, rate 1", Unit::bytes, "Resident memory at most of a process that draws one segment per edge."},
    {Metric::memoryPerBufferByte, "memory per byte of buffers", Unit::ratio, "The growth of the peak memory since rate 1, with the buffers of rate 1, divided by all buffers."},
    {Metric::coldRunTime, "whole process, cold shaders", Unit::milliseconds, "A whole relief render without a cache of compiled shaders."},
    {Metric::warmRunTime, "whole process, cached shaders", Unit::milliseconds, "A whole relief render with the driver's cache of compiled shaders."},
    {Metric::deviceOpenTime, "opening the device", Unit::milliseconds, "Making the Vulkan device, a part of the whole process."},
    {Metric::warmFrameTime, "warm frame", Unit::milliseconds, "The frame of that process, in a process that has compiled its shaders before."},
    {Metric::coldRunPerFrame, "cold process less tables, per warm frame", Unit::ratio, "The whole process with cold shaders, less OpenSubdiv's tables, divided by the warm frame."},
    {Metric::errorPerFinerError, "error / that of displacement with segments a quarter as long", Unit::ratio, "Picture RMSE of this row divided by that of displacement alone at four times the rate."},
    {Metric::timePerFinerTime, "time / that of displacement with segments a quarter as long", Unit::ratio, "Frame time of this row divided by that of displacement alone at four times the rate."},
    {Metric::shadowPassTime, "shadow pass", Unit::milliseconds, "Drawing the triangles as the key light sees them, timed by the device."},
    {Metric::occlusionPassTime, "occlusion pass", Unit::milliseconds, "How much of its surroundings each pixel sees, timed by the device."},
    {Metric::otherLightsTime, "other lights", Unit::milliseconds, "The shadows and the light of all lights but the key light, timed by the device."},
};
// clang-format on

template <typename Enum>
struct Word {
    Enum value;
    const char* word;
};

constexpr Word<Unit> kUnits[] = {
    {Unit::number, ""},     {Unit::milliseconds, "ms"}, {Unit::microseconds, "us"},          {Unit::nanoseconds, "ns"},
    {Unit::bytes, "bytes"}, {Unit::ratio, "ratio"},     {Unit::diagonal, "of the diagonal"}, {Unit::white, "of white"},
    {Unit::decibels, "dB"},
};

constexpr Word<Method> kMethods[] = {
    {Method::cageFloatMap, "cage + float map"},
    {Method::cageHalfMap, "cage + half map"},
    {Method::cageUnorm16Map, "cage + 16 bit map"},
    {Method::cageUnorm8Map, "cage + 8 bit map"},
    {Method::cageBc4Map, "cage + BC4 map"},
    {Method::denseRaw, "dense mesh, raw"},
    {Method::denseQuantised, "dense mesh, quantised"},
    {Method::denseDraco, "dense mesh, Draco"},
    {Method::simplifiedRaw, "simplified mesh, raw"},
    {Method::simplifiedQuantised, "simplified mesh, quantised"},
    {Method::simplifiedDraco, "simplified mesh, Draco"},
    {Method::geometryImage, "geometry image"},
    {Method::tessellation, "tessellation"},
    {Method::grid, "grid"},
    {Method::dicing, "dicing"},
    {Method::dicingInCompute, "dicing, compute rasterizer"},
    {Method::denseInCompute, "dense mesh, compute rasterizer"},
    {Method::posedCage, "posed cage"},
    {Method::posedCageTessellation, "posed cage, tessellation"},
    {Method::posedCageDicing, "posed cage, dicing"},
    {Method::denseSkinnedOnDevice, "dense mesh, skinned on the device"},
    {Method::densePosedOnHost, "dense mesh, posed on the host"},
    {Method::preparation, "preparation"},
    {Method::reliefRender, "relief render"},
    {Method::displacement, "displacement"},
    {Method::displacementAndBump, "displacement and bump"},
    {Method::bump, "bump"},
    {Method::undisplaced, "undisplaced"},
    {Method::keyLight, "key light"},
    {Method::keyLightWithShadows, "key light with shadows"},
    {Method::keyLightWithOcclusion, "key light and occlusion"},
    {Method::threeLights, "three lights with shadows"},
    {Method::metal, "metal"},
    {Method::phong, "phong"},
    {Method::phongTable, "table"},
    {Method::matcap, "matcap"},
    {Method::water, "water over a floor"},
};

constexpr Word<Suite> kSuites[] = {
    {Suite::bandwidth, "bandwidth"}, {Suite::frame, "frame"},     {Suite::animate, "animate"},
    {Suite::memory, "memory"},       {Suite::scaling, "scaling"}, {Suite::startup, "startup"},
    {Suite::detail, "detail"},       {Suite::light, "light"},
};

constexpr Word<Axis> kAxes[] = {
    {Axis::none, ""},
    {Axis::tolerance, "tolerance"},
    {Axis::triangles, "triangles"},
    {Axis::pixelTriangles, "triangles of one pixel"},
    {Axis::faces, "cage faces"},
    {Axis::segmentPixels, "pixels per segment"},
};

constexpr Word<Origin> kOrigins[] = {{Origin::measured, "measured"}, {Origin::computed, "computed"}};

/// Rows stand in the order of their enumeration, so that a value is the number of its row.
template <typename Row, std::size_t kCount, typename Enum>
constexpr bool isComplete(const Row (&table)[kCount], Enum Row::*value, Enum last) {
    for (std::size_t i = 0; i < kCount; ++i)
        if (std::size_t(table[i].*value) != i) return false;
    return std::size_t(last) + 1 == kCount;
}
static_assert(isComplete(kMetrics, &MetricInfo::metric, Metric::otherLightsTime));
static_assert(isComplete(kUnits, &Word<Unit>::value, Unit::decibels));
static_assert(isComplete(kMethods, &Word<Method>::value, Method::water));
static_assert(isComplete(kSuites, &Word<Suite>::value, Suite::light));
static_assert(isComplete(kAxes, &Word<Axis>::value, Axis::segmentPixels));
static_assert(isComplete(kOrigins, &Word<Origin>::value, Origin::computed));

template <typename Enum, std::size_t kCount>
Enum findWord(const Word<Enum> (&table)[kCount], const std::string& word, const char* kind) {
    const auto found = std::ranges::find_if(table, [&](const Word<Enum>& row) { return row.word == word; });
    if (found == std::end(table)) throw std::invalid_argument(fmt::format("\"{}\" is no {}", word, kind));
    return found->value;
}

} // namespace

const MetricInfo& describe(Metric metric) { return kMetrics[std::size_t(metric)]; }

const char* toWord(Unit unit) { return kUnits[std::size_t(unit)].word; }
const char* toWord(Method method) { return kMethods[std::size_t(method)].word; }
const char* toWord(Suite suite) { return kSuites[std::size_t(suite)].word; }
const char* toWord(Axis axis) { return kAxes[std::size_t(axis)].word; }
const char* toWord(Origin origin) { return kOrigins[std::size_t(origin)].word; }

std::span<const Suite> allSuites() {
    static constexpr auto kAll = [] {
        std::array<Suite, std::size(kSuites)> all{};
        for (std::size_t i = 0; i < all.size(); ++i) all[i] = kSuites[i].value;
        return all;
    }();
    return kAll;
}

Suite parseSuite(const std::string& word) {
    try {
        return findWord(kSuites, word, "suite");
    } catch (const std::invalid_argument& error) {
        fail(Failure::input, "{}", error.what());
    }
}

void parseWord(const std::string& word, Suite& value) { value = findWord(kSuites, word, "suite"); }
void parseWord(const std::string& word, Method& value) { value = findWord(kMethods, word, "method"); }
void parseWord(const std::string& word, Axis& value) { value = findWord(kAxes, word, "axis"); }
void parseWord(const std::string& word, Origin& value) { value = findWord(kOrigins, word, "origin"); }
void parseWord(const std::string& word, Metric& value) {
    const auto found = std::ranges::find_if(kMetrics, [&](const MetricInfo& row) { return row.name == word; });
    if (found == std::end(kMetrics)) throw std::invalid_argument(fmt::format("\"{}\" is no metric", word));
    value = found->metric;
}

bool isCageAndMap(Method method) { return method <= Method::cageBc4Map; }

} // namespace relief
