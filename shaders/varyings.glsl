// What the stages that make triangles hand to surface.frag. RELIEF_VARYING is in or out.
layout(location = 0) RELIEF_VARYING vec3 vNormal;
layout(location = 1) RELIEF_VARYING vec4 vTexCoord; // (s,t), and for layers the face's own (u,v)
layout(location = 2) RELIEF_VARYING float vHeight;
layout(location = 3) flat RELIEF_VARYING uint vFace; // of the cage; for layers that of the surface
layout(location = 4) flat RELIEF_VARYING uint vRate; // largest of the face's sides

// kHasTangents: derivative of the drawn surface by s and by t, in the world's directions; and how much of h_s and h_t the
// normal has already. Where heights stretch with the surface both are divided by the stretch.
layout(location = 5) RELIEF_VARYING vec4 vTangentS;
layout(location = 6) RELIEF_VARYING vec4 vTangentT;
