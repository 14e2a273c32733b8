// Random numbers and noise that are the same on every machine and in every run.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/base.h"

namespace relief::meshes {

/// PCG output function (Jarzynski and Olano, "Hash functions for GPU rendering", 2020).
inline std::uint32_t scramble(std::uint32_t x) {
    x = x * 747796405u + 2891336453u;
    x = ((x >> ((x >> 28u) + 4u)) ^ x) * 277803737u;
    return (x >> 22u) ^ x;
}

/// What a lattice point's coordinates add to the number that is scrambled.
inline std::uint32_t latticeX(int x) { return std::uint32_t(x) * 0x8da6b343u; }
inline std::uint32_t latticeY(int y) { return std::uint32_t(y) * 0xd8163841u; }
inline std::uint32_t latticeZ(int z) { return std::uint32_t(z) * 0xcb1ab31fu; }

/// 0 <= unit < 1.
inline double unit(std::uint32_t bits) { return bits * (1.0 / 4294967296.0); }

/// A stream of numbers.
class Random {
public:
    explicit Random(std::uint32_t seed) : seed_(seed) {}
    double operator()() { return unit(scramble(seed_ * 0x9e3779b9u + scramble(count_++))); }
    double operator()(double low, double high) { return low + (high - low) * (*this)(); }
    dvec3 inBox() { return {(*this)(-1, 1), (*this)(-1, 1), (*this)(-1, 1)}; } ///< braces: in this order everywhere

private:
    std::uint32_t seed_, count_ = 0;
};

/// The largest integer <= x; quicker than the library's where that is a call.
inline int floorOf(double x) {
    int i = int(x);
    return i - (x < i);
}

/// Height at d of the lattice point's ramp, which rises towards one of the twelve edges of a cube (Perlin 2002).
inline double ramp(std::uint32_t bits, double x, double y, double z) {
    static constexpr double kRamps[16][3] = {{1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
                                             {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
                                             {1, 1, 0},  {-1, 1, 0},  {0, -1, 1}, {0, -1, -1}};
    const double* r = kRamps[bits >> 28];
    return r[0] * x + r[1] * y + r[2] * z;
}

/// Gradient noise, about -1..1, one feature per unit; with a period (> 0) it repeats after so many units along x and y.
inline double noise(const dvec3& p, std::uint32_t seed, int period = 0) {
    int x = floorOf(p.x), y = floorOf(p.y), z = floorOf(p.z);
    double fx = p.x - x, fy = p.y - y, fz = p.z - z;
    auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    auto wrap = [&](int i) { return period ? (i % period + period) % period : i; };
    std::uint32_t xs[2] = {latticeX(wrap(x)), latticeX(wrap(x + 1))},
                  ys[2] = {latticeY(wrap(y)), latticeY(wrap(y + 1))};
    std::uint32_t zs[2] = {latticeZ(z) + scramble(seed), latticeZ(z + 1) + scramble(seed)};
    double value[2][2], u = fade(fx), v = fade(fy), w = fade(fz);
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j) {
            std::uint32_t row = ys[j] + zs[k];
            double left = ramp(scramble(xs[0] + row), fx, fy - j, fz - k);
            value[k][j] = left + u * (ramp(scramble(xs[1] + row), fx - 1, fy - j, fz - k) - left);
        }
    double near = value[0][0] + v * (value[0][1] - value[0][0]), far = value[1][0] + v * (value[1][1] - value[1][0]);
    return near + w * (far - near);
}

/// Octaves of noise, each of half the size and height of the one before; about -1..1.
inline double fractal(dvec3 p, int octaves, std::uint32_t seed, int period = 0) {
    double sum = 0, height = 0.5;
    for (int i = 0; i < octaves; ++i, height /= 2, p *= 2.0, period *= 2) sum += height * noise(p, seed + i, period);
    return sum;
}

/// Sharp crests where the noise crosses zero, 0..1; the octaves gather on the crests (Musgrave's ridged multifractal).
inline double ridges(dvec3 p, int octaves, std::uint32_t seed) {
    double sum = 0, height = 0.5, weight = 1;
    for (int i = 0; i < octaves; ++i, height /= 2, p *= 2.03) {
        double crest = 1 - std::abs(noise(p, seed + i));
        crest *= crest * weight;
        sum += height * crest;
        weight = glm::clamp(1.6 * crest, 0.0, 1.0);
    }
    return sum;
}

/// Distances from p to the nearest two of one random point per unit cell, and the nearest one's own number (Worley
/// 1996).
struct Cells {
    double nearest, second, luck;
};
inline Cells cells(const dvec3& p, std::uint32_t seed) {
    int x = floorOf(p.x), y = floorOf(p.y), z = floorOf(p.z);
    Cells found{9, 9, 0};
    for (int k = z - 1; k <= z + 1; ++k)
        for (int j = y - 1; j <= y + 1; ++j)
            for (int i = x - 1; i <= x + 1; ++i) {
                std::uint32_t bits = scramble(latticeX(i) + latticeY(j) + latticeZ(k) + scramble(seed));
                dvec3 point = dvec3(i, j, k) + dvec3(bits & 1023u, (bits >> 10) & 1023u, (bits >> 20) & 1023u) / 1024.0;
                double d = glm::dot(p - point, p - point);
                if (d < found.nearest)
                    found = {d, found.nearest, unit(scramble(bits))};
                else
                    found.second = std::min(found.second, d);
            }
    return {std::sqrt(found.nearest), std::sqrt(found.second), found.luck};
}

/// p moved about by noise: breaks up anything regular.
inline dvec3 warped(const dvec3& p, double frequency, double distance, std::uint32_t seed) {
    dvec3 q = p * frequency;
    return p + distance * dvec3(noise(q, seed), noise(q, seed + 101), noise(q, seed + 202));
}

/// A bump of height 1 at 0 that ends smoothly at 1.
inline double bump(double x) { return x >= 1 ? 0 : (1 - x * x) * (1 - x * x); }

} // namespace relief::meshes
