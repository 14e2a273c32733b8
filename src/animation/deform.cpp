// Deformers, one after another: their text, and the animation that they make.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "animation/animation.h"
#include "animation/arithmetic.h"
#include "animation/deformers.h"

namespace relief {
namespace {

constexpr double kStandInSeconds = 4; ///< the range of keys of a motion that has no end
constexpr double kFarthest = 1e6; ///< diagonals of the box that a point may move: floats do not separate points there

struct Deformer {
    const DeformerKind* kind = nullptr;
    std::size_t column = 0;
    std::vector<Arithmetic> values; ///< one per value of the kind
    std::vector<std::string> texts; ///< of values that are given
};

template <typename Kind>
std::vector<std::string> namesOf(const std::vector<Kind>& kinds) {
    std::vector<std::string> names;
    names.reserve(kinds.size());
    for (const Kind& kind : kinds) names.push_back(kind.name);
    return names;
}

// --- reading -----------------------------------------------------------------------------------------------------

constexpr double kNextAxis = 3; ///< until the deformer's own axis is known

Arithmetic constantValue(double number) { return {.steps = {Step::number}, .numbers = {number}}; }

Arithmetic readAxis(TextReader& text) {
    const std::vector<std::string> names = {"x", "y", "z", "next"};
    TextReader before = text;
    const std::string_view word = text.takeWord();
    if (word.empty()) text.failExpecting("an axis: x, y, z or next");
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) before.failUnknown(word, "axis", names);
    return constantValue(double(found - names.begin()));
}

Arithmetic readValue(const ValueKind& kind, TextReader& text) {
    return kind.isAxis ? readAxis(text) : readArithmetic(text);
}

/// The kind whose name comes next.
template <typename Kind>
std::size_t takeName(const std::vector<Kind>& kinds, const std::string& what, TextReader& text) {
    const std::vector<std::string> names = namesOf(kinds);
    TextReader before = text;
    const std::string_view word = text.takeWord();
    if (word.empty()) text.failExpecting(fmt::format("a {}: {}", what, fmt::join(names, ", ")));
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) before.failUnknown(word, what, names);
    return std::size_t(found - names.begin());
}

/// "angle=90*t, axis=x", up to the closing parenthesis.
void readGivenValues(Deformer& deformer, TextReader& text) {
    const std::vector<ValueKind>& kinds = deformer.kind->values;
    while (!text.take(')')) {
        const std::size_t column = text.column();
        const std::size_t value = takeName(kinds, "value of " + deformer.kind->name, text);
        if (!deformer.values[value].steps.empty()) failAtColumn(column, "{} is given twice", kinds[value].name);
        if (!text.take('=')) text.failExpecting(fmt::format("'=' after {}", kinds[value].name));
        const std::size_t start = text.column();
        deformer.values[value] = readValue(kinds[value], text);
        deformer.texts[value] = text.takenSince(start);
        if (text.take(')')) return;
        if (!text.take(',')) text.failExpecting(kinds[value].isAxis ? "',' or ')'" : "an operator, ',' or ')'");
    }
}

/// The first axis is the deformer's own; others must differ from it.
void settleAxes(Deformer& deformer) {
    const std::vector<ValueKind>& kinds = deformer.kind->values;
    if (!kinds.front().isAxis) return;
    double& own = deformer.values.front().numbers.front();
    if (own == kNextAxis)
        failAtColumn(deformer.column, "{} of {} is x, y or z", kinds.front().name, deformer.kind->name);
    for (std::size_t i = 1; i < kinds.size(); ++i) {
        if (!kinds[i].isAxis) continue;
        double& other = deformer.values[i].numbers.front();
        if (other == kNextAxis) other = int(own + 1) % 3;
        if (other == own)
            failAtColumn(deformer.column, "{} and {} of {} are the same axis; choose two", kinds.front().name,
                         kinds[i].name, deformer.kind->name);
    }
}

Deformer readDeformer(TextReader& text) {
    Deformer deformer{.column = text.column()};
    deformer.kind = &deformerKinds()[takeName(deformerKinds(), "deformer", text)];
    deformer.values.resize(deformer.kind->values.size());
    deformer.texts.resize(deformer.kind->values.size());
    if (!text.take('(')) text.failExpecting(fmt::format("'(' after {}", deformer.kind->name));
    readGivenValues(deformer, text);
    for (std::size_t i = 0; i < deformer.values.size(); ++i) {
        TextReader standard(deformer.kind->values[i].standard);
        if (deformer.values[i].steps.empty()) deformer.values[i] = readValue(deformer.kind->values[i], standard);
    }
    settleAxes(deformer);
    return deformer;
}

std::vector<Deformer> readDeformers(const std::string& expression) {
    TextReader text(expression);
    std::vector<Deformer> deformers;
    do deformers.push_back(readDeformer(text));
    while (!text.isAtEnd());
    return deformers;
}

// --- posing ------------------------------------------------------------------------------------------------------

/// The box around the faces of a cage, in the coordinates of the poses that are deformed.
Bounds boxOf(const Cage& cage, const Coordinates& coordinates) {
    const Bounds box = computeBounds(cage.corners, [&](std::uint32_t point) { return cage.positions[point]; });
    if (coordinates == cage.coordinates) return box;
    const Bounds world = cage.coordinates.toWorld(box);
    return {.lower = coordinates.toLocal(world.lower), .upper = coordinates.toLocal(world.upper)};
}

double valueAt(const Deformer& deformer, std::size_t index, double t) {
    const ValueKind& kind = deformer.kind->values[index];
    const double value = deformer.values[index].at(t);
    const auto failWith = [&](const std::string& need) {
        fail(Failure::usage, "deformers: column {}: {} of {} is {} at t = {} seconds; {}", deformer.column, kind.name,
             deformer.kind->name, value, t, need);
    };
    if (!std::isfinite(value)) failWith("a finite number is needed");
    if (value <= kind.above) failWith(fmt::format("it must be above {}", kind.above));
    if (value >= kind.below) failWith(fmt::format("it must be below {}", kind.below));
    return value;
}

Move moveAt(const Deformer& deformer, const Bounds& box, double t) {
    std::vector<double> values;
    for (std::size_t i = 0; i < deformer.values.size(); ++i) values.push_back(valueAt(deformer, i, t));
    return deformer.kind->make({.box = box, .values = values, .seconds = t});
}

bool movesWithTime(const Deformer& deformer) {
    for (const Arithmetic& value : deformer.values)
        if (value.usesTime()) return true;
    return deformer.kind->speedValue >= 0 && deformer.values[std::size_t(deformer.kind->speedValue)].at(0) != 0;
}

class DeformedAnimation : public Animation {
public:
    DeformedAnimation(std::unique_ptr<Animation> base, const Bounds& box, std::vector<Deformer> deformers)
        : Animation(base->coordinates()), base_(std::move(base)), box_(box), deformers_(std::move(deformers)) {}

    [[nodiscard]] Pose pose(double seconds) const override;
    [[nodiscard]] dvec2 keyRange() const override;

private:
    [[noreturn]] static void failToHold(std::size_t point, const dvec3& p, double seconds) {
        fail(Failure::usage, "deformers: point {} goes to ({} {} {}) at t = {} seconds; use smaller values", point, p.x,
             p.y, p.z, seconds);
    }

    std::unique_ptr<Animation> base_;
    Bounds box_;
    std::vector<Deformer> deformers_;
};

Pose DeformedAnimation::pose(double seconds) const {
    std::vector<Move> moves;
    for (const Deformer& deformer : deformers_)
        if (Move move = moveAt(deformer, box_, seconds)) moves.push_back(std::move(move));

    Pose pose{.positions = posedPositions(base_->rig(), base_->pose(seconds)), .joints = {}, .morphWeights = {}};
    for (std::size_t i = 0; i < pose.positions.size(); ++i) {
        const dvec3 before(pose.positions[i]);
        dvec3 p = before;
        for (const Move& move : moves) p = move(p);
        if (!(glm::length(p - before) <= kFarthest * box_.diagonal())) failToHold(i, coordinates().toWorld(p), seconds);
        pose.positions[i] = p;
    }
    return pose;
}

dvec2 DeformedAnimation::keyRange() const {
    const dvec2 range = base_->keyRange();
    if (std::none_of(deformers_.begin(), deformers_.end(), movesWithTime)) return range;
    return {std::min(range.x, 0.0), std::max(range.y, kStandInSeconds)};
}

} // namespace

std::unique_ptr<Animation> deform(std::unique_ptr<Animation> base, const Cage& cage, const std::string& expression) {
    const Bounds box = boxOf(cage, base->coordinates());
    return std::make_unique<DeformedAnimation>(std::move(base), box, readDeformers(expression));
}

std::vector<DeformerText> parseDeformers(const std::string& expression) {
    std::vector<DeformerText> texts;
    for (const Deformer& deformer : readDeformers(expression)) {
        DeformerText& text = texts.emplace_back(DeformerText{.name = deformer.kind->name, .values = {}});
        for (std::size_t i = 0; i < deformer.texts.size(); ++i) {
            const std::string& given = deformer.texts[i];
            const ValueKind& kind = deformer.kind->values[i];
            DeformerValue value{.name = kind.name, .text = given.empty() ? kind.standard : given};
            value.isGiven = !given.empty();
            char* end = nullptr;
            const double number = std::strtod(value.text.c_str(), &end);
            if (!kind.isAxis && *end == 0) value.number = number;
            text.values.push_back(value);
        }
    }
    return texts;
}

std::string toExpression(std::span<const DeformerText> deformers) {
    std::vector<std::string> all;
    for (const DeformerText& deformer : deformers) {
        std::vector<std::string> values;
        for (const DeformerValue& value : deformer.values)
            if (value.isGiven) values.push_back(value.name + "=" + value.text);
        all.push_back(fmt::format("{}({})", deformer.name, fmt::join(values, ", ")));
    }
    return fmt::format("{}", fmt::join(all, " "));
}

std::string deformerHelp() {
    std::string help;
    for (const DeformerKind& kind : deformerKinds()) {
        std::vector<std::string> values;
        for (const ValueKind& value : kind.values) values.push_back(value.name + "=" + value.standard);
        help += fmt::format("  {}({})\n      {}\n", kind.name, fmt::join(values, ", "), kind.help);
    }
    return help + "Values have these defaults. The box is that of the cage at rest, deformers work from its centre.\n"
                  "Axes are x, y, z or next (the one after `axis`). Other values are arithmetic over t, the seconds:\n"
                  "numbers, pi, + - * / ^, parentheses, sin cos abs (radians), min(a, b), max(a, b).\n";
}

} // namespace relief
