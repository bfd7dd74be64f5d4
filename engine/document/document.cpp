// SPDX-License-Identifier: Apache-2.0
#include "document/document.hpp"

#include "base/file.hpp"
#include "document/exposure.hpp"
#include "document/isolate.hpp"
#include "document/pack.hpp"
#include "document/project.hpp"

namespace restage::document {

void DataSources::note(const std::shared_ptr<const void>& data, DataSource source) {
    if (data) by_data_.insert_or_assign(data.get(), Held{data, std::move(source)});
}

void DataSources::note_all(const scene::Scene& imported, const std::string& file, const std::string& format,
                           const scene::ParamSet& options) {
    const auto each = [&](auto id, const auto& item) { note(item.data, {file, format, id.value, item.name, options}); };
    imported.meshes.each(each);
    imported.images.each(each);
}

const DataSource* DataSources::find(const void* data) const {
    const auto found = by_data_.find(data);
    return found == by_data_.end() ? nullptr : &found->second.source;
}

bool is_project(const std::filesystem::path& path) { return path.extension() == project_extension; }

Result<io::ImportedScene> read_scene(const std::string& path, const plugin::Registry& registry,
                                     const ReadOptions& options, const std::string& format) {
    const auto read = [&]() -> Result<io::ImportedScene> {
        const io::ImportOptions reading{.progress = options.progress,
                                        .format = format,
                                        .values = options.import_options.value_or(scene::ParamSet())};
        if (options.isolate) return import_isolated(path, registry, *options.isolate, reading);
        return io::import_scene(path, registry, reading);
    };
    RESTAGE_TRY(io::ImportedScene imported, read());
    if (options.expose) expose(imported, registry);
    return imported;
}

Result<Document> read_document(const std::string& path, const plugin::Registry& registry, const ReadOptions& options) {
    if (is_project(path)) return read_project(path, registry, options);
    if (is_packed(path)) {
        RESTAGE_TRY(const std::filesystem::path project, unpack_project(path, options.progress));
        return read_project(project.string(), registry, options);
    }
    RESTAGE_TRY(io::ImportedScene imported, read_scene(path, registry, options));
    RESTAGE_TRY(const std::string bytes, read_file(path));
    Document document;
    document.path = path;
    document.base = {.file = std::filesystem::absolute(path).lexically_normal().string(),
                     .format = imported.importer,
                     .hash = hash64(bytes),
                     .scene = std::move(imported.scene),
                     .options = std::move(imported.options)};
    document.report = std::move(imported.report);
    return document;
}

} // namespace restage::document
