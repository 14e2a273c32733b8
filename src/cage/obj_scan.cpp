// The checks that tinyobjloader does not make. It reads "0,5", "nan" and missing words as 0, takes indices past the
// end, counts a face's corners in one byte, drops faces of two corners and reports no line numbers.
#include "cage/obj.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <span>

#include "cage/faces.h"
#include "cage/obj_lines.h"

namespace relief {

namespace {

using Words = std::vector<std::string_view>;

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
constexpr std::size_t kMaxCorners = std::numeric_limits<int>::max();
constexpr std::size_t kMaxLineBytes = 16'000'000; ///< the words of a line take up to eight times as much

/// The three kinds of things that a face's corner names.
enum Kind { position, texCoord, normal, kindCount };
constexpr std::array kKindNames = {"vertex", "texture coordinate", "normal"};

/// What the lines read so far have of one kind.
struct Values {
    std::size_t count = 0;
    std::size_t largestIndex = 0, largestIndexLine = 0;  ///< faces may come before their vertices: compared at the end
    std::size_t firstLineWith = 0, firstLineWithout = 0; ///< faces where some corner has or lacks one; 0: there is none
};

/// Faces with the same fault.
struct FaultyFaces {
    std::size_t count = 0, first = 0, firstLine = 0; ///< faces count from 0
    std::size_t vertex = 0;                          ///< from 1, of the first
};

class ObjScanner {
public:
    ObjScanner(const std::string& name, const Warn& warn) : name_(name), warn_(warn) {}
    ObjScan scan(std::string_view text);

private:
    void scanLine(std::string_view line);
    void scanNumbers(Kind kind);
    void scanPosition();
    void scanFace();
    void scanCorner(std::string_view corner, std::array<bool, kindCount>& has);
    std::size_t resolveIndex(Kind kind, std::string_view word);
    void noteFault(FaultyFaces& faces);
    void notePresence(Kind kind, std::size_t cornersWith);
    [[nodiscard]] const char* slashHint(Kind kind) const;
    void checkLength(std::size_t length) const;
    void scanTag();
    [[nodiscard]] std::array<std::size_t, 3> scanTagSizes(std::string_view sizes) const;
    float scanFloat(std::string_view word) const;
    double scanCoordinate(std::string_view word) const;
    void splitWords(std::string_view rest);
    void keepWords(std::string_view keyword);
    void warnOnce(std::string_view keyword);
    void finishNormals();
    void finishFaces();
    void finish();

    template <typename... Args>
    [[noreturn]] void failHere(fmt::format_string<Args...> format, Args&&... args) const {
        failAtLine(name_, line_, format, std::forward<Args>(args)...);
    }

    const std::string& name_;
    const Warn& warn_;
    ObjScan result_;
    std::size_t line_ = 0;
    std::array<Values, kindCount> values_;
    Words words_;                                            ///< of the line, without keyword and comment
    std::vector<std::uint32_t> faceVertices_, soundCorners_; ///< of the face at hand, from 0
    FaultyFaces repeating_, degenerate_;
    std::string lostNormal_; ///< what is wrong with the first one that is before all others; empty when none is
    std::set<std::string, std::less<>> warnedOf_;
};

ObjScan ObjScanner::scan(std::string_view text) {
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    result_.text.reserve(text.size());
    std::string joined;
    for (std::size_t nextLine = 1; !text.empty();) {
        line_ = nextLine++;
        std::string_view line = takeLine(text);
        if (isContinued(line)) {
            joined.clear();
            for (; line.ends_with('\\') && !text.empty(); line = takeLine(text), ++nextLine) {
                joined.append(line.substr(0, line.size() - 1)).push_back(' ');
                checkLength(joined.size());
            }
            joined.append(line.substr(0, line.find_last_not_of('\\') + 1));
            line = joined;
        }
        scanLine(trimmed(line));
    }
    finish();
    return std::move(result_);
}

void ObjScanner::scanLine(std::string_view line) {
    if (line.empty() || line[0] == '#') return;
    checkLength(line.size());
    if (line.find('\0') != std::string_view::npos)
        failHere("there is a zero byte in this line; save the file as plain UTF-8 text");

    // Names may contain blanks, so they are not split into words; smoothing groups and material files have no effect.
    const std::string_view keyword = firstWord(line);
    const std::string_view rest = trimmed(line.substr(keyword.size()));
    if (keyword == "o" || keyword == "g" || keyword == "usemtl") {
        result_.text.append(keyword).append(" ").append(rest).append("\n");
        return;
    }
    if (keyword == "s" || keyword == "mtllib") return;

    // Lines of numbers and faces are checked, then kept for tinyobjloader.
    splitWords(rest);
    if (keyword == "t") return scanTag();
    if (keyword == "v")
        scanNumbers(position);
    else if (keyword == "vt")
        scanNumbers(texCoord);
    else if (keyword == "vn")
        scanNumbers(normal);
    else if (keyword == "f")
        scanFace();
    else
        return warnOnce(keyword);
    keepWords(keyword);
}

void ObjScanner::scanNumbers(Kind kind) {
    static constexpr std::array<std::size_t, kindCount> kFewest = {3, 1, 3};
    static constexpr std::array<std::size_t, kindCount> kMost = {8, 3, 3}; // x y z, then w, a colour or both
    const std::size_t fewest = kFewest[kind], most = kMost[kind];
    if (words_.size() < fewest || words_.size() > most)
        failHere("a {} has {} to {} numbers, this one has {}", kKindNames[kind], fewest, most, words_.size());
    ++values_[kind].count;
    if (kind == position) return scanPosition();
    for (const std::string_view word : words_) scanFloat(word);
}

/// Kept in double precision: far from the origin, floats are farther apart than the vertices.
void ObjScanner::scanPosition() {
    dvec3& p = result_.positions.emplace_back();
    for (int k = 0; k < 3; ++k) p[k] = scanCoordinate(words_[std::size_t(k)]);
    for (const std::string_view word : std::span(words_).subspan(3)) scanFloat(word);
}

void ObjScanner::scanFace() {
    if (words_.empty()) failHere("this face has no corners; a face needs 3 or more");
    faceVertices_.clear();
    std::array<std::size_t, kindCount> cornersWith{};
    for (const std::string_view word : words_) {
        std::array<bool, kindCount> has{};
        scanCorner(word, has);
        for (int kind = 0; kind < kindCount; ++kind) cornersWith[kind] += has[kind] ? 1 : 0;
    }
    findSoundCorners(faceVertices_, soundCorners_);
    if (soundCorners_.empty()) {
        noteFault(degenerate_);
    } else {
        if (soundCorners_.size() < words_.size()) noteFault(repeating_);
        notePresence(texCoord, cornersWith[texCoord]);
        notePresence(normal, cornersWith[normal]);
    }
    ++result_.faceCount;
    result_.cornerCount += words_.size();
    if (result_.cornerCount > kMaxCorners) failHere("more than {} corners in all faces", kMaxCorners);
}

/// A corner is "v", "v/vt", "v//vn" or "v/vt/vn"; an empty field means that there is none.
void ObjScanner::scanCorner(std::string_view corner, std::array<bool, kindCount>& has) {
    std::string_view rest = corner;
    for (int kind = 0; kind < kindCount; ++kind) {
        const std::string_view field = rest.substr(0, rest.find('/'));
        has[kind] = !field.empty() || kind == position;
        if (has[kind]) {
            const std::size_t index = resolveIndex(Kind(kind), field);
            if (kind == position) faceVertices_.push_back(std::uint32_t(index));
        }
        if (field.size() == rest.size()) return;
        rest.remove_prefix(field.size() + 1);
    }
    failHere("{} has more than three indices; a corner is vertex/texture/normal", inQuotes(corner));
}

/// The index from 0. Negative ones count back from the latest value; positive ones may name values still to come.
std::size_t ObjScanner::resolveIndex(Kind kind, std::string_view word) {
    Values& values = values_[kind];
    const std::optional<int> index = parseNumber<int>(word);
    if (!index) failHere("{} is not a {} index; write a whole number", inQuotes(word), kKindNames[kind]);
    if (*index == 0) failHere("{} index 0 does not exist; a face's indices count from 1", kKindNames[kind]);
    if (*index < 0) {
        const std::size_t back = std::size_t(-std::int64_t(*index));
        if (back <= values.count) return values.count - back;
        if (kind != normal)
            failHere("{} index {} reaches before the first; {} are defined above this line{}", kKindNames[kind], *index,
                     values.count, slashHint(kind));
        if (lostNormal_.empty())
            lostNormal_ = fmt::format("{}:{}: normal index {} reaches before the first", name_, line_, *index);
        return 0;
    }
    if (std::size_t(*index) > values.largestIndex) {
        values.largestIndex = std::size_t(*index);
        values.largestIndexLine = line_;
    }
    return std::size_t(*index) - 1;
}

void ObjScanner::noteFault(FaultyFaces& faces) {
    if (faces.count++ != 0) return;
    faces.first = result_.faceCount;
    faces.firstLine = line_;
    std::ranges::sort(faceVertices_);
    const auto twin = std::ranges::adjacent_find(faceVertices_);
    faces.vertex = twin == faceVertices_.end() ? 0 : *twin + 1;
}

void ObjScanner::notePresence(Kind kind, std::size_t cornersWith) {
    Values& values = values_[kind];
    if (cornersWith > 0 && values.firstLineWith == 0) values.firstLineWith = line_;
    if (cornersWith < words_.size() && values.firstLineWithout == 0) values.firstLineWithout = line_;
}

/// The hint for a texture coordinate that does not exist in a file whose normals no face names; else "".
const char* ObjScanner::slashHint(Kind kind) const {
    const bool isLikely = kind == texCoord && values_[normal].count > 0 && values_[normal].firstLineWith == 0;
    return isLikely ? "; if it counts normals, write v//vn" : "";
}

void ObjScanner::checkLength(std::size_t length) const {
    if (length > kMaxLineBytes)
        failHere("this line has more than {}, the most that is read of one; is this an OBJ file?",
                 humanBytes(kMaxLineBytes));
}

/// `t name ints/floats/strings`, then as many words of each type.
void ObjScanner::scanTag() {
    if (words_.size() < 2) failHere("a tag is 't name ints/floats/strings values...'");
    const std::array<std::size_t, 3> counts = scanTagSizes(words_[1]);
    const std::size_t expected = counts[0] + counts[1] + counts[2];
    const std::span<const std::string_view> values = std::span(words_).subspan(2);
    if (values.size() != expected)
        failHere("tag {} announces {} values, {} follow", inQuotes(words_[0]), expected, values.size());

    ObjTag tag{.line = line_, .name = std::string(words_[0]), .ints = {}, .floats = {}, .strings = {}};
    for (const std::string_view word : values.first(counts[0])) {
        const std::optional<int> value = parseNumber<int>(word);
        if (!value) failHere("{} is not a whole number", inQuotes(word));
        tag.ints.push_back(*value);
    }
    for (const std::string_view word : values.subspan(counts[0], counts[1])) tag.floats.push_back(scanFloat(word));
    for (const std::string_view word : values.last(counts[2])) tag.strings.emplace_back(word);
    result_.tags.push_back(std::move(tag));
}

std::array<std::size_t, 3> ObjScanner::scanTagSizes(std::string_view sizes) const {
    std::array<std::size_t, 3> counts{};
    std::string_view rest = sizes;
    for (int type = 0; type < 3; ++type) {
        const std::string_view field = rest.substr(0, rest.find('/'));
        const std::optional<std::uint32_t> count = parseNumber<std::uint32_t>(field);
        const bool isLast = field.size() == rest.size();
        if (!count || isLast != (type == 2))
            failHere("{} are not the sizes of a tag; write ints/floats/strings, such as 2/1/0", inQuotes(sizes));
        counts[type] = *count;
        rest.remove_prefix(isLast ? field.size() : field.size() + 1);
    }
    return counts;
}

/// A number that is finite as a float.
float ObjScanner::scanFloat(std::string_view word) const {
    const std::optional<double> value = parseNumber<double>(word);
    if (!value || !std::isfinite(float(*value)))
        failHere("{} is not a finite number; write digits with a decimal point", inQuotes(word));
    return float(*value);
}

double ObjScanner::scanCoordinate(std::string_view word) const {
    const std::optional<double> value = parseNumber<double>(word);
    if (!value || !std::isfinite(*value))
        failHere("{} is not a finite number; write digits with a decimal point", inQuotes(word));
    if (std::abs(*value) > kFarthestCoordinate)
        failHere("{} is too far from the origin; up to {} is possible", inQuotes(word), kFarthestCoordinate);
    return *value;
}

void ObjScanner::splitWords(std::string_view rest) {
    words_.clear();
    while (!rest.empty() && rest[0] != '#') {
        words_.push_back(firstWord(rest));
        rest = trimmed(rest.substr(words_.back().size()));
    }
}

void ObjScanner::keepWords(std::string_view keyword) {
    result_.text.append(keyword);
    if (keyword == "v") {
        result_.text.append(" 0 0 0\n"); // its place in the order of lines is all that is needed
        return;
    }
    for (const std::string_view word : words_) result_.text.append(" ").append(word);
    result_.text.push_back('\n');
}

void ObjScanner::warnOnce(std::string_view keyword) {
    if (warnedOf_.emplace(keyword).second)
        warn_(fmt::format("{}:{}: lines {} are not read", name_, line_, inQuotes(keyword)));
}

/// Subdivision needs no normals: faulty ones are no reason to refuse a cage.
void ObjScanner::finishNormals() {
    const Values& normals = values_[normal];
    if (lostNormal_.empty() && normals.largestIndex > normals.count)
        lostNormal_ = fmt::format("{}:{}: normal index {} does not exist, there are {}", name_,
                                  normals.largestIndexLine, normals.largestIndex, normals.count);
    if (!lostNormal_.empty())
        warn_(lostNormal_ + "; all normals are dropped");
    else if (normals.firstLineWith != 0 && normals.firstLineWithout != 0)
        warn_(fmt::format("{}:{}: this face has no normals but others have; all normals are dropped", name_,
                          normals.firstLineWithout));
    result_.normalCount = normals.count;
    result_.hasNormals = normals.firstLineWith != 0 && normals.firstLineWithout == 0 && lostNormal_.empty();
}

void ObjScanner::finishFaces() {
    const FaultyFaces &lost = degenerate_, &repeating = repeating_;
    if (lost.count > 0) {
        const std::string fault =
            lost.vertex == 0 ? "has fewer than 3 corners" : fmt::format("uses vertex {} twice", lost.vertex);
        if (lost.count == result_.faceCount) // nothing is left
            failAtLine(name_, lost.firstLine, "this face {}, and all {} faces are degenerate; a face needs 3 vertices",
                       fault, lost.count);
        warn_(fmt::format("{}:{}: face {} (from 0) {}: degenerate faces are dropped, {} in all", name_, lost.firstLine,
                          lost.first, fault, lost.count));
    }
    if (repeating.count > 0)
        warn_(fmt::format("{}:{}: face {} (from 0) names vertex {} twice in a row: repeated corners are dropped, of {} "
                          "faces in all",
                          name_, repeating.firstLine, repeating.first, repeating.vertex, repeating.count));
}

void ObjScanner::finish() {
    for (const Kind kind : {position, texCoord}) {
        const Values& values = values_[kind];
        if (values.largestIndex > values.count)
            failAtLine(name_, values.largestIndexLine, "{} index {} does not exist; there are {}{}", kKindNames[kind],
                       values.largestIndex, values.count, slashHint(kind));
    }
    finishFaces();
    finishNormals();
    const Values& texCoords = values_[texCoord];
    if (texCoords.firstLineWith != 0 && texCoords.firstLineWithout != 0)
        result_.missingTexCoords =
            fmt::format("{}:{}: this face has no texture coordinates at some corner, others have", name_,
                        texCoords.firstLineWithout);
    result_.vertexCount = values_[position].count;
    result_.texCoordCount = texCoords.count;
    result_.hasTexCoords = texCoords.firstLineWith != 0 && texCoords.firstLineWithout == 0;
}

} // namespace

std::string inQuotes(std::string_view word) {
    constexpr std::size_t kLongest = 40;
    std::string text = "'" + std::string(word.substr(0, kLongest)) + (word.size() > kLongest ? "...'" : "'");
    for (char& letter : text)
        if (static_cast<unsigned char>(letter) < ' ' || letter == '\x7f') letter = '?';
    return text;
}

ObjScan scanObj(std::string_view text, const std::string& name, const Warn& warn) {
    return ObjScanner(name, warn).scan(text);
}

} // namespace relief
