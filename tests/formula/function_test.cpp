// Height functions by themselves: their text, their shaders, the cache of these, their values.
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

#include "formula/formula.h"
#include "on_device.h"
#include "support.h"

namespace relief::test {
namespace {

/// Every test has a cache of its own.
class HeightFunctions : public ::testing::Test {
protected:
    void SetUp() override { setenv("RELIEF_CACHE", (folder_ / "relief").c_str(), 1); }
    [[nodiscard]] std::vector<std::filesystem::path> cacheFiles() const {
        std::vector<std::filesystem::path> files;
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path / "relief"))
            files.push_back(entry.path());
        return files;
    }
    TemporaryFolder folder_;
};

std::vector<FunctionValue> evaluate(const HeightFunction& function, const std::vector<FunctionPoint>& points) {
    return FunctionEvaluator(device(), function).evaluate(points);
}

FunctionValue valueOf(const std::string& text, const FunctionPoint& point = {}) {
    const HeightFunction function({"test.glsl", text});
    return evaluate(function, {point}).front();
}

/// The error of a text; its failure has to be `input`.
std::string errorOf(const std::string& text) {
    try {
        const HeightFunction function({"bumps.glsl", text});
    } catch (const Error& error) {
        EXPECT_EQ(int(error.failure), int(Failure::input)) << error.what();
        return error.what();
    }
    return "no error";
}

bool startsWith(const std::string& text, const std::string& start) { return text.compare(0, start.size(), start) == 0; }

const std::string kHeight = "float height(vec3 p, vec2 st, float t) { return p.x; }\n";

// --- values

TEST_F(HeightFunctions, areGivenPointTextureCoordinatesAndTime) {
    const std::string text = "float height(vec3 p, vec2 st, float t) {\n"
                             "    return p.x + 10.0 * p.y + 100.0 * p.z + 1e3 * st.x + 1e4 * st.y + 1e5 * t;\n}\n";
    const HeightFunction function({"test.glsl", text});
    std::vector<FunctionPoint> points;
    for (int i = 0; i < 1000; ++i)
        points.push_back({.p = vec3(i % 2, i % 3, i % 5), .st = vec2(i % 7, i % 4), .t = float(i % 6)});
    const std::vector<FunctionValue> values = evaluate(function, points);
    ASSERT_EQ(values.size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const FunctionPoint& x = points[i];
        EXPECT_EQ(values[i].value, x.p.x + 10 * x.p.y + 100 * x.p.z + 1e3f * x.st.x + 1e4f * x.st.y + 1e5f * x.t) << i;
    }
}

TEST_F(HeightFunctions, thatAreBuiltInStayWithinTheBoundTheyState) {
    const std::vector<std::string> names = listHeightFunctions();
    EXPECT_EQ(names.size(), 3u);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(-5, 5);
    std::vector<FunctionPoint> points;
    for (int i = 0; i < 20000; ++i)
        points.push_back({.p = vec3(number(random), number(random), number(random)),
                          .st = vec2(number(random), number(random)),
                          .t = number(random)});
    for (const std::string& name : names) {
        const HeightFunction function(readHeightFunction(name));
        ASSERT_TRUE(function.statesBound()) << name;
        const float bound = FunctionEvaluator(device(), function).bound();
        float lowest = INFINITY, highest = -INFINITY;
        for (const FunctionValue& found : evaluate(function, points)) {
            EXPECT_FALSE(found.hasTooManyTurns) << name;
            lowest = std::min(lowest, found.value), highest = std::max(highest, found.value);
        }
        EXPECT_LE(std::max(-lowest, highest), bound) << name;
        EXPECT_GT(highest - lowest, 0.5f * bound) << name << " hardly displaces";
    }
}

TEST_F(HeightFunctions, moveWithTimeWhereTheySaySo) {
    const FunctionPoint now{.p = vec3(0.3f, 0.2f, 0.1f)}, later{.p = now.p, .t = 0.5f};
    const auto moves = [&](const char* name) {
        const HeightFunction function(readHeightFunction(name));
        const std::vector<FunctionValue> values = evaluate(function, {now, later});
        return values[0].value != values[1].value;
    };
    EXPECT_TRUE(moves("waves"));
    EXPECT_FALSE(moves("golf"));
}

// --- loops

TEST_F(HeightFunctions, withAnEndlessLoopEndAndSaySo) {
    for (const char* loop : {"while (true) x += 1.0;", "for (;;) x += 1.0;", "do { x += 1.0; } while (x > -1.0);",
                             "for (int i = 0; i < 2000; ++i) x += 1.0;",
                             "for (int i = 0; i < 100; ++i) for (int j = 0; j < 100; ++j) x += 1.0;"}) {
        const std::string text =
            fmt::format("float height(vec3 p, vec2 st, float t) {{ float x = p.x; {} return x; }}", loop);
        EXPECT_TRUE(valueOf(text).hasTooManyTurns) << loop;
    }
}

TEST_F(HeightFunctions, mayTakeAThousandTurns) {
    const FunctionValue found = valueOf("float height(vec3 p, vec2 st, float t) {\n"
                                        "    float sum = 0.0;\n"
                                        "    for (int i = 0; i < 30; ++i) for (int j = 0; j < 30; j++) sum += 1.0;\n"
                                        "    int k = 0; while (k < 9) ++k; do --k; while (k > 0);\n"
                                        "    return sum + float(k);\n}");
    EXPECT_FALSE(found.hasTooManyTurns);
    EXPECT_EQ(found.value, 900.0f);
}

// --- names

// All of these are names of shaders, or of parts of vectors.
TEST_F(HeightFunctions, mayDeclareNamesThatShadersHave) {
    const std::string text =
        "#define inputs 2.0\n"
        "#define TWICE(x) (2.0 * (x))\n"
        "struct Face { float x, root; };\n"
        "const float a = 3.0, xyz = 4.0; // letters of swizzles\n"
        "const float displaced = 6.0;\n"
        "float project(float x) { return TWICE(x) + inputs; }\n"
        "Face fetchFace(float root) { Face limit; limit.x = a; limit.root = root; return limit; }\n"
        "float height(vec3 p, vec2 st, float t) {\n"
        "    Face face = fetchFace(p.xyz.x);\n"
        "    vec4 color = vec4(1.0, 2.0, 3.0, xyz);\n"
        "    return project(face.x) + face.root + color.a + displaced;\n}\n";
    EXPECT_EQ(valueOf(text, {.p = vec3(7)}).value, 8.0f + 7.0f + 4.0f + 6.0f);
    const HeightFunction function({"test.glsl", text});
    EXPECT_FALSE(function.shader("grid.vert", false, TableAccess::texelBuffers).empty());
    EXPECT_FALSE(function.shader("dice_insides.comp", true, TableAccess::storageBuffers).empty());
}

TEST_F(HeightFunctions, areInTheShadersThatEvaluateHeightsAndInNoOthers) {
    const HeightFunction function({"test.glsl", kHeight});
    for (const char* file :
         {"patch.tese", "patch_capture.tese", "grid.vert", "grid_capture.vert", "dice_edges.comp", "dice_insides.comp",
          "rates.comp", "sample.comp", "layers.comp", "mesh.vert", "surface.frag"})
        EXPECT_FALSE(function.shader(file, false, TableAccess::texelBuffers).empty()) << file;
    for (const char* file : {"patch.vert", "patch.tesc", "light.comp", "dice_triangles.comp", "pose_cage.comp"})
        EXPECT_TRUE(function.shader(file, false, TableAccess::texelBuffers).empty()) << file;
}

// --- mistakes

TEST_F(HeightFunctions, withAMistakeNameItsLine) {
    EXPECT_TRUE(
        startsWith(errorOf("// dimples\n\nfloat height(vec3 p, vec2 st, float t) {\n    return sinus(p.x);\n}\n"),
                   "bumps.glsl:4: 'sinus' : no matching overloaded function"));
    EXPECT_TRUE(startsWith(errorOf("float height(vec3 p, vec2 st, float t) { return p.x }\n"), "bumps.glsl:1: "));
    EXPECT_TRUE(startsWith(errorOf("/* a\n comment */ float twice(float x) { return 2.0 * x; }\n"
                                   "float height(vec3 p, vec2 st, float t) { return twice(st); }\n"),
                           "bumps.glsl:3: 'twice' : "));
    EXPECT_TRUE(startsWith(errorOf("float height(vec3 p, vec2 st, float t) {\n    return p.x;\n"),
                           "bumps.glsl:1: '{' is not "));
    for (const char* text : {"", "float heights(vec3 p, vec2 st, float t) { return p.x; }", "const float height = 1.0;",
                             "// float height(vec3 p, vec2 st, float t) { return p.x; }"})
        EXPECT_EQ(errorOf(text), "bumps.glsl: there is no function float height(vec3 p, vec2 st, float t)") << text;
    for (const char* text : {"float height(vec3 p) { return p.x; }", "void height(vec3 p, vec2 st, float t) {}"})
        EXPECT_TRUE(startsWith(errorOf(text), "bumps.glsl")) << errorOf(text);
}

TEST_F(HeightFunctions, mayNotDeclareWhatIsNotTheirOwn) {
    for (const char* line : {"#version 460", "#extension GL_EXT_ray_query : require", "#include \"heights.glsl\"",
                             "#pragma optimize(off)", "#line 7"})
        EXPECT_TRUE(startsWith(errorOf("\n" + std::string(line) + "\n" + kHeight),
                               "bumps.glsl:2: a height function cannot have #"))
            << line;
    for (const char* line :
         {"uniform float x;", "layout(location = 0) in vec3 x;", "void main() {}", "shared float x;", "double x = 1.0;",
          "float f() { return gl_FragCoord.x; }", "float formula_value() { return 1.0; }"})
        EXPECT_TRUE(startsWith(errorOf("\n\n" + std::string(line) + "\n" + kHeight),
                               "bumps.glsl:3: a height function cannot have "))
            << line;
    EXPECT_TRUE(startsWith(errorOf(std::string("float x\0;", 9) + kHeight), "bumps.glsl: byte 7 is 0"));
}

// What would be kept from call to call, loops that nothing counts, and what drivers compile for minutes.
TEST_F(HeightFunctions, mayNotHaveStateUncountedLoopsOrLargeArrays) {
    const auto errorOfLine = [&](const std::string& line) { return errorOf(line + "\n" + kHeight); };
    EXPECT_TRUE(startsWith(errorOfLine("float sum = 0.0;"), "bumps.glsl:1: sum has to be const"));
    EXPECT_TRUE(startsWith(errorOfLine("const float a = 1.0; vec3 b[2];"), "bumps.glsl:1: b has to be const"));
    EXPECT_EQ(errorOfLine("const float a = 1.0, b = 2.0; const float c[2] = float[](1.0, 2.0);"), "no error");
    EXPECT_TRUE(
        startsWith(errorOfLine("#define W while"), "bumps.glsl:1: a macro of a height function cannot have loops"));
    EXPECT_TRUE(startsWith(errorOfLine("float f() { float a[20000]; return a[3]; }"), "bumps.glsl:1: an array"));
    std::string sum = "float f(float x) { return x";
    for (int i = 0; i < 2000; ++i) sum += "+sin(x*" + std::to_string(i) + ".0)";
    EXPECT_NE(errorOf(sum + "; }\nfloat height(vec3 p, vec2 st, float t) { return f(p.x); }").find("words of SPIR-V"),
              std::string::npos);
}

TEST_F(HeightFunctions, ofAFileMayHaveAMarkAndMustBeShort) {
    const std::string path = folder_ / "f.glsl";
    putFile(path, "\xef\xbb\xbf" + kHeight);
    EXPECT_NO_THROW(HeightFunction(readHeightFunction(path)));
    putFile(path, std::string(10'000'000, ' ') + kHeight);
    EXPECT_THROW(readHeightFunction(path), Error);
    EXPECT_THROW(readHeightFunction(folder_ / "none.glsl"), Error);
}

// The compiler works through expressions by recursion.
TEST_F(HeightFunctions, thatAreLongAreCompiledOrRefused) {
    const auto repeat = [](const std::string& part, std::size_t bytes) {
        std::string all;
        while (all.size() < bytes) all += part;
        return all;
    };
    const std::size_t most = kMostFunctionBytes - 100;
    const std::string pairs[] = {repeat("(", most / 2), repeat(")", most / 2)};
    for (const std::string& body :
         {"float x = p.x; return x" + repeat("+x", most) + ";",
          "float x = p.x; return x" + repeat("?x>t:x", most) + ";", "return " + pairs[0] + "p.x" + pairs[1] + ";",
          "return " + repeat("-(", 2 * most / 3) + "p.x" + repeat(")", most / 3) + ";",
          "return " + repeat("abs(", 4 * most / 5) + "p.x" + repeat(")", most / 5) + ";", repeat("{", most),
          repeat("if(t>0.)", most) + "return 1.0; return p.x;"}) {
        try {
            const HeightFunction function({"long.glsl", "float height(vec3 p, vec2 st, float t) {" + body + "}"});
        } catch (const Error& error) {
            EXPECT_EQ(int(error.failure), int(Failure::input)) << error.what();
        }
    }
}

// --- cache

TEST_F(HeightFunctions, areCompiledOnce) {
    const FunctionText text{"test.glsl", kHeight};
    std::vector<std::uint32_t> words;
    {
        const HeightFunction first(text);
        const auto code = first.shader("grid.vert", false, TableAccess::texelBuffers);
        words.assign(code.begin(), code.end());
        EXPECT_EQ(first.costs().compiledCount, 2);
        EXPECT_EQ(first.costs().cachedCount, 0);
    }
    const HeightFunction second(text);
    const auto code = second.shader("grid.vert", false, TableAccess::texelBuffers);
    EXPECT_TRUE(std::ranges::equal(code, words));
    EXPECT_EQ(second.costs().compiledCount, 0);
    EXPECT_EQ(second.costs().cachedCount, 2);
    // Everything that decides the code is in the key.
    const HeightFunction other({"test.glsl", "float height(vec3 p, vec2 st, float t) { return p.y; }\n"});
    EXPECT_EQ(other.costs().compiledCount, 1);
    (void)second.shader("grid.vert", true, TableAccess::texelBuffers);
    (void)second.shader("grid.vert", false, TableAccess::storageBuffers);
    EXPECT_EQ(second.costs().compiledCount, 2);
    EXPECT_NE(other.number(), second.number());
}

TEST_F(HeightFunctions, areCompiledAgainWhereTheCacheIsDamaged) {
    const FunctionText text{"test.glsl", kHeight};
    { const HeightFunction function(text); }
    ASSERT_EQ(cacheFiles().size(), 1u);
    const std::string path = cacheFiles().front().string(), whole = readFile(path);
    std::string flipped = whole, foreign = whole;
    flipped[whole.size() / 2] ^= 1;
    foreign[0] = 'x';
    for (const std::string& damaged :
         {flipped, foreign, whole.substr(0, whole.size() - 4), whole.substr(0, 20), std::string(), whole + "more"}) {
        putFile(path, damaged);
        const HeightFunction again(text);
        EXPECT_EQ(again.costs().compiledCount, 1);
        EXPECT_EQ(readFile(path), whole) << "and kept anew";
    }
}

// Pipelines are kept by the number: it is the same for the same text, and of no function once the last one has ended.
TEST_F(HeightFunctions, areSharedAsLongAsTheyLive) {
    const FunctionText text{"test.glsl", kHeight};
    std::uint32_t number = 0;
    {
        const std::shared_ptr<const HeightFunction> first = shareHeightFunction(text), same = shareHeightFunction(text);
        EXPECT_EQ(first, same);
        EXPECT_NE(first, shareHeightFunction({"other.glsl", kHeight})); // whose messages have another name
        number = first->number();
        EXPECT_TRUE(HeightFunction::lives(number));
    }
    EXPECT_FALSE(HeightFunction::lives(number));
    EXPECT_NE(shareHeightFunction(text)->number(), number);
}

TEST_F(HeightFunctions, areNotKeptWhereThatIsNotWanted) {
    setenv("RELIEF_CACHE", "0", 1);
    EXPECT_EQ(cacheFolder(), "");
    for (int i = 0; i < 2; ++i) EXPECT_EQ(HeightFunction({"test.glsl", kHeight}).costs().compiledCount, 1);
    EXPECT_EQ(folder_.fileCount(), 0u);
}

TEST_F(HeightFunctions, areCompiledWhereTheCacheCannotBeWritten) {
    putFile(folder_ / "relief", "a file, where the folder should be");
    EXPECT_EQ(HeightFunction({"test.glsl", kHeight}).costs().compiledCount, 1);
}

} // namespace
} // namespace relief::test
