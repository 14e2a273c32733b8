// Colors and normals in sets of tiles: one picture of them all.
#include <algorithm>
#include <cmath>

#include "displacement/parallel.h"
#include "scene/loading.h"

namespace relief {
namespace {

constexpr int kMostPictureSide = 16384;

/// The mean of the texels that a texel of a smaller picture covers, or in a larger one the texel between others.
vec3 resampledAt(const Image& image, const dvec2& center, const dvec2& footprint) {
    dvec3 sum(0);
    const ivec2 counts(glm::max(glm::ceil(footprint), dvec2(1)));
    for (int j = 0; j < counts.y; ++j)
        for (int i = 0; i < counts.x; ++i) {
            const dvec2 at = center + footprint * ((dvec2(i, j) + 0.5) / dvec2(counts) - 0.5) - 0.5;
            const dvec2 whole = glm::floor(at), f = at - whole;
            const auto texel = [&](double x, double y) {
                const float* c =
                    image.at(std::clamp(int(x), 0, image.width - 1), std::clamp(int(y), 0, image.height - 1));
                return dvec3(c[0], c[1], c[2]);
            };
            sum += glm::mix(glm::mix(texel(whole.x, whole.y), texel(whole.x + 1, whole.y), f.x),
                            glm::mix(texel(whole.x, whole.y + 1), texel(whole.x + 1, whole.y + 1), f.x), f.y);
        }
    return vec3(sum / double(counts.x * counts.y));
}

/// Puts a tile into its square of the picture; returns the sum of its colors there.
dvec3 putTile(Image& all, const Image& tile, const ivec2& corner, const ivec2& size) {
    dvec3 sum(0);
    const dvec2 footprint = dvec2(tile.width, tile.height) / dvec2(size);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const vec3 color = resampledAt(tile, (dvec2(x, y) + 0.5) * footprint, footprint);
            float* to = all.at(corner.x + x, corner.y + y);
            for (int c = 0; c < 3; ++c) to[c] = color[c];
            sum += dvec3(color);
        }
    return sum;
}

} // namespace

JoinedPictures joinSquares(const std::vector<PictureSquare>& squares, const std::optional<vec3>& empty,
                           const std::string& name, const Warn& warn) {
    // Sizes first: memory is taken for what they come to.
    ivec2 size(1), lowest = squares.front().place, highest = lowest;
    for (const PictureSquare& square : squares) {
        size = glm::max(size, square.size);
        lowest = glm::min(lowest, square.place), highest = glm::max(highest, square.place);
    }
    JoinedPictures joined{.image = {}, .tiles = {lowest, highest - lowest + 1}};
    const ivec2 largest = size, count = joined.tiles.count;
    const auto isTooLarge = [&] {
        const dvec2 all = dvec2(size) * dvec2(count);
        return std::max(all.x, all.y) > kMostPictureSide || all.x * all.y * 12 > double(ImageLimits().decodedBytes);
    };
    while (isTooLarge() && size != ivec2(1)) size = glm::max(size / 2, ivec2(1));
    if (isTooLarge())
        fail(Failure::input, "{}: its tiles span {} x {} unit squares, more than one picture holds", name, count.x,
             count.y);
    if (size != largest)
        warn(fmt::format("{}: its tiles span {} x {} unit squares; {} x {} texels are drawn of each", name, count.x,
                         count.y, size.x, size.y));
    Image& image = joined.image;
    image = {.width = size.x * count.x, .height = size.y * count.y, .channels = 3, .texels = {}};
    image.texels.assign(std::size_t(image.width) * std::size_t(image.height) * 3, 0.0f);

    // Tiles at once; rows go down.
    const auto cornerOf = [&](const ivec2& place) { return ivec2(place.x - lowest.x, highest.y - place.y) * size; };
    std::vector<dvec3> sums(squares.size());
    std::vector<std::vector<std::string>> warnings(squares.size());
    forEachAtOnce(squares.size(), [&](std::size_t i) {
        const Warn collect = [&](const std::string& line) { warnings[i].push_back(line); };
        sums[i] = putTile(image, squares[i].read(collect), cornerOf(squares[i].place), size);
    });
    for (const std::vector<std::string>& lines : warnings)
        for (const std::string& line : lines) warn(line);

    // Squares without a tile.
    dvec3 mean(0);
    for (const dvec3& sum : sums) mean += sum / (double(size.x) * size.y * double(squares.size()));
    const Image filler{.width = 1, .height = 1, .channels = 3, .texels = [&] {
                           const vec3 color = empty.value_or(vec3(mean));
                           return std::vector<float>{color.x, color.y, color.z};
                       }()};
    for (int t = lowest.y; t <= highest.y; ++t)
        for (int s = lowest.x; s <= highest.x; ++s)
            if (std::ranges::find(squares, ivec2(s, t), &PictureSquare::place) == squares.end())
                putTile(image, filler, cornerOf({s, t}), size);
    return joined;
}

JoinedPictures joinPictures(const std::string& path, const std::optional<vec3>& empty, const Warn& warn) {
    std::vector<PictureSquare> squares;
    for (const TileFile& file : listTiles(path)) {
        const ImageInfo info = readImageInfo(file.path);
        if (info.channels < 3)
            fail(Failure::input, "{}: a map of colors or normals has 3 channels, this one has {}", file.path,
                 info.channels);
        squares.push_back({.place = file.place,
                           .size = {info.width, info.height},
                           .read = [path = file.path, isColors = !empty](const Warn& collect) {
                               return isColors ? loadColors(path, collect) : readImage(path);
                           }});
    }
    return joinSquares(squares, empty, path, warn);
}

} // namespace relief
