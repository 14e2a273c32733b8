// `t` lines of OBJ. Layouts (ints/floats/strings), indices from 0 through the whole file:
//   crease 2/1/0 a b sharpness               corner n/1/0 or n/n/0 vertices... sharpnesses...
//   hole n/0/0 faces...                      interpolateboundary 1/0/0 0..2
//   creasemethod 0/0/1 normal|chaikin        facevaryinginterpolateboundary 1/0/0 0..5
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "base/unique_points.h"
#include "cage/edges.h"
#include "cage/obj.h"

namespace relief {

namespace {

class TagReader {
public:
    TagReader(Cage& cage, const std::string& name, const Warn& warn) : cage_(cage), name_(name), warn_(warn) {}
    void read(const ObjTag& tag);

private:
    void readCrease(const ObjTag& tag);
    void addCrease(std::uint32_t a, std::uint32_t b, float sharpness);
    void findUniquePoints();
    void readCorner(const ObjTag& tag);
    void readHole(const ObjTag& tag);
    void readBoundaryRule(const ObjTag& tag);
    void readTexBoundaryRule(const ObjTag& tag);
    void readCreaseMethod(const ObjTag& tag);
    void warnUnknown(const ObjTag& tag);

    void checkSizes(const ObjTag& tag, bool isRight, const char* sizes) const;
    [[nodiscard]] std::uint32_t checkIndex(const ObjTag& tag, int index, std::size_t count, const char* what) const;
    [[nodiscard]] float checkSharpness(const ObjTag& tag, float sharpness) const;
    [[nodiscard]] int checkRule(const ObjTag& tag, int largest) const;
    template <typename Rule>
    void setRule(const ObjTag& tag, Rule& rule, Rule value);

    struct Reader {
        const char* name;
        void (TagReader::*read)(const ObjTag&);
    };
    static constexpr std::array kReaders = {
        Reader{"crease", &TagReader::readCrease},
        Reader{"corner", &TagReader::readCorner},
        Reader{"hole", &TagReader::readHole},
        Reader{"interpolateboundary", &TagReader::readBoundaryRule},
        Reader{"facevaryinginterpolateboundary", &TagReader::readTexBoundaryRule},
        Reader{"creasemethod", &TagReader::readCreaseMethod},
    };

    Cage& cage_;
    const std::string& name_;
    const Warn& warn_;
    std::vector<EdgeUse> edges_; ///< filled at the first crease
    /// Files repeat vertices along seams, so that a crease may name the two ends of an edge in different faces. Per
    /// vertex the first one at its position, and edges by those of their ends; filled when a crease first needs them.
    std::vector<std::uint32_t> firstAtPosition_;
    std::multimap<std::uint64_t, std::uint64_t> edgesByPosition_;
    std::map<std::uint64_t, std::size_t> creaseOf_; ///< edge key -> index of its crease
    std::map<std::uint32_t, std::size_t> sharpOf_;  ///< vertex -> index of its sharpness
    std::map<std::string, std::size_t> lineOf_;     ///< of the rules set so far
    std::set<std::string> warnedOf_;
};

void TagReader::read(const ObjTag& tag) {
    const auto found =
        std::find_if(kReaders.begin(), kReaders.end(), [&](const Reader& reader) { return reader.name == tag.name; });
    if (found == kReaders.end()) return warnUnknown(tag);
    (this->*found->read)(tag);
}

void TagReader::readCrease(const ObjTag& tag) {
    checkSizes(tag, tag.ints.size() == 2 && tag.floats.size() == 1 && tag.strings.empty(), "2/1/0: one edge per tag");
    if (edges_.empty()) edges_ = sortedEdgeUses(cage_);
    const std::uint32_t a = checkIndex(tag, tag.ints[0], cage_.positions.size(), "vertex");
    const std::uint32_t b = checkIndex(tag, tag.ints[1], cage_.positions.size(), "vertex");
    const float sharpness = checkSharpness(tag, tag.floats[0]);
    if (hasEdge(edges_, a, b)) return addCrease(a, b, sharpness);
    if (edgesByPosition_.empty()) findUniquePoints();
    const auto [first, end] = edgesByPosition_.equal_range(edgeKey(firstAtPosition_[a], firstAtPosition_[b]));
    if (first == end)
        failAtLine(name_, tag.line, "no face has an edge between vertices {} and {} (counted from 0)", a, b);
    for (auto edge = first; edge != end; ++edge)
        addCrease(std::uint32_t(edge->second >> 32), std::uint32_t(edge->second), sharpness);
}

/// The last sharpness of an edge holds.
void TagReader::addCrease(std::uint32_t a, std::uint32_t b, float sharpness) {
    const auto [crease, isNew] = creaseOf_.try_emplace(edgeKey(a, b), cage_.creaseSharpness.size());
    if (!isNew) {
        cage_.creaseSharpness[crease->second] = sharpness;
        return;
    }
    cage_.creaseEdges.insert(cage_.creaseEdges.end(), {a, b});
    cage_.creaseSharpness.push_back(sharpness);
}

void TagReader::findUniquePoints() {
    const UniquePoints unique = relief::findUniquePoints(cage_.positions);
    for (const std::uint32_t point : unique.indices) firstAtPosition_.push_back(unique.firsts[point]);
    for (std::size_t i = 0; i < edges_.size(); ++i) {
        const std::uint64_t key = edges_[i].key;
        if (i > 0 && edges_[i - 1].key == key) continue;
        edgesByPosition_.emplace(edgeKey(firstAtPosition_[key >> 32], firstAtPosition_[std::uint32_t(key)]), key);
    }
}

void TagReader::readCorner(const ObjTag& tag) {
    const std::size_t count = tag.ints.size();
    const bool isRight = count > 0 && (tag.floats.size() == 1 || tag.floats.size() == count) && tag.strings.empty();
    checkSizes(tag, isRight, "1/1/0, or n/n/0 for n vertices");
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t vertex = checkIndex(tag, tag.ints[i], cage_.positions.size(), "vertex");
        const float sharpness = checkSharpness(tag, tag.floats[tag.floats.size() == 1 ? 0 : i]);
        const auto [corner, isNew] = sharpOf_.try_emplace(vertex, cage_.sharpVertices.size());
        if (!isNew) {
            cage_.vertexSharpness[corner->second] = sharpness;
            continue;
        }
        cage_.sharpVertices.push_back(vertex);
        cage_.vertexSharpness.push_back(sharpness);
    }
}

void TagReader::readHole(const ObjTag& tag) {
    const bool isRight = !tag.ints.empty() && tag.floats.empty() && tag.strings.empty();
    checkSizes(tag, isRight, "1/0/0, or n/0/0 for n faces");
    for (const int face : tag.ints) cage_.holes.push_back(checkIndex(tag, face, cage_.faceCount(), "face"));
}

void TagReader::readBoundaryRule(const ObjTag& tag) {
    setRule(tag, cage_.boundaryRule, BoundaryRule(checkRule(tag, int(BoundaryRule::edgeOnly))));
}

void TagReader::readTexBoundaryRule(const ObjTag& tag) {
    setRule(tag, cage_.texBoundaryRule, TexBoundaryRule(checkRule(tag, int(TexBoundaryRule::all))));
}

void TagReader::readCreaseMethod(const ObjTag& tag) {
    checkSizes(tag, tag.ints.empty() && tag.floats.empty() && tag.strings.size() == 1, "0/0/1");
    const std::string& method = tag.strings[0];
    if (method != "normal" && method != "chaikin")
        failAtLine(name_, tag.line, "crease method {} does not exist; use normal or chaikin", inQuotes(method));
    setRule(tag, cage_.creaseMethod, method == "chaikin" ? CreaseMethod::chaikin : CreaseMethod::uniform);
}

void TagReader::warnUnknown(const ObjTag& tag) {
    if (!warnedOf_.insert(tag.name).second) return;
    const bool isEdit = tag.name.ends_with("edit");
    warn_(fmt::format("{}:{}: {} {} ignored", name_, tag.line, isEdit ? "hierarchical edit" : "unknown tag",
                      inQuotes(tag.name)));
}

void TagReader::checkSizes(const ObjTag& tag, bool isRight, const char* sizes) const {
    if (!isRight)
        failAtLine(name_, tag.line, "tag '{}' has sizes {}/{}/{}; it takes {}", tag.name, tag.ints.size(),
                   tag.floats.size(), tag.strings.size(), sizes);
}

std::uint32_t TagReader::checkIndex(const ObjTag& tag, int index, std::size_t count, const char* what) const {
    if (index < 0 || std::size_t(index) >= count)
        failAtLine(name_, tag.line, "{} {} does not exist; tags count from 0 to {}", what, index,
                   std::ptrdiff_t(count) - 1);
    return std::uint32_t(index);
}

float TagReader::checkSharpness(const ObjTag& tag, float sharpness) const {
    if (sharpness < 0)
        failAtLine(name_, tag.line, "sharpness {} is negative; use 0 (smooth) to 10 (infinitely sharp)", sharpness);
    return sharpness;
}

int TagReader::checkRule(const ObjTag& tag, int largest) const {
    checkSizes(tag, tag.ints.size() == 1 && tag.floats.empty() && tag.strings.empty(), "1/0/0");
    if (tag.ints[0] < 0 || tag.ints[0] > largest)
        failAtLine(name_, tag.line, "{} {} does not exist; use 0 to {}", tag.name, tag.ints[0], largest);
    return tag.ints[0];
}

/// Objects of one file may carry rules of their own, but a cage has one of each.
template <typename Rule>
void TagReader::setRule(const ObjTag& tag, Rule& rule, Rule value) {
    const auto [line, isNew] = lineOf_.try_emplace(tag.name, tag.line);
    if (!isNew && rule != value)
        warn_(fmt::format("{}:{}: '{}' differs from line {}; this one holds for the whole cage", name_, tag.line,
                          tag.name, line->second));
    rule = value;
    line->second = tag.line;
}

} // namespace

void applyObjTags(const std::vector<ObjTag>& tags, Cage& cage, const std::string& name, const Warn& warn) {
    TagReader reader(cage, name, warn);
    for (const ObjTag& tag : tags) reader.read(tag);
    std::sort(cage.holes.begin(), cage.holes.end());
    cage.holes.erase(std::unique(cage.holes.begin(), cage.holes.end()), cage.holes.end());
}

} // namespace relief
