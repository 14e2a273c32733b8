#include "bake/heights.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <mutex>
#include <thread>

#include "bake/membrane.h"
#include "displacement/voids.h"

namespace relief {
namespace {

constexpr int kRowsAtOnce = 8;

class HeightBaker {
public:
    HeightBaker(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const TexelSource& texels,
                const BakeOptions& options)
        : texels_(texels), faceCount_(surface.faceCount()), options_(options), lines_(surface, sculpt, options_.lines),
          layers_(surface, sculpt, options_.layers), channelCount_(std::size_t(layers_.channelCount())),
          progress_("baking", std::uint64_t(texels.height()), options.progress, "rows") {}

    BakedHeights bake() {
        map_.width = texels_.width(), map_.height = texels_.height();
        map_.seenFaces.assign(std::size_t(faceCount_), false);
        const std::size_t count = std::size_t(map_.width) * std::size_t(map_.height);
        map_.heights.assign(count, 0);
        map_.states.assign(count, TexelState::outside);
        for (const SculptLayer layer : options_.layers.layers) {
            Image image{map_.width, map_.height, channelsOf(layer), {}};
            image.texels.assign(count * std::size_t(image.channels), 0);
            map_.layers.push_back(std::move(image));
        }
        if (channelCount_ > 0) hasLayers_.assign(count, 0);
        // Each thread takes the next strip of rows, which nobody else writes to.
        std::vector<std::future<void>> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.push_back(std::async([this] {
                for (int row = nextRow_.fetch_add(kRowsAtOnce); row < map_.height;
                     row = nextRow_.fetch_add(kRowsAtOnce))
                    bakeRows(row, std::min(kRowsAtOnce, map_.height - row));
            }));
        for (std::future<void>& thread : threads) thread.get();
        for (Image& layer : map_.layers) fillAround(layer);
        return std::move(map_);
    }

private:
    struct Sums {
        double heights = 0, weights = 0;
        double layerCount = 0; ///< samples whose layers are summed up
        bool isInside = false, isAnywhere = false;
    };

    void bakeRows(int first, int count) {
        std::vector<TexelSample> samples;
        texels_.listSamples(first, count, samples);
        const std::size_t firstTexel = std::size_t(first) * std::size_t(map_.width);
        std::vector<Sums> sums(std::size_t(count) * std::size_t(map_.width));
        std::vector<double> channels(sums.size() * channelCount_, 0), own(channelCount_);
        BakedHeights counts; // of these rows alone
        for (const TexelSample& sample : samples) {
            const std::size_t texel = sample.texel - firstTexel;
            if (!addSample(sample, sums[texel], own, counts)) continue;
            for (std::size_t k = 0; k < channelCount_; ++k) channels[texel * channelCount_ + k] += own[k];
        }
        for (std::size_t i = 0; i < sums.size(); ++i) {
            finishTexel(firstTexel + i, sums[i], counts);
            if (sums[i].layerCount > 0) putLayers(firstTexel + i, sums[i].layerCount, &channels[i * channelCount_]);
        }
        const std::lock_guard lock(mutex_);
        for (const TexelSample& sample : samples)
            if (sample.isInside) map_.seenFaces[std::size_t(sample.face)] = true;
        map_.texelCount += counts.texelCount, map_.voidCount += counts.voidCount;
        map_.sampleCount += counts.sampleCount, map_.missCount += counts.missCount;
        map_.behindCount += counts.behindCount, map_.insideCount += counts.insideCount;
        progress_.advance(std::uint64_t(count));
    }

    /// True where the sample has layers, which it leaves in `channels`.
    bool addSample(const TexelSample& sample, Sums& sums, std::span<double> channels, BakedHeights& counts) const {
        const SculptLines::Line line = lines_.lineAt(sample.face, dvec2(sample.uv));
        std::optional<LineHit> hit = lines_.find(line);
        const bool isBehind = hit && hit->isBehindBack;
        if (isBehind && options_.dropsBehind) hit.reset();
        sums.isAnywhere = true;
        sums.isInside = sums.isInside || sample.isInside;
        if (sample.isInside) {
            ++counts.sampleCount;
            counts.missCount += hit ? 0 : 1;
            counts.behindCount += isBehind ? 1 : 0;
            counts.insideCount += line.start < 0 ? 1 : 0;
        }
        if (!hit) return false;
        sums.heights += double(sample.weight) * hit->height;
        sums.weights += double(sample.weight);
        if (channelCount_ == 0 || !sample.isInside) return false;
        layers_.evaluate(sample, line.frame, line.direction, *hit, channels);
        sums.layerCount += 1;
        return true;
    }

    void putLayers(std::size_t texel, double count, const double* channels) {
        hasLayers_[texel] = 1;
        for (std::size_t i = 0; i < map_.layers.size(); ++i) {
            Image& image = map_.layers[i];
            const auto width = std::size_t(image.channels);
            double length = count;
            const SculptLayer layer = options_.layers.layers[i];
            if (layer == SculptLayer::tangentNormal || layer == SculptLayer::objectNormal)
                length = std::max(glm::length(dvec3(channels[0], channels[1], channels[2])), 1e-30);
            for (std::size_t k = 0; k < width; ++k) image.texels[texel * width + k] = float(*channels++ / length);
        }
    }

    /// Texels that no sample lies in, by means of those around them.
    void fillAround(Image& layer) const {
        std::vector<bool> isVoid(hasLayers_.size());
        for (std::size_t i = 0; i < isVoid.size(); ++i) isVoid[i] = hasLayers_[i] == 0;
        if (std::ranges::find(isVoid, false) == isVoid.end()) return;
        const auto width = std::size_t(layer.channels);
        std::vector<float> channel(isVoid.size());
        for (std::size_t k = 0; k < width; ++k) {
            for (std::size_t i = 0; i < channel.size(); ++i) channel[i] = layer.texels[i * width + k];
            fillVoids(layer.width, layer.height, channel, isVoid);
            for (std::size_t i = 0; i < channel.size(); ++i) layer.texels[i * width + k] = channel[i];
        }
    }

    void finishTexel(std::size_t texel, const Sums& sums, BakedHeights& counts) {
        if (!sums.isAnywhere) return;
        constexpr double kFewest = 0.5; // weights of continued heights may cancel
        const bool isHit = std::abs(sums.weights) > kFewest;
        map_.states[texel] = isHit ? TexelState::hit : TexelState::missed;
        if (isHit) map_.heights[texel] = float(sums.heights / sums.weights);
        counts.texelCount += sums.isInside ? 1 : 0;
        counts.voidCount += sums.isInside && !isHit ? 1 : 0;
    }

    const TexelSource& texels_;
    int faceCount_;
    BakeOptions options_;
    SculptLines lines_;
    LayerSampler layers_;
    std::size_t channelCount_; ///< of all layers
    BakedHeights map_;
    std::vector<std::uint8_t> hasLayers_; ///< by texel
    std::atomic<int> nextRow_ = 0;
    std::mutex mutex_; ///< of the counts and the bar
    Progress progress_;
};

} // namespace

BakedHeights bakeHeights(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const TexelSource& texels,
                         const BakeOptions& options) {
    BakedHeights map = HeightBaker(surface, sculpt, texels, options).bake();
    if (std::ranges::find(map.states, TexelState::hit) != map.states.end()) fillMissed(map, texels);
    return map;
}

} // namespace relief
