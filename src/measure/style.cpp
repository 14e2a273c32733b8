#include "measure/page.h"

namespace relief {

// The colors of series are those of Okabe and Ito ("Color universal design", 2008), lighter on a dark page.
std::string styleSheet() {
    return R"css(
:root { color-scheme: light dark; --paper: #fcfcfb; --ink: #1c1e21; --soft: #5b6168; --grid: #e3e5e8; --box: #f2f3f4;
  --good: #00694c; --bad: #a43e00; --c0: #0072b2; --c1: #d55e00; --c2: #009e73; --c3: #aa4b86; --c4: #4aa3d8; --c5: #777; }
@media (prefers-color-scheme: dark) { :root { --paper: #15171a; --ink: #e7e9ec; --soft: #a2a9b1; --grid: #30343a;
  --box: #1e2125; --good: #4fd1a5; --bad: #ff9a5c; --c0: #4a9ee0; --c1: #f58b45; --c2: #30c79b; --c3: #e29ac6;
  --c4: #9fdcff; --c5: #999; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 1rem; max-width: 78rem; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; overflow-wrap: break-word; }
h1 { font-size: 1.6rem; line-height: 1.25; margin: .5rem 0; } h2 { font-size: 1.25rem; margin: 2.2rem 0 .4rem; }
h3 { font-size: 1.02rem; margin: 1.4rem 0 .3rem; } p, ul.words { max-width: 46rem; margin: .5rem 0; }
.soft, .caption { color: var(--soft); } .caption { font-size: .86rem; margin: .2rem 0 0; }
.figures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 27rem), 1fr)); gap: 1.4rem 2rem; }
figure { margin: 0; min-width: 0; } figcaption b { display: block; font-size: .95rem; }
figcaption .y { color: var(--soft); font-size: .82rem; }
svg.plot { display: block; width: 100%; height: auto; }
svg text { fill: var(--soft); font-size: 12.5px; } svg text.note { font-style: italic; paint-order: stroke; stroke: var(--paper); stroke-width: 4px; } svg text.label { fill: var(--ink); }
.grid { stroke: var(--grid); } .axis { stroke: var(--soft); fill: none; }
.rule { stroke: var(--ink); stroke-width: 1.5; } .loss { fill: var(--bad); opacity: .07; }
.line { fill: none; stroke-width: 2; } .line.thin { stroke-width: 1.2; opacity: .8; } .band { opacity: .13; }
.c0 { stroke: var(--c0); } .c1 { stroke: var(--c1); } .c2 { stroke: var(--c2); } .c3 { stroke: var(--c3); }
.c4 { stroke: var(--c4); } .c5 { stroke: var(--c5); }
.mark { stroke: none; } .mark.c0, .f0 { fill: var(--c0); } .mark.c1, .f1 { fill: var(--c1); }
.mark.c2, .f2 { fill: var(--c2); } .mark.c3, .f3 { fill: var(--c3); } .mark.c4, .f4 { fill: var(--c4); }
.mark.c5, .f5 { fill: var(--c5); }
ul.legend { list-style: none; display: flex; flex-wrap: wrap; gap: .1rem .9rem; margin: .1rem 0 0; padding: 0; font-size: .82rem; }
ul.legend svg { width: 34px; height: 12px; margin-right: .35rem; vertical-align: -1px; }
.scroll { overflow-x: auto; margin: .5rem 0; } table { border-collapse: collapse; font-size: .84rem; }
th, td { padding: .22rem .6rem; text-align: right; border-bottom: 1px solid var(--grid); white-space: nowrap; }
th { color: var(--soft); font-weight: 600; vertical-align: bottom; white-space: normal; min-width: 4.2rem; }
th:first-child, td:first-child, td.words, th.words { text-align: left; } td.words { white-space: normal; min-width: 9rem; }
@media (max-width: 30rem) { th, td { padding: .22rem .35rem; } table { font-size: .8rem; } }
td small { color: var(--soft); } td.computed::after { content: "\2009\2217"; color: var(--soft); }
.good { color: var(--good); font-weight: 600; } .bad { color: var(--bad); font-weight: 600; }
.strip { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 14rem), 1fr)); gap: .6rem; margin: .5rem 0 1.2rem; }
.strip img { width: 100%; height: auto; display: block; border-radius: 3px; } .strip p { margin: .2rem 0 0; font-size: .84rem; }
details { margin: .8rem 0; } summary { cursor: pointer; color: var(--soft); }
)css";
}

std::string describeAssumptions() {
    return R"html(<ul class="words">
<li><b>Reference.</b> The displaced surface itself, with the whole map of the scene, at four times the triangles of the mesh of a
million. Distances are measured both ways, from samples of one surface to the nearest point of the other; RMS is the root of the
mean of both mean squares. Each method is made as small as it can be with a measured RMS distance within the tolerance.</li>
<li><b>Cage and map.</b> Resident bytes are everything that the device holds of the surface: patches, trees, owners, refined
points, texture coordinates, and the map with all its mip levels. Three things are made smaller: the depth of refinement around
extraordinary vertices, the size of the map, and its format; the device holds and draws the smaller ones. Maps of another size are
fitted by least squares, as a baker fits them. The vertices of dense meshes lie on the surface, as exporters put them: vertices
fitted in the same way would have a smaller error. On disk: the cage as OBJ text, and the map without mip levels.
The fewest bytes decide: the smallest map that meets a tolerance can need more triangles than the dense mesh has, and times and
bytes read are those of its own rate.</li>
<li><b>Dense mesh.</b> Each distinct sample once, and again where texture coordinates differ. Raw: position, normal and texture
coordinates as 32-bit floats, 32 bytes per vertex, and 32-bit indices. Quantised: 16-bit positions, 8-bit octahedral normals
and 16-bit texture coordinates, 12 bytes per vertex, triangles and vertices in an order made for caches. Simplified by
meshoptimizer in steps of a square root of two. Draco at the speed of its own encoder program, 8 bits for normals, 12 for texture
coordinates.</li>
<li><b>Geometry image.</b> The surface cut open and spread over a square, its positions and normals on a grid as 32-bit floats,
24 bytes per sample, without indices: the smallest one within the tolerance of those that are sampled from one parametrisation of
a mesh of some 250,000 triangles. On disk: the EXR file.</li>
<li><b>Bytes read per frame, cached.</b> Every resident byte once. Diced triangles are written to memory and read again.</li>
<li><b>Bytes read per frame, uncached.</b> A dense mesh: 32 bytes for every invocation of the vertex shader that the device
counted (three per triangle where nothing was counted), and its indices. A surface: for every evaluation the records of face and
patch (32 bytes), two words of the tree, sixteen control points with their indices of 16 bits (288), as many texture points (160),
and twelve texels of the map, 4 bytes each; of BC4 a block of 8 bytes each.</li>
<li><b>Bytes uploaded per pose.</b> The points of the cage, 12 bytes each; positions and normals of the dense mesh.</li>
<li><b>Times.</b> Each round draws every method once, so that a slow moment of the machine affects all of them; the first round is
not counted. Median, and 5th to 95th percentile. No shadows; four samples per pixel; the camera turns around the object.</li>
</ul>
)html";
}

} // namespace relief
