// SPDX-License-Identifier: Apache-2.0
// The data of PLY files (Turk 1994): every size is checked against the bytes that are there before anything is
// allocated. Of the vertices x y z, nx ny nz and u v (or s t, texture_u.., as pbrt) are read; of the faces their vertex
// indices.
#include "lexer.hpp"
#include "mesh.hpp"
#include "ply_header.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace restage::pbrt {

namespace {

template <class T>
double load(const char* from, bool swap) {
    T value;
    if (swap) {
        char bytes[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i)
            bytes[i] = from[sizeof(T) - 1 - i];
        std::memcpy(&value, bytes, sizeof(T));
    } else {
        std::memcpy(&value, from, sizeof(T));
    }
    return static_cast<double>(value);
}

double load(PlyType type, const char* from, bool swap) {
    switch (type) {
        case PlyType::i8:
            return load<std::int8_t>(from, swap);
        case PlyType::u8:
            return load<std::uint8_t>(from, swap);
        case PlyType::i16:
            return load<std::int16_t>(from, swap);
        case PlyType::u16:
            return load<std::uint16_t>(from, swap);
        case PlyType::i32:
            return load<std::int32_t>(from, swap);
        case PlyType::u32:
            return load<std::uint32_t>(from, swap);
        case PlyType::f32:
            return load<float>(from, swap);
        default:
            return load<double>(from, swap);
    }
}

class Reader {
  public:
    explicit Reader(std::string_view bytes) : bytes_(bytes), header_(read_ply_header(bytes)), position_(header_.size) {
        swap_ = header_.format == (std::endian::native == std::endian::little ? PlyFormat::big : PlyFormat::little);
    }

    Mesh read() {
        for (const PlyElement& element : header_.elements) {
            if (element.name == "vertex")
                vertices(element);
            else if (element.name == "face")
                faces(element);
            else
                skip(element);
        }
        if (mesh_.positions.empty()) fail("it has no vertices");
        for (std::size_t i = 0; i < mesh_.indices.size(); ++i)
            if (mesh_.indices[i] >= mesh_.vertex_count())
                fail("a face names vertex " + std::to_string(mesh_.indices[i]) + " of " +
                     std::to_string(mesh_.vertex_count()));
        if (mesh_.indices.empty()) fail("it has no faces");
        return std::move(mesh_);
    }

  private:
    [[noreturn]] static void fail(const std::string& what) { throw PlyProblem{what}; }

    std::size_t left() const { return bytes_.size() - position_; }

    // Rows that cannot be there are refused before memory is asked for.
    void check_count(const PlyElement& element) const {
        std::size_t row = 0;
        for (const PlyProperty& property : element.properties)
            row += header_.format == PlyFormat::ascii
                       ? 2
                       : (property.is_list ? size_of(property.count_type) : size_of(property.type));
        // The last number of an ascii file may lack the blank after it.
        if (row > 0 && element.count > (left() + 1) / row)
            fail(std::to_string(element.count) + " '" + element.name +
                 "' elements are promised, but the file ends before them (truncated?)");
        if (row == 0 && element.count > 0 && element.properties.empty()) return;
        if (element.count > 0xffffffffu) fail("more than 2^32 '" + element.name + "' elements");
    }

    double ascii_number() {
        while (position_ < bytes_.size() && static_cast<unsigned char>(bytes_[position_]) <= ' ')
            ++position_;
        const char* begin = bytes_.data() + position_;
        const char* end = bytes_.data() + bytes_.size();
        if (begin == end) fail("the file ends early (truncated?)");
        if (*begin == '+') ++begin;
        double value = 0;
        const auto [stop, code] = std::from_chars(begin, end, value);
        if (code == std::errc::result_out_of_range)
            value = 0; // 1e-400; 1e400 becomes a visible wrong point
        else if (code != std::errc())
            fail("'" + std::string(begin, std::min<std::size_t>(20, static_cast<std::size_t>(end - begin))) +
                 "' is no number");
        position_ = static_cast<std::size_t>(stop - bytes_.data());
        return value;
    }

    double number(PlyType type) {
        if (header_.format == PlyFormat::ascii) return ascii_number();
        if (left() < size_of(type)) fail("the file ends early (truncated?)");
        const double value = load(type, bytes_.data() + position_, swap_);
        position_ += size_of(type);
        return value;
    }

    std::size_t list_count(const PlyProperty& property) {
        const double count = number(property.count_type);
        if (!(count >= 0) || count != std::floor(count)) fail("a list has " + shortest(count) + " entries");
        const double least = header_.format == PlyFormat::ascii ? 1 : double(size_of(property.type));
        if (count * least > double(left()) + 1)
            fail("a list of " + shortest(count) + " entries does not fit into the file (truncated?)");
        return static_cast<std::size_t>(count);
    }

    void skip(const PlyElement& element) {
        check_count(element);
        if (header_.format != PlyFormat::ascii && !element.has_lists) {
            position_ += element.count * element.stride;
            return;
        }
        for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i)
            for (const PlyProperty& property : element.properties) {
                const std::size_t n = property.is_list ? list_count(property) : 1;
                for (std::size_t k = 0; k < n; ++k)
                    number(property.type);
            }
    }

    static int find(const PlyElement& element, std::string_view name) {
        for (std::size_t i = 0; i < element.properties.size(); ++i)
            if (element.properties[i].name == name && !element.properties[i].is_list) return static_cast<int>(i);
        return -1;
    }

    // Where each property of a row goes: which array, which component.
    struct Target {
        std::vector<float>* array = nullptr;
        std::size_t width = 0, component = 0;
    };

    std::vector<Target> targets(const PlyElement& element) {
        std::vector<Target> out(element.properties.size());
        const auto bind = [&](std::vector<float>& array, std::initializer_list<const char*> names) {
            std::vector<int> at;
            for (const char* name : names)
                at.push_back(find(element, name));
            for (const int i : at)
                if (i < 0) return false;
            array.resize(element.count * at.size());
            for (std::size_t k = 0; k < at.size(); ++k)
                out[static_cast<std::size_t>(at[k])] = {&array, at.size(), k};
            return true;
        };
        if (!bind(mesh_.positions, {"x", "y", "z"})) fail("its vertices have no x, y and z");
        bind(mesh_.normals, {"nx", "ny", "nz"});
        bind(mesh_.uvs, {"u", "v"}) || bind(mesh_.uvs, {"s", "t"}) || bind(mesh_.uvs, {"texture_u", "texture_v"}) ||
            bind(mesh_.uvs, {"texture_s", "texture_t"});
        return out;
    }

    void vertices(const PlyElement& element) {
        check_count(element);
        const auto target = targets(element);
        if (header_.format != PlyFormat::ascii && !element.has_lists) {
            for (std::size_t p = 0; p < target.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (!target[p].array) continue;
                const char* from = bytes_.data() + position_ + property.offset;
                float* to = target[p].array->data() + target[p].component;
                if (property.type == PlyType::f32 && !swap_)
                    for (std::size_t i = 0; i < element.count; ++i)
                        std::memcpy(to + i * target[p].width, from + i * element.stride, sizeof(float));
                else
                    for (std::size_t i = 0; i < element.count; ++i)
                        to[i * target[p].width] =
                            static_cast<float>(load(property.type, from + i * element.stride, swap_));
            }
            position_ += element.count * element.stride;
        } else {
            for (std::size_t i = 0; i < element.count; ++i)
                for (std::size_t p = 0; p < target.size(); ++p) {
                    const PlyProperty& property = element.properties[p];
                    const std::size_t n = property.is_list ? list_count(property) : 1;
                    for (std::size_t k = 0; k < n; ++k) {
                        const double value = number(property.type);
                        if (target[p].array)
                            (*target[p].array)[i * target[p].width + target[p].component] = static_cast<float>(value);
                    }
                }
        }
        for (std::size_t i = 0; i < mesh_.positions.size(); ++i)
            if (!std::isfinite(mesh_.positions[i]))
                fail("vertex " + std::to_string(i / 3) + " is not finite (NaN or infinite)");
        for (float& value : mesh_.uvs)
            if (!std::isfinite(value)) value = 0;
    }

    std::uint32_t index(double value) const {
        if (!(value >= 0 && value <= 4294967294.0) || value != std::floor(value))
            fail("a face names vertex " + shortest(value));
        return static_cast<std::uint32_t>(value);
    }

    void faces(const PlyElement& element) {
        check_count(element);
        std::size_t list = element.properties.size();
        for (std::size_t p = 0; p < element.properties.size(); ++p)
            if (element.properties[p].is_list &&
                (element.properties[p].name == "vertex_indices" || element.properties[p].name == "vertex_index"))
                list = p;
        if (list == element.properties.size()) fail("its faces have no list 'vertex_indices'");
        mesh_.indices.reserve(element.count * 3);
        const PlyProperty& indices = element.properties[list];
        const bool is_plain = element.properties.size() == 1 && header_.format != PlyFormat::ascii && !swap_ &&
                              indices.count_type == PlyType::u8 &&
                              (indices.type == PlyType::i32 || indices.type == PlyType::u32);
        std::vector<std::uint32_t> corner;
        for (std::size_t i = 0; i < element.count; ++i) {
            // Triangles of nothing but 32-bit indices: nearly every PLY there is.
            if (is_plain && left() >= 13 && bytes_[position_] == 3) {
                std::uint32_t three[3];
                std::memcpy(three, bytes_.data() + position_ + 1, sizeof three);
                mesh_.indices.insert(mesh_.indices.end(), three, three + 3);
                position_ += 13;
                continue;
            }
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                const std::size_t n = property.is_list ? list_count(property) : 1;
                if (p == list) corner.clear();
                for (std::size_t k = 0; k < n; ++k) {
                    const double value = number(property.type);
                    if (p == list) corner.push_back(index(value));
                }
            }
            polygon(corner);
        }
    }

    void polygon(const std::vector<std::uint32_t>& corner) { // as a fan; pbrt's quads are bilinear patches
        for (std::size_t k = 2; k < corner.size(); ++k)
            mesh_.indices.insert(mesh_.indices.end(), {corner[0], corner[k - 1], corner[k]});
        if (corner.size() < 4 || mesh_.has_bent_quads) return;
        for (const std::uint32_t c : corner)
            if (c >= mesh_.vertex_count()) return; // said at the end
        const auto point = [&](std::uint32_t c) {
            const float* p = mesh_.positions.data() + 3 * std::size_t(c);
            return Vec3{double(p[0]), double(p[1]), double(p[2])};
        };
        const Vec3 origin = point(corner[0]);
        const Vec3 e1 = point(corner[1]) - origin, e2 = point(corner[2]) - origin;
        const Vec3 n = normalize(cross(e1, e2));
        for (std::size_t k = 3; k < corner.size(); ++k)
            if (std::abs(dot(n, point(corner[k]) - origin)) > 1e-3 * (length(e1) + length(e2)))
                mesh_.has_bent_quads = true;
    }

    std::string_view bytes_;
    PlyHeader header_;
    std::size_t position_ = 0;
    bool swap_ = false;
    Mesh mesh_;
};

} // namespace

Mesh read_ply(const std::string& path, std::string_view bytes, Location at) {
    try {
        return Reader(bytes).read();
    } catch (const PlyProblem& problem) {
        throw ImportError{at, path + ": " + problem.what + "; export the mesh again or remove the shape"};
    }
}

} // namespace restage::pbrt
