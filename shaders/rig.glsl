// Linear blend skinning by what was uploaded for a pose: morph weights, then three rows of four per joint.
RELIEF_TABLE(kPoseUpload, float, uploaded)
RELIEF_TABLE(kPoseRest, vec4, restAt)
RELIEF_TABLE(kPoseJoints, uint, jointAt)
RELIEF_TABLE(kPoseInfluences, float, influenceAt)

vec4 uploadedRow(uint i) { return vec4(uploaded(i), uploaded(i + 1u), uploaded(i + 2u), uploaded(i + 3u)); }

// sum_i w_i J_i of a point, its rows as columns: vec4(p, 1) * m is the moved p (glTF 2.0, section 3.7.3.3).
mat3x4 blendedJoints(uint point) {
    mat3x4 sum = mat3x4(0.0);
    for (uint i = point * push.influenceCount; i < (point + 1u) * push.influenceCount; ++i) {
        uint row = push.morphCount + 12u * jointAt(i);
        sum += influenceAt(i) * mat3x4(uploadedRow(row), uploadedRow(row + 4u), uploadedRow(row + 8u));
    }
    return sum;
}
