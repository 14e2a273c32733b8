#include "app/library_pages.h"

#include <bit>
#include <span>

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

namespace relief::app {
namespace {

/// Whether the loader has written addresses into code and constants of a library: these are in no file.
bool hasRelocatedText(const dl_phdr_info& library) {
    for (const ElfW(Phdr) & segment : std::span(library.dlpi_phdr, library.dlpi_phnum)) {
        if (segment.p_type != PT_DYNAMIC) continue;
        const auto* entry = std::bit_cast<const ElfW(Dyn)*>(library.dlpi_addr + segment.p_vaddr);
        for (; entry->d_tag != DT_NULL; ++entry)
            if (entry->d_tag == DT_TEXTREL || (entry->d_tag == DT_FLAGS && (entry->d_un.d_val & DF_TEXTREL) != 0))
                return true;
    }
    return false;
}

int releasePagesOf(dl_phdr_info* library, std::size_t, void*) {
    if (hasRelocatedText(*library)) return 0;
    const auto page = ElfW(Addr)(sysconf(_SC_PAGESIZE));
    for (const ElfW(Phdr) & segment : std::span(library->dlpi_phdr, library->dlpi_phnum)) {
        // What may not be written has the bytes of its file. Data are never touched.
        if (segment.p_type != PT_LOAD || (segment.p_flags & PF_W) != 0) continue;
        const ElfW(Addr) first = (library->dlpi_addr + segment.p_vaddr + page - 1) / page * page,
                         end = (library->dlpi_addr + segment.p_vaddr + segment.p_filesz) / page * page;
        if (first < end) madvise(std::bit_cast<void*>(first), end - first, MADV_DONTNEED);
    }
    return 0;
}

} // namespace

void releaseLibraryPages() { dl_iterate_phdr(releasePagesOf, nullptr); }

} // namespace relief::app
