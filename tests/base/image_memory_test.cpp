// Pictures that lie in other files.
#include <OpenImageIO/imageio.h>

#include "support.h"

namespace relief::test {
namespace {

Image decode(const std::string& bytes) {
    return decodeImage({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()}, "model: image 3");
}

Image ramp(int channels) {
    Image image{.width = 16, .height = 8, .channels = channels, .texels = {}};
    for (int i = 0; i < 16 * 8 * channels; ++i) image.texels.push_back(float(i % 251) / 250);
    return image;
}

TEST(ImageInMemory, isDecodedAsItsFileIs) {
    const TemporaryFolder folder;
    for (const int channels : {1, 3, 4})
        for (const SampleType sample : {SampleType::uint8, SampleType::uint16}) {
            writeImage(folder / "a.png", ramp(channels), sample);
            const Image fromFile = readImage(folder / "a.png"), fromMemory = decode(readFile(folder / "a.png"));
            EXPECT_EQ(fromMemory.channels, channels);
            EXPECT_EQ(fromMemory.width, 16);
            EXPECT_EQ(fromMemory.texels, fromFile.texels);
        }
}

TEST(ImageInMemory, isDecodedFromJpeg) {
    const TemporaryFolder folder;
    const std::string path = folder / "a.jpg";
    const auto output = OIIO::ImageOutput::create(path);
    ASSERT_TRUE(output) << OIIO::geterror();
    ASSERT_TRUE(output->open(path, OIIO::ImageSpec(16, 8, 3, OIIO::TypeDesc::UINT8))) << output->geterror();
    ASSERT_TRUE(output->write_image(OIIO::TypeFloat, ramp(3).texels.data()));
    ASSERT_TRUE(output->close());
    const std::string bytes = readFile(path);
    EXPECT_EQ(decode(bytes).texels, readImage(path).texels);
    expectFailure(Failure::input, {"model: image 3: damaged jpeg"}, [&] { decode(bytes.substr(0, bytes.size() - 9)); });
}

TEST(ImageInMemory, isNamedInMessages) {
    const TemporaryFolder folder;
    writeImage(folder / "a.png", ramp(3), SampleType::uint8);
    const std::string bytes = readFile(folder / "a.png");
    expectFailure(Failure::input, {"model: image 3: not a picture"}, [] { decode("no picture"); });
    expectFailure(Failure::input, {"model: image 3: not a picture"}, [] { decode(""); });
    expectFailure(Failure::input, {"model: image 3: damaged png"}, [&] { decode(bytes.substr(0, bytes.size() / 2)); });
    writeImage(folder / "a.exr", ramp(3), SampleType::half);
    expectFailure(Failure::input, {"model: image 3", "PNG or JPEG", "openexr"},
                  [&] { decode(readFile(folder / "a.exr")); });
    std::string spoiled = bytes;
    for (std::size_t at = 60; at < 90; ++at) spoiled[at] = char(~spoiled[at]);
    expectFailure(Failure::input, {"model: image 3: damaged png"}, [&] { decode(spoiled); });
}

TEST(ImageInMemory, isCheckedAgainstItsLimits) {
    const TemporaryFolder folder;
    writeImage(folder / "a.png", ramp(3), SampleType::uint8);
    const std::string bytes = readFile(folder / "a.png");
    const std::span<const unsigned char> span(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    expectFailure(Failure::input, {"16 x 8"}, [&] { decodeImage(span, "model", {.side = 10}); });
}

} // namespace
} // namespace relief::test
