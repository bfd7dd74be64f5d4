// SPDX-License-Identifier: Apache-2.0
// Private to plugin/: the keys of a manifest and of what is nested in it. A misspelt one is not passed over but named,
// with the key that may have been meant. Who keeps notes of their own calls them "x-...".
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace restage::plugin {

using Keys = std::span<const std::string_view>;

// The first key of the object that is neither known nor begins with "x-".
std::optional<std::string> unknown_key(const nlohmann::json& object, Keys known);

// 'the key "file" is unknown; is "files" meant? (...)', or what is known where nothing is alike.
std::string unknown_key_text(const std::string& key, Keys known);

} // namespace restage::plugin
