// What tests of files and errors share.
#pragma once

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/resource.h>

#include <gtest/gtest.h>

#include "base/base.h"

namespace relief::test {

/// A fresh folder, gone with its content at the end of the scope.
struct TemporaryFolder {
    std::filesystem::path path;

    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "relief-test-XXXXXX").string();
        path = mkdtemp(name.data());
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }

    [[nodiscard]] std::string operator/(const std::string& name) const { return (path / name).string(); }

    [[nodiscard]] std::size_t fileCount() const {
        std::size_t count = 0;
        for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path)) ++count;
        return count;
    }
};

/// Puts the bytes there without the code under test.
inline void putFile(const std::string& path, std::string_view bytes) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    ASSERT_NE(file, nullptr) << path;
    ASSERT_EQ(std::fwrite(bytes.data(), 1, bytes.size(), file), bytes.size());
    ASSERT_EQ(std::fclose(file), 0);
}

/// Until the end of the scope no file can grow past so many bytes, as on a full disk.
struct FullDisk {
    rlimit before{};

    explicit FullDisk(rlim_t bytes) {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before);
        const rlimit limit{bytes, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;
    ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before); }
};

/// Expects `action` to throw an Error of this kind on one line that holds each of the words.
template <typename Action>
void expectFailure(Failure failure, const std::vector<std::string>& words, const Action& action) {
    try {
        action();
    } catch (const Error& error) {
        const std::string line = error.what();
        EXPECT_EQ(int(error.failure), int(failure)) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        for (const std::string& word : words)
            EXPECT_NE(line.find(word), std::string::npos) << "'" << word << "' in " << line;
        return;
    } catch (const std::exception& other) {
        FAIL() << "another exception: " << other.what();
    }
    FAIL() << "no exception";
}

/// Collects warnings.
struct Warnings {
    std::vector<std::string> lines;

    [[nodiscard]] Warn warn() {
        return [this](const std::string& line) { lines.push_back(line); };
    }
    [[nodiscard]] bool has(const std::string& word) const {
        for (const std::string& line : lines)
            if (line.find(word) != std::string::npos) return true;
        return false;
    }
};

/// The folder of production meshes, or empty when it is not there.
inline std::string productionFolder() {
    const char* given = std::getenv("RELIEF_DATA");
    const char* source = std::getenv("RELIEF_SOURCE");
    const std::string folder = given ? given : source ? std::string(source) + "/../shared/data" : "../shared/data";
    return std::filesystem::is_directory(folder) ? folder : "";
}

} // namespace relief::test
