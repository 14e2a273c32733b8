#include "bake/certificate.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <limits>
#include <thread>

namespace relief {
namespace {

/// What is known at a vertex besides its point.
struct VertexFacts {
    dvec3 normal{0};
    double area = 0; ///< of the limit surface that the vertex stands for
    bool isMissed = false, isBehind = false, isFolded = false;
};

/// The smallest 1 + h kappa of both principal curvatures: the eigenvalues of I + h S with S (p_u p_v) = (n_u n_v).
double computeFoldFactor(const LimitFrame& frame, double h) {
    const NormalFrame normal = computeNormalFrame(frame);
    const double e = glm::dot(frame.pu, frame.pu), f = glm::dot(frame.pu, frame.pv), g = glm::dot(frame.pv, frame.pv);
    const double determinant = e * g - f * f;
    if (!(determinant > 0)) return 1;
    // The shape operator from both fundamental forms: trace 2H, determinant K.
    const double l = glm::dot(normal.nu, frame.pu), m = glm::dot(normal.nu, frame.pv),
                 n = glm::dot(normal.nv, frame.pv);
    const double mean = 0.5 * (l * g - 2 * m * f + n * e) / determinant, gauss = (l * n - m * m) / determinant;
    const double apart = std::sqrt(std::max(0.0, mean * mean - gauss));
    return 1 + std::min(h * (mean + apart), h * (mean - apart));
}

class Certifier {
public:
    Certifier(const ReferenceSurface& surface, const HeightMap& map, const MeasuredSurface& sculpt,
              const BakeCertificateOptions& options)
        : surface_(surface), map_(map), sculpt_(sculpt), options_(options), lines_(surface, sculpt, options.lines),
          sideCount_(surface.sideCount()) {
        for (int face = 0; face < surface.faceCount(); ++face)
            if (!surface.isHole(face)) faces_.push_back(face);
        const double perFace = double(options.triangleCount) / double(std::max<std::size_t>(faces_.size(), 1));
        certificate_.rate = int(std::clamp(std::sqrt(perFace / (sideCount_ == 4 ? 2 : 1)), 2.0, 2048.0));
        const auto n = std::size_t(certificate_.rate);
        perFace_ = sideCount_ == 4 ? (n + 1) * (n + 1) : (n + 1) * (n + 2) / 2;
    }

    BakeCertificate certify() {
        Progress progress("certifying", 4, options_.progress);
        DenseMesh& mesh = certificate_.displaced;
        mesh.positions.resize(faces_.size() * perFace_);
        if (options_.wantsDistances) mesh.normals.resize(mesh.positions.size());
        if (options_.wantsDistances) mesh.heights.resize(mesh.positions.size());
        facts_.resize(mesh.positions.size());
        onEachFace([this](std::size_t i) { displaceFace(i); });
        makeTriangles();
        progress.advance();
        addUpFacts();
        progress.advance();

        // What nobody draws is not kept beside the tree.
        facts_ = {};
        const MeasuredSurface displaced = takeSurface(mesh);
        certificate_.distance.forth = measureOneWay(displaced, sculpt_);
        progress.advance();
        certificate_.distance.back = measureOneWay(sculpt_, displaced);
        progress.advance();
        return std::move(certificate_);
    }

private:
    /// Of the triangles themselves, unless they are drawn afterwards.
    MeasuredSurface takeSurface(DenseMesh& mesh) const {
        constexpr std::size_t kSamples = 200'000;
        if (options_.wantsDistances) return MeasuredSurface({mesh.positions, mesh.indices}, kSamples, TreeUse::lines);
        return MeasuredSurface::ofMesh({.positions = std::move(mesh.positions), .indices = std::move(mesh.indices)},
                                       kSamples, TreeUse::lines);
    }

    void onEachFace(const std::function<void(std::size_t)>& work) {
        std::atomic<std::size_t> next = 0;
        std::vector<std::future<void>> threads;
        for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
            threads.push_back(std::async([&] {
                for (std::size_t face = next++; face < faces_.size(); face = next++) work(face);
            }));
        for (std::future<void>& thread : threads) thread.get();
    }

    /// The number of a vertex in its face; rows of triangular faces become shorter.
    [[nodiscard]] std::size_t indexOf(int i, int j) const {
        const int n = certificate_.rate;
        return std::size_t(sideCount_ == 4 ? j * (n + 1) + i : j * (n + 1) - j * (j - 1) / 2 + i);
    }
    [[nodiscard]] int rowEnd(int j) const { return sideCount_ == 4 ? certificate_.rate : certificate_.rate - j; }

    void displaceFace(std::size_t number) {
        const int n = certificate_.rate;
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= rowEnd(j); ++i)
                displaceVertex(faces_[number], dvec2(i, j) / double(n), number * perFace_ + indexOf(i, j));
    }

    /// Slightly inside of the face, because a sculpt may end where the surface does.
    [[nodiscard]] std::optional<LineHit> look(int face, const dvec2& uv) const {
        constexpr double kInwards = 1e-3;
        const dvec2 inside = glm::mix(uv, dvec2(sideCount_ == 4 ? 1.0 / 2 : 1.0 / 3), kInwards);
        return lines_.find(lines_.lineAt(face, inside));
    }

    void displaceVertex(int face, const dvec2& uv, std::size_t vertex) {
        const SculptLines::Line line = lines_.lineAt(face, uv);
        const LimitFrame& frame = line.frame;
        const TexFrame tex = surface_.texture(face, uv);
        const HeightSample sample = sampleHeight(map_, {.face = face, .uv = uv, .st = tex.st});
        const double h = sample.h;
        VertexFacts& facts = facts_[vertex];
        const bool hasPlane = frame.hasTangentPlane();
        facts.normal = line.direction;
        facts.area = glm::length(glm::cross(frame.pu, frame.pv));
        facts.isFolded = hasPlane && computeFoldFactor(frame, h) <= 0;
        const std::optional<LineHit> hit = look(face, uv);
        facts.isMissed = !hit;
        facts.isBehind = hit && hit->isBehindBack;
        const dvec3 q = frame.p + h * facts.normal;
        certificate_.displaced.positions[vertex] = vec3(q);
        if (!options_.wantsDistances) return;
        const dvec2 slope(sample.hs, sample.ht); // of a map per face along u and v
        const dvec2 dh = map_.addressing == Addressing::faces ? slope : slope * tex.jacobian;
        const dvec3 full = hasPlane ? computeDisplacedNormals(frame, h, dh).full : facts.normal;
        certificate_.displaced.normals[vertex] = vec3(glm::length(full) > 0 ? glm::normalize(full) : facts.normal);
        // The hit is a point of the sculpt, and near: beyond it there is nothing to look for.
        const double limit =
            hit ? 2 * std::abs(h - hit->height) + 0.01 * (options_.lines.reach.front + options_.lines.reach.back)
                : std::numeric_limits<double>::infinity();
        double distance = sculpt_.distance(q, limit);
        if (!std::isfinite(distance)) distance = sculpt_.distance(q);
        certificate_.displaced.heights[vertex] = float(hit ? distance : -distance);
    }

    void makeTriangles() {
        const int n = certificate_.rate;
        std::vector<std::uint32_t>& indices = certificate_.displaced.indices;
        const auto perSide = std::size_t(n);
        certificate_.triangleCount = faces_.size() * perSide * perSide * (sideCount_ == 4 ? 2 : 1);
        indices.reserve(3 * certificate_.triangleCount);
        for (std::size_t face = 0; face < faces_.size(); ++face)
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < rowEnd(j); ++i) {
                    const auto at = [&](int di, int dj) {
                        return std::uint32_t(face * perFace_ + indexOf(i + di, j + dj));
                    };
                    indices.insert(indices.end(), {at(0, 0), at(1, 0), at(0, 1)});
                    if (sideCount_ == 4 || i + 1 < rowEnd(j))
                        indices.insert(indices.end(), {at(1, 0), at(1, 1), at(0, 1)});
                }
    }

    void addUpFacts() {
        // Shares of the area of the surface, by what was found at its vertices.
        double area = 0, missed = 0, behind = 0, folded = 0;
        for (const VertexFacts& facts : facts_) {
            area += facts.area;
            missed += facts.isMissed ? facts.area : 0;
            behind += facts.isBehind ? facts.area : 0;
            folded += facts.isFolded ? facts.area : 0;
        }
        // Each triangle has a third of the area at each of its corners.
        double turned = 0, triangles = 0;
        const DenseMesh& mesh = certificate_.displaced;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const auto at = [&](std::size_t k) { return dvec3(mesh.positions[mesh.indices[i + k]]); };
            const auto facts = [&](std::size_t k) -> const VertexFacts& { return facts_[mesh.indices[i + k]]; };
            const dvec3 normal = facts(0).normal + facts(1).normal + facts(2).normal;
            const double share = facts(0).area + facts(1).area + facts(2).area;
            triangles += share;
            if (glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), normal) >= 0) continue;
            turned += share;
            ++certificate_.overturnedCount;
        }
        if (area > 0) {
            certificate_.missedShare = missed / area, certificate_.behindShare = behind / area;
            certificate_.foldedShare = folded / area;
        }
        if (triangles > 0) certificate_.overturnedShare = turned / triangles;
    }

    const ReferenceSurface& surface_;
    const HeightMap& map_;
    const MeasuredSurface& sculpt_;
    BakeCertificateOptions options_;
    SculptLines lines_;
    int sideCount_;
    std::vector<int> faces_;
    std::size_t perFace_ = 0;
    std::vector<VertexFacts> facts_;
    BakeCertificate certificate_;
};

} // namespace

BakeCertificate certifyBake(const ReferenceSurface& surface, const HeightMap& map, const MeasuredSurface& sculpt,
                            const BakeCertificateOptions& options) {
    return Certifier(surface, map, sculpt, options).certify();
}

} // namespace relief
