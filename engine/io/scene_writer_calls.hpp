// SPDX-License-Identifier: Apache-2.0
// Private to SceneWriter: the C functions behind its table. They are thin: each converts a C struct, checks
// it and pushes it.
#pragma once

#include "io/scene_writer.hpp"
#include "scene/tables.hpp"
#include "scene/validate.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace restage::io {

struct SceneWriter::Calls {
    template <class F>
    static RestageHandle guarded(void* ctx, const char* what, F&& f) noexcept {
        return Exchange::guarded<SceneWriter>(ctx, what, std::forward<F>(f));
    }

    // scene_writer_shapes.cpp
    static RestageHandle mesh(void* ctx, const RestageMesh* in);
    static RestageHandle group(void* ctx, const RestageGroup* in);
    static RestageHandle instance(void* ctx, const RestageInstance* in);

    // scene_writer_materials.cpp
    static RestageHandle image(void* ctx, const RestageImage* in);
    static RestageHandle texture(void* ctx, const RestageTexture* in);
    static RestageHandle material(void* ctx, const RestageMaterialDesc* in);
    static RestageHandle medium(void* ctx, const RestageMedium* in);

    // scene_writer_view.cpp
    static RestageHandle light(void* ctx, const RestageLight* in);
    static void environment(void* ctx, const RestageEnvironment* in);
    static RestageHandle camera(void* ctx, const RestageCamera* in);
    static void camera_medium(void* ctx, RestageHandle medium);
    static void film(void* ctx, const RestageFilm* in);
    static void settings(void* ctx, const RestageSettings* in);

    // scene_writer.cpp
    static void report(void* ctx, int fate, const char* file, std::uint32_t line, const char* what, const char* note);
    static void error(void* ctx, const char* file, std::uint32_t line, std::uint32_t column, const char* message);
    static int progress(void* ctx, float done, const char* what);
    static const RestageParam* material_table(void* ctx, const char* type, std::uint32_t* count);
    static const RestageParam* texture_table(void* ctx, const char* type, std::uint32_t* count);
};

template <class T>
RestageHandle SceneWriter::push(T item) {
    auto& slots = scene::table<T>(scene);
    const scene::Id<T> id = slots.next();
    slots.set(id, std::move(item), scene.clock);
    return id.value;
}

template <class T>
bool SceneWriter::known(RestageHandle handle, const char* who_kind, const std::string& who, bool needed) {
    if (handle == 0 ? !needed : scene::table<T>(scene).find({handle}) != nullptr) return true;
    refuse(std::string(who_kind) + " \"" + who + "\"",
           handle == 0 ? std::string("it has no ") + scene::kind_name<T>
                       : std::string("there is no ") + scene::kind_name<T> + " " + std::to_string(handle));
    return false;
}

template <class... X>
bool finite(X... x) {
    return (std::isfinite(x) && ...);
}
inline bool finite3(const float* v) { return finite(v[0], v[1], v[2]); }

inline bool affine(const glm::dmat4& m) {
    return scene::is_finite(m) && m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
}

} // namespace restage::io
