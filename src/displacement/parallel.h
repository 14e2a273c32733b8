// For other modules: work on many tiles at once.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace relief {

/// Calls `work(i)` for all i below `count`, on all cores. The exception of the lowest i that threw is thrown again.
template <typename Work>
void forEachAtOnce(std::size_t count, const Work& work) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr thrown;
    std::size_t thrownBy = count;
    const auto run = [&] {
        for (std::size_t i = next++; i < count; i = next++) {
            try {
                work(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (i < thrownBy) thrown = std::current_exception(), thrownBy = i;
            }
        }
    };
    {
        std::vector<std::jthread> threads;
        const std::size_t most = std::min<std::size_t>(count, std::max(1u, std::thread::hardware_concurrency()));
        for (std::size_t k = 1; k < most; ++k) threads.emplace_back(run);
        run();
    }
    if (thrown) std::rethrow_exception(thrown);
}

} // namespace relief
