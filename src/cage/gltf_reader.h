// The steps of reading a glTF file, in order: loadGltfDocument checks the JSON, GltfBuffers finds bytes, GltfAccessors
// takes numbers out of them, readGltf makes plain arrays of all. Each takes only what the scene that is shown needs.
#pragma once

#include <map>

#include "cage/gltf_json.h"

// Only constants and small helpers of tinygltf are used: its loader reads all of a file, needed or not, unchecked.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

namespace draco {
class Mesh;
class PointAttribute;
} // namespace draco

namespace relief {

struct GltfDocument {
    std::string path;
    nlohmann::json json;
    std::string file;                         ///< of a .glb, all its bytes
    std::size_t firstByte = 0, byteCount = 0; ///< of its second chunk, in `file`; none in a .gltf
    bool isBinary = false;
    std::uint32_t uvSet = 0; ///< TEXCOORD_n is read with this n

    [[nodiscard]] GltfElement root() const { return {json, path, ""}; }
    /// An entry of one of the file's own lists. Throws, naming the place that asks for it, where there is none.
    [[nodiscard]] GltfElement entry(const char* list, const char* what, std::uint32_t index,
                                    const std::string& place) const;
};

/// Reads the file and checks its JSON. Throws as readGltf.
GltfDocument loadGltfDocument(const std::string& path, const Warn& warn);

/// Bytes of buffers and of views of them, each buffer read when it is asked for first.
class GltfBuffers {
public:
    explicit GltfBuffers(const GltfDocument& document);

    /// The bytes of a view that `place` asks for.
    [[nodiscard]] std::span<const unsigned char> view(std::uint32_t view, const std::string& place);

private:
    [[nodiscard]] std::span<const unsigned char> buffer(std::uint32_t index, const std::string& place);
    /// The bytes of a buffer that `from`, a view or its extension, names.
    [[nodiscard]] std::span<const unsigned char> part(const GltfElement& from, const std::string& what,
                                                      const std::string& place);

    const GltfDocument& document_;
    std::map<std::uint32_t, std::string> read_;         ///< those that are not in the document's file
    std::map<std::uint32_t, std::string> decompressed_; ///< views of EXT_meshopt_compression
};

/// The bytes of a picture that lies in a file below the folder of the glTF file, or in the "uri" itself.
std::string readGltfPicture(const GltfElement& image);

/// Decompresses `from`, which has the `byteCount` bytes of a view with EXT_meshopt_compression.
std::string decodeMeshopt(const GltfElement& extension, std::uint64_t byteCount, std::span<const unsigned char> from);

/// What an accessor must be to be read for a purpose.
struct GltfUse {
    std::string place; ///< "meshes/0/primitives/1/POSITION", for messages
    int type = TINYGLTF_TYPE_SCALAR;
    bool takesNormalized = false;     ///< also bytes and shorts that stand for -1..1 or 0..1
    bool takesQuantized = false;      ///< also plain bytes and shorts, in files that name KHR_mesh_quantization
    std::optional<std::size_t> count; ///< elements; empty: any number
    const draco::PointAttribute* decoded = nullptr; ///< holds the elements instead, where they were compressed
};

/// Reads the numbers of accessors, sparse ones too.
class GltfAccessors {
public:
    explicit GltfAccessors(const GltfDocument& document);

    /// Reads floats, or integers mapped to them (section 3.11), of all elements or of those in `which`, each below the
    /// count. Throws for numbers that are not finite and where there is no such accessor.
    [[nodiscard]] std::vector<float> floats(std::uint32_t accessor, const GltfUse& use,
                                            std::optional<std::span<const std::uint32_t>> which = {});
    /// Reads unsigned integers of at most `mostBytes` bytes each, of all elements or of those in `which`.
    [[nodiscard]] std::vector<std::uint32_t> integers(std::uint32_t accessor, const GltfUse& use, int mostBytes,
                                                      std::optional<std::span<const std::uint32_t>> which = {});
    /// The number of elements, at least one. Throws where there is no such accessor.
    [[nodiscard]] std::size_t count(std::uint32_t accessor, const std::string& place) const;
    /// Throws where so many numbers more are too many: accessors of the same bytes, or of none, must not fill the
    /// memory.
    void checkRoom(std::uint64_t numberCount, const std::string& place) const;
    /// Throws as checkRoom, else counts the numbers: memory is about to be taken for them.
    void takeRoom(std::uint64_t numberCount, const std::string& place);
    [[nodiscard]] GltfBuffers& buffers() { return buffers_; }

private:
    struct Layout;
    struct Elements;
    struct Sparse { ///< elements that are stored apart from the others; their numbers rise
        std::vector<std::uint32_t> indices;
        const unsigned char* values = nullptr;
        std::uint64_t stride = 0;
    };
    [[nodiscard]] Elements elements(std::uint32_t accessor, const GltfUse& use);
    /// `count` elements from a view that `from`, an accessor or a part of a sparse one, names with an offset.
    [[nodiscard]] Layout layout(const GltfElement& from, std::uint64_t elementBytes, std::uint64_t count,
                                const std::string& place);
    [[nodiscard]] const Sparse* sparse(std::uint32_t accessor, std::uint64_t elementBytes, std::uint64_t count,
                                       const std::string& place);

    const GltfDocument& document_;
    GltfBuffers buffers_;
    std::map<std::uint32_t, Sparse> sparse_; ///< by accessor
    bool isQuantized_;
    std::uint64_t numberCount_ = 0;
};

/// What KHR_draco_mesh_compression holds, each view decoded once.
class GltfDracoMeshes {
public:
    GltfDracoMeshes(const GltfDocument& document, GltfAccessors& accessors);
    ~GltfDracoMeshes();

    /// The mesh of a primitive's extension. Throws where it cannot be decoded and where its points or faces are other
    /// than `pointCount` and `faceCount`, which are checked before memory is taken.
    const draco::Mesh& decode(const GltfElement& extension, std::uint64_t pointCount, std::uint64_t faceCount);

private:
    const GltfDocument& document_;
    GltfAccessors& accessors_;
    std::map<std::uint32_t, std::unique_ptr<draco::Mesh>> meshes_; ///< by buffer view
};

/// Finds the attribute of a mesh that the extension calls `name`; null where it has none of that name. Throws where the
/// mesh lacks the attribute or its values are outside its bytes.
const draco::PointAttribute* dracoAttribute(const draco::Mesh& mesh, const GltfElement& extension,
                                            const std::string& name);
/// Returns the corners of the triangles of a decoded mesh, three points each.
std::vector<std::uint32_t> dracoCorners(const draco::Mesh& mesh);

/// Oddities that many elements of a file may have: one warning each, with their number and the first place.
class GltfOddities {
public:
    /// `what` is what stands before the number: "primitives without POSITION are skipped".
    void add(const char* what, const std::string& place, std::size_t count = 1);
    void report(const std::string& path, const Warn& warn) const;

private:
    struct Oddity {
        std::size_t count = 0;
        std::string firstPlace;
    };
    std::map<std::string, Oddity> oddities_;
};

/// What reading meshes needs and fills.
struct GltfMeshReading {
    const GltfDocument& document;
    GltfAccessors& accessors;
    GltfDracoMeshes& dracoMeshes;
    GltfOddities& oddities;
};

/// Reads a mesh with all its primitives. Throws as readGltf.
GltfMesh readGltfMesh(const GltfElement& from, GltfMeshReading& reading);

/// Reads the animation `asked`, a name or a number; "": the first. `scene` has its nodes and meshes; channels that move
/// nodes that are not shown are skipped. Empty where `asked` is "" and the file has no animation.
std::optional<GltfClip> readGltfClip(const GltfDocument& document, const std::string& asked, const GltfScene& scene,
                                     GltfAccessors& accessors, GltfOddities& oddities);

/// Groups consecutive numbers into vectors.
template <typename Vector>
std::vector<Vector> grouped(const std::vector<float>& numbers) {
    std::vector<Vector> vectors(numbers.size() / std::size_t(Vector::length()));
    for (std::size_t i = 0; i < vectors.size(); ++i)
        for (int k = 0; k < Vector::length(); ++k)
            vectors[i][k] = numbers[i * std::size_t(Vector::length()) + std::size_t(k)];
    return vectors;
}

} // namespace relief
