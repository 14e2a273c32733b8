#include "app/weld.h"

#include "app/units.h"

namespace relief::app {
namespace {

WeldedCage weldAsAsked(Cage cage, const std::string& word) {
    const double diagonal = summarize(cage).bounds.diagonal(), unit = cage.coordinates.unit;
    WeldedCage welded = weld(std::move(cage), parseDistance(word).value_or(Distance{}).cageUnits(diagonal) / unit);
    if (welded.cage.faceCount() == 0)
        fail(Failure::usage, "--weld {}: all faces shrink to nothing; use a smaller distance", word);
    return welded;
}

} // namespace

std::vector<std::string> withDefaultDistances(int argc, char** argv) {
    std::vector<std::string> words(argv, argv + argc);
    for (std::size_t i = 1; i < words.size(); ++i) {
        if (words[i] == "--") break;
        const bool isAlone = i + 1 == words.size() || !parseDistance(words[i + 1]);
        if (words[i] == "--weld" && isAlone) words[i] = "--weld=0";
    }
    return words;
}

void addWeld(CLI::App& app, std::string& word) {
    app.add_option("--weld", word,
                   "join boundary vertices at one place, or at most so far apart: cage units, or % of the diagonal (0)")
        ->check(distanceFromZero())
        ->option_text("[DISTANCE]")
        ->group("surface");
}

void weldLoaded(Loaded& loaded, const std::string& word) {
    if (word.empty()) return;
    WeldedCage welded = weldAsAsked(std::move(loaded.cage), word);
    loaded.cage = std::move(welded.cage);
    if (loaded.animation) loaded.animation = gather(std::move(loaded.animation), std::move(welded.sources));
}

Cage welded(Cage cage, const std::string& word) {
    return word.empty() ? std::move(cage) : weldAsAsked(std::move(cage), word).cage;
}

void warnOfCoincidence(const Cage& cage, const std::string& path, const Warn& warn) {
    const std::uint64_t count = countCoincidentVertices(cage);
    if (count > 0)
        warn(fmt::format("{}: {} of {} vertices stand where another boundary vertex does: the surface is open between "
                         "them; --weld joins them",
                         path, count, cage.positions.size()));
}

void warnOfPlainTags(const Loaded& loaded, const SurfaceArgs& args, const Warn& warn) {
    const Cage& cage = loaded.cage;
    const bool hasTags = !cage.creaseEdges.empty() || !cage.sharpVertices.empty() || !cage.holes.empty();
    if (loaded.dense && args.scheme.empty() && hasTags)
        warn(fmt::format("{}: it has subdivision tags, but triangles are drawn as they are; name --scheme loop or "
                         "catmark to subdivide them",
                         args.cage));
}

void checkTexCoords(const Cage& cage, const std::vector<std::string>& maps, const Warn& warn) {
    if (cage.missingTexCoords.empty()) return;
    for (const std::string& map : maps)
        if (!map.empty()) fail(Failure::input, "{}; the map {} needs them on all faces", cage.missingTexCoords, map);
    warn(cage.missingTexCoords + "; all are ignored");
}

} // namespace relief::app
