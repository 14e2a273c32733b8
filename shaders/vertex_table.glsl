// Coordinates in the table of kShadingVertexTable at a vertex (Hart, section 16.4): linear interpolation between them misses
// highlights inside of triangles.
#ifndef RELIEF_VERTEX_TABLE_GLSL
#define RELIEF_VERTEX_TABLE_GLSL

layout(constant_id = kIdShading) const uint kShading = kShadingPhysical;

// n.l and v.r; the normal is of length 1 and in the world, the position in the model's own space.
vec2 tableCoordinates(vec3 n, vec3 position) {
    vec3 v = normalize(inputs.view.normalToWorld * (inputs.view.eye - position)), l = inputs.light.keyDirection;
    return vec2(dot(n, l), dot(v, reflect(-l, n)));
}
#endif
