// Pictures, by the module that holds OpenImageIO.
#include "base/images.h"

#include <string_view>
#include <thread>

#include <dlfcn.h>

#include "base/errors.h"
#include "base/pictures/module.h"

namespace relief {

namespace {

const ImageModule& loadImageModule() {
    // By its name alone: the run path of what is linked with this function says where it lies.
    void* library = dlopen(RELIEF_IMAGE_MODULE, RTLD_LAZY | RTLD_LOCAL);
    if (library == nullptr) {
        const std::string_view why = dlerror();
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
        } catch (const std::exception&) { // whoever needs a picture says so
        }
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
