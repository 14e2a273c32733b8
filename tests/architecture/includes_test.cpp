// The drawing of modules cannot rot: CMakeLists.txt states who uses whom, and the sources are held to it.
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
    for (const auto& [name, uses] : projectModules()) known.insert(name);
    ASSERT_GE(known.size(), 7u);
    for (const auto& entry : fs::directory_iterator(kProject / "src"))
        EXPECT_TRUE(entry.is_regular_file() || known.contains(entry.path().filename())) << entry.path();
    for (const std::string& name : known) EXPECT_TRUE(fs::is_directory(kProject / "src" / name)) << name;
}

TEST(Architecture, modulesUseOnlyThoseAboveThem) {
    Modules modules;
    Names above;
    for (const Line& line : linesOf(kProject, "CMakeLists.txt"))
        for (const auto& [name, uses] : modulesOf({line})) {
            for (const std::string& used : uses)
                EXPECT_TRUE(above.contains(used))
                    << fmt::format("CMakeLists.txt:{}: {} uses {}", line.number, name, used);
            above.insert(name);
        }
    EXPECT_GE(above.size(), 6u);
}

TEST(Architecture, everyModuleHasOneHeaderOfItsNameAndReliefHasThemAll) {
    Names included;
    for (const Line& line : linesOf(kProject, "src/relief.h")) included.insert(line.text);
    for (const auto& [name, uses] : projectModules()) {
        const std::string header = name + "/" + name + ".h";
        EXPECT_TRUE(fs::exists(kProject / "src" / header)) << header;
        EXPECT_TRUE(included.contains("#include \"" + header + "\"")) << header << " in src/relief.h";
    }
}

// --- the reader itself --------------------------------------------------------------------------------------------

const std::vector<Line> kTable = {{"CMakeLists.txt", 1, "function(add_module name)"},
                                  {"CMakeLists.txt", 2, "add_module(base LINKS Some::Library)"},
                                  {"CMakeLists.txt", 3, "add_module(cage USES base LINKS Other::Library)"},
                                  {"CMakeLists.txt", 4, "add_module(surface USES base cage)"}};

TEST(Includes, readTheTable) {
    EXPECT_EQ(modulesOf(kTable), (Modules{{"base", {}}, {"cage", {"base"}}, {"surface", {"base", "cage"}}}));
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

} // namespace
} // namespace relief::test
