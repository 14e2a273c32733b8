// How much code a height function becomes: macros and calls of functions multiply.
#include <algorithm>
#include <map>

#include "base/base.h"
#include "formula/tokens.h"

namespace relief {
namespace {

/// Tokens that macros may add to a text, and functions, which drivers compile into each place that calls them.
constexpr double kMostAdded = 1 << 14;

using Tokens = std::span<const Token>;

/// What becomes of a name: `size` tokens, and as many copies of each token between its parentheses.
struct Expansion {
    double size = 1, copies = 1;
};

class Expander {
public:
    Expander(Tokens tokens, std::string_view file) : file_(file), most_(double(tokens.size()) + kMostAdded) {
        for (std::size_t i = 0; i < tokens.size();) {
            const std::size_t end = tokens[i].isOfDirective ? endOfDirective(tokens, i) : i + 1;
            if (tokens[i].isOfDirective)
                addDirective(tokens.subspan(i, end - i));
            else
                text_.push_back(tokens[i]);
            i = end;
        }
        findFunctions();
    }

    void check() {
        for (const Tokens condition : conditions_) checkSize(condition);
        checkSize(outside_);
        for (const auto& [name, bodies] : definitions_)
            for (const Definition& body : bodies)
                if (!body.isMacro) checkSize(body.tokens);
    }

private:
    /// A macro, or a function.
    struct Definition {
        Tokens tokens;
        std::vector<std::string_view> parameters;
        bool isMacro = false;
    };

    static std::size_t endOfDirective(Tokens tokens, std::size_t first) {
        const auto isStart = [&](std::size_t i) {
            return tokens[i].text == "#" && (i == 0 || tokens[i - 1].line < tokens[i].line);
        };
        std::size_t end = first + 1;
        while (end < tokens.size() && tokens[end].isOfDirective && !isStart(end)) ++end;
        return end;
    }

    void addDirective(Tokens line) {
        if (line.size() < 2) return;
        if (line[1].text == "if" || line[1].text == "elif") conditions_.push_back(line.subspan(2));
        if (line[1].text != "define" || line.size() < 3) return;
        Definition definition{.tokens = line.subspan(3), .parameters = {}, .isMacro = true};
        // Parameters follow the name without a space.
        const bool hasParameters =
            line.size() > 3 && line[3].text == "(" && line[3].text.data() == line[2].text.data() + line[2].text.size();
        if (hasParameters) {
            std::size_t i = 4;
            for (; i < line.size() && line[i].text != ")"; ++i)
                if (line[i].kind == TokenKind::word) definition.parameters.push_back(line[i].text);
            definition.tokens = line.subspan(std::min(i + 1, line.size()));
        }
        definitions_[line[2].text].push_back(definition);
    }

    /// NAME ( ... ) { ... } outside of all braces.
    void findFunctions() {
        const Tokens all = text_;
        std::size_t first = 0; // behind the function before
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (all[i].text != "{") continue;
            const std::size_t end = endOfBrackets(all, i);
            std::size_t name = i;
            while (name > first && all[name].text != "(" && all[name].text != ";") --name;
            const bool isFunction = all[i == 0 ? 0 : i - 1].text == ")" && name > first && all[name].text == "(";
            if (isFunction) definitions_[all[name - 1].text].push_back({all.subspan(i, end - i), {}, false});
            outside_.insert(outside_.end(), all.begin() + std::ptrdiff_t(first),
                            all.begin() + std::ptrdiff_t(isFunction ? name - 1 : end));
            first = end;
            i = end - 1;
        }
        outside_.insert(outside_.end(), all.begin() + std::ptrdiff_t(first), all.end());
    }

    /// The token behind the bracket that closes that at `first`.
    static std::size_t endOfBrackets(Tokens tokens, std::size_t first) {
        int depth = 0;
        for (std::size_t i = first; i < tokens.size(); ++i) {
            depth += tokens[i].isOpening() ? 1 : tokens[i].isClosing() ? -1 : 0;
            if (depth == 0) return i + 1;
        }
        return tokens.size();
    }

    Expansion expansionOf(std::string_view name) {
        const auto found = definitions_.find(name);
        if (found == definitions_.end()) return {};
        const auto [known, isNew] = expansions_.try_emplace(name); // a name within itself is not replaced again
        if (!isNew) return known->second;
        Expansion largest;
        for (const Definition& definition : found->second) {
            const Expansion one = measure(definition.tokens, definition.parameters);
            largest.size = std::max(largest.size, 1 + one.size);
            if (definition.isMacro) largest.copies = std::max(largest.copies, one.copies);
        }
        return expansions_[name] = largest;
    }

    /// `copies` of the result: how often a parameter occurs.
    Expansion measure(Tokens tokens, std::span<const std::string_view> parameters) {
        constexpr double kPlenty = 1e30;
        Expansion sum{0, 0};
        std::vector<double> weights{1}; // of what is in the parentheses that are open
        double next = 1;                // of parentheses that open here
        for (const Token& token : tokens) {
            const bool isParameter = std::ranges::count(parameters, token.text) > 0;
            const Expansion one = token.kind == TokenKind::word && !isParameter ? expansionOf(token.text) : Expansion();
            sum.size = std::min(sum.size + weights.back() * one.size, kPlenty);
            if (isParameter) sum.copies = std::min(sum.copies + weights.back(), kPlenty);
            if (token.isOpening()) weights.push_back(std::min(weights.back() * next, kPlenty));
            if (token.isClosing() && weights.size() > 1) weights.pop_back();
            next = std::max(one.copies, 1.0);
        }
        return sum;
    }

    /// Names the first token with which there are too many.
    void checkSize(Tokens tokens) {
        if (measure(tokens, {}).size <= most_) return;
        std::size_t low = 0, high = tokens.size(); // so many first ones fit, and do not
        while (high - low > 1) {
            const std::size_t middle = (low + high) / 2;
            (measure(tokens.first(middle), {}).size <= most_ ? low : high) = middle;
        }
        fail(Failure::input,
             "{}:{}: with '{}' the function becomes more than {} words and signs, macros and calls of functions "
             "replaced: compilers would take minutes",
             file_, tokens[low].line, tokens[low].text, std::size_t(most_));
    }

    std::string_view file_;
    double most_;                ///< tokens, macros and calls replaced
    std::vector<Token> outside_; ///< of functions and directives
    std::vector<Token> text_;    ///< outside of directives
    std::vector<Tokens> conditions_;
    std::map<std::string_view, std::vector<Definition>> definitions_;
    std::map<std::string_view, Expansion> expansions_;
};

} // namespace

void checkExpansion(Tokens tokens, std::string_view file) { Expander(tokens, file).check(); }

} // namespace relief
