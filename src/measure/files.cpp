#include <filesystem>

#include <unistd.h>

#include "measure/suite.h"

namespace relief {
namespace {

/// Writes the map as an image file and returns its size. An empty `compression` is the format's own choice.
std::uint64_t measureFile(const HeightMap& map, const std::string& file, SampleType sample,
                          const std::string& compression) {
    const ScratchFolder folder;
    const std::string path = folder / file;
    Image image{map.width, map.height, 1, map.texels};
    // Integer files hold 0..1: the range of the map.
    const float range = map.highest > map.lowest ? map.highest - map.lowest : 1;
    if (sample == SampleType::uint8 || sample == SampleType::uint16)
        for (float& texel : image.texels) texel = (texel - map.lowest) / range;
    writeImage(path, image, sample, compression);
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
        const SampleType type = format == MapFormat::real ? SampleType::real : SampleType::half;
        return {{Metric::mapFileExrZip, measureFile(map, "map.exr", type, "zip")},
                {Metric::mapFileExrPiz, measureFile(map, "map.exr", type, "piz")}};
    }
    case MapFormat::unorm16: return {{Metric::mapFilePng, measureFile(map, "map.png", SampleType::uint16, "")}};
    case MapFormat::unorm8: return {{Metric::mapFilePng, measureFile(map, "map.png", SampleType::uint8, "")}};
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
