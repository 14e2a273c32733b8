#include <algorithm>
#include <cmath>
#include <cstring>

#include "cage/gltf_model.h"

namespace relief {
namespace {

constexpr std::uint64_t kMostNumbers = 1ull << 29;

bool isUnsigned(int componentType) {
    return componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
           componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
           componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
}

bool isByteOrShort(int componentType) {
    return componentType >= TINYGLTF_COMPONENT_TYPE_BYTE && componentType <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

/// Bytes of one number, or 0 for what is no component type.
std::uint64_t componentBytes(int componentType) {
    if (componentType == TINYGLTF_COMPONENT_TYPE_INT || componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE) return 0;
    return std::uint64_t(std::max(0, tinygltf::GetComponentSizeInBytes(std::uint32_t(componentType))));
}

std::uint64_t componentsOf(int type) { return std::uint64_t(tinygltf::GetNumComponentsInType(std::uint32_t(type))); }

const char* typeName(int type) {
    switch (type) {
    case TINYGLTF_TYPE_SCALAR: return "SCALAR";
    case TINYGLTF_TYPE_VEC2: return "VEC2";
    case TINYGLTF_TYPE_VEC3: return "VEC3";
    case TINYGLTF_TYPE_VEC4: return "VEC4";
    case TINYGLTF_TYPE_MAT4: return "MAT4";
    default: return "a matrix";
    }
}

template <typename Value>
Value valueAt(const unsigned char* bytes) {
    Value value;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
}

double numberAt(const unsigned char* bytes, int componentType) {
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return valueAt<std::int8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return valueAt<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_SHORT: return valueAt<std::int16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return valueAt<std::uint16_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return valueAt<std::uint32_t>(bytes);
    default: return valueAt<float>(bytes);
    }
}

/// What a normalised integer is divided by (section 3.11); 1 for plain numbers.
double largestOf(const tinygltf::Accessor& accessor) {
    if (!accessor.normalized) return 1;
    switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return 32767;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 65535;
    default: return 1;
    }
}

} // namespace

/// Where elements lie in a buffer; all of them inside.
struct GltfAccessors::Layout {
    const unsigned char* first = nullptr;
    std::uint64_t stride = 0;
};

GltfAccessors::GltfAccessors(const GltfModel& model)
    : model_(model), isQuantized_(std::count(model.model.extensionsUsed.begin(), model.model.extensionsUsed.end(),
                                             "KHR_mesh_quantization") != 0) {}

std::size_t GltfAccessors::count(int accessor, const std::string& place) const {
    const auto& accessors = model_.model.accessors;
    if (accessor < 0 || std::size_t(accessor) >= accessors.size())
        failAtElement(model_.path, place, "accessor {} does not exist; there are {} (from 0)", accessor,
                      accessors.size());
    return accessors[std::size_t(accessor)].count;
}

GltfAccessors::Layout GltfAccessors::layout(int view, std::uint64_t offset, std::uint64_t elementBytes,
                                            std::uint64_t count, const std::string& place) const {
    const tinygltf::Model& model = model_.model;
    if (view < 0 || std::size_t(view) >= model.bufferViews.size())
        failAtElement(model_.path, place, "buffer view {} does not exist; there are {} (from 0)", view,
                      model.bufferViews.size());
    const tinygltf::BufferView& bytes = model.bufferViews[std::size_t(view)];
    if (bytes.buffer < 0 || std::size_t(bytes.buffer) >= model.buffers.size())
        failAtElement(model_.path, place, "buffer {} of buffer view {} does not exist; there are {} (from 0)",
                      bytes.buffer, view, model.buffers.size());
    const std::vector<unsigned char>& buffer = model.buffers[std::size_t(bytes.buffer)].data;
    // Offsets, lengths and counts fit 32 bits, so none of these overflows.
    if (bytes.byteOffset + bytes.byteLength > buffer.size())
        failAtElement(model_.path, place, "buffer view {} ends at byte {} of buffer {}, which has {}", view,
                      bytes.byteOffset + bytes.byteLength, bytes.buffer, buffer.size());
    const std::uint64_t stride = bytes.byteStride == 0 ? elementBytes : bytes.byteStride;
    if (stride < elementBytes)
        failAtElement(model_.path, place, "elements of {} bytes every {} bytes in buffer view {}", elementBytes, stride,
                      view);
    const std::uint64_t end = offset + (count - 1) * stride + elementBytes;
    if (end > bytes.byteLength)
        failAtElement(model_.path, place, "{} elements end at byte {} of buffer view {}, which has {}", count, end,
                      view, bytes.byteLength);
    return {.first = buffer.data() + bytes.byteOffset + offset, .stride = stride};
}

const tinygltf::Accessor& GltfAccessors::checked(int index, const GltfUse& use) const {
    const std::size_t elements = count(index, use.place);
    const tinygltf::Accessor& accessor = model_.model.accessors[std::size_t(index)];
    if (accessor.type != use.type)
        failAtElement(model_.path, use.place, "accessor {} is of {}, {} expected", index, typeName(accessor.type),
                      typeName(use.type));
    if (use.count && elements != *use.count)
        failAtElement(model_.path, use.place, "accessor {} has {} elements, {} expected", index, elements, *use.count);
    if (elements == 0) failAtElement(model_.path, use.place, "accessor {} has no elements", index);
    if (componentBytes(accessor.componentType) == 0)
        failAtElement(model_.path, use.place, "accessor {} has components of unknown type {}", index,
                      accessor.componentType);
    if (accessor.bufferView < 0 && !use.count)
        failAtElement(model_.path, use.place, "accessor {} has no buffer view to take its elements from", index);
    return accessor;
}

void GltfAccessors::checkRoom(std::uint64_t numberCount, const std::string& place) const {
    if (numberCount_ + numberCount > kMostNumbers)
        failAtElement(model_.path, place, "with it the file unfolds to more than {} numbers, the most that are read",
                      kMostNumbers);
}

/// Some elements in other places than the rest (section 3.6.2.3).
void GltfAccessors::replaceSparse(const tinygltf::Accessor& accessor, std::vector<unsigned char>& bytes,
                                  const std::string& place) const {
    const auto& sparse = accessor.sparse;
    const auto replaced = std::uint64_t(sparse.count);
    if (replaced < 1 || replaced > accessor.count || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        failAtElement(model_.path, place, "{} sparse elements of {}", replaced, accessor.count);
    if (!isUnsigned(sparse.indices.componentType))
        failAtElement(model_.path, place, "sparse indices of component type {}; unsigned integers are needed",
                      sparse.indices.componentType);
    const std::uint64_t elementBytes = bytes.size() / accessor.count;
    const Layout indices = layout(sparse.indices.bufferView, std::uint64_t(sparse.indices.byteOffset),
                                  componentBytes(sparse.indices.componentType), replaced, place);
    const Layout values =
        layout(sparse.values.bufferView, std::uint64_t(sparse.values.byteOffset), elementBytes, replaced, place);
    for (std::uint64_t i = 0; i < replaced; ++i) {
        const auto index = std::uint64_t(numberAt(indices.first + i * indices.stride, sparse.indices.componentType));
        if (index >= accessor.count)
            failAtElement(model_.path, place, "sparse element {} does not exist; there are {} (from 0)", index,
                          accessor.count);
        std::memcpy(&bytes[index * elementBytes], values.first + i * values.stride, elementBytes);
    }
}

/// One after the other without gaps; zeros where nothing says what they are.
std::vector<unsigned char> GltfAccessors::elements(int index, const GltfUse& use) {
    const tinygltf::Accessor& accessor = checked(index, use);
    const std::uint64_t elementBytes = componentBytes(accessor.componentType) * componentsOf(accessor.type);
    const bool hasBytes = accessor.bufferView >= 0;
    const Layout from =
        hasBytes ? layout(accessor.bufferView, accessor.byteOffset, elementBytes, accessor.count, use.place) : Layout{};
    const std::uint64_t numberCount = accessor.count * componentsOf(accessor.type);
    checkRoom(numberCount, use.place);
    numberCount_ += numberCount;
    std::vector<unsigned char> bytes(accessor.count * elementBytes);
    if (hasBytes)
        for (std::uint64_t i = 0; i < accessor.count; ++i)
            std::memcpy(&bytes[i * elementBytes], from.first + i * from.stride, elementBytes);
    if (accessor.sparse.isSparse) replaceSparse(accessor, bytes, use.place);
    return bytes;
}

std::vector<float> GltfAccessors::floats(int index, const GltfUse& use) {
    const std::vector<unsigned char> bytes = elements(index, use);
    const tinygltf::Accessor& accessor = model_.model.accessors[std::size_t(index)];
    const bool isInteger = isByteOrShort(accessor.componentType);
    const bool isTaken = accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT ||
                         (isInteger && accessor.normalized && use.takesNormalized) ||
                         (isInteger && isQuantized_ && use.takesQuantized);
    if (!isTaken)
        failAtElement(model_.path, use.place, "accessor {} has {} components of type {}, which it cannot have", index,
                      accessor.normalized ? "normalized" : "plain", accessor.componentType);
    const std::uint64_t step = componentBytes(accessor.componentType);
    const double largest = largestOf(accessor);
    std::vector<float> values(bytes.size() / step);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double number = numberAt(&bytes[i * step], accessor.componentType);
        if (!std::isfinite(number))
            failAtElement(model_.path, use.place, "element {} is not finite ({}); give it numbers",
                          i / componentsOf(accessor.type), number);
        values[i] = largest == 1 ? float(number) : float(std::max(number / largest, -1.0));
    }
    return values;
}

std::vector<std::uint32_t> GltfAccessors::integers(int index, const GltfUse& use, int mostBytes) {
    const std::vector<unsigned char> bytes = elements(index, use);
    const tinygltf::Accessor& accessor = model_.model.accessors[std::size_t(index)];
    const std::uint64_t step = componentBytes(accessor.componentType);
    if (!isUnsigned(accessor.componentType) || step > std::uint64_t(mostBytes) || accessor.normalized)
        failAtElement(model_.path, use.place,
                      "accessor {} has components of type {}; unsigned integers of at most {} bytes are needed", index,
                      accessor.componentType, mostBytes);
    std::vector<std::uint32_t> values(bytes.size() / step);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = std::uint32_t(numberAt(&bytes[i * step], accessor.componentType));
    return values;
}

} // namespace relief
