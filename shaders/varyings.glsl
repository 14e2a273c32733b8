// What the stages that make triangles hand to surface.frag. RELIEF_VARYING is in or out.
layout(location = 0) RELIEF_VARYING vec3 vNormal;
layout(location = 1) RELIEF_VARYING vec2 vTexCoord;
layout(location = 2) RELIEF_VARYING float vHeight;
layout(location = 3) flat RELIEF_VARYING uint vFace; // of the cage
layout(location = 4) flat RELIEF_VARYING uint vRate; // largest of the face's sides
