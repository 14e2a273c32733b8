// The suite `light`: what shadows, occlusion, more lights and other shadings add to a frame.
#include "measure/suite.h"

namespace relief {

void measureLight(SuiteContext& context, const TestScene& scene) {
    const SceneOnDevice on(context.device, scene);
    const int side = context.pictureSide() / 2;
    Renderer renderer(context.device, {.width = side, .height = side, .shadowSide = 1024});

    // One light, what goes with it, and shadings in place of the material's.
    std::vector<TimedDrawing> drawings;
    const auto add = [&](Method method) -> TimedDrawing& {
        drawings.push_back({.method = method, .instance = on.model, .options = on.renderOptions(1)});
        RenderOptions& options = drawings.back().options;
        options.rate.reset();
        options.edgePixels = 2;
        options.path = Path::dice;
        return drawings.back();
    };
    add(Method::keyLight);
    add(Method::keyLightWithShadows).options.lighting.castsShadows = true;
    add(Method::keyLightWithOcclusion).options.lighting.occlusionRadius = 0.05;
    Lighting& three = add(Method::threeLights).options.lighting;
    three.castsShadows = true;
    three.others = {{.azimuth = 120, .elevation = 20}, {.azimuth = 240, .elevation = 50}};
    add(Method::metal).instance.material = {.roughness = 0.2f, .metallic = 1.0f};
    for (const auto& [method, shading] :
         {std::pair(Method::phong, Shading::phong), std::pair(Method::phongTable, Shading::table),
          std::pair(Method::water, Shading::water), std::pair(Method::matcap, Shading::matcap)})
        add(method).options.shading = shading;

    const GpuMatcap ball = uploadMatcap(context.device, renderMatcap(context.device, {}, {}, dvec2(0), 256));
    drawings.back().options.matcap = &ball; // without one, each frame would draw its own

    timeDrawings(renderer, on.views, context.roundCount(), drawings);
    for (const TimedDrawing& drawing : drawings) {
        Row row{.suite = Suite::light, .scene = scene.name, .method = drawing.method};
        row.addMeasured(Metric::frameTime, drawing.frameTimes);
        row.addMeasured(Metric::lightPassTime, drawing.lightTimes);
        if (drawing.options.lighting.castsShadows) row.addMeasured(Metric::shadowPassTime, drawing.shadowTimes);
        if (drawing.options.lighting.occlusionRadius > 0)
            row.addMeasured(Metric::occlusionPassTime, drawing.occlusionTimes);
        if (!drawing.options.lighting.others.empty())
            row.addMeasured(Metric::otherLightsTime, drawing.otherLightsTimes);
        context.results.rows.push_back(std::move(row));
    }
    context.progress.advance();
}

} // namespace relief
