#include "measure/looks.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr float kAmplification = 8; ///< of differences in the report
constexpr std::size_t kRounds = 3;

std::string pngOf(const Image& image, const ScratchFolder& folder) {
    writeImage(folder / "image.png", image, SampleType::uint8);
    return readFile(folder / "image.png");
}

} // namespace

Looks::Looks(Bench& bench, Contest& contest)
    : bench_(bench), contest_(contest),
      renderer_(bench.device, {.width = bench.pictureSide() / 2, .height = bench.pictureSide() / 2, .shadowSide = 1}) {
    const ReferenceSurface coarse(contest.subject().cage, {.scheme = contest.subject().surface.scheme, .isolation = 2});
    const std::vector<dvec3> points = outline(coarse, &contest.subject().height);
    const std::vector<Camera> path = cameraPath(points);
    views_ = {path[0], path[2]};
    for (const dvec3& p : points) bounds_.add(p);
    const MeshModel model(bench.device, {.mesh = &contest.reference()});
    RenderOptions options;
    options.bounds = bounds_;
    options.lighting.castsShadows = false;
    for (const Camera& view : views_) {
        options.camera = view;
        reference_.push_back(seen(renderer_.render(model, options)));
    }
}

Looks::Seen Looks::seen(const Picture& picture) {
    const std::string path = folder_ / "picture.png";
    writePicture(path, picture);
    Seen seen{.image = readImage(path), .png = readFile(path)};
    const Image linear = picture.image();
    for (std::size_t i = 3; i < linear.texels.size(); i += 4) seen.isObject.push_back(linear.texels[i] > 0);
    return seen;
}

void Looks::compare(Look& look, Seen seen, const Seen& reference) {
    for (std::size_t i = 0; i < seen.image.texels.size(); ++i) {
        if (!reference.isObject[i / 3] && !seen.isObject[i / 3]) continue;
        look.squares += std::pow(double(seen.image.texels[i]) - reference.image.texels[i], 2.0);
        ++look.count;
    }
    look.pngs.push_back(std::move(seen.png));
    look.images.push_back(std::move(seen.image));
}

/// Rounds draw every contestant once, view after view: the pictures of the first two are compared, and all but the
/// first, which compiles shaders, are timed.
void Looks::judge(double tolerance, const std::vector<Drawable>& all) {
    looks_.clear();
    std::vector<Model> models;
    models.reserve(all.size());
    for (const Drawable& drawable : all)
        models.push_back(drawable.saving ? Model(std::move(*contest_.model(*drawable.saving)))
                                         : Model(MeshModel(bench_.device, {.mesh = drawable.mesh})));
    for (std::size_t round = 0; round < kRounds; ++round)
        for (std::size_t i = 0; i < all.size(); ++i) {
            const bool isCompared = round < views_.size();
            if (!isCompared && !all[i].isTimed) continue;
            RenderOptions options;
            options.bounds = bounds_;
            options.lighting.castsShadows = false;
            options.path = Path::dice;
            options.filtersHeights = false;
            options.camera = views_[round % views_.size()];
            if (all[i].saving) options.rate = all[i].saving->rate;
            const Picture picture = renderer_.render(models[i], options);
            Look& look = looks_[all[i].name];
            if (round > 0 && all[i].isTimed) look.frame.push_back(picture.stats.wallMs);
            if (isCompared) compare(look, seen(picture), reference_[round]);
        }
    if (!std::exchange(hasPair_, true)) {
        addPair(tolerance, "dense mesh, raw", "cage + bc4 map");
        addPair(tolerance, "simplified mesh, raw", "cage + float map");
    }
}

void Looks::addPair(double tolerance, const std::string& left, const std::string& right) {
    const auto a = looks_.find(left), b = looks_.find(right);
    if (a == looks_.end() || b == looks_.end()) return;
    Image difference = a->second.images[0];
    for (std::size_t i = 0; i < difference.texels.size(); ++i)
        difference.texels[i] =
            std::min(1.0f, kAmplification * std::abs(difference.texels[i] - b->second.images[0].texels[i]));
    bench_.results.pictures.push_back({contest_.subject().name,
                                       fmt::format("RMS distance of {:g} % of the diagonal", 100 * tolerance), left,
                                       right, a->second.pngs[0], b->second.pngs[0], pngOf(difference, folder_)});
}

void Looks::tell(const std::string& name, Row& row) const {
    const auto found = looks_.find(name);
    if (found == looks_.end()) return;
    const double rmse = found->second.rmse();
    row.add("picture rmse", "of white", Origin::measured, rmse);
    row.add("picture psnr", "dB", Origin::measured, rmse > 0 ? -20 * std::log10(rmse) : 99);
    if (!found->second.frame.empty()) row.add("frame", "ms", found->second.frame);
}

} // namespace relief
