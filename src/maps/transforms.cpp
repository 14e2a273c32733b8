#include "maps/transforms.h"

#include <cmath>
#include <numbers>

#include <unsupported/Eigen/FFT>

namespace relief {

using Complex = std::complex<double>;

struct AxisTransform::Fourier {
    Eigen::FFT<double> plans;
};

AxisTransform::AxisTransform(int size, Wrap wrap)
    : size_(size), wrap_(wrap), fourier_(std::make_unique<Fourier>()), in_(std::size_t(size)), out_(std::size_t(size)) {
    fourier_->plans.SetFlag(Eigen::FFT<double>::Unscaled);
    if (wrap == Wrap::repeat) return;
    for (int k = 0; k < size; ++k) phases_.push_back(std::polar(1.0, -std::numbers::pi * k / (2.0 * size)));
}

AxisTransform::~AxisTransform() = default;

double AxisTransform::angle(int k) const {
    const double turns = wrap_ == Wrap::repeat ? 2.0 * k / size_ : double(k) / size_; // of pi
    return std::numbers::pi * turns;
}

void AxisTransform::forward(std::span<double> a, std::span<double> b) {
    if (size_ == 1) return; // the library has no plan of that length
    if (wrap_ == Wrap::repeat)
        hartley(a, b, 1);
    else
        cosine(a, b);
}

void AxisTransform::inverse(std::span<double> a, std::span<double> b) {
    if (size_ == 1) return;
    if (wrap_ == Wrap::repeat)
        hartley(a, b, 1.0 / size_); // its own inverse
    else
        inverseCosine(a, b);
}

/// The transform of a real row is Re F - Im F of its Fourier transform F. Of the transform Z of a + ib, those of a and
/// b are (Z[k] + conj Z[-k]) / 2 and (Z[k] - conj Z[-k]) / 2i.
void AxisTransform::hartley(std::span<double> a, std::span<double> b, double factor) {
    const std::size_t count = a.size();
    for (std::size_t i = 0; i < count; ++i) in_[i] = {a[i], b[i]};
    fourier_->plans.fwd(out_.data(), in_.data(), size_);
    for (std::size_t k = 0; k < count; ++k) {
        const Complex z = out_[k], mirrored = std::conj(out_[k == 0 ? 0 : count - k]);
        const Complex ofA = 0.5 * (z + mirrored), ofB = Complex(0, -0.5) * (z - mirrored);
        a[k] = factor * (ofA.real() - ofA.imag());
        b[k] = factor * (ofB.real() - ofB.imag());
    }
}

/// By a Fourier transform of the same length (Makhoul 1980): even entries in order, then the odd ones backwards.
void AxisTransform::cosine(std::span<double> a, std::span<double> b) {
    const std::size_t count = a.size();
    for (std::size_t i = 0; i < count; ++i) in_[i % 2 == 0 ? i / 2 : count - 1 - i / 2] = {a[i], b[i]};
    fourier_->plans.fwd(out_.data(), in_.data(), size_);
    for (std::size_t k = 0; k < count; ++k) {
        const Complex z = out_[k], mirrored = std::conj(out_[k == 0 ? 0 : count - k]);
        a[k] = (phases_[k] * 0.5 * (z + mirrored)).real();
        b[k] = (phases_[k] * Complex(0, -0.5) * (z - mirrored)).real();
    }
}

void AxisTransform::inverseCosine(std::span<double> a, std::span<double> b) {
    const std::size_t count = a.size();
    const auto spectrum = [&](std::span<const double> row, std::size_t k) {
        return std::conj(phases_[k]) * Complex(row[k], k == 0 ? 0 : -row[count - k]);
    };
    for (std::size_t k = 0; k < count; ++k) in_[k] = spectrum(a, k) + Complex(0, 1) * spectrum(b, k);
    fourier_->plans.inv(out_.data(), in_.data(), size_);
    for (std::size_t i = 0; i < count; ++i) {
        const Complex both = out_[i % 2 == 0 ? i / 2 : count - 1 - i / 2] / double(count);
        a[i] = both.real();
        b[i] = both.imag();
    }
}

} // namespace relief
