#include "measure/pictures.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr float kAmplification = 8; ///< of differences in the report
constexpr std::size_t kPictureRounds = 3;

std::string encodePng(const Image& image, const ScratchFolder& folder) {
    writeImage(folder / "image.png", image, SampleType::uint8);
    return readFile(folder / "image.png");
}

} // namespace

double PictureComparison::Comparison::rmse() const { return count > 0 ? std::sqrt(squares / count) : 0; }

PictureComparison::PictureComparison(SuiteContext& context, CompressionStudy& study)
    : context_(context), study_(study),
      renderer_(context.device,
                {.width = context.pictureSide() / 2, .height = context.pictureSide() / 2, .shadowSide = 1}) {
    // Two opposite views of the scene's outline.
    const TestScene& scene = study.scene();
    const std::vector<dvec3> points = outline(makeCoarseSurface(scene.cage, scene.surface.scheme), &scene.height);
    const std::vector<Camera> path = makeCameraPath(points);
    views_ = {path[0], path[2]};
    bounds_ = computeBounds(points);
    const MeshModel model = uploadDenseMesh(context.device, study.reference());
    for (std::size_t view = 0; view < views_.size(); ++view)
        reference_.push_back(finish(renderer_.render(model, renderOptions(view))));
}

RenderOptions PictureComparison::renderOptions(std::size_t view) const {
    RenderOptions options = makeRenderOptions(bounds_, views_[view]);
    options.path = Path::dice;
    options.filtersHeights = false;
    return options;
}

/// Writes the picture as relief render does and reads it back: differences are those that a user sees.
PictureComparison::View PictureComparison::finish(const Picture& picture) {
    const std::string path = folder_ / "picture.png";
    writePicture(path, picture);
    View view{.image = readImage(path), .isObject = {}, .png = readFile(path)};
    const Image linear = picture.image();
    for (std::size_t i = 3; i < linear.texels.size(); i += 4) view.isObject.push_back(linear.texels[i] > 0);
    RELIEF_CHECK(view.image.texels.size() == 3 * view.isObject.size());
    return view;
}

void PictureComparison::addView(Comparison& comparison, View view, const View& reference) {
    RELIEF_CHECK(view.image.texels.size() == reference.image.texels.size());
    for (std::size_t i = 0; i < view.image.texels.size(); ++i) {
        if (!reference.isObject[i / 3] && !view.isObject[i / 3]) continue;
        comparison.squares += std::pow(double(view.image.texels[i]) - reference.image.texels[i], 2.0);
        ++comparison.count;
    }
    comparison.views.push_back(std::move(view));
}

void PictureComparison::compare(double tolerance, const std::vector<PicturedMethod>& methods) {
    comparisons_.clear();
    std::vector<Model> models;
    models.reserve(methods.size());
    for (const PicturedMethod& method : methods)
        models.push_back(method.compression ? Model(study_.makeModel(*method.compression))
                                            : Model(uploadDenseMesh(context_.device, *method.mesh)));
    // Each round draws every method once, from the next view. The first rounds are compared; all but the first, which
    // compiles shaders, are timed.
    for (std::size_t round = 0; round < kPictureRounds; ++round)
        for (std::size_t i = 0; i < methods.size(); ++i) {
            const bool isCompared = round < views_.size();
            if (!isCompared && !methods[i].isTimed) continue;
            RenderOptions options = renderOptions(round % views_.size());
            if (methods[i].compression) options.rate = methods[i].compression->rate;
            const Picture picture = renderer_.render(models[i], options);
            Comparison& comparison = comparisons_[methods[i].method];
            if (round > 0 && methods[i].isTimed) comparison.frameTimes.push_back(picture.stats.wallMs);
            if (isCompared) addView(comparison, finish(picture), reference_[round]);
        }
    if (std::exchange(hasPair_, true)) return;
    addPair(tolerance, Method::denseRaw, Method::cageBc4Map);
    addPair(tolerance, Method::simplifiedRaw, Method::cageFloatMap);
}

void PictureComparison::addPair(double tolerance, Method left, Method right) {
    const auto a = comparisons_.find(left), b = comparisons_.find(right);
    if (a == comparisons_.end() || b == comparisons_.end()) return;
    const View &viewA = a->second.views[0], &viewB = b->second.views[0];
    Image difference = viewA.image;
    for (std::size_t i = 0; i < difference.texels.size(); ++i)
        difference.texels[i] = std::min(1.0f, kAmplification * std::abs(difference.texels[i] - viewB.image.texels[i]));
    context_.results.pictures.push_back(
        {study_.scene().name, fmt::format("RMS distance of {:g} % of the diagonal", 100 * tolerance), toWord(left),
         toWord(right), viewA.png, viewB.png, encodePng(difference, folder_)});
}

void PictureComparison::addTo(Row& row) const {
    const auto found = comparisons_.find(row.method);
    if (found == comparisons_.end()) return;
    const double rmse = found->second.rmse();
    row.addMeasured(Metric::pictureRmse, rmse);
    row.addMeasured(Metric::picturePsnr, rmse > 0 ? -20 * std::log10(rmse) : 99);
    if (!found->second.frameTimes.empty()) row.addMeasured(Metric::frameTime, found->second.frameTimes);
}

} // namespace relief
