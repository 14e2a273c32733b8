// The tables of words: options, help and messages rely on them.
#include <set>

#include "scene/scene.h"
#include "support.h"

namespace relief::test {
namespace {

template <typename Value, std::size_t kCount>
void expectWhole(const Word<Value> (&table)[kCount], std::size_t valueCount) {
    EXPECT_EQ(kCount, valueCount);
    std::set<std::string> words, helps;
    for (const Word<Value>& row : table) {
        EXPECT_TRUE(words.insert(row.word).second) << row.word;
        EXPECT_TRUE(helps.insert(row.help).second) << row.help;
        EXPECT_STREQ(wordOf(table, row.value), row.word) << "values have one word each";
    }
}

TEST(Words, nameEachValueOfAnEnumerationOnce) {
    expectWhole(kSubdivisions, std::size_t(Subdivision::none) + 1);
    expectWhole(kPaths, std::size_t(Path::dice) + 1);
    expectWhole(kSpacings, std::size_t(Spacing::fractional) + 1);
    expectWhole(kNormals, std::size_t(NormalKind::full) + 1);
    expectWhole(kWraps, std::size_t(Wrap::clamp) + 1);
    expectWhole(kMapFormatChoices, 6);
    expectWhole(kHeightSpaces, std::size_t(HeightSpace::stretch) + 1);
    expectWhole(kInterpolations, std::size_t(Interpolation::step) + 1);
    expectWhole(kShows, std::size_t(Show::error) + 1);
    expectWhole(kLayers, std::size_t(Layer::motion) + 1);
}

} // namespace
} // namespace relief::test
