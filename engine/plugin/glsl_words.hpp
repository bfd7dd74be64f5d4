// SPDX-License-Identifier: Apache-2.0
// Private to plugin/: words not allowed as names of struct members in shaders that Restage composes.
#pragma once

#include <string_view>

namespace restage::plugin {

// Keywords and reserved words of GLSL 4.60 (section 3.6) and of the extensions that kernels may enable (types of
// GL_EXT_shader_explicit_arithmetic_types, storage of GL_EXT_ray_tracing), and names defined by Restage's own headers.
bool is_glsl_word(std::string_view name);

} // namespace restage::plugin
