// Internal: threads that work for a device while its caller goes on.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace relief {

/// A few threads, started with the first task.
class BackgroundTasks {
public:
    BackgroundTasks() = default;
    /// Waits for tasks that have begun. Those that have not are dropped.
    ~BackgroundTasks();
    BackgroundTasks(const BackgroundTasks&) = delete;
    BackgroundTasks& operator=(const BackgroundTasks&) = delete;

    /// Runs a task, which must not throw, after those before it have begun. Nothing promises that it is run at all:
    /// with one core, or where no thread can be started, it is not.
    void add(std::function<void()> task);

private:
    void startThread();
    void work();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_; ///< that have not begun
    std::vector<std::thread> threads_;
    bool isEnding_ = false;
};

} // namespace relief
