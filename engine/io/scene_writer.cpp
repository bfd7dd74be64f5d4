// SPDX-License-Identifier: Apache-2.0
#include "io/scene_writer.hpp"

#include "io/scene_reader.hpp"
#include "io/scene_writer_calls.hpp"
#include "plugin/abi.hpp"

namespace restage::io {

using namespace scene;

void SceneWriter::refuse(const std::string& what, const std::string& why) { report.add(Fate::dropped, what, why); }

Origin SceneWriter::origin(const RestageOrigin* given) {
    if (!given) return {};
    const RestageOrigin in = plugin::sized(*given);
    Origin result{.verbatim = text(in.verbatim), .format = text(in.format), .values = {}};
    for (std::uint32_t i = 0; in.values && i < in.value_count; ++i) {
        const RestageOriginValue value = plugin::element(in.values, i);
        result.values.push_back({text(value.id), text(value.text)});
    }
    if (scene.format.empty()) scene.format = result.format;
    return result;
}

std::string SceneWriter::unique_name(const char* kind, const std::string& wanted) {
    auto& taken = names_[kind];
    if (!wanted.empty() && taken.insert(wanted).second) return wanted;
    const std::string base = wanted.empty() ? kind : wanted;
    unsigned& number = numbers_[std::string(kind) + '\n' + base];
    if (number == 0 && !wanted.empty()) number = 1; // the second "chair" is "chair 2"
    std::string name;
    do
        name = base + " " + std::to_string(++number);
    while (!taken.insert(name).second);
    return name;
}

void SceneWriter::Calls::report(void* ctx, int fate, const char* file, std::uint32_t line, const char* what,
                                const char* note) {
    guarded(ctx, "report", [&](SceneWriter& w) -> RestageHandle {
        w.tell(fate, what, note, file, line);
        return 0;
    });
}

void SceneWriter::Calls::error(void* ctx, const char* file, std::uint32_t line, std::uint32_t column,
                               const char* message) {
    guarded(ctx, "error", [&](SceneWriter& w) -> RestageHandle {
        w.raise(file, line, column, message);
        return 0;
    });
}

int SceneWriter::Calls::progress(void* ctx, float done, const char* what) {
    return static_cast<int>(
        guarded(ctx, "progress", [&](SceneWriter& w) -> RestageHandle { return w.proceed(done, what); }));
}

const RestageParam* SceneWriter::Calls::material_table(void* ctx, const char* type, std::uint32_t* count) {
    if (count) *count = 0;
    const RestageParam* lines = nullptr;
    guarded(ctx, "material_table", [&](SceneWriter& w) -> RestageHandle {
        const auto entry = w.registry_.find_material(text(type));
        if (!entry) return 0;
        auto& given = w.tables_[entry->table->type]; // the importer may use it until it is done
        if (!given) given = std::make_unique<plugin::GivenTable>(entry->table->params);
        if (count) *count = given->count();
        lines = given->lines();
        return 1;
    });
    return lines;
}

const RestageParam* SceneWriter::Calls::texture_table(void* ctx, const char* type, std::uint32_t* count) {
    if (count) *count = 0;
    const RestageParam* lines = nullptr;
    guarded(ctx, "texture_table", [&](SceneWriter& w) -> RestageHandle {
        const auto entry = w.registry_.find_texture(text(type));
        if (!entry) return 0;
        auto& given = w.tables_["texture " + entry->table->type]; // the importer may use it until it is done
        if (!given) {
            std::vector<model::Param> params = entry->table->params;
            if (entry->table->mapped)
                params.insert(params.end(), model::mapping_params().begin(), model::mapping_params().end());
            given = std::make_unique<plugin::GivenTable>(params);
        }
        if (count) *count = given->count();
        lines = given->lines();
        return 1;
    });
    return lines;
}

SceneWriter::SceneWriter(const plugin::Registry& registry, Progress progress)
    : Exchange(std::move(progress)), registry_(registry) {
    scene.clock = 1;
    table_ = {.size = sizeof(RestageSceneWriter1),
              .ctx = this,
              .mesh = Calls::mesh,
              .image = Calls::image,
              .texture = Calls::texture,
              .material = Calls::material,
              .medium = Calls::medium,
              .group = Calls::group,
              .instance = Calls::instance,
              .light = Calls::light,
              .environment = Calls::environment,
              .camera = Calls::camera,
              .camera_medium = Calls::camera_medium,
              .film = Calls::film,
              .settings = Calls::settings,
              .report = Calls::report,
              .error = Calls::error,
              .progress = Calls::progress,
              .material_table = Calls::material_table,
              .options = nullptr,
              .option_count = 0,
              .texture_table = Calls::texture_table};
}

void SceneWriter::set_options(ParamSet options) {
    options_ = std::move(options);
    given_options_ = give_values(options_);
    table_.options = given_options_.data();
    table_.option_count = static_cast<std::uint32_t>(given_options_.size());
}

} // namespace restage::io
