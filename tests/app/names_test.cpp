// Names that are not UTF-8: files, and what files hold.
#include "program.h"

namespace relief::test {
namespace {

constexpr const char* kReplacement = "\xEF\xBF\xBD"; // U+FFFD

class Names : public ::testing::Test {
protected:
    void SetUp() override {
        putFile(cage_, "g gr\xfcn\nusemtl bl\xe4u\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
        putFile(points_, "0,0.5,0.5\n");
        writeImage(map_, {2, 2, 1, {0, 1, 1, 0}}, {{.name = "h\xf6he", .sample = SampleType::real}});
    }

    TemporaryFolder folder_;
    std::string cage_ = folder_ / "c\xe4ge.obj", map_ = folder_ / "m\xe4p.exr", points_ = folder_ / "p\xf6ints.csv";
};

TEST_F(Names, thatAreNotUtf8ComeOutOfEveryVerbAsJson) {
    for (const Words& words :
         {Words{"render", cage_, "--size", "16,16", "--height", map_, "-o", folder_ / "\xe4.png"},
          Words{"export", cage_, "--rate", "1", "-o", folder_ / "\xe4.ply"},
          Words{"sample", cage_, "--at", points_, "-o", folder_ / "\xe4.csv"},
          Words{"animate", cage_, "--turntable", "1", "--size", "16,16", "-o", folder_ / "\xe4{frame}.png"},
          Words{"check", cage_, "--height", map_, "--points", "10", "--rate", "2"}, Words{"info", cage_, map_}}) {
        SCOPED_TRACE(words[0]);
        const Outcome plain = relief(words), asJson = relief(words, "--json");
        EXPECT_EQ(plain.exitCode, 0) << plain.err;
        const nlohmann::json json = jsonOf(asJson);
        EXPECT_TRUE(contains(json.dump(), kReplacement)) << json;
    }
}

TEST_F(Names, ofWhatFilesHoldAreReplacedWhereTheyAreWrong) {
    const nlohmann::json json = jsonOf(relief({"info", cage_, map_, "--json"}));
    EXPECT_EQ(json[0].at("parts")[0].at("name"), fmt::format("gr{}n", kReplacement));
    EXPECT_EQ(json[0].at("parts")[0].at("material"), fmt::format("bl{}u", kReplacement));
    EXPECT_EQ(json[1].at("channels")[0], fmt::format("h{}he", kReplacement));
}

TEST_F(Names, withLineBreaksStayOnOneLineOfAWarning) {
    const std::string cage = folder_ / "two\nlines.obj";
    putFile(cage, "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nwhat 1\n");
    const Outcome outcome = relief({"info", cage});
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

} // namespace
} // namespace relief::test
