// What the tests of the device share.
#pragma once

#include "on_device.h"

namespace relief::test {

/// A test whose end also checks that all memory of the device was given back.
class OnDeviceWithoutLeaks : public OnDevice {
protected:
    void SetUp() override {
        OnDevice::SetUp();
        bytesBefore_ = device().allocatedBytes();
    }
    void TearDown() override {
        OnDevice::TearDown();
        EXPECT_EQ(device().allocatedBytes(), bytesBefore_);
    }

private:
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
