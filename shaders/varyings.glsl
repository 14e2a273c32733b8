// What the stages that make triangles hand to surface.frag. RELIEF_VARYING is in or out; in
// raster_resolve.comp, which makes fragments of samples, all of it is plain variables.
#ifndef RELIEF_LOCATION
#define RELIEF_LOCATION(i) layout(location = i)
#define RELIEF_FLAT flat
#endif
RELIEF_LOCATION(0) RELIEF_VARYING vec3 vNormal;
RELIEF_LOCATION(1) RELIEF_VARYING vec4 vTexCoord; // (s,t), and with kPassLayers the face's own (u,v)
RELIEF_LOCATION(2) RELIEF_VARYING float vHeight;
RELIEF_LOCATION(3) RELIEF_FLAT RELIEF_VARYING uint vFace; // of the cage; with kPassLayers that of the surface
RELIEF_LOCATION(4) RELIEF_FLAT RELIEF_VARYING uint vRate; // largest of the face's sides

// kHasTexGradients: the gradients of s and t along the drawn surface, in the world's directions, cage units; the fourth number is
// not used. Where heights stretch with the surface, gradients are multiplied with the stretch. Without kHasTexGradients, S holds
// the point itself with kPassLayers, in the model's own space.
RELIEF_LOCATION(5) RELIEF_VARYING vec4 vGradientS;
RELIEF_LOCATION(6) RELIEF_VARYING vec4 vGradientT;

#ifdef RELIEF_HEIGHT_FUNCTION
// What a function that bends normals is given (kHasSlopes): the limit surface's point at rest, and how it moves with the point
// of the drawn surface, per unit of length in the world's directions: p0_u (x) grad u + p0_v (x) grad v. Where heights
// stretch with the surface, it is multiplied with the stretch, as gradients are.
RELIEF_LOCATION(8) RELIEF_VARYING vec3 vRest;
RELIEF_LOCATION(9) RELIEF_VARYING mat3 vRestGradient;
#endif
