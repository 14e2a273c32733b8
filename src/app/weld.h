// --weld, and words about cages that look as if they needed it or another option.
#pragma once

#include "app/options.h"

namespace relief::app {

/// The command line with "--weld" alone, or before a word that is no distance, written as "--weld=0": CLI11 would take
/// the word after it for its distance. The words outlive `run`.
std::vector<std::string> withDefaultDistances(int argc, char** argv);

void addWeld(CLI::App& app, std::string& word);

/// Joins the vertices of a cage that is loaded and what moves it, if --weld asks for it ("": it does not).
void weldLoaded(Loaded& loaded, const std::string& word);
/// Joins the vertices of a cage that nothing moves, if --weld asks for it.
Cage welded(Cage cage, const std::string& word);

/// Warns of a surface that is open where it probably should not be.
void warnOfCoincidence(const Cage& cage, const std::string& path, const Warn& warn);
/// Warns of tags that plain polygons do not show, unless they were asked for.
void warnOfPlainTags(const Loaded& loaded, const SurfaceArgs& args, const Warn& warn);
/// For a cage whose texture coordinates some faces lack: throws Failure::input when one of the maps, which need them,
/// is given ("" where none is), else warns.
void checkTexCoords(const Cage& cage, const std::vector<std::string>& maps, const Warn& warn);

} // namespace relief::app
