// Bump mapping and normal maps: the normals that a picture shows, against closed forms and the reference.
#include <functional>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "seen.h"

namespace relief::test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
class DetailNormals : public OnDevice {};

// --- closed forms ---------------------------------------------------------------------------------------------------

/// A surface with its derivatives by s and t, and by both twice.
struct Shape {
    const char* name;
    std::function<dvec3(dvec2)> point;
    bool isMirrored = false; ///< its texture coordinates

    [[nodiscard]] dvec3 derivative(dvec2 st, int axis) const {
        constexpr double kStep = 1e-5;
        dvec2 step(0);
        step[axis] = kStep;
        return (point(st + step) - point(st - step)) / (2 * kStep);
    }
    [[nodiscard]] dvec3 normal(dvec2 st) const {
        return glm::normalize(glm::cross(derivative(st, 0), derivative(st, 1))) * (isMirrored ? -1.0 : 1.0);
    }
};

const std::vector<Shape>& shapes() {
    static const std::vector<Shape> all = {
        {"plane", [](dvec2 st) { return dvec3(2 * st.x - 1, 2 * st.y - 1, 0); }},
        {"mirrored plane", [](dvec2 st) { return dvec3(1 - 2 * st.x, 2 * st.y - 1, 0); }, true},
        {"cylinder", [](dvec2 st) { return dvec3(std::sin(kTurn * st.x), 2 * st.y - 1, std::cos(kTurn * st.x)); }},
        {"sphere",
         [](dvec2 st) {
             const double along = kTurn * st.x, up = std::numbers::pi * (st.y - 0.5);
             return dvec3(std::cos(up) * std::sin(along), std::sin(up), std::cos(up) * std::cos(along));
         }},
        {"torus",
         [](dvec2 st) {
             const double around = kTurn * st.x, across = kTurn * st.y, r = 0.7 + 0.3 * std::cos(across);
             return dvec3(r * std::sin(around), r * std::cos(around), 0.3 * std::sin(across));
         },
         true},
    };
    return all;
}

/// h = amplitude sin(2 pi k s) cos(2 pi k t), as in sineMap().
struct Wave {
    double amplitude;
    int count;

    [[nodiscard]] double height(dvec2 st) const {
        return amplitude * std::sin(kTurn * count * st.x) * std::cos(kTurn * count * st.y);
    }
    [[nodiscard]] dvec2 slopes(dvec2 st) const {
        const double k = kTurn * count;
        return amplitude * k * dvec2(std::cos(k * st.x) * std::cos(k * st.y), -std::sin(k * st.x) * std::sin(k * st.y));
    }
};

/// Blinn (1978): m = p_s x p_t + h_s (n x p_t) - h_t (n x p_s).
dvec3 blinnNormal(const Shape& shape, const dvec2& slopes, dvec2 st) {
    const dvec3 ps = shape.derivative(st, 0), pt = shape.derivative(st, 1), n = shape.normal(st);
    const dvec3 m = glm::cross(ps, pt) + (slopes.x * glm::cross(n, pt) - slopes.y * glm::cross(n, ps));
    return glm::normalize(m) * (shape.isMirrored ? -1.0 : 1.0);
}

/// The shape as triangles, with normals and tangents in closed form.
struct ShapeMesh {
    DenseMesh mesh;
    Tangents tangents;

    ShapeMesh(const Shape& shape, int columns, int rows) {
        for (int j = 0; j <= rows; ++j)
            for (int i = 0; i <= columns; ++i) {
                const dvec2 st(double(i) / columns, std::clamp(double(j) / rows, 1e-6, 1 - 1e-6));
                mesh.positions.emplace_back(shape.point(st));
                mesh.normals.emplace_back(shape.normal(st));
                mesh.texCoords.emplace_back(st);
                tangents.ps.emplace_back(shape.derivative(st, 0));
                tangents.pt.emplace_back(shape.derivative(st, 1));
            }
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                const auto a = std::uint32_t(j * (columns + 1) + i), b = a + 1, c = a + std::uint32_t(columns) + 1;
                if (shape.isMirrored) // still counter-clockwise from outside
                    mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, c + 1});
                else
                    mesh.indices.insert(mesh.indices.end(), {a, b, c, b, c + 1, c});
            }
    }
};

// Poles and silhouettes aside, every pixel has Blinn's normal at its (s,t).
TEST_F(DetailNormals, ofBumpsAreBlinnsOnPlaneCylinderSphereAndTorus) {
    const Wave wave{0.03, 4};
    const HeightMap map = sineMap(512, wave.amplitude, wave.count);
    for (const Shape& shape : shapes()) {
        const ShapeMesh triangles(shape, 256, 128);
        const MeshModel model(device(), {.mesh = &triangles.mesh, .bump = &map, .tangents = &triangles.tangents});
        std::vector<double> errors, bends;
        for (const Seen& seen : look(model, bilinear(), {1, 1.5, 4}, 1.2)) {
            if (std::string(shape.name) == "sphere" && std::abs(seen.st.y - 0.5) > 0.4) continue;
            if (glm::dot(shape.normal(seen.st), glm::normalize(dvec3(1, 1.5, 4))) < 0.3) continue;
            errors.push_back(degreesBetween(seen.normal, blinnNormal(shape, wave.slopes(seen.st), seen.st)));
            bends.push_back(degreesBetween(seen.normal, shape.normal(seen.st)));
        }
        EXPECT_GT(errors.size(), 4000u) << shape.name;
        EXPECT_GT(rms(bends), 5) << shape.name;
        EXPECT_LT(rms(errors), 0.1) << shape.name;
        EXPECT_LT(most(errors), 0.5) << shape.name;
    }
}

// The normal of the moved torus has one term more, h times the derivative of n: it vanishes with h while the slopes
// stay.
TEST_F(DetailNormals, ofBumpsAreThoseOfTheMovedSurfaceWhereHeightsVanish) {
    const Shape& torus = shapes().back();
    std::vector<double> errors;
    for (const int count : {2, 4, 8}) {
        const Wave wave{0.08 / count, count};
        const HeightMap map = sineMap(1024, wave.amplitude, wave.count);
        const ShapeMesh triangles(torus, 256, 128);
        const MeshModel model(device(), {.mesh = &triangles.mesh, .bump = &map, .tangents = &triangles.tangents});
        const Shape moved{"moved", [&](dvec2 st) { return torus.point(st) + wave.height(st) * torus.normal(st); },
                          true};
        std::vector<double> angles;
        for (const Seen& seen : look(model, bilinear(), {0, 0, 4}, 1.2))
            angles.push_back(degreesBetween(seen.normal, moved.normal(seen.st)));
        errors.push_back(rms(angles));
    }
    EXPECT_GT(errors[0], 1.8 * errors[1]);
    EXPECT_GT(errors[1], 1.8 * errors[2]);
    EXPECT_LT(errors[2], 0.5);
}

// --- normal maps ----------------------------------------------------------------------------------------------------

NormalMap constantNormals(const dvec3& normal, NormalSpace space) {
    return {.width = 2, .height = 2, .normals = std::vector<vec3>(4, vec3(glm::normalize(normal))), .space = space};
}

/// The frame in double precision: T along p_s in the plane of n, B along the side of p_t.
dvec3 inFrame(const Shape& shape, const dvec3& c, dvec2 st) {
    const dvec3 n = shape.normal(st), ps = shape.derivative(st, 0), pt = shape.derivative(st, 1);
    const dvec3 tangent = glm::normalize(ps - n * glm::dot(n, ps)), side = glm::cross(n, tangent);
    return c.x * tangent + (glm::dot(side, pt) < 0 ? -c.y : c.y) * side + c.z * n;
}

TEST_F(DetailNormals, ofTangentSpaceAreInTheFrameOfTheSurfaceMirroredOrNot) {
    const dvec3 c = glm::normalize(dvec3(0.5, 0.3, 0.8));
    const NormalMap map = constantNormals(c, NormalSpace::tangent);
    for (const Shape& shape : shapes()) {
        const ShapeMesh triangles(shape, 256, 128);
        const MeshModel model(device(), {.mesh = &triangles.mesh, .normalMap = &map, .tangents = &triangles.tangents});
        std::vector<double> errors;
        for (const Seen& seen : look(model, bilinear(), {1, 1.5, 4}, 1.2)) {
            if (std::string(shape.name) == "sphere" && std::abs(seen.st.y - 0.5) > 0.4) continue;
            const dvec3 expected = inFrame(shape, c, seen.st);
            if (glm::dot(shape.normal(seen.st), glm::normalize(dvec3(1, 1.5, 4))) > 0.3)
                errors.push_back(degreesBetween(seen.normal, expected));
        }
        EXPECT_GT(errors.size(), 4000u) << shape.name;
        EXPECT_LT(most(errors), 0.5) << shape.name;
    }
}

// Normals of object space turn with the object.
TEST_F(DetailNormals, ofObjectSpaceAreTheMapsOwn) {
    const dvec3 c = glm::normalize(dvec3(0.5, 0.3, 0.8));
    const NormalMap map = constantNormals(c, NormalSpace::object);
    const ShapeMesh triangles(shapes().front(), 4, 4);
    const MeshModel model(device(), {.mesh = &triangles.mesh, .normalMap = &map});
    const mat4 turn = glm::rotate(mat4(1), 0.5f, vec3(0, 1, 0));
    for (const Seen& seen : look(Instance(model, {}, turn), bilinear(), {0, 0, 4}, 1.2))
        EXPECT_LT(degreesBetween(seen.normal, dvec3(turn * vec4(vec3(c), 0))), 0.1);
}

// --- surfaces -------------------------------------------------------------------------------------------------------

TEST_F(DetailNormals, ofBumpsOnASurfaceAreBlinnsOnAllPaths) {
    const HeightMap map = sineMap(256, 0.03, 6);
    Islands& cube = cubeWithIslands();
    const SurfaceModel model(device(), {.surface = &cube.surface, .cagePositions = cube.cage.positions, .bump = &map});
    for (const Path path : kDetailPaths) {
        RenderOptions options = bilinear();
        options.path = path;
        options.rate = 32;
        const std::vector<Seen> pixels = look(model, options, {2, 3, 4}, 0.8);
        const std::vector<double> angles = anglesTo(pixels, &map, NormalKind::firstOrder);
        EXPECT_GT(angles.size(), 3000u) << int(path);
        EXPECT_LT(rms(angles), 0.2) << int(path);
        EXPECT_LT(most(angles), 1.5) << int(path);
        EXPECT_GT(rms(anglesTo(pixels, nullptr, NormalKind::limit)), 5) << int(path);
        for (const Seen& seen : pixels) EXPECT_EQ(seen.height, 0) << "the surface has not moved";
    }
}

// Whatever part of the heights the triangles carry, the rest of the slopes is added at every pixel.
TEST_F(DetailNormals, ofBothAreThoseOfTheFullMapAtEveryRate) {
    const HeightMap map = sineMap(512, 0.004, 18);
    Islands& cube = cubeWithIslands();
    const SurfaceModel both(
        device(), {.surface = &cube.surface, .cagePositions = cube.cage.positions, .height = &map, .bump = &map});
    const SurfaceModel displaced(device(),
                                 {.surface = &cube.surface, .cagePositions = cube.cage.positions, .height = &map});
    for (const Path path : kDetailPaths) {
        RenderOptions options = bilinear();
        options.path = path;
        for (const int rate : {32, 16, 8}) {
            options.rate = rate;
            const auto angles = [&](const SurfaceModel& model) {
                return anglesTo(look(model, options, {2, 3, 4}, 0.8), &map, NormalKind::full);
            };
            EXPECT_LT(rms(angles(both)), 0.5) << int(path) << " rate " << rate;
            EXPECT_GT(rms(angles(displaced)), rate > 16 ? 0.5 : 1.5) << int(path) << " rate " << rate;
        }
    }
}

// Slopes of vertices and the rest of the map's both raise the surface along the normal of the plane below it.
TEST_F(DetailNormals, ofBothAreThoseOfTheFullMapWhereItIsSteep) {
    const Wave wave{0.08, 6};
    const HeightMap map = sineMap(1024, wave.amplitude, wave.count);
    Cage plane;
    plane.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    plane.texCoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    addFace(plane, {0, 1, 2, 3}, {0, 1, 2, 3});
    const Surface surface = buildSurface(plane, {.scheme = Scheme::bilinear});
    const SurfaceModel model(device(),
                             {.surface = &surface, .cagePositions = plane.positions, .height = &map, .bump = &map});
    for (const int rate : {64, 32, 16}) {
        RenderOptions options = bilinear();
        options.path = Path::dice;
        options.rate = rate;
        std::vector<double> angles;
        for (const Seen& seen : look(model, options, {0, 0, 4}, 0.9)) {
            const dvec2 slopes = 0.5 * wave.slopes(seen.st); // the plane is 2 wide
            angles.push_back(degreesBetween(seen.normal, {-slopes.x, -slopes.y, 1}));
        }
        EXPECT_GT(angles.size(), 10000u);
        EXPECT_LT(rms(angles), 1.5) << rate; // slopes of up to 56 degrees
    }
}

// Large triangles are seen at outlines, where they have short segments, and where they miss heights that they could
// show.
TEST_F(DetailNormals, ofBothMakePicturesOfDisplacementOfAQuarterOfTheSegments) {
    const HeightMap map = sineMap(512, 0.008, 14);
    Islands& cube = cubeWithIslands();
    const auto modelOf = [&](const HeightMap* bump) {
        return SurfaceModel(
            device(), {.surface = &cube.surface, .cagePositions = cube.cage.positions, .height = &map, .bump = bump});
    };
    const SurfaceModel both = modelOf(&map), displaced = modelOf(nullptr);
    RenderOptions options;
    options.path = Path::dice;
    options.lighting.castsShadows = false;
    options.bounds.add(dvec3(-2));
    options.bounds.add(dvec3(2));
    options.camera = {.eye = {2, 3, 4}, .fieldOfView = 16, .nearDistance = 1, .farDistance = 12};
    const auto draw = [&](const SurfaceModel& model, double pixels) {
        options.edgePixels = pixels;
        return displayed(detailRenderer().render(model, options));
    };
    const Image reference = draw(displaced, 0.4);
    const auto error = [&](const SurfaceModel& model, double pixels) {
        const Image image = draw(model, pixels);
        std::vector<double> differences;
        for (std::size_t i = 0; i < image.texels.size(); ++i)
            differences.push_back(double(image.texels[i]) - double(reference.texels[i]));
        return rms(differences);
    };
    EXPECT_LT(error(both, 4), 1.1 * error(displaced, 1));
    EXPECT_GT(error(displaced, 4), 3 * error(displaced, 1));

    // Edges: those that face the eye have the rate that displacement has, those at outlines up to four times as much.
    EdgeRater rater(device());
    options.edgePixels = 1;
    const View view = viewOf(options.camera, 160);
    const EdgeRates many = rater.rates(both, options, view), few = rater.rates(displaced, options, view);
    int same = 0, fine = 0;
    for (std::size_t edge = 0; edge < few.rates.size(); ++edge) {
        const float ratio = many.rates[edge] / few.rates[edge];
        EXPECT_TRUE(ratio >= 1 && ratio < 4.01f) << edge << ": " << ratio;
        same += ratio == 1, fine += ratio > 3;
    }
    EXPECT_GT(same, 0);
    EXPECT_GT(fine, 0);
}

// Shading does not change with the rate: that is what jumps where displacement alone loses heights.
TEST_F(DetailNormals, ofBothHoldStillWhileRatesChange) {
    const HeightMap map = sineMap(512, 0.004, 18);
    Islands& cube = cubeWithIslands();
    const auto meanChange = [&](const HeightMap* bump) {
        const SurfaceModel model(
            device(), {.surface = &cube.surface, .cagePositions = cube.cage.positions, .height = &map, .bump = bump});
        RenderOptions options;
        options.path = Path::dice;
        options.lighting.castsShadows = false;
        options.bounds.add(dvec3(-2));
        options.bounds.add(dvec3(2));
        options.camera = {.eye = {2, 3, 4}, .fieldOfView = 9, .nearDistance = 1, .farDistance = 12};
        std::vector<Image> pictures;
        for (const int rate : {8, 10, 12, 14, 16}) {
            options.rate = rate;
            pictures.push_back(displayed(detailRenderer().render(model, options)));
        }
        double sum = 0;
        for (std::size_t i = 1; i < pictures.size(); ++i)
            for (std::size_t k = 0; k < pictures[i].texels.size(); ++k)
                sum += std::abs(double(pictures[i].texels[k]) - double(pictures[i - 1].texels[k]));
        return 255 * sum / double((pictures.size() - 1) * pictures[0].texels.size());
    };
    const double withBump = meanChange(&map), without = meanChange(nullptr);
    EXPECT_LT(withBump, 1);
    EXPECT_GT(without, 3 * withBump);
}

TEST_F(DetailNormals, ofNormalMapsFollowThePoseAndTheMirroredIslands) {
    const dvec3 c = glm::normalize(dvec3(0.6, 0.2, 0.8));
    const NormalMap map = constantNormals(c, NormalSpace::tangent);
    Islands& cube = cubeWithIslands();
    const auto check = [&](const std::vector<vec3>& positions, const ReferenceSurface& reference) {
        const SurfaceModel model(device(), {.surface = &cube.surface, .cagePositions = positions, .normalMap = &map});
        for (const Path path : kDetailPaths) {
            RenderOptions options = bilinear();
            options.path = path;
            options.rate = 16;
            std::vector<double> angles;
            for (const Seen& seen : look(model, options, {2, 3, 4}, 0.8)) {
                const dvec2 uv = uvOf(cube.cage, seen.face, seen.st);
                if (std::min({uv.x, uv.y, 1 - uv.x, 1 - uv.y}) < 0.05) continue;
                const DisplacedFrame frame = displacedFrame(reference, nullptr, seen.face, uv);
                const glm::dmat2 j = glm::inverse(glm::dmat2(frame.tex.jacobian));
                const dvec3 ps = frame.limit.pu * j[0].x + frame.limit.pv * j[0].y;
                const dvec3 pt = frame.limit.pu * j[1].x + frame.limit.pv * j[1].y;
                const dvec3& n = frame.normal;
                const dvec3 tangent = glm::normalize(ps - n * glm::dot(n, ps)), side = glm::cross(n, tangent);
                const dvec3 expected = c.x * tangent + (glm::dot(side, pt) < 0 ? -c.y : c.y) * side + c.z * n;
                angles.push_back(degreesBetween(seen.normal, expected));
            }
            EXPECT_GT(angles.size(), 3000u);
            EXPECT_LT(rms(angles), 0.3) << int(path);
            EXPECT_LT(most(angles), 2) << int(path);
        }
    };
    check(cube.cage.positions, cube.reference);
    Cage bent = cube.cage;
    for (vec3& p : bent.positions) p = vec3(p.x + 0.4f * p.y, p.y, p.z - 0.3f * p.x);
    check(bent.positions, ReferenceSurface(bent, cube.options));
}

// --- filters --------------------------------------------------------------------------------------------------------

/// A floor with stripes, seen at a flat angle: the mean of many pixels of a larger picture is what one should show.
TEST_F(DetailNormals, areWithoutNoiseWhereTheFilterFitsThePixel) {
    const HeightMap stripes = sineMap(512, 0.002, 64);
    const ShapeMesh floor(shapes().front(), 2, 2);
    const MeshModel model(device(), {.mesh = &floor.mesh, .bump = &stripes, .tangents = &floor.tangents});
    const auto noise = [&](Filter filter) { // how far normals are from the floor's own: at a distance they cancel
        RenderOptions options;
        options.filter = filter;
        std::vector<double> angles;
        for (const Seen& seen : look(model, options, {0, -6, 1}, 0.9))
            angles.push_back(degreesBetween(seen.normal, {0, 0, 1}));
        return rms(angles);
    };
    const double nearest = noise(Filter::nearest), bilinear = noise(Filter::bilinear), mipmap = noise(Filter::mipmap);
    EXPECT_GT(nearest, 5);
    EXPECT_GT(bilinear, 5);
    EXPECT_LT(mipmap, 0.5 * bilinear);
    if (device().traits().maxAnisotropy > 1) { // it keeps what mipmaps blur across
        const double anisotropic = noise(Filter::anisotropic);
        EXPECT_NE(anisotropic, mipmap);
        EXPECT_LT(anisotropic, bilinear);
    }
}

/// Four texels per pixel, sixteen per wave. Samples are half a pixel apart, so that slopes are those of the level with
/// two texels per texel: differences over two of them keep 0.9 of a wave, means of 2 x 2 keep 0.95, and up to 0.85 is
/// kept between texels. The next level keeps 0.52 at most, the one before 0.93 at least.
TEST_F(DetailNormals, areOfTheLevelThatFitsSamples) {
    const Wave wave{0.001, 64};
    const HeightMap map = sineMap(1024, wave.amplitude, wave.count);
    const ShapeMesh floor(shapes().front(), 2, 2);
    const MeshModel model(device(), {.mesh = &floor.mesh, .bump = &map, .tangents = &floor.tangents});
    RenderOptions options;
    options.filter = Filter::mipmap;
    std::vector<double> slopes;
    for (const Seen& seen : look(model, options, {0, 0, 4}, 0.625)) // 160 pixels see 1.25 of 2, which are 1024 texels
        slopes.push_back(seen.normal.x / seen.normal.z);
    const double whole = 0.5 * wave.amplitude * kTurn * wave.count / 2; // root of the mean square
    EXPECT_GT(slopes.size(), 20000u);
    EXPECT_GT(rms(slopes) / whole, 0.62);
    EXPECT_LT(rms(slopes) / whole, 0.9);
}

} // namespace
} // namespace relief::test
