// What is chosen for a device, and what is said of it.
#include "scene/scene.h"
#include "support.h"

namespace relief::test {
namespace {

DeviceTraits ableDevice() {
    DeviceTraits traits;
    traits.hasTessellation = traits.hasWireframe = traits.hasTransformFeedback = traits.hasVertexStores = true;
    traits.countsPipeline = true;
    traits.timestampNanoseconds = 1;
    traits.maxTexelBufferElements = 1u << 27;
    return traits;
}

TEST(Devices, drawByGridWithoutTessellationShaders) {
    DeviceTraits traits = ableDevice();
    EXPECT_EQ(choosePath(traits).path, Path::tessellation);
    traits.hasTessellation = false;
    EXPECT_EQ(choosePath(traits).path, Path::grid);
    EXPECT_NE(choosePath(traits).reason.find("no tessellation shaders"), std::string::npos);
}

TEST(Devices, drawDicedMeshesWhereThatIsFaster) {
    DeviceTraits traits = ableDevice();
    traits.dicesFaster = true;
    EXPECT_EQ(choosePath(traits).path, Path::dice);
    EXPECT_NE(choosePath(traits).reason.find("measured to be faster"), std::string::npos);
}

TEST(Devices, cutEdgesShortWhereTheTessellatorEnds) {
    DeviceTraits traits = ableDevice();
    traits.maxTessellationLevel = 64;
    TriangleOptions options{.path = Path::tessellation};
    EXPECT_FALSE(isCutShort(options, traits, 63));
    EXPECT_TRUE(isCutShort(options, traits, 64));
    traits.maxTessellationLevel = 32;
    EXPECT_TRUE(isCutShort(options, traits, 32));
    options.rate = 32; // that number was asked for
    EXPECT_FALSE(isCutShort(options, traits, 32));
    options = {.path = Path::dice};
    EXPECT_FALSE(isCutShort(options, traits, 1000));
}

TEST(Devices, areCertifiedByThePathsThatCanBeReadBack) {
    DeviceTraits traits = ableDevice();
    EXPECT_EQ(listCapturablePaths(traits), (std::vector{Path::tessellation, Path::grid, Path::dice}));
    traits.hasTransformFeedback = false;
    EXPECT_EQ(listCapturablePaths(traits), (std::vector{Path::grid, Path::dice}));
    traits.hasVertexStores = false;
    EXPECT_EQ(listCapturablePaths(traits), std::vector{Path::dice});
}

TEST(Devices, haveOneLinePerLimit) {
    EXPECT_TRUE(listLimits(ableDevice()).empty());
    const std::pair<std::function<void(DeviceTraits&)>, const char*> cases[] = {
        {[](DeviceTraits& t) { t.hasTessellation = t.hasTransformFeedback = false; }, "--path tessellation"},
        {[](DeviceTraits& t) { t.hasTransformFeedback = false; }, "transform feedback"},
        {[](DeviceTraits& t) { t.evaluatesInVertexStages = false; }, "--path grid"},
        {[](DeviceTraits& t) { t.hasWireframe = false; }, "--show wireframe"},
        {[](DeviceTraits& t) { t.hasVertexStores = false; }, "--path grid"},
        {[](DeviceTraits& t) { t.timestampNanoseconds = 0; }, "timestamps"},
        {[](DeviceTraits& t) { t.countsPipeline = false; }, "pipeline statistics"},
    };
    for (const auto& [weaken, word] : cases) {
        DeviceTraits traits = ableDevice();
        weaken(traits);
        const std::vector<std::string> limits = listLimits(traits);
        ASSERT_EQ(limits.size(), 1u) << word;
        EXPECT_NE(limits[0].find(word), std::string::npos) << limits[0];
    }
}

TEST(Devices, sayHowTablesAreRead) {
    DeviceTraits traits = ableDevice();
    EXPECT_NE(describeTableReads(traits).find("texel buffers"), std::string::npos);
    traits.readsTablesAs = TableAccess::storageBuffers;
    traits.maxTexelBufferElements = 65536;
    EXPECT_NE(describeTableReads(traits).find("storage buffers"), std::string::npos);
    EXPECT_NE(describeTableReads(traits).find("65536"), std::string::npos);
}

} // namespace
} // namespace relief::test
