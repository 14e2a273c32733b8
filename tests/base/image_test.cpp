#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <random>
#include <thread>

#include <OpenImageIO/imageio.h>

#include "support.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

Image noise(int width, int height, int channels) {
    std::mt19937 random(1);
    Image image{.width = width, .height = height, .channels = channels, .texels = {}};
    for (int i = 0; i < width * height * channels; ++i) image.texels.push_back(float(random() % 65536) / 65535.0f);
    return image;
}

float largestDifference(const Image& a, const Image& b) {
    EXPECT_EQ(a.texels.size(), b.texels.size());
    float largest = 0;
    for (std::size_t i = 0; i < std::min(a.texels.size(), b.texels.size()); ++i)
        largest = std::max(largest, std::abs(a.texels[i] - b.texels[i]));
    return largest;
}

/// JPEG and HDR are read, not written, by relief.
void writeForeign(const std::string& path, const Image& image, const OIIO::TypeDesc& sample) {
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output) << OIIO::geterror();
    OIIO::ImageSpec spec(image.width, image.height, image.channels, sample);
    ASSERT_TRUE(output->open(path, spec)) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, image.texels.data()));
    ASSERT_TRUE(output->close());
}

/// One file of each kind that can be read.
std::vector<std::string> writeAllKinds(const TemporaryFolder& folder) {
    const Image gray = noise(67, 41, 1), colour = noise(67, 41, 3);
    writeImage(folder / "gray8.png", gray, SampleType::uint8);
    writeImage(folder / "rgb16.png", colour, SampleType::uint16);
    writeImage(folder / "gray16.tif", gray, SampleType::uint16);
    writeImage(folder / "rgb32.tiff", colour, SampleType::real);
    writeImage(folder / "gray32.exr", gray, SampleType::real);
    writeImage(folder / "rgb16.exr", colour, SampleType::half);
    writeForeign(folder / "rgb.jpg", colour, OIIO::TypeDesc::UINT8);
    writeForeign(folder / "rgb.hdr", colour, OIIO::TypeDesc::FLOAT);
    writeForeign(folder / "foreign.tif", colour, OIIO::TypeDesc::FLOAT); // its directory comes before its pixels
    std::vector<std::string> paths;
    for (const auto& entry : fs::directory_iterator(folder.path)) paths.push_back(entry.path().string());
    return paths;
}

std::string bigEndian(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

std::string pngChunk(const std::string& typeAndData) {
    std::uint32_t crc = ~0u;
    for (const char letter : typeAndData) {
        crc ^= static_cast<unsigned char>(letter);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0u);
    }
    return bigEndian(std::uint32_t(typeAndData.size() - 4)) + typeAndData + bigEndian(~crc);
}

/// A flawless 8-bit grey header with no pixels behind it.
std::string pngOfSize(std::uint32_t width, std::uint32_t height) {
    const std::string header = "IHDR" + bigEndian(width) + bigEndian(height) + std::string("\x08\x00\x00\x00\x00", 5);
    return "\x89PNG\r\n\x1a\n" + pngChunk(header) + pngChunk("IDAT") + pngChunk("IEND");
}

std::string hdrOfSize(const std::string& resolution) {
    return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + resolution + "\n";
}

TEST(Image, integersComeBackWithinHalfAStep) {
    const TemporaryFolder folder;
    const Image image = noise(33, 17, 3);
    for (const std::string name : {"a.png", "a.tif"}) {
        writeImage(folder / name, image, SampleType::uint8);
        EXPECT_LE(largestDifference(readImage(folder / name), image), 0.501f / 255) << name;
        writeImage(folder / name, image, SampleType::uint16);
        EXPECT_LE(largestDifference(readImage(folder / name), image), 0.501f / 65535) << name;
    }
}

TEST(Image, floatsComeBackAsTheyWere) {
    const TemporaryFolder folder;
    Image image = noise(33, 17, 4);
    image.texels[0] = -1000.25f, image.texels[1] = 1e30f;
    for (const std::string name : {"a.exr", "a.tif"}) {
        writeImage(folder / name, image, SampleType::real);
        EXPECT_EQ(readImage(folder / name).texels, image.texels) << name;
    }
}

TEST(Image, halvesAreHalvesInExr) {
    const TemporaryFolder folder;
    const Image image = noise(33, 17, 1);
    writeImage(folder / "a.exr", image, SampleType::half);
    EXPECT_EQ(readImageInfo(folder / "a.exr").sample, "half");
    EXPECT_EQ(readImageInfo(folder / "a.exr").sampleBytes, 2);
    EXPECT_LE(largestDifference(readImage(folder / "a.exr"), image), 1.0f / 2048);
}

TEST(Image, rowZeroIsOnTop) {
    const TemporaryFolder folder;
    Image image{.width = 1, .height = 2, .channels = 1, .texels = {1, 0}};
    for (const std::string name : {"a.png", "a.tif"}) {
        writeImage(folder / name, image, SampleType::uint8);
        EXPECT_EQ(*readImage(folder / name).at(0, 0), 1) << name;
        EXPECT_EQ(*readImage(folder / name).at(0, 1), 0) << name;
    }
}

TEST(Image, coloursAreNotMultipliedByAlpha) {
    const TemporaryFolder folder;
    const Image image{.width = 2, .height = 1, .channels = 4, .texels = {1, 0.8f, 0.6f, 0, 0.2f, 0.4f, 1, 0.2f}};
    for (const std::string name : {"a.png", "a.tif"}) {
        writeImage(folder / name, image, SampleType::uint8);
        EXPECT_LE(largestDifference(readImage(folder / name), image), 1e-6f) << name;
    }
}

TEST(Image, integersAreTheNearestCodesAndHalvesGoUp) {
    const TemporaryFolder folder;
    for (const auto& [sample, largest] : {std::pair{SampleType::uint8, 255}, {SampleType::uint16, 65535}}) {
        Image image{.width = 3, .height = 85, .channels = 1, .texels = {}};
        std::vector<float> rounded;
        for (int code = 0; code < 255; ++code) {
            const float step = code % 3 == 0 ? 0.49f : code % 3 == 1 ? 0.5f : 0.51f;
            image.texels.push_back((float(code) + step) / float(largest));
            rounded.push_back(float(code + (step < 0.5f ? 0 : 1)));
        }
        image.texels[1] = 0.5f, rounded[1] = float(largest / 2 + 1); // a half that floats hold exactly
        for (const std::string name : {"a.png", "a.tif"}) {
            writeImage(folder / name, image, sample);
            const Image read = readImage(folder / name);
            for (int i = 0; i < 255; ++i) {
                const bool isExact = i % 3 != 1 || i == 1;
                if (!isExact) continue;
                EXPECT_EQ(std::round(read.texels[i] * float(largest)), rounded[i]) << name << ' ' << i;
            }
        }
    }
}

TEST(Image, integersAreClamped) {
    const TemporaryFolder folder;
    const Image image{.width = 9, .height = 1, .channels = 1, .texels = {-1, 2, 1e30f, NAN, -INFINITY, 1, 1, 1, NAN}};
    for (const SampleType sample : {SampleType::uint8, SampleType::uint16}) {
        writeImage(folder / "a.png", image, sample);
        EXPECT_EQ(readImage(folder / "a.png").texels, (std::vector<float>{0, 1, 1, 0, 0, 1, 1, 1, 0}));
    }
}

TEST(Image, givesOneChannel) {
    const TemporaryFolder folder;
    const Image image = noise(5, 4, 3);
    writeImage(folder / "a.exr", image, SampleType::real);
    const Image green = readImage(folder / "a.exr", 1);
    EXPECT_EQ(green.channels, 1);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) EXPECT_EQ(*green.at(x, y), image.at(x, y)[1]);
    expectFailure(Failure::input, {folder / "a.exr", "channel 3", "0 to 2"}, [&] { readImage(folder / "a.exr", 3); });
}

TEST(Image, infoHasWhatTheHeaderHolds) {
    const TemporaryFolder folder;
    writeAllKinds(folder);
    const ImageInfo png = readImageInfo(folder / "rgb16.png");
    EXPECT_EQ(png.width, 67);
    EXPECT_EQ(png.height, 41);
    EXPECT_EQ(png.channels, 3);
    EXPECT_EQ(png.format, "png");
    EXPECT_EQ(png.sample, "uint16");
    EXPECT_EQ(png.sampleBytes, 2);
    EXPECT_FALSE(png.isFloat);
    EXPECT_EQ(png.channelNames, (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_EQ(readImageInfo(folder / "gray16.tif").format, "tiff");
    EXPECT_EQ(readImageInfo(folder / "rgb.jpg").format, "jpeg");
    EXPECT_EQ(readImageInfo(folder / "rgb.hdr").format, "hdr");
    EXPECT_EQ(readImageInfo(folder / "gray32.exr").format, "openexr");
    EXPECT_TRUE(readImageInfo(folder / "gray32.exr").isFloat);
}

TEST(Image, contentDecidesTheReaderNotTheName) {
    const TemporaryFolder folder;
    writeImage(folder / "a.png", noise(3, 3, 1), SampleType::uint8);
    fs::rename(folder / "a.png", folder / "a.exr");
    EXPECT_EQ(readImageInfo(folder / "a.exr").format, "png");
    EXPECT_EQ(readImage(folder / "a.exr").width, 3);
}

TEST(Image, refusesOtherKindsOfFiles) {
    const TemporaryFolder folder;
    for (const std::string_view bytes : {"", "P6\n1 1\n255\nabc", "GIF89a......", "v 0 0 0\n"}) {
        putFile(folder / "a.png", bytes);
        expectFailure(Failure::input, {folder / "a.png", "EXR, TIFF, PNG, HDR or JPEG"},
                      [&] { readImage(folder / "a.png"); });
    }
}

TEST(Image, namesAMissingFile) {
    const TemporaryFolder folder;
    expectFailure(Failure::file, {folder / "none.png", "No such file"}, [&] { readImageInfo(folder / "none.png"); });
    expectFailure(Failure::file, {folder.path.string()}, [&] { readImage(folder.path.string()); });
}

TEST(Image, refusesCutFiles) {
    const TemporaryFolder folder;
    for (const std::string& path : writeAllKinds(folder)) {
        const std::string whole = readFile(path);
        for (const double share : {0.02, 0.3, 0.6, 0.9, 0.99}) {
            putFile(path, std::string_view(whole).substr(0, std::size_t(share * double(whole.size()))));
            expectFailure(Failure::input, {path}, [&] { readImage(path); });
        }
    }
}

TEST(Image, refusesPngWithoutItsEndAndKeepsStderrClean) {
    const TemporaryFolder folder;
    writeImage(folder / "a.png", noise(16, 16, 1), SampleType::uint8);
    const std::string whole = readFile(folder / "a.png");
    testing::internal::CaptureStderr();
    for (const std::size_t missing : {1, 12, 13, 100}) {
        putFile(folder / "a.png", std::string_view(whole).substr(0, whole.size() - missing));
        expectFailure(Failure::input, {"ends before"}, [&] { readImage(folder / "a.png"); });
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Image, refusesJpegThatEndsOnlyInItsThumbnail) {
    const TemporaryFolder folder;
    writeForeign(folder / "a.jpg", noise(64, 64, 3), OIIO::TypeDesc::UINT8);
    std::string bytes = readFile(folder / "a.jpg");
    const std::string thumbnail("\xff\xe2\x00\x08\xff\xd8\xff\xd9\x00\x00", 10);
    putFile(folder / "a.jpg", bytes.substr(0, 2) + thumbnail + bytes.substr(2));
    EXPECT_EQ(readImage(folder / "a.jpg").width, 64);
    putFile(folder / "a.jpg", bytes.substr(0, 2) + thumbnail + bytes.substr(2, bytes.size() - 4));
    expectFailure(Failure::input, {"ends before"}, [&] { readImage(folder / "a.jpg"); });
}

TEST(Image, damagedFilesAreBadInputOrHarmless) {
    const TemporaryFolder folder;
    std::mt19937 random(7);
    for (const std::string& path : writeAllKinds(folder)) {
        const std::string whole = readFile(path);
        for (int round = 0; round < 20; ++round) {
            std::string bytes = whole;
            for (int k = 0; k < 4; ++k) bytes[random() % bytes.size()] = char(random());
            putFile(path, bytes);
            try {
                readImage(path, -1, {.side = 4096, .decodedBytes = 1 << 24});
            } catch (const Error& error) {
                EXPECT_EQ(error.failure, Failure::input) << error.what();
            }
        }
    }
}

TEST(Image, refusesHeadersPastTheLimits) {
    const TemporaryFolder folder;
    const std::string path = folder / "a";
    const auto expectRefused = [&](const std::string& bytes, const std::string& size) {
        putFile(path, bytes);
        expectFailure(Failure::input, {path, size, "32768"}, [&] { readImageInfo(path); });
        expectFailure(Failure::input, {path, size, "32768"}, [&] { readImage(path); });
    };
    expectRefused(pngOfSize(100000, 100000), "100000 x 100000");
    expectRefused(hdrOfSize("-Y 2000000000 +X 2000000000"), "2000000000");
    expectRefused(hdrOfSize("-Y -5 +X 10"), "-5");
}

TEST(Image, refusesExrWindowsPastTheLimits) {
    const TemporaryFolder folder;
    writeImage(folder / "a.exr", noise(4, 4, 1), SampleType::real);
    std::string bytes = readFile(folder / "a.exr");
    const std::string name("dataWindow\0box2i\0", 17);
    const std::size_t window = bytes.find(name) + name.size() + 4;
    const std::int32_t far = 99'999;
    std::memcpy(&bytes[window + 8], &far, 4), std::memcpy(&bytes[window + 12], &far, 4);
    putFile(folder / "a.exr", bytes);
    expectFailure(Failure::input, {folder / "a.exr"}, [&] { readImage(folder / "a.exr"); });
}

TEST(Image, refusesMoreBytesThanTheLimit) {
    const TemporaryFolder folder;
    putFile(folder / "a.png", pngOfSize(30000, 30000)); // 900 MB
    expectFailure(Failure::input, {"decodes to 900.0 MB", "up to 500.0 MB"},
                  [&] { readImageInfo(folder / "a.png", {.decodedBytes = 500'000'000}); });
    writeImage(folder / "b.png", noise(10, 10, 3), SampleType::uint16);
    EXPECT_EQ(readImage(folder / "b.png", -1, {.decodedBytes = 600}).width, 10);
    expectFailure(Failure::input, {"600 B"}, [&] { readImage(folder / "b.png", -1, {.decodedBytes = 599}); });
    expectFailure(Failure::input, {"10 x 10", "1 to 9"}, [&] { readImage(folder / "b.png", -1, {.side = 9}); });
}

TEST(Image, refusesNamesThatNoWriterKnows) {
    const TemporaryFolder folder;
    for (const std::string name : {"a.bmp", "a", "a.jpg"})
        expectFailure(Failure::usage, {name, ".png"},
                      [&] { writeImage(folder / name, noise(2, 2, 1), SampleType::uint8); });
    expectFailure(Failure::usage, {"PNG", ".exr"},
                  [&] { writeImage(folder / "a.png", noise(2, 2, 1), SampleType::real); });
    expectFailure(Failure::usage, {"EXR", ".png"},
                  [&] { writeImage(folder / "a.exr", noise(2, 2, 1), SampleType::uint8); });
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(Image, refusesPicturesWithoutPixels) {
    const TemporaryFolder folder;
    expectFailure(Failure::internal, {"0 x 2"}, [&] {
        writeImage(folder / "a.png", {.width = 0, .height = 2, .channels = 1, .texels = {}}, SampleType::uint8);
    });
}

TEST(Image, pngHoldsOneToFourChannelsOfAnySize) {
    const TemporaryFolder folder;
    for (int channels = 1; channels <= 4; ++channels)
        for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {300, 200}})
            for (const SampleType sample : {SampleType::uint8, SampleType::uint16}) {
                const Image image = noise(width, height, channels);
                writeImage(folder / "a.png", image, sample);
                const float step = sample == SampleType::uint8 ? 0.5f / 255 : 0.5f / 65535;
                EXPECT_LE(largestDifference(readImage(folder / "a.png"), image), 1.001f * step) << channels;
            }
    expectFailure(Failure::file, {"a.png", "5"},
                  [&] { writeImage(folder / "a.png", noise(2, 2, 5), SampleType::uint8); });
}

TEST(Image, pngIsSmallWherePicturesAreSmooth) {
    const TemporaryFolder folder;
    Image image{.width = 256, .height = 256, .channels = 3, .texels = {}};
    for (int i = 0; i < 256 * 256; ++i)
        for (int c = 0; c < 3; ++c) image.texels.push_back(float((i % 256) + (i / 256)) / 511);
    writeImage(folder / "a.png", image, SampleType::uint8);
    EXPECT_LT(fs::file_size(folder / "a.png"), 256u * 256u * 3 / 4);
}

TEST(Image, textInHeadersComesBack) {
    const TemporaryFolder folder;
    const Image image{2, 2, 1, {0, 0.25f, 0.5f, 1}};
    const ImageAttributes attributes{{"relief:mid", "0.25"}, {"relief:program", "relief bake"}};
    for (const auto& [name, sample] : {std::pair("a.exr", SampleType::real), std::pair("a.tif", SampleType::real),
                                       std::pair("b.tif", SampleType::uint16), std::pair("a.png", SampleType::uint16),
                                       std::pair("b.png", SampleType::uint8)}) {
        writeImage(folder / name, image, sample, attributes);
        EXPECT_EQ(readImageInfo(folder / name).attributes, attributes) << name;
        EXPECT_NEAR(readImage(folder / name).texels[2], 0.5, 0.002) << name;
    }
}

TEST(Image, givesEqualFilesForEqualPictures) {
    const TemporaryFolder folder;
    const Image image{2, 2, 1, {0.0F, 0.25F, 0.5F, 1.0F}};
    for (const char* extension : {".exr", ".png", ".tif"}) {
        const std::string first = folder / (std::string("a") + extension),
                          second = folder / (std::string("b") + extension);
        const SampleType sample = extension == std::string(".exr") ? SampleType::half : SampleType::uint8;
        writeImage(first, image, sample);
        std::this_thread::sleep_for(std::chrono::milliseconds(1100)); // a time stamp would have moved on
        writeImage(second, image, sample);
        EXPECT_EQ(readFile(first), readFile(second)) << extension;
    }
}

TEST(Image, refusesFoldersThatCannotBeWritten) {
    const TemporaryFolder folder;
    expectFailure(Failure::file, {folder / "none/a.png"},
                  [&] { writeImage(folder / "none/a.png", noise(2, 2, 1), SampleType::uint8); });
}

TEST(Image, aFullDiskIsAnErrorAndLeavesTheOldPicture) {
    const TemporaryFolder folder;
    const Image image = noise(67, 41, 3);
    for (const std::string name : {"a.png", "a.tif", "a.exr"}) {
        const SampleType sample = name == "a.exr" ? SampleType::half : SampleType::uint16;
        writeImage(folder / name, image, sample);
        const std::string old = readFile(folder / name);
        for (const double share : {0.0, 0.5, 0.8, 0.97}) {
            const FullDisk disk(rlim_t(share * double(old.size())));
            expectFailure(Failure::file, {folder / name}, [&] { writeImage(folder / name, image, sample); });
        }
        EXPECT_EQ(readFile(folder / name), old);
    }
    EXPECT_EQ(folder.fileCount(), 3u);
}

} // namespace
} // namespace relief::test
