// Which shaders, constants and formats a pass has: decided by the rows of pass_table.h and by what is drawn.
#include "frame/renderer_parts.h"

namespace relief {
namespace {

std::uint32_t normalMapConstant(const ModelPictures& pictures) {
    if (!pictures.normalMap) return kNormalMapNone;
    return pictures.normalMap->space == NormalSpace::object ? kNormalMapObject : kNormalMapTangent;
}

} // namespace

ShaderConstants Renderer::Parts::constantsOf(const Frame& frame, const Drawn& drawn, DrawPass pass) const {
    const DrawPassRow& row = rowOf(pass);
    // Errors are measured along the normal of the surface that is displaced, whatever it is shaded by.
    const NormalKind asked = pass == DrawPass::errors ? NormalKind::full : frame.options.normal;
    const NormalKind normal = row.hasNormals ? asked : NormalKind::limit;
    ShaderConstants c =
        drawn.surface != nullptr ? relief::constantsOf(*drawn.surface, normal) : relief::constantsOf(*drawn.mesh);
    c.pass = row.constant;
    // Vertices of a diced mesh have their heights already; motion is evaluated again.
    if (drawn.surface != nullptr && (frame.path != Path::dice || row.namesPoints)) {
        c.hasMips = drawn.rates.hasMips();
        c.readsNodes = pass != DrawPass::errors && readsNodes(*drawn.surface, drawn.rates); // fragments lie anywhere
    }
    c.hasInstances = row.marksInstances && frame.hasInstances();
    c.isPlaced = row.hasNormals && drawn.inputs.view.normalToWorld != mat3(1);
    // What is not asked for is not compiled: passes without normals have neither pictures nor slopes.
    const ModelPictures& pictures = drawn.pictures();
    c.hasPictureTiles = row.hasNormals && pictures.haveTiles();
    if (row.bendsNormals) {
        c.hasTexGradients = pictures.needTexGradients() || drawn.isBentByFunction();
        c.hasSlopes = pictures.slopes.has_value() || drawn.isBentByFunction();
        c.normalMap = normalMapConstant(pictures);
    }
    // Of shadings, vertices and fragments know the one that is theirs.
    if (pass == DrawPass::surface && frame.shading == kShadingVertexTable) c.shading = frame.shading;
    if (pass == DrawPass::layers) {
        c.wantsTexCoords = true;
    } else if (row.hasNormals) {
        c.show = frame.technique.constant;
        c.hasAlbedoMap = pass == DrawPass::surface && frame.technique.wantsAlbedo && pictures.albedo && c.hasTexCoords;
        c.wantsTexCoords = c.hasAlbedoMap || (frame.technique.wantsTexCoords && c.hasTexCoords) ||
                           (row.bendsNormals && (pictures.needTexCoords() || drawn.isBentByFunction()));
    }
    return c;
}

std::vector<Stage> Renderer::Parts::stagesOf(const Frame& frame, const Drawn& drawn, DrawPass pass) const {
    std::vector<Stage> stages;
    const auto add = [&](VkShaderStageFlagBits stage, const char* file, bool ofSurface) {
        stages.push_back(ofSurface ? shaderStage(device, stage, file, drawn.function(), drawn.isTriangles())
                                   : shaderStage(device, stage, file));
    };
    if (drawn.surface != nullptr && frame.path == Path::dice && rowOf(pass).namesPoints) {
        add(VK_SHADER_STAGE_VERTEX_BIT, "diced_layers.vert", true);
    } else if (drawn.surface == nullptr || frame.path == Path::dice) {
        add(VK_SHADER_STAGE_VERTEX_BIT, "mesh.vert", drawn.isBentByFunction());
    } else if (frame.path == Path::grid) {
        add(VK_SHADER_STAGE_VERTEX_BIT, "grid.vert", true);
    } else {
        add(VK_SHADER_STAGE_VERTEX_BIT, "patch.vert", true);
        add(VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, "patch.tesc", true);
        add(VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, "patch.tese", true);
    }
    if (const char* fragment = rowOf(pass).fragment)
        add(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, drawn.isBentByFunction() || pass == DrawPass::errors);
    return stages;
}

const PendingPipeline& Renderer::Parts::drawPipeline(const Frame& frame, const Drawn& drawn, DrawPass pass) {
    // Everything in which two pipelines may differ is part of the key.
    const std::vector<std::uint32_t> constants = constantsOf(frame, drawn, pass).values();
    std::vector<std::uint32_t> key = constants;
    key.insert(key.end(), {std::uint32_t(pass), std::uint32_t(frame.path), drawn.mesh != nullptr, drawn.isTriangles()});
    return draws.of(key, [&] {
        // The fixed state follows from the row of the pass.
        const DrawPassRow& row = rowOf(pass);
        const bool isPatches = drawn.surface != nullptr && frame.path == Path::tessellation;
        GraphicsDesc graphics;
        graphics.name = row.name;
        graphics.stages = stagesOf(frame, drawn, pass);
        graphics.constants = constants;
        graphics.layout = passLayout(device);
        graphics.topology = isPatches ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        for (const VkFormat format : row.colors)
            if (format != VK_FORMAT_UNDEFINED) graphics.colorFormats.push_back(format);
        if (row.marksInstances && frame.hasInstances()) graphics.colorFormats.push_back(kInstanceFormat);
        graphics.depthFormat = row.depth;
        graphics.samples = row.samples;
        graphics.additiveBlend = row.isAdditive;
        graphics.polygonMode = row.drawsLines ? VK_POLYGON_MODE_LINE : VK_POLYGON_MODE_FILL;
        if (row.drawsLines) graphics.depthBiasUnits = kLineBiasUnits, graphics.depthBiasSlope = kLineBiasSlope;
        return startGraphics(device, std::move(graphics));
    });
}

const PendingPipeline& Renderer::Parts::lightPipeline(const Frame& frame, bool addsLight) {
    return computes.start("light.comp", {.show = frame.technique.constant,
                                         .hasInstances = frame.hasInstances(),
                                         .readsSampleBuffers = frame.raster == Raster::compute,
                                         .readsShadowCodes = frame.shadowRaster == Raster::compute,
                                         .hasSampleColors = frame.writesIds,
                                         .shading = frame.shading,
                                         .addsLight = addsLight,
                                         .hasOcclusion = frame.hasOcclusion()});
}

const PendingPipeline& Renderer::Parts::occlusionPipeline(const Frame& frame) {
    return computes.start("occlusion.comp", {.show = frame.technique.constant,
                                             .readsSampleBuffers = frame.raster == Raster::compute,
                                             .hasSampleColors = frame.writesIds});
}

// --- in advance -----------------------------------------------------------------------------------------------------

/// Starts all pipelines of a picture, in the order in which it needs them.
void Renderer::Parts::startPipelines(const Frame& frame) {
    const auto startPass = [&](const Drawn& drawn, DrawPass pass, Raster raster) {
        if (raster == Raster::compute) {
            rasterPipeline("raster_vertices.comp", frame, drawn, pass);
            rasterPipeline("raster_triangles.comp", frame, drawn, pass);
        } else {
            drawPipeline(frame, drawn, pass);
        }
    };
    for (const Drawn& drawn : frame.drawn)
        if (frame.castsShadows()) startPass(drawn, DrawPass::shadow, frame.shadowRaster);
    for (const Drawn& drawn : frame.drawn) {
        startPass(drawn, frame.technique.pass, frame.raster);
        if (frame.writesIds) resolvePipeline(frame, drawn);
        if (!frame.technique.hasLines) continue;
        if (frame.raster == Raster::compute)
            rasterPipeline("raster_lines.comp", frame, drawn, DrawPass::surface);
        else
            drawPipeline(frame, drawn, DrawPass::lines);
    }
    if (frame.hasOcclusion()) occlusionPipeline(frame);
    lightPipeline(frame);
}

namespace {

/// About how many triangles a surface gets that is measured in pixels and fills the picture, per pixel of the picture
/// and for segments of one pixel (octopus: 2.9, bigguy: 5).
constexpr double kTrianglesPerPixel = 3;

} // namespace

/// Starts the pipelines that a picture most probably needs, before rates and triangles are known.
void Renderer::Parts::startGuessedPipelines(Frame& frame) {
    const TriangleOptions& o = frame.options;
    double triangles = 0;
    for (const Drawn& drawn : frame.drawn) {
        if (drawn.mesh != nullptr) {
            triangles += drawn.mesh->triangleCount;
            continue;
        }
        rater.startPipelines(*drawn.surface, o);
        const bool hasMips = o.filtersHeights && drawn.surface->height;
        if (frame.path == Path::dice) dicer.startPipelines(*drawn.surface, diceOptionsOf(frame, drawn), hasMips);
        const double pixels = double(desc.width) * desc.height;
        triangles += o.rate ? 2.0 * double(drawn.surface->faces.size()) * *o.rate * *o.rate
                            : kTrianglesPerPixel * pixels / (o.edgePixels * o.edgePixels);
    }
    // What tessellation and grids need depends on rates; meshes are drawn alike.
    chooseRasters(frame, std::uint64_t(std::min(triangles, 1e9)));
    const bool areMeshes = std::ranges::all_of(frame.drawn, [](const Drawn& d) { return d.mesh != nullptr; });
    if (areMeshes || frame.path == Path::dice) startPipelines(frame);
}

} // namespace relief
