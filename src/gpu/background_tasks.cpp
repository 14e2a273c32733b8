#include "gpu/background_tasks.h"

#include <algorithm>
#include <system_error>
#include <utility>

namespace relief {
namespace {

/// The caller has a core of its own. More threads than this would find little to do.
std::size_t mostThreads() {
    const std::size_t cores = std::thread::hardware_concurrency();
    return cores > 1 ? std::min<std::size_t>(cores - 1, 4) : 0;
}

} // namespace

BackgroundTasks::~BackgroundTasks() {
    {
        const std::lock_guard lock(mutex_);
        isEnding_ = true;
        tasks_.clear();
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void BackgroundTasks::add(std::function<void()> task) {
    if (threads_.size() < mostThreads()) startThread();
    if (threads_.empty()) return;
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    changed_.notify_one();
}

void BackgroundTasks::settle() {
    std::unique_lock lock(mutex_);
    tasks_.clear();
    changed_.wait(lock, [this] { return runningCount_ == 0; });
}

void BackgroundTasks::startThread() {
    try {
        threads_.emplace_back([this] { work(); });
    } catch (const std::system_error&) { // no more threads, or no memory for one: those that there are do the work
    }
}

void BackgroundTasks::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return isEnding_ || !tasks_.empty(); });
        if (isEnding_) return;
        const std::function<void()> task = std::move(tasks_.front());
        tasks_.pop_front();
        ++runningCount_;
        lock.unlock();
        task();
        lock.lock();
        if (--runningCount_ == 0) changed_.notify_all();
    }
}

} // namespace relief
