// How --help is laid out.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace relief::app {

/// Breaks lines between words so that none is longer than `width`. A line's further parts are indented more than its
/// first one if that is indented.
std::string wrapLines(const std::string& text, std::size_t width);

/// CLI11's own layout, with the explanations of options wrapped to the columns of a usual screen.
class HelpFormatter : public CLI::Formatter {
public:
    [[nodiscard]] std::string make_option_desc(const CLI::Option* option) const override;
};

} // namespace relief::app
