#include "app/memory.h"

#include <cstdlib>

#include "base/base.h"

namespace relief::app {

OutOfMemory::OutOfMemory(std::size_t bytes) noexcept {
    fmt::format_to_n(text_.data(), text_.size() - 1,
                     "out of memory: {} more are not to be had; try a lower --rate, --isolation or --size, or a "
                     "smaller input",
                     humanBytes(bytes));
}

} // namespace relief::app

#ifndef __SANITIZE_ADDRESS__ // which has its own of all of these

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

#endif
