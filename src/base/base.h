// Vectors, errors, progress, images on disk, files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#include <glm/glm.hpp>

#include "base/checks.h"
#include "base/words.h"

namespace relief {

using glm::dmat2;
using glm::dvec2;
using glm::dvec3;
using glm::ivec2;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// Why something failed; the value is the exit code of the command line.
enum class Failure { internal = 1, usage = 2, input = 3, file = 4, device = 5, check = 6 };

/// One line a person can act on: what, file and line or index, the valid range, what to do.
class Error : public std::runtime_error {
public:
    Error(Failure failure, const std::string& line) : std::runtime_error(line), failure(failure) {}
    Failure failure;
};

template <typename... Args>
[[noreturn]] void fail(Failure failure, fmt::format_string<Args...> format, Args&&... args) {
    throw Error(failure, fmt::format(format, std::forward<Args>(args)...));
}

/// Called with one line for each thing that is odd but not wrong (an 8-bit height map, a cage without UVs).
using Warn = std::function<void(const std::string&)>;

/// The text with a space in the place of each control character: one line, whatever stood in the names that it repeats.
std::string onOneLine(std::string text);

/// Prints to stderr, and goes on where that cannot be written (closed, or a file on a full disk).
void printOnStderr(std::string_view text);

/// Prints "warning: LINE" to stderr.
void warnOnStderr(const std::string& line);

/// An axis-aligned box; empty (lower > upper) until something is added.
struct Bounds {
    dvec3 lower{1e300};
    dvec3 upper{-1e300};

    void add(const dvec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
    [[nodiscard]] bool isEmpty() const { return lower.x > upper.x; }
    [[nodiscard]] dvec3 center() const { return 0.5 * (lower + upper); }
    [[nodiscard]] double diagonal() const { return isEmpty() ? 0 : glm::length(upper - lower); }
    [[nodiscard]] double longestSide() const;
    /// From a point to the box, which is not empty; 0 inside.
    [[nodiscard]] double distanceTo(const dvec3& p) const {
        return glm::length(glm::max(glm::max(lower - p, p - upper), dvec3(0)));
    }
};

// --- coordinates ------------------------------------------------------------------------------------------------

/// The largest coordinate of a position that is taken, and the smallest side of an object that has coordinates of its
/// own.
inline constexpr double kFarthestCoordinate = 1e100, kSmallestSide = 1e-100;

/// Where an object's own coordinates, which floats hold, are in the world, which takes doubles:
/// world = origin + unit * local. The unit is a power of two.
struct Coordinates {
    dvec3 origin{0};
    double unit = 1;

    bool operator==(const Coordinates&) const = default;
    /// Local coordinates are the world's, to the bit.
    [[nodiscard]] bool isIdentity() const { return origin == dvec3(0) && unit == 1; }
    [[nodiscard]] dvec3 toWorld(const dvec3& local) const;
    [[nodiscard]] dvec3 toLocal(const dvec3& world) const;
    [[nodiscard]] Bounds toWorld(const Bounds& local) const;
};

/// For an object with such a box in the world. The identity unless the box's centre is farther from the origin than the
/// box is large, or its longest side is below 2^-20 or above 2^21. Origins are multiples of a power of two above the
/// longest side, so that positions that are floats stay exact, and so does an object that is moved by such a multiple.
Coordinates coordinatesFor(const Bounds& bounds);

/// From the largest coordinate of a place to the next float.
double floatSpacing(const dvec3& p);

// --- images on disk ---------------------------------------------------------------------------------------------

/// What a picture file may hold before it is refused (checked on its header, before memory is taken).
struct ImageLimits {
    int side = 32768;                        ///< largest width and height, pixels
    std::uint64_t decodedBytes = 1ull << 30; ///< largest width * height * channels * bytes a sample
};

/// A part of an EXR or a page of a TIFF.
struct ImagePart {
    std::string name; ///< as the file says it, else its number from 0
    std::vector<std::string> channelNames;
};

/// Of the first part, except for `parts`.
struct ImageInfo {
    int width = 0, height = 0, channels = 0;
    std::string format; ///< reader's name: "png", "openexr", "tiff", "hdr", "jpeg"
    std::string sample; ///< sample type: "uint8", "int16", "half", "float", ...
    int sampleBytes = 0;
    bool isFloat = false;         ///< half, float or double samples: heights in units, not 0..1
    bool isSigned = false;        ///< signed integers: texels are the stored numbers, not 0..1
    std::optional<double> noData; ///< the stored number that stands for a void (GDAL_NODATA of a TIFF); may be NaN
    std::vector<std::string> channelNames;
    std::vector<ImagePart> parts; ///< at least the first one; only pages of its size

    /// Samples whose texels are numbers with a unit of their own: 0 means no height.
    [[nodiscard]] bool hasUnit() const { return isFloat || isSigned; }
};

/// A channel of a file: of one of its parts, both from 0.
struct ChannelPlace {
    int part = 0, channel = 0;
};
/// By its number in the first part, its name ("R", "Displacement.R", with its part's name before it: "part.R"), or the
/// name of a layer or part, whose first channel it is. Nothing where there is no such channel.
std::optional<ChannelPlace> findChannel(const ImageInfo& info, std::string_view word);
/// The names of the file's layers in their order: parts, and what stands before the last dot in channels' names.
std::vector<std::string> layersOf(const ImageInfo& info);

/// Floats, row-major from the top row, channels interleaved; unsigned integers are mapped to 0..1, signed ones are the
/// stored numbers; no color transform.
struct Image {
    int width = 0, height = 0, channels = 0;
    std::vector<float> texels; ///< width * height * channels

    [[nodiscard]] const float* at(int x, int y) const { return &texels[(std::size_t(y) * width + x) * channels]; }
    float* at(int x, int y) { return &texels[(std::size_t(y) * width + x) * channels]; }
};

/// Reads a header. The reader is chosen by the file's first bytes (EXR, TIFF, PNG, HDR, JPEG), never by its name.
/// Throws Failure::file when it cannot be opened, Failure::input when it is no such picture or passes a limit.
ImageInfo readImageInfo(const std::string& path, const ImageLimits& limits = {});

/// Reads all channels, or only `channel` (0-based) when it is not negative, as raw data.
Image readImage(const std::string& path, int channel = -1, const ImageLimits& limits = {}, int part = 0);

/// Called with `count` rows from row `first` on: count * width * channels texels.
using TakeRows = std::function<void(int first, int count, std::span<const float> texels)>;
/// Reads all channels of the first part, as readImage, in strips of a few megabytes from the top.
void readImageRows(const std::string& path, const TakeRows& take, const ImageLimits& limits = {});

/// The first texel that is NaN or infinite, by column, row and channel from 0.
struct TexelPlace {
    int x = 0, y = 0, channel = 0;
    float value = 0;
};
std::optional<TexelPlace> findNotFinite(const Image& image);

enum class SampleType { uint8, uint16, half, real };

/// Writes PNG, TIFF or EXR by the extension of `path`, whole or not at all. Values are written as they are (0..1 for
/// integer samples, clamped). Throws Failure::usage for an unknown extension or a sample that the format has not (PNG
/// holds integers, EXR half and real, TIFF all; half becomes real there), Failure::file when writing fails.
void writeImage(const std::string& path, const Image& image, SampleType sample);

/// A channel of a picture with many: its name, which may hold the layer's ("N.X"), and half or real samples.
struct ImageChannel {
    std::string name;
    SampleType sample = SampleType::real;
};
/// The same with channels of their own names and samples, one for each of the image's. For .exr only.
void writeImage(const std::string& path, const Image& image, const std::vector<ImageChannel>& channels);

// --- files ------------------------------------------------------------------------------------------------------

/// A regular file, open for reading: the one way in which files come in. Folders, pipes, sockets and devices are
/// refused before anything waits for them.
class InputFile {
public:
    /// Throws Failure::file when it cannot be opened or is not a regular file.
    explicit InputFile(std::string path);
    InputFile(InputFile&& other) noexcept;
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;
    ~InputFile();

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::uint64_t size() const { return size_; } ///< bytes when it was opened
    /// Reads up to `count` bytes from `offset` on, fewer only where the file ends. Throws Failure::file.
    std::size_t read(std::uint64_t offset, void* bytes, std::size_t count) const;

private:
    std::string path_;
    std::uint64_t size_ = 0;
    int file_ = -1;
};

/// The whole file as bytes. Throws Failure::file, or Failure::input when it is longer than `limit` bytes.
std::string readFile(const std::string& path, std::uint64_t limit = 1ull << 32);

/// Calls `write` with the name of an empty temporary file, then puts that in the place of `path`; on any exception
/// `path` is as it was. The temporary file lies in the target's folder; it has no name of its own there where the
/// system knows such files, so that nothing is left of a process that is killed. A link is followed, to a file that is
/// still to be made too; a file keeps its permissions. Throws Failure::file when the folder or the file cannot be
/// written or `path` is something else than a file (a folder, a device).
void writeWhole(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// Throws what writeWhole would throw for a `path` that cannot be written, and leaves no file behind: to be asked
/// before long work whose result goes there.
void checkWritable(const std::string& path);

/// Writes `bytes` as the file `path`, whole or not at all. Throws Failure::file when writing fails.
void writeFile(const std::string& path, std::string_view bytes);

/// A file or folder that is removed, with all that is in it, at the end of the scope or by an interrupt before.
class Temporary {
public:
    /// `make` makes it and returns its path. No interrupt comes between its being made and its being listed.
    explicit Temporary(const std::function<std::string()>& make);
    Temporary(const Temporary&) = delete;
    Temporary& operator=(const Temporary&) = delete;
    ~Temporary();

    [[nodiscard]] const std::string& path() const { return path_; }

private:
    std::string path_;
};

/// From now on an interrupt (SIGINT, SIGTERM, SIGHUP) removes everything temporary and ends the program with 128 + the
/// signal's number: 130 for Ctrl-C. Call it first in main: threads that run already are not covered.
void endCleanlyOnInterrupt();

// --- words ------------------------------------------------------------------------------------------------------

/// The file name's extension with its dot, in lower case: what kind of file a name asks for.
std::string lowerExtension(const std::string& path);

/// The candidate nearest to `word` by edit distance, or "" when none is near: for "did you mean".
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates);

/// "4.2 MB": decimal units as file managers print them.
std::string humanBytes(std::uint64_t bytes);

enum class ShowProgress { automatic, always, never };

/// One line on stderr, redrawn in place: `rendering  42 % ████░░░░`. With a unit, also how fast it goes and how long it
/// will take: `animating  42 % ████░░░░  3.2 frames/s, 0:41 left`. Automatic: silent unless stderr is a terminal and
/// the work takes over a second. One thread advances it.
class Progress {
public:
    Progress(std::string title, std::uint64_t total, ShowProgress show, std::string unit = "");
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void advance(std::uint64_t steps = 1);

private:
    void draw();
    [[nodiscard]] std::string speed() const;
    std::string title_, unit_;
    std::uint64_t total_, done_ = 0;
    int shownPercent_ = -1;
    bool isShown_;
    double startSeconds_, quietUntil_;
};

} // namespace relief
