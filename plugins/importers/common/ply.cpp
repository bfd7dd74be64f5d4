// SPDX-License-Identifier: Apache-2.0
// The elements of a PLY file: the meaning of properties, and the destination of their numbers.
#include "common/ply.hpp"

#include "common/large_coordinates.hpp"
#include "common/ply_rows.hpp"
#include "common/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace restage::importing {

namespace {

int find(const PlyElement& element, std::string_view name, bool list = false) {
    for (std::size_t i = 0; i < element.properties.size(); ++i)
        if (element.properties[i].name == name && element.properties[i].is_list == list) return static_cast<int>(i);
    return -1;
}

// Divisor of integer colours.
double white(PlyType type) {
    switch (type) {
        case PlyType::u8:
        case PlyType::i8:
            return 255;
        case PlyType::u16:
        case PlyType::i16:
            return 65535;
        default:
            return 1;
    }
}

constexpr std::initializer_list<const char*> color_names[] = {
    {"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}, {"r", "g", "b"}};

class Reader {
  public:
    Reader(std::string_view bytes, const PlyWanted& wanted)
        : wanted_(wanted), header_(read_ply_header(bytes)), rows_(bytes, header_) {}

    PlyMesh read() {
        for (const PlyElement& element : header_.elements) {
            rows_.check_count(element);
            if (element.name == "vertex")
                vertices(element);
            else if (element.name == "face")
                faces(element);
            else if (element.name == "tristrips")
                strips(element);
            else if (element.name == "edge" && wanted_.colors && find(element, "vertex1") >= 0 &&
                     find(element, "vertex2") >= 0)
                edges(element);
            else
                skip(element);
        }
        if (mesh_.positions.empty()) throw PlyProblem{"it has no vertices"};
        for (const auto* list : {&mesh_.indices, &mesh_.edges}) // if they came before the vertices
            for (const std::uint32_t i : *list)
                if (i >= mesh_.vertex_count()) throw PlyProblem{no_vertex(i)};
        mesh_.textures = std::move(header_.textures);
        return std::move(mesh_);
    }

  private:
    std::string no_vertex(std::uint32_t i) const {
        return "a face names vertex " + std::to_string(i) + " of " + std::to_string(mesh_.vertex_count());
    }
    void unread(const PlyElement& element, const PlyProperty& property) {
        if (wanted_.colors) mesh_.not_read[element.name + " property \"" + property.name + "\""] += element.count;
    }

    void skip(const PlyElement& element) {
        if (wanted_.colors && element.count > 0) mesh_.not_read["element \"" + element.name + "\""] += element.count;
        if (rows_.skip_plain(element)) return;
        for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i)
            for (const PlyProperty& property : element.properties)
                rows_.skip(property);
    }

    // The destination of each property of a row: array and component.
    struct Target {
        std::vector<float>* array = nullptr;
        std::vector<double>* wide = nullptr; // instead
        std::size_t width = 0, component = 0;
        double scale = 1;
        explicit operator bool() const { return array || wide; }
        void set(std::size_t row, double value) const {
            if (array)
                (*array)[row * width + component] = static_cast<float>(value * scale);
            else if (wide)
                (*wide)[row * width + component] = value;
        }
    };

    std::vector<Target> targets(const PlyElement& element, std::vector<double>& wide) {
        std::vector<Target> out(element.properties.size());
        const auto bind = [&](std::vector<float>& array, std::initializer_list<const char*> names, bool color = false) {
            std::vector<int> at;
            for (const char* name : names)
                at.push_back(find(element, name));
            if (std::any_of(at.begin(), at.end(), [](int i) { return i < 0; })) return false;
            const auto& first = element.properties[static_cast<std::size_t>(at[0])];
            const bool precise = &array == &mesh_.positions && wanted_.recentre &&
                                 (header_.format == PlyFormat::ascii || first.type == PlyType::f64);
            if (precise)
                wide.resize(element.count * at.size());
            else
                array.resize(element.count * at.size());
            for (std::size_t k = 0; k < at.size(); ++k) {
                const auto i = static_cast<std::size_t>(at[k]);
                out[i] = {precise ? nullptr : &array, precise ? &wide : nullptr, at.size(), k,
                          color ? 1 / white(element.properties[i].type) : 1};
            }
            return true;
        };
        if (!bind(mesh_.positions, {"x", "y", "z"})) rows_.fail("its vertices have no x, y and z");
        bind(mesh_.normals, {"nx", "ny", "nz"});
        bind(mesh_.uvs, {"u", "v"}) || bind(mesh_.uvs, {"s", "t"}) || bind(mesh_.uvs, {"texture_u", "texture_v"}) ||
            bind(mesh_.uvs, {"texture_s", "texture_t"});
        if (wanted_.colors)
            for (const auto& names : color_names)
                if (bind(mesh_.colors, names, true)) break;
        if (!mesh_.colors.empty()) bind(opacity_, {"alpha"}, true);
        for (std::size_t p = 0; p < out.size(); ++p)
            if (!out[p]) unread(element, element.properties[p]);
        return out;
    }

    void vertices(const PlyElement& element) {
        std::vector<double> wide;
        const auto target = targets(element, wide);
        const std::size_t begin = rows_.position();
        if (const char* data = rows_.plain(element)) {
            for (std::size_t p = 0; p < target.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (!target[p]) continue;
                const char* from = data + property.offset;
                if (target[p].array && property.type == PlyType::f32 && !rows_.swaps() && target[p].scale == 1) {
                    float* to = target[p].array->data() + target[p].component;
                    for (std::size_t i = 0; i < element.count; ++i)
                        std::memcpy(to + i * target[p].width, from + i * element.stride, sizeof(float));
                } else {
                    for (std::size_t i = 0; i < element.count; ++i)
                        target[p].set(i, rows_.load(property.type, from + i * element.stride));
                }
            }
        } else {
            for (std::size_t i = 0; i < element.count; ++i)
                for (std::size_t p = 0; p < target.size(); ++p) {
                    const PlyProperty& property = element.properties[p];
                    if (property.is_list) {
                        rows_.skip(property);
                        continue;
                    }
                    const double value = rows_.number(property.type);
                    if (target[p].component < 3 && (target[p].array == &mesh_.positions || target[p].wide) &&
                        !(std::abs(value) <= double(std::numeric_limits<float>::max())))
                        not_finite(i);
                    target[p].set(i, value);
                }
        }
        const auto row_of = [&](std::size_t i) { return rows_.is_plain(element) ? begin + i / 3 * element.stride : 0; };
        for (std::size_t i = 0; i < wide.size(); ++i)
            if (!(std::abs(wide[i]) <= double(std::numeric_limits<float>::max()))) not_finite(i / 3, row_of(i));
        for (std::size_t i = 0; i < mesh_.positions.size(); ++i)
            if (!std::isfinite(mesh_.positions[i])) not_finite(i / 3, row_of(i));
        if (!wide.empty()) mesh_.positions = recentred(wide, mesh_.origin);
        for (float& value : mesh_.uvs)
            if (!std::isfinite(value)) value = 0;
        for (float& value : mesh_.colors)
            value = value > 0 ? std::min(value, 1.f) : 0; // NaN too
        for (const float value : opacity_)
            see_through("vertex", value);
    }

    // Colours are written with an opacity that is nearly always meaningless.
    void see_through(const std::string& what, double opacity) {
        if (opacity < 0.999) ++mesh_.not_read[what + " property \"alpha\""];
    }

    [[noreturn]] void not_finite(std::size_t vertex, std::size_t byte = 0) const {
        const std::string what = "vertex " + std::to_string(vertex) + " is not finite (NaN or infinite)";
        if (byte > 0) throw PlyProblem{what, 0, byte};
        rows_.fail(what);
    }

    std::uint32_t index(double value) const {
        if (!(value >= 0 && value <= 4294967294.0) || value != std::floor(value))
            rows_.fail("a face names vertex " + PlyRows::shortest(value));
        const auto i = static_cast<std::uint32_t>(value);
        if (!mesh_.positions.empty() && i >= mesh_.vertex_count()) rows_.fail(no_vertex(i));
        return i;
    }

    int index_list(const PlyElement& element) const {
        const int list = find(element, "vertex_indices", true);
        return list >= 0 ? list : find(element, "vertex_index", true);
    }

    struct Face {
        std::vector<std::uint32_t> corners;
        std::vector<double> uvs;
        double texture = 0;
        float color[3] = {};
    };

    void faces(const PlyElement& element) {
        const int list = index_list(element);
        if (list < 0) rows_.fail("its faces have no list 'vertex_indices'");
        const int uvs = wanted_.colors ? find(element, "texcoord", true) : -1;
        const int texture = wanted_.colors ? find(element, "texnumber") : -1;
        int color[3] = {-1, -1, -1};
        for (const auto& names : color_names) {
            if (!wanted_.colors || color[0] >= 0) break;
            int at[3] = {find(element, names.begin()[0]), find(element, names.begin()[1]),
                         find(element, names.begin()[2])};
            if (at[0] >= 0 && at[1] >= 0 && at[2] >= 0) std::copy_n(at, 3, color);
        }
        const int alpha = color[0] >= 0 ? find(element, "alpha") : -1;
        has_uvs_ = uvs >= 0, has_texture_ = texture >= 0, has_color_ = color[0] >= 0;
        mesh_.indices.reserve(element.count * 3);
        const PlyProperty& indices = element.properties[static_cast<std::size_t>(list)];
        const bool plain = element.properties.size() == 1 && header_.format != PlyFormat::ascii && !rows_.swaps() &&
                           indices.count_type == PlyType::u8 &&
                           (indices.type == PlyType::i32 || indices.type == PlyType::u32);
        for (std::size_t p = 0; p < element.properties.size(); ++p) {
            const int i = static_cast<int>(p);
            if (i != list && i != uvs && i != texture && i != alpha && std::find(color, color + 3, i) == color + 3)
                unread(element, element.properties[p]);
        }
        Face face;
        for (std::size_t i = 0; i < element.count; ++i) {
            // Triangles of 32-bit indices only: nearly every PLY in practice.
            std::uint32_t three[3];
            if (plain && rows_.take_plain_triangle(three)) {
                for (const std::uint32_t c : three)
                    if (!mesh_.positions.empty() && c >= mesh_.vertex_count()) rows_.fail(no_vertex(c));
                mesh_.indices.insert(mesh_.indices.end(), three, three + 3);
                continue;
            }
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                const int at = static_cast<int>(p);
                const int* channel = std::find(color, color + 3, at);
                if (at == list) {
                    face.corners.resize(rows_.list_count(property));
                    for (std::uint32_t& c : face.corners)
                        c = index(rows_.number(property.type));
                } else if (at == uvs) {
                    face.uvs.resize(rows_.list_count(property));
                    for (double& c : face.uvs)
                        c = rows_.number(property.type);
                } else if (at == texture) {
                    face.texture = rows_.number(property.type);
                } else if (channel != color + 3) {
                    const double value = rows_.number(property.type) / white(property.type);
                    face.color[channel - color] = static_cast<float>(value > 0 ? std::min(value, 1.0) : 0);
                } else if (at == alpha) {
                    see_through("face", rows_.number(property.type) / white(property.type));
                } else {
                    rows_.skip(property);
                }
            }
            polygon(face);
        }
    }

    void polygon(const Face& face) {
        const auto& corners = face.corners;
        cut_.clear();
        if (corners.size() > 3 && !mesh_.positions.empty()) {
            points_.clear();
            for (const std::uint32_t c : corners) {
                const float* p = mesh_.positions.data() + 3 * std::size_t{c};
                points_.push_back({double(p[0]), double(p[1]), double(p[2])});
            }
            if (cut_polygon(points_, cut_) > 1e-3) mesh_.has_bent_polygons = true;
        } else {
            for (std::uint32_t k = 2; k < corners.size(); ++k)
                cut_.insert(cut_.end(), {0u, k - 1, k});
        }
        for (const std::uint32_t c : cut_)
            mesh_.indices.push_back(corners[c]);
        if (has_uvs_)
            for (const std::uint32_t c : cut_)
                for (std::size_t k = 0; k < 2; ++k) {
                    const double value = 2 * c + k < face.uvs.size() ? face.uvs[2 * c + k] : 0;
                    mesh_.corner_uvs.push_back(std::isfinite(value) ? static_cast<float>(value) : 0);
                }
        for (std::size_t t = 0; t < cut_.size() / 3; ++t) {
            if (has_color_) mesh_.triangle_colors.insert(mesh_.triangle_colors.end(), face.color, face.color + 3);
            if (has_texture_)
                mesh_.triangle_textures.push_back(
                    face.texture >= 0 && face.texture < 1e6 ? static_cast<std::uint32_t>(face.texture) : 0);
        }
    }

    // Each next corner makes a triangle with the two before it, flipped every second time; -1 restarts (Stanford).
    void strips(const PlyElement& element) {
        const int list = index_list(element);
        if (list < 0) rows_.fail("its triangle strips have no list 'vertex_indices'");
        for (std::size_t i = 0; i < element.count; ++i)
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                const PlyProperty& property = element.properties[p];
                if (static_cast<int>(p) != list) {
                    rows_.skip(property);
                    continue;
                }
                const std::size_t n = rows_.list_count(property);
                std::uint32_t a = 0, b = 0;
                std::size_t length = 0;
                for (std::size_t k = 0; k < n; ++k) {
                    const double value = rows_.number(property.type);
                    if (value == -1) {
                        length = 0;
                        continue;
                    }
                    const std::uint32_t c = index(value);
                    ++length;
                    if (length >= 3 && a != b && b != c && a != c) // repeated corners turn around an end
                        mesh_.indices.insert(mesh_.indices.end(), {length % 2 ? a : b, length % 2 ? b : a, c});
                    a = b, b = c;
                }
            }
    }

    void edges(const PlyElement& element) {
        const int from = find(element, "vertex1"), to = find(element, "vertex2");
        for (std::size_t i = 0; i < element.count; ++i) {
            std::uint32_t ends[2] = {};
            for (std::size_t p = 0; p < element.properties.size(); ++p) {
                const int at = static_cast<int>(p);
                if (at == from || at == to)
                    ends[at == to] = index(rows_.number(element.properties[p].type));
                else
                    rows_.skip(element.properties[p]);
            }
            mesh_.edges.insert(mesh_.edges.end(), ends, ends + 2);
        }
    }

    PlyWanted wanted_;
    PlyHeader header_;
    PlyRows rows_;
    PlyMesh mesh_;
    std::vector<float> opacity_; // of vertices
    bool has_uvs_ = false, has_texture_ = false, has_color_ = false;
    std::vector<std::uint32_t> cut_;
    std::vector<Vec3> points_;
};

} // namespace

PlyMesh read_ply(std::string_view bytes, const PlyWanted& wanted) {
    if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3); // a byte order mark, written by Windows editors
    return Reader(bytes, wanted).read();
}

} // namespace restage::importing
