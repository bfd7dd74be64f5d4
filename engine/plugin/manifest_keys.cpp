// SPDX-License-Identifier: Apache-2.0
#include "plugin/manifest_keys.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>
#include <vector>

namespace restage::plugin {

namespace {

// Number of letters to insert, delete or replace (Levenshtein 1966).
std::size_t typing_errors(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row.back();
}

} // namespace

std::optional<std::string> unknown_key(const nlohmann::json& object, Keys known) {
    for (const auto& [key, value] : object.items())
        if (!key.starts_with("x-") && std::find(known.begin(), known.end(), key) == known.end()) return key;
    return std::nullopt;
}

std::string unknown_key_text(const std::string& key, Keys known) {
    std::string all;
    std::string_view nearest = known[0];
    for (const std::string_view k : known) {
        all += (all.empty() ? "" : ", ") + std::string(k);
        if (typing_errors(key, k) < typing_errors(key, nearest)) nearest = k;
    }
    const bool alike = typing_errors(key, nearest) <= std::max<std::size_t>(1, nearest.size() / 3);
    return "the key \"" + key + "\" is unknown; " +
           (alike ? "did you mean \"" + std::string(nearest) + "\"?" : "known keys: " + all) +
           " (custom keys begin with \"x-\")";
}

} // namespace restage::plugin
