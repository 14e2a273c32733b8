#include "measure/goals.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

/// The least of a value among contestants whose name has this beginning and end, at the tightest tolerance; 0: none.
double leastAtEqualError(const Results& results, const std::string& scene, const std::string& begin,
                         const std::string& value) {
    double tightest = INFINITY, least = 0;
    for (const Row* row : rowsOf(results, "bandwidth", "tolerance"))
        if (row->scene == scene) tightest = std::min(tightest, row->at);
    for (const Row* row : rowsOf(results, "bandwidth", "tolerance"))
        if (row->scene == scene && row->at == tightest && row->contestant.starts_with(begin) &&
            row->find(value) != nullptr)
            least = least == 0 ? row->get(value) : std::min(least, row->get(value));
    return least;
}

void addBandwidth(std::vector<Goal>& goals, const Results& results) {
    for (const std::string& scene : scenesOf(results, "bandwidth")) {
        const auto add = [&](const char* what, const char* opponent, const char* value, double wanted) {
            const double theirs = leastAtEqualError(results, scene, opponent, value);
            const double ours = leastAtEqualError(results, scene, "cage + ", value);
            if (theirs > 0 && ours > 0) goals.push_back({what, scene, wanted, theirs / ours, true, " ×"});
        };
        add("resident bytes, raw dense mesh to cage and map, same RMS error", "dense mesh, raw", "resident", 20);
        add("resident bytes, quantised dense mesh to cage and map, same RMS error", "dense mesh, quantised", "resident",
            6);
        add("bytes on disk, Draco of the dense mesh to cage and map, same RMS error", "Draco, dense mesh", "disk", 1);
    }
}

/// The row of a contestant where it has the most triangles up to `most`.
const Row* largestUpTo(const Results& results, const std::string& suite, const std::string& contestant, double most) {
    const Row* found = nullptr;
    for (const Row* row : rowsOf(results, suite, "triangles"))
        if (row->contestant == contestant && row->at <= most && (found == nullptr || row->at > found->at)) found = row;
    return found;
}

void addAnimate(std::vector<Goal>& goals, const Results& results) {
    const Row* cage = largestUpTo(results, "animate", "posed cage", 1.3e6);
    const Row* dense = largestUpTo(results, "animate", "dense mesh, raw", 1.3e6);
    if (cage == nullptr || dense == nullptr) return;
    goals.push_back({"bytes uploaded for a pose, raw dense mesh to cage, a million triangles", cage->scene, 200,
                     dense->get("uploaded a frame") / cage->get("uploaded a frame"), true, " ×"});
}

/// By how much values are off the middle of their range, as a share.
double unevenness(const std::vector<double>& values) {
    const auto [low, high] = std::ranges::minmax(values);
    return (high - low) / (high + low);
}

void addScaling(std::vector<Goal>& goals, const Results& results) {
    std::map<std::string, std::vector<double>> costs;
    std::string scene;
    for (const Row* row : rowsOf(results, "scaling", "triangles of a pixel"))
        if (row->at > 0.95e5) costs[row->contestant].push_back(row->get("a further triangle")), scene = row->scene;
    for (const auto& [contestant, values] : costs)
        if (values.size() > 1)
            goals.push_back(
                {"cost of a further triangle of a pixel from 100 k to 10 M, off its middle by, " + contestant, scene,
                 15, 100 * unevenness(values), false, " %",
                 contestant == "dicing" ? "the machine's own unevenness from one run to the next is as large"
                                        : "faces share no vertices: (n + 1)² for 2 n² triangles, which is more a "
                                          "triangle where n is small"});
    std::vector<double> perFace;
    for (const Row* row : rowsOf(results, "scaling", "faces")) perFace.push_back(row->get("a face"));
    if (perFace.size() > 1)
        goals.push_back({"preparation a cage face up to 100 k faces, off its middle by", scene, 15,
                         100 * unevenness(perFace), false, " %",
                         "the machine's own unevenness from one run to the next is as large"});
}

void addMemory(std::vector<Goal>& goals, const Results& results) {
    for (const Row* row : rowsOf(results, "memory", ""))
        goals.push_back({"resident memory of a frame to the buffers it lists, less what a process without triangles "
                         "takes, " +
                             row->contestant,
                         row->scene, 1.2, row->get("grown and first buffers to all buffers"), false, " ×",
                         "the CPU driver keeps triangles that it has not rasterized; waiting for them in between, as "
                         "is done with finished meshes, takes more time here than it saves memory"});
}

void addFrame(std::vector<Goal>& goals, const Results& results) {
    const std::vector<const Row*> rows = rowsOf(results, "frame", "");
    const auto dense = std::ranges::find(rows, "dense mesh, raw", &Row::contestant);
    if (dense == rows.end()) return;
    for (const Row* row : rows) {
        const double wanted = row->contestant == "tessellation" ? 2 : row->contestant == "dicing" ? 1.6 : 0;
        if (wanted > 0)
            goals.push_back({"time of the triangle passes to those of the static dense mesh, " + row->contestant,
                             row->scene, wanted, row->get("triangle passes") / (*dense)->get("triangle passes"), false,
                             " ×"});
    }
}

} // namespace

std::vector<const Row*> rowsOf(const Results& results, const std::string& suite, const std::string& axis) {
    std::vector<const Row*> rows;
    for (const Row& row : results.rows)
        if (row.suite == suite && row.axis == axis) rows.push_back(&row);
    return rows;
}

std::vector<std::string> scenesOf(const Results& results, const std::string& suite) {
    std::vector<std::string> scenes;
    for (const Row& row : results.rows)
        if (row.suite == suite && std::ranges::find(scenes, row.scene) == scenes.end()) scenes.push_back(row.scene);
    return scenes;
}

std::vector<Goal> goalsOf(const Results& results) {
    std::vector<Goal> goals;
    addBandwidth(goals, results);
    addAnimate(goals, results);
    addScaling(goals, results);
    addMemory(goals, results);
    addFrame(goals, results);
    return goals;
}

} // namespace relief
