// SPDX-License-Identifier: Apache-2.0
#include "plugin/glsl_words.hpp"

#include <algorithm>
#include <initializer_list>

namespace restage::plugin {

namespace {

constexpr std::string_view words[] = {
    // keywords
    "const", "uniform", "buffer", "shared", "attribute", "varying", "coherent", "volatile", "restrict", "readonly",
    "writeonly", "atomic_uint", "layout", "centroid", "flat", "smooth", "noperspective", "patch", "sample", "invariant",
    "precise", "break", "continue", "do", "for", "while", "switch", "case", "default", "if", "else", "subroutine", "in",
    "out", "inout", "int", "void", "bool", "true", "false", "float", "double", "discard", "return", "uint", "lowp",
    "mediump", "highp", "precision", "struct", "samplerExternalOES",
    // reserved for the future
    "common", "partition", "active", "asm", "class", "union", "enum", "typedef", "template", "this", "resource", "goto",
    "inline", "noinline", "public", "static", "extern", "external", "interface", "long", "short", "half", "fixed",
    "unsigned", "superp", "input", "output", "filter", "sizeof", "cast", "namespace", "using", "sampler3DRect",
    // extensions
    "rayPayloadEXT", "rayPayloadInEXT", "hitAttributeEXT", "callableDataEXT", "callableDataInEXT", "shaderRecordEXT",
    "accelerationStructureEXT", "rayQueryEXT", "ignoreIntersectionEXT", "terminateRayEXT", "rayPayloadNV",
    "rayPayloadInNV", "hitAttributeNV", "callableDataNV", "callableDataInNV", "shaderRecordNV",
    "accelerationStructureNV", "nonuniformEXT", "devicecoherent", "queuefamilycoherent", "workgroupcoherent",
    "subgroupcoherent", "shadercallcoherent", "pervertexEXT", "pervertexNV", "nonprivate", "demote",
    "terminateInvocation",
    // macros of the headers around a material and of the compiler, and the built-in method length
    "address", "length", "Material", "MATERIAL_SITE", "Spectrum", "VULKAN"};

bool any_of(std::string_view name, std::initializer_list<std::string_view> list) {
    return std::find(list.begin(), list.end(), name) != list.end();
}

bool take(std::string_view& name, std::initializer_list<std::string_view> prefixes) { // the first match
    for (const std::string_view p : prefixes)
        if (name.starts_with(p)) {
            name.remove_prefix(p.size());
            return true;
        }
    return false;
}

bool is_size(char c) { return c >= '2' && c <= '4'; }
bool is_bits(std::string_view s) { return any_of(s, {"8", "16", "32", "64"}); }

bool is_vector_or_matrix(std::string_view name) {
    const auto vec = name.find("vec"), mat = name.find("mat");
    if (vec != name.npos && name.size() == vec + 4 && is_size(name.back())) { // ivec3, f16vec2
        std::string_view kind = name.substr(0, vec);
        if (any_of(kind, {"", "b", "d", "i", "u", "h", "f"})) return true;
        return take(kind, {"i", "u", "f"}) && is_bits(kind);
    }
    if (mat == name.npos || !any_of(name.substr(0, mat), {"", "d", "f16", "f32", "f64"})) return false;
    const std::string_view size = name.substr(mat + 3); // mat3, dmat2x4
    return (size.size() == 1 || (size.size() == 3 && size[1] == 'x')) && is_size(size.front()) && is_size(size.back());
}

bool is_scalar(std::string_view name) { // int64_t
    if (!name.ends_with("_t") || !take(name, {"int", "uint", "float"})) return false;
    return is_bits(name.substr(0, name.size() - 2));
}

bool is_opaque(std::string_view name) { // usampler2DArray, image3D, textureCube
    if (!any_of(name.substr(0, 5), {"image"})) take(name, {"i64", "u64", "f16", "i", "u"});
    if (any_of(name, {"sampler", "samplerShadow", "subpassInput", "subpassInputMS"})) return true;
    if (!take(name, {"sampler", "image", "texture"})) return false;
    if (name.ends_with("Shadow")) name.remove_suffix(6);
    return any_of(
        name, {"1D", "2D", "3D", "Cube", "1DArray", "2DArray", "CubeArray", "2DMS", "2DMSArray", "2DRect", "Buffer"});
}

} // namespace

bool is_glsl_word(std::string_view name) {
    if (name.starts_with("GL_") || name.starts_with("RESTAGE_")) return true; // macros: of extensions, of headers
    return std::find(std::begin(words), std::end(words), name) != std::end(words) || is_vector_or_matrix(name) ||
           is_scalar(name) || is_opaque(name);
}

} // namespace restage::plugin
