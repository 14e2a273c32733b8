#include "app/memory.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include "base/base.h"

namespace relief::app {
namespace {

constexpr std::size_t kScarceBytes = 128 << 20;

/// Ends the program by async-signal-safe calls alone.
[[noreturn]] void endHere(std::string_view line) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line.data(), line.size());
    _exit(int(Failure::device));
}

bool isMemoryScarce() {
    void* more = mmap(nullptr, kScarceBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (more == MAP_FAILED) return true;
    munmap(more, kScarceBytes);
    return false;
}

void onCrash(int signal) {
    if (isMemoryScarce())
        endHere("relief: out of memory: a library crashed where 128 MB more cannot be allocated; raise the limit "
                "(ulimit -v)\n");
    raise(signal); // the handler is reset: this is the system's own way to end
}

constexpr int kSecondsBetweenLooks = 5;
constexpr long kIdleNanoseconds = 2'000'000; ///< of processor time between two looks

/// Called every few seconds. A library whose thread cannot be started may wait for it for ever (log4cplus does, while
/// it is loaded): nothing happens any more, and no memory is left.
void onLook(int) {
    static timespec before{};
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    const long used = (now.tv_sec - before.tv_sec) * 1'000'000'000 + (now.tv_nsec - before.tv_nsec);
    before = now;
    if (used < kIdleNanoseconds && isMemoryScarce())
        endHere("relief: out of memory: a library waits where 128 MB more cannot be allocated; raise the limit "
                "(ulimit -v)\n");
}

bool isLimited(int resource) {
    rlimit limit{};
    return getrlimit(__rlimit_resource_t(resource), &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

} // namespace

OutOfMemory::OutOfMemory(std::size_t bytes) noexcept {
    fmt::format_to_n(text_.data(), text_.size() - 1,
                     "out of memory: {} more cannot be allocated; try a lower --rate, --isolation or --size, or a "
                     "smaller input",
                     humanBytes(bytes));
}

void endWhereMemoryRunsOut() {
    if (!isLimited(RLIMIT_AS) && !isLimited(RLIMIT_DATA)) return;
    struct sigaction action {};
    action.sa_handler = onCrash;
    action.sa_flags = int(SA_RESETHAND);
    for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGABRT}) sigaction(signal, &action, nullptr);
    action.sa_handler = onLook;
    action.sa_flags = SA_RESTART;
    sigaction(SIGALRM, &action, nullptr);
    const itimerval looks = {.it_interval = {kSecondsBetweenLooks, 0}, .it_value = {kSecondsBetweenLooks, 0}};
    setitimer(ITIMER_REAL, &looks, nullptr);
}

} // namespace relief::app

#ifndef __SANITIZE_ADDRESS__ // which has its own of all of these, and starts threads before anything else

void* operator new(std::size_t bytes) {
    for (;;) {
        if (void* memory = std::malloc(bytes > 0 ? bytes : 1)) return memory;
        const std::new_handler handler = std::get_new_handler();
        if (handler == nullptr) throw relief::app::OutOfMemory(bytes);
        handler();
    }
}

void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace relief::app {
namespace {

// --- threads: some libraries start theirs before main and abort where they cannot, and a driver that cannot waits for
// ever. So as many threads as they may need are started, and ended, before any library is initialized.

constexpr int kOtherThreads = 8; ///< beside one per core: the libraries', and those of this program

void* waitForRelease(void* isHeld) {
    pthread_mutex_lock(static_cast<pthread_mutex_t*>(isHeld));
    pthread_mutex_unlock(static_cast<pthread_mutex_t*>(isHeld));
    return nullptr;
}

void tryThreads() {
    constexpr int kMost = 256;
    static pthread_t threads[kMost];
    pthread_mutex_t isHeld = PTHREAD_MUTEX_INITIALIZER;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, 1 << 16);
    const int wanted = std::min(int(sysconf(_SC_NPROCESSORS_ONLN)) + kOtherThreads, kMost);
    int count = 0;
    pthread_mutex_lock(&isHeld); // so that all of them are there at the same time
    while (count < wanted && pthread_create(&threads[count], &attributes, waitForRelease, &isHeld) == 0) ++count;
    pthread_mutex_unlock(&isHeld);
    for (int i = 0; i < count; ++i) pthread_join(threads[i], nullptr);
    pthread_attr_destroy(&attributes);
    if (count < wanted) endHere("relief: too few threads can be started; raise the limit of processes (ulimit -u)\n");
}

[[gnu::section(".preinit_array"), gnu::used]] void (*const kTryThreads)() = tryThreads;

} // namespace
} // namespace relief::app

#endif
