// The suite `animate`: the bytes that a new pose sends to the device, and the times of posed frames, for a posed cage
// and for posed dense meshes.
#include <algorithm>
#include <cmath>

#include "measure/suite.h"
#include "pose/pose.h"

namespace relief {
namespace {

constexpr std::uint32_t kJoints = 4;

/// A column of joints; each point is bound to the two joints between which it lies. Four influences per point, two of
/// them with a weight of 0, as exporters write them.
Rig makeColumnRig(std::span<const vec3> points, const Bounds& bounds) {
    Rig rig{.rest = {points.begin(), points.end()}, .jointCount = kJoints, .influenceCount = 4};
    for (const vec3& p : points) {
        const double height = std::clamp((p.y - bounds.lower.y) / (bounds.upper.y - bounds.lower.y), 0.0, 1.0);
        const double at = height * (kJoints - 1);
        const auto lower = std::uint32_t(std::min(at, kJoints - 2.0));
        const auto weight = float(at - lower);
        rig.joints.insert(rig.joints.end(), {lower, lower + 1, 0, 0});
        rig.weights.insert(rig.weights.end(), {1 - weight, weight, 0, 0});
    }
    return rig;
}

/// Each joint is turned further than the one below it, about the vertical axis through the middle.
Pose makeColumnPose(const Bounds& bounds, int round) {
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

/// Linear blend skinning of positions and normals on the host, in single precision.
void poseOnHost(const DenseMesh& rest, const Rig& rig, const Pose& pose, DenseMesh& posed) {
    RELIEF_CHECK(rig.weights.size() == 4 * rest.positions.size());
    for (std::size_t i = 0; i < rest.positions.size(); ++i) {
        mat4 joints(0);
        for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) joints += rig.weights[k] * pose.joints[rig.joints[k]];
        posed.positions[i] = joints * vec4(rest.positions[i], 1);
        posed.normals[i] = glm::normalize(mat3(joints) * rest.normals[i]);
    }
}

/// Counts bytes without drawing, for many numbers of triangles.
void countBytes(SuiteContext& context, const TestScene& scene, const SceneOnDevice& on) {
    int previous = 0;
    for (const double triangles : {3e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6, 1e7}) {
        const int rate = on.chooseRate(triangles);
        if (rate == std::exchange(previous, rate)) continue;
        const DrawPlan plan = planGrids(on.model, makeUniformRates(on.model, rate));
        const auto add = [&](Method method, std::uint64_t bytes) {
            Row row{Suite::animate, scene.name, method, Axis::triangles, double(plan.triangleCount), {}};
            row.addComputed(Metric::uploadedBytes, double(bytes));
            context.results.rows.push_back(row);
        };
        add(Method::posedCage, computePosedCageBytes(scene.cage.positions.size()));
        add(Method::denseRaw, computePosedDenseBytes(kRawLayout, plan.vertexCount));
        add(Method::denseQuantised, computePosedDenseBytes(kQuantisedLayout, plan.vertexCount));
    }
}

/// Times frames of one number of triangles, posed in every way.
void timeFrames(SuiteContext& context, const TestScene& scene, SceneOnDevice& on, int rate) {
    // The same column of joints moves the cage, and dense meshes of the surface at that rate.
    const DenseMesh mesh = makeDenseMesh(context.device, on.model, rate);
    const Rig cageRig = makeColumnRig(scene.cage.positions, on.bounds),
              meshRig = makeColumnRig(mesh.positions, on.bounds);
    Poser poser(context.device, on.model, {.surface = &on.surface, .rig = &cageRig});
    MeshModel skinned = uploadDenseMesh(context.device, mesh), sent = uploadDenseMesh(context.device, mesh);
    MeshPoser skinner(context.device, skinned, mesh, meshRig), sender(context.device, sent, mesh, meshRig);
    DenseMesh posed = mesh;

    // What is drawn, and how each of it is posed.
    std::vector<TimedDrawing> drawings;
    const auto add = [&](Method method, const Instance& instance,
                         std::function<void(int)> updatePose) -> TimedDrawing& {
        drawings.push_back({.method = method, .instance = instance, .options = on.renderOptions(rate)});
        drawings.back().updatePose = std::move(updatePose);
        return drawings.back();
    };
    const auto poseCage = [&](int round) { poser.pose(makeColumnPose(on.bounds, round)); };
    if (context.device.traits().hasTessellation)
        add(Method::posedCageTessellation, on.model, poseCage).options.path = Path::tessellation;
    add(Method::posedCageDicing, on.model, poseCage).options.path = Path::dice;
    add(Method::denseSkinnedOnDevice, skinned, [&](int round) { skinner.pose(makeColumnPose(on.bounds, round)); });
    add(Method::densePosedOnHost, sent, [&](int round) {
        poseOnHost(mesh, meshRig, makeColumnPose(on.bounds, round), posed);
        sender.upload(posed);
    });

    Renderer renderer(context.device,
                      {.width = context.pictureSide(), .height = context.pictureSide(), .shadowSide = 1});
    timeDrawings(renderer, on.views, context.roundCount(), drawings);
    for (const TimedDrawing& drawing : drawings) {
        Row row{Suite::animate, scene.name, drawing.method, Axis::triangles, double(drawing.stats.triangleCount), {}};
        row.addMeasured(Metric::frameTime, drawing.frameTimes);
        row.addMeasured(Metric::poseTime, drawing.poseTimes);
        context.results.rows.push_back(row);
    }
}

} // namespace

void measureAnimate(SuiteContext& context, const TestScene& scene) {
    SceneOnDevice on(context.device, scene);
    countBytes(context, scene, on);
    for (const double triangles : context.options.isQuick ? std::vector{6e4} : std::vector{1e5, 1e6})
        timeFrames(context, scene, on, std::min(on.chooseRate(triangles), 64));
    context.progress.advance();
}

} // namespace relief
