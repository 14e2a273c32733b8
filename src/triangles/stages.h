// How passes without pictures are set up, for this module and for frame.
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
    Derived& of(const SurfaceModel& model, const Make& make) {
        std::erase_if(entries_, [](const Entry& entry) { return entry.identity.expired(); });
        for (Entry& entry : entries_)
            if (entry.identity.lock() == model.identity) return *entry.derived;
        entries_.push_back({model.identity, std::make_unique<Derived>(make())});
        return *entries_.back().derived;
    }

private:
    struct Entry {
        std::weak_ptr<const int> identity;
        std::unique_ptr<Derived> derived;
    };
    std::vector<Entry> entries_;
};

/// Pipelines by everything in which two of them may differ: a key begins with ShaderConstants::values().
class KeptPipelines {
public:
    /// That of a key, started by `start()` when it is first asked for. Those of height functions that are gone are
    /// dropped then.
    template <typename Start>
    const PendingPipeline& of(const std::vector<std::uint32_t>& key, const Start& start) {
        const auto found = pipelines_.find(key);
        if (found != pipelines_.end()) return found->second;
        std::erase_if(pipelines_, [](const auto& each) { return areOfGoneFunction(each.first); });
        return pipelines_[key] = start();
    }

private:
    std::map<std::vector<std::uint32_t>, PendingPipeline> pipelines_;
};

/// Which of the variants of a shader: with heights by a function, for faces with three sides.
struct ShaderVariant {
    const HeightFunction* function = nullptr;
    bool isTriangles = false;
};

/// Compute pipelines by shader and constants.
class ComputeStages {
public:
    explicit ComputeStages(Device& device) : device_(device) {}
    /// Starts to make a pipeline when it is first asked for.
    const PendingPipeline& start(const char* file, const ShaderConstants& constants, const ShaderVariant& variant = {});
    /// That of the model's variant.
    const PendingPipeline& start(const char* file, const SurfaceModel& model, const ShaderConstants& constants);
    const Pipeline& pipeline(const char* file, const SurfaceModel& model, const ShaderConstants& constants) {
        return start(file, model, constants).get();
    }

private:
    Device& device_;
    KeptPipelines pipelines_;
};

/// What shaders read of rates: the rates themselves and the mip levels of the height map.
struct RateTables {
    TexelBuffer rates, levels;
};
RateTables uploadRates(Device& device, const SurfaceModel& model, const EdgeRates& rates);
/// Binds the tables of rates and fills their part of the inputs.
void describeRates(const SurfaceModel& model, const EdgeRates& rates, const RateTables& tables, PassInputs& inputs,
                   PassBindings& bindings);

/// Whether the samples of all faces and edges lie on nodes of a map per face, on one level of it: one fetch gives a
/// height then (shaders/heights.glsl).
bool readsNodes(const SurfaceModel& model, const EdgeRates& rates);

/// Indices of a grid of quads, two triangles per cell, row after row. The first rows of a grid are those of a larger
/// one with as many columns.
std::vector<std::uint32_t> gridIndices(std::uint32_t columns, std::uint32_t rows);
/// Indices of a triangle with n segments per side, row after row: one triangle in the last cell of a row.
std::vector<std::uint32_t> triangleGridIndices(std::uint32_t n);

} // namespace relief
