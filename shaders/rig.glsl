// Linear blend skinning by what was uploaded for a pose: morph weights, then three rows of four a joint.
layout(set = 0, binding = kPoseUpload) uniform samplerBuffer uploadTexels;
layout(set = 0, binding = kPoseRest) uniform samplerBuffer restTexels;
layout(set = 0, binding = kPoseJoints) uniform usamplerBuffer jointTexels;
layout(set = 0, binding = kPoseInfluences) uniform samplerBuffer influenceTexels;

float uploaded(uint i) { return texelFetch(uploadTexels, int(i)).x; }

vec4 uploadedRow(uint i) { return vec4(uploaded(i), uploaded(i + 1u), uploaded(i + 2u), uploaded(i + 3u)); }

// sum_i w_i J_i of a point, its rows as columns: vec4(p, 1) * m is the moved p (glTF 2.0, section 3.7.3.3).
mat3x4 blendedJoints(uint point) {
    mat3x4 sum = mat3x4(0.0);
    for (uint i = point * influenceCount; i < (point + 1u) * influenceCount; ++i) {
        uint row = morphCount + 12u * texelFetch(jointTexels, int(i)).x;
        sum += texelFetch(influenceTexels, int(i)).x * mat3x4(uploadedRow(row), uploadedRow(row + 4u), uploadedRow(row + 8u));
    }
    return sum;
}
