// One device for all tests of a program, and the promise that the validation layer stays silent.
#pragma once

#include <gtest/gtest.h>

#include "gpu/gpu.h"

namespace relief::test {

inline Device& device() {
    static Device instance;
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

} // namespace relief::test
