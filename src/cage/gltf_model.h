// The steps of reading a glTF file, in order: loadGltfModel checks the JSON and has tinygltf make structs of it,
// GltfAccessors takes numbers out of buffers, readGltf makes plain arrays of all. tinygltf believes whatever it is
// told.
#pragma once

// No pictures, no files but through the callbacks it is given.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

#include "cage/gltf.h"

namespace relief {

struct GltfModel {
    std::string path;
    tinygltf::Model model; ///< without what hangs on materials
    std::vector<std::string> materials;
};

/// Throws as readGltf. After it every index is a whole number and every member has its type; what they refer to is
/// unchecked.
GltfModel loadGltfModel(const std::string& path);

/// Throws Failure::input as "PATH: PLACE: ...".
template <typename... Args>
[[noreturn]] void failAtElement(const std::string& path, std::string_view place, fmt::format_string<Args...> format,
                                Args&&... args) {
    fail(Failure::input, "{}: {}: {}", path, place, fmt::format(format, std::forward<Args>(args)...));
}

/// What an accessor must be to be read for a purpose.
struct GltfUse {
    std::string place; ///< "meshes/0/primitives/1/POSITION", for messages
    int type = TINYGLTF_TYPE_SCALAR;
    bool takesNormalized = false;     ///< also bytes and shorts that stand for -1..1 or 0..1
    bool takesQuantized = false;      ///< also plain bytes and shorts, in files that name KHR_mesh_quantization
    std::optional<std::size_t> count; ///< elements; any where it is not said
};

/// Reads the numbers of accessors, sparse ones too.
class GltfAccessors {
public:
    explicit GltfAccessors(const GltfModel& model);

    /// Floats, or integers mapped to them (section 3.11); all finite. `accessor` need not exist.
    [[nodiscard]] std::vector<float> floats(int accessor, const GltfUse& use);
    /// Unsigned integers of at most `bytes` bytes each.
    [[nodiscard]] std::vector<std::uint32_t> integers(int accessor, const GltfUse& use, int bytes);
    /// Throws where so many numbers more are too many: accessors of the same bytes, or of none, must not fill the
    /// memory.
    void checkRoom(std::uint64_t numberCount, const std::string& place) const;
    /// The number of elements. Throws where there is no such accessor.
    [[nodiscard]] std::size_t count(int accessor, const std::string& place) const;

private:
    struct Layout;
    [[nodiscard]] const tinygltf::Accessor& checked(int accessor, const GltfUse& use) const;
    [[nodiscard]] std::vector<unsigned char> elements(int accessor, const GltfUse& use);
    [[nodiscard]] Layout layout(int view, std::uint64_t offset, std::uint64_t elementBytes, std::uint64_t count,
                                const std::string& place) const;
    void replaceSparse(const tinygltf::Accessor& accessor, std::vector<unsigned char>& bytes,
                       const std::string& place) const;

    const GltfModel& model_;
    bool isQuantized_;
    std::uint64_t numberCount_ = 0; ///< read so far
};

/// Throws as readGltf.
GltfMesh readGltfMesh(const GltfModel& model, std::size_t mesh, GltfAccessors& accessors, const Warn& warn);

/// The clips of a file whose nodes and meshes are read. Throws as readGltf.
std::vector<GltfClip> readGltfClips(const GltfModel& model, const GltfScene& scene, GltfAccessors& accessors,
                                    const Warn& warn);

/// Numbers as vectors.
template <typename Vector>
std::vector<Vector> grouped(const std::vector<float>& numbers) {
    std::vector<Vector> vectors(numbers.size() / std::size_t(Vector::length()));
    for (std::size_t i = 0; i < vectors.size(); ++i)
        for (int k = 0; k < Vector::length(); ++k)
            vectors[i][k] = numbers[i * std::size_t(Vector::length()) + std::size_t(k)];
    return vectors;
}

} // namespace relief
