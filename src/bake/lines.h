// The lines that look for a sculpt: where they begin and which way they look.
#pragma once

#include "displacement/displacement.h"
#include "distance/distance.h"

namespace relief {

/// The direction that displacement moves each point of a surface in: the limit normal, and on edges and corners whose
/// faces have different normals the direction that they share (src/README.md, "Watertightness", 4).
class DisplacementDirections {
public:
    /// The surfaces have to outlive it and must be of one cage.
    DisplacementDirections(const Surface& surface, const ReferenceSurface& reference);

    /// A unit vector. Points are on a side of a face where their (u,v) is to the bit.
    [[nodiscard]] dvec3 at(int face, const dvec2& uv) const;

private:
    /// Edges and corners along a side of a face that share a direction.
    struct SharedSide {
        struct Stretch {
            std::uint32_t edge = kNoPatch;
            float start = 0, end = 0; ///< along the side
        };
        Stretch stretches[2];
        std::uint32_t corner = kNoPatch; ///< at the side's beginning
        std::uint32_t middle = kNoPatch; ///< the corner in the middle of a split side
    };

    [[nodiscard]] std::optional<dvec3> ofCorner(std::uint32_t corner) const;
    [[nodiscard]] std::optional<dvec3> onSide(int face, int side, double x) const;

    const Surface& surface_;
    const ReferenceSurface& reference_;
    std::vector<SharedSide> sides_; ///< by face and side; empty where nothing is shared
};

/// Where lines look for a sculpt.
struct LineSearch {
    LineReach reach;               ///< along the direction of displacement and against it
    Facing facing = Facing::front; ///< of the triangles that count
    /// Not null: lines begin as high above the surface as the same point (face,u,v) of this one lies above it, and look
    /// inwards from there; the first hit counts. Where it lies inside of the surface, as inflated cages do at ends that
    /// are thinner than they move, the nearest hit on both sides does.
    const ReferenceSurface* cage = nullptr;
    const DisplacementDirections* directions = nullptr; ///< null: the limit normals
};

/// Looks for a sculpt along lines through points of a surface. Several threads may ask.
class SculptLines {
public:
    /// All of them have to outlive it.
    SculptLines(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const LineSearch& search)
        : surface_(surface), sculpt_(sculpt), search_(search) {}

    /// A point of the surface, and the line through it.
    struct Line {
        LimitFrame frame;
        dvec3 direction{0};
        double start = 0; ///< with a cage: its height above the point, which is below 0 where the cage lies inside
    };
    [[nodiscard]] Line lineAt(int face, const dvec2& uv) const;
    /// Without a cage the hit nearest to the surface in both directions wins (Lee, Moreton and Hoppe 2000,
    /// section 4.4), with a cage the first one below it. LineHit::height is the height above the surface in either
    /// case.
    [[nodiscard]] std::optional<LineHit> find(const Line& line, Facing facing) const;
    [[nodiscard]] std::optional<LineHit> find(const Line& line) const { return find(line, search_.facing); }

private:
    const ReferenceSurface& surface_;
    const MeasuredSurface& sculpt_;
    LineSearch search_;
};

/// Moves the vertices of a cage along their normals: means of those of the polygons around them weighted by area,
/// whether edges are sharp or not. Vertices without a normal stay.
Cage inflateCage(const Cage& cage, double distance);

} // namespace relief
