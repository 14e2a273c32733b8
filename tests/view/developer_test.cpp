// What the window shows of a picture, against the codes of the .png of the same picture.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <glm/gtc/packing.hpp>

#include "view/developer.h"

namespace relief::test {
namespace {

/// Random light behind a random coverage; a third of the pixels each are opaque, empty, and between.
Picture randomPicture(int width, int height) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> unit(0, 1);
    Picture picture{.width = width, .height = height};
    for (int pixel = 0; pixel < width * height; ++pixel) {
        const float alpha = pixel % 3 == 0 ? 1.0f : pixel % 3 == 1 ? 0.0f : 0.25f + 0.5f * unit(random);
        for (int c = 0; c < 3; ++c) picture.halves.push_back(glm::packHalf1x16(alpha * 3 * unit(random)));
        picture.halves.push_back(glm::packHalf1x16(alpha));
    }
    return picture;
}

const Finish kFinishes[] = {{},
                            {.exposure = 1.5},
                            {.background = Background::color, .color = {0.2f, 0.4f, 0.9f}},
                            {.background = Background::color, .color = {0.2f, 0.4f, 0.9f}, .exposure = -2}};

TEST(Developer, isExactAtRest) {
    const Picture picture = randomPicture(31, 17);
    for (const Finish& finish : kFinishes) {
        const Image image = displayed(picture, finish);
        const Codes codes = developExactly(picture, finish);
        for (int i = 0; i < 31 * 17; ++i)
            for (int c = 0; c < 3; ++c)
                ASSERT_EQ(codes.rgba[std::size_t(4 * i + c)],
                          std::floor(255 * image.texels[std::size_t(3 * i + c)] + 0.5f));
    }
}

TEST(Developer, isExactButAtTheOutlineWhileSomethingMoves) {
    const Picture picture = randomPicture(31, 17);
    Developer developer; // one for all: its tables follow the finish
    for (const Finish& finish : kFinishes) {
        const Codes exact = developExactly(picture, finish), quick = developer.develop(picture, finish);
        for (std::size_t i = 0; i < exact.rgba.size(); ++i) {
            const int most = (i / 4) % 3 == 2 ? 2 : 0;
            ASSERT_LE(std::abs(int(exact.rgba[i]) - int(quick.rgba[i])), most) << i;
        }
    }
}

TEST(Developer, joinsTwoPicturesAtTheDivider) {
    Codes left{4, 1, std::vector<std::uint8_t>(16, 10)}, right{4, 1, std::vector<std::uint8_t>(16, 30)};
    Codes joined = left;
    joinColumns(joined, right, 3);
    EXPECT_EQ(joined.rgba[8], 10);
    EXPECT_EQ(joined.rgba[12], 30);
    joinDifference(left, right, 2, 8);
    EXPECT_EQ(left.rgba[4], 10);
    EXPECT_EQ(left.rgba[8], 160);
}

} // namespace
} // namespace relief::test
