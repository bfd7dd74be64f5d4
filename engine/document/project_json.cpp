// SPDX-License-Identifier: Apache-2.0
#include "document/project_json.hpp"

#include "base/base64.hpp"
#include "scene/bounds.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace restage::document {

static_assert(std::endian::native == std::endian::little, "blocks of bytes are little-endian");

json number_json(double x) {
    if (std::isfinite(x)) return x;
    return std::isnan(x) ? "nan" : x > 0 ? "inf" : "-inf";
}

json number_json(float x) {
    if (!std::isfinite(x)) return number_json(double(x));
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, x).ptr;
    double d = 0; // 0.1f as 0.1, not as 0.10000000149011612
    std::from_chars(text, end, d);
    return float(d) == x ? d : double(x);
}

bool read_number(const json& j, double& x) {
    if (j.is_number())
        x = j.get<double>();
    else if (j == "nan")
        x = std::numeric_limits<double>::quiet_NaN();
    else if (j == "inf")
        x = std::numeric_limits<double>::infinity();
    else if (j == "-inf")
        x = -std::numeric_limits<double>::infinity();
    else
        return false;
    return true;
}

bool read_number(const json& j, float& x) {
    double d = 0;
    if (!read_number(j, d)) return false;
    x = float(d);
    return true;
}

// --- arrays of numbers, as base64

namespace {

template <class T>
std::string encode(const std::vector<T>& values) {
    return encode_base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)});
}

template <class T>
bool decode(const json& j, std::vector<T>& values) {
    if (!j.is_string()) return false;
    const auto decoded = decode_base64(j.get_ref<const std::string&>());
    if (!decoded) return false;
    const std::string& bytes = *decoded;
    if (bytes.size() % sizeof(T)) return false;
    values.resize(bytes.size() / sizeof(T));
    if (!bytes.empty()) std::memcpy(static_cast<void*>(values.data()), bytes.data(), bytes.size());
    return true;
}

bool plain_number(const json& j) {
    return j.is_number() || (j.is_string() && j.get_ref<const std::string&>().size() <= 4);
}

void append(std::string& out, const json& j, int indent) {
    const auto new_line = [&](int by) {
        out += '\n';
        out.append(std::size_t(indent + by) * 2, ' ');
    };
    const bool line = j.is_array() && std::all_of(j.begin(), j.end(), [](const json& x) {
                          return plain_number(x) || (x.is_array() && std::all_of(x.begin(), x.end(), plain_number));
                      });
    if (!j.is_structured() || j.empty()) {
        out += j.dump(-1, ' ', false, json::error_handler_t::replace);
        return;
    }
    out += j.is_array() ? '[' : '{';
    bool first = true;
    for (auto it = j.begin(); it != j.end(); ++it) {
        if (!std::exchange(first, false)) out += line ? ", " : ",";
        if (!line) new_line(1);
        if (j.is_object()) out += json(it.key()).dump(-1, ' ', false, json::error_handler_t::replace) + ": ";
        append(out, *it, indent + 1);
    }
    if (!line) new_line(0);
    out += j.is_array() ? ']' : '}';
}

} // namespace

std::string pretty(const json& j) {
    std::string out;
    append(out, j, 0);
    out += '\n';
    return out;
}

void erase_marks(json& j) {
    if (j.is_object()) j.erase(place_mark);
    if (j.is_structured())
        for (auto& item : j)
            erase_marks(item);
}

// --- geometry and pixels
// -----------------------------------------------------------------------------------------------

json inline_mesh(const scene::MeshData& mesh) {
    json j;
    j["vertices"] = mesh.positions.size();
    j["positions"] = encode(mesh.positions);
    if (!mesh.normals.empty()) j["normals"] = encode(mesh.normals);
    if (!mesh.uvs.empty()) j["uvs"] = encode(mesh.uvs);
    if (!mesh.uvs2.empty()) j["uvs2"] = encode(mesh.uvs2);
    if (!mesh.tangents.empty()) j["tangents"] = encode(mesh.tangents);
    j["triangles"] = encode(mesh.triangles);
    return j;
}

Result<std::shared_ptr<const scene::MeshData>> read_inline_mesh(const json& j) {
    auto mesh = std::make_shared<scene::MeshData>();
    const bool good =
        j.contains("positions") && decode(j["positions"], mesh->positions) && j.contains("triangles") &&
        decode(j["triangles"], mesh->triangles) && (!j.contains("normals") || decode(j["normals"], mesh->normals)) &&
        (!j.contains("uvs") || decode(j["uvs"], mesh->uvs)) && (!j.contains("uvs2") || decode(j["uvs2"], mesh->uvs2)) &&
        (!j.contains("tangents") || decode(j["tangents"], mesh->tangents));
    if (!good) return fail("its geometry is damaged");
    scene::compute_bounds(*mesh);
    return mesh;
}

json inline_image(const scene::PixelData& pixels) {
    json j;
    j["width"] = pixels.width;
    j["height"] = pixels.height;
    j["channels"] = pixels.channels;
    j["values"] = encode(pixels.values);
    return j;
}

Result<std::shared_ptr<const scene::PixelData>> read_inline_image(const json& j) {
    auto pixels = std::make_shared<scene::PixelData>();
    const auto number = [&](const char* name) {
        return j.contains(name) && j[name].is_number_unsigned() ? j[name].get<std::uint32_t>() : 0u;
    };
    pixels->width = number("width");
    pixels->height = number("height");
    pixels->channels = number("channels");
    if (!j.contains("values") || !decode(j["values"], pixels->values) ||
        pixels->values.size() != std::size_t(pixels->width) * pixels->height * pixels->channels)
        return fail("its pixels are damaged");
    return pixels;
}

void take_value_lines(scene::Origin& origin) {
    if (origin.verbatim.find('=') == std::string::npos) return;
    std::string kept;
    for (std::string_view rest = origin.verbatim; !rest.empty();) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        if (const std::size_t space = line.find(' '); line.starts_with('=') && space != std::string_view::npos)
            origin.values.push_back({std::string(line.substr(1, space - 1)), std::string(line.substr(space + 1))});
        else
            kept.append(rest.substr(0, std::min(end + 1, rest.size())));
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    origin.verbatim = std::move(kept);
}

} // namespace restage::document
