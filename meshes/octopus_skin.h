// The octopus' relief: suckers, papillae, folds and the fine plates between them.
#pragma once

#include "octopus.h"
#include "painting.h"
#include "stamps.h"

namespace relief::meshes {

/// A point of the skin and what grows there; everything is continuous across seams.
struct SkinPoint {
    dvec3 p{0};
    int arm = -1;          ///< 0..7, or -1 on the body
    double row = 0;        ///< along the arm, 0 at the body to kArmRows at the tip
    double turn = 0;       ///< around the arm, 0 and 1 at the top, 0.5 in the middle of the underside
    double belly = 0;      ///< 0 on the upper side, 1 on the underside
    double size = 1;       ///< detail is so much smaller on the thin parts of the arms
    int eye = 0;           ///< the nearer one
    double eyeAxis = 9;    ///< distance from its axis
    double calm = 1;       ///< 0 on eyes, low on the siphon: rough skin keeps away from them
    double funnel = 9;     ///< distance from the siphon's axis
    double groove = 0;     ///< 1 between the plates of the skin, 0 on them
    double dome = 0;       ///< the plates' own roundness, 0..1
    double wart = 0;       ///< height of a papilla, cage units
    double wartTip = 0;    ///< 1 on its top
    double sucker = 9;     ///< distance from the middle of the nearest sucker over its radius
    double suckerSize = 0; ///< its radius
};

class OctopusSkin {
public:
    OctopusSkin(const Cage& cage, const ReferenceSurface& surface);
    [[nodiscard]] SkinPoint at(const SurfacePoint& point) const;
    [[nodiscard]] static double height(const SkinPoint& skin);
    [[nodiscard]] const Eye& eye(int index) const { return eyes_[index]; }

private:
    /// What a face of the cage belongs to.
    struct Region {
        int arm = -1, row = 0, column = 0;
        bool isUnder = false, isWebEdge = false;
    };
    void findRegions(const Cage& cage);
    void strewSuckers();
    void strewPapillae();
    void strewPapillae(int tries, double low, double high, double spacing);
    [[nodiscard]] SkinPoint placeOf(const SurfacePoint& point) const;
    [[nodiscard]] double siphonDistance(const dvec3& p) const;

    const ReferenceSurface& surface_;
    std::vector<Region> regions_; ///< by face
    std::array<Eye, 2> eyes_{octopusEye(0), octopusEye(1)};
    Siphon siphon_ = octopusSiphon();
    std::vector<Stamps> suckers_{kArmCount, Stamps(0.1, 1.3)};
    Stamps papillae_{0.1, 3.2};
    Random random_{11};
};

inline OctopusSkin::OctopusSkin(const Cage& cage, const ReferenceSurface& surface) : surface_(surface) {
    findRegions(cage);
    strewSuckers();
    strewPapillae();
}

inline void OctopusSkin::findRegions(const Cage& cage) {
    for (const CagePart& part : cage.parts)
        for (int local = 0; local < int(part.faceCount); ++local) {
            Region& region = regions_.emplace_back();
            region.isUnder = part.name == "mouth";
            region.isWebEdge = part.name == "shell" && local < kArmCount; // its first row: the web between two arms
            if (!part.name.starts_with("arm")) continue;
            region.arm = part.name.back() - '0';
            region.row = local / kArmSides;
            region.column = local % kArmSides;
        }
}

inline SkinPoint OctopusSkin::placeOf(const SurfacePoint& point) const {
    const Region& region = regions_[point.face];
    SkinPoint skin;
    skin.p = point.p;
    if (region.arm >= 0) {
        bool isTip = region.row >= kArmRows;
        skin.arm = region.arm;
        skin.row = isTip ? kArmRows : std::max(0.0, region.row + point.uv.y);
        skin.turn = (region.column + point.uv.x) / kArmSides;
        skin.belly = glm::clamp(2 - std::abs(skin.turn - 0.5) * kArmSides, 0.0, 1.0);
        skin.size = 0.25 + 0.75 * std::exp(-2.0 * std::pow(skin.row / kArmRows, 1.5));
    }
    if (region.isUnder) skin.belly = 1;
    if (region.isWebEdge) skin.belly = glm::clamp(1 - point.uv.y, 0.0, 1.0);
    for (int i = 0; i < 2; ++i) {
        dvec3 d = point.p - eyes_[i].center;
        double height = glm::dot(d, eyes_[i].axis), away = glm::length(d - height * eyes_[i].axis);
        if (std::abs(height) < 0.6 && away < skin.eyeAxis) skin.eyeAxis = away, skin.eye = i;
    }
    skin.funnel = siphonDistance(point.p);
    skin.calm = smoothstep(0.19, 0.27, skin.eyeAxis) * glm::mix(0.15, 1.0, smoothstep(0.14, 0.30, skin.funnel));
    return skin;
}

/// From the funnel's axis.
inline double OctopusSkin::siphonDistance(const dvec3& p) const {
    double t = glm::clamp(glm::dot(p - siphon_.root, siphon_.out), -0.1, 0.4);
    return glm::distance(p, siphon_.root + t * siphon_.out + t * t * siphon_.bend);
}

/// Two staggered rows under each arm; their size follows the arm's.
inline void OctopusSkin::strewSuckers() {
    constexpr double kFirstRow = 0.95, kStep = 0.61;
    for (int face = 0; face < int(regions_.size()); ++face) {
        const Region& region = regions_[face];
        if (region.arm < 0 || (region.column != 2 && region.column != 3)) continue;
        for (int i = region.column - 2;; i += 2) { // even ones left, odd ones right
            double v = kFirstRow + i * kStep - region.row;
            if (v >= 1 || region.row >= kArmRows) break;
            if (v < 0) continue;
            dvec2 uv(region.column == 2 ? 0.52 : 0.48, v);
            LimitFrame frame = surface_.limit(face, uv);
            double radius = 0.43 * glm::length(frame.pu) * random_(0.92, 1.05); // p_u: a sixth of the way round
            suckers_[region.arm].add({frame.p, radius, {}, random_(), 0});
        }
    }
}

/// Two horns over each eye, then papillae of three sizes, large ones first.
inline void OctopusSkin::strewPapillae() {
    for (const Eye& eye : eyes_)
        for (double angle : {66.0, 112.0}) {
            dvec3 out = std::cos(radians(angle)) * eye.right + std::sin(radians(angle)) * eye.up;
            papillae_.add({eye.center + 0.225 * out + 0.13 * eye.axis, 0.085, {}, 1, 1});
        }
    strewPapillae(1500, 0.060, 0.095, 1.7);
    strewPapillae(8000, 0.032, 0.055, 1.3);
    strewPapillae(25000, 0.016, 0.028, 1.1);
}

inline void OctopusSkin::strewPapillae(int tries, double low, double high, double spacing) {
    for (int i = 0; i < tries; ++i) {
        int face = int(random_() * double(regions_.size()));
        dvec2 uv{random_(), random_()};
        LimitFrame frame = surface_.limit(face, uv);
        if (random_() > glm::length(glm::cross(frame.pu, frame.pv)) / 0.06) continue; // even density over the area
        SkinPoint skin = placeOf({face, uv, {}, frame.p, {}});
        double radius = random_(low, high) * skin.size, crowd = fractal(frame.p * 1.7, 2, 31);
        if (skin.belly > 0.25 || skin.eyeAxis < 0.30 || skin.calm < 0.7 || crowd < random_(-0.4, 0.3)) continue;
        if (papillae_.isFree(frame.p, radius, spacing)) papillae_.add({frame.p, radius, {}, random_(), 0});
    }
}

inline SkinPoint OctopusSkin::at(const SurfacePoint& point) const {
    SkinPoint skin = placeOf(point);
    Cells cell = cells(warped(point.p, 5, 0.05, 41) * 12.0, 43);
    skin.groove = 1 - smoothstep(0.02, 0.25, cell.second - cell.nearest);
    skin.dome = std::max(0.0, 1 - 1.3 * cell.nearest * cell.nearest) * smoothstep(0.0, 0.4, cell.second - cell.nearest);
    papillae_.forEachNear(point.p, [&](const Stamp& wart, double x) {
        double tall = 0.45 + 0.45 * wart.luck;
        skin.wart = std::max(skin.wart, wart.radius * tall * bump(x));
        skin.wartTip = std::max(skin.wartTip, 1 - smoothstep(0.25, 0.75, x));
    });
    if (skin.arm >= 0 && skin.belly > 0.3)
        suckers_[skin.arm].forEachNear(point.p, [&](const Stamp& sucker, double x) {
            if (x < skin.sucker) skin.sucker = x, skin.suckerSize = sucker.radius;
        });
    return skin;
}

/// A cup with a swollen rim; x is the distance from its middle over its radius.
inline double suckerProfile(double x) {
    double rim = (x - 0.72) / 0.23, pedestal = 0.24 * (1 - smoothstep(0.78, 1.22, x));
    return pedestal + 0.42 * std::exp(-rim * rim) - 0.34 * (1 - smoothstep(0.20, 0.62, x));
}

/// Wrinkles that lie level on the body.
inline double bodyFolds(const dvec3& p) {
    return 0.034 * (ridges(warped(p, 1.5, 0.25, 57) * dvec3(1.6, 6.5, 1.6), 3, 53) - 0.45);
}

/// Wrinkles that run across an arm.
inline double armFolds(const SkinPoint& skin) {
    double a = 2 * kPi * skin.turn;
    dvec3 around(0.7 * std::cos(a), 0.7 * std::sin(a), 1.7 * skin.row + 10 * skin.arm);
    return 0.024 * skin.size * (ridges(around, 3, 59) - 0.45);
}

/// Soft lumps, and the wrinkles of body and arm, which give way to each other near the arm's root.
inline double skinFolds(const SkinPoint& skin) {
    double lumps = 0.07 * fractal(skin.p * 1.5, 3, 51) * skin.size, share = smoothstep(0, 3, skin.row);
    if (share > 0) lumps += share * armFolds(skin);
    if (share < 1) lumps += (1 - share) * bodyFolds(skin.p);
    return lumps;
}

/// Rings of loose skin around an eye.
inline double eyeFolds(double eyeAxis) {
    double amount = smoothstep(0.20, 0.26, eyeAxis) * (1 - smoothstep(0.30, 0.52, eyeAxis));
    return 0.012 * amount * std::sin(eyeAxis * 95);
}

inline double OctopusSkin::height(const SkinPoint& skin) {
    double upper = 1 - smoothstep(0.2, 0.7, skin.belly);
    double bare = smoothstep(-0.25, 0.15, fractal(skin.p * 1.3, 2, 63)); // some patches are smoother than others
    double plates = (0.010 + 0.020 * bare) * skin.size * skin.dome + 0.005 * skin.size * fractal(skin.p * 28.0, 2, 61);
    double detail = skinFolds(skin) * (0.35 + 0.65 * upper) + plates * (0.3 + 0.7 * upper) + eyeFolds(skin.eyeAxis);
    double sucker = skin.suckerSize > 0 ? skin.suckerSize * suckerProfile(skin.sucker) : 0;
    double tip = 1 - smoothstep(kArmRows - 4, kArmRows - 1.5, skin.row);
    return tip * (skin.calm * (detail + skin.wart) + sucker);
}

} // namespace relief::meshes
