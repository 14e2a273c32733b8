#version 460
// What a shader of many ways does: constants choose one, of which the others are no part.
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require

layout(constant_id = 0) const uint kWay = 0;
layout(constant_id = 1) const uint kGroupSize = 64;
layout(local_size_x_id = 1) in;

layout(buffer_reference, scalar) writeonly buffer Words { uint at[]; };
layout(push_constant, scalar) uniform Push { Words target; uint count; };

const bool kTurns = kWay == 2;

uint turned(uint value) {
    for (uint i = 0; i < 5; ++i) value = (value << 7 | value >> 25) ^ (value * 2654435761u + i);
    return value;
}

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint value = i;
    if (kTurns) value = turned(turned(value) + 1);
    else if (kWay == 1) value = 3 * i + kGroupSize;
    target.at[i] = value;
}
