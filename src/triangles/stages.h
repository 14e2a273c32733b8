// Internal: how passes without pictures are set up; also for frame.
#pragma once

#include <map>

#include "model/stages.h"
#include "triangles/triangles.h"

namespace relief {

/// What is derived from models and kept while they live.
template <typename Derived>
class PerModel {
public:
    /// That of a model, made by `make()` when it is first asked for.
    template <typename Make>
    Derived& of(const Model& model, const Make& make) {
        std::erase_if(entries_, [](const Entry& entry) { return entry.identity.expired(); });
        for (Entry& entry : entries_)
            if (entry.identity.lock() == model.identity()) return *entry.derived;
        entries_.push_back({model.identity(), std::make_unique<Derived>(make())});
        return *entries_.back().derived;
    }

private:
    struct Entry {
        std::weak_ptr<const int> identity;
        std::unique_ptr<Derived> derived;
    };
    std::vector<Entry> entries_;
};

/// Passes that make no picture: everything of a scene and of set 0 up to the samples of a picture.
class GeometryInputs {
public:
    explicit GeometryInputs(Device& device);

    static PipelineLayoutDesc layout();
    /// Describes the model; what it does not fill is bound all the same: Mesa 22.3's CPU driver walks every descriptor
    /// of a set, whether or not a shader reads it.
    void fill(const Model& model, Scene& scene, std::span<Binding> bindings) const;
    const Buffer& scene() const { return scene_; }

private:
    Buffer scene_;
    TexelBuffer none_;
    Owned<VkSampler> sampler_;
};

/// Compute pipelines by shader and constants, made when first asked for.
class ComputeStages {
public:
    explicit ComputeStages(Device& device) : device_(device) {}
    const Pipeline& pipeline(const char* file, const Model& model, const ShaderConstants& constants);

private:
    Device& device_;
    std::map<std::pair<std::string, std::vector<std::uint32_t>>, Pipeline> pipelines_;
};

/// What shaders read of rates: the rates themselves and the levels of the height map.
struct RateTexels {
    TexelBuffer rates, levels;
};
RateTexels uploadRates(Device& device, const Model& model, const EdgeRates& rates);
/// Binds them and fills their part of the scene.
void useRates(const Model& model, const EdgeRates& rates, const RateTexels& texels, Scene& scene,
              std::span<Binding> bindings);

/// Two triangles a cell, row after row: the first rows of a larger grid with as many columns.
std::vector<std::uint32_t> gridIndices(std::uint32_t columns, std::uint32_t rows);
/// The same for triangles with n segments a side: one triangle in the last cell of a row.
std::vector<std::uint32_t> triangleGridIndices(std::uint32_t n);

} // namespace relief
