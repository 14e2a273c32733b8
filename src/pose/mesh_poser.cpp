#include <algorithm>
#include <cstring>

#include "pose/stages.h"

namespace relief {
namespace {

constexpr std::uint32_t kGroup = 64; ///< invocations of pose_mesh.comp

std::vector<vec4> verticesOf(std::span<const vec3> positions, std::span<const vec3> normals) {
    std::vector<vec4> vertices;
    vertices.reserve(2 * positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
        vertices.emplace_back(positions[i], 0.0f);
        vertices.emplace_back(normals[i], 0.0f);
    }
    return vertices;
}

} // namespace

struct MeshPoser::Parts {
    Device& device;
    MeshModel& model;
    PosePush push;
    TexelBuffer rest, gradients, joints, influences, upload;
    Buffer staging; ///< of vertices that the host has posed
    Pipeline pipeline;
    BindingSet set;
};

MeshPoser::MeshPoser(Device& device, MeshModel& model, const DenseMesh& mesh, const Rig& rig)
    : parts_(new Parts{.device = device, .model = model}) {
    // Tables that no pose changes.
    Parts& p = *parts_;
    const std::vector<vec4> vertices = verticesOf(mesh.positions, mesh.normals);
    const auto texels = [&](const char* name, VkFormat format, auto span) {
        return uploadTexels(device, {.name = name}, format, std::as_bytes(span));
    };
    p.rest = texels("mesh at rest", VK_FORMAT_R32G32B32A32_SFLOAT, std::span(vertices));
    if (model.texGradients.buffer.bytes > 0) { // of the model, which is at rest
        std::vector<vec4> gradients(model.texGradients.buffer.bytes / sizeof(vec4));
        downloadBytes(device, model.texGradients.buffer, std::as_writable_bytes(std::span(gradients)));
        p.gradients = texels("mesh gradients at rest", VK_FORMAT_R32G32B32A32_SFLOAT, std::span(gradients));
        p.push.gradients = model.texGradients.buffer.address;
        p.push.gradientTexels = std::uint32_t(gradients.size() / mesh.positions.size());
    }
    p.joints = texels("mesh joints", VK_FORMAT_R32_UINT, std::span(rig.joints));
    p.influences = texels("mesh joint weights", VK_FORMAT_R32_SFLOAT, std::span(rig.weights));

    // What a pose uploads: the joints, or vertices that the host has posed.
    p.upload = makeTexels(device,
                          {.name = "mesh pose",
                           .bytes = std::uint64_t(kFloatsPerJoint) * rig.jointCount * sizeof(float),
                           .memory = MemoryUse::upload},
                          VK_FORMAT_R32_SFLOAT);
    p.staging = makeBuffer(device, {.name = "posed mesh",
                                    .bytes = vertices.size() * sizeof(vec4) + model.texGradients.buffer.bytes,
                                    .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                    .memory = MemoryUse::upload});

    // The pass that moves vertices into the model's own buffer.
    p.pipeline = makePosePipeline(device, "pose_mesh.comp");
    PoseBindings bindings;
    for (Binding& binding : bindings) binding = p.rest.binding(); // every one is bound, read or not
    if (p.push.gradientTexels > 0) bindings[kPoseGradients] = p.gradients.binding();
    bindings[kPoseUpload] = p.upload.binding();
    bindings[kPoseJoints] = p.joints.binding();
    bindings[kPoseInfluences] = p.influences.binding();
    p.set = makeBindingSet(device, p.pipeline, poseLayout(device), bindings);
    p.push.target = model.vertices.buffer.address;
    p.push.pointCount = std::uint32_t(mesh.positions.size());
    p.push.influenceCount = rig.influenceCount;
}

MeshPoser::~MeshPoser() = default;

void MeshPoser::pose(const Pose& pose) {
    Parts& p = *parts_;
    const std::vector<float> floats = rigFloats(pose);
    std::memcpy(p.upload.buffer.mapped, floats.data(), floats.size() * sizeof(float));
    p.device.submitAndWait([&](VkCommandBuffer commands) {
        bind(commands, p.pipeline, p.set);
        for (std::uint32_t first = 0; first < p.push.pointCount; first += kGroup * kGroupsAtOnce) {
            PosePush part = p.push;
            part.firstPoint = first;
            push(commands, p.pipeline, std::as_bytes(std::span(&part, 1)));
            const std::uint32_t groups = (p.push.pointCount - first + kGroup - 1) / kGroup;
            vkCmdDispatch(commands, std::min(groups, kGroupsAtOnce), 1, 1);
        }
        barrier(commands);
    });
}

std::uint64_t MeshPoser::upload(const DenseMesh& posed, const Tangents* tangents) {
    Parts& p = *parts_;
    std::vector<vec4> texels = verticesOf(posed.positions, posed.normals);
    const std::uint64_t vertexBytes = texels.size() * sizeof(vec4);
    if (tangents != nullptr || p.model.function) {
        const std::vector<vec4> more = toTexGradients(posed, tangents, p.model.restPositions);
        texels.insert(texels.end(), more.begin(), more.end());
    }
    const std::uint64_t bytes = texels.size() * sizeof(vec4);
    RELIEF_CHECK(bytes <= p.staging.bytes);
    std::memcpy(p.staging.mapped, texels.data(), bytes);
    p.device.submitAndWait([&](VkCommandBuffer commands) {
        const auto copy = [&](std::uint64_t from, std::uint64_t count, const TexelBuffer& to) {
            const VkBufferCopy region{from, 0, count};
            if (count > 0) vkCmdCopyBuffer(commands, p.staging.handle.get(), to.buffer.handle.get(), 1, &region);
        };
        copy(0, vertexBytes, p.model.vertices);
        copy(vertexBytes, bytes - vertexBytes, p.model.texGradients);
        barrier(commands);
    });
    return bytes;
}

} // namespace relief
