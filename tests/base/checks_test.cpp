#include "support.h"

namespace relief::test {
namespace {

TEST(ReliefCheck, passesWhatHoldsAndEvaluatesEachOperandOnce) {
    int calls = 0;
    const auto three = [&] { return ++calls, 3; };
    RELIEF_CHECK(three() == 3u);
    RELIEF_CHECK(three() < 4);
    RELIEF_CHECK(-1 < 1u); // by value, whatever the signs of the types
    RELIEF_CHECK(!std::string("a").empty());
    EXPECT_EQ(calls, 2);
}

TEST(ReliefCheck, printsFileConditionAndBothOperands) {
    const std::size_t count = 3;
    expectFailure(Failure::internal, {"checks_test.cpp:", "count + 1 == 5 does not hold: 4 == 5"},
                  [&] { RELIEF_CHECK(count + 1 == 5); });
    expectFailure(Failure::internal, {"does not hold: -1 >= 1"}, [] { RELIEF_CHECK(-1 >= 1u); });
    expectFailure(Failure::internal, {"does not hold: 0.5 > 1.5"}, [] { RELIEF_CHECK(0.5 > 1.5); });
    expectFailure(Failure::internal, {"isClosed does not hold: false"}, [] {
        const bool isClosed = false;
        RELIEF_CHECK(isClosed);
    });
}

} // namespace
} // namespace relief::test
