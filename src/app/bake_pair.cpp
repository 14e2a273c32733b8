// The cage and the sculpt that `relief bake` is called with.
#include <algorithm>
#include <cmath>

#include "app/bake_maps.h"

namespace relief::app {
namespace {

std::string describeBox(const Bounds& box) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})", box.lower.x, box.lower.y, box.lower.z,
                       box.upper.x, box.upper.y, box.upper.z);
}

TriangleMesh readTriangleSculpt(const BakeArgs& args, const Coordinates& coordinates, const Warn& warn) {
    TriangleMesh mesh = readSculpt(args.sculpt, coordinates, warn);
    const SculptFaults faults = windAlike(mesh);
    if (faults.turnedCount > 0)
        warn(fmt::format("{}: {} of {} triangles were wound against those around them; they are turned over",
                         args.sculpt, faults.turnedCount, mesh.indices.size() / 3));
    if (faults.nonManifoldCount > 0)
        warn(fmt::format("{}: {} edges have more than two triangles (not manifold); the winding is not followed across "
                         "them",
                         args.sculpt, faults.nonManifoldCount));
    if (faults.nonOrientableCount > 0)
        warn(fmt::format("{}: {} edges have triangles that cannot be wound alike (as of a Moebius strip)", args.sculpt,
                         faults.nonOrientableCount));
    return mesh;
}

/// Which side of the sculpt is outside, as seen from the surface. A sculpt that is wound the other way is taken as it
/// is, with a word about it.
Facing chooseFacing(const BakeArgs& args, const SculptSides& sides, const Bounds& cageBox, const Bounds& sculptBox,
                    const Warn& warn) {
    const std::uint64_t hits = sides.frontCount + sides.backCount;
    if (hits == 0)
        fail(Failure::input,
             "{}: none of {} lines along the normals of {} meets it within --max-distance; the cage's box is {}, the "
             "sculpt's {}",
             args.sculpt, sides.lineCount, args.object.cage, describeBox(cageBox), describeBox(sculptBox));
    if (sides.facing() == Facing::back)
        warn(fmt::format("{}: its triangles are wound inside out ({:.0f} % of the lines see their backs); the other "
                         "side is taken for the outside",
                         args.sculpt, 100.0 * double(sides.backCount) / double(hits)));
    const double fewer = double(std::min(sides.frontCount, sides.backCount)) / double(hits);
    if (fewer > 0.1)
        warn(fmt::format("{}: {:.0f} % of the lines meet a triangle first that faces the other way; is the surface far "
                         "from the sculpt, or are its parts wound differently?",
                         args.sculpt, 100 * fewer));
    return sides.facing();
}

LoadedObject loadObject(const BakeArgs& args, const Warn& warn) {
    LoadedObject object = load(args.object, CageState::posed, warn);
    if (object.dense)
        fail(Failure::usage, "{}: maps are baked for subdivision surfaces; name its --scheme", args.object.cage);
    const bool isPerFace = args.perFace || (object.height && object.height->addressing == Addressing::faces);
    if (!object.cage.hasTexCoords() && !isPerFace)
        fail(Failure::input, "{}: there are no texture coordinates to bake over; --per-face needs none",
             args.object.cage);
    if (args.perFace && object.surface.sideCount != 4)
        fail(Failure::usage, "--per-face: faces need four sides; use --scheme catmark or bilinear");
    return object;
}

/// How far vertices of the cage move where no distance is given, in units of the object: past the sculpt, as twenty
/// thousand lines from the surface find it (four per face where faces are many), and no farther, because lines of cages
/// that are inflated more begin above other sheets.
double chooseInflation(const ReferenceSurface& reference, const MeasuredSurface& sculpt, const LineSearch& lines) {
    constexpr int kLines = 20'000;
    constexpr double kMore = 1.5;   // lines miss the tips
    constexpr double kLeast = 0.01; // of the reach: past the rounding of positions, where the sculpt is nowhere above
    const SculptLines along(reference, sculpt, lines);
    const int perSide = std::clamp(int(std::ceil(std::sqrt(double(kLines) / reference.faceCount()))), 2, 32);
    double highest = 0;
    for (int face = 0; face < reference.faceCount(); ++face)
        for (int i = 0; i < perSide * perSide && !reference.isHole(face); ++i) {
            const dvec2 uv = (dvec2(i % perSide, i / perSide) + 0.5) / double(perSide);
            if (reference.sideCount() == 3 && uv.x + uv.y > 1) continue;
            if (const std::optional<LineHit> hit = along.find(along.lineAt(face, uv)))
                highest = std::max(highest, hit->height);
        }
    return std::clamp(kMore * highest, kLeast * lines.reach.front, lines.reach.front);
}

/// The cage that lines begin on, in the coordinates of the object's.
std::optional<Cage> makeLineCage(const BakeArgs& args, const LoadedObject& object, double inflation, const Warn& warn) {
    if (args.smoothCage) return inflateCage(object.cage, inflation);
    if (args.lineCage.empty()) return {};
    ObjectDesc desc = args.object;
    desc.cage = args.lineCage, desc.height = {}, desc.motion = {};
    const LoadedObject other = load(desc, CageState::posed, warn);
    if (hashTopology(other.cage) != hashTopology(object.cage))
        fail(Failure::input,
             "{}: its {} vertices and {} faces are not those of {} ({} and {}) in the same order; --cage takes a copy "
             "of "
             "the cage with its vertices moved",
             args.lineCage, other.cage.positions.size(), other.cage.faceSizes.size(), args.object.cage,
             object.cage.positions.size(), object.cage.faceSizes.size());
    Cage cage = object.cage;
    for (std::size_t i = 0; i < cage.positions.size(); ++i)
        cage.positions[i] =
            vec3(cage.coordinates.toLocal(other.cage.coordinates.toWorld(dvec3(other.cage.positions[i]))));
    return cage;
}

} // namespace

BakePair::BakePair(const BakeArgs& args, const Warn& warn)
    : object(loadObject(args, warn)), reference(object.cage, object.options), directions(object.surface, reference),
      sculpt(loadSculpt(args, warn)) {
    unit = object.cage.coordinates.unit, diagonal = sculptBox.diagonal() * unit;
    lines.reach = {args.front.cageUnits(diagonal) / unit, args.back.cageUnits(diagonal) / unit};
    lines.directions = &directions;
    const auto chooseSide = [&] {
        lines.facing = chooseFacing(args, findSides(reference, sculpt, lines), summarize(object.cage).bounds,
                                    object.cage.coordinates.toWorld(sculptBox), warn);
    };
    double inflation = lines.reach.front;
    const bool measuresInflation = args.smoothCage && !args.hasReach;
    if (measuresInflation) {
        chooseSide();
        inflation = chooseInflation(reference, sculpt, lines);
    }
    if (const std::optional<Cage> cage = makeLineCage(args, object, inflation, warn)) {
        lineCage.emplace(*cage, object.options);
        lines.cage = &*lineCage;
    }
    if (!measuresInflation) chooseSide();
}

MeasuredSurface BakePair::loadSculpt(const BakeArgs& args, const Warn& warn) {
    TriangleMesh mesh = readTriangleSculpt(args, object.cage.coordinates, warn);
    sculptBox = computeBounds(mesh.positions);
    triangleCount = mesh.indices.size() / 3;
    constexpr std::size_t kSamples = 200'000;
    return MeasuredSurface::ofMesh(std::move(mesh), kSamples, TreeUse::lines);
}

} // namespace relief::app
