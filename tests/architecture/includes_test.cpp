// The drawing of modules cannot rot: CMakeLists.txt states who uses whom, and the sources are held to it.
#include <algorithm>

#include <gtest/gtest.h>

#include "architecture/includes.h"

namespace relief::test {
namespace {

Modules projectModules() { return modulesOf(linesOf(kProject, "CMakeLists.txt")); }

TEST(Architecture, everyIncludeIsInTheTable) {
    std::vector<Line> sources = linesBelow(kProject, "src");
    for (const Line& line : linesBelow(kProject, "shaders/shared")) sources.push_back(line);
    ASSERT_GT(sources.size(), 5000u);
    for (const std::string& forbidden : forbiddenIncludes(sources, projectModules())) ADD_FAILURE() << forbidden;
}

TEST(Architecture, everyFolderOfSourcesIsAModule) {
    Names known{"app"};
    for (const auto& [name, module] : projectModules()) known.insert(name);
    ASSERT_GE(known.size(), 7u);
    for (const auto& entry : fs::directory_iterator(kProject / "src"))
        EXPECT_TRUE(entry.is_regular_file() || known.contains(entry.path().filename())) << entry.path();
    for (const std::string& name : known) EXPECT_TRUE(fs::is_directory(kProject / "src" / name)) << name;
}

TEST(Architecture, modulesUseOnlyThoseAboveThem) {
    Modules modules;
    Names above;
    for (const Line& line : linesOf(kProject, "CMakeLists.txt"))
        for (const auto& [name, module] : modulesOf({line})) {
            for (const std::string& used : module.uses)
                EXPECT_TRUE(above.contains(used))
                    << fmt::format("CMakeLists.txt:{}: {} uses {}", line.number, name, used);
            above.insert(name);
        }
    EXPECT_GE(above.size(), 6u);
}

TEST(Architecture, everyModuleHasOneHeaderOfItsNameAndReliefHasThemAll) {
    Names included;
    for (const Line& line : linesOf(kProject, "src/relief.h")) included.insert(line.text);
    for (const auto& [name, module] : projectModules()) {
        const std::string header = name + "/" + name + ".h";
        EXPECT_TRUE(fs::exists(kProject / "src" / header)) << header;
        EXPECT_TRUE(included.contains("#include \"" + header + "\"")) << header << " in src/relief.h";
    }
}

TEST(Architecture, internalHeadersStayInTheirModule) {
    std::vector<Line> sources = linesBelow(kProject, "src");
    for (const Line& line : linesBelow(kProject, "tests")) sources.push_back(line);
    for (const std::string& line : internalIncludes(kProject, sources, projectModules())) ADD_FAILURE() << line;
    for (const auto& [name, module] : projectModules())
        for (const std::string& header : module.offers)
            EXPECT_TRUE(fs::exists(kProject / "src" / name / header)) << name << " OFFERS " << header;
}

TEST(Architecture, everyModuleHasTests) {
    Names registered;
    static const std::regex call(R"(^\s*add_module_test\((\w+))");
    for (const Line& line : linesOf(kProject, "CMakeLists.txt"))
        if (std::smatch found; std::regex_search(line.text, found, call)) registered.insert(found[1]);
    static const std::regex test(R"(^\s*(?:TEST|TEST_F|TEST_P|TYPED_TEST)\()");
    const auto hasTest = [](const Line& line) { return std::regex_search(line.text, test); };
    for (const auto& [name, module] : projectModules()) {
        EXPECT_TRUE(registered.contains(name)) << "CMakeLists.txt has no add_module_test(" << name << ")";
        if (!fs::is_directory(kProject / "tests" / name)) {
            ADD_FAILURE() << "tests/" << name << " is missing";
            continue;
        }
        const std::vector<Line> lines = linesBelow(kProject, "tests/" + name);
        EXPECT_TRUE(std::ranges::any_of(lines, hasTest)) << "tests/" << name << " has no test";
    }
}

/// The first column of the table below the line `## Modules` of src/README.md.
Names drawnModules() {
    static const std::regex row(R"(^\|\s*`?(\w+)`?\s*\|)");
    Names names;
    bool isInSection = false;
    for (const Line& line : linesOf(kProject, "src/README.md")) {
        if (line.text.starts_with("## ")) isInSection = line.text == "## Modules";
        std::smatch found;
        if (isInSection && std::regex_search(line.text, found, row) && found[1] != "module") names.insert(found[1]);
    }
    return names;
}

TEST(Architecture, theTableOfModulesInTheReadmeIsThatOfCMake) {
    Names modules{"app"};
    for (const auto& [name, module] : projectModules()) modules.insert(name);
    const Names drawn = drawnModules();
    EXPECT_FALSE(drawn.empty()) << "src/README.md has no table below a line `## Modules`";
    for (const std::string& name : modules) EXPECT_TRUE(drawn.contains(name)) << name << " is not in src/README.md";
    for (const std::string& name : drawn) EXPECT_TRUE(modules.contains(name)) << name << " is no module";
}

// --- sizes --------------------------------------------------------------------------------------------------------

// A header that is longer is two topics, and so is a source. The design document has many.
TEST(Architecture, filesAreShort) {
    std::map<std::string, int> counts;
    for (const char* folder : {"src", "shaders"})
        for (const Line& line : linesBelow(kProject, folder)) counts[line.file] = line.number;
    ASSERT_GT(counts.size(), 150u);
    std::erase_if(counts, [](const auto& entry) { return entry.first.ends_with(".md"); });
    for (const auto& [file, count] : counts)
        EXPECT_LE(count, file.ends_with(".h") ? 250 : 400) << file << " has " << count << " lines";
}

// --- the reader itself --------------------------------------------------------------------------------------------

const std::vector<Line> kTable = {{"CMakeLists.txt", 1, "function(add_module name)"},
                                  {"CMakeLists.txt", 2, "add_module(base OFFERS tree.h LINKS Some::Library)"},
                                  {"CMakeLists.txt", 3, "add_module(cage USES base LINKS Other::Library)"},
                                  {"CMakeLists.txt", 4, "add_module(surface USES base cage)"}};

TEST(Includes, readTheTable) {
    EXPECT_EQ(modulesOf(kTable),
              (Modules{{"base", {{}, {"tree.h"}}}, {"cage", {{"base"}, {}}}, {"surface", {{"base", "cage"}, {}}}}));
}

TEST(Includes, thatAreForbiddenAreFoundWithTheirLine) {
    const Modules modules = modulesOf(kTable);
    const auto forbidden = [&](const std::string& file, const std::string& text) {
        return forbiddenIncludes({{file, 7, text}}, modules);
    };
    EXPECT_TRUE(forbidden("src/cage/obj.cpp", "#include \"base/base.h\"").empty());
    EXPECT_TRUE(forbidden("src/cage/obj.cpp", "#include \"cage/cage.h\"").empty());
    EXPECT_TRUE(forbidden("src/surface/tools/a.cpp", "#include \"shared/surface.h\"").empty());
    EXPECT_TRUE(forbidden("src/surface/a.cpp", "#include <opensubdiv/far/patchTable.h>").empty());
    EXPECT_TRUE(forbidden("src/app/main.cpp", "#include \"surface/surface.h\"").empty());
    EXPECT_TRUE(forbidden("src/relief.h", "#include \"surface/surface.h\"").empty());
    const std::vector<std::string> found = forbidden("src/cage/obj.cpp", "  # include \"surface/surface.h\"");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].find("src/cage/obj.cpp:7: cage may not include \"surface/surface.h\""), 0u) << found[0];
    EXPECT_EQ(forbidden("src/base/a.cpp", "#include \"cage/cage.h\"").size(), 1u);
    EXPECT_EQ(forbidden("src/cage/a.cpp", "#include \"obj.h\"").size(), 1u);
    EXPECT_EQ(forbidden("src/cage/a.cpp", "#include \"app/options.h\"").size(), 1u);
    EXPECT_EQ(forbidden("shaders/shared/a.h", "#include \"surface/surface.h\"").size(), 1u);
}

TEST(Includes, ofInternalHeadersAreFoundWithTheirLine) {
    const Modules modules = projectModules();
    const auto internal = [&](const std::string& file, const std::string& text) {
        return internalIncludes(kProject, {{file, 7, text}}, modules);
    };
    EXPECT_TRUE(internal("src/cage/a.cpp", "#include \"base/files.h\"").empty()) << "base.h includes it";
    EXPECT_TRUE(internal("src/cage/a.cpp", "#include \"base/point_tree.h\"").empty()) << "it is offered";
    EXPECT_TRUE(internal("tests/surface/a.cpp", "#include \"surface/gregory.h\"").empty())
        << "of the module's own test";
    EXPECT_TRUE(internal("tests/check/a.cpp", "#include \"surface/families.h\"").empty()) << "a helper of tests";
    const std::vector<std::string> found = internal("src/check/a.cpp", "#include \"surface/gregory.h\"");
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0], "src/check/a.cpp:7: surface/gregory.h is internal to surface");
    EXPECT_EQ(internal("tests/check/a.cpp", "#include \"surface/gregory.h\"").size(), 1u);
}

} // namespace
} // namespace relief::test
