// SPDX-License-Identifier: Apache-2.0
#include "io/export.hpp"

#include "io/scene_reader.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <vector>

namespace restage::io {

using namespace scene;

namespace {

std::string known_options(const model::Exporter& exporter) {
    std::string list;
    for (const model::Param& option : exporter.options) {
        list += (list.empty() ? "" : ", ") + option.id;
        if (option.type == model::ParamType::choice) list += "=" + choices_text(option);
    }
    return list.empty() ? "it has no options" : "there are: " + list;
}

Result<> check_option(const model::Exporter& exporter, const std::string& id, const Value& value) {
    const model::Param* option = find_param(exporter.options, id);
    const std::string who = std::string("exporter \"") + exporter.format + "\": ";
    if (!option) return fail(who + "there is no option \"" + id + "\"; " + known_options(exporter));
    if (const std::string why = misfit(*option, value); !why.empty()) return fail(who + "option \"" + id + "\"" + why);
    return {};
}

bool has_extension(const model::Exporter& exporter, std::string_view extension) {
    return std::ranges::find(exporter.extensions, extension) != exporter.extensions.end();
}

} // namespace

Result<plugin::ExporterEntry> find_exporter(const std::string& path, const std::string& format,
                                            const plugin::Registry& registry) {
    std::string known;
    for (const auto& entry : registry.exporters())
        known += (known.empty() ? "" : ", ") + std::string(entry.table->format);
    known = known.empty() ? "no exporter plugin is loaded" : "known are: " + known;
    if (!format.empty()) {
        if (auto entry = registry.find_exporter(format)) return *std::move(entry);
        return fail("there is no exporter \"" + format + "\"; " + known);
    }
    std::string extension = std::filesystem::path(path).extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    for (const auto& entry : registry.exporters())
        if (has_extension(*entry.table, extension)) return entry;
    return fail(path +
                (extension.empty() ? ": has no extension that says the format; "
                                   : ": no exporter writes files called ." + extension + "; ") +
                known);
}

Result<> set_option(const model::Exporter& exporter, const std::string& assignment, ParamSet& values) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        return fail("\"" + assignment + "\" is no option; write name=value");
    const std::string id = assignment.substr(0, equals), text = assignment.substr(equals + 1);
    const model::Param* option = find_param(exporter.options, id);
    if (!option) return check_option(exporter, id, {});
    Value value{.type = option->type};
    if (option->type == model::ParamType::choice || option->type == model::ParamType::text) {
        value.text = text;
    } else if (option->type == model::ParamType::boolean) {
        if (text != "true" && text != "false")
            return fail("option \"" + id + "\": \"" + text + "\" is neither true nor false");
        value.i = text == "true";
    } else if (option->type == model::ParamType::integer) {
        const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value.i);
        if (code != std::errc() || end != text.data() + text.size())
            return fail("option \"" + id + "\": \"" + text + "\" is not a whole number");
    } else {
        const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value.v[0]);
        if (code != std::errc() || end != text.data() + text.size())
            return fail("option \"" + id + "\": \"" + text + "\" is not a number");
    }
    RESTAGE_CHECK(check_option(exporter, id, value));
    values.set(id, std::move(value));
    return {};
}

Result<Report> export_scene(const Scene& scene, const std::string& path, const plugin::Registry& registry,
                            const ExportOptions& options) {
    RESTAGE_TRY(const plugin::ExporterEntry chosen, find_exporter(path, options.format, registry));
    const model::Exporter* exporter = chosen.table;
    for (const auto& [id, value] : options.values.entries())
        RESTAGE_CHECK(check_option(*exporter, id, value));
    for (const Problem& problem : validate(scene))
        if (problem.severity == Problem::Severity::error) return fail(path + ": not written: " + problem.sentence);

    ParamSet all; // every option, set or default, in the table's order
    for (const model::Param& option : exporter->options) {
        const Value* given = options.values.find(option.id);
        all.set(option.id, given ? *given : default_value(option));
    }
    const std::vector<RestageValue> values = give_values(all);
    SceneReader reader(scene, registry, options.progress);
    std::optional<CrashNote> note(std::in_place, chosen.plugin->blame("while it wrote " + path));
    const bool saved = chosen.native->save(path.c_str(), &reader.table(), values.data(),
                                           static_cast<std::uint32_t>(values.size())) != 0;
    note.reset();
    if (reader.cancelled()) return cancelled(path + ": stopped on request");
    if (!reader.error().empty()) return fail(reader.error());
    if (!saved) return fail(path + ": exporter \"" + exporter->format + "\" gave up and did not say why");
    return std::move(reader.report);
}

} // namespace restage::io
