// SPDX-License-Identifier: Apache-2.0
#include "pbrt_writer.hpp"

#include <unistd.h>
#include <atomic>

namespace restage::pbrt::test {

namespace {

Recorder& self(void* ctx) { return *static_cast<Recorder*>(ctx); }

ValueMap copy(const RestageValue* values, std::uint32_t count) {
    ValueMap out;
    for (std::uint32_t i = 0; i < count; ++i) {
        const RestageValue& value = values[i];
        Value& to = out[value.id];
        to.type = value.type;
        to.ref = value.ref;
        for (std::size_t k = 0; k < 4; ++k)
            to.v[k] = value.v[k];
        if (value.type == RESTAGE_INT || value.type == RESTAGE_BOOL) to.v[0] = static_cast<float>(value.i);
        if (value.text) to.text = value.text;
    }
    return out;
}

std::string name_of(const char* name) { return name ? name : ""; }

// The kept lines, values ("=id text") first.
std::string lines_of(const RestageOrigin* origin) {
    std::string out;
    for (std::uint32_t i = 0; origin && i < origin->value_count; ++i)
        out += "=" + std::string(origin->values[i].id) + " " + origin->values[i].text + "\n";
    return origin && origin->verbatim ? out + origin->verbatim : out;
}

template <class T>
RestageHandle handle(const std::vector<T>& list) {
    return static_cast<RestageHandle>(list.size());
}

} // namespace

RestageSceneWriter1 Recorder::table() {
    RestageSceneWriter1 w{};
    w.size = sizeof w;
    w.ctx = this;
    w.mesh = [](void* c, const RestageMesh* m) {
        MeshRecord r{name_of(m->name), m->source_file, m->primitive, {}, {}, {}, {}};
        r.positions.assign(m->positions, m->positions + 3 * std::size_t(m->vertex_count));
        if (m->normals) r.normals.assign(m->normals, m->normals + 3 * std::size_t(m->vertex_count));
        if (m->uvs) r.uvs.assign(m->uvs, m->uvs + 2 * std::size_t(m->vertex_count));
        r.indices.assign(m->indices, m->indices + 3 * std::size_t(m->triangle_count));
        self(c).meshes.push_back(std::move(r));
        return handle(self(c).meshes);
    };
    w.image = [](void* c, const RestageImage* i) {
        Named n{.name = name_of(i->name), .path = i->path, .encoding = i->encoding, .gamma = i->gamma};
        self(c).images.push_back(std::move(n));
        return handle(self(c).images);
    };
    w.texture = [](void* c, const RestageTexture* t) {
        Named n{.name = name_of(t->name),
                .type = t->type,
                .verbatim = lines_of(t->origin),
                .values = copy(t->values, t->value_count),
                .image = t->image,
                .is_float = t->is_float != 0};
        self(c).textures.push_back(std::move(n));
        return handle(self(c).textures);
    };
    w.material = [](void* c, const RestageMaterialDesc* m) {
        Named n{.name = name_of(m->name),
                .type = m->type,
                .verbatim = lines_of(m->origin),
                .values = copy(m->values, m->value_count)};
        self(c).materials.push_back(std::move(n));
        return handle(self(c).materials);
    };
    w.medium = [](void* c, const RestageMedium* m) {
        self(c).media.push_back({.name = name_of(m->name), .verbatim = lines_of(m->origin)});
        self(c).raw_media.push_back(*m);
        return handle(self(c).media);
    };
    w.group = [](void* c, const RestageGroup* g) {
        self(c).groups.push_back({.name = name_of(g->name)});
        return handle(self(c).groups);
    };
    w.instance = [](void* c, const RestageInstance* i) {
        self(c).instances.push_back({name_of(i->name), lines_of(i->origin), *i});
        return handle(self(c).instances);
    };
    w.light = [](void* c, const RestageLight* l) {
        self(c).lights.push_back({.name = name_of(l->name), .verbatim = lines_of(l->origin)});
        self(c).raw_lights.push_back(*l);
        return handle(self(c).lights);
    };
    w.environment = [](void* c, const RestageEnvironment* e) { self(c).environments.push_back(*e); };
    w.camera = [](void* c, const RestageCamera* k) {
        self(c).cameras.push_back({.name = name_of(k->name), .verbatim = lines_of(k->origin)});
        self(c).raw_cameras.push_back(*k);
        return handle(self(c).cameras);
    };
    w.camera_medium = [](void* c, RestageHandle h) { self(c).camera_medium = h; };
    w.film = [](void* c, const RestageFilm* f) {
        self(c).film = *f;
        self(c).film_filter = f->filter;
        self(c).film_name = f->filename;
    };
    w.settings = [](void* c, const RestageSettings* s) {
        self(c).settings = *s;
        self(c).settings_text = lines_of(s->origin);
    };
    w.report = [](void* c, int fate, const char* file, std::uint32_t line, const char* what, const char* note) {
        self(c).lines.push_back({fate, file, line, what, note});
    };
    w.error = [](void* c, const char* file, std::uint32_t line, std::uint32_t column, const char* message) {
        if (self(c).error.set) return;
        self(c).error = {true, file, message, line, column};
    };
    w.progress = [](void* c, float, const char*) {
        Recorder& r = self(c);
        return r.stop_after >= 0 && ++r.progress_calls > r.stop_after ? 0 : 1;
    };
    w.material_table = [](void*, const char*, std::uint32_t*) -> const RestageParam* { return nullptr; };
    return w;
}

int Recorder::load_text(const std::string& text, const std::string& name) {
    const Folder folder;
    return load_file(folder.file(name, text));
}

std::string Folder::file(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
}

} // namespace restage::pbrt::test
