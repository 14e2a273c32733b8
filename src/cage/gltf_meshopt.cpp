// EXT_meshopt_compression: the bytes of a buffer view, compressed.
#include <meshoptimizer.h>

#include "cage/gltf_reader.h"

namespace relief {
namespace {

constexpr std::uint64_t kMostGrowth = 64, kLeastBytes = 1024; ///< the codecs have 2 bits for 16 bytes, and a tail

/// What the extension says of a view; checked against what the decoders can do.
struct MeshoptView {
    std::string mode, filter;
    std::uint64_t count = 0, stride = 0;
};

bool isDecodable(const MeshoptView& view) {
    const bool areIndices = view.mode == "INDICES" || view.mode == "TRIANGLES";
    if (areIndices)
        return (view.stride == 2 || view.stride == 4) && view.filter == "NONE" &&
               (view.mode == "INDICES" || view.count % 3 == 0);
    if (view.mode != "ATTRIBUTES" || view.stride == 0 || view.stride > 256 || view.stride % 4 != 0) return false;
    if (view.filter == "OCTAHEDRAL") return view.stride == 4 || view.stride == 8;
    if (view.filter == "QUATERNION") return view.stride == 8;
    return view.filter == "NONE" || view.filter == "EXPONENTIAL";
}

bool decode(const MeshoptView& view, std::span<const unsigned char> from, char* to) {
    if (view.mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(to, view.count, view.stride, from.data(), from.size()) == 0;
    if (view.mode == "INDICES")
        return meshopt_decodeIndexSequence(to, view.count, view.stride, from.data(), from.size()) == 0;
    if (meshopt_decodeVertexBuffer(to, view.count, view.stride, from.data(), from.size()) != 0) return false;
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(to, view.count, view.stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(to, view.count, view.stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(to, view.count, view.stride);
    return true;
}

} // namespace

std::string decodeMeshopt(const GltfElement& extension, std::uint64_t byteCount, std::span<const unsigned char> from) {
    const MeshoptView view{.mode = extension.need("mode").text("mode"),
                           .filter = extension.has("filter") ? extension.text("filter") : "NONE",
                           .count = *extension.need("count").integer("count"),
                           .stride = *extension.need("byteStride").integer("byteStride")};
    if (!isDecodable(view))
        extension.fail("{} of {} bytes with the filter {} are not known", printable(view.mode), view.stride,
                       printable(view.filter));
    if (view.count * view.stride != byteCount)
        extension.fail("{} elements of {} bytes; the view has {}", view.count, view.stride, byteCount);
    if (byteCount > kLeastBytes + kMostGrowth * from.size())
        extension.fail("{} cannot be in {} bytes", humanBytes(byteCount), from.size());
    std::string bytes(byteCount, '\0');
    if (!decode(view, from, bytes.data())) extension.fail("its bytes cannot be decompressed; is the file whole?");
    return bytes;
}

} // namespace relief
