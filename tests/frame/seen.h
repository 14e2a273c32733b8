// What pictures show of normals: what the centres of pixels see, and a cube with islands to look at.
#pragma once

#include <algorithm>

#include "frame/device.h"
#include "meshes.h"

namespace relief::test {

inline Renderer& detailRenderer() {
    static Renderer instance(device(), {.width = 160, .height = 160, .shadowSide = 64});
    return instance;
}

/// What a pixel's centre sees.
struct Seen {
    int face = -1;
    dvec2 st{0};
    dvec3 normal{0};
    double height = 0;
};

inline std::vector<Seen> look(const Instance& instance, RenderOptions options, const dvec3& eye, double size) {
    options.layers = {Layer::normal, Layer::face, Layer::uv, Layer::height};
    options.bounds.add(dvec3(-4));
    options.bounds.add(dvec3(4));
    options.lighting.castsShadows = false;
    const double distance = glm::length(eye);
    options.camera = {.eye = eye,
                      .target = {0, 0, 0},
                      .fieldOfView = glm::degrees(2 * std::atan(size / distance)),
                      .nearDistance = 0.1 * distance,
                      .farDistance = 3 * distance};
    const Picture picture = detailRenderer().render(instance, options);
    std::vector<Seen> all;
    for (std::size_t i = 0; i < picture.layerValues.size(); i += kLayerChannels) {
        const float* v = &picture.layerValues[i];
        if (v[kLayerDepth] > 1e9f) continue;
        all.push_back({int(v[kLayerFace]),
                       {v[kLayerTexCoords], v[kLayerTexCoords + 1]},
                       {v[kLayerNormal], v[kLayerNormal + 1], v[kLayerNormal + 2]},
                       v[kLayerHeight]});
    }
    return all;
}

/// What a height function does to a surface.
enum class ByFunction { moves, bends, both };

inline FunctionHeights heightsByFunction(const std::string& expression, ByFunction how) {
    FunctionHeights heights;
    heights.function = std::make_shared<const HeightFunction>(
        FunctionText{"test", "float height(vec3 p, vec2 st, float t) { return " + expression + "; }"});
    heights.movesSurface = how != ByFunction::bends;
    heights.bendsNormals = how != ByFunction::moves;
    heights.bound = 1;
    heights.step = 3e-4f;
    return heights;
}

inline double rms(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value * value;
    return values.empty() ? 1e9 : std::sqrt(sum / double(values.size()));
}

inline double most(const std::vector<double>& values) {
    return values.empty() ? 1e9 : *std::ranges::max_element(values);
}

inline RenderOptions bilinear() {
    RenderOptions options;
    options.filter = Filter::bilinear;
    return options;
}

/// A path, and what makes samples of its triangles.
struct Way {
    Path path;
    Raster raster = Raster::hardware;
};

/// All that the device has.
inline std::vector<Way> detailWays() {
    std::vector<Way> ways{{Path::grid}, {Path::dice}};
    if (device().traits().hasTessellation) ways.push_back({Path::tessellation});
    if (device().traits().hasLongAtomics) ways.push_back({Path::dice, Raster::compute});
    return ways;
}

inline std::string nameOf(const Way& way) { return fmt::format("path {} raster {}", int(way.path), int(way.raster)); }

inline constexpr Path kDetailPaths[] = {Path::tessellation, Path::grid, Path::dice};

/// The square from (-1, -1) to (1, 1) in the plane z = 0.
inline Cage squareCage(bool hasTexCoords) {
    Cage plane;
    plane.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    if (hasTexCoords) plane.texCoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    addFace(plane, {0, 1, 2, 3}, hasTexCoords ? std::vector<std::uint32_t>{0, 1, 2, 3} : std::vector<std::uint32_t>{});
    return plane;
}

/// A cube whose faces have islands of their own in the texture, one in two of them mirrored.
inline Cage islands() {
    Cage cage = cubeOfIslands();
    for (std::size_t face = 0; face < 6; face += 2)
        std::swap(cage.texCorners[4 * face + 1], cage.texCorners[4 * face + 3]);
    return cage;
}

/// (u,v) of (s,t) in the island of a face: its corners are a parallelogram.
inline dvec2 uvOf(const Cage& cage, int face, const dvec2& st) {
    const auto corner = [&](int k) { return dvec2(cage.texCoords[cage.texCorners[std::size_t(4 * face + k)]]); };
    const glm::dmat2 sides(corner(1) - corner(0), corner(3) - corner(0));
    return glm::inverse(sides) * (st - corner(0));
}

struct Islands {
    Cage cage = islands();
    SurfaceOptions options{.isolation = 4};
    Surface surface = buildSurface(cage, options);
    ReferenceSurface reference{cage, options};
};

inline Islands& cubeWithIslands() {
    static Islands instance;
    return instance;
}

/// Angles between what is seen and a normal of the reference, in the middle of faces: at seams heights are the owner's,
/// and at corners end caps have second derivatives that jump.
inline std::vector<double> anglesTo(const std::vector<Seen>& pixels, const HeightMap* map, NormalKind kind) {
    Islands& cube = cubeWithIslands();
    std::vector<double> angles;
    for (const Seen& seen : pixels) {
        const dvec2 uv = uvOf(cube.cage, seen.face, seen.st);
        if (std::min({uv.x, uv.y, 1 - uv.x, 1 - uv.y}) < 0.2) continue;
        const DisplacedFrame frame = displacedFrame(cube.reference, map, seen.face, uv);
        const dvec3& normal = kind == NormalKind::limit        ? frame.normal
                              : kind == NormalKind::firstOrder ? frame.firstOrder
                                                               : frame.full;
        angles.push_back(degreesBetween(seen.normal, normal));
    }
    return angles;
}

} // namespace relief::test
