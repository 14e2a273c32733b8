// Internal: what contestants look like beside the reference, and how long frames of those that can be drawn take.
#pragma once

#include <cmath>

#include "measure/contest.h"

namespace relief {

/// A contestant at one tolerance: a surface or a mesh.
struct Drawable {
    std::string name;
    std::optional<Saving> saving;
    const DenseMesh* mesh = nullptr;
    bool isTimed = false; ///< the device holds it as its bytes say: others only have their picture compared
};

class Looks {
public:
    Looks(Bench& bench, Contest& contest);

    /// Draws all of them; pictures of the first tolerance go into the report.
    void judge(double tolerance, const std::vector<Drawable>& all);
    /// Adds what was seen of the latest.
    void tell(const std::string& name, Row& row) const;

private:
    /// A finished picture: display values, and where the object is.
    struct Seen {
        Image image;
        std::vector<bool> isObject;
        std::string png;
    };
    struct Look {
        double squares = 0, count = 0; ///< differences of display values 0..1 over the object's pixels, both views
        std::vector<double> frame;
        std::vector<std::string> pngs;
        std::vector<Image> images;

        [[nodiscard]] double rmse() const { return count > 0 ? std::sqrt(squares / count) : 0; }
    };

    Seen seen(const Picture& picture);
    void compare(Look& look, Seen seen, const Seen& reference);
    void addPair(double tolerance, const std::string& left, const std::string& right);

    Bench& bench_;
    Contest& contest_;
    ScratchFolder folder_;
    Renderer renderer_;
    std::vector<Camera> views_;
    Bounds bounds_;
    std::vector<Seen> reference_;
    std::map<std::string, Look> looks_;
    bool hasPair_ = false;
};

} // namespace relief
