#include <gtest/gtest.h>
#include "distance/distance.h"
#include "geometry_image/geometry_image.h"
#include "geometry_image/shapes.h"
#include "base/clock.h"
namespace relief::test {
static void go(const char* name, const DenseMesh& mesh, int size) {
    const double t0 = secondsNow();
    SpreadSurface s(mesh, name, {.size = size});
    const double t1 = secondsNow();
    GeometryImage image = s.sample(size);
    const double t2 = secondsNow();
    const auto& r = s.report();
    printf("%s: tri %zu genus %d boundaries %d paths %d cut %.4g stretch %.3f (first %.3f) side %d mips %d  %.2fs %.2fs\n", name, size_t(r.triangles), r.genus, r.boundaryCount, r.pathCount, r.cutLength, r.stretch, r.firstStretch, image.sewing.sideSegments, image.mipCount(), t1-t0, t2-t1);
    for (int k = 0; k < image.mipCount(); ++k) {
        DenseMesh m = toMesh(image, k);
        MeshFaults f = findFaults(m.indices);
        long V = m.positions.size(), F = m.indices.size()/3;
        long E = (3*F + (long)f.openEdges)/2;
        MeasuredSurface a({mesh.positions, mesh.indices}, 50000), b({m.positions, m.indices}, 50000);
        SurfaceDistance d = measureDistance(a, b);
        double diag = computeBounds(mesh.positions).diagonal();
        printf("   mip %d size %d open %zu other %zu degen %zu chi %ld  rms %.3g haus %.3g\n", k, image.sizeAt(k), size_t(f.openEdges), size_t(f.otherEdges), size_t(f.degenerateTriangles), V-E+F, d.rms()/diag, d.hausdorff()/diag);
    }
}
TEST(Try, all) {
    go("square", flatSquare(20), 65);
    go("sphere", sphereMesh(32), 129);
    go("ellipsoid", sphereMesh(32, dvec3(4,1,1)), 129);
    go("torus", torusMesh(80), 129);
    go("double", doubleTorus(), 129);
    go("annulus", gridMesh(60, 10, [](double s, double t){ double a = 2*std::numbers::pi*s; return dvec3(std::cos(a),std::sin(a),0)*(2-t); }, true), 129);
    go("sphere100k", sphereMesh(92, dvec3(2,1,1)), 257);
    DenseMesh tet; tet.positions = {{0,0,0},{1,0,0},{0,1,0},{0,0,1}}; tet.indices = {0,2,1,0,1,3,1,2,3,2,0,3};
    go("tet", tet, 65);
    DenseMesh one; one.positions = {{0,0,0},{1,0,0},{0,1,0}}; one.indices = {0,1,2};
    go("triangle", one, 65);
}
}
