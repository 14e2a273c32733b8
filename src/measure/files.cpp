#include <filesystem>

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include "measure/suite.h"

namespace relief {
namespace {

/// Writes the map as an image file and returns its size. An empty `compression` is the format's own choice.
std::uint64_t measureFile(const HeightMap& map, const std::string& file, const OIIO::TypeDesc& type,
                          const std::string& compression) {
    const ScratchFolder folder;
    const std::string path = folder / file;
    const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(path);
    OIIO::ImageSpec spec(map.width, map.height, 1, type);
    if (!compression.empty()) spec.attribute("compression", compression);
    // Integer files hold 0..1: the range of the map.
    std::vector<float> texels = map.texels;
    const float range = map.highest > map.lowest ? map.highest - map.lowest : 1;
    if (!type.is_floating_point())
        for (float& texel : texels) texel = (texel - map.lowest) / range;
    if (!out || !out->open(path, spec) || !out->write_image(OIIO::TypeFloat, texels.data()) || !out->close())
        fail(Failure::file, "{}: cannot be written: {}", path, out ? out->geterror() : OIIO::geterror());
    return std::filesystem::file_size(path);
}

} // namespace

ScratchFolder::ScratchFolder()
    : folder_([] {
          std::string name = (std::filesystem::temp_directory_path() / "relief-bench-XXXXXX").string();
          if (mkdtemp(name.data()) == nullptr) fail(Failure::file, "{}: cannot make a folder there", name);
          return name;
      }) {}

std::vector<MapFile> measureMapFiles(const HeightMap& map, MapFormat format) {
    switch (format) {
    case MapFormat::real:
    case MapFormat::half: {
        const OIIO::TypeDesc type = format == MapFormat::real ? OIIO::TypeFloat : OIIO::TypeHalf;
        return {{Metric::mapFileExrZip, measureFile(map, "map.exr", type, "zip")},
                {Metric::mapFileExrPiz, measureFile(map, "map.exr", type, "piz")}};
    }
    case MapFormat::unorm16: return {{Metric::mapFilePng, measureFile(map, "map.png", OIIO::TypeUInt16, "")}};
    case MapFormat::unorm8: return {{Metric::mapFilePng, measureFile(map, "map.png", OIIO::TypeUInt8, "")}};
    case MapFormat::bc4:
        return {{Metric::mapFileBlocks, std::uint64_t((map.width + 3) / 4) * std::uint64_t((map.height + 3) / 4) * 8}};
    }
    return {};
}

std::uint64_t measureCageFile(const Cage& cage) {
    const ScratchFolder folder;
    writeObj(folder / "cage.obj", cage);
    return std::filesystem::file_size(folder / "cage.obj");
}

} // namespace relief
