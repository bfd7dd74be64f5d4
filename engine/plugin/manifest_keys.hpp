// SPDX-License-Identifier: Apache-2.0
// Private to plugin/: the keys of a manifest and its nested objects. A misspelt key is not ignored but reported,
// with the most similar known key. Custom keys are named "x-...".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace restage::plugin {

using Keys = std::span<const std::string_view>;

// The object's first key that is unknown and does not begin with "x-".
std::optional<std::string> unknown_key(const nlohmann::json& object, Keys known);

// 'the key "file" is unknown; did you mean "files"? (...)', or the known keys if none is similar.
std::string unknown_key_text(const std::string& key, Keys known);

} // namespace restage::plugin
