#include "animation/arithmetic.h"

#include <cmath>
#include <numbers>

#include "support.h"

namespace relief::test {
namespace {

double valueOf(const std::string& text, double t = 0) {
    TextReader reader(text);
    const Arithmetic arithmetic = readArithmetic(reader);
    EXPECT_TRUE(reader.isAtEnd()) << text;
    return arithmetic.at(t);
}

void expectRefused(const std::string& text, int column, std::vector<std::string> words) {
    words.push_back(fmt::format("column {}: ", column));
    expectFailure(Failure::usage, words, [&] {
        TextReader reader(text);
        readArithmetic(reader);
    });
}

TEST(Arithmetic, readsNumbers) {
    EXPECT_EQ(valueOf("0"), 0);
    EXPECT_EQ(valueOf("90"), 90);
    EXPECT_EQ(valueOf(".5"), 0.5);
    EXPECT_EQ(valueOf("2."), 2);
    EXPECT_EQ(valueOf("1.25e2"), 125);
    EXPECT_EQ(valueOf("1E-3"), 1e-3);
    EXPECT_EQ(valueOf("0.1"), 0.1);
    EXPECT_EQ(valueOf("pi"), std::numbers::pi);
    EXPECT_EQ(valueOf("t", -2.5), -2.5);
}

TEST(Arithmetic, groupsAsMathematicsDoes) {
    EXPECT_EQ(valueOf("1+2*3"), 7);
    EXPECT_EQ(valueOf("(1+2)*3"), 9);
    EXPECT_EQ(valueOf("7-4-2"), 1);
    EXPECT_EQ(valueOf("8/4/2"), 1);
    EXPECT_EQ(valueOf("8/4*2"), 4);
    EXPECT_EQ(valueOf("2^3^2"), 512);
    EXPECT_EQ(valueOf("-2^2"), -4);
    EXPECT_EQ(valueOf("(-2)^2"), 4);
    EXPECT_EQ(valueOf("2^-1"), 0.5);
    EXPECT_EQ(valueOf("2*-3"), -6);
    EXPECT_EQ(valueOf("1--1"), 2);
    EXPECT_EQ(valueOf("+-+2"), -2);
    EXPECT_EQ(valueOf("3*2^2"), 12);
    EXPECT_EQ(valueOf(" ( 1 +\t2 )\n* 3 "), 9);
}

TEST(Arithmetic, computesItsFunctions) {
    EXPECT_EQ(valueOf("sin(t)", 1.25), std::sin(1.25));
    EXPECT_EQ(valueOf("cos(pi)"), -1);
    EXPECT_EQ(valueOf("abs(-3)"), 3);
    EXPECT_EQ(valueOf("min(1, 2)"), 1);
    EXPECT_EQ(valueOf("min(2, 1)"), 1);
    EXPECT_EQ(valueOf("max(1, 2)"), 2);
    EXPECT_EQ(valueOf("max(2, 1)"), 2);
    EXPECT_EQ(valueOf("90*sin(2*pi*t/4) + max(t, 1)^2", 3), 90 * std::sin(2 * std::numbers::pi * 3 / 4) + 9);
}

TEST(Arithmetic, hasNoFiniteValueWhereMathematicsHasNone) {
    for (const std::string text : {"1/0", "-1/0", "0/0", "(-1)^0.5", "10^400", "0^-1", "min(0/0, 1)", "min(1, 0/0)",
                                   "max(0/0, 1)", "max(1, 0/0)", "1/t", "1/sin(t)"})
        EXPECT_FALSE(std::isfinite(valueOf(text))) << text;
}

TEST(Arithmetic, reportsWhetherItDependsOnTime) {
    const auto usesTime = [](const std::string& text) {
        TextReader reader(text);
        return readArithmetic(reader).usesTime();
    };
    EXPECT_TRUE(usesTime("1+sin(2*t)"));
    EXPECT_FALSE(usesTime("1+sin(2*pi)"));
}

TEST(Arithmetic, stopsWhereItCannotGoOn) {
    const std::string text = "1+2 ) 3";
    TextReader reader(text);
    EXPECT_EQ(readArithmetic(reader).at(0), 3);
    EXPECT_EQ(reader.column(), 5u);
    EXPECT_TRUE(reader.take(')'));
}

TEST(Arithmetic, saysWhatItFoundAndWhatItExpected) {
    const std::string operands = "a number, t, pi, '(', sin, cos, abs, min or max";
    expectRefused("", 1, {"found the end", operands});
    expectRefused("1 + ", 5, {"found the end", operands});
    expectRefused("1 + * 2", 5, {"found '*'", operands});
    expectRefused("2*)", 3, {"found ')'", operands});
    expectRefused(".", 1, {"found '.'", operands});
    expectRefused("(1 + 2", 7, {"found the end", "an operator (+ - * / ^) or ')'"});
    expectRefused("(1 2)", 4, {"found '2'", "or ')'"});
    expectRefused("(2t)", 3, {"found 't'", "an operator"});
    expectRefused("sin 1", 5, {"found '1'", "'(' after sin"});
    expectRefused("sin()", 5, {"found ')'", operands});
    expectRefused("sin(1, 2)", 6, {"found ','", "or ')'"});
    expectRefused("min(1)", 6, {"found ')'", "','", "second number of min"});
    expectRefused("max(1, 2, 3)", 9, {"found ','", "or ')'"});
    expectRefused("1+\xc3\xa9", 3, {"found the byte 0xc3"});
    expectRefused(std::string("1+\x01", 3), 3, {"found the byte 0x01"});
}

TEST(Arithmetic, listsTheNamesThatExist) {
    expectRefused("2*sine(t)", 3, {"'sine'", "t, pi, sin, cos, abs, min, max", "did you mean 'sin'?"});
    expectRefused("T", 1, {"'T'", "t, pi, sin", "did you mean 't'?"});
    expectRefused("1+velocity", 3, {"'velocity'", "t, pi, sin"});
    expectRefused("nan", 1, {"'nan'"});
    expectRefused("inf", 1, {"'inf'"});
    expectRefused(std::string(100, 'q'), 1, {"'" + std::string(24, 'q') + "...'"});
}

TEST(Arithmetic, refusesNumbersOutOfRange) {
    expectRefused("1+1e999", 3, {"too large or too small"});
    expectRefused("1e-999", 1, {"too large or too small"});
}

TEST(Arithmetic, refusesNestingThatIsTooDeep) {
    const auto repeated = [](const std::string& text, int count) {
        std::string all;
        for (int i = 0; i < count; ++i) all += text;
        return all;
    };
    EXPECT_EQ(valueOf(repeated("(", 63) + "1" + repeated(")", 63)), 1);
    expectRefused(repeated("(", 64) + "1" + repeated(")", 64), 65, {"more than 64"});
    expectRefused(repeated("-", 4000) + "1", 65, {"more than 64"});
    expectRefused(repeated("1^", 2000) + "1", 129, {"more than 64"});
    expectRefused(repeated("abs(", 1000), 257, {"more than 64"});
    EXPECT_EQ(valueOf(repeated("1+", 2000) + "1"), 2001) << "which is long, not deep";
}

TEST(Arithmetic, refusesTextsThatAreTooLong) {
    EXPECT_EQ(valueOf(std::string(4095, ' ') + "1"), 1);
    expectFailure(Failure::usage, {"4097 letters", "4096"}, [] { valueOf(std::string(4096, ' ') + "1"); });
}

} // namespace
} // namespace relief::test
