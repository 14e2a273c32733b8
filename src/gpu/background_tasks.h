// Internal: threads that work for a device while its caller goes on.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace relief {

/// Up to four threads; each of the first tasks starts one. add() and settle() are called by one thread alone.
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

    /// Drops tasks that have not begun, and waits for those that have.
    void settle();

private:
    void startThread();
    void work();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_; ///< that have not begun
    std::vector<std::thread> threads_;
    std::size_t runningCount_ = 0;
    bool isEnding_ = false;
};

} // namespace relief
