// Finds the bytes of accessors and turns them into numbers.
#include "renderer/gltf_accessor.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>

namespace parafovea {
namespace {

using Bytes = std::span<const unsigned char>;

// More elements than any file that fits into memory could hold.
constexpr std::size_t kMostElements = 1u << 28;

[[noreturn]] void fail(const std::string& what, const std::string& why) {
    throw std::runtime_error(what + ": " + why);
}

const tinygltf::Accessor& accessor_at(const tinygltf::Model& model, int index, const std::string& what) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.accessors.size())
        fail(what, "there is no accessor " + std::to_string(index));
    return model.accessors[static_cast<std::size_t>(index)];
}

// The part of a buffer that a buffer view shows, from `offset` on.
Bytes view_bytes(const tinygltf::Model& model, int index, std::size_t offset, const std::string& what) {
    if (index < 0 || static_cast<std::size_t>(index) >= model.bufferViews.size())
        fail(what, "there is no buffer view " + std::to_string(index));
    const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(index)];
    if (view.buffer < 0 || static_cast<std::size_t>(view.buffer) >= model.buffers.size())
        fail(what, "there is no buffer " + std::to_string(view.buffer));
    const auto& data = model.buffers[static_cast<std::size_t>(view.buffer)].data;
    if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
        fail(what, "buffer view " + std::to_string(index) + " reaches outside its buffer of " +
                       std::to_string(data.size()) + " bytes");
    if (offset > view.byteLength) fail(what, "starts outside buffer view " + std::to_string(index));
    return Bytes(data).subspan(view.byteOffset + offset, view.byteLength - offset);
}

struct Layout {
    std::size_t component_bytes = 0;
    std::size_t components = 0;
    std::size_t element_bytes() const { return component_bytes * components; }
};

Layout layout_of(const tinygltf::Accessor& accessor, const std::string& what) {
    const int bytes = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType));
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    if (bytes <= 0 || components <= 0) fail(what, "its component type or shape is unknown");
    return {static_cast<std::size_t>(bytes), static_cast<std::size_t>(components)};
}

template <typename T>
T bytes_as(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

template <typename T>
double number(const unsigned char* bytes, bool normalized) {
    const auto value = static_cast<double>(bytes_as<T>(bytes));
    if (!normalized) return value;
    return std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
}

double component(const unsigned char* bytes, int type, bool normalized, const std::string& what) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return number<std::int8_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return number<std::uint8_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return number<std::int16_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return number<std::uint16_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return number<std::uint32_t>(bytes, normalized);
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return static_cast<double>(bytes_as<float>(bytes));
        default:
            fail(what, "component type " + std::to_string(type) + " is not one of glTF's");
    }
}

// Elements at `stride` apart, checked to lie inside `bytes`.
void check_extent(Bytes bytes, std::size_t count, std::size_t stride, std::size_t element_bytes,
                  const std::string& what) {
    if (count == 0) return;
    if (bytes.size() < element_bytes || (bytes.size() - element_bytes) / stride < count - 1)
        fail(what, "needs " + std::to_string(count) + " elements, its buffer view ends before");
}

std::size_t index_at(Bytes bytes, std::size_t i, int type, const std::string& what) {
    const auto size = static_cast<std::size_t>(
        std::max(1, tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(type))));
    return static_cast<std::size_t>(component(bytes.data() + i * size, type, false, what));
}

template <typename Number>
std::vector<Number> read(const tinygltf::Model& model, int index, int components, const std::string& what) {
    const tinygltf::Accessor& accessor = accessor_at(model, index, what);
    const Layout layout = layout_of(accessor, what);
    if (layout.components != static_cast<std::size_t>(components))
        fail(what, "has " + std::to_string(layout.components) + " components, " + std::to_string(components) +
                       " expected");
    if (accessor.count > kMostElements) fail(what, "claims " + std::to_string(accessor.count) + " elements");

    // Read the dense elements; without a buffer view they are zero.
    std::vector<Number> values;
    const std::size_t width = layout.components;
    if (accessor.bufferView >= 0) {
        const Bytes bytes = view_bytes(model, accessor.bufferView, accessor.byteOffset, what);
        const tinygltf::BufferView& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
        const std::size_t stride = view.byteStride == 0 ? layout.element_bytes() : view.byteStride;
        if (stride < layout.component_bytes) fail(what, "its stride is smaller than one component");
        check_extent(bytes, accessor.count, stride, layout.element_bytes(), what);
        values.resize(accessor.count * width);
        const bool plain_floats = std::is_same_v<Number, float> &&
                                  accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT &&
                                  stride == layout.element_bytes();
        if (plain_floats) {
            if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));
        } else {
            for (std::size_t i = 0; i < accessor.count; ++i)
                for (std::size_t c = 0; c < width; ++c)
                    values[i * width + c] =
                        static_cast<Number>(component(bytes.data() + i * stride + c * layout.component_bytes,
                                                      accessor.componentType, accessor.normalized, what));
        }
    } else {
        values.resize(accessor.count * width);
    }
    if (!accessor.sparse.isSparse) return values;

    // Put the sparse elements in their places.
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        fail(what, "its sparse part has a negative count or offset");
    const auto sparse_count = static_cast<std::size_t>(sparse.count);
    const int index_bytes =
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(sparse.indices.componentType));
    if (index_bytes <= 0) fail(what, "its sparse indices have an unknown type");
    const Bytes where = view_bytes(model, sparse.indices.bufferView,
                                   static_cast<std::size_t>(sparse.indices.byteOffset), what);
    const Bytes data =
        view_bytes(model, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset), what);
    check_extent(where, sparse_count, static_cast<std::size_t>(index_bytes),
                 static_cast<std::size_t>(index_bytes), what);
    check_extent(data, sparse_count, layout.element_bytes(), layout.element_bytes(), what);
    for (std::size_t i = 0; i < sparse_count; ++i) {
        const std::size_t target = index_at(where, i, sparse.indices.componentType, what);
        if (target >= accessor.count) fail(what, "a sparse index points outside");
        for (std::size_t c = 0; c < width; ++c)
            values[target * width + c] = static_cast<Number>(
                component(data.data() + i * layout.element_bytes() + c * layout.component_bytes,
                          accessor.componentType, accessor.normalized, what));
    }
    return values;
}

}  // namespace

std::vector<float> read_floats(const tinygltf::Model& model, int accessor, int components,
                               const std::string& what) {
    return read<float>(model, accessor, components, what);
}

std::vector<std::uint32_t> read_integers(const tinygltf::Model& model, int accessor, int components,
                                         const std::string& what) {
    if (accessor_at(model, accessor, what).componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
        fail(what, "holds fractions, whole numbers expected");
    return read<std::uint32_t>(model, accessor, components, what);
}

int components_of(const tinygltf::Model& model, int accessor, const std::string& what) {
    return static_cast<int>(layout_of(accessor_at(model, accessor, what), what).components);
}

}  // namespace parafovea
