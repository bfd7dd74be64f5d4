// SPDX-License-Identifier: Apache-2.0
// Typed reading of accessors (glTF 2.0, 3.6.2): strides, integer normalisation, sparse substitution.
#include "model.hpp"

#include <cmath>
#include <cstring>

namespace restage::gltf {

namespace {

constexpr std::size_t most_elements = std::size_t{1} << 28; // of an accessor without data: zeros must be allocated

std::string number(std::size_t n) { return std::to_string(n); }

std::size_t component_size(int type, const std::string& who) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            throw ImportError{who + " has the unknown component type " + std::to_string(type), 0, 0, {}};
    }
}

template <class T>
T load(const unsigned char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof value);
    return value;
}

// glTF 2.0, 3.6.2.2 for normalised integers.
double component(const unsigned char* at, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normalized ? std::max(load<std::int8_t>(at) / 127.0, -1.0) : load<std::int8_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return normalized ? *at / 255.0 : *at;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normalized ? std::max(load<std::int16_t>(at) / 32767.0, -1.0) : load<std::int16_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return normalized ? load<std::uint16_t>(at) / 65535.0 : load<std::uint16_t>(at);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<std::uint32_t>(at);
        default:
            return static_cast<double>(load<float>(at));
    }
}

// f(element, component, pointer to it) for all of an accessor's data, then of its sparse part.
template <class F>
void each_component(const tinygltf::Model& model, const tinygltf::Accessor& accessor, int components,
                    const std::string& who, F&& f) {
    const std::size_t size = component_size(accessor.componentType, who);
    // Columns of matrices of small integers are aligned to 4 bytes (3.6.2.4); only float matrices are read here.
    const std::size_t element = size * static_cast<std::size_t>(components);
    const auto walk = [&](int view, std::size_t offset, std::size_t count, std::size_t stride, auto&& index) {
        const auto bytes = view_bytes(model, view, who);
        if (count == 0) return;
        if (stride < element || offset > bytes.size() || bytes.size() - offset < element ||
            (bytes.size() - offset - element) / stride < count - 1)
            throw ImportError{who + " reads " + number(count) + " elements of " + number(element) +
                                  " bytes from byte " + number(offset) + " of buffer view " + std::to_string(view) +
                                  ", which has " + number(bytes.size()) + " bytes",
                              0,
                              0,
                              {}};
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c)
                f(index(i), c, bytes.data() + offset + i * stride + c * size);
    };
    if (accessor.bufferView >= 0) {
        const auto& view = at(model.bufferViews, accessor.bufferView, "buffer view", who);
        walk(accessor.bufferView, accessor.byteOffset, accessor.count, view.byteStride ? view.byteStride : element,
             [](std::size_t i) { return i; });
    }
    if (!accessor.sparse.isSparse || accessor.sparse.count <= 0) return;
    const auto count = static_cast<std::size_t>(accessor.sparse.count);
    const auto indices = view_bytes(model, accessor.sparse.indices.bufferView, who + " (sparse indices)");
    const std::size_t index_size = component_size(accessor.sparse.indices.componentType, who);
    const auto from = static_cast<std::size_t>(std::max(accessor.sparse.indices.byteOffset, 0));
    if (count > accessor.count || from > indices.size() || (indices.size() - from) / index_size < count)
        throw ImportError{who + ": " + number(count) + " sparse indices do not fit", 0, 0, {}};
    walk(accessor.sparse.values.bufferView, static_cast<std::size_t>(std::max(accessor.sparse.values.byteOffset, 0)),
         count, element, [&](std::size_t i) {
             const double index =
                 component(indices.data() + from + i * index_size, accessor.sparse.indices.componentType, false);
             if (!(index >= 0 && index < static_cast<double>(accessor.count)))
                 throw ImportError{
                     who + ": a sparse index is beyond the " + number(accessor.count) + " elements", 0, 0, {}};
             return static_cast<std::size_t>(index);
         });
}

const tinygltf::Accessor& checked(const tinygltf::Model& model, int index, int components, std::string& who) {
    const auto& accessor = at(model.accessors, index, "accessor", who);
    who += ": accessor " + std::to_string(index);
    static const int types[] = {0, TINYGLTF_TYPE_SCALAR, TINYGLTF_TYPE_VEC2, TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4};
    const int wanted = components == 16 ? TINYGLTF_TYPE_MAT4 : types[components];
    if (accessor.type != wanted) throw ImportError{who + " has the wrong type for this use", 0, 0, {}};
    if (accessor.bufferView < 0 && accessor.count > most_elements)
        throw ImportError{who + " declares " + number(accessor.count) + " elements and has no data", 0, 0, {}};
    if (accessor.bufferView >= 0 &&
        accessor.count > view_bytes(model, accessor.bufferView, who).size()) // an element has a byte at least
        throw ImportError{
            who + " declares " + number(accessor.count) + " elements; its buffer view is smaller", 0, 0, {}};
    return accessor;
}

} // namespace

std::span<const unsigned char> view_bytes(const tinygltf::Model& model, int index, const std::string& who) {
    const auto& view = at(model.bufferViews, index, "buffer view", who);
    const auto& buffer = at(model.buffers, view.buffer, "buffer", who + ": buffer view " + std::to_string(index));
    if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset)
        throw ImportError{"buffer view " + std::to_string(index) + " reaches to byte " +
                              number(view.byteOffset + view.byteLength) + " of buffer " + std::to_string(view.buffer) +
                              ", which has " + number(buffer.data.size()),
                          0,
                          0,
                          {}};
    return {buffer.data.data() + view.byteOffset, view.byteLength};
}

std::vector<float> read_floats(const tinygltf::Model& model, int index, int components, const std::string& user) {
    std::string who = user;
    const auto& accessor = checked(model, index, components, who);
    std::vector<float> values(accessor.count * static_cast<std::size_t>(components));
    each_component(model, accessor, components, who, [&](std::size_t i, std::size_t c, const unsigned char* bytes) {
        const double value = component(bytes, accessor.componentType, accessor.normalized);
        if (!std::isfinite(value)) throw ImportError{who + ": element " + number(i) + " is not finite", 0, 0, {}};
        values[i * static_cast<std::size_t>(components) + c] = static_cast<float>(value);
    });
    return values;
}

std::vector<float> read_colors(const tinygltf::Model& model, int index, const std::string& who) {
    if (at(model.accessors, index, "accessor", who).type == TINYGLTF_TYPE_VEC4)
        return read_floats(model, index, 4, who);
    const std::vector<float> rgb = read_floats(model, index, 3, who);
    std::vector<float> rgba;
    for (std::size_t i = 0; i < rgb.size(); i += 3)
        rgba.insert(rgba.end(), {rgb[i], rgb[i + 1], rgb[i + 2], 1.f});
    return rgba;
}

std::vector<std::uint32_t> read_integers(const tinygltf::Model& model, int index, int components,
                                         const std::string& user) {
    std::string who = user;
    const auto& accessor = checked(model, index, components, who);
    const int type = accessor.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        throw ImportError{who + " must hold unsigned integers", 0, 0, {}};
    std::vector<std::uint32_t> values(accessor.count * static_cast<std::size_t>(components));
    each_component(model, accessor, components, who, [&](std::size_t i, std::size_t c, const unsigned char* bytes) {
        values[i * static_cast<std::size_t>(components) + c] =
            static_cast<std::uint32_t>(component(bytes, type, false));
    });
    return values;
}

} // namespace restage::gltf
