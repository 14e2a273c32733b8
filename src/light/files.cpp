// Environments on disk: which shape a picture has, and where the faces of cubes are in it.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "light/light.h"

namespace relief {
namespace {

constexpr const char* kFaceMark = "{face}";

/// Names of faces in files, each set in the order of Vulkan. Files are written with the first one.
constexpr const char* kFaceNames[][kCubeFaces] = {{"px", "nx", "py", "ny", "pz", "nz"},
                                                  {"posx", "negx", "posy", "negy", "posz", "negz"},
                                                  {"right", "left", "up", "down", "front", "back"}};

/// How many faces a picture has each way, and the cell of each, from the top left. In a column face nz is turned.
struct Arrangement {
    int columns, rows;
    ivec2 cells[kCubeFaces];
};

Arrangement arrangementOf(CubeLayout layout) {
    switch (layout) {
    case CubeLayout::cross: return {4, 3, {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}};
    case CubeLayout::column: return {3, 4, {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}}};
    case CubeLayout::strip: return {6, 1, {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}};
    case CubeLayout::files: break;
    }
    fail(Failure::internal, "six files are no arrangement in one picture");
}

bool isTurned(CubeLayout layout, int face) { return layout == CubeLayout::column && face == 5; }

/// Calls use(x of the whole picture, y of it, x of the face, y of it) for all texels of a face.
template <typename Use>
void forTexels(CubeLayout layout, int face, int side, const Use& use) {
    const ivec2 first = arrangementOf(layout).cells[face] * side;
    const bool turned = isTurned(layout, face);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            use(first.x + x, first.y + y, turned ? side - 1 - x : x, turned ? side - 1 - y : y);
}

bool isArranged(const Image& image, CubeLayout layout) {
    const Arrangement a = arrangementOf(layout);
    return image.width % a.columns == 0 && image.width / a.columns * a.rows == image.height;
}

/// The layout that fits a picture's sides.
std::optional<CubeLayout> layoutOf(const Image& image) {
    for (const CubeLayout layout : {CubeLayout::cross, CubeLayout::column, CubeLayout::strip})
        if (isArranged(image, layout)) return layout;
    return {};
}

/// Reads a picture of colors and takes their first three channels.
Image readColors(const std::string& path) {
    const Image file = readImage(path);
    if (file.channels < 3 || file.width < 4 || file.height < 4)
        fail(Failure::input,
             "{}: an environment is a color picture of at least 8 x 4 pixels; this one is {} x {} with {} channels",
             path, file.width, file.height, file.channels);
    Image image{file.width, file.height, 3, {}};
    image.texels.reserve(std::size_t(file.width) * std::size_t(file.height) * 3);
    for (int y = 0; y < file.height; ++y)
        for (int x = 0; x < file.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float value = file.at(x, y)[c];
                if (!std::isfinite(value) || value < 0 || value > kMostRadiance)
                    fail(Failure::input, "{}: pixel {},{} is {}; radiance is a number in 0..{:g}", path, x, y, value,
                         kMostRadiance);
                image.texels.push_back(value);
            }
    return image;
}

std::string nameFace(std::string path, const char* face) {
    return path.replace(path.find(kFaceMark), std::string_view(kFaceMark).size(), face);
}

EnvironmentPicture readFaces(const std::string& path) {
    // The set of names of which files exist; the first one where there are none.
    const auto* names = &kFaceNames[0];
    for (const auto& set : kFaceNames)
        if (std::ranges::any_of(set, [&](const char* face) { return std::filesystem::exists(nameFace(path, face)); })) {
            names = &set;
            break;
        }
    // All six of that set, as squares of one size.
    EnvironmentPicture cube{.shape = EnvironmentShape::cube, .images = {}};
    for (const char* face : *names) {
        const std::string file = nameFace(path, face);
        if (!std::filesystem::exists(file))
            fail(Failure::input, "{}: there is no {}; a cube has six faces: {}", path, file, fmt::join(*names, " "));
        Image image = readColors(file);
        const Image& first = cube.images.empty() ? image : cube.images.front();
        if (image.width != image.height || image.width != first.width)
            fail(Failure::input, "{}: the face is {} x {}; the faces of a cube are six squares of one size{}", file,
                 image.width, image.height,
                 cube.images.empty()
                     ? ""
                     : fmt::format(", and {} is {} x {}", nameFace(path, (*names)[0]), first.width, first.height));
        cube.images.push_back(std::move(image));
    }
    return cube;
}

/// Whether all corners of a square picture are black, where a mirroring ball does not reach.
bool isBlackOutsideOfBall(const Image& image) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const dvec2 at = (dvec2(x, y) + 0.5) * 2.0 / double(image.width) - 1.0;
            if (glm::length(at) < 1 + 3.0 / image.width) continue;
            for (int c = 0; c < 3; ++c)
                if (image.at(x, y)[c] > 0.02f) return false;
        }
    return true;
}

/// Takes the faces out of a picture. A cross has cells without a face, which are of one color.
EnvironmentPicture takeFaces(const std::string& path, const Image& image, CubeLayout layout, bool isChosen) {
    const Arrangement a = arrangementOf(layout);
    const int side = image.width / a.columns;
    EnvironmentPicture cube{.shape = EnvironmentShape::cube, .images = {}};
    std::vector<char> isFace(std::size_t(image.width) * std::size_t(image.height));
    for (int face = 0; face < kCubeFaces; ++face) {
        Image& to = cube.images.emplace_back(
            Image{side, side, 3, std::vector<float>(std::size_t(side) * std::size_t(side) * 3)});
        forTexels(layout, face, side, [&](int x, int y, int i, int j) {
            std::copy_n(image.at(x, y), 3, to.at(i, j));
            isFace[std::size_t(y) * std::size_t(image.width) + std::size_t(x)] = 1;
        });
    }
    if (!isChosen || layout == CubeLayout::strip) return cube;
    // The bottom right corner belongs to no face of either cross.
    const float* beside = image.at(image.width - 1, image.height - 1);
    for (std::size_t i = 0; i < isFace.size(); ++i)
        for (std::size_t c = 0; isFace[i] == 0 && c < 3; ++c)
            if (std::abs(image.texels[3 * i + c] - beside[c]) > 0.02f)
                fail(Failure::input,
                     "{}: its sides are those of a cross of six faces, but there is a picture beside them; name "
                     "--environment-shape cube if it is one",
                     path);
    return cube;
}

EnvironmentFile readPicture(const std::string& path, std::optional<EnvironmentShape> asked) {
    Image image = readColors(path);
    const std::optional<CubeLayout> layout = layoutOf(image);
    const bool isWide = image.width == 2 * image.height && image.width >= 8;
    const bool isSquare = image.width == image.height;
    // What was asked for; else what its sides say: 2 x 1, those of crosses and strips, or 1 x 1.
    EnvironmentFile file{.isChosen = !asked};
    file.picture.shape = asked.value_or(isWide     ? EnvironmentShape::equirect
                                        : layout   ? EnvironmentShape::cube
                                        : isSquare ? EnvironmentShape::sphere
                                                   : EnvironmentShape::equirect);
    const std::string size = fmt::format("this one is {} x {}", image.width, image.height);
    // A shape that was guessed has to look like it, too.
    switch (file.picture.shape) {
    case EnvironmentShape::cube:
        if (!layout) fail(Failure::input, "{}: the faces of a cube are 4 x 3, 3 x 4 or 6 x 1 squares; {}", path, size);
        file.layout = *layout;
        file.picture = takeFaces(path, image, *layout, file.isChosen);
        return file;
    case EnvironmentShape::sphere:
        if (!isSquare) fail(Failure::input, "{}: a sphere map is a square picture; {}", path, size);
        if (file.isChosen && !isBlackOutsideOfBall(image))
            fail(Failure::input,
                 "{}: a square picture is a sphere map where it is black outside of the ball, and this one is not; "
                 "name --environment-shape sphere if it is one",
                 path);
        break;
    case EnvironmentShape::equirect:
        if (!isWide)
            fail(Failure::input, "{}: an equirectangular environment is twice as wide as high; {}{}", path, size,
                 asked ? "" : " (cubes are 4 x 3, 3 x 4 or 6 x 1 squares, sphere maps one)");
        break;
    }
    file.picture.images.push_back(std::move(image));
    return file;
}

} // namespace

EnvironmentFile readEnvironment(const std::string& path, std::optional<EnvironmentShape> shape) {
    if (path.find(kFaceMark) == std::string::npos) return readPicture(path, shape);
    if (shape && *shape != EnvironmentShape::cube)
        fail(Failure::usage, "{}: six files are a cube, and another shape is asked for", path);
    return {.picture = readFaces(path), .layout = CubeLayout::files, .isChosen = !shape};
}

std::string describe(const EnvironmentPicture& picture, CubeLayout layout) {
    const Image& image = picture.images.front();
    if (picture.shape == EnvironmentShape::sphere) return fmt::format("a sphere map of {0} x {0} texels", image.width);
    if (picture.shape == EnvironmentShape::equirect)
        return fmt::format("an equirectangular picture of {} x {} texels", image.width, image.height);
    const char* words[] = {"six files", "cross", "column", "strip"};
    return fmt::format("a cube ({}) of 6 x {} x {} texels", words[int(layout)], image.width, image.height);
}

Image arrangeFaces(const EnvironmentPicture& cube, CubeLayout layout) {
    RELIEF_CHECK(cube.images.size() == std::size_t(kCubeFaces));
    const Arrangement a = arrangementOf(layout);
    const int side = cube.side();
    Image whole{a.columns * side, a.rows * side, 3, {}};
    whole.texels.resize(std::size_t(whole.width) * std::size_t(whole.height) * 3);
    for (int face = 0; face < kCubeFaces; ++face)
        forTexels(layout, face, side, [&](int x, int y, int i, int j) {
            std::copy_n(cube.images[std::size_t(face)].at(i, j), 3, whole.at(x, y));
        });
    return whole;
}

std::vector<std::string> listEnvironmentFiles(const std::string& path) {
    if (path.find(kFaceMark) == std::string::npos) return {path};
    std::vector<std::string> files;
    for (const char* face : kFaceNames[0]) files.push_back(nameFace(path, face));
    return files;
}

void writeEnvironment(const std::string& path, const EnvironmentPicture& picture, CubeLayout layout,
                      SampleType sample) {
    const std::vector<std::string> files = listEnvironmentFiles(path);
    const bool isCube = picture.shape == EnvironmentShape::cube;
    if (files.size() > 1) {
        if (!isCube) fail(Failure::usage, "{}: {} names the six faces of a cube; name --shape cube", path, kFaceMark);
        for (std::size_t face = 0; face < files.size(); ++face) writeImage(files[face], picture.images[face], sample);
        return;
    }
    writeImage(path, isCube ? arrangeFaces(picture, layout) : picture.images.front(), sample);
}

} // namespace relief
