#include "bake/heights.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <mutex>
#include <thread>

#include "bake/membrane.h"

namespace relief {
namespace {

constexpr int kRowsAtOnce = 8;

class HeightBaker {
public:
    HeightBaker(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const TexelSource& texels,
                const BakeOptions& options)
        : surface_(surface), sculpt_(sculpt), texels_(texels), options_(options),
          progress_("baking", std::uint64_t(texels.height()), options.progress, "rows") {}

    BakedHeights bake() {
        map_.width = texels_.width(), map_.height = texels_.height();
        const std::size_t count = std::size_t(map_.width) * std::size_t(map_.height);
        map_.heights.assign(count, 0);
        map_.states.assign(count, TexelState::outside);
        // Each thread takes the next strip of rows, which nobody else writes to.
        std::vector<std::future<void>> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.push_back(std::async([this] {
                for (int row = nextRow_.fetch_add(kRowsAtOnce); row < map_.height;
                     row = nextRow_.fetch_add(kRowsAtOnce))
                    bakeRows(row, std::min(kRowsAtOnce, map_.height - row));
            }));
        for (std::future<void>& thread : threads) thread.get();
        return std::move(map_);
    }

private:
    struct Sums {
        double heights = 0, weights = 0;
        bool isInside = false, isAnywhere = false;
    };

    void bakeRows(int first, int count) {
        std::vector<TexelSample> samples;
        texels_.listSamples(first, count, samples);
        const std::size_t firstTexel = std::size_t(first) * std::size_t(map_.width);
        std::vector<Sums> sums(std::size_t(count) * std::size_t(map_.width));
        BakedHeights counts; // of these rows alone
        for (const TexelSample& sample : samples) addSample(sample, sums[sample.texel - firstTexel], counts);
        for (std::size_t i = 0; i < sums.size(); ++i) finishTexel(firstTexel + i, sums[i], counts);
        const std::lock_guard lock(mutex_);
        map_.texelCount += counts.texelCount, map_.voidCount += counts.voidCount;
        map_.sampleCount += counts.sampleCount, map_.missCount += counts.missCount;
        map_.behindCount += counts.behindCount;
        progress_.advance(std::uint64_t(count));
    }

    void addSample(const TexelSample& sample, Sums& sums, BakedHeights& counts) const {
        const dvec2 uv(sample.uv);
        const LimitFrame frame = surface_.limit(sample.face, uv);
        const dvec3 normal =
            frame.hasTangentPlane() ? glm::normalize(glm::cross(frame.pu, frame.pv)) : surface_.normal(sample.face, uv);
        const std::optional<LineHit> hit = sculpt_.nearestOnLine(frame.p, normal, options_.reach, options_.facing);
        sums.isAnywhere = true;
        sums.isInside = sums.isInside || sample.isInside;
        if (sample.isInside) {
            ++counts.sampleCount;
            counts.missCount += hit ? 0 : 1;
            counts.behindCount += hit && hit->isBehindBack ? 1 : 0;
        }
        if (!hit) return;
        sums.heights += double(sample.weight) * hit->height;
        sums.weights += double(sample.weight);
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

    const ReferenceSurface& surface_;
    const MeasuredSurface& sculpt_;
    const TexelSource& texels_;
    BakeOptions options_;
    BakedHeights map_;
    std::atomic<int> nextRow_ = 0;
    std::mutex mutex_; ///< of the counts and the bar
    Progress progress_;
};

} // namespace

BakedHeights bakeHeights(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const TexelSource& texels,
                         const BakeOptions& options) {
    BakedHeights map = HeightBaker(surface, sculpt, texels, options).bake();
    if (std::ranges::find(map.states, TexelState::hit) != map.states.end()) fillMissed(map, options.wrap);
    return map;
}

} // namespace relief
