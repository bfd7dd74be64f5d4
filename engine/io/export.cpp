// SPDX-License-Identifier: Apache-2.0
#include "io/export.hpp"

#include "io/scene_reader.hpp"
#include "scene/validate.hpp"

#include <charconv>
#include <cstring>
#include <filesystem>
#include <vector>

namespace restage::io {

using namespace scene;

namespace {

const RestageParam* find_option(const RestageExporter1& exporter, std::string_view id) {
    for (std::uint32_t i = 0; i < exporter.option_count; ++i)
        if (exporter.options[i].id == id) return &exporter.options[i];
    return nullptr;
}

std::string known_options(const RestageExporter1& exporter) {
    std::string list;
    for (std::uint32_t i = 0; i < exporter.option_count; ++i) {
        list += (list.empty() ? "" : ", ") + std::string(exporter.options[i].id);
        if (exporter.options[i].type == RESTAGE_ENUM) list += "=" + std::string(exporter.options[i].choices);
    }
    return list.empty() ? "it has no options" : "there are: " + list;
}

Result<> check_option(const RestageExporter1& exporter, const std::string& id, const Value& value) {
    const RestageParam* option = find_option(exporter, id);
    const std::string who = std::string("exporter \"") + exporter.format + "\": ";
    if (!option) return fail(who + "there is no option \"" + id + "\"; " + known_options(exporter));
    if (value.type != static_cast<RestageType>(option->type))
        return fail(who + "option \"" + id + "\" has another type");
    if (option->type == RESTAGE_ENUM && !choice_index(option->choices, value.text))
        return fail(who + "option \"" + id + "\" cannot be \"" + value.text + "\"; " + option->choices +
                    " are possible");
    if ((option->type == RESTAGE_FLOAT || option->type == RESTAGE_INT) &&
        !(value.v[0] >= option->min && value.v[0] <= option->max))
        return fail(who + "option \"" + id + "\" is out of its range");
    return {};
}

bool has_extension(const RestageExporter1& exporter, std::string_view extension) {
    return choice_index(exporter.extensions, extension).has_value();
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

Result<> set_option(const RestageExporter1& exporter, const std::string& assignment, ParamSet& values) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
        return fail("\"" + assignment + "\" is no option; write name=value");
    const std::string id = assignment.substr(0, equals), text = assignment.substr(equals + 1);
    const RestageParam* option = find_option(exporter, id);
    if (!option) return check_option(exporter, id, {});
    Value value{.type = static_cast<RestageType>(option->type)};
    if (option->type == RESTAGE_ENUM || option->type == RESTAGE_TEXT) {
        value.text = text;
    } else if (option->type == RESTAGE_BOOL) {
        if (text != "true" && text != "false")
            return fail("option \"" + id + "\": \"" + text + "\" is neither true nor false");
        value.v[0] = text == "true";
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
    const RestageExporter1* exporter = chosen.table;
    for (const auto& [id, value] : options.values.entries())
        RESTAGE_CHECK(check_option(*exporter, id, value));
    for (const Problem& problem : validate(scene))
        if (problem.severity == Problem::Severity::error) return fail(path + ": not written: " + problem.sentence);

    ParamSet all; // every option, set or default, in the table's order
    for (std::uint32_t i = 0; i < exporter->option_count; ++i) {
        const Value* given = options.values.find(exporter->options[i].id);
        all.set(exporter->options[i].id, given ? *given : default_value(exporter->options[i]));
    }
    std::vector<RestageValue> values;
    for (const auto& [id, value] : all.entries()) {
        RestageValue out{.id = id.c_str(),
                         .type = static_cast<std::uint32_t>(value.type),
                         .ref = 0,
                         .v = {},
                         .text = value.text.c_str()};
        std::memcpy(out.v, value.v.data(), sizeof out.v);
        values.push_back(out);
    }
    SceneReader reader(scene, registry, options.progress);
    std::optional<CrashNote> note(std::in_place, chosen.plugin->blame("while it wrote " + path));
    const bool saved =
        exporter->save(path.c_str(), &reader.table(), values.data(), static_cast<std::uint32_t>(values.size())) != 0;
    note.reset();
    if (reader.cancelled()) return cancelled(path + ": stopped on request");
    if (!reader.error().empty()) return fail(reader.error());
    if (!saved) return fail(path + ": exporter \"" + exporter->format + "\" gave up and did not say why");
    return std::move(reader.report);
}

} // namespace restage::io
