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
    const NormalKind normal = row.hasNormals ? frame.options.normal : NormalKind::limit;
    ShaderConstants c =
        drawn.surface != nullptr ? relief::constantsOf(*drawn.surface, normal) : relief::constantsOf(*drawn.mesh);
    // What is not asked for is not compiled: passes without normals have neither pictures nor slopes.
    c.pass = row.constant;
    c.hasMips = drawn.rates.hasMips();
    c.readsNodes = drawn.surface != nullptr && readsNodes(*drawn.surface, drawn.rates);
    c.hasInstances = row.marksInstances && frame.hasInstances();
    c.isPlaced = row.hasNormals && drawn.inputs.view.normalToWorld != mat3(1);
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
        c.wantsTexCoords =
            c.hasAlbedoMap || (row.bendsNormals && (pictures.needTexCoords() || drawn.isBentByFunction()));
    }
    return c;
}

std::vector<Stage> Renderer::Parts::stagesOf(const Frame& frame, const Drawn& drawn, DrawPass pass) const {
    std::vector<Stage> stages;
    const auto add = [&](VkShaderStageFlagBits stage, const char* file, bool ofSurface) {
        stages.push_back(ofSurface ? shaderStage(device, stage, file, drawn.function(), drawn.isTriangles())
                                   : shaderStage(device, stage, file));
    };
    if (drawn.surface != nullptr && frame.path == Path::dice && pass == DrawPass::layers) {
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
        add(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, drawn.isBentByFunction());
    return stages;
}

const Pipeline& Renderer::Parts::pipelineOf(const Frame& frame, const Drawn& drawn, DrawPass pass) {
    // Everything in which two pipelines may differ is part of the key.
    const std::vector<std::uint32_t> constants = constantsOf(frame, drawn, pass).values();
    std::vector<std::uint32_t> key = constants;
    key.insert(key.end(), {std::uint32_t(pass), std::uint32_t(frame.path), drawn.mesh != nullptr, drawn.isTriangles()});
    const auto found = pipelines.find(key);
    if (found != pipelines.end()) return found->second;

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
    graphics.depthBias = row.drawsLines;
    return pipelines[key] = makeGraphics(device, graphics);
}

const Pipeline& Renderer::Parts::computePipeline(const char* file, const SurfaceModel* surface,
                                                 const ShaderConstants& constants) {
    const std::vector<std::uint32_t> values = constants.values();
    std::vector<std::uint32_t> key = values;
    key.push_back(surface != nullptr && surface->isTriangles() ? 1 : 0);
    for (const char* letter = file; *letter != 0; ++letter) key.push_back(std::uint32_t(*letter));
    const auto found = pipelines.find(key);
    if (found != pipelines.end()) return found->second;
    return pipelines[key] = makeCompute(
               device, {.name = file,
                        .stage = surface != nullptr ? shaderStage(device, VK_SHADER_STAGE_COMPUTE_BIT, file, *surface)
                                                    : shaderStage(device, VK_SHADER_STAGE_COMPUTE_BIT, file),
                        .constants = values,
                        .layout = passLayout(device)});
}

const Pipeline& Renderer::Parts::lightPipeline(const Frame& frame, bool addsLight) {
    return computePipeline("light.comp", nullptr,
                           {.show = frame.technique.constant,
                            .hasInstances = frame.hasInstances(),
                            .readsSampleBuffers = frame.raster == Raster::compute,
                            .readsShadowCodes = frame.shadowRaster == Raster::compute,
                            .hasSampleColors = frame.writesIds,
                            .shading = frame.shading,
                            .addsLight = addsLight,
                            .hasOcclusion = frame.hasOcclusion()});
}

const Pipeline& Renderer::Parts::occlusionPipeline(const Frame& frame) {
    return computePipeline("occlusion.comp", nullptr,
                           {.show = frame.technique.constant,
                            .readsSampleBuffers = frame.raster == Raster::compute,
                            .hasSampleColors = frame.writesIds});
}

} // namespace relief
