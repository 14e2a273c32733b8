// PLY (Turk, "The PLY polygon file format", 1994): text, and binary in both orders of bytes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "mesh/read.h"

namespace relief {
namespace {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr Word<Scalar> kScalars[] = {
    {"char", Scalar::int8, ""},      {"int8", Scalar::int8, ""},       {"uchar", Scalar::uint8, ""},
    {"uint8", Scalar::uint8, ""},    {"short", Scalar::int16, ""},     {"int16", Scalar::int16, ""},
    {"ushort", Scalar::uint16, ""},  {"uint16", Scalar::uint16, ""},   {"int", Scalar::int32, ""},
    {"int32", Scalar::int32, ""},    {"uint", Scalar::uint32, ""},     {"uint32", Scalar::uint32, ""},
    {"float", Scalar::float32, ""},  {"float32", Scalar::float32, ""}, {"double", Scalar::float64, ""},
    {"float64", Scalar::float64, ""}};

constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 4, 8}; ///< by Scalar

struct Property {
    std::string name;
    Scalar type = Scalar::float32;
    std::optional<Scalar> listCount; ///< type of the count, where it is a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

enum class Order { text, little, big };

struct Header {
    Order order = Order::text;
    std::vector<Element> elements;
};

std::vector<std::string> wordsOf(std::string_view line) {
    std::vector<std::string> words;
    for (std::size_t at = line.find_first_not_of(" \t"); at != std::string_view::npos;
         at = line.find_first_not_of(" \t", at)) {
        const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
        words.emplace_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

class PlyReader {
public:
    explicit PlyReader(const std::string& path) : source_(path) {}

    ReadTriangles read() {
        readHeader();
        checkHeader();
        for (const Element& element : header_.elements) {
            // The other elements matter only where faces come after them.
            if (element.name == "vertex")
                readVertices(element);
            else if (element.name == "face")
                readFaces(element);
            else
                skip(element);
            if (element.name == "face") break;
        }
        return std::move(triangles_);
    }

private:
    [[noreturn]] void failHeader(int line, const std::string& why) const {
        fail(Failure::input, "{}:{}: {}", source_.path(), line, why);
    }

    Scalar scalarOf(const std::string& word, int line) const {
        for (const Word<Scalar>& row : kScalars)
            if (word == row.word) return row.value;
        failHeader(line, fmt::format("there is no type {}", onOneLine(word)));
    }

    void readHeader() {
        if (source_.takeLine() != "ply")
            fail(Failure::input, "{}: a PLY file begins with a line 'ply'", source_.path());
        constexpr int kMostLines = 10'000;
        for (int line = 2; line <= kMostLines; ++line) {
            const std::vector<std::string> words = wordsOf(source_.takeLine());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
            if (words[0] == "end_header") return;
            readHeaderLine(words, line);
        }
        fail(Failure::input, "{}: there is no end_header in the first {} lines", source_.path(), kMostLines);
    }

    void readHeaderLine(const std::vector<std::string>& words, int line) {
        if (words[0] == "format" && words.size() >= 2) {
            if (words[1] == "ascii")
                header_.order = Order::text;
            else if (words[1] == "binary_little_endian")
                header_.order = Order::little;
            else if (words[1] == "binary_big_endian")
                header_.order = Order::big;
            else
                failHeader(line, fmt::format("there is no format {}", onOneLine(words[1])));
        } else if (words[0] == "element" && words.size() == 3) {
            const std::optional<double> count = numberOf(words[2]);
            if (!count || !(*count >= 0) || *count != std::floor(*count) || *count > 1e15)
                failHeader(line, fmt::format("{} is no number of elements", onOneLine(words[2])));
            header_.elements.push_back({words[1], std::uint64_t(*count), {}});
        } else if (words[0] == "property" && words.size() == 3 && !header_.elements.empty()) {
            header_.elements.back().properties.push_back({words[2], scalarOf(words[1], line), {}});
        } else if (words[0] == "property" && words.size() == 5 && words[1] == "list" && !header_.elements.empty()) {
            header_.elements.back().properties.push_back(
                {words[4], scalarOf(words[3], line), scalarOf(words[2], line)});
        } else {
            failHeader(line, fmt::format("a header has no line '{}'", onOneLine(words[0])));
        }
    }

    /// Before memory is taken: an element needs a byte per number at least, and a text a space beside it.
    void checkHeader() const {
        std::uint64_t left = source_.bytesLeft();
        for (const Element& element : header_.elements) {
            std::uint64_t bytes = 0;
            for (const Property& property : element.properties)
                bytes +=
                    header_.order == Order::text ? 2 : kBytes[std::size_t(property.listCount.value_or(property.type))];
            if (element.count > 0 && (bytes == 0 || element.count - 1 > left / bytes))
                fail(Failure::input,
                     "{}: the header claims {} elements '{}' of {} bytes or more each, and {} bytes are left",
                     source_.path(), element.count, onOneLine(element.name), bytes, left);
            left -= std::min(left, element.count * bytes);
        }
        const auto find = [&](const char* name) {
            return std::ranges::find(header_.elements, name, &Element::name) - header_.elements.begin();
        };
        const auto vertices = std::size_t(find("vertex")), faces = std::size_t(find("face"));
        if (vertices >= header_.elements.size() || faces >= header_.elements.size() || faces < vertices)
            fail(Failure::input, "{}: there are no elements 'vertex' with elements 'face' after them", source_.path());
        if (header_.elements[vertices].count > std::numeric_limits<std::uint32_t>::max())
            fail(Failure::input, "{}: {} vertices; at most {} can be read", source_.path(),
                 header_.elements[vertices].count, std::numeric_limits<std::uint32_t>::max());
    }

    double takeNumber(Scalar type) {
        if (header_.order == Order::text) {
            const std::string_view word = source_.takeWord();
            if (word.empty()) source_.failCut();
            const std::optional<double> number = numberOf(word);
            if (!number)
                fail(Failure::input, "{}: '{}' is no number", source_.path(),
                     onOneLine(std::string(word.substr(0, 40))));
            return *number;
        }
        const std::size_t count = kBytes[std::size_t(type)];
        std::array<char, 8> bytes{};
        std::memcpy(bytes.data(), source_.take(count), count);
        if ((header_.order == Order::big) == (std::endian::native == std::endian::little))
            std::reverse(bytes.begin(), bytes.begin() + std::ptrdiff_t(count));
        const auto as = [&]<typename T>(T value) {
            std::memcpy(&value, bytes.data(), sizeof(T));
            return double(value);
        };
        switch (type) {
        case Scalar::int8: return as(std::int8_t());
        case Scalar::uint8: return as(std::uint8_t());
        case Scalar::int16: return as(std::int16_t());
        case Scalar::uint16: return as(std::uint16_t());
        case Scalar::int32: return as(std::int32_t());
        case Scalar::uint32: return as(std::uint32_t());
        case Scalar::float32: return as(float());
        case Scalar::float64: return as(double());
        }
        fail(Failure::internal, "there is no type {}", int(type));
    }

    std::uint64_t takeListCount(const Element& element, std::uint64_t index, const Property& property) {
        const double count = takeNumber(*property.listCount);
        const double most = double(source_.bytesLeft()) /
                            (header_.order == Order::text ? 1.0 : double(kBytes[std::size_t(property.type)]));
        if (!(count >= 0) || count != std::floor(count))
            fail(Failure::input, "{}: {} {} has a list of {} numbers", source_.path(), element.name, index, count);
        if (count > most)
            fail(Failure::input, "{}: {} {} has a list of {} numbers, and {} bytes are left", source_.path(),
                 element.name, index, count, source_.bytesLeft());
        return std::uint64_t(count);
    }

    void skipProperty(const Element& element, std::uint64_t index, const Property& property) {
        const std::uint64_t count = property.listCount ? takeListCount(element, index, property) : 1;
        for (std::uint64_t i = 0; i < count; ++i) takeNumber(property.type);
    }

    void skip(const Element& element) {
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) skipProperty(element, i, property);
    }

    void readVertices(const Element& element) {
        std::array<bool, 3> isThere{};
        for (const Property& property : element.properties)
            for (std::size_t k = 0; k < 3; ++k)
                if (!property.listCount && property.name == std::string(1, char('x' + k))) isThere[k] = true;
        if (!isThere[0] || !isThere[1] || !isThere[2])
            fail(Failure::input, "{}: vertices have no properties x, y and z", source_.path());
        triangles_.positions.resize(element.count);
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) {
                if (!property.listCount && property.name.size() == 1 && property.name[0] >= 'x' &&
                    property.name[0] <= 'z')
                    triangles_.positions[i][property.name[0] - 'x'] = takeNumber(property.type);
                else
                    skipProperty(element, i, property);
            }
    }

    void readFaces(const Element& element) {
        const auto isCorners = [](const Property& p) {
            return p.listCount && (p.name == "vertex_indices" || p.name == "vertex_index");
        };
        if (std::ranges::none_of(element.properties, isCorners))
            fail(Failure::input, "{}: faces have no list vertex_indices", source_.path());
        triangles_.indices.reserve(3 * element.count);
        for (std::uint64_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) {
                if (isCorners(property))
                    readCorners(element, i, property);
                else
                    skipProperty(element, i, property);
            }
    }

    /// A polygon becomes a fan around its first corner. Fewer than three corners have no area.
    void readCorners(const Element& element, std::uint64_t face, const Property& property) {
        const std::uint64_t count = takeListCount(element, face, property);
        std::uint32_t first = 0, last = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
            const double number = takeNumber(property.type);
            if (!(number >= 0) || number >= double(triangles_.positions.size()) || number != std::floor(number))
                fail(Failure::input, "{}: face {} names vertex {}; vertices 0 to {} exist", source_.path(), face,
                     number, std::int64_t(triangles_.positions.size()) - 1);
            const auto corner = std::uint32_t(number);
            if (i == 0) first = corner;
            if (i >= 2) triangles_.indices.insert(triangles_.indices.end(), {first, last, corner});
            last = corner;
        }
    }

    MeshSource source_;
    Header header_;
    ReadTriangles triangles_;
};

} // namespace

ReadTriangles readPly(const std::string& path) { return PlyReader(path).read(); }

} // namespace relief
