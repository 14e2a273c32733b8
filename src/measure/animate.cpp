// The suite `animate`: what a new pose sends to the device, and what a posed frame takes, with a cage and without.
#include <algorithm>
#include <cmath>

#include "measure/parts.h"
#include "pose/pose.h"

namespace relief {
namespace {

constexpr std::uint32_t kJoints = 4;

/// Joints one above another; every point hangs on the two that it lies between. Four influences, as exporters write.
Rig columnRig(std::span<const vec3> points, const Bounds& bounds) {
    Rig rig{.rest = {points.begin(), points.end()}, .jointCount = kJoints, .influenceCount = 4};
    for (const vec3& p : points) {
        const double height = std::clamp((p.y - bounds.lower.y) / (bounds.upper.y - bounds.lower.y), 0.0, 1.0);
        const double at = height * (kJoints - 1);
        const auto lower = std::uint32_t(std::min(at, kJoints - 2.0));
        const auto share = float(at - lower);
        rig.joints.insert(rig.joints.end(), {lower, lower + 1, 0, 0});
        rig.weights.insert(rig.weights.end(), {1 - share, share, 0, 0});
    }
    return rig;
}

/// Each joint turned a little more about the vertical through the middle.
Pose columnPose(const Bounds& bounds, int round) {
    Pose pose;
    for (std::uint32_t joint = 0; joint < kJoints; ++joint) {
        const double angle = 0.15 * joint * std::sin(0.7 * round);
        const auto c = float(std::cos(angle)), s = float(std::sin(angle));
        mat4 turn(c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1);
        const vec3 center(bounds.center());
        turn[3] = vec4(center - mat3(turn) * center, 1);
        pose.joints.push_back(turn);
    }
    return pose;
}

/// The processor's way to pose a dense mesh: positions and normals, in single precision.
void poseOnHost(const DenseMesh& rest, const Rig& rig, const Pose& pose, DenseMesh& posed) {
    for (std::size_t i = 0; i < rest.positions.size(); ++i) {
        mat4 joints(0);
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) joints += rig.weights[k] * pose.joints[rig.joints[k]];
        posed.positions[i] = joints * vec4(rest.positions[i], 1);
        posed.normals[i] = glm::normalize(mat3(joints) * rest.normals[i]);
    }
}

/// Bytes alone, over many numbers of triangles.
void countBytes(Bench& bench, const Subject& subject, const OnDevice& on) {
    int previous = 0;
    for (const double triangles : {3e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7}) {
        const int rate = on.rateFor(triangles);
        if (rate == std::exchange(previous, rate)) continue;
        const DrawPlan plan = planGrids(on.model, exactRates(on.model, rate));
        const auto add = [&](const char* name, std::uint64_t bytes) {
            Row row{"animate", subject.name, name, "triangles", double(plan.triangleCount), {}};
            row.add("uploaded a frame", "bytes", Origin::computed, double(bytes));
            bench.results.rows.push_back(row);
        };
        add("posed cage", posedCageBytes(subject.cage.positions.size()));
        add(kDense, posedDenseBytes(kRawLayout, plan.vertexCount));
        add("dense mesh, quantised", posedDenseBytes(kQuantisedLayout, plan.vertexCount));
    }
}

/// Frames of one number of triangles, posed in every way.
void timeFrames(Bench& bench, const Subject& subject, OnDevice& on, int rate) {
    const DenseMesh mesh = denseMeshOf(bench.device, on.model, rate);
    const Rig cageRig = columnRig(subject.cage.positions, on.bounds), meshRig = columnRig(mesh.positions, on.bounds);
    Poser poser(bench.device, on.model, {.surface = &on.surface, .rig = &cageRig});
    const std::unique_ptr<MeshModel> skinned = denseModel(bench.device, mesh), sent = denseModel(bench.device, mesh);
    MeshPoser skinner(bench.device, *skinned, mesh, meshRig), sender(bench.device, *sent, mesh, meshRig);
    DenseMesh posed = mesh;

    const auto poseCage = [&](int round) { poser.pose(columnPose(on.bounds, round)); };
    std::vector<Drawn> all;
    const auto addCage = [&](const char* name, Path path) {
        all.push_back({.name = name, .instance = on.model, .options = on.renderOptions(rate), .pose = poseCage});
        all.back().options.path = path;
    };
    if (bench.device.traits().hasTessellation) addCage("posed cage, tessellation", Path::tessellation);
    addCage("posed cage, dicing", Path::dice);
    all.push_back({.name = "dense mesh, skinned on the device",
                   .instance = *skinned,
                   .options = on.renderOptions(rate),
                   .pose = [&](int round) { skinner.pose(columnPose(on.bounds, round)); }});
    all.push_back({.name = "dense mesh, posed by the processor",
                   .instance = *sent,
                   .options = on.renderOptions(rate),
                   .pose = [&](int round) {
                       poseOnHost(mesh, meshRig, columnPose(on.bounds, round), posed);
                       sender.upload(posed.positions, posed.normals);
                   }});
    Renderer renderer(bench.device, {.width = bench.pictureSide(), .height = bench.pictureSide(), .shadowSide = 1});
    drawRounds(renderer, on.views, bench.roundCount(), all);
    for (const Drawn& drawn : all) {
        Row row{"animate", subject.name, drawn.name, "triangles", double(drawn.last.triangleCount), {}};
        row.add("frame", "ms", drawn.wall);
        row.add("pose", "ms", drawn.poses);
        bench.results.rows.push_back(row);
    }
}

} // namespace

void measureAnimate(Bench& bench, const Subject& subject) {
    OnDevice on(bench.device, subject);
    countBytes(bench, subject, on);
    for (const double triangles : bench.options.isQuick ? std::vector{6e4} : std::vector{1e5, 1e6})
        timeFrames(bench, subject, on, std::min(on.rateFor(triangles), 64));
    bench.progress.advance();
}

} // namespace relief
