#include "formula/tokens.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include "base/base.h"

namespace relief {
namespace {

bool isWordLetter(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

class Lexer {
public:
    explicit Lexer(std::string_view text) : text_(text) {}

    std::vector<Token> read() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (at(0) == '/' && at(1) == '/') {
                add(TokenKind::space, std::min(text_.find('\n', at_), text_.size()));
            } else if (at(0) == '/' && at(1) == '*') {
                const std::size_t end = text_.find("*/", at_ + 2);
                add(TokenKind::space, end == std::string_view::npos ? text_.size() : end + 2);
            } else if (std::isspace(static_cast<unsigned char>(c)) != 0) {
                if (c == '\n' && !isContinued()) isDirective_ = false, isLineStart_ = true;
                add(TokenKind::space, at_ + 1);
            } else if (isDigit(c) || (c == '.' && isDigit(at(1)))) {
                add(TokenKind::number, numberEnd());
            } else if (isWordLetter(c)) {
                add(TokenKind::word, wordEnd(at_));
            } else {
                isDirective_ = isDirective_ || (c == '#' && isLineStart_);
                add(TokenKind::sign, at_ + 1);
            }
        }
        return std::move(tokens_);
    }

private:
    [[nodiscard]] char at(std::size_t offset) const { return at_ + offset < text_.size() ? text_[at_ + offset] : '\0'; }
    [[nodiscard]] bool isContinued() const {
        const std::size_t last = at_ > 0 && text_[at_ - 1] == '\r' ? 2 : 1;
        return at_ >= last && text_[at_ - last] == '\\';
    }
    [[nodiscard]] std::size_t wordEnd(std::size_t end) const {
        while (end < text_.size() && isWordLetter(text_[end])) ++end;
        return end;
    }
    /// Exponents have signs, and suffixes are letters: what follows a number without a space belongs to it.
    [[nodiscard]] std::size_t numberEnd() const {
        const bool isHexadecimal = at(0) == '0' && (at(1) == 'x' || at(1) == 'X');
        std::size_t end = at_;
        const auto isSign = [&] {
            return !isHexadecimal && (text_[end] == '+' || text_[end] == '-') &&
                   (text_[end - 1] == 'e' || text_[end - 1] == 'E');
        };
        while (end < text_.size() && (isWordLetter(text_[end]) || text_[end] == '.' || isSign())) ++end;
        return end;
    }
    void add(TokenKind kind, std::size_t end) {
        const std::string_view part = text_.substr(at_, end - at_);
        tokens_.push_back({kind, part, line_, isDirective_});
        line_ += int(std::count(part.begin(), part.end(), '\n'));
        isLineStart_ = isLineStart_ && kind == TokenKind::space;
        at_ = end;
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
    bool isDirective_ = false, isLineStart_ = true;
    std::vector<Token> tokens_;
};

/// The brackets of a text that have no other half.
class PairChecker {
public:
    PairChecker(std::span<const Token> tokens, std::string_view file) : file_(file) {
        for (const Token& token : tokens) {
            if (token.kind == TokenKind::space)
                checkComment(token);
            else
                tokens_.push_back(token);
        }
    }

    void check() {
        checkConditionals();
        if (!hasConditionals_ && areMacrosWhole()) checkBrackets();
    }

private:
    void checkComment(const Token& space) const {
        if (space.text.starts_with("/*") && (space.text.size() < 4 || !space.text.ends_with("*/")))
            fail(Failure::input, "{}:{}: the comment that begins here has no end", file_, space.line);
    }

    void checkConditionals() {
        std::vector<int> open; // lines
        for (std::size_t i = 0; i + 1 < tokens_.size(); ++i) {
            if (!isStartOfDirective(i)) continue;
            const std::string_view word = tokens_[i + 1].text;
            const bool isEnd = word == "endif";
            if (word.starts_with("if")) open.push_back(tokens_[i].line), hasConditionals_ = true;
            if ((isEnd || word == "else" || word == "elif") && open.empty())
                fail(Failure::input, "{}:{}: #{} has no #if before it", file_, tokens_[i].line, word);
            if (isEnd) open.pop_back();
        }
        if (!open.empty()) fail(Failure::input, "{}:{}: the #if here has no #endif", file_, open.back());
    }

    [[nodiscard]] bool isStartOfDirective(std::size_t i) const {
        return tokens_[i].text == "#" && tokens_[i].isOfDirective && (i == 0 || tokens_[i - 1].line < tokens_[i].line);
    }

    [[nodiscard]] bool areMacrosWhole() const {
        int depth = 0;
        for (std::size_t i = 0; i < tokens_.size(); ++i) {
            if (isStartOfDirective(i) && depth != 0) return false;
            if (tokens_[i].isOfDirective) depth += tokens_[i].isOpening() ? 1 : tokens_[i].isClosing() ? -1 : 0;
        }
        return depth == 0;
    }

    void checkBrackets() const {
        constexpr std::string_view kOpening = "([{", kClosing = ")]}";
        std::vector<const Token*> open;
        for (const Token& token : tokens_) {
            if (token.isOfDirective) continue;
            if (token.isOpening()) open.push_back(&token);
            if (!token.isClosing()) continue;
            const auto isOther = [&](const Token* t) { return kOpening.find(t->text) == kClosing.find(token.text); };
            if (std::ranges::none_of(open, isOther))
                fail(Failure::input, "{}:{}: '{}' closes nothing", file_, token.line, token.text);
            if (!isOther(open.back())) failOpen(*open.back());
            open.pop_back();
        }
        if (!open.empty()) failOpen(*open.back());
    }

    [[noreturn]] void failOpen(const Token& token) const {
        fail(Failure::input, "{}:{}: '{}' is not closed", file_, token.line, token.text);
    }

    std::string_view file_;
    std::vector<Token> tokens_; ///< without space
    bool hasConditionals_ = false;
};

} // namespace

std::vector<Token> readTokens(std::string_view text) { return Lexer(text).read(); }

void checkPairs(std::span<const Token> tokens, std::string_view file) { PairChecker(tokens, file).check(); }

} // namespace relief
