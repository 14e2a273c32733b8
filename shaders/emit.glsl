// The end of every stage that makes vertices of the displaced surface.
#define RELIEF_VARYING out
#include "varyings.glsl"

vec4 project(vec3 position) {
    if (drawsShadow != 0u) return scene.worldToShadow * vec4(position, 1.0);
    return scene.worldToClip * vec4(position, 1.0);
}

void emitVertex(uint face, vec2 uv, Place place, uint rate) {
    DisplacedSample s = displaced(face, uv, place);
    precise vec4 clip = project(s.q);
    gl_Position = clip;
    vNormal = s.normal;
    vTexCoord = s.st;
    vHeight = s.h;
    vFace = recordTexel(scene.firstFace, kFaceTexels, face, 1u).y;
    vRate = rate;
}
