#include "formula/isolate.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <set>

#include "formula/tokens.h"

namespace relief {
namespace {

constexpr int kMostElements = 1024; ///< of an array: drivers compile large ones for minutes

constexpr std::array kAllowedDirectives = {"define", "undef", "if",    "ifdef", "ifndef",
                                           "elif",   "else",  "endif", "error"};
constexpr std::array kRefusedWords = {"layout", "uniform", "buffer", "shared", "main", "attribute", "varying", "double",
                                      "dvec2", "dvec3", "dvec4", "discard", "subroutine", "barrier", "memoryBarrier",
                                      // Derivatives are of pixels, and surfaces are evaluated at points.
                                      "dFdx", "dFdy", "fwidth", "dFdxFine", "dFdyFine", "fwidthFine", "dFdxCoarse",
                                      "dFdyCoarse", "fwidthCoarse"};

bool isOneOf(std::span<const char* const> words, std::string_view word) {
    return std::ranges::any_of(words, [&](const char* other) { return word == other; });
}

/// Components of vectors: they are no names of their own after a point.
bool isSwizzle(std::string_view word) {
    const auto isOf = [&](std::string_view letters) {
        return word.size() <= 4 && word.find_first_not_of(letters) == std::string_view::npos;
    };
    return isOf("xyzw") || isOf("rgba") || isOf("stpq");
}

class Isolator {
public:
    explicit Isolator(const FunctionText& function)
        : file_(function.name), tokens_(readTokens(function.text)), inserted_(tokens_.size() + 1) {
        for (std::size_t i = 0; i < tokens_.size(); ++i)
            if (tokens_[i].kind != TokenKind::space) order_.push_back(i);
    }

    IsolatedText isolate() {
        checkLetters();
        checkDirectives();
        checkPairs(tokens_, file_);
        checkWords();
        checkArrays();
        findDeclarations();
        if (!functions_.contains("height"))
            fail(Failure::input, "{}: there is no function float height(vec3 p, vec2 st, float t)", file_);
        checkExpansion(withoutSpace(), file_);
        countTurns();
        return {write(), names_.contains("kBound")};
    }

private:
    // Tokens without spaces and comments, by their order; an empty one past both ends.
    [[nodiscard]] const Token& token(std::size_t i) const {
        static const Token none;
        return i < order_.size() ? tokens_[order_[i]] : none;
    }
    [[nodiscard]] bool is(std::size_t i, std::string_view text) const { return token(i).text == text; }

    [[nodiscard]] std::vector<Token> withoutSpace() const {
        std::vector<Token> tokens;
        for (const std::size_t i : order_) tokens.push_back(tokens_[i]);
        return tokens;
    }

    /// Outside of comments and #error GLSL is ASCII.
    void checkLetters() const {
        const auto isOfLetter = [](const Token& t) { return t.kind == TokenKind::sign && (t.text[0] & '\x80') != 0; };
        for (std::size_t i = 0; i < order_.size(); ++i) {
            if (is(i, "#") && is(i + 1, "error"))
                while (token(i + 1).isOfDirective) ++i;
            if (!isOfLetter(token(i))) continue;
            // The bytes of one letter, as far as they are there.
            std::string bytes(token(i).text);
            for (std::size_t k = i + 1; k < order_.size() && isOfLetter(token(k)) && (token(k).text[0] & '\x40') == 0;
                 ++k)
                bytes += token(k).text;
            const auto first = static_cast<unsigned char>(bytes[0]);
            const std::size_t expected = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : first >= 0xc0 ? 2 : 0;
            fail(Failure::input, "{}:{}: {} is no letter of GLSL, which is written in ASCII", file_, token(i).line,
                 bytes.size() == expected ? fmt::format("'{}'", bytes) : fmt::format("the byte {:#x}", first));
        }
    }

    void checkDirectives() const {
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const bool isStart = is(i, "#") && token(i).isOfDirective && (i == 0 || token(i - 1).line < token(i).line);
            const bool isWord = token(i + 1).kind == TokenKind::word && token(i + 1).line == token(i).line;
            if (isStart && isWord && !isOneOf(kAllowedDirectives, token(i + 1).text))
                fail(Failure::input, "{}:{}: a height function cannot have #{}", file_, token(i).line,
                     token(i + 1).text);
        }
    }

    void checkWords() const {
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const Token& t = token(i);
            if (t.isOfDirective && is(i, "#") && is(i + 1, "#"))
                fail(Failure::input, "{}:{}: a macro of a height function cannot have ##", file_, t.line);
            if (t.kind != TokenKind::word) continue;
            const bool isLoop = t.text == "for" || t.text == "while" || t.text == "do";
            if (t.isOfDirective && isLoop)
                fail(Failure::input, "{}:{}: a macro of a height function cannot have loops", file_, t.line);
            if (isOneOf(kRefusedWords, t.text) || t.text.starts_with("gl_") || t.text.starts_with(kFunctionPrefix))
                fail(Failure::input, "{}:{}: a height function cannot have {}: it is given p, st and t alone", file_,
                     t.line, t.text);
        }
    }

    void checkArrays() const {
        for (std::size_t i = 0; i + 1 < order_.size(); ++i) {
            if (!is(i, "[") || token(i + 1).kind != TokenKind::number) continue;
            const std::string size(token(i + 1).text);
            if (std::strtod(size.c_str(), nullptr) > kMostElements)
                fail(Failure::input, "{}:{}: an array of a height function cannot have {} elements, {} are the most",
                     file_, token(i).line, size, kMostElements);
        }
    }

    /// Names that are declared outside of all braces, and macros.
    void findDeclarations() {
        int depth = 0;
        bool isConstant = false; // the statement outside of all braces
        for (std::size_t i = 0; i < order_.size(); ++i) {
            if (token(i).isOfDirective) {
                if (is(i, "define")) names_.insert(token(i + 1).text);
                continue;
            }
            if (is(i, "{") || is(i, "(")) ++depth;
            if (is(i, "}") || is(i, ")")) --depth;
            if (depth == 0 && (is(i, ";") || is(i, "}"))) isConstant = false;
            isConstant = isConstant || is(i, "const");
            if (depth > 0 || token(i).kind != TokenKind::word) continue;
            if (is(i, "precision")) // a statement of three words that declares nothing
                i += 2;
            else if (isDeclared(i))
                names_.insert(token(i).text), checkConstant(i, isConstant);
            if (is(i, "struct")) names_.insert(token(i + 1).text);
            if (is(i + 1, "(") && names_.contains(token(i).text)) functions_.insert(token(i).text);
        }
    }

    void checkConstant(std::size_t i, bool isConstant) const {
        if (!isConstant && !is(i + 1, "("))
            fail(Failure::input, "{}:{}: {} has to be const: a height function keeps nothing from one call to the next",
                 file_, token(i).line, token(i).text);
    }

    /// A word after its type, or after another one, before what ends a declarator.
    [[nodiscard]] bool isDeclared(std::size_t i) const {
        if (i == 0) return false;
        const Token &before = token(i - 1), &after = token(i + 1);
        const bool followsType = before.kind == TokenKind::word || is(i - 1, "]") || is(i - 1, "}") || is(i - 1, ",");
        return followsType && after.text.size() == 1 && std::string_view("(=;[,").find(after.text) != std::string::npos;
    }

    /// Every condition of a loop counts first.
    void countTurns() {
        for (std::size_t i = 0; i + 1 < order_.size(); ++i) {
            const bool isFor = is(i, "for");
            if ((!isFor && !is(i, "while")) || !is(i + 1, "(")) continue;
            // The tokens before and after the condition.
            std::vector<std::size_t> ends{i + 1};
            std::size_t j = i + 2;
            for (int depth = 1; j < order_.size(); ++j) {
                depth += is(j, "(") ? 1 : is(j, ")") ? -1 : 0;
                if (depth == 0 || (isFor && depth == 1 && is(j, ";"))) ends.push_back(j);
                if (depth == 0) break;
            }
            const std::size_t first = isFor ? 1 : 0;
            if (ends.size() != first + 2 + (isFor ? 1 : 0)) continue; // a syntax error that the compiler reports
            const bool isEmpty = ends[first + 1] == ends[first] + 1;
            inserted_[order_[ends[first]] + 1] += isEmpty ? " formula_turn()" : " formula_turn() && (";
            if (!isEmpty) inserted_[order_[ends[first + 1]]] = ")" + inserted_[order_[ends[first + 1]]];
        }
    }

    [[nodiscard]] std::string write() const {
        std::string text;
        std::size_t last = tokens_.size(); // the token before, without spaces
        int structDepth = 0;
        bool isStruct = false;
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            const Token& t = tokens_[i];
            text += inserted_[i];
            isStruct = isStruct || t.text == "struct";
            if (isStruct) structDepth += t.text == "{" ? 1 : t.text == "}" ? -1 : 0;
            if (t.text == "}" && structDepth == 0) isStruct = false;
            const bool isMember = (last < i && tokens_[last].text == ".") || structDepth > 0;
            if (t.kind == TokenKind::word && names_.contains(t.text) && !(isMember && isSwizzle(t.text)))
                text += kFunctionPrefix;
            text += t.text;
            if (t.kind != TokenKind::space) last = i;
        }
        return text + inserted_.back();
    }

    const std::string& file_;
    std::vector<Token> tokens_;
    std::vector<std::size_t> order_;
    std::vector<std::string> inserted_; ///< before each token, and at the end
    std::set<std::string_view> names_, functions_;
};

} // namespace

IsolatedText isolate(const FunctionText& function) {
    const std::size_t zero = function.text.find('\0');
    if (zero != std::string::npos) fail(Failure::input, "{}: byte {} is 0: this is no text", function.name, zero);
    return Isolator(function).isolate();
}

} // namespace relief
