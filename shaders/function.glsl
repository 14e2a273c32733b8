// Heights by a function instead of a map. Only where RELIEF_HEIGHT_FUNCTION is defined: shaders compiled at run time.
#ifndef RELIEF_FUNCTION_GLSL
#define RELIEF_FUNCTION_GLSL

#include "inputs.glsl"
#include "height_function.glsl" // no file: the model's own function, formula_value(), see src/formula

float functionTime = inputs.model.heightTime; // layers.comp also asks for the frame before

// Height by the function at a point of the limit surface at rest. No more than the bound, and never NaN: bounds of faces and
// triangles hold whatever the function returns.
float heightOfFunction(vec3 p, vec2 st) {
    float value = formula_value(inputs.model.heightUnit * p, st, functionTime);
    precise float h = inputs.model.maps[0].scale * (value - inputs.model.maps[0].mid);
    return isnan(h) ? 0.0 : clamp(h, -inputs.model.heightBound, inputs.model.heightBound);
}
#endif
