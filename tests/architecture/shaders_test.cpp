// Shaders: no function without a call, and specialization constants by their names.
#include <cctype>

#include <gtest/gtest.h>

#include "architecture/includes.h"

namespace relief::test {
namespace {

/// The text of files without comments.
std::string codeOf(const std::vector<Line>& lines) {
    std::string code;
    for (const Line& line : lines) code += line.text.substr(0, line.text.find("//")) + "\n";
    return code;
}

/// How often a pattern's first group names each name.
std::map<std::string, int> countNames(const std::string& code, const std::regex& pattern) {
    std::map<std::string, int> counts;
    for (std::sregex_iterator found(code.begin(), code.end(), pattern), end; found != end; ++found)
        ++counts[(*found)[1]];
    return counts;
}

/// How often each name stands before a parenthesis, or stands for a macro (`#define RELIEF_POINT tilePoint`).
std::map<std::string, int> countUses(const std::string& code) {
    static const std::regex macro(R"(#define\s+\w+\s+(\w+)\s*\n)");
    std::map<std::string, int> uses = countNames(code, macro);
    const auto isLetter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    for (std::size_t open = code.find('('); open != std::string::npos; open = code.find('(', open + 1)) {
        const std::size_t end = code.find_last_not_of(" \n", open - 1) + 1;
        std::size_t start = end;
        while (start > 0 && isLetter(code[start - 1])) --start;
        ++uses[code.substr(start, end - start)];
    }
    return uses;
}

/// Functions that shaders define and never call. Those of `shared` may be called by C++ instead.
Names functionsWithoutCall(const std::string& shaders, const std::string& shared, const std::string& sources) {
    static const std::regex definition(R"((?:void|bool|u?int|float|[iu]?vec[234]|mat[234]|real|real[23]|[A-Z]\w*)\s+)"
                                       R"((\w+)\s*\([^(){};]*\)\s*\{)");
    const std::map<std::string, int> inShared = countNames(shared, definition), uses = countUses(shaders + shared),
                                     usesInSources = countUses(sources);
    Names found;
    for (const auto& [name, count] : countNames(shaders + shared, definition)) {
        const bool isCalledByCpp = inShared.contains(name) && usesInSources.contains(name);
        if (name != "main" && uses.at(name) <= count && !isCalledByCpp) found.insert(name);
    }
    return found;
}

TEST(Shaders, haveNoFunctionWithoutACall) {
    std::vector<Line> shaders, shared;
    for (const Line& line : linesBelow(kProject, "shaders"))
        if (!line.file.starts_with("shaders/functions/")) // their height() is called where they are compiled into
            (line.file.starts_with("shaders/shared/") ? shared : shaders).push_back(line);
    ASSERT_GT(shaders.size(), 1500u);
    ASSERT_GT(shared.size(), 300u);
    for (const std::string& name :
         functionsWithoutCall(codeOf(shaders), codeOf(shared), codeOf(linesBelow(kProject, "src"))))
        ADD_FAILURE() << name << "() is defined in shaders and called nowhere";
}

/// Names and numbers of `RELIEF_CONSTANT uint kId... = 3u;`.
std::map<std::string, int> constantIds(const std::vector<Line>& lines) {
    static const std::regex constant(R"(RELIEF_CONSTANT\s+uint\s+(kId\w+)\s*=\s*(\d+)u?\s*;)");
    std::map<std::string, int> ids;
    for (const Line& line : lines)
        if (std::smatch found; std::regex_search(line.text, found, constant)) ids[found[1]] = std::stoi(found[2]);
    return ids;
}

/// One line for each constant whose id is a number or a name that `ids` does not have.
std::vector<std::string> unnamedConstants(const std::vector<Line>& shaders, const std::map<std::string, int>& ids) {
    static const std::regex constant(R"(constant_id\s*=\s*(\w+))");
    std::vector<std::string> found;
    for (const Line& line : shaders)
        if (std::smatch match; std::regex_search(line.text, match, constant) && !ids.contains(match[1]))
            found.push_back(fmt::format("{}:{}: constant_id = {} is no name of shaders/shared/constants.h", line.file,
                                        line.number, match[1].str()));
    return found;
}

TEST(Shaders, nameTheirSpecializationConstants) {
    if (!fs::exists(kProject / "shaders/shared/constants.h")) GTEST_SKIP() << "there is no shaders/shared/constants.h";
    const std::map<std::string, int> ids = constantIds(linesOf(kProject, "shaders/shared/constants.h"));
    EXPECT_GE(ids.size(), 10u);
    std::map<int, std::string> names;
    for (const auto& [name, id] : ids) {
        const auto [other, isNew] = names.emplace(id, name);
        EXPECT_TRUE(isNew) << name << " and " << other->second << " are both " << id;
    }
    for (const std::string& line : unnamedConstants(linesBelow(kProject, "shaders"), ids)) ADD_FAILURE() << line;
}

// --- the reader itself --------------------------------------------------------------------------------------------

TEST(Shaders, withoutACallAreFound) {
    const std::string shaders = "#define RELIEF_POINT viaMacro\n"
                                "float used(vec2 x) { return x.x; }\n"
                                "vec3 viaMacro(uint i) { return vec3(i); }\n"
                                "Leaf dead(uint face,\n          vec2 uv) {\n    return leaf(face, used(uv));\n}\n"
                                "void main() { float y = used(vec2(0)); }\n";
    const std::string shared = "real3 shared(real h) { return h; }\n";
    EXPECT_EQ(functionsWithoutCall(shaders, shared, "x = shared(1), y = dead(2);"), Names{"dead"});
    EXPECT_EQ(functionsWithoutCall(shaders, shared, ""), (Names{"dead", "shared"}));
}

TEST(Shaders, constantsWithoutANameAreFound) {
    const std::map<std::string, int> ids = constantIds({{"constants.h", 1, "RELIEF_CONSTANT uint kIdHasMips = 8u;"}});
    EXPECT_EQ(ids, (std::map<std::string, int>{{"kIdHasMips", 8}}));
    EXPECT_TRUE(unnamedConstants({{"a.glsl", 3, "layout(constant_id = kIdHasMips) const bool kHasMips = false;"}}, ids)
                    .empty());
    EXPECT_EQ(unnamedConstants({{"a.glsl", 3, "layout(constant_id = 8) const bool kHasMips = false;"}}, ids).size(),
              1u);
    EXPECT_EQ(unnamedConstants({{"a.glsl", 3, "layout(constant_id = kIdOther) const bool k = false;"}}, ids).size(),
              1u);
}

} // namespace
} // namespace relief::test
