// What is said of the text of a height function that cannot be compiled: one line, soon, with the author's line.
#include <chrono>

#include <gtest/gtest.h>

#include "formula/formula.h"
#include "support.h"

namespace relief::test {
namespace {

class FunctionMessages : public ::testing::Test {
protected:
    void SetUp() override { setenv("RELIEF_CACHE", "0", 1); }
    void TearDown() override { unsetenv("RELIEF_CACHE"); }
};

/// The error of a text, whose failure has to be `input`, on one line and within a few seconds.
std::string messageOf(const std::string& text) {
    const auto start = std::chrono::steady_clock::now();
    std::string message = "no error";
    try {
        const HeightFunction function({"bumps.glsl", text});
    } catch (const Error& error) {
        EXPECT_EQ(int(error.failure), int(Failure::input)) << error.what();
        message = error.what();
    }
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10)) << text.substr(0, 80);
    return message;
}

/// A height function with this line in it, the third one of its text.
std::string withLine(const std::string& line) {
    return "// a comment\nfloat height(vec3 p, vec2 st, float t) {\n" + line + "\nreturn p.x;\n}\n";
}

TEST_F(FunctionMessages, nameTheLineOfABracketWithoutItsOther) {
    EXPECT_EQ(messageOf(withLine("float x = (p.x;")), "bumps.glsl:3: '(' is not closed");
    EXPECT_EQ(messageOf(withLine("float x = p.x);")), "bumps.glsl:3: ')' closes nothing");
    EXPECT_EQ(messageOf(withLine("float x[3;")), "bumps.glsl:3: '[' is not closed");
    EXPECT_EQ(messageOf(withLine("if (p.x > 0.0) {")), "bumps.glsl:2: '{' is not closed");
    EXPECT_EQ(messageOf(withLine("}")), "bumps.glsl:5: '}' closes nothing");
    EXPECT_EQ(messageOf("float f(float x { return x; }\n" + withLine("")), "bumps.glsl:1: '(' is not closed");
    EXPECT_EQ(messageOf("/* open\n" + withLine("")), "bumps.glsl:1: the comment that begins here has no end");
    // Macros and conditionals may hold one of two.
    EXPECT_EQ(messageOf("#define BEGIN {\n#define END }\n" + withLine("if (p.x > 0.0) BEGIN p.x = 0.0; END")),
              "no error");
    EXPECT_EQ(messageOf(withLine("#if 0\n{\n#endif")), "no error");
}

TEST_F(FunctionMessages, nameTheLineOfAConditional) {
    EXPECT_EQ(messageOf(withLine("#if 1")), "bumps.glsl:3: the #if here has no #endif");
    EXPECT_EQ(messageOf(withLine("#else")), "bumps.glsl:3: #else has no #if before it");
    EXPECT_EQ(messageOf(withLine("#endif")), "bumps.glsl:3: #endif has no #if before it");
    EXPECT_EQ(messageOf(withLine("#if defined(X) &&\n#endif")), "bumps.glsl:3: the condition of this #if is no number");
    EXPECT_TRUE(messageOf(withLine("#if a.b\n#endif")).starts_with("bumps.glsl:3: "));
    EXPECT_EQ(messageOf(withLine("#if 1\np.x += 1.0;\n#elif 0\n#else\n#endif")), "no error");
}

TEST_F(FunctionMessages, nameWhatGlslOrAHeightFunctionLacks) {
    EXPECT_EQ(messageOf("float f(float x) { return x < 0.0 ? 0.0 : f(x - 1.0); }\n" + withLine("p.x = f(p.y);")),
              "bumps.glsl:1: f calls itself: there is no recursion in GLSL");
    const std::string circle = messageOf("float g(float x);\nfloat f(float x) { return g(x); }\n"
                                         "float g(float x) { return f(x); }\n" +
                                         withLine("p.x = f(p.y);"));
    EXPECT_TRUE(circle.ends_with("which comes back to it: there is no recursion in GLSL") ||
                circle.find("comes back") != std::string::npos)
        << circle;
    for (const char* word : {"dFdx", "fwidth", "dFdyFine"})
        EXPECT_EQ(messageOf(withLine(std::string("p.x = ") + word + "(p.x);")),
                  std::string("bumps.glsl:3: a height function cannot have ") + word +
                      ": it is given p, st and t alone");
    EXPECT_EQ(messageOf(withLine("p.x = float(subgroupAdd(1));")),
              "bumps.glsl:3: 'subgroupAdd' : needs an extension of GLSL, and a height function has none");
    EXPECT_EQ(messageOf(withLine("p.x = 1.0")), "bumps.glsl:4: syntax error, unexpected RETURN, expecting ',' or ';'");
}

TEST_F(FunctionMessages, showLettersWhole) {
    EXPECT_EQ(messageOf(withLine("float h\xc3\xb6he = 1.0;")),
              "bumps.glsl:3: '\xc3\xb6' is no letter of GLSL, which is written in ASCII");
    EXPECT_EQ(messageOf(withLine("float x\xe2\x82;")),
              "bumps.glsl:3: the byte 0xe2 is no letter of GLSL, which is written in ASCII");
    EXPECT_EQ(messageOf(withLine("// H\xc3\xb6he")), "no error");
    EXPECT_TRUE(messageOf("#error zu hoch: H\xc3\xb6he\n" + withLine("")).starts_with("bumps.glsl:1: "));
}

/// #define A0 FIRST, and from A1 on NEXT with the name before in place of each @, up to A30.
std::string macros(const std::string& parameters, const std::string& first, const std::string& next) {
    std::string text = "#define A0" + parameters + " " + first + "\n";
    for (int i = 1; i <= 30; ++i) {
        std::string line = "#define A" + std::to_string(i) + parameters + " " + next;
        for (std::size_t at = line.find('@'); at != std::string::npos; at = line.find('@', at))
            line.replace(at, 1, "A" + std::to_string(i - 1));
        text += line + "\n";
    }
    return text;
}

TEST_F(FunctionMessages, endWhatGrowsWithoutBound) {
    const auto expectGrowth = [](const std::string& text, const std::string& word) {
        const std::string message = messageOf(text);
        EXPECT_NE(message.find(": with '" + word + "' the function becomes more than "), std::string::npos) << message;
        EXPECT_TRUE(message.starts_with("bumps.glsl:")) << message;
    };
    expectGrowth(macros("", "p.x", "@ + @") + withLine("p.x = A30;"), "A30");
    expectGrowth(macros("(x)", "x + x", "@(@(x))") + withLine("p.x = A30(p.x);"), "A30");
    expectGrowth(macros("(x)", "x", "@(x) * @(x)") + withLine("p.x = A30(p.x);"), "A30");
    expectGrowth(macros("", "1", "@ + @") + withLine("#if A30\n#endif"), "A30");
    expectGrowth("#define TWICE(f) f f\n" + macros("", "p.x", "TWICE(@ +)") + withLine("p.x = A30 0.0;"), "A30");
    // Drivers compile a function into each place that calls it.
    std::string calls = "float f0(float x) { return sin(x); }\n";
    for (int i = 1; i < 30; ++i) {
        const std::string before = "f" + std::to_string(i - 1);
        calls += "float f" + std::to_string(i) + "(float x) { return " + before + "(x) + " + before + "(x + 1.0); }\n";
    }
    EXPECT_NE(messageOf(calls + withLine("p.x = f29(p.x);")).find("the function becomes more than"), std::string::npos);
    EXPECT_NE(
        messageOf("const int N = 100000000;\n" + withLine("float a[N]; p.x = a[int(p.y)];")).find("array of 1e+08"),
        std::string::npos);
    EXPECT_EQ(messageOf(withLine("#define CAT(a, b) a ## b")),
              "bumps.glsl:3: a macro of a height function cannot have ##");
    // What grows a little is none of that.
    EXPECT_EQ(messageOf("#define SQUARE(x) ((x) * (x))\n" + withLine("p.x = SQUARE(SQUARE(SQUARE(p.x)));")),
              "no error");
}

} // namespace
} // namespace relief::test
