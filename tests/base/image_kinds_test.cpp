// Pictures of unusual kinds: signed integers, no-data numbers, layers, parts, files cut by a byte.
#include <cmath>
#include <fstream>

#include <OpenImageIO/imageio.h>

#include "support.h"
#include "tiff.h"

namespace relief::test {
namespace {

OIIO::ImageSpec specOf(std::vector<std::string> channels, const std::string& part = "") {
    OIIO::ImageSpec spec(4, 3, int(channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = std::move(channels);
    if (!part.empty()) spec.attribute("oiio:subimagename", part);
    return spec;
}

/// Parts of one EXR; every channel holds its number within the file.
void writeExr(const std::string& path, const std::vector<OIIO::ImageSpec>& parts) {
    const auto output = OIIO::ImageOutput::create("openexr");
    ASSERT_TRUE(output->open(path, int(parts.size()), parts.data())) << output->geterror();
    float number = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const auto next = OIIO::ImageOutput::AppendSubimage;
        ASSERT_TRUE(p == 0 || output->open(path, parts[p], next)) << output->geterror();
        std::vector<float> texels;
        for (int i = 0; i < 12; ++i)
            for (int c = 0; c < parts[p].nchannels; ++c) texels.push_back(number + float(c));
        number += float(parts[p].nchannels);
        ASSERT_TRUE(output->write_image(OIIO::TypeFloat, texels.data())) << output->geterror();
    }
    ASSERT_TRUE(output->close());
}

/// The number of the channel that a word chooses, or -1.
float chosen(const std::string& path, const std::string& word) {
    const std::optional<ChannelIndex> found = findChannel(readImageInfo(path), word);
    return found ? readImage(path, found->channel, {}, found->part).texels.at(0) : -1;
}

template <typename T>
void expectNumbers(const std::vector<T>& samples) {
    const TemporaryFolder folder;
    for (const bool isBigEndian : {false, true}) {
        putFile(folder / "a.tif",
                tiffOf<T>({.width = 2, .height = 2, .sampleFormat = 2, .isBigEndian = isBigEndian}, samples));
        EXPECT_TRUE(readImageInfo(folder / "a.tif").isSigned);
        EXPECT_TRUE(readImageInfo(folder / "a.tif").hasUnit());
        EXPECT_EQ(readImage(folder / "a.tif").texels, std::vector<float>(samples.begin(), samples.end()))
            << 8 * sizeof(T) << (isBigEndian ? " MM" : " II");
    }
}

TEST(SignedIntegers, areTheStoredNumbers) {
    expectNumbers<std::int8_t>({-128, 127, 0, 100});
    expectNumbers<std::int16_t>({-32768, 32767, 1, 100});
    expectNumbers<std::int32_t>({-2147483647 - 1, 100, 16777215, -3});
}

TEST(UnsignedIntegers, areSharesOfTheLargest) {
    const TemporaryFolder folder;
    putFile(folder / "a.tif", tiffOf<std::uint16_t>({.width = 2, .height = 1}, {65535, 0}));
    EXPECT_FALSE(readImageInfo(folder / "a.tif").hasUnit());
    EXPECT_EQ(readImage(folder / "a.tif").texels, (std::vector<float>{1, 0}));
}

TEST(Doubles, pastTheRangeOfFloatsAreFinite) {
    const TemporaryFolder folder;
    const std::vector<double> samples{-1.7e308, 2.5, 1e300, NAN, 1, 2, 3, 4};
    putFile(folder / "a.tif", tiffOf<double>({.width = 4, .height = 2, .sampleFormat = 3}, samples));
    const std::vector<float> texels = readImage(folder / "a.tif").texels;
    constexpr float kMost = std::numeric_limits<float>::max();
    EXPECT_EQ(texels[0], -kMost);
    EXPECT_EQ(texels[1], 2.5f);
    EXPECT_EQ(texels[2], kMost);
    EXPECT_TRUE(std::isnan(texels[3]));
}

// OpenImageIO 2.4 does not read these and says nothing: a flat map without a word would be worse than none.
TEST(Doubles, thatComeOutAsZerosAreRefused) {
    const TemporaryFolder folder;
    putFile(folder / "a.tif", tiffOf<double>({.width = 2, .height = 1, .sampleFormat = 3}, {1, 2}));
    expectFailure(Failure::input, {folder / "a.tif", "64-bit samples", "not supported"},
                  [&] { readImage(folder / "a.tif"); });
}

TEST(NoData, isReadFromTheTagOfTheFirstPage) {
    const TemporaryFolder folder;
    const auto noDataOf = [&](TiffDesc desc) {
        desc.width = 1, desc.height = 1, desc.sampleFormat = 3;
        putFile(folder / "a.tif", tiffOf<float>(desc, {1}));
        return readImageInfo(folder / "a.tif").noData;
    };
    EXPECT_EQ(noDataOf({.noData = "-9999"}), -9999);
    EXPECT_EQ(noDataOf({.noData = "-3.4028234663852886e+38", .isBigEndian = true}), -3.4028234663852886e+38);
    EXPECT_EQ(noDataOf({.noData = "0"}), 0) << "short enough to stand in the entry itself";
    EXPECT_EQ(noDataOf({.noData = "-32768", .hasDirectoryLast = true, .pageCount = 3}), -32768);
    EXPECT_TRUE(std::isnan(noDataOf({.noData = "nan"}).value()));
    EXPECT_FALSE(noDataOf({}).has_value());
    EXPECT_FALSE(noDataOf({.noData = "none"}).has_value());
}

TEST(Rows, areThePictureInOrder) {
    const TemporaryFolder folder;
    Image image{.width = 3, .height = 700, .channels = 2, .texels = {}};
    for (int i = 0; i < 3 * 700 * 2; ++i) image.texels.push_back(float(i));
    writeImage(folder / "a.exr", image, SampleType::real);
    std::vector<float> texels;
    int next = 0, calls = 0;
    readImageRows(folder / "a.exr", [&](int first, int count, std::span<const float> rows) {
        EXPECT_EQ(first, next);
        EXPECT_EQ(rows.size(), std::size_t(count) * 6);
        next += count, ++calls;
        texels.insert(texels.end(), rows.begin(), rows.end());
    });
    EXPECT_EQ(texels, image.texels);
    EXPECT_GT(calls, 1) << "strips are smaller than this picture";
}

TEST(Rows, ofTiledPicturesAreTheSame) {
    const TemporaryFolder folder;
    OIIO::ImageSpec spec(100, 70, 1, OIIO::TypeDesc::FLOAT);
    spec.tile_width = 32, spec.tile_height = 16;
    std::vector<float> texels;
    for (int i = 0; i < 7000; ++i) texels.push_back(float(i));
    for (const std::string name : {"a.exr", "a.tif"}) {
        const auto output = OIIO::ImageOutput::create(folder / name);
        ASSERT_TRUE(output->open(folder / name, spec)) << output->geterror();
        ASSERT_TRUE(output->write_image(OIIO::TypeFloat, texels.data()));
        ASSERT_TRUE(output->close());
        EXPECT_EQ(readImage(folder / name).texels, texels) << name;
    }
}

TEST(Layers, areChosenByName) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.exr";
    writeExr(path, {specOf({"Beauty.R", "Beauty.G", "Beauty.B", "Height.Y", "deep.er.Z"})});
    const ImageInfo info = readImageInfo(path);
    EXPECT_EQ(layersOf(info), (std::vector<std::string>{"Beauty", "Height", "deep.er"}));
    EXPECT_EQ(chosen(path, "Beauty.R"), 0);
    EXPECT_EQ(chosen(path, "Beauty.B"), 2);
    EXPECT_EQ(chosen(path, "Height"), 3);
    EXPECT_EQ(chosen(path, "deep.er"), 4);
    EXPECT_EQ(chosen(path, "2"), 2);
    for (const char* word : {"R", "deep", "5", "-1", "", "Height.", "1x"}) EXPECT_EQ(chosen(path, word), -1) << word;
}

TEST(Layers, mayBePartsOfTheFile) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.exr";
    writeExr(path, {specOf({"R", "G", "B"}, "color"), specOf({"R"}, "height")});
    EXPECT_EQ(layersOf(readImageInfo(path)), (std::vector<std::string>{"color", "height"}));
    EXPECT_EQ(readImageInfo(path).channels, 3);
    EXPECT_EQ(chosen(path, "R"), 0);
    EXPECT_EQ(chosen(path, "color.G"), 1);
    EXPECT_EQ(chosen(path, "height"), 3);
    EXPECT_EQ(chosen(path, "height.R"), 3);
}

TEST(Layers, areOneInOrdinaryPictures) {
    const TemporaryFolder folder;
    writeExr(folder / "a.exr", {specOf({"R", "G", "B", "A"})});
    EXPECT_EQ(layersOf(readImageInfo(folder / "a.exr")).size(), 1u);
    putFile(folder / "a.tif", tiffOf<float>({.width = 1, .height = 1, .sampleFormat = 3}, {1}));
    EXPECT_EQ(layersOf(readImageInfo(folder / "a.tif")).size(), 1u);
    putFile(folder / "a.tif", tiffOf<float>({.width = 1, .height = 1, .sampleFormat = 3, .pageCount = 2}, {1}));
    EXPECT_EQ(layersOf(readImageInfo(folder / "a.tif")).size(), 2u) << "pages";
}

TEST(SubsampledExr, isNotSupportedRatherThanDamaged) {
    const TemporaryFolder folder;
    writeExr(folder / "a.exr", {specOf({"BY", "Y"})});
    std::string bytes = readFile(folder / "a.exr");
    const std::size_t channel = bytes.find(std::string("BY\0", 3));
    bytes[channel + 3 + 8] = 2; // after the type, linearity and three unused bytes: every second column
    putFile(folder / "a.exr", bytes);
    expectFailure(Failure::input, {folder / "a.exr", "not supported"}, [&] { readImageInfo(folder / "a.exr"); });
    try {
        readImage(folder / "a.exr");
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find("damaged"), std::string::npos) << error.what();
    }
}

TEST(Tiles, inANameAreExplained) {
    const TemporaryFolder folder;
    for (const char* name : {"a.<UDIM>.exr", "a_<uvtile>.tif", "a_<UVTILE>.png", "a.%(UDIM)d.png"})
        expectFailure(Failure::usage, {folder / name, "a set of tiles"}, [&] { readImage(folder / name); });
    writeExr(folder / "b.<UDIM>.exr", {specOf({"R"})});
    EXPECT_EQ(readImage(folder / "b.<UDIM>.exr").width, 4) << "a file of that very name is a picture";
}

/// Every kind of file that is cut shorter by each of 1 to 40 bytes is refused.
TEST(CutFiles, byAFewBytesAreDamaged) {
    const TemporaryFolder folder;
    Image image{.width = 67, .height = 41, .channels = 3, .texels = {}};
    for (int i = 0; i < 67 * 41 * 3; ++i) image.texels.push_back(float((i * 7919) % 1000) / 1000);
    struct Kind {
        const char *name, *compression;
        OIIO::TypeDesc sample;
    };
    const Kind kinds[] = {{"zip.tif", "zip", OIIO::TypeDesc::UINT8},  {"lzw.tif", "lzw", OIIO::TypeDesc::UINT16},
                          {"raw.tif", "none", OIIO::TypeDesc::FLOAT}, {"bits.tif", "packbits", OIIO::TypeDesc::UINT8},
                          {"zip.exr", "zip", OIIO::TypeDesc::HALF},   {"raw.exr", "none", OIIO::TypeDesc::FLOAT},
                          {"piz.exr", "piz", OIIO::TypeDesc::HALF},   {"a.png", "", OIIO::TypeDesc::UINT8},
                          {"b.png", "", OIIO::TypeDesc::UINT16},      {"a.jpg", "", OIIO::TypeDesc::UINT8},
                          {"a.hdr", "", OIIO::TypeDesc::FLOAT}};
    for (const Kind& kind : kinds) {
        const std::string path = folder / kind.name;
        const auto output = OIIO::ImageOutput::create(path);
        OIIO::ImageSpec spec(image.width, image.height, image.channels, kind.sample);
        if (*kind.compression != 0) spec.attribute("compression", kind.compression);
        ASSERT_TRUE(output->open(path, spec)) << output->geterror();
        ASSERT_TRUE(output->write_image(OIIO::TypeFloat, image.texels.data())) << output->geterror();
        ASSERT_TRUE(output->close());
        EXPECT_EQ(readImage(path).width, 67) << kind.name;
        const std::string whole = readFile(path);
        for (std::size_t missing = 1; missing <= 40; ++missing) {
            putFile(path, std::string_view(whole).substr(0, whole.size() - missing));
            SCOPED_TRACE(fmt::format("{} without {} bytes", kind.name, missing));
            expectFailure(Failure::input, {path}, [&] { readImage(path); });
        }
    }
}

TEST(CutFiles, withPixelsOrDirectoriesLastAreDamaged) {
    const TemporaryFolder folder;
    for (const bool isLast : {false, true})
        for (const bool isBigEndian : {false, true}) {
            const std::string whole = tiffOf<float>({.width = 2,
                                                     .height = 2,
                                                     .sampleFormat = 3,
                                                     .noData = "-9999",
                                                     .isBigEndian = isBigEndian,
                                                     .hasDirectoryLast = isLast,
                                                     .pageCount = 2},
                                                    {1, 2, 3, 4});
            putFile(folder / "a.tif", whole);
            EXPECT_EQ(readImage(folder / "a.tif").texels, (std::vector<float>{1, 2, 3, 4}));
            for (std::size_t size = 10; size < whole.size(); ++size) {
                putFile(folder / "a.tif", std::string_view(whole).substr(0, size));
                expectFailure(Failure::input, {"a.tif"}, [&] { readImageInfo(folder / "a.tif"); });
            }
        }
}

TEST(DamagedFiles, keepStderrClean) {
    const TemporaryFolder folder;
    Image image{.width = 64, .height = 64, .channels = 3, .texels = std::vector<float>(64 * 64 * 3, 0.25f)};
    for (std::size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = float(i * 7919 % 255) / 255;
    for (const std::string name : {"a.png", "a.tif", "a.exr"}) {
        writeImage(folder / name, image, name == "a.exr" ? SampleType::half : SampleType::uint8);
        const std::string whole = readFile(folder / name);
        testing::internal::CaptureStderr();
        int refused = 0;
        for (std::size_t at = 8; at < whole.size(); at += whole.size() / 97) {
            std::string bytes = whole;
            bytes[at] = char(~bytes[at]);
            putFile(folder / name, bytes);
            try {
                readImage(folder / name, -1, {.side = 4096, .decodedBytes = 1 << 24});
            } catch (const Error&) {
                ++refused;
            }
        }
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << name;
        EXPECT_GT(refused, 0) << name;
    }
    std::fputs("still there", stderr);
}

} // namespace
} // namespace relief::test
