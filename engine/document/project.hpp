// SPDX-License-Identifier: Apache-2.0
// Project files, *.restage: JSON with the base scene by path, format and content hash, and the changes against
// its import, and the looks as changes to that. References are "#17 oak": the id in the base (new items follow in
// order) and the name there, by which it is found again if the base has changed meanwhile. Same scene, same bytes.
#pragma once

#include "document/document.hpp"

namespace restage::document {

inline constexpr int project_version = 1;

struct ProjectContent {
    const Base& base;
    const scene::Scene& scene;
    const DataSources& sources;
    std::string_view unknown = {}; // of Document
    const Looks* looks = nullptr;
    const std::map<std::string, std::string>* note = nullptr;
};

// `folder`: the base of relative paths in the file; "" = paths are absolute. [any]
std::string project_text(const ProjectContent&, const std::filesystem::path& folder);

Result<Document> read_project(const std::string& path, const plugin::Registry&, const ReadOptions& = {}); // [worker]
// Likewise from a project's text; errors call it `name`.
Result<Document> read_project_text(const std::string& text, const std::string& name, const plugin::Registry&);

} // namespace restage::document
