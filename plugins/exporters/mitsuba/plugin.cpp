// SPDX-License-Identifier: Apache-2.0
// The exporter's table, its options, and the boundary that no exception crosses.
#include "exporter.hpp"

namespace restage::mitsuba_out {

namespace {

const RestageParam options[] = {
    RESTAGE_ENUM_PARAM("textures", "Textures", "copy|relative|absolute", 0, 0,
                       "Copy image files next to the scene, or refer to them in place."),
};

int save(const char* path, const RestageSceneReader1* in, const RestageValue* values, std::uint32_t count) {
    try {
        const std::filesystem::path target(path);
        Output output(target);
        const Files textures = files_option(Values(values, count).choice("textures", "copy"));
        if (!Exporter(*in, textures, output).run(target.filename().string())) return 0; // stopped
        if (!in->progress(in->ctx, 1, "done")) return 0; // last chance to cancel: nothing has been renamed yet
        output.commit();
        return 1;
    } catch (const ExportError& e) {
        in->error(in->ctx, e.file.empty() ? path : e.file.c_str(), e.what());
    } catch (const std::exception& e) {
        in->error(in->ctx, path, e.what());
    }
    return 0;
}

const RestageExporter1 table = {.format = "mitsuba",
                                .label = "Mitsuba 3 scene",
                                .extensions = "xml",
                                .options = options,
                                .option_count = RESTAGE_COUNT(options),
                                .save = save};

} // namespace

} // namespace restage::mitsuba_out

RESTAGE_PLUGIN("org.restage.exporter.mitsuba", "0.1.0", {RESTAGE_EXPORTER1, &restage::mitsuba_out::table})
