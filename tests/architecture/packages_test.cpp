// .packages is the one list of what relief needs: it must cover all that CMake looks for, and hold nothing else.
#include <gtest/gtest.h>

#include "architecture/includes.h"

namespace relief::test {
namespace {

/// What CMake looks for, by the words it looks with, and the Debian package that brings it.
const std::map<std::string, std::string> kPackageOf = {
    {"OpenSubdivFar", "libosd-dev"},
    {"ImageIO", "libopenimageio-dev"},
    {"ZLIB", "zlib1g-dev"},
    {"Vulkan", "libvulkan-dev"},
    {"fmt", "libfmt-dev"},
    {"CLI11", "libcli11-dev"},
    {"nlohmann_json", "nlohmann-json3-dev"},
    {"tinyobjloader", "libtinyobjloader-dev"},
    {"Threads", "build-essential"},
    {"OpenMP", "build-essential"},
    {"embree", "libembree-dev"},
    {"draco", "libdraco-dev"},
    {"meshoptimizer", "libmeshoptimizer-dev"},
    {"Eigen3", "libeigen3-dev"},
    {"GTest", "libgtest-dev"},
    {"glslangValidator", "glslang-tools"},
    {"glslang", "glslang-dev"},
    {"glfw3", "libglfw3-dev"},
    {"X11", "libglfw3-dev"}, // through libgl-dev, which it depends on
    {"imgui.h", "libimgui-dev"},
    {"imgui", "libimgui-dev"},
    {"stb", "libimgui-dev"},        // through libstb-dev, which it depends on
    {"spirv-opt", "glslang-tools"}, // through spirv-tools, which it depends on
    {"SPIRV-Tools", "glslang-tools"},
    {"SPIRV-Tools-opt", "glslang-tools"},
    {"glm/glm.hpp", "libglm-dev"},
    {"tiny_gltf.h", "libtinygltf-dev"},
    {"OpenImageIO/imageio.h", "libopenimageio-dev"},
    {"OpenImageIO", "libopenimageio-dev"},
    {"OpenImageIO_Util", "libopenimageio-dev"},
    {"ImathVec.h", "libopenimageio-dev"}, // through libilmbase-dev, which it depends on
    {"Imath", "libopenimageio-dev"},
    {"opensubdiv/far/patchTable.h", "libosd-dev"},
    {"osdCPU", "libosd-dev"},
    {"osdGPU", "libosd-dev"},
    {"vk_swiftshader_icd.json", "chromium-common"},
};

/// What no find_... names: tools, and what is loaded when relief runs.
const Names kOthers = {
    "cmake", "ninja-build", "mesa-vulkan-drivers", "vulkan-validationlayers", "ffmpeg", "fonts-dejavu-core",
    "xvfb",  "xauth"};

Names packages() {
    Names names;
    for (const Line& line : linesOf(kProject, ".packages"))
        if (!line.text.starts_with('#')) names.merge(wordsOf(line.text));
    return names;
}

/// `file:line` of everything that CMake's files look for, by its name.
std::map<std::string, std::string> soughtNames() {
    static const std::regex call(
        R"(^\s*(?:need|find_package|find_program|find_path|find_library)\(\s*(?:\w+_\w+ |GLSLANG )?([\w./-]+))");
    std::vector<Line> lines = linesOf(kProject, "CMakeLists.txt");
    for (const Line& line : linesBelow(kProject, "src"))
        if (line.file.ends_with(".cmake")) lines.push_back(line);
    std::map<std::string, std::string> sought;
    for (const Line& line : lines)
        if (std::smatch found; std::regex_search(line.text, found, call))
            sought[found[1]] = fmt::format("{}:{}", line.file, line.number);
    return sought;
}

TEST(Packages, coverWhatCMakeLooksFor) {
    const Names listed = packages();
    const std::map<std::string, std::string> sought = soughtNames();
    ASSERT_GE(sought.size(), 15u);
    for (const auto& [name, place] : sought) {
        const auto found = kPackageOf.find(name);
        ASSERT_NE(found, kPackageOf.end())
            << place << " looks for " << name << "; add its package to this test's table";
        EXPECT_TRUE(listed.contains(found->second)) << place << " looks for " << name << " of " << found->second;
    }
}

TEST(Packages, holdNothingThatIsNotNeeded) {
    Names needed = kOthers;
    for (const auto& [name, place] : soughtNames())
        if (const auto found = kPackageOf.find(name); found != kPackageOf.end()) needed.insert(found->second);
    for (const std::string& package : packages()) EXPECT_TRUE(needed.contains(package)) << package;
    for (const std::string& other : kOthers) EXPECT_TRUE(packages().contains(other)) << other;
}

} // namespace
} // namespace relief::test
