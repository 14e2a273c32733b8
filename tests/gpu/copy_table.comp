#version 460
#extension GL_EXT_buffer_reference : require
// Copies a table of words, read as texels or as a storage buffer, to an address.
layout(local_size_x = 64) in;
#ifdef STORAGE
layout(set = 0, binding = 0) readonly buffer Table { uint words[]; } table;
uint read(uint i) { return table.words[i]; }
#else
layout(set = 0, binding = 0) uniform utextureBuffer table;
uint read(uint i) { return texelFetch(table, int(i)).x; }
#endif
layout(buffer_reference, std430, buffer_reference_align = 4) writeonly buffer Target { uint words[]; };
layout(push_constant) uniform Push { Target target; uint count; } push;

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < push.count) push.target.words[i] = read(i);
}
