// Internal: real transforms in which central differences of one axis are diagonal.
#pragma once

#include <complex>
#include <memory>
#include <span>
#include <vector>

#include "displacement/displacement.h"

namespace relief {

/// One axis of a map. Let D be central differences over one texel, (h[i+1] - h[i-1]) / 2, as the axis continues at its
/// ends. The vectors w_k make D^T D diagonal, with the eigenvalue sin^2(a_k):
///   repeat  w_k[i] = cos(a_k i) + sin(a_k i), a_k = 2 pi k / size   (Hartley transform)
///   clamp   w_k[i] = cos(a_k (i + 1/2)),      a_k = pi k / size     (cosine transform, DCT-II)
class AxisTransform {
public:
    AxisTransform(int size, Wrap wrap);
    AxisTransform(const AxisTransform&) = delete;
    AxisTransform& operator=(const AxisTransform&) = delete;
    ~AxisTransform();

    [[nodiscard]] int size() const { return size_; }
    /// a_k, radians.
    [[nodiscard]] double angle(int k) const;
    /// Whether D of the vector is 0: constants, and waves of two texels along an axis that repeats.
    [[nodiscard]] bool isHidden(int k) const { return k == 0 || (wrap_ == Wrap::repeat && 2 * k == size_); }
    /// Replaces two rows of `size` numbers by their coefficients: dot products with the vectors.
    void forward(std::span<double> a, std::span<double> b);
    /// Replaces coefficients by their rows.
    void inverse(std::span<double> a, std::span<double> b);

private:
    void hartley(std::span<double> a, std::span<double> b, double factor);
    void cosine(std::span<double> a, std::span<double> b);
    void inverseCosine(std::span<double> a, std::span<double> b);

    struct Fourier; ///< plans of the library
    int size_;
    Wrap wrap_;
    std::unique_ptr<Fourier> fourier_;
    std::vector<std::complex<double>> in_, out_; ///< two real rows, as real and imaginary parts
    std::vector<std::complex<double>> phases_;   ///< clamp: exp(-i pi k / 2 size)
};

} // namespace relief
