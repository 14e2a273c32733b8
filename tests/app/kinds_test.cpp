// Inputs that are no files: nothing waits for them, whoever reads.
#include <sys/stat.h>

#include "program.h"

namespace relief::test {
namespace {

/// Each of the program's readers, given that path.
std::vector<Words> readersOf(const std::string& path, const TemporaryFolder& folder) {
    const std::string cube = cagePath("cube"), picture = folder / "a.png", table = folder / "a.csv";
    return {{"info", path},
            {"render", cube, "-o", picture, "--height", path},
            {"render", cube, "-o", picture, "--albedo", path},
            {"render", cube, "-o", picture, "--environment", path},
            {"check", cube, "--height", path},
            {"export", cube, "-o", folder / "a.ply", "--height", path},
            {"sample", cube, "-o", table, "--at", path},
            {"bench", "--from", path},
            {"bench", "--compare", path, path}};
}

/// Each reader of files that are recognised by their extension; `named` adds that to the path.
std::vector<Words> readersByExtension(const std::function<std::string(const std::string&)>& named,
                                      const TemporaryFolder& folder) {
    const std::string cube = cagePath("cube"), picture = folder / "f.{frame}.png";
    std::vector<Words> readers;
    for (const char* extension : {".obj", ".gltf", ".glb", ".png", ".exr", ".tif", ".hdr"})
        readers.push_back({"info", named(extension)});
    for (const char* extension : {".pc2", ".mdd"})
        readers.push_back({"animate", cube, "-o", picture, "--cache", named(extension)});
    for (const char* extension : {".gltf", ".glb"})
        readers.push_back({"animate", cube, "-o", picture, "--skin", named(extension)});
    return readers;
}

TEST(InputKinds, pipesAreRefusedByEveryReader) {
    const TemporaryFolder folder;
    const auto makePipe = [&](const std::string& extension) {
        std::string path = folder / ("pipe" + extension);
        mkfifo(path.c_str(), 0600);
        return path;
    };
    std::vector<Words> readers = readersOf(makePipe(""), folder);
    for (const Words& reader : readersByExtension(makePipe, folder)) readers.push_back(reader);
    const std::size_t pipeCount = folder.fileCount();
    for (const Words& reader : readers) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(reader, " ")));
        expectRefused(relief(reader), Failure::file, {"pipe", "regular files"});
    }
    EXPECT_EQ(folder.fileCount(), pipeCount);
}

TEST(InputKinds, endlessDevicesAreRefusedBehindLinks) {
    const TemporaryFolder folder;
    const auto makeLink = [&](const std::string& extension) {
        std::string path = folder / ("zero" + extension);
        if (!std::filesystem::is_symlink(path)) std::filesystem::create_symlink("/dev/zero", path);
        return path;
    };
    for (const Words& reader : readersByExtension(makeLink, folder)) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(reader, " ")));
        expectRefused(relief(reader), Failure::file, {"device", "regular files"});
    }
}

TEST(InputKinds, bufferOfASceneMustBeAFile) {
    const TemporaryFolder folder;
    putFile(folder / "a.gltf",
            R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "buffers": [{"byteLength": 36, "uri": "a.bin"}],
                "bufferViews": [{"buffer": 0, "byteLength": 36}],
                "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                               "min": [0, 0, 0], "max": [1, 1, 0]}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})");
    mkfifo((folder / "a.bin").c_str(), 0600);
    expectRefused(relief({"info", folder / "a.gltf"}), Failure::file, {"a.bin", "it is a pipe"});
}

TEST(InputKinds, keysOfASequenceMustBeFiles) {
    const TemporaryFolder folder;
    mkfifo((folder / "a.1.obj").c_str(), 0600);
    expectRefused(
        relief({"animate", cagePath("cube"), "--cache", folder / "a.{frame}.obj", "-o", folder / "f.{frame}.png"}),
        Failure::file, {"a.{frame}.obj"});
}

TEST(InputKinds, stdinIsReadWhereItIsAFile) {
    const TemporaryFolder folder;
    putFile(folder / "points.csv", "0,0.5,0.5\n");
    const std::string words = "$RELIEF sample " + cagePath("cube") + " -q --at /dev/stdin -o $IN/a.csv";
    expectDone(shell(words + " <$IN/points.csv", folder));
    expectRefused(shell("cat $IN/points.csv | " + words, folder), Failure::file, {"/dev/stdin", "pipe"});
}

} // namespace
} // namespace relief::test
