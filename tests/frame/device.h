// One device for all tests of a program, and the promise that the validation layer stays silent.
#pragma once

#include <gtest/gtest.h>

#include "frame/frame.h"

namespace relief::test {

inline Device& device() {
    static Device instance;
    return instance;
}

inline SurfaceSampler& sampler() {
    static SurfaceSampler instance(device());
    return instance;
}

/// A test whose end checks that Vulkan's validation layer, synchronization validation included, printed nothing.
class OnDevice : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(device().isValidating()) << "run with RELIEF_VALIDATE=1";
        messagesBefore_ = device().validationMessages().size();
    }
    void TearDown() override { EXPECT_EQ(device().validationMessages().size(), messagesBefore_); }

private:
    std::size_t messagesBefore_ = 0;
};

/// Smooth, tileable, both signs: `waves` periods each way of the given amplitude in cage units.
inline HeightMap sineMap(int side, double amplitude, int waves = 2) {
    std::vector<float> texels(std::size_t(side) * std::size_t(side));
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double s = (x + 0.5) / side, t = 1 - (y + 0.5) / side, k = 6.283185307179586 * waves;
            texels[std::size_t(y) * std::size_t(side) + std::size_t(x)] = float(std::sin(k * s) * std::cos(k * t));
        }
    return makeHeightMap(side, side, std::move(texels), 0, amplitude, Wrap::repeat);
}

} // namespace relief::test
