// SPDX-License-Identifier: Apache-2.0
// Project files, *.restage: JSON with the base scene by path, format and content hash, and the changes against what
// importing it gives. References are "#17 oak": the id in the base (new things follow in order) and the name there, by
// which it is found again when the base has changed meanwhile. Same scene, same bytes.
#pragma once

#include "document/document.hpp"

namespace restage::document {

inline constexpr int project_version = 1;

struct ProjectContent {
    const Base& base;
    const scene::Scene& scene;
    const DataSources& sources;
    std::string_view unknown = {}; // of Document
    const std::map<std::string, std::string>* note = nullptr;
};

// `folder`: what paths in the file are relative to; "" = they are absolute. [any]
std::string project_text(const ProjectContent&, const std::filesystem::path& folder);

Result<Document> read_project(const std::string& path, const plugin::Registry&, const ReadOptions& = {}); // [worker]
// The same of a project's text; `name` is what errors call it.
Result<Document> read_project_text(const std::string& text, const std::string& name, const plugin::Registry&);

} // namespace restage::document
