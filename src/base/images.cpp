// Pictures, by the module that holds OpenImageIO.
#include "base/images.h"

#include <cstddef>
#include <string>
#include <thread>
#include <vector>

#include <dlfcn.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/pictures/module.h"

namespace relief {

namespace {

/// The folders that this program looks for libraries in, those of its run path first.
std::vector<std::string> listLibraryFolders() {
    void* program = dlopen(nullptr, RTLD_LAZY);
    Dl_serinfo sizes;
    if (program == nullptr || dlinfo(program, RTLD_DI_SERINFOSIZE, &sizes) != 0) return {};
    std::vector<std::max_align_t> memory(sizes.dls_size / sizeof(std::max_align_t) + 1);
    auto* info = reinterpret_cast<Dl_serinfo*>(memory.data());
    *info = sizes;
    if (dlinfo(program, RTLD_DI_SERINFO, info) != 0) return {};
    std::vector<std::string> folders;
    const Dl_serpath* paths = info->dls_serpath;
    for (unsigned i = 0; i < info->dls_cnt; ++i) folders.emplace_back(paths[i].dls_name);
    return folders;
}

/// Loads the library, or sets `why` to the reason.
void* openImageModule(std::string& why) {
    // By its name alone: the run path of what is linked with this function says where it lies.
    void* library = dlopen(RELIEF_IMAGE_MODULE, RTLD_LAZY | RTLD_LOCAL);
    if (library != nullptr) return library;
    why = dlerror();
    if (why.find("No such file") == why.npos) return nullptr;
    // With sanitizers dlopen is a function of theirs, and the run path that of their library.
    for (const std::string& folder : listLibraryFolders()) {
        const std::string path = folder + "/" + RELIEF_IMAGE_MODULE;
        if (access(path.c_str(), F_OK) != 0) continue;
        library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
        if (library == nullptr) why = dlerror();
        return library;
    }
    return nullptr;
}

const ImageModule& loadImageModule() {
    std::string why;
    void* library = openImageModule(why);
    if (library == nullptr) {
        const bool isScarce = why.find("allocate") != why.npos || why.find("map segment") != why.npos;
        fail(isScarce ? Failure::device : Failure::internal, "the library that reads pictures cannot be loaded: {}{}",
             isScarce ? "out of memory: " : "", why);
    }
    const auto entry = reinterpret_cast<const ImageModule* (*)()>(dlsym(library, kImageModuleEntry));
    if (entry == nullptr) fail(Failure::internal, "{} is not relief's library of pictures", RELIEF_IMAGE_MODULE);
    return *entry();
}

} // namespace

const ImageModule& imageModule() {
    static const ImageModule& loaded = loadImageModule();
    return loaded;
}

std::jthread prepareImages() {
    return std::jthread([] {
        try {
            imageModule();
        } catch (const Error&) { // whoever needs a picture says so
        } // Memory that ran out ends the program: the loader stays locked, and the next call of it would wait.
    });
}

ImageInfo readImageInfo(const std::string& path, const ImageLimits& limits) {
    return imageModule().readImageInfo(path, limits);
}

Image readImage(const std::string& path, int channel, const ImageLimits& limits, int part) {
    return imageModule().readImage(path, channel, limits, part);
}

Image decodeImage(std::span<const unsigned char> bytes, const std::string& name, const ImageLimits& limits) {
    return imageModule().decodeImage(bytes, name, limits);
}

void readImageRows(const std::string& path, const TakeRows& take, const ImageLimits& limits) {
    imageModule().readImageRows(path, take, limits);
}

bool drawText(Image& image, const std::string& text, int x, int y, int size, float grey) {
    return imageModule().drawText(image, text, x, y, size, grey);
}

} // namespace relief
