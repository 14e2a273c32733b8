#include <fstream>

#include <unistd.h>

#include "support.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

TEST(WriteWhole, replacesTheFile) {
    const TemporaryFolder folder;
    putFile(folder / "a.txt", "old");
    writeFile(folder / "a.txt", "new");
    EXPECT_EQ(readFile(folder / "a.txt"), "new");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WriteWhole, givesATemporaryNameBesideTheTargetWithItsExtension) {
    const TemporaryFolder folder;
    fs::path temporary;
    writeWhole(folder / "a.exr", [&](const std::string& name) {
        temporary = name;
        EXPECT_FALSE(fs::exists(folder / "a.exr"));
    });
    EXPECT_EQ(temporary.parent_path(), folder.path);
    EXPECT_EQ(temporary.extension(), ".exr");
    EXPECT_FALSE(fs::exists(temporary));
}

TEST(WriteWhole, leavesEverythingAsItWasWhenTheCallThrows) {
    const TemporaryFolder folder;
    putFile(folder / "a.txt", "old");
    const auto write = [&] {
        writeWhole(folder / "a.txt", [](const std::string& temporary) {
            putFile(temporary, "half of the n");
            fail(Failure::device, "device lost");
        });
    };
    expectFailure(Failure::device, {"device lost"}, write);
    EXPECT_EQ(readFile(folder / "a.txt"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WriteWhole, refusesFoldersThatCannotBeWritten) {
    const TemporaryFolder folder;
    putFile(folder / "file", "");
    for (const std::string& path : {folder / "none/a.txt", folder / "file/a.txt", std::string("/proc/a.txt")})
        expectFailure(Failure::file, {path}, [&] { writeFile(path, "x"); });
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(WriteWhole, refusesToReplaceDevicesAndFolders) {
    const TemporaryFolder folder;
    expectFailure(Failure::file, {"/dev/full"}, [] { writeFile("/dev/full", "x"); });
    expectFailure(Failure::file, {"ordinary file"}, [&] { writeFile(folder.path.string(), "x"); });
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST(WriteWhole, passesOverTemporaryNamesThatAreTaken) {
    const TemporaryFolder folder;
    for (int i = 0; i < 300; ++i) putFile(folder / fmt::format(".relief-{}-{}.txt", getpid(), i), "other");
    writeFile(folder / "a.txt", "new");
    EXPECT_EQ(readFile(folder / "a.txt"), "new");
    EXPECT_EQ(folder.fileCount(), 301u);
}

TEST(WriteWhole, refusesAnEmptyName) {
    expectFailure(Failure::usage, {"no name"}, [] { writeFile("", "x"); });
}

TEST(WriteWhole, writesThroughLinks) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "real");
    putFile(folder / "real/a.txt", "old");
    fs::create_symlink(folder / "real/a.txt", folder / "link.txt");
    writeFile(folder / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(readFile(folder / "real/a.txt"), "new");
}

TEST(WriteWhole, bearsTheLongestNames) {
    const TemporaryFolder folder;
    const std::string path = folder / (std::string(251, 'n') + ".png");
    writeFile(path, "x");
    EXPECT_EQ(readFile(path), "x");
}

TEST(CheckWritable, saysWhatWritingWouldSayAndLeavesNothing) {
    const TemporaryFolder folder;
    putFile(folder / "file", "old");
    for (const std::string& path : {folder / "none/a.txt", folder / "file/a.txt", std::string("/proc/a.txt")})
        expectFailure(Failure::file, {path}, [&] { checkWritable(path); });
    expectFailure(Failure::file, {"ordinary file"}, [&] { checkWritable(folder.path.string()); });
    expectFailure(Failure::usage, {"no name"}, [] { checkWritable(""); });
    EXPECT_NO_THROW(checkWritable(folder / "new"));
    EXPECT_NO_THROW(checkWritable(folder / "file"));
    EXPECT_EQ(readFile(folder / "file"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(ReadFile, givesAllBytes) {
    const TemporaryFolder folder;
    const std::string bytes("a\0b\r\n\xff", 6);
    putFile(folder / "a", bytes);
    EXPECT_EQ(readFile(folder / "a"), bytes);
    putFile(folder / "empty", "");
    EXPECT_EQ(readFile(folder / "empty"), "");
}

TEST(ReadFile, namesAMissingFile) {
    expectFailure(Failure::file, {"/nowhere/cage.obj", "No such file"}, [] { readFile("/nowhere/cage.obj"); });
}

TEST(ReadFile, refusesAFolder) {
    const TemporaryFolder folder;
    expectFailure(Failure::file, {folder.path.string(), "directory"}, [&] { readFile(folder.path.string()); });
}

TEST(ReadFile, refusesMoreThanTheLimit) {
    const TemporaryFolder folder;
    putFile(folder / "a", std::string(100, 'x'));
    EXPECT_EQ(readFile(folder / "a", 100).size(), 100u);
    expectFailure(Failure::input, {folder / "a", "99 B"}, [&] { readFile(folder / "a", 99); });
}

TEST(ReadFile, refusesEndlessDevices) {
    expectFailure(Failure::input, {"/dev/zero"}, [] { readFile("/dev/zero", 1 << 20); });
}

} // namespace
} // namespace relief::test
