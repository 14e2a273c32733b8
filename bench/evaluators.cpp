#include "evaluators.h"

#include <array>
#include <memory>

#include <omp.h>

#include <embree3/rtcore.h>
#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>
#include <opensubdiv/osd/ompEvaluator.h>

#include "surface/far.h"
#include "timing.h"

namespace relief::bench {

namespace {

namespace Osd = OpenSubdiv::Osd;

constexpr int kRounds = 5;
constexpr std::size_t kCheckedCount = 500;
constexpr double kPointTolerance = 2e-5, kSlopeTolerance = 5 * kPointTolerance; // of the longest side

struct FirstFrame {
    dvec3 p, pu, pv;
};

/// Evaluates all points at each call, into its own memory.
class Evaluator {
public:
    virtual ~Evaluator() = default;
    [[nodiscard]] virtual std::string name() const = 0;
    virtual void evaluate() = 0;
    [[nodiscard]] virtual FirstFrame at(std::size_t point) const = 0; ///< result of the last call
};

/// Three vectors per point, in an array each.
struct Results {
    std::vector<vec3> p, pu, pv;

    explicit Results(std::size_t count) : p(count), pu(count), pv(count) {}
    [[nodiscard]] FirstFrame at(std::size_t i) const { return {dvec3(p[i]), dvec3(pu[i]), dvec3(pv[i])}; }
};

float* toFloats(std::vector<vec3>& values) { return &values.front().x; }

/// What OpenSubdiv's evaluators take: its tables, the refined points, and the patch of every point.
struct OsdInput {
    FarTables tables;
    Osd::CpuPatchTable patches;
    std::vector<vec3> controlPoints;
    std::vector<Osd::PatchCoord> coords;

    OsdInput(const Cage& cage, int isolation, std::span<const PatchPoint> points)
        : tables(makeFarTables(cage, {.isolation = isolation, .endCaps = EndCapKind::gregory})),
          patches(tables.patches.get()) {
        for (const Point& point : refineAll(tables, cage.positions)) controlPoints.emplace_back(point.value);
        const Far::PatchMap map(*tables.patches);
        for (const PatchPoint& point : points)
            coords.emplace_back(*map.FindPatch(int(point.face), point.u, point.v), point.u, point.v);
    }
};

template <typename Backend>
class OsdEvaluator : public Evaluator {
public:
    OsdEvaluator(std::string name, const OsdInput& input)
        : name_(std::move(name)), input_(input), results_(input.coords.size()) {}

    [[nodiscard]] std::string name() const override { return name_; }
    void evaluate() override {
        const Osd::BufferDescriptor vectors(0, 3, 3);
        Backend::EvalPatches(&input_.controlPoints.front().x, vectors, toFloats(results_.p), vectors,
                             toFloats(results_.pu), vectors, toFloats(results_.pv), vectors, int(input_.coords.size()),
                             input_.coords.data(), input_.patches.GetPatchArrayBuffer(),
                             input_.patches.GetPatchIndexBuffer(), input_.patches.GetPatchParamBuffer());
    }
    [[nodiscard]] FirstFrame at(std::size_t point) const override { return results_.at(point); }

private:
    std::string name_;
    const OsdInput& input_;
    Results results_;
};

/// A loop over Far as its users write it: basis weights by Far, sums by hand.
class FarEvaluator : public Evaluator {
public:
    explicit FarEvaluator(const OsdInput& input) : input_(input), results_(input.coords.size()) {}

    [[nodiscard]] std::string name() const override { return "OpenSubdiv Far, plain loop"; }
    void evaluate() override {
        const std::size_t count = input_.coords.size();
#pragma omp parallel for schedule(static)
        for (std::size_t i = 0; i < count; ++i) evaluateOne(i);
    }
    [[nodiscard]] FirstFrame at(std::size_t point) const override { return results_.at(point); }

private:
    void evaluateOne(std::size_t i) {
        const Osd::PatchCoord& coord = input_.coords[i];
        std::array<float, 20> wP, wU, wV;
        input_.tables.patches->EvaluateBasis(coord.handle, coord.s, coord.t, wP.data(), wU.data(), wV.data());
        const Far::ConstIndexArray vertices = input_.tables.patches->GetPatchVertices(coord.handle);
        vec3 p(0), pu(0), pv(0);
        for (int k = 0; k < vertices.size(); ++k) {
            const vec3& c = input_.controlPoints[std::size_t(vertices[k])];
            p += wP[k] * c, pu += wU[k] * c, pv += wV[k] * c;
        }
        results_.p[i] = p, results_.pu[i] = pu, results_.pv[i] = pv;
    }

    const OsdInput& input_;
    Results results_;
};

/// Embree takes points as arrays and returns an array per component. Each thread takes the next batch when it is free.
/// Within a batch Embree evaluates neighbouring points of one face together; points sorted by face are its best case.
class EmbreeEvaluator : public Evaluator {
public:
    EmbreeEvaluator(const Cage& cage, std::span<const PatchPoint> points)
        : device_(rtcNewDevice(nullptr)), batch_(points.size() / (8 * std::size_t(omp_get_max_threads())) / 4 * 4 + 4) {
        if (!device_) fail(Failure::internal, "Embree does not start: error {}", int(rtcGetDeviceError(nullptr)));
        for (const PatchPoint& point : points) {
            faces_.push_back(point.face);
            u_.push_back(point.u);
            v_.push_back(point.v);
        }
        while (faces_.size() % 4 != 0) { // rtcInterpolateN stores four at a time, aligned
            faces_.push_back(faces_.back());
            u_.push_back(u_.back());
            v_.push_back(v_.back());
        }
        for (std::vector<float>* values : {&p_, &pu_, &pv_}) values->resize(3 * faces_.size());
        makeGeometry(cage);
    }
    EmbreeEvaluator(const EmbreeEvaluator&) = delete;
    EmbreeEvaluator& operator=(const EmbreeEvaluator&) = delete;
    ~EmbreeEvaluator() override {
        rtcReleaseScene(scene_);
        rtcReleaseGeometry(geometry_);
        rtcReleaseDevice(device_);
    }

    [[nodiscard]] std::string name() const override { return "Embree rtcInterpolateN"; }
    void evaluate() override {
        const std::size_t count = faces_.size();
#pragma omp parallel for schedule(dynamic)
        for (std::size_t first = 0; first < count; first += batch_)
            evaluateBatch(first, std::min(batch_, count - first));
    }
    [[nodiscard]] FirstFrame at(std::size_t point) const override {
        return {vectorAt(p_, point), vectorAt(pu_, point), vectorAt(pv_, point)};
    }

private:
    void setBuffer(RTCBufferType type, RTCFormat format, const void* data, std::size_t stride, std::size_t count) {
        if (count > 0) rtcSetSharedGeometryBuffer(geometry_, type, 0, format, data, 0, stride, count);
    }

    void makeGeometry(const Cage& cage) {
        // Faces, points, creases and sharp vertices as the cage has them.
        geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_SUBDIVISION);
        positions_ = cage.positions;
        positions_.emplace_back(0); // Embree reads 16 bytes per vertex, also of the last one
        setBuffer(RTC_BUFFER_TYPE_FACE, RTC_FORMAT_UINT, cage.faceSizes.data(), 4, cage.faceCount());
        setBuffer(RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT, cage.corners.data(), 4, cage.corners.size());
        setBuffer(RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, positions_.data(), 12, cage.positions.size());
        setBuffer(RTC_BUFFER_TYPE_EDGE_CREASE_INDEX, RTC_FORMAT_UINT2, cage.creaseEdges.data(), 8,
                  cage.creaseSharpness.size());
        setBuffer(RTC_BUFFER_TYPE_EDGE_CREASE_WEIGHT, RTC_FORMAT_FLOAT, cage.creaseSharpness.data(), 4,
                  cage.creaseSharpness.size());
        setBuffer(RTC_BUFFER_TYPE_VERTEX_CREASE_INDEX, RTC_FORMAT_UINT, cage.sharpVertices.data(), 4,
                  cage.sharpVertices.size());
        setBuffer(RTC_BUFFER_TYPE_VERTEX_CREASE_WEIGHT, RTC_FORMAT_FLOAT, cage.vertexSharpness.data(), 4,
                  cage.sharpVertices.size());
        rtcSetGeometrySubdivisionMode(geometry_, 0,
                                      cage.boundaryRule == BoundaryRule::edgeAndCorner
                                          ? RTC_SUBDIVISION_MODE_PIN_CORNERS
                                          : RTC_SUBDIVISION_MODE_SMOOTH_BOUNDARY);
        // Interpolation needs what the commit of a scene makes of the geometry.
        rtcCommitGeometry(geometry_);
        scene_ = rtcNewScene(device_);
        rtcAttachGeometry(scene_, geometry_);
        rtcCommitScene(scene_);
        if (const RTCError error = rtcGetDeviceError(device_); error != RTC_ERROR_NONE)
            fail(Failure::internal, "Embree refuses the cage: error {}", int(error));
    }

    void evaluateBatch(std::size_t first, std::size_t count) {
        RELIEF_CHECK(first + count <= faces_.size());
        RTCInterpolateNArguments arguments{};
        arguments.geometry = geometry_;
        arguments.primIDs = &faces_[first];
        arguments.u = &u_[first];
        arguments.v = &v_[first];
        arguments.N = unsigned(count);
        arguments.bufferType = RTC_BUFFER_TYPE_VERTEX;
        arguments.P = &p_[3 * first];
        arguments.dPdu = &pu_[3 * first];
        arguments.dPdv = &pv_[3 * first];
        arguments.valueCount = 3;
        rtcInterpolateN(&arguments);
    }

    /// Within a batch all x come first, then all y, then all z.
    [[nodiscard]] dvec3 vectorAt(const std::vector<float>& values, std::size_t point) const {
        const std::size_t first = point / batch_ * batch_, count = std::min(batch_, faces_.size() - first);
        const float* x = &values[3 * first + (point - first)];
        return {x[0], x[count], x[2 * count]};
    }

    RTCDevice device_;
    std::size_t batch_; ///< points per call
    RTCGeometry geometry_ = nullptr;
    RTCScene scene_ = nullptr;
    std::vector<vec3> positions_;
    std::vector<std::uint32_t> faces_;
    std::vector<float> u_, v_, p_, pu_, pv_;
};

void checkCage(const Cage& cage, std::span<const PatchPoint> points) {
    if (points.empty()) fail(Failure::input, "there are no points to evaluate");
    if (!cage.holes.empty()) fail(Failure::input, "the evaluators are compared on cages without holes");
    if (!std::ranges::all_of(cage.faceSizes, [](std::uint32_t size) { return size == 4; }))
        fail(Failure::input, "the evaluators are compared on cages of four-sided faces only");
    for (const PatchPoint& point : points) {
        if (point.face >= cage.faceCount())
            fail(Failure::input, "face {} does not exist; there are {} (from 0)", point.face, cage.faceCount());
        if (!(point.u >= 0 && point.u <= 1 && point.v >= 0 && point.v <= 1))
            fail(Failure::input, "({}, {}) lies outside face {}; u and v run from 0 to 1", point.u, point.v,
                 point.face);
    }
}

/// Fills in the errors of `time` from the last evaluation. Throws Failure::check where they are too large.
void compare(const Evaluator& evaluator, const ReferenceSurface& reference, std::span<const PatchPoint> points,
             double longestSide, EvaluatorTime& time) {
    const std::size_t step = std::max<std::size_t>(points.size() / kCheckedCount, 1);
    for (std::size_t i = 0; i < points.size(); i += step) {
        const dvec2 uv(points[i].u, points[i].v);
        const LimitFrame exact = reference.limit(int(points[i].face), uv);
        const FirstFrame got = evaluator.at(i);
        const double distance = glm::length(got.p - exact.p) / longestSide;
        if (reference.isApproximate(int(points[i].face), uv)) {
            time.endCapError = std::max(time.endCapError, distance);
            continue;
        }
        time.pointError = std::max(time.pointError, distance);
        for (const dvec3& difference : {got.pu - exact.pu, got.pv - exact.pv})
            time.slopeError = std::max(time.slopeError, glm::length(difference) / longestSide);
    }
    if (!(time.pointError <= kPointTolerance && time.slopeError <= kSlopeTolerance))
        fail(Failure::check,
             "{} does not evaluate the limit surface: errors of {:.1e} in points and {:.1e} in derivatives", time.name,
             time.pointError, time.slopeError);
}

} // namespace

std::vector<PatchPoint> makeGridPoints(const Cage& cage, int rate) {
    std::vector<PatchPoint> points;
    points.reserve(cage.faceCount() * std::size_t(rate + 1) * std::size_t(rate + 1));
    for (std::uint32_t face = 0; face < cage.faceCount(); ++face)
        for (int j = 0; j <= rate; ++j)
            for (int i = 0; i <= rate; ++i) points.push_back({face, float(i) / float(rate), float(j) / float(rate)});
    return points;
}

std::vector<EvaluatorTime> timeEvaluators(const Cage& cage, int isolation, std::span<const PatchPoint> points,
                                          const std::function<void()>& others) {
    // Everything is ready before the first round.
    checkCage(cage, points);
    const OsdInput input(cage, isolation, points);
    std::vector<std::unique_ptr<Evaluator>> evaluators;
    evaluators.push_back(std::make_unique<OsdEvaluator<Osd::OmpEvaluator>>("OpenSubdiv OmpEvaluator", input));
    evaluators.push_back(std::make_unique<OsdEvaluator<Osd::CpuEvaluator>>("OpenSubdiv CpuEvaluator", input));
    evaluators.push_back(std::make_unique<FarEvaluator>(input));
    evaluators.push_back(std::make_unique<EmbreeEvaluator>(cage, points));

    // Interleaved rounds. The first one starts threads and touches memory.
    std::vector<std::vector<double>> rounds(evaluators.size());
    for (int round = 0; round <= kRounds; ++round) {
        others();
        for (std::size_t i = 0; i < evaluators.size(); ++i) {
            const double ms = measureMilliseconds([&] { evaluators[i]->evaluate(); });
            if (round > 0) rounds[i].push_back(ms);
        }
    }

    // The results of the last round, compared with the reference.
    const ReferenceSurface reference(cage, {.isolation = isolation, .endCaps = EndCapKind::gregory});
    Bounds bounds;
    for (const vec3& p : cage.positions) bounds.add(dvec3(p));
    std::vector<EvaluatorTime> times;
    for (std::size_t i = 0; i < evaluators.size(); ++i) {
        times.push_back({.name = evaluators[i]->name(), .rounds = rounds[i]});
        compare(*evaluators[i], reference, points, bounds.longestSide(), times.back());
    }
    return times;
}

} // namespace relief::bench
