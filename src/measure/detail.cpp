// The suite `detail`: what moving the surface, bending its normals, and both cost, and how near their pictures come.
#include <cmath>

#include "measure/suite.h"

namespace relief {
namespace {

constexpr double kReferencePixels = 0.25; ///< per segment, of the picture that others are compared with
constexpr double kSegmentPixels[] = {8, 4, 2, 1, 0.5};

/// A picture as it is displayed, and where it shows the object.
struct Shown {
    Image image; ///< display values 0..1
    std::vector<bool> isObject;
};

Shown show(const Picture& picture) {
    Shown shown{.image = displayed(picture), .isObject = {}};
    const Image linear = picture.image();
    for (std::size_t i = 3; i < linear.texels.size(); i += 4) shown.isObject.push_back(linear.texels[i] > 0);
    return shown;
}

/// Root mean square of the differences over the pixels in which either sees the object, of all views.
double computeRmse(std::span<const Shown> pictures, std::span<const Shown> references) {
    RELIEF_CHECK(pictures.size() == references.size());
    double squares = 0, count = 0;
    for (std::size_t view = 0; view < pictures.size(); ++view) {
        const Shown &picture = pictures[view], &reference = references[view];
        const std::size_t channels = std::size_t(picture.image.channels);
        for (std::size_t i = 0; i < picture.image.texels.size(); ++i) {
            if (!picture.isObject[i / channels] && !reference.isObject[i / channels]) continue;
            squares += std::pow(double(picture.image.texels[i]) - double(reference.image.texels[i]), 2.0);
            ++count;
        }
    }
    return count > 0 ? std::sqrt(squares / count) : 0;
}

RenderOptions optionsOf(const SceneOnDevice& on, double segmentPixels) {
    RenderOptions options = on.renderOptions(1);
    options.rate.reset();
    options.edgePixels = segmentPixels;
    options.path = Path::dice;
    return options;
}

std::vector<Shown> drawViews(Renderer& renderer, const SceneOnDevice& on, const Instance& instance,
                             RenderOptions options) {
    std::vector<Shown> views;
    for (const std::size_t view : {0, 2}) { // from opposite sides
        options.camera = on.views[view];
        views.push_back(show(renderer.render(instance, options)));
    }
    return views;
}

/// Adds how rows of displacement and bump compare with displacement alone whose segments are a quarter as long.
void addFinerRatios(Results& results, const std::string& scene) {
    const auto find = [&](Method method, double at) {
        return std::ranges::find_if(results.rows, [&](const Row& row) {
            return row.suite == Suite::detail && row.scene == scene && row.method == method && row.at == at;
        });
    };
    for (const double pixels : kSegmentPixels) {
        const auto row = find(Method::displacementAndBump, pixels), finer = find(Method::displacement, pixels / 4);
        if (row == results.rows.end() || finer == results.rows.end()) continue;
        const auto ratio = [&](Metric metric) { return row->get(metric) / finer->get(metric); };
        row->addComputed(Metric::errorPerFinerError, ratio(Metric::pictureRmse));
        row->addComputed(Metric::timePerFinerTime, ratio(Metric::frameTime));
    }
}

} // namespace

void measureDetail(SuiteContext& context, const TestScene& scene) {
    // The scene four times: displaced, displaced and bumped, bumped alone, smooth.
    Device& device = context.device;
    const SceneOnDevice on(device, scene);
    const auto makeModel = [&](bool isDisplaced, bool isBumped) {
        return SurfaceModel(device, {.surface = &on.surface,
                                     .cagePositions = scene.cage.positions,
                                     .height = isDisplaced ? &scene.height : nullptr,
                                     .encoding = &scene.heightEncoding,
                                     .bump = isBumped ? &scene.height : nullptr});
    };
    const SurfaceModel both = makeModel(true, true), bumped = makeModel(false, true), smooth = makeModel(false, false);
    const std::pair<Method, const SurfaceModel*> methods[] = {{Method::displacement, &on.model},
                                                              {Method::displacementAndBump, &both},
                                                              {Method::bump, &bumped},
                                                              {Method::undisplaced, &smooth}};

    const int side = context.pictureSide() / 2;
    Renderer renderer(device, {.width = side, .height = side, .shadowSide = 1});
    const std::vector<Shown> references = drawViews(renderer, on, on.model, optionsOf(on, kReferencePixels));

    // Lengths of segments take turns with methods, so that what slows the machine down for a while meets all of them.
    for (const double pixels : kSegmentPixels) {
        std::vector<TimedDrawing> drawings;
        for (const auto& [method, model] : methods)
            drawings.push_back({.method = method, .instance = *model, .options = optionsOf(on, pixels)});
        timeDrawings(renderer, on.views, context.roundCount(), drawings);
        for (const TimedDrawing& drawing : drawings) {
            Row row{Suite::detail, scene.name, drawing.method, Axis::segmentPixels, pixels, {}};
            drawing.addTo(row);
            row.addMeasured(Metric::pictureRmse,
                            computeRmse(drawViews(renderer, on, drawing.instance, drawing.options), references));
            context.results.rows.push_back(std::move(row));
        }
        context.progress.advance();
    }
    addFinerRatios(context.results, scene.name);
}

} // namespace relief
