#include <algorithm>
#include <cmath>
#include <cstring>

#include <draco/attributes/point_attribute.h>

#include "cage/gltf_reader.h"

namespace relief {
namespace {

constexpr std::uint64_t kMostNumbers = 1ull << 29;

struct NamedType {
    std::string_view name;
    int type;
};
constexpr NamedType kTypes[] = {{"SCALAR", TINYGLTF_TYPE_SCALAR}, {"VEC2", TINYGLTF_TYPE_VEC2},
                                {"VEC3", TINYGLTF_TYPE_VEC3},     {"VEC4", TINYGLTF_TYPE_VEC4},
                                {"MAT2", TINYGLTF_TYPE_MAT2},     {"MAT3", TINYGLTF_TYPE_MAT3},
                                {"MAT4", TINYGLTF_TYPE_MAT4}};

std::string_view typeName(int type) {
    return std::find_if(std::begin(kTypes), std::end(kTypes), [&](const NamedType& t) { return t.type == type; })->name;
}

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

/// The component type of what Draco has decoded, or 0.
int componentTypeOf(draco::DataType type) {
    switch (type) {
    case draco::DT_INT8: return TINYGLTF_COMPONENT_TYPE_BYTE;
    case draco::DT_UINT8: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE;
    case draco::DT_INT16: return TINYGLTF_COMPONENT_TYPE_SHORT;
    case draco::DT_UINT16: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    case draco::DT_UINT32: return TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    case draco::DT_FLOAT32: return TINYGLTF_COMPONENT_TYPE_FLOAT;
    default: return 0;
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

/// What a normalised integer is divided by (section 3.11).
double largestOf(int componentType) {
    switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return 127;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return 255;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return 32767;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return 65535;
    default: return 1;
    }
}

/// Calls act(i, which[i]) for each, or act(i, i) for `all` elements where which is not given.
template <typename Act>
void forEach(std::optional<std::span<const std::uint32_t>> which, std::size_t all, const Act& act) {
    const std::size_t count = which ? which->size() : all;
    for (std::size_t i = 0; i < count; ++i) act(i, which ? (*which)[i] : i);
}

bool usesQuantization(const GltfDocument& document) {
    const auto used = document.json.find("extensionsUsed");
    return used != document.json.end() && used->is_array() &&
           std::find(used->begin(), used->end(), "KHR_mesh_quantization") != used->end();
}

} // namespace

/// Elements in a row, all of them inside a buffer.
struct GltfAccessors::Layout {
    const unsigned char* first = nullptr;
    std::uint64_t stride = 0;
};

/// All elements of an accessor, wherever they are.
struct GltfAccessors::Elements {
    int componentType = 0;
    std::uint64_t width = 0, count = 0; ///< numbers of an element, elements
    bool isNormalized = false;
    Layout layout;
    const Sparse* sparse = nullptr;
    const draco::PointAttribute* decoded = nullptr;

    [[nodiscard]] const unsigned char* bytes(std::size_t element) const {
        if (decoded != nullptr) return decoded->GetAddressOfMappedIndex(draco::PointIndex(std::uint32_t(element)));
        if (sparse != nullptr) {
            const std::vector<std::uint32_t>& all = sparse->indices;
            const auto found = std::lower_bound(all.begin(), all.end(), element);
            if (found != all.end() && *found == element)
                return sparse->values + std::uint64_t(found - all.begin()) * sparse->stride;
        }
        return layout.first + element * layout.stride;
    }
    [[nodiscard]] double number(std::size_t element, std::size_t component) const {
        return numberAt(bytes(element) + component * componentBytes(componentType), componentType);
    }
};

GltfAccessors::GltfAccessors(const GltfDocument& document)
    : document_(document), buffers_(document), isQuantized_(usesQuantization(document)) {}

std::size_t GltfAccessors::count(std::uint32_t accessor, const std::string& place) const {
    const std::size_t count = *document_.entry("accessors", "accessor", accessor, place).need("count").integer("count");
    if (count == 0) failAtElement(document_.path, place, "accessor {} has no elements", accessor);
    return count;
}

void GltfAccessors::takeRoom(std::uint64_t numberCount, const std::string& place) {
    checkRoom(numberCount, place);
    numberCount_ += numberCount;
}

void GltfAccessors::checkRoom(std::uint64_t numberCount, const std::string& place) const {
    if (numberCount_ + numberCount > kMostNumbers)
        failAtElement(document_.path, place,
                      "with it the accessors in use have more than {} numbers, the most that are read", kMostNumbers);
}

GltfAccessors::Layout GltfAccessors::layout(const GltfElement& from, std::uint64_t elementBytes, std::uint64_t count,
                                            const std::string& place) {
    const std::uint32_t view = *from.need("bufferView").integer("bufferView");
    const std::span<const unsigned char> bytes = buffers_.view(view, place);
    const std::uint64_t offset = from.size("byteOffset");
    const std::uint64_t given = document_.root().at("bufferViews", view).integer("byteStride").value_or(0);
    const std::uint64_t stride = given == 0 ? elementBytes : given;
    if (stride < elementBytes)
        failAtElement(document_.path, place, "elements of {} bytes every {} bytes in buffer view {}", elementBytes,
                      stride, view);
    const std::uint64_t end = offset + (count - 1) * stride + elementBytes; // of numbers of 32 bits each
    if (end > bytes.size())
        failAtElement(document_.path, place, "{} elements end at byte {} of buffer view {}, which has {}", count, end,
                      view, bytes.size());
    return {.first = bytes.data() + offset, .stride = stride};
}

/// Reads where the elements are that a sparse accessor replaces (section 3.6.2.3).
const GltfAccessors::Sparse* GltfAccessors::sparse(std::uint32_t accessor, std::uint64_t elementBytes,
                                                   std::uint64_t count, const std::string& place) {
    const GltfElement from = *document_.root().at("accessors", accessor).object("sparse");
    // Read once per accessor, however many primitives use it.
    const auto [kept, isNew] = sparse_.try_emplace(accessor);
    Sparse& sparse = kept->second;
    if (!isNew) return &sparse;

    // Two views: the numbers of the elements, and their values.
    const std::uint64_t replaced = from.need("count").integer("count").value_or(0);
    if (replaced < 1 || replaced > count)
        failAtElement(document_.path, place, "{} sparse elements of {}", replaced, count);
    const GltfElement indices = *from.need("indices").object("indices"), values = *from.need("values").object("values");
    const int type = int(*indices.need("componentType").integer("componentType"));
    if (!isUnsigned(type))
        failAtElement(document_.path, place, "sparse indices of component type {}; unsigned integers are needed", type);
    const Layout numbers = layout(indices, componentBytes(type), replaced, place);
    const Layout elements = layout(values, elementBytes, replaced, place);
    sparse.values = elements.first, sparse.stride = elements.stride;

    // Numbers that rise are found by bisection.
    for (std::uint64_t i = 0; i < replaced; ++i) {
        const auto index = std::uint32_t(numberAt(numbers.first + i * numbers.stride, type));
        if (index >= count)
            failAtElement(document_.path, place, "sparse element {} does not exist; there are {} (from 0)", index,
                          count);
        if (i > 0 && index <= sparse.indices.back())
            failAtElement(document_.path, place, "sparse element {} follows {}; their indices must rise", index,
                          sparse.indices.back());
        sparse.indices.push_back(index);
    }
    return &sparse;
}

GltfAccessors::Elements GltfAccessors::elements(std::uint32_t index, const GltfUse& use) {
    static constexpr unsigned char kZeros[64] = {}; // an element of the largest type
    const GltfElement accessor = document_.entry("accessors", "accessor", index, use.place);
    // Its type and length, which must be those that are expected.
    const std::string type = accessor.need("type").text("type");
    if (type != typeName(use.type))
        failAtElement(document_.path, use.place, "accessor {} is of {}, {} expected", index, printable(type),
                      typeName(use.type));
    const std::uint64_t count = *accessor.need("count").integer("count");
    if (use.count && count != *use.count)
        failAtElement(document_.path, use.place, "accessor {} has {} elements, {} expected", index, count, *use.count);
    if (count == 0) failAtElement(document_.path, use.place, "accessor {} has no elements", index);
    Elements elements{.componentType = int(*accessor.need("componentType").integer("componentType")),
                      .width = std::uint64_t(tinygltf::GetNumComponentsInType(std::uint32_t(use.type))),
                      .count = count,
                      .isNormalized = accessor.boolean("normalized"),
                      .layout = {.first = kZeros, .stride = 0},
                      .decoded = use.decoded};
    if (componentBytes(elements.componentType) == 0)
        failAtElement(document_.path, use.place, "accessor {} has components of unknown type {}", index,
                      elements.componentType);
    // The bytes that hold its elements.
    if (use.decoded != nullptr) {
        const int decodedType = componentTypeOf(use.decoded->data_type());
        if (decodedType != elements.componentType || std::uint64_t(use.decoded->num_components()) != elements.width)
            failAtElement(document_.path, use.place,
                          "accessor {} has components of type {}, its compressed data have {} of type {}", index,
                          elements.componentType, use.decoded->num_components(), decodedType);
        return elements;
    }
    const std::uint64_t elementBytes = componentBytes(elements.componentType) * elements.width;
    if (accessor.has("bufferView"))
        elements.layout = layout(accessor, elementBytes, count, use.place);
    else if (!use.count && !accessor.has("sparse"))
        failAtElement(document_.path, use.place, "accessor {} has no buffer view to take its elements from", index);
    if (accessor.has("sparse")) elements.sparse = sparse(index, elementBytes, count, use.place);
    return elements;
}

std::vector<float> GltfAccessors::floats(std::uint32_t index, const GltfUse& use,
                                         std::optional<std::span<const std::uint32_t>> which) {
    // Which component types the use allows.
    const Elements elements = this->elements(index, use);
    const bool isInteger = isByteOrShort(elements.componentType);
    const bool isTaken = elements.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT ||
                         (isInteger && elements.isNormalized && use.takesNormalized) ||
                         (isInteger && isQuantized_ && use.takesQuantized);
    if (!isTaken)
        failAtElement(document_.path, use.place, "accessor {} has {} components of type {}, which it cannot have",
                      index, elements.isNormalized ? "normalized" : "plain", elements.componentType);

    // The numbers, normalised integers divided by their largest (section 3.11).
    const double largest = elements.isNormalized ? largestOf(elements.componentType) : 1;
    const std::uint64_t numberCount = (which ? which->size() : elements.count) * elements.width;
    takeRoom(numberCount, use.place);
    std::vector<float> values(numberCount);
    forEach(which, elements.count, [&](std::size_t i, std::size_t element) {
        for (std::size_t k = 0; k < elements.width; ++k) {
            const double number = elements.number(element, k);
            if (!std::isfinite(number))
                failAtElement(document_.path, use.place, "element {} is not finite ({}); give it numbers", element,
                              number);
            values[i * elements.width + k] = largest == 1 ? float(number) : float(std::max(number / largest, -1.0));
        }
    });
    return values;
}

std::vector<std::uint32_t> GltfAccessors::integers(std::uint32_t index, const GltfUse& use, int mostBytes,
                                                   std::optional<std::span<const std::uint32_t>> which) {
    const Elements elements = this->elements(index, use);
    const bool isTaken = isUnsigned(elements.componentType) &&
                         componentBytes(elements.componentType) <= std::uint64_t(mostBytes) && !elements.isNormalized;
    if (!isTaken)
        failAtElement(document_.path, use.place,
                      "accessor {} has components of type {}; unsigned integers of at most {} bytes are needed", index,
                      elements.componentType, mostBytes);
    const std::uint64_t numberCount = (which ? which->size() : elements.count) * elements.width;
    takeRoom(numberCount, use.place);
    std::vector<std::uint32_t> values(numberCount);
    forEach(which, elements.count, [&](std::size_t i, std::size_t element) {
        for (std::size_t k = 0; k < elements.width; ++k)
            values[i * elements.width + k] = std::uint32_t(elements.number(element, k));
    });
    return values;
}

} // namespace relief
