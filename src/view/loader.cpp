#include "view/loader.h"

#include <chrono>

namespace relief {

void Loader::ask(const Look& look) {
    if (isBusy())
        next_ = look;
    else
        start(look);
}

Loader::~Loader() {
    isEnding_ = true;
    if (isBusy()) running_.wait();
}

void Loader::start(const Look& look) {
    running_ = std::async(std::launch::async, [this, look, device = device_, shown = shown_] {
        Prepared prepared = prepareScene(desc_, look);
        rehearse(desc_, device, shown, prepared, isEnding_);
        return prepared;
    });
}

std::optional<Loader::Result> Loader::take() {
    if (!isBusy() || running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return {};
    Result result;
    try {
        result.prepared = running_.get();
    } catch (const Error& error) {
        result.error = error.what();
    }
    if (next_) start(*std::exchange(next_, std::nullopt));
    return result;
}

FileWatch::Stamp FileWatch::stampOf(const std::string& path) {
    std::error_code error;
    const auto time = std::filesystem::last_write_time(path, error);
    if (error) return {};
    const auto size = std::filesystem::file_size(path, error);
    if (error) return {};
    return std::pair(time, size);
}

void FileWatch::watch(const std::vector<std::string>& paths) {
    files_.clear();
    for (const std::string& path : paths)
        if (!path.empty()) files_.emplace_back(path, stampOf(path));
}

bool FileWatch::hasChanged() {
    bool hasChanged = false;
    for (auto& [path, stamp] : files_) {
        const Stamp now = stampOf(path);
        // A file that is gone is being written, or comes back.
        if (now && now != stamp) hasChanged = true, stamp = now;
    }
    return hasChanged;
}

} // namespace relief
