// Internal: pictures of methods compared with those of the reference, and the times of their frames.
#pragma once

#include "measure/compression.h"

namespace relief {

/// A method at one tolerance: a compressed surface or a mesh.
struct PicturedMethod {
    Method method;
    std::optional<Compression> compression; ///< either this,
    const DenseMesh* mesh = nullptr;        ///< or this
    bool isTimed = false; ///< false where the device draws more bytes than the method has: its times would mislead
};

class PictureComparison {
public:
    /// Draws the reference of the study from two views.
    PictureComparison(SuiteContext& context, CompressionStudy& study);

    /// Draws all methods and compares them with the reference. Pictures of the first call go into the results.
    void compare(double tolerance, const std::vector<PicturedMethod>& methods);
    /// Adds what the latest compare() found of a method; nothing for a method that it did not draw.
    void addTo(Row& row) const;

private:
    /// A finished picture.
    struct View {
        Image image;                ///< display values 0..1
        std::vector<bool> isObject; ///< per pixel
        std::string png;
    };
    struct Comparison {
        double squares = 0, count = 0;  ///< differences of display values over the object's pixels, all views
        std::vector<double> frameTimes; ///< ms
        std::vector<View> views;

        [[nodiscard]] double rmse() const;
    };

    [[nodiscard]] RenderOptions renderOptions(std::size_t view) const;
    View finish(const Picture& picture);
    static void addView(Comparison& comparison, View view, const View& reference);
    void addPair(double tolerance, Method left, Method right);

    SuiteContext& context_;
    CompressionStudy& study_;
    ScratchFolder folder_;
    Renderer renderer_;
    std::vector<Camera> views_;
    Bounds bounds_;
    std::vector<View> reference_; ///< per view
    std::map<Method, Comparison> comparisons_;
    bool hasPair_ = false;
};

} // namespace relief
