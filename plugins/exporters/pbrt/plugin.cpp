// SPDX-License-Identifier: Apache-2.0
// The exporter's table, its options, and the border that no exception crosses.
#include "exporter.hpp"

#include <cstring>

namespace restage::pbrt_out {

namespace {

const RestageParam options[] = {
    {"version", "pbrt version", RESTAGE_ENUM, 0, 0, 0, {0}, "", "v4|v3", "Which pbrt the file is for."},
    {"textures",
     "Textures",
     RESTAGE_ENUM,
     0,
     0,
     0,
     {0},
     "",
     "copy|relative|absolute",
     "Copy image files beside the scene, or name them where they are."},
    {"meshes",
     "Meshes",
     RESTAGE_ENUM,
     0,
     0,
     0,
     {0},
     "",
     "write|reference",
     "Write heavy meshes beside the scene, or name the PLY files they came from."},
};

Options read_options(const RestageValue* values, std::uint32_t count) {
    const Values given(values, count);
    Options out;
    out.version = given.choice("version", "v4") == "v3" ? Version::v3 : Version::v4;
    const std::string textures = given.choice("textures", "copy");
    out.textures = textures == "relative" ? Files::relative : textures == "absolute" ? Files::absolute : Files::copy;
    out.write_meshes = given.choice("meshes", "write") != "reference";
    return out;
}

int save(const char* path, const RestageSceneReader1* in, const RestageValue* values, std::uint32_t count) {
    try {
        const std::filesystem::path target(path);
        Output output(target);
        if (!Exporter(*in, read_options(values, count), output).run(target.filename().string())) return 0; // stopped
        output.commit();
        in->progress(in->ctx, 1, "done");
        return 1;
    } catch (const ExportError& e) {
        in->error(in->ctx, e.file.empty() ? path : e.file.c_str(), e.what());
    } catch (const std::exception& e) {
        in->error(in->ctx, path, e.what());
    }
    return 0;
}

const RestageExporter1 table = {sizeof(RestageExporter1),           "pbrt", "pbrt scene (v4, v3)", "pbrt", options,
                                sizeof options / sizeof options[0], save};

const void* query(const char* id, std::uint32_t index) {
    return index == 0 && std::strcmp(id, RESTAGE_EXPORTER1) == 0 ? &table : nullptr;
}

} // namespace

} // namespace restage::pbrt_out

extern "C" {
RESTAGE_EXPORT extern const RestagePlugin restage_plugin;
const RestagePlugin restage_plugin = {
    RESTAGE_ABI, sizeof(RestagePlugin),   "org.restage.exporter.pbrt", "0.1.0", nullptr,
    nullptr,     restage::pbrt_out::query};
}
