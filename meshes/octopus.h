// The octopus' control cage: body, eyes, siphon and eight arms as one closed surface, with its texture islands.
#pragma once

#include "octopus_arms.h"
#include "octopus_body.h"

namespace relief::meshes {

/// Cage units to one side of the texture square, for islands at the common texel density.
constexpr double kTexUnits = 7.2;

struct OctopusBuilder {
    CageBuilder cage;
    std::vector<Loop> rings; ///< the body's rings of kColumns points

    void addRings();
    void addShell();
    void addMantle();
    void addMouth();
    void addEye(int index);
    void addSiphon();
    void addArm(int index);
    [[nodiscard]] Loop blockLoop(int row, int column, int rows, int columns) const;
};

/// True where a quad of the shell makes room for an eye, the siphon or an arm.
inline bool isGap(int row, int column) {
    if (row == 0) return column % 3 != 0;
    for (double eye : kEyeColumns)
        if ((row == kEyeRow - 1 || row == kEyeRow) && (column == int(eye) - 1 || column == int(eye))) return true;
    return row == kSiphonRow && (column == kSiphonColumn || column == kSiphonColumn + 1);
}

inline void OctopusBuilder::addRings() {
    for (const BodyRing& ring : bodyRings()) {
        Loop& loop = rings.emplace_back();
        for (int j = 0; j < kColumns; ++j) loop.push_back(cage.point(swellAroundEyes(ringPoint(ring, j))));
    }
}

/// The points around a block of quads, counter-clockwise from outside, from its lower left corner.
inline Loop OctopusBuilder::blockLoop(int row, int column, int rows, int columns) const {
    Loop loop;
    auto add = [&](int i, int j) { loop.push_back(this->rings[i][(j + kColumns) % kColumns]); };
    for (int j = 0; j < columns; ++j) add(row, column + j);
    for (int i = 0; i < rows; ++i) add(row + i, column + columns);
    for (int j = 0; j < columns; ++j) add(row + rows, column + columns - j);
    for (int i = 0; i < rows; ++i) add(row + rows - i, column);
    return loop;
}

/// The skin between the arms' roots and the mantle's cap, one island cut open at the back.
inline void OctopusBuilder::addShell() {
    constexpr int kBackColumn = 12;
    constexpr double kLeft = 0.010, kBottom = 0.522, kWidth = 0.695;
    std::vector<double> heights{0};
    for (std::size_t i = 1; i < rings.size(); ++i)
        heights.push_back(heights.back() + glm::distance(cage.position(rings[i][11]), cage.position(rings[i - 1][11])));
    cage.part("shell");
    TexGrid tex(cage, [&](int row, int column) {
        return dvec2(kLeft + kWidth * column / kColumns, kBottom + heights[row] / kTexUnits);
    });
    for (int row = 0; row + 1 < int(rings.size()); ++row)
        for (int c = 0; c < kColumns; ++c) {
            int j = (kBackColumn + c) % kColumns, next = (j + 1) % kColumns;
            if (isGap(row, j)) continue;
            cage.quad({rings[row][j], tex(row, c)}, {rings[row][next], tex(row, c + 1)},
                      {rings[row + 1][next], tex(row + 1, c + 1)}, {rings[row + 1][j], tex(row + 1, c)});
        }
}

/// The dome of the mantle: part of a sphere that continues the shoulder.
inline void OctopusBuilder::addMantle() {
    constexpr double kSpan = 58; // degrees from the shoulder to the top
    const BodyRing& last = bodyRings().back();
    double lean = radians(last.lean), span = radians(kSpan), sphere = 1.12 * last.across / std::sin(span);
    dvec3 up(0, std::cos(lean), -std::sin(lean));
    cage.part("mantle");
    capLoop(
        cage, rings.back(),
        [&](double ring, double turn) {
            double rise = sphere * (std::cos(span * ring) - std::cos(span));
            return ringPoint(last, turn * kColumns, std::sin(span * ring) / std::sin(span)) + rise * up;
        },
        [](dvec2 p) { return dvec2(0.855, 0.870) + 0.120 * p; });
}

/// The underside, which nobody sees: coarse in the texture, drawn up a little where the beak would be.
inline void OctopusBuilder::addMouth() {
    Loop loop = rings.front();
    std::reverse(loop.begin() + 1, loop.end());
    cage.part("mouth");
    capLoop(
        cage, loop,
        [](double ring, double turn) {
            const BodyRing& first = bodyRings().front();
            return ringPoint(first, -turn * kColumns, ring) + dvec3(0, 0.25 * (1 - ring * ring), 0);
        },
        [](dvec2 p) { return dvec2(0.890, 0.580) + 0.055 * p; });
}

/// Rings from the foot of the mound over lid and fold to the eyeball; a round island of twice the common density.
inline void OctopusBuilder::addEye(int index) {
    // The points of the rings; the outermost ones are the body's own, moved.
    Eye eye = octopusEye(index);
    int column = int(kEyeColumns[index]);
    std::vector<Loop> loops{blockLoop(kEyeRow - 1, column - 1, 2, 2)};
    std::vector<double> lengths{0}; // arc length from the foot inwards
    for (std::size_t i = 0; i < std::size(kEyeRings); ++i) {
        if (i) loops.emplace_back();
        for (int k = 0; k < 8; ++k) {
            dvec3 p = eyeRingPoint(eye, kEyeRings[i], 225 + 45 * k);
            if (i)
                loops[i].push_back(cage.point(p));
            else
                cage.move(loops[0][k], p);
        }
        if (i)
            lengths.push_back(lengths[i - 1] + std::hypot(kEyeRings[i].radius - kEyeRings[i - 1].radius,
                                                          kEyeRings[i].height - kEyeRings[i - 1].height));
    }
    // Texture coordinates by arc length, so that texels are about square.
    double total = lengths.back() + kEyeRings[std::size(kEyeRings) - 1].radius;
    auto texCoordAt = [&](double radius, dvec2 direction) {
        return dvec2(0.773, index ? 0.683 : 0.576) + 0.051 * radius / total * direction;
    };
    TexGrid tex(
        cage,
        [&](int row, int k) {
            double angle = radians(225 + 45 * k);
            return texCoordAt(total - lengths[row], {std::cos(angle), std::sin(angle)});
        },
        8);
    // Faces between the rings, then four around the middle of the pupil.
    cage.part(index ? "eye left" : "eye right");
    joinLoops(cage, loops, tex);
    Corner middle{rings[kEyeRow][column],
                  cage.tex(texCoordAt(0, {1, 0}))}; // the ring's own point, which the gap left over
    cage.move(middle.point, eye.center + kEyeTop * eye.axis);
    int last = int(loops.size()) - 1;
    auto rim = [&](int k) { return Corner{loops[last][k % 8], tex(last, k % 8)}; };
    for (int k = 1; k < 8; k += 2) cage.quad(rim(k), rim(k + 1), rim(k + 2), middle);
}

/// A short funnel at the side of the neck, bent forward and hollow.
inline void OctopusBuilder::addSiphon() {
    struct Ring {
        double ahead, radius;
    };
    constexpr Ring kRings[] = {{0.07, 0.125},  {0.18, 0.105}, {0.30, 0.112},
                               {0.325, 0.092}, {0.28, 0.072}, {0.14, 0.055}};
    // Rings along a parabola, the last ones within the others.
    std::vector<Loop> loops{blockLoop(kSiphonRow, kSiphonColumn, 1, 2)};
    Siphon siphon = octopusSiphon();
    dvec3 previous = siphon.root;
    std::vector<double> heights{0};
    for (const Ring& ring : kRings) {
        double t = ring.ahead;
        dvec3 middle = siphon.root + t * siphon.out + t * t * siphon.bend;
        dvec3 along = glm::normalize(siphon.out + 2 * t * siphon.bend);
        dvec3 side = glm::normalize(glm::cross(dvec3(0, 1, 0), along)), up = glm::cross(along, side);
        loops.push_back(addSixLoop(cage, {middle, side, up, ring.radius, ring.radius}));
        heights.push_back(heights.back() + std::max(0.035, glm::distance(middle, previous)));
        previous = middle;
    }
    // Faces between the rings, and a floor inside.
    heights.push_back(heights.back() + 0.05);
    TexGrid tex(
        cage, [&](int row, int column) { return dvec2(0.840 + 0.100 * column / 6, 0.643 + heights[row] / kTexUnits); });
    cage.part("siphon");
    joinLoops(cage, loops, tex, 4);
    closeSix(cage, loops.back(), tex, int(loops.size()) - 1, 2);
}

/// One arm out of its root on the body; a tapering strip, every second one upside down beside its neighbour.
inline void OctopusBuilder::addArm(int index) {
    const Arm& arm = octopusArms()[index];
    std::vector<Loop> loops{blockLoop(0, 3 * index + 1, 1, 2)};
    std::vector<double> v{0}; // length so far over the arm's length
    dvec3 previous = centerOf(cage, loops[0]);
    for (const ArmSection& section : sweepArm(arm, armAzimuth(index), previous)) {
        loops.push_back(addSixLoop(cage, {section.center, section.side, section.up, section.radius, section.radius}));
        v.push_back(v.back() + glm::distance(section.center, previous) / arm.length);
        previous = section.center;
    }
    v.push_back(v.back() + 0.006);
    dvec2 middle(0.0885 + 0.1175 * index, 0.265);
    TexGrid tex(cage, [&](int row, int column) {
        double width = glm::mix(0.166, 0.046, v[row]);
        dvec2 st(width * (column - 3) / 6, 0.510 * (v[row] - 0.5));
        return index % 2 ? middle - st : middle + st;
    });
    cage.part(fmt::format("arm {}", index));
    joinLoops(cage, loops, tex, 4);
    closeSix(cage, loops.back(), tex, kArmRows, 2);
}

inline Cage makeOctopus() {
    OctopusBuilder builder;
    builder.addRings();
    for (int i = 0; i < 2; ++i) builder.addEye(i);
    builder.addShell();
    builder.addMantle();
    builder.addMouth();
    builder.addSiphon();
    for (int i = 0; i < kArmCount; ++i) builder.addArm(i);
    return builder.cage.finish("octopus");
}

} // namespace relief::meshes
