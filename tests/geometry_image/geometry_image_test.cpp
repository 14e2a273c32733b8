#include "geometry_image/geometry_image.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

#include "distance/distance.h"
#include "geometry_image/shapes.h"
#include "support.h"

namespace relief::test {
namespace {

struct Counts {
    std::int64_t vertices = 0, edges = 0, triangles = 0;
    MeshFaults faults;

    [[nodiscard]] std::int64_t euler() const { return vertices - edges + triangles; }
};

/// Every vertex counts: one that no triangle names would spoil the characteristic.
Counts countMesh(const DenseMesh& mesh) {
    Counts counts{.vertices = std::int64_t(mesh.positions.size()),
                  .triangles = std::int64_t(mesh.indices.size() / 3),
                  .faults = findFaults(mesh.indices)};
    counts.edges = (3 * counts.triangles + std::int64_t(counts.faults.openEdges)) / 2;
    return counts;
}

/// RMS distance, both ways, relative to the diagonal.
double errorOf(const DenseMesh& source, const DenseMesh& mesh) {
    constexpr std::size_t kSamples = 20'000;
    const MeasuredSurface a({source.positions, source.indices}, kSamples), b({mesh.positions, mesh.indices}, kSamples);
    return measureDistance(a, b).rms() / computeBounds(source.positions).diagonal();
}

SpreadSurface spread(const DenseMesh& mesh, int size = 65) { return {mesh, "source", {.size = size}}; }

std::string messageOf(const std::function<void()>& call) {
    try {
        call();
    } catch (const Error& error) {
        return fmt::format("{}: {}", int(error.failure), error.what());
    }
    return "nothing is wrong";
}

struct Shape {
    const char* name;
    DenseMesh mesh;
    int genus, boundaries;
    double mostStretch, mostError; ///< of the image of 65 samples per side
    int mips;                      ///< of that image
    double mostCut;                ///< length; what a disk that grows leaves over is half as much again
};

std::vector<Shape> listShapes() {
    const auto ring = [](double s, double t) {
        const double angle = 2 * std::numbers::pi * s;
        return (2 - t) * dvec3(std::cos(angle), std::sin(angle), 0.3 * std::sin(2 * angle));
    };
    DenseMesh tetrahedron;
    tetrahedron.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    tetrahedron.indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
    return {{"square", flatSquare(12), 0, 1, 1.0001, 1e-7, 4, 0},
            {"triangle", gridMesh(9, 1, [](double s, double t) { return dvec3(s * t, t, 0); }), 0, 1, 4, 1e-3, 4, 0},
            {"ring", gridMesh(40, 8, ring, true), 0, 2, 4, 1e-3, 4, 1.2},
            {"tetrahedron", tetrahedron, 0, 0, 2, 2e-3, 4, 1.5},
            {"sphere", sphereMesh(16), 0, 0, 1.4, 5e-4, 4, 7},
            {"cigar", sphereMesh(16, dvec3(6, 1, 1)), 0, 0, 1.4, 5e-4, 4, 14},
            {"pierced sphere", piercedSphere(32), 0, 1, 3, 2e-3, 4, 9},
            {"torus", torusMesh(48), 1, 0, 1.7, 6e-4, 4, 7},
            {"double torus", doubleTorus(), 2, 0, 2, 1e-3, 2, 110}};
}

TEST(GeometryImage, sewsEveryShapeAtEveryMip) {
    for (const Shape& shape : listShapes()) {
        SCOPED_TRACE(shape.name);
        const SpreadSurface surface = spread(shape.mesh);
        const GeometryImage image = surface.sample(65);
        EXPECT_EQ(surface.report().genus, shape.genus);
        EXPECT_EQ(surface.report().boundaryCount, shape.boundaries);
        EXPECT_LT(surface.report().stretch, shape.mostStretch);
        EXPECT_GE(surface.report().stretch, 1 - 1e-9);
        EXPECT_LE(surface.report().stretch, 1.02 * surface.report().firstStretch); // shear is made smaller as well
        EXPECT_LE(surface.report().cutLength, shape.mostCut);
        EXPECT_EQ(image.mipCount(), shape.mips);
        for (int mip = 0; mip < image.mipCount(); ++mip) {
            const Counts counts = countMesh(toMesh(image, mip));
            EXPECT_EQ(counts.euler(), 2 - 2 * shape.genus - shape.boundaries) << "mip " << mip;
            EXPECT_EQ(counts.faults.openEdges == 0, shape.boundaries == 0) << "mip " << mip;
            EXPECT_EQ(counts.faults.otherEdges, 0u) << "mip " << mip;
            EXPECT_EQ(counts.faults.degenerateTriangles, 0u) << "mip " << mip;
        }
        EXPECT_LT(errorOf(shape.mesh, toMesh(image)), shape.mostError);
    }
}

// Beside the end of a cut two diagonals may join the same vertices, whatever lengths and normals say.
TEST(GeometryImage, hasEachEdgeOnce) {
    GeometryImage image{.size = 5, .sewing = {.sideSegments = 4, .first = 2, .paths = {{8, 1}, {8, 0}}}};
    std::mt19937 random(1);
    const auto number = [&random] { return float(random() % 1000) / 500 - 1; };
    for (int round = 0; round < 200; ++round) {
        image.positions.clear(), image.normals.clear();
        for (int i = 0; i < 25; ++i) {
            image.positions.emplace_back(number(), number(), number());
            image.normals.emplace_back(glm::normalize(vec3(number(), number(), number() + 1.5f)));
        }
        const MeshFaults faults = findFaults(toMesh(image).indices);
        EXPECT_EQ(faults.openEdges + faults.otherEdges + faults.degenerateTriangles, 0u) << round;
    }
}

// Corners of the square meet those of the patch, and mean value coordinates reproduce what is flat.
TEST(GeometryImage, aFlatSquareStaysItself) {
    const GeometryImage image = spread(flatSquare(12)).sample(33);
    std::set<std::pair<float, float>> corners;
    for (const std::size_t corner : {0u, 32u, 32u * 33u, 33u * 33u - 1u})
        corners.insert({image.positions[corner].x, image.positions[corner].y});
    EXPECT_EQ(corners, (std::set<std::pair<float, float>>{{0, 0}, {0, 1}, {1, 0}, {1, 1}}));
    for (std::size_t j = 0; j < 33; ++j)
        for (std::size_t i = 0; i + 1 < 33; ++i) {
            const vec3 step = image.positions[j * 33 + i + 1] - image.positions[j * 33 + i];
            EXPECT_NEAR(glm::length(step), 1 / 32.0, 1e-6);
            EXPECT_NEAR(image.normals[j * 33 + i].z, 1, 1e-6);
        }
}

TEST(GeometryImage, errorsFallWithTheSquareOfTheSize) {
    const DenseMesh sphere = sphereMesh(48);
    const GeometryImage image = spread(sphere, 129).sample(129);
    double before = errorOf(sphere, toMesh(image, 3));
    for (int mip = 2; mip >= 0; --mip) {
        const double error = errorOf(sphere, toMesh(image, mip));
        EXPECT_GT(before / error, 3.3) << "mip " << mip;
        EXPECT_LT(before / error, 4.7) << "mip " << mip;
        before = error;
    }
}

// Rows of samples that meet at small angles on a long arm make triangles that look anywhere.
TEST(GeometryImage, holdsLongArms) {
    const DenseMesh jack = jackMesh(48);
    const SpreadSurface surface = spread(jack, 129);
    const DenseMesh mesh = toMesh(surface.sample(129));
    EXPECT_LT(surface.report().stretch, 3.4); // before relaxing: 4
    EXPECT_LT(double(countTurned(mesh)), 0.01 * double(mesh.indices.size() / 3));
    EXPECT_LT(errorOf(jack, mesh), 1e-3);
}

TEST(GeometryImage, takesSamplesFromAFinerSurface) {
    // A coarse sphere, whose samples are moved to the round one.
    const SpreadSurface surface = spread(sphereMesh(6));
    const auto settle = [](dvec3& position, dvec3& normal) { normal = position = glm::normalize(position); };
    const GeometryImage image = surface.sample(65, settle);
    for (std::size_t i = 0; i < image.positions.size(); ++i) {
        EXPECT_NEAR(glm::length(image.positions[i]), 1, 1e-6);
        EXPECT_EQ(image.positions[i], image.normals[i]);
    }
    const Counts counts = countMesh(toMesh(image));
    EXPECT_EQ(counts.faults.openEdges + counts.faults.otherEdges, 0u);
    EXPECT_GT(errorOf(sphereMesh(48), toMesh(surface.sample(65))), 5 * errorOf(sphereMesh(48), toMesh(image)));
}

// The outer and the inner boundary of a ring: every open edge of the image lies on one of them.
TEST(GeometryImage, keepsBoundaries) {
    const DenseMesh ring = gridMesh(
        64, 8,
        [](double s, double t) {
            const double angle = 2 * std::numbers::pi * s;
            return (2 - t) * dvec3(std::cos(angle), std::sin(angle), 0);
        },
        true);
    const DenseMesh mesh = toMesh(spread(ring).sample(65));
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> counts;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const auto edge = std::minmax(mesh.indices[i], mesh.indices[i % 3 == 2 ? i - 2 : i + 1]);
        ++counts[{edge.first, edge.second}];
    }
    int inner = 0, outer = 0;
    const double flat = std::cos(std::numbers::pi / 64); // chords of the source
    for (const auto& [edge, count] : counts) {
        if (count != 1) continue;
        const double radius = glm::length(mesh.positions[edge.first]);
        const bool isOuter = radius > 1.5;
        EXPECT_LE(radius, isOuter ? 2 + 1e-5 : 1 + 1e-5);
        EXPECT_GE(radius, (isOuter ? 2 : 1) * flat - 1e-5);
        ++(isOuter ? outer : inner);
    }
    EXPECT_GT(inner, 20);
    EXPECT_GT(outer, 40);
}

TEST(GeometryImage, isTheSameInEveryRun) {
    const GeometryImage first = spread(torusMesh(24)).sample(65), second = spread(torusMesh(24)).sample(65);
    EXPECT_EQ(first.positions, second.positions);
    EXPECT_EQ(first.normals, second.normals);
}

// Samples that are sewn are shared vertices: their normals are one, and a sphere's point outwards.
TEST(GeometryImage, holdsTheNormals) {
    const GeometryImage image = spread(sphereMesh(24)).sample(65);
    for (std::size_t i = 0; i < image.positions.size(); ++i) {
        EXPECT_GT(glm::dot(glm::normalize(image.positions[i]), image.normals[i]), 0.995f);
        EXPECT_NEAR(glm::length(image.normals[i]), 1, 1e-5);
    }
}

TEST(GeometryImage, otherSizesFitTheBorder) {
    const SpreadSurface surface = spread(torusMesh(24));
    const int side = surface.sideSegments();
    for (const int times : {1, 3, 6}) {
        const GeometryImage image = surface.sample(times * side + 1);
        const Counts counts = countMesh(toMesh(image, image.mipCount() - 1));
        EXPECT_EQ(counts.euler(), 0) << times;
        EXPECT_EQ(counts.faults.openEdges + counts.faults.otherEdges, 0u) << times;
    }
    EXPECT_EQ(messageOf([&] { (void)surface.sample(side * 3 + 2); }).substr(0, 1), "2");
}

TEST(GeometryImage, refusesWhatIsNoSurface) {
    const auto refusal = [](const DenseMesh& mesh) { return messageOf([&] { spread(mesh); }); };
    // Two parts; three triangles along one edge; two cones that meet in a point; a triangle wound the other way.
    DenseMesh two = sphereMesh(4);
    const std::size_t count = two.positions.size(), corners = two.indices.size();
    for (std::size_t i = 0; i < count; ++i) two.positions.push_back(two.positions[i] + vec3(5, 0, 0));
    for (std::size_t i = 0; i < corners; ++i) two.indices.push_back(two.indices[i] + std::uint32_t(count));
    EXPECT_EQ(refusal(two), "3: source: the surface has 2 parts that are not connected; a geometry image holds one");
    DenseMesh fin = flatSquare(2);
    fin.positions.emplace_back(0.5f, 0.5f, 1);
    fin.indices.insert(fin.indices.end(), {3, 4, 9});
    EXPECT_NE(refusal(fin).find("3: source: 1 edges have more than two triangles, the first is at"), std::string::npos)
        << refusal(fin);
    DenseMesh bow;
    bow.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}, {0, 2, 0}, {-2, 0, 0}};
    bow.indices = {0, 1, 2, 0, 3, 4, 1, 5, 2, 5, 6, 2, 6, 3, 2, 3, 6, 4};
    EXPECT_EQ(refusal(bow).substr(0, 10), "3: source:") << refusal(bow);
    DenseMesh turned = flatSquare(2);
    std::swap(turned.indices[0], turned.indices[1]);
    EXPECT_NE(refusal(turned).find("wound against each other"), std::string::npos) << refusal(turned);
    EXPECT_NE(refusal({}).find("no area"), std::string::npos);
    EXPECT_EQ(messageOf([] { spread(flatSquare(2), 8); }).substr(0, 1), "2");
}

// --- files --------------------------------------------------------------------------------------------------------

class GeometryImageFiles : public ::testing::Test {
protected:
    [[nodiscard]] std::string path(const char* name) const { return folder_ / name; }

    /// Writes the picture of an image with another header, and returns what the reader says of it.
    std::string refusalOf(ImageAttributes changes, const std::function<void(Image&)>& change = {}) {
        writeGeometryImage(path("good.exr"), image_);
        ImageAttributes attributes = readImageInfo(path("good.exr")).attributes;
        for (const auto& [name, text] : changes) attributes[name] = text;
        Image picture = readImage(path("good.exr"));
        if (change) change(picture);
        std::vector<ImageChannel> channels;
        for (const std::string& name : readImageInfo(path("good.exr")).channelNames) channels.push_back({name});
        channels.resize(std::size_t(picture.channels), {"more"});
        writeImage(path("bad.exr"), picture, channels, attributes);
        std::string message = messageOf([&] { readGeometryImage(path("bad.exr")); });
        EXPECT_EQ(message.find('\n'), std::string::npos);
        return message;
    }

    TemporaryFolder folder_;
    GeometryImage image_ = spread(torusMesh(24)).sample(33);
};

TEST_F(GeometryImageFiles, comeBackToTheBit) {
    image_.coordinates = {.origin = {1e6, -2e6, 3e6}, .unit = 0.25};
    writeGeometryImage(path("a.exr"), image_);
    const GeometryImage read = readGeometryImage(path("a.exr"));
    EXPECT_EQ(read.positions, image_.positions);
    EXPECT_EQ(read.normals, image_.normals);
    EXPECT_EQ(read.coordinates, image_.coordinates);
    EXPECT_EQ(read.mipCount(), image_.mipCount());
    EXPECT_EQ(toMesh(read, 1).indices, toMesh(image_, 1).indices);
    EXPECT_TRUE(isGeometryImageFile(path("a.exr")));
}

TEST_F(GeometryImageFiles, ofHalvesAreSewnToo) {
    image_.coordinates = {.origin = {100, 0, 0}, .unit = 1024};
    writeGeometryImage(path("a.exr"), image_, SampleType::half);
    const GeometryImage read = readGeometryImage(path("a.exr"));
    EXPECT_EQ(countMesh(toMesh(read)).faults.openEdges, 0u);
    for (std::size_t i = 0; i < read.positions.size(); ++i) {
        const dvec3 was = image_.coordinates.toWorld(dvec3(image_.positions[i]));
        EXPECT_LT(glm::length(read.coordinates.toWorld(dvec3(read.positions[i])) - was), 1.0) << i; // of 2867
    }
}

TEST_F(GeometryImageFiles, areRefusedWhereTheyAreNone) {
    EXPECT_EQ(refusalOf({}), "nothing is wrong");
    EXPECT_NE(refusalOf({{"relief:geometry_image", "2"}}).find("3: "), std::string::npos);
    const std::string good = readImageInfo(path("good.exr")).attributes.at("relief:sewing");
    for (const std::string& sewing :
         {std::string(), std::string("8 0"), good + " 1 1", good + "x", "0 " + good, "-" + good, "99999999999 " + good,
          std::string("8 0 32 5"), std::string("8 9 32 0"), std::string("8 0 16 1 16 0 0 2"), std::string("8 0 30 0"),
          std::string("8 0 20 1 12 0")}) {
        const std::string message = refusalOf({{"relief:sewing", sewing}});
        EXPECT_NE(message.find("how a border of 33 samples per side is sewn"), std::string::npos) << sewing << message;
    }
    for (const char* origin : {"1 2 3", "1 2 3 0", "1 2 nan 1", "1 2 1e300 1", "a b c d"})
        EXPECT_NE(refusalOf({{"relief:origin", origin}}).find("where its positions lie"), std::string::npos) << origin;
    // A sample of the border that is not its mate's, and one that is no number.
    const auto moved = [](Image& picture) { picture.at(5, 0)[0] += 1; };
    EXPECT_NE(refusalOf({}, moved).find("are sewn together and differ"), std::string::npos);
    const auto broken = [](Image& picture) { picture.at(5, 7)[1] = std::numeric_limits<float>::quiet_NaN(); };
    EXPECT_NE(refusalOf({}, broken).find("column 5, row 7"), std::string::npos);
    const auto cut = [](Image& picture) { picture.height = 20, picture.texels.resize(std::size_t(20 * 33 * 6)); };
    EXPECT_NE(refusalOf({}, cut).find("33 x 20"), std::string::npos);
    // Another picture.
    writeImage(path("other.exr"), Image{4, 4, 1, std::vector<float>(16, 0.5f)}, SampleType::real);
    EXPECT_NE(messageOf([&] { readGeometryImage(path("other.exr")); }).find("no geometry image"), std::string::npos);
    EXPECT_EQ(messageOf([&] { writeGeometryImage(path("a.png"), image_); }).substr(0, 1), "2");
    EXPECT_EQ(messageOf([&] { (void)toMesh(image_, 9); }).substr(0, 1), "2");
}

} // namespace
} // namespace relief::test
