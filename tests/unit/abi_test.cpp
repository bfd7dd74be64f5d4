// SPDX-License-Identifier: Apache-2.0
// The plugin ABI does not change: sizes, offsets and numbers are as released (64-bit platforms), as are plugins
// built with the headers of earlier releases. If this fails, the header is wrong, not the test: growth is a new
// interface id.
#include "paths.hpp"
#include "plugin_folder.hpp"

#include <restage/action.h>
#include <restage/denoiser.h>
#include <restage/emission.h>
#include <restage/image.h>
#include <restage/inspector.h>
#include <restage/material.h>
#include <restage/scene_io.h>
#include <restage/sky.h>
#include <restage/table.h>
#include <restage/texture.h>
#include <cstddef>

namespace fs = std::filesystem;
using namespace restage;

namespace {

struct Frozen {
    const char* what;
    std::size_t released, now;
};
#define SIZE(type, bytes) {#type, bytes, sizeof(type)},
#define FIELD(type, field, offset) {#type "::" #field, offset, offsetof(type, field)},
const Frozen layout[] = {
    // clang-format off
    SIZE(RestageHost, 24)
        FIELD(RestageHost, abi, 0) FIELD(RestageHost, size, 4) FIELD(RestageHost, version, 8)
        FIELD(RestageHost, service, 16)
    SIZE(RestagePlugin, 48)
        FIELD(RestagePlugin, abi, 0) FIELD(RestagePlugin, size, 4) FIELD(RestagePlugin, id, 8)
        FIELD(RestagePlugin, version, 16) FIELD(RestagePlugin, init, 24) FIELD(RestagePlugin, shutdown, 32)
        FIELD(RestagePlugin, query, 40)
    SIZE(RestageLog1, 16)
        FIELD(RestageLog1, size, 0) FIELD(RestageLog1, log, 8)
    SIZE(RestageParam, 88)
        FIELD(RestageParam, size, 0) FIELD(RestageParam, type, 4) FIELD(RestageParam, flags, 8)
        FIELD(RestageParam, int_min, 12) FIELD(RestageParam, int_max, 16) FIELD(RestageParam, int_def, 20)
        FIELD(RestageParam, min, 24) FIELD(RestageParam, max, 28) FIELD(RestageParam, def, 32)
        FIELD(RestageParam, id, 48) FIELD(RestageParam, label, 56) FIELD(RestageParam, unit, 64)
        FIELD(RestageParam, choices, 72) FIELD(RestageParam, tooltip, 80)
    SIZE(RestageValue, 48)
        FIELD(RestageValue, size, 0) FIELD(RestageValue, type, 4) FIELD(RestageValue, id, 8)
        FIELD(RestageValue, ref, 16) FIELD(RestageValue, i, 20) FIELD(RestageValue, v, 24)
        FIELD(RestageValue, text, 40)
    SIZE(RestageMaterial1, 64)
        FIELD(RestageMaterial1, size, 0) FIELD(RestageMaterial1, flags, 4) FIELD(RestageMaterial1, type, 8)
        FIELD(RestageMaterial1, label, 16) FIELD(RestageMaterial1, prefix, 24)
        FIELD(RestageMaterial1, glsl_file, 32) FIELD(RestageMaterial1, params, 40)
        FIELD(RestageMaterial1, param_count, 48) FIELD(RestageMaterial1, tooltip, 56)
    SIZE(RestageDenoiseJob, 72)
        FIELD(RestageDenoiseJob, size, 0) FIELD(RestageDenoiseJob, width, 4)
        FIELD(RestageDenoiseJob, height, 8) FIELD(RestageDenoiseJob, color, 16)
        FIELD(RestageDenoiseJob, albedo, 24) FIELD(RestageDenoiseJob, normal, 32)
        FIELD(RestageDenoiseJob, output, 40) FIELD(RestageDenoiseJob, quality, 48)
        FIELD(RestageDenoiseJob, threads, 52) FIELD(RestageDenoiseJob, progress_ctx, 56)
        FIELD(RestageDenoiseJob, progress, 64)
    SIZE(RestageDenoiser1, 40)
        FIELD(RestageDenoiser1, size, 0) FIELD(RestageDenoiser1, type, 8) FIELD(RestageDenoiser1, label, 16)
        FIELD(RestageDenoiser1, available, 24) FIELD(RestageDenoiser1, run, 32)
    SIZE(RestageUi1, 144)
        FIELD(RestageUi1, size, 0) FIELD(RestageUi1, param, 8) FIELD(RestageUi1, hide, 16)
        FIELD(RestageUi1, slider, 24) FIELD(RestageUi1, color, 32) FIELD(RestageUi1, texture, 40)
        FIELD(RestageUi1, combo, 48) FIELD(RestageUi1, button, 56) FIELD(RestageUi1, text, 64)
        FIELD(RestageUi1, begin_group, 72) FIELD(RestageUi1, end_group, 80) FIELD(RestageUi1, plot, 88)
        FIELD(RestageUi1, curve, 96) FIELD(RestageUi1, image, 104) FIELD(RestageUi1, get, 112)
        FIELD(RestageUi1, set, 120) FIELD(RestageUi1, run, 128) FIELD(RestageUi1, selected, 136)
    SIZE(RestageInspector1, 24)
        FIELD(RestageInspector1, size, 0) FIELD(RestageInspector1, type, 8)
        FIELD(RestageInspector1, draw, 16)
    SIZE(RestageTableFile1, 64)
        FIELD(RestageTableFile1, size, 0) FIELD(RestageTableFile1, reserved, 4)
        FIELD(RestageTableFile1, ctx, 8) FIELD(RestageTableFile1, path, 16)
        FIELD(RestageTableFile1, length, 24) FIELD(RestageTableFile1, bytes, 32)
        FIELD(RestageTableFile1, append, 40) FIELD(RestageTableFile1, note, 48)
        FIELD(RestageTableFile1, error, 56)
    SIZE(RestageTable1, 32)
        FIELD(RestageTable1, size, 0) FIELD(RestageTable1, type, 8) FIELD(RestageTable1, extensions, 16)
        FIELD(RestageTable1, read, 24)
    SIZE(RestageEmission1, 40)
        FIELD(RestageEmission1, size, 0) FIELD(RestageEmission1, reserved, 4)
        FIELD(RestageEmission1, type, 8) FIELD(RestageEmission1, radiance, 16)
        FIELD(RestageEmission1, scale, 24) FIELD(RestageEmission1, two_sided, 32)
    SIZE(RestageDecodedImage, 48)
        FIELD(RestageDecodedImage, size, 0) FIELD(RestageDecodedImage, width, 4)
        FIELD(RestageDecodedImage, height, 8) FIELD(RestageDecodedImage, channels, 12)
        FIELD(RestageDecodedImage, bits, 16) FIELD(RestageDecodedImage, texels, 24)
        FIELD(RestageDecodedImage, problem, 32) FIELD(RestageDecodedImage, owner, 40)
    SIZE(RestageImageService1, 24)
        FIELD(RestageImageService1, size, 0) FIELD(RestageImageService1, decode, 8)
        FIELD(RestageImageService1, release, 16)
    SIZE(RestageTextureAt1, 48)
        FIELD(RestageTextureAt1, size, 0) FIELD(RestageTextureAt1, uv, 4)
        FIELD(RestageTextureAt1, values, 16) FIELD(RestageTextureAt1, whole, 24)
        FIELD(RestageTextureAt1, host, 32) FIELD(RestageTextureAt1, image, 40)
    SIZE(RestageTexture1, 72)
        FIELD(RestageTexture1, size, 0) FIELD(RestageTexture1, flags, 4) FIELD(RestageTexture1, type, 8)
        FIELD(RestageTexture1, label, 16) FIELD(RestageTexture1, prefix, 24)
        FIELD(RestageTexture1, glsl_file, 32) FIELD(RestageTexture1, params, 40)
        FIELD(RestageTexture1, param_count, 48) FIELD(RestageTexture1, tooltip, 56)
        FIELD(RestageTexture1, eval, 64)
    SIZE(RestageOriginValue, 24)
        FIELD(RestageOriginValue, size, 0) FIELD(RestageOriginValue, reserved, 4)
        FIELD(RestageOriginValue, id, 8) FIELD(RestageOriginValue, text, 16)
    SIZE(RestageOrigin, 32)
        FIELD(RestageOrigin, size, 0) FIELD(RestageOrigin, value_count, 4) FIELD(RestageOrigin, format, 8)
        FIELD(RestageOrigin, verbatim, 16) FIELD(RestageOrigin, values, 24)
    SIZE(RestageMesh, 96)
        FIELD(RestageMesh, size, 0) FIELD(RestageMesh, name, 8) FIELD(RestageMesh, origin, 16)
        FIELD(RestageMesh, vertex_count, 24) FIELD(RestageMesh, triangle_count, 28)
        FIELD(RestageMesh, positions, 32) FIELD(RestageMesh, normals, 40) FIELD(RestageMesh, uvs, 48)
        FIELD(RestageMesh, indices, 56) FIELD(RestageMesh, source_file, 64)
        FIELD(RestageMesh, primitive, 72) FIELD(RestageMesh, tangents, 80) FIELD(RestageMesh, uvs2, 88)
    SIZE(RestageImage, 64)
        FIELD(RestageImage, size, 0) FIELD(RestageImage, name, 8) FIELD(RestageImage, origin, 16)
        FIELD(RestageImage, path, 24) FIELD(RestageImage, encoding, 32) FIELD(RestageImage, gamma, 36)
        FIELD(RestageImage, width, 40) FIELD(RestageImage, height, 44) FIELD(RestageImage, channels, 48)
        FIELD(RestageImage, pixels, 56)
    SIZE(RestageTexture, 56)
        FIELD(RestageTexture, size, 0) FIELD(RestageTexture, name, 8) FIELD(RestageTexture, origin, 16)
        FIELD(RestageTexture, type, 24) FIELD(RestageTexture, is_float, 32) FIELD(RestageTexture, image, 36)
        FIELD(RestageTexture, values, 40) FIELD(RestageTexture, value_count, 48)
    SIZE(RestageMaterialDesc, 48)
        FIELD(RestageMaterialDesc, size, 0) FIELD(RestageMaterialDesc, name, 8)
        FIELD(RestageMaterialDesc, origin, 16) FIELD(RestageMaterialDesc, type, 24)
        FIELD(RestageMaterialDesc, values, 32) FIELD(RestageMaterialDesc, value_count, 40)
    SIZE(RestageMedium, 56)
        FIELD(RestageMedium, size, 0) FIELD(RestageMedium, name, 8) FIELD(RestageMedium, origin, 16)
        FIELD(RestageMedium, sigma_a, 24) FIELD(RestageMedium, sigma_s, 36) FIELD(RestageMedium, g, 48)
    SIZE(RestageInstance, 200)
        FIELD(RestageInstance, size, 0) FIELD(RestageInstance, name, 8) FIELD(RestageInstance, origin, 16)
        FIELD(RestageInstance, mesh, 24) FIELD(RestageInstance, material, 28)
        FIELD(RestageInstance, group, 32) FIELD(RestageInstance, alpha_texture, 36)
        FIELD(RestageInstance, interior, 40) FIELD(RestageInstance, exterior, 44)
        FIELD(RestageInstance, has_medium_interface, 48) FIELD(RestageInstance, flags, 52)
        FIELD(RestageInstance, alpha, 56) FIELD(RestageInstance, emission, 60)
        FIELD(RestageInstance, object_to_world, 72)
    SIZE(RestageGroup, 32)
        FIELD(RestageGroup, size, 0) FIELD(RestageGroup, name, 8) FIELD(RestageGroup, origin, 16)
        FIELD(RestageGroup, parent, 24)
    SIZE(RestageLight, 184)
        FIELD(RestageLight, size, 0) FIELD(RestageLight, name, 8) FIELD(RestageLight, origin, 16)
        FIELD(RestageLight, kind, 24) FIELD(RestageLight, value, 28) FIELD(RestageLight, light_to_world, 40)
        FIELD(RestageLight, cone_angle, 168) FIELD(RestageLight, cone_delta, 172)
        FIELD(RestageLight, falloff, 176) FIELD(RestageLight, flags, 180)
    SIZE(RestageEnvironment, 200)
        FIELD(RestageEnvironment, size, 0) FIELD(RestageEnvironment, name, 8)
        FIELD(RestageEnvironment, origin, 16) FIELD(RestageEnvironment, image, 24)
        FIELD(RestageEnvironment, mapping, 28) FIELD(RestageEnvironment, scale, 32)
        FIELD(RestageEnvironment, light_to_world, 48) FIELD(RestageEnvironment, hidden_from_camera, 176)
        FIELD(RestageEnvironment, sky_value_count, 180) FIELD(RestageEnvironment, sky, 184)
        FIELD(RestageEnvironment, sky_values, 192)
    SIZE(RestageCamera, 192)
        FIELD(RestageCamera, size, 0) FIELD(RestageCamera, name, 8) FIELD(RestageCamera, origin, 16)
        FIELD(RestageCamera, camera_to_world, 24) FIELD(RestageCamera, fov, 152)
        FIELD(RestageCamera, screen_window, 156) FIELD(RestageCamera, lens_radius, 172)
        FIELD(RestageCamera, focal_distance, 176) FIELD(RestageCamera, frame_aspect, 180)
        FIELD(RestageCamera, projection, 184) FIELD(RestageCamera, fit_aspect, 188)
    SIZE(RestageFilm, 80)
        FIELD(RestageFilm, size, 0) FIELD(RestageFilm, width, 4) FIELD(RestageFilm, height, 8)
        FIELD(RestageFilm, crop, 12) FIELD(RestageFilm, filter, 32) FIELD(RestageFilm, filter_radius, 40)
        FIELD(RestageFilm, filter_params, 48) FIELD(RestageFilm, exposure, 56)
        FIELD(RestageFilm, filename, 64) FIELD(RestageFilm, unexposed, 72)
    SIZE(RestageSettings, 24)
        FIELD(RestageSettings, size, 0) FIELD(RestageSettings, max_depth, 4)
        FIELD(RestageSettings, samples, 8) FIELD(RestageSettings, origin, 16)
    SIZE(RestageSceneWriter1, 176)
        FIELD(RestageSceneWriter1, size, 0) FIELD(RestageSceneWriter1, ctx, 8)
        FIELD(RestageSceneWriter1, mesh, 16) FIELD(RestageSceneWriter1, image, 24)
        FIELD(RestageSceneWriter1, texture, 32) FIELD(RestageSceneWriter1, material, 40)
        FIELD(RestageSceneWriter1, medium, 48) FIELD(RestageSceneWriter1, group, 56)
        FIELD(RestageSceneWriter1, instance, 64) FIELD(RestageSceneWriter1, light, 72)
        FIELD(RestageSceneWriter1, environment, 80) FIELD(RestageSceneWriter1, camera, 88)
        FIELD(RestageSceneWriter1, camera_medium, 96) FIELD(RestageSceneWriter1, film, 104)
        FIELD(RestageSceneWriter1, settings, 112) FIELD(RestageSceneWriter1, report, 120)
        FIELD(RestageSceneWriter1, error, 128) FIELD(RestageSceneWriter1, progress, 136)
        FIELD(RestageSceneWriter1, material_table, 144) FIELD(RestageSceneWriter1, options, 152)
        FIELD(RestageSceneWriter1, option_count, 160) FIELD(RestageSceneWriter1, texture_table, 168)
    SIZE(RestageImporter1, 64)
        FIELD(RestageImporter1, size, 0) FIELD(RestageImporter1, format, 8)
        FIELD(RestageImporter1, label, 16) FIELD(RestageImporter1, extensions, 24)
        FIELD(RestageImporter1, probe, 32) FIELD(RestageImporter1, load, 40)
        FIELD(RestageImporter1, options, 48) FIELD(RestageImporter1, option_count, 56)
    SIZE(RestageSceneReader1, 160)
        FIELD(RestageSceneReader1, size, 0) FIELD(RestageSceneReader1, ctx, 8)
        FIELD(RestageSceneReader1, count, 16) FIELD(RestageSceneReader1, mesh, 24)
        FIELD(RestageSceneReader1, image, 32) FIELD(RestageSceneReader1, texture, 40)
        FIELD(RestageSceneReader1, material, 48) FIELD(RestageSceneReader1, medium, 56)
        FIELD(RestageSceneReader1, group, 64) FIELD(RestageSceneReader1, instance, 72)
        FIELD(RestageSceneReader1, light, 80) FIELD(RestageSceneReader1, environment, 88)
        FIELD(RestageSceneReader1, camera, 96) FIELD(RestageSceneReader1, active_camera, 104)
        FIELD(RestageSceneReader1, camera_medium, 112) FIELD(RestageSceneReader1, film, 120)
        FIELD(RestageSceneReader1, settings, 128) FIELD(RestageSceneReader1, report, 136)
        FIELD(RestageSceneReader1, error, 144) FIELD(RestageSceneReader1, progress, 152)
    SIZE(RestageExporter1, 56)
        FIELD(RestageExporter1, size, 0) FIELD(RestageExporter1, format, 8)
        FIELD(RestageExporter1, label, 16) FIELD(RestageExporter1, extensions, 24)
        FIELD(RestageExporter1, options, 32) FIELD(RestageExporter1, option_count, 40)
        FIELD(RestageExporter1, save, 48)
    SIZE(RestageSkySun, 32)
        FIELD(RestageSkySun, size, 0) FIELD(RestageSkySun, direction, 4) FIELD(RestageSkySun, radiance, 16)
        FIELD(RestageSkySun, angular_radius, 28)
    SIZE(RestageSkyJob1, 48)
        FIELD(RestageSkyJob1, size, 0) FIELD(RestageSkyJob1, width, 4) FIELD(RestageSkyJob1, pixels, 8)
        FIELD(RestageSkyJob1, ctx, 16) FIELD(RestageSkyJob1, progress, 24) FIELD(RestageSkyJob1, sun, 32)
        FIELD(RestageSkyJob1, error, 40)
    SIZE(RestageSky1, 48)
        FIELD(RestageSky1, size, 0) FIELD(RestageSky1, param_count, 4) FIELD(RestageSky1, type, 8)
        FIELD(RestageSky1, label, 16) FIELD(RestageSky1, tooltip, 24) FIELD(RestageSky1, params, 32)
        FIELD(RestageSky1, make, 40)
    SIZE(RestageSelection1, 16)
        FIELD(RestageSelection1, size, 0) FIELD(RestageSelection1, instance_count, 4)
        FIELD(RestageSelection1, instances, 8)
    SIZE(RestageEditWriter1, 216)
        FIELD(RestageEditWriter1, size, 0) FIELD(RestageEditWriter1, ctx, 8)
        FIELD(RestageEditWriter1, add_mesh, 16) FIELD(RestageEditWriter1, add_image, 24)
        FIELD(RestageEditWriter1, add_texture, 32) FIELD(RestageEditWriter1, add_material, 40)
        FIELD(RestageEditWriter1, add_medium, 48) FIELD(RestageEditWriter1, add_group, 56)
        FIELD(RestageEditWriter1, add_instance, 64) FIELD(RestageEditWriter1, add_light, 72)
        FIELD(RestageEditWriter1, add_camera, 80) FIELD(RestageEditWriter1, set_transform, 88)
        FIELD(RestageEditWriter1, set_material, 96) FIELD(RestageEditWriter1, set_group, 104)
        FIELD(RestageEditWriter1, set_hidden, 112) FIELD(RestageEditWriter1, set_name, 120)
        FIELD(RestageEditWriter1, set_param, 128) FIELD(RestageEditWriter1, set_light, 136)
        FIELD(RestageEditWriter1, set_camera, 144) FIELD(RestageEditWriter1, set_active_camera, 152)
        FIELD(RestageEditWriter1, set_environment, 160) FIELD(RestageEditWriter1, remove, 168)
        FIELD(RestageEditWriter1, select, 176) FIELD(RestageEditWriter1, report, 184)
        FIELD(RestageEditWriter1, error, 192) FIELD(RestageEditWriter1, progress, 200)
        FIELD(RestageEditWriter1, material_table, 208)
    SIZE(RestageAction1, 56)
        FIELD(RestageAction1, size, 0) FIELD(RestageAction1, id, 8) FIELD(RestageAction1, label, 16)
        FIELD(RestageAction1, tooltip, 24) FIELD(RestageAction1, params, 32)
        FIELD(RestageAction1, param_count, 40) FIELD(RestageAction1, flags, 44)
        FIELD(RestageAction1, run, 48)
    SIZE(RestagePanel1, 48)
        FIELD(RestagePanel1, size, 0) FIELD(RestagePanel1, id, 8) FIELD(RestagePanel1, label, 16)
        FIELD(RestagePanel1, params, 24) FIELD(RestagePanel1, param_count, 32)
        FIELD(RestagePanel1, draw, 40)
    // clang-format on
};
#undef SIZE
#undef FIELD

} // namespace

TEST_CASE("sizes and offsets of the ABI are as released", "[abi]") {
    static_assert(sizeof(void*) == 8, "the table is of 64-bit platforms");
    for (const Frozen& f : layout) {
        INFO(f.what);
        CHECK(f.now == f.released);
    }
    CHECK(std::size(layout) > 200);
}

TEST_CASE("numbers and ids of the ABI are as released", "[abi]") {
    CHECK(RESTAGE_ABI == 2);
    CHECK(std::string(RESTAGE_PLUGIN_SYMBOL) == "restage_plugin");
    CHECK(std::string(RESTAGE_LOG) == "restage.log/1");
    CHECK(std::string(RESTAGE_MATERIAL1) == "restage.material/1");
    CHECK(std::string(RESTAGE_IMPORTER1) == "restage.importer/1");
    CHECK(std::string(RESTAGE_EXPORTER1) == "restage.exporter/1");
    CHECK(std::string(RESTAGE_DENOISER1) == "restage.denoiser/1");
    CHECK(std::string(RESTAGE_INSPECTOR1) == "restage.inspector/1");
    CHECK(std::string(RESTAGE_TABLE1) == "restage.table/1");
    CHECK(std::string(RESTAGE_ACTION1) == "restage.action/1");
    CHECK(std::string(RESTAGE_PANEL1) == "restage.panel/1");
    CHECK(std::string(RESTAGE_EMISSION1) == "restage.emission/1");
    CHECK(std::string(RESTAGE_SKY1) == "restage.sky/1");
    CHECK(std::string(RESTAGE_IMAGE_SERVICE) == "restage.image/1");
    const int types[] = {RESTAGE_FLOAT, RESTAGE_COLOR,    RESTAGE_INT,     RESTAGE_BOOL, RESTAGE_ENUM,
                         RESTAGE_TEXT,  RESTAGE_MATERIAL, RESTAGE_TEXTURE, RESTAGE_TABLE};
    for (int i = 0; i < 9; ++i)
        CHECK(types[i] == i + 1);
    const unsigned flags[] = {RESTAGE_MATERIAL_STOCHASTIC,    RESTAGE_MATERIAL_LOSSLESS, RESTAGE_MATERIAL_TRANSMISSIVE,
                              RESTAGE_MATERIAL_NONRECIPROCAL, RESTAGE_MATERIAL_NULL,     RESTAGE_MATERIAL_MIX,
                              RESTAGE_MATERIAL_TANGENT,       RESTAGE_MATERIAL_ADDITIVE, RESTAGE_MATERIAL_SITE};
    for (unsigned i = 0; i < 9; ++i)
        CHECK(flags[i] == 1u << i);
    CHECK(RESTAGE_PARAM_TEXTURABLE == 1u);
    CHECK(RESTAGE_PARAM_ADVANCED == 2u);
    CHECK(RESTAGE_ACTION_NEEDS_SELECTION == 1u);
    CHECK(RESTAGE_INSTANCE_TWO_SIDED == 8u);
    CHECK(RESTAGE_INSTANCE_EMITS_BY_MATERIAL == 16u);
    CHECK(RESTAGE_LIGHT_DISTANT == 3);
    CHECK(RESTAGE_KIND_CAMERA == 9);
}

TEST_CASE("plugins built for pre-release interfaces are refused with a remedy", "[abi]") {
    const fs::path folder = restage::test::build_dir() / "tests" / "plugins_old" / "0.1";
    test::PluginFolder lines;
    plugin::Registry registry(lines.log);
    registry.scan(std::vector<plugin::SearchPath>{{folder, true}});
    REQUIRE(registry.entries().size() == 1);
    CHECK(registry.entries()[0]->state == plugin::State::refused);
    CHECK(registry.entries()[0]->reason.find("\"kind\" and \"abi\" belong to Restage 0.1") != std::string::npos);
    // And with a current manifest and the old library: none of its code runs.
    REQUIRE(fs::exists(folder / "velvet.so"));
    lines.lines.clear();
    const fs::path where = lines.add("p", test::manifest(), nullptr);
    fs::copy_file(folder / "velvet.so", where / "velvet.so");
    CHECK(lines.refusal().find("was built for plugin interface 1, this program has 2") != std::string::npos);
    CHECK(std::none_of(lines.lines.begin(), lines.lines.end(),
                       [](const std::string& l) { return l.find("is here") != std::string::npos; }));
}
