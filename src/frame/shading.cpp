// How surfaces shade: materials, tables, balls, distant lights, and what of the environment the surface hides.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "frame/renderer_parts.h"

namespace relief {
namespace {

Texture uploadColors(Device& device, const char* name, const Image& image) {
    std::vector<float> texels; // RGBA
    texels.reserve(image.texels.size() / 3 * 4);
    for (std::size_t i = 0; i < image.texels.size(); i += 3)
        texels.insert(texels.end(), {image.texels[i], image.texels[i + 1], image.texels[i + 2], 1.0f});
    return uploadTexture(device,
                         {.name = name,
                          .width = std::uint32_t(image.width),
                          .height = std::uint32_t(image.height),
                          .format = VK_FORMAT_R32G32B32A32_SFLOAT},
                         std::as_bytes(std::span(texels)), 4 * sizeof(float));
}

/// A ball of radius 1 with exact normals, of 2 n^2 triangles around the axis Z.
DenseMesh makeBall(std::uint32_t n) {
    constexpr double kPi = std::numbers::pi;
    DenseMesh ball;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= n; ++i) {
            const double theta = kPi * j / n, phi = 2 * kPi * i / n;
            const vec3 p(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            ball.positions.push_back(p);
            ball.normals.push_back(p);
        }
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < n; ++i) {
            const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
            ball.indices.insert(ball.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    return ball;
}

/// Colors of what the ball covers of each pixel, which are means of `part` x `part` pixels.
Image toBall(const Image& picture, int part) {
    const int side = picture.width / part;
    Image ball{side, side, 3, std::vector<float>(std::size_t(side) * std::size_t(side) * 3)};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            vec4 sum(0);
            for (int k = 0; k < part * part; ++k) {
                const float* c = picture.at(part * x + k % part, part * y + k / part);
                sum += vec4(c[0], c[1], c[2], c[3]);
            }
            for (int c = 0; c < 3 && sum.w > 0; ++c) ball.at(x, y)[c] = sum[c] / sum.w;
        }
    return ball;
}

} // namespace

BallStudio::BallStudio(Device& device, int side)
    : mesh(makeBall(256)), model(device, {.mesh = &mesh}),
      renderer(device, {.width = side, .height = side, .shadowSide = 1}) {}

Image BallStudio::draw(const Material& material, Lighting lighting, const dvec3& back) {
    constexpr double kDistance = 1e3;
    RenderOptions options;
    options.lighting = std::move(lighting);
    options.lighting.castsShadows = false;
    options.lighting.occlusionRadius = 0;
    options.bounds = computeBounds(mesh.positions);
    options.raster = Raster::hardware;
    options.camera = {.eye = kDistance * back,
                      .fieldOfView = 2 * std::asin(1 / kDistance) * 180 / std::numbers::pi,
                      .nearDistance = kDistance - 2,
                      .farDistance = kDistance + 2};
    return renderer.render(Instance(model, material), options).image();
}

// --- what is shaded with ------------------------------------------------------------------------------------------

std::uint32_t shadingOf(std::span<const Instance> instances, const RenderOptions& options) {
    const auto conserves = [](const Instance& instance) { return instance.material.metallic.has_value(); };
    switch (options.shading) {
    case Shading::physical: return std::ranges::any_of(instances, conserves) ? kShadingConserving : kShadingPhysical;
    case Shading::phong: return kShadingPhong;
    case Shading::table: return options.tableAtVertices ? kShadingVertexTable : kShadingTable;
    case Shading::water: return kShadingWater;
    case Shading::matcap: break;
    }
    return kShadingMatcap;
}

pass::Material toPass(const Material& material, std::uint32_t shading) {
    const float least = shading == kShadingConserving || shading == kShadingWater ? 0.0f : 0.05f;
    return {.albedo = material.albedo,
            .roughness = std::clamp(material.roughness, least, 1.0f),
            .environmentLevel = 0,
            .metallic = material.metallic.value_or(0.0f)};
}

Image makeShadingTable(const PhongCoefficients& phong) {
    Image table{kShadingTableSide, kShadingTableSide, 3, {}};
    for (int t = 0; t < kShadingTableSide; ++t)
        for (int s = 0; s < kShadingTableSide; ++s) {
            const double nl = s / double(kShadingTableSide - 1), vr = t / double(kShadingTableSide - 1);
            const double diffuse = phong.ambient + phong.diffuse * nl;
            table.texels.insert(table.texels.end(),
                                {float(diffuse), float(phong.specular * std::pow(vr, phong.exponent)), 0.0f});
        }
    return table;
}

GpuMatcap uploadMatcap(Device& device, Image ball) {
    RELIEF_CHECK(ball.width == ball.height);
    fillRing(ball);
    return {uploadColors(device, "matcap", ball)};
}

Image renderMatcap(Device& device, const Material& material, const Lighting& lighting, const dvec2& from, int side) {
    // Twice as many pixels each way as the picture has: the rim has no steps.
    return toBall(BallStudio(device, 2 * side).draw(material, lighting, directionAt(from.x, from.y)), 2);
}

/// The ball that stands for the picture's own material and lights, as its camera sees them.
void Renderer::Parts::makeOwnMatcap(const Material& material, const RenderOptions& options) {
    constexpr int kSide = 1024;
    const dvec3 back = glm::normalize(options.camera.eye - options.camera.target);
    if (!ball) ball = std::make_unique<BallStudio>(device, kSide);
    ownMatcap = uploadMatcap(device, toBall(ball->draw(material, options.lighting, back), 1));
}

void Renderer::Parts::useShading(Frame& frame) {
    const PhongCoefficients& phong = frame.options.phong;
    frame.inputs.light.phong = {phong.ambient, phong.diffuse, phong.specular, phong.exponent};
    const WaterFloor& floor = frame.options.waterFloor;
    frame.inputs.light.floorColor = floor.color;
    frame.inputs.light.floorHeight = float(floor.height);
    frame.inputs.light.floorDepth = float(floor.depth);
    frame.inputs.light.floorTile = float(floor.tile);
    const auto use = [&](const Texture& texture) {
        frame.bindings[kBindShading] = {.view = texture.view.get(), .sampler = smooth.get()};
    };
    if (frame.shading == kShadingTable || frame.shading == kShadingVertexTable) {
        if (!shadingTable || tablePhong != phong)
            shadingTable = uploadColors(device, "shading table", makeShadingTable(phong)), tablePhong = phong;
        use(*shadingTable);
    }
    if (frame.shading != kShadingMatcap) return;
    const GpuMatcap* ball = frame.options.matcap != nullptr ? frame.options.matcap : ownMatcap ? &*ownMatcap : nullptr;
    if (ball != nullptr) use(ball->ball); // crossings need no light
    // The ball has the material's color: what is left to multiply it by is a color map.
    for (pass::Material& material : frame.materials) material.albedo = vec3(1);
}

// --- distant lights -----------------------------------------------------------------------------------------------

DistantLight keyOf(const Lighting& lighting) {
    return {.azimuth = lighting.keyAzimuth,
            .elevation = lighting.keyElevation,
            .strength = lighting.keyStrength,
            .color = lighting.keyColor};
}

/// Makes a light the one of the shadow map. Its shadow is softened over three texels and biased by one and a half.
void Renderer::Parts::useLight(Frame& frame, const DistantLight& from) {
    const RenderOptions& o = frame.options;
    pass::Light& light = frame.inputs.light;
    const dvec3 direction = directionAt(from.azimuth, from.elevation);
    light.keyDirection = vec3(direction);
    light.keyRadiance = vec3(float(from.strength)) * from.color;
    light.hasShadows = frame.castsShadows() ? 1 : 0;
    light.toShadow = shadowMatrix(direction, o.bounds);
    light.shadowBias = float(1.5 * o.bounds.diagonal() / desc.shadowSide);
    light.shadowSoftness = 3.0f / float(desc.shadowSide);
    light.shadowSide = std::uint32_t(desc.shadowSide);
    for (Drawn& drawn : frame.drawn) {
        drawn.inputs.light = light;
        drawn.inputs.light.toShadow = mat4(glm::dmat4(light.toShadow) * drawn.toWorld);
    }
}

/// The other lights, one after another: each has the shadow map, and is added to the picture.
void Renderer::Parts::otherLightPasses(VkCommandBuffer commands, Frame& frame) {
    for (const DistantLight& light : frame.otherLights()) {
        useLight(frame, light);
        writeInputs(commands, frame);
        if (frame.castsShadows()) shadowPass(commands, frame);
        if (frame.shading == kShadingVertexTable) { // vertices know the light's direction
            if (frame.raster == Raster::compute)
                resolve(commands, frame);
            else
                surfacePass(commands, frame);
        }
        lightPass(commands, frame, true);
    }
    useLight(frame, keyOf(frame.options.lighting)); // a picture with large triangles is recorded once more
}

// --- occlusion ----------------------------------------------------------------------------------------------------

void Renderer::Parts::useOcclusion(Frame& frame) {
    const std::uint64_t pixels = std::uint64_t(desc.width) * std::uint64_t(desc.height);
    if (occlusion.bytes == 0) occlusion = makeBuffer(device, {.name = "occlusion", .bytes = 8 * pixels});
    frame.inputs.targets.occlusion = occlusion.address;
    const double radius = frame.options.lighting.occlusionRadius * frame.options.bounds.diagonal();
    frame.inputs.light.occlusionRadius = float(radius);
}

void Renderer::Parts::occlusionPass(VkCommandBuffer commands, const Frame& frame) {
    bind(commands, occlusionPipeline(frame).get(), frame.set);
    vkCmdDispatch(commands, std::uint32_t(desc.width + 7) / 8, std::uint32_t(desc.height + 7) / 8, 1);
    barrier(commands);
}

} // namespace relief
