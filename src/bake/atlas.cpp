#include <algorithm>
#include <set>

#include "bake/bake.h"

namespace relief {
namespace {

SurfacePoint mix3(const std::array<SurfacePoint, 3>& c, const dvec3& w) {
    SurfacePoint r = c[0];
    r.uv = w.x * c[0].uv + w.y * c[1].uv + w.z * c[2].uv;
    r.st = w.x * c[0].st + w.y * c[1].st + w.z * c[2].st;
    r.p = w.x * c[0].p + w.y * c[1].p + w.z * c[2].p;
    r.n = w.x * c[0].n + w.y * c[1].n + w.z * c[2].n;
    return r;
}

} // namespace

Atlas::Atlas(const Cage& cage, int width, int height) : surface_(cage, {}), width_(width), height_(height) {
    findSeams(cage);
}

/// A side is a seam unless another face has the same texture coordinates in the opposite order.
void Atlas::findSeams(const Cage& cage) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> runs;
    auto corner = [&](std::size_t face, std::size_t i) { return cage.texCorners[4 * face + i % 4]; };
    for (std::size_t face = 0; face < cage.faceCount(); ++face)
        for (std::size_t i = 0; i < 4; ++i) runs.insert({corner(face, i), corner(face, i + 1)});
    hasSeam_.resize(cage.faceCount());
    for (std::size_t face = 0; face < cage.faceCount(); ++face)
        for (std::size_t i = 0; i < 4; ++i) hasSeam_[face][i] = !runs.contains({corner(face, i + 1), corner(face, i)});
}

SurfacePoint Atlas::beyond(const SurfacePoint& border, const SurfacePoint& inner) const {
    dvec2 texels = (border.st - inner.st) * dvec2(width_, height_);
    double steps = kMargin / std::max(1e-6, glm::length(texels)); // of a length like that from inner to border
    return mix3({border, inner, border}, {1 + steps, -steps, 0});
}

Atlas::Samples Atlas::sampleFace(int face) const {
    Samples samples;
    auto at = [&](int i, int j) -> SurfacePoint& { return samples[(j + 1) * kSpan + i + 1]; };
    for (int j = 0; j <= kSteps; ++j)
        for (int i = 0; i <= kSteps; ++i) {
            dvec2 uv = dvec2(i, j) / double(kSteps);
            at(i, j) = {face, uv, surface_.texture(face, uv).st, surface_.limit(face, uv).p, surface_.normal(face, uv)};
        }
    for (int i = 0; i <= kSteps; ++i) {
        at(i, -1) = beyond(at(i, 0), at(i, 1));
        at(i, kSteps + 1) = beyond(at(i, kSteps), at(i, kSteps - 1));
    }
    for (int j = -1; j <= kSteps + 1; ++j) {
        at(-1, j) = beyond(at(0, j), at(1, j));
        at(kSteps + 1, j) = beyond(at(kSteps, j), at(kSteps - 1, j));
    }
    return samples;
}

void Atlas::paintTriangle(const std::array<SurfacePoint, 3>& c, const Painter& paint) {
    std::array<dvec2, 3> t;
    for (int i = 0; i < 3; ++i) t[i] = dvec2(c[i].st.x * width_, (1 - c[i].st.y) * height_) - 0.5;
    auto cross = [](dvec2 a, dvec2 b) { return a.x * b.y - a.y * b.x; };
    double area = cross(t[1] - t[0], t[2] - t[0]);
    if (std::abs(area) < 1e-12) return;
    dvec2 low = glm::max(glm::ceil(glm::min(t[0], glm::min(t[1], t[2])) - 1e-6), dvec2(0));
    dvec2 high = glm::min(glm::max(t[0], glm::max(t[1], t[2])) + 1e-6, dvec2(width_ - 1, height_ - 1));
    for (int y = int(low.y); y <= high.y; ++y)
        for (int x = int(low.x); x <= high.x; ++x) {
            std::size_t texel = std::size_t(y) * width_ + x;
            dvec3 w(0, cross(dvec2(x, y) - t[0], t[2] - t[0]) / area, cross(t[1] - t[0], dvec2(x, y) - t[0]) / area);
            w.x = 1 - w.y - w.z;
            if (isPainted_[texel] || std::min({w.x, w.y, w.z}) < -1e-6) continue;
            isPainted_[texel] = true;
            paint(x, y, mix3(c, w));
        }
}

void Atlas::paintCell(const Samples& samples, int i, int j, const Painter& paint) {
    auto at = [&](int di, int dj) { return samples[(j + dj + 1) * kSpan + i + di + 1]; };
    paintTriangle({at(0, 0), at(1, 0), at(1, 1)}, paint);
    paintTriangle({at(0, 0), at(1, 1), at(0, 1)}, paint);
}

void Atlas::forEachTexel(const Painter& paint) {
    isPainted_.assign(std::size_t(width_) * height_, false);
    for (int face = 0; face < surface_.faceCount(); ++face) {
        Samples samples = sampleFace(face);
        for (int j = 0; j < kSteps; ++j)
            for (int i = 0; i < kSteps; ++i) paintCell(samples, i, j, paint);
    }
    // The margins come second: inside an island its own texels win.
    for (int face = 0; face < surface_.faceCount(); ++face) {
        const std::array<bool, 4>& seam = hasSeam_[face];
        if (!seam[0] && !seam[1] && !seam[2] && !seam[3]) continue;
        Samples samples = sampleFace(face);
        for (int i = -1; i <= kSteps; ++i) {
            if (seam[0]) paintCell(samples, i, -1, paint);
            if (seam[1]) paintCell(samples, kSteps, i, paint);
            if (seam[2]) paintCell(samples, i, kSteps, paint);
            if (seam[3]) paintCell(samples, -1, i, paint);
        }
    }
}

void Atlas::spread(Image& image) const {
    std::vector<bool> isFilled = isPainted_;
    std::vector<ivec2> front, next;
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x)
            if (isFilled[std::size_t(y) * width_ + x]) front.emplace_back(x, y);
    for (; !front.empty(); front.swap(next), next.clear())
        for (const ivec2& from : front)
            for (const ivec2& step : {ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1)}) {
                ivec2 to = from + step;
                if (to.x < 0 || to.y < 0 || to.x >= width_ || to.y >= height_) continue;
                std::size_t texel = std::size_t(to.y) * width_ + to.x;
                if (isFilled[texel]) continue;
                isFilled[texel] = true;
                std::copy_n(image.at(from.x, from.y), image.channels, image.at(to.x, to.y));
                next.push_back(to);
            }
}

} // namespace relief
