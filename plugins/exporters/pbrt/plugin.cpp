// SPDX-License-Identifier: Apache-2.0
// The exporter's table, its options, and the boundary that no exception crosses.
#include "exporter.hpp"

namespace restage::pbrt_out {

namespace {

const RestageParam options[] = {
    RESTAGE_ENUM_PARAM("version", "pbrt version", "v4|v3", 0, 0, "pbrt version of the file."),
    RESTAGE_ENUM_PARAM("textures", "Textures", "copy|relative|absolute", 0, 0,
                       "Copy image files next to the scene, or refer to them in place."),
    RESTAGE_ENUM_PARAM("meshes", "Meshes", "write|reference", 0, 0,
                       "Write heavy meshes next to the scene, or refer to their original PLY files."),
};

Options read_options(const RestageValue* values, std::uint32_t count) {
    const Values given(values, count);
    Options out;
    out.version = given.choice("version", "v4") == "v3" ? Version::v3 : Version::v4;
    out.textures = files_option(given.choice("textures", "copy"));
    out.write_meshes = given.choice("meshes", "write") != "reference";
    return out;
}

int save(const char* path, const RestageSceneReader1* in, const RestageValue* values, std::uint32_t count) {
    try {
        const std::filesystem::path target(path);
        Output output(target);
        if (!Exporter(*in, read_options(values, count), output).run(target.filename().string())) return 0; // stopped
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

const RestageExporter1 table = {.format = "pbrt",
                                .label = "pbrt scene (v4, v3)",
                                .extensions = "pbrt",
                                .options = options,
                                .option_count = RESTAGE_COUNT(options),
                                .save = save};

} // namespace

} // namespace restage::pbrt_out

RESTAGE_PLUGIN("org.restage.exporter.pbrt", "0.1.0", {RESTAGE_EXPORTER1, &restage::pbrt_out::table})
