#include "animation/arithmetic.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace relief {
namespace {

constexpr std::size_t kMostLetters = 4096;
constexpr int kDeepestNesting = 64;
constexpr std::size_t kShownLetters = 24; ///< of a word in a message

bool isLetter(char letter) { return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z'); }
bool isDigit(char letter) { return letter >= '0' && letter <= '9'; }
bool isWordLetter(char letter) { return isLetter(letter) || isDigit(letter) || letter == '_'; }
bool isBlank(char letter) { return letter == ' ' || (letter >= '\t' && letter <= '\r'); }

std::string shown(std::string_view word) {
    return word.size() <= kShownLetters ? fmt::format("'{}'", word)
                                        : fmt::format("'{}...'", word.substr(0, kShownLetters));
}

/// The word or the single letter that `rest` starts with, as it may stand in a message.
std::string firstShown(std::string_view rest) {
    if (rest.empty()) return "the end";
    const auto end = std::find_if_not(rest.begin(), rest.end(), isWordLetter);
    if (end != rest.begin()) return shown(rest.substr(0, std::size_t(end - rest.begin())));
    const auto letter = static_cast<unsigned char>(rest.front());
    return letter > ' ' && letter < 127 ? fmt::format("'{}'", rest.front()) : fmt::format("the byte {:#04x}", letter);
}

// --- reading -----------------------------------------------------------------------------------------------------

struct Function {
    const char* name;
    Step step;
    int operandCount;
};
constexpr Function kFunctions[] = {
    {"sin", Step::sin, 1}, {"cos", Step::cos, 1}, {"abs", Step::abs, 1}, {"min", Step::min, 2}, {"max", Step::max, 2}};

/// One function per level of the grammar, from the operators that bind loosest.
class ArithmeticReader {
public:
    explicit ArithmeticReader(TextReader& text) : text_(text) {}

    void readSum() {
        readProduct();
        for (;;) {
            if (text_.take('+'))
                readProduct(), put(Step::add);
            else if (text_.take('-'))
                readProduct(), put(Step::subtract);
            else
                return;
        }
    }

    Arithmetic result;

private:
    void readProduct() {
        readSigned();
        for (;;) {
            if (text_.take('*'))
                readSigned(), put(Step::multiply);
            else if (text_.take('/'))
                readSigned(), put(Step::divide);
            else
                return;
        }
    }

    void readSigned() { // everything that nests is read through this function
        if (++nesting_ > kDeepestNesting)
            failAtColumn(text_.column(), "parentheses, signs and powers are nested more than {} deep", kDeepestNesting);
        if (text_.take('-'))
            readSigned(), put(Step::negate);
        else if (text_.take('+'))
            readSigned();
        else
            readPower();
        --nesting_;
    }

    void readPower() {
        readOperand();
        if (text_.take('^')) readSigned(), put(Step::power);
    }

    void readOperand() {
        if (text_.take('(')) {
            readSum();
            close();
        } else if (const std::optional<double> number = text_.takeNumber()) {
            putNumber(*number);
        } else {
            readNamed();
        }
    }

    void readNamed();

    void close() {
        if (!text_.take(')')) text_.failExpecting("an operator (+ - * / ^) or ')'");
    }

    void put(Step step) { result.steps.push_back(step); }
    void putNumber(double number) { put(Step::number), result.numbers.push_back(number); }

    TextReader& text_;
    int nesting_ = 0;
};

void ArithmeticReader::readNamed() {
    TextReader before = text_;
    const std::string_view word = text_.takeWord();
    if (word.empty()) text_.failExpecting("a number, t, pi, '(', sin, cos, abs, min or max");
    if (word == "t") return put(Step::time);
    if (word == "pi") return putNumber(std::numbers::pi);
    const auto* function = std::find_if(std::begin(kFunctions), std::end(kFunctions),
                                        [&](const Function& candidate) { return word == candidate.name; });
    if (function == std::end(kFunctions))
        before.failUnknown(word, "name in arithmetic", {"t", "pi", "sin", "cos", "abs", "min", "max"});
    if (!text_.take('(')) text_.failExpecting(fmt::format("'(' after {}", word));
    readSum();
    if (function->operandCount == 2) {
        if (!text_.take(',')) text_.failExpecting(fmt::format("an operator or ',' and the second number of {}", word));
        readSum();
    }
    close();
    put(function->step);
}

// --- computing ---------------------------------------------------------------------------------------------------

double computed(Step step, double a) {
    switch (step) {
    case Step::negate: return -a;
    case Step::sin: return std::sin(a);
    case Step::cos: return std::cos(a);
    default: return std::abs(a);
    }
}

double computed(Step step, double a, double b) {
    switch (step) {
    case Step::add: return a + b;
    case Step::subtract: return a - b;
    case Step::multiply: return a * b;
    case Step::divide: return a / b;
    case Step::power: return std::pow(a, b);
    // Comparisons would hide a NaN.
    case Step::min: return std::isnan(a) || a < b ? a : b;
    default: return std::isnan(a) || a > b ? a : b;
    }
}

bool hasOneOperand(Step step) {
    return step == Step::negate || step == Step::sin || step == Step::cos || step == Step::abs;
}

} // namespace

TextReader::TextReader(std::string_view text) : text_(text) {
    if (text.size() > kMostLetters)
        fail(Failure::usage, "deformers: the text has {} letters; up to {} are possible", text.size(), kMostLetters);
}

void TextReader::skipBlanks() {
    while (next_ < text_.size() && isBlank(text_[next_])) ++next_;
}

bool TextReader::isAtEnd() {
    skipBlanks();
    return next_ == text_.size();
}

std::string_view TextReader::takenSince(std::size_t column) const {
    std::string_view taken = text_.substr(column - 1, next_ - (column - 1));
    while (!taken.empty() && isBlank(taken.back())) taken.remove_suffix(1);
    return taken;
}

std::size_t TextReader::column() {
    skipBlanks();
    return next_ + 1;
}

bool TextReader::take(char letter) {
    const bool isThere = !isAtEnd() && text_[next_] == letter;
    if (isThere) ++next_;
    return isThere;
}

std::string_view TextReader::takeWord() {
    if (isAtEnd() || !isLetter(text_[next_])) return {};
    const std::size_t first = next_;
    while (next_ < text_.size() && isWordLetter(text_[next_])) ++next_;
    return text_.substr(first, next_ - first);
}

std::optional<double> TextReader::takeNumber() {
    if (isAtEnd() || !(isDigit(text_[next_]) || text_[next_] == '.')) return std::nullopt;
    double number = 0;
    const auto [end, error] = std::from_chars(text_.data() + next_, text_.data() + text_.size(), number);
    if (error == std::errc::invalid_argument) return std::nullopt; // a lone point
    if (error == std::errc::result_out_of_range)
        failAtColumn(column(), "the number is too large or too small; 1e-307 to 1e308 are possible");
    next_ = std::size_t(end - text_.data());
    return number;
}

void TextReader::failExpecting(const std::string& expected) {
    const std::size_t here = column();
    failAtColumn(here, "found {}, expected {}", firstShown(text_.substr(next_)), expected);
}

void TextReader::failUnknown(std::string_view word, const std::string& what, const std::vector<std::string>& known) {
    const std::string near = nearestWord(word, known);
    failAtColumn(column(), "found {}, which is no {}: {}{}", shown(word), what, fmt::join(known, ", "),
                 near.empty() ? "" : fmt::format(" (did you mean '{}'?)", near));
}

bool Arithmetic::usesTime() const { return std::find(steps.begin(), steps.end(), Step::time) != steps.end(); }

double Arithmetic::at(double t) const {
    std::vector<double> stack;
    std::size_t number = 0;
    for (const Step step : steps) {
        if (step == Step::number) {
            stack.push_back(numbers[number++]);
        } else if (step == Step::time) {
            stack.push_back(t);
        } else if (hasOneOperand(step)) {
            stack.back() = computed(step, stack.back());
        } else {
            const double second = stack.back();
            stack.pop_back();
            stack.back() = computed(step, stack.back(), second);
        }
    }
    return stack.back();
}

Arithmetic readArithmetic(TextReader& text) {
    ArithmeticReader reader(text);
    reader.readSum();
    return std::move(reader.result);
}

} // namespace relief
