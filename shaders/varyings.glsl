// What the stages that make triangles hand to shade.frag. RELIEF_VARYING is in or out.
layout(location = 0) RELIEF_VARYING vec3 vPosition;
layout(location = 1) RELIEF_VARYING vec3 vNormal;
layout(location = 2) RELIEF_VARYING vec2 vTexCoord;
layout(location = 3) RELIEF_VARYING float vHeight;
layout(location = 4) flat RELIEF_VARYING uint vFace; // of the cage
layout(location = 5) flat RELIEF_VARYING uint vRate; // largest of the face's sides
