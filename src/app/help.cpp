#include "app/help.h"

#include <sstream>

namespace relief::app {
namespace {

constexpr std::size_t kScreenColumns = 120;

std::string wrapLine(const std::string& line, std::size_t width) {
    const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
    const std::string further(indent > 0 ? indent + 2 : 0, ' ');
    std::string wrapped, current(indent, ' ');
    std::istringstream words(line);
    bool isFirst = true; // of its line: no space before it
    for (std::string word; words >> word; isFirst = false) {
        if (!isFirst && current.size() + 1 + word.size() > width) {
            wrapped += current + '\n';
            current = further;
            isFirst = true;
        }
        current += (isFirst ? "" : " ") + word;
    }
    return wrapped + current;
}

} // namespace

std::string wrapLines(const std::string& text, std::size_t width) {
    std::string wrapped;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) wrapped += (wrapped.empty() ? "" : "\n") + wrapLine(line, width);
    return wrapped;
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
    return wrapLines(CLI::Formatter::make_option_desc(option), kScreenColumns - get_column_width());
}

} // namespace relief::app
