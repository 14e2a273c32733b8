// Tables of the device: arrays that passes read by number. RELIEF_TABLE(slot, element, name) declares one and the function
// `element name(uint i)` that reads it.
//
// Texel buffers are the fast way (see shared/bindings.h). Devices may limit them to 65,536 texels: for those all shaders are
// compiled once more with RELIEF_STORAGE_TABLES, and the same elements come from storage buffers.
#ifndef RELIEF_TABLES_GLSL
#define RELIEF_TABLES_GLSL

#extension GL_EXT_scalar_block_layout : require

#ifdef RELIEF_STORAGE_TABLES
#define RELIEF_TABLE(slot, element, name) \
    layout(set = 0, binding = slot, scalar) readonly buffer name##Block { element elements[]; } name##Table; \
    element name(uint i) { return name##Table.elements[i]; }
#else
#define RELIEF_SAMPLER_uint usamplerBuffer
#define RELIEF_SAMPLER_uvec2 usamplerBuffer
#define RELIEF_SAMPLER_uvec4 usamplerBuffer
#define RELIEF_SAMPLER_float samplerBuffer
#define RELIEF_SAMPLER_vec2 samplerBuffer
#define RELIEF_SAMPLER_vec4 samplerBuffer
#define RELIEF_PART_uint x
#define RELIEF_PART_uvec2 xy
#define RELIEF_PART_uvec4 xyzw
#define RELIEF_PART_float x
#define RELIEF_PART_vec2 xy
#define RELIEF_PART_vec4 xyzw
#define RELIEF_TABLE(slot, element, name) \
    layout(set = 0, binding = slot) uniform RELIEF_SAMPLER_##element name##Table; \
    element name(uint i) { return texelFetch(name##Table, int(i)).RELIEF_PART_##element; }
#endif
#endif
