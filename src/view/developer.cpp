#include "view/developer.h"

#include <algorithm>
#include <cstdlib>

#include <glm/gtc/packing.hpp>

#include "base/codes.h"

namespace relief {
namespace {

constexpr std::uint16_t kHalfOne = 0x3c00;

/// Grey squares behind what is transparent.
float checkerboard(int x, int y) { return ((x >> 3) + (y >> 3)) % 2 == 0 ? 0.72f : 0.62f; }

bool isSameFinish(const Finish& a, const Finish& b) { return a.background == b.background && a.color == b.color; }

} // namespace

Codes developExactly(const Picture& picture, const Finish& finish) {
    const Image image = displayed(picture, finish);
    Codes codes{picture.width, picture.height, {}};
    codes.rgba.resize(std::size_t(codes.width) * codes.height * 4, 255);
    for (int y = 0; y < codes.height; ++y)
        for (int x = 0; x < codes.width; ++x) {
            const float* in = image.at(x, y);
            std::uint8_t* out = &codes.rgba[4 * (std::size_t(y) * codes.width + x)];
            const float alpha = image.channels == 4 ? in[3] : 1;
            for (int c = 0; c < 3; ++c)
                out[c] = toCode<std::uint8_t>(alpha == 1 ? in[c] : glm::mix(checkerboard(x, y), in[c], alpha));
        }
    return codes;
}

void Developer::makeTable(const Finish& finish, bool isDisplayReferred) {
    if (tableOf_ == std::pair(finish.exposure, isDisplayReferred)) return;
    // A picture of all halves, one per pixel, opaque.
    Picture all{.width = 256, .height = 256, .isDisplayReferred = isDisplayReferred};
    for (std::uint32_t half = 0; half < 65536; ++half)
        for (int c = 0; c < 4; ++c) all.halves.push_back(c == 3 ? kHalfOne : std::uint16_t(half));
    const Codes codes = developExactly(all, {.exposure = finish.exposure});
    for (std::size_t half = 0; half < 65536; ++half) table_[half] = codes.rgba[4 * half];
    tableOf_ = {finish.exposure, isDisplayReferred};
}

void Developer::makeBackground(int width, int height, const Finish& finish) {
    if (finish_ && isSameFinish(*finish_, finish) && background_.width == width && background_.height == height) return;
    Picture empty{.width = width, .height = height};
    empty.halves.resize(std::size_t(width) * height * 4);
    background_ = developExactly(empty, finish);
    finish_ = finish;
}

Codes Developer::develop(const Picture& picture, const Finish& finish) {
    makeTable(finish, picture.isDisplayReferred);
    makeBackground(picture.width, picture.height, finish);
    Codes codes = background_;
    for (std::size_t pixel = 0; pixel < picture.halves.size() / 4; ++pixel) {
        const std::uint16_t* in = &picture.halves[4 * pixel];
        std::uint8_t* out = &codes.rgba[4 * pixel];
        if (in[3] == kHalfOne) {
            for (int c = 0; c < 3; ++c) out[c] = table_[in[c]];
        } else if (in[3] != 0) { // the outline
            const float alpha = std::clamp(glm::unpackHalf1x16(in[3]), 0.0f, 1.0f);
            for (int c = 0; c < 3; ++c) {
                const std::uint16_t own = glm::packHalf1x16(glm::unpackHalf1x16(in[c]) / alpha);
                out[c] = std::uint8_t(glm::mix(float(out[c]), float(table_[own]), alpha) + 0.5f);
            }
        }
    }
    return codes;
}

void joinColumns(Codes& left, const Codes& right, int divider) {
    RELIEF_CHECK(left.rgba.size() == right.rgba.size());
    const int first = std::clamp(divider, 0, left.width);
    for (int y = 0; y < left.height; ++y) {
        const std::size_t row = 4 * std::size_t(y) * left.width;
        std::copy(right.rgba.begin() + std::ptrdiff_t(row + 4 * std::size_t(first)),
                  right.rgba.begin() + std::ptrdiff_t(row + 4 * std::size_t(left.width)),
                  left.rgba.begin() + std::ptrdiff_t(row + 4 * std::size_t(first)));
    }
}

void joinDifference(Codes& left, const Codes& right, int divider, int gain) {
    RELIEF_CHECK(left.rgba.size() == right.rgba.size());
    for (int y = 0; y < left.height; ++y)
        for (int x = std::clamp(divider, 0, left.width); x < left.width; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t i = 4 * (std::size_t(y) * left.width + x) + c;
                left.rgba[i] = std::uint8_t(std::min(255, gain * std::abs(int(left.rgba[i]) - int(right.rgba[i]))));
            }
}

} // namespace relief
