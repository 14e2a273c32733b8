// One device for all tests of the program, and the promise that the validation layer stays silent.
#pragma once

#include <gtest/gtest.h>

#include "gpu/gpu.h"

namespace relief::test {

inline Device& device() {
    static Device instance;
    return instance;
}

/// A test whose end checks that the validation layer printed nothing and that all memory was given back.
class OnDevice : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(device().isValidating()) << "run with RELIEF_VALIDATE=1";
        messagesBefore_ = device().validationMessages().size();
        bytesBefore_ = device().allocatedBytes();
    }
    void TearDown() override {
        EXPECT_EQ(device().validationMessages().size(), messagesBefore_);
        EXPECT_EQ(device().allocatedBytes(), bytesBefore_);
    }

private:
    std::size_t messagesBefore_ = 0;
    std::uint64_t bytesBefore_ = 0;
};

/// Bytes that differ from their neighbours and from those of another seed.
inline std::vector<std::byte> pattern(std::size_t count, unsigned seed = 1) {
    std::vector<std::byte> bytes(count);
    std::uint32_t state = seed * 2654435761u + 1;
    for (std::byte& each : bytes) {
        state = state * 1664525u + 1013904223u;
        each = std::byte(state >> 24);
    }
    return bytes;
}

/// The message of the Failure::device that `act` throws.
template <typename Act>
std::string deviceFailure(const Act& act) {
    try {
        act();
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::device) << error.what();
        return error.what();
    }
    ADD_FAILURE() << "nothing was thrown";
    return "";
}

} // namespace relief::test
