// Internal: files that are read while the window goes on, and whether they have changed since.
#pragma once

#include <filesystem>
#include <future>

#include "view/rehearsal.h"

namespace relief {

/// Reads scenes on another thread, one at a time; of those that are asked for meanwhile the latest follows.
class Loader {
public:
    explicit Loader(const ViewDesc& desc) : desc_(desc) {}
    ~Loader(); ///< waits for the step that it is at
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;

    /// The name of the window's device: height functions are rehearsed on another one of that name.
    void useDevice(const std::string& name) { device_ = name; }
    /// What the window shows needs no rehearsal.
    void setShown(const PipelineKey& key) { shown_ = key; }

    void ask(const Look& look);
    [[nodiscard]] bool isBusy() const { return running_.valid(); }
    /// What was read, once it is; or why it could not be.
    struct Result {
        std::optional<Prepared> prepared;
        std::string error;
    };
    std::optional<Result> take();

private:
    void start(const Look& look);
    const ViewDesc& desc_;
    std::string device_;
    PipelineKey shown_;
    std::atomic<bool> isEnding_ = false;
    std::future<Prepared> running_;
    std::optional<Look> next_;
};

/// Sees when files are written anew.
class FileWatch {
public:
    /// From now on these files; empty names are none.
    void watch(const std::vector<std::string>& paths);
    /// Whether one of them is another one than at the last call.
    bool hasChanged();

private:
    /// Time and size, or nothing where there is no such file.
    using Stamp = std::optional<std::pair<std::filesystem::file_time_type, std::uintmax_t>>;
    static Stamp stampOf(const std::string& path);
    std::vector<std::pair<std::string, Stamp>> files_;
};

} // namespace relief
