// SPDX-License-Identifier: Apache-2.0
#include "document/project_looks.hpp"

#include "io/sky.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace restage::document {

using namespace scene;

LookReader::LookReader(const std::string& file, const plugin::Registry& registry, const Scene& base,
                       std::map<std::string, std::uint32_t> sizes)
    : ValueReader(file), registry_(registry) {
    base_ = &base;
    sizes_ = std::move(sizes);
}

template <class T>
void LookReader::read_items(const json& look, Scene& state) {
    const char* plural = std::get<Kind<T>>(kinds).plural;
    const auto part = look.find(plural);
    if (part == look.end()) return;
    if (!part->is_object()) return error(plural, "expected an object");
    for (const auto& [key, members] : part->items()) {
        const auto id = resolve<T>(key, plural);
        const T* before = id ? table<T>(state).find(*id) : nullptr;
        if (!before) {
            if (id) lost_.push_back(fmt::format("{} \"{}\"", kind_name<T>, parse_ref(key)->name));
            continue;
        }
        T item = *before;
        json ignored = json::object();
        read_members(*this, members, item, key.c_str(), ignored);
        table<T>(state).set(*id, std::move(item), state.clock);
    }
}

Scene LookReader::read_look(const json& look, const Scene& scene) {
    Scene state = scene;
    ++state.clock;
    read_items<Texture>(look, state);
    read_items<Material>(look, state);
    read_items<Medium>(look, state);
    read_items<Instance>(look, state);
    read_items<Light>(look, state);
    read_items<Camera>(look, state);
    const auto single = [&](const char* name, auto& value) {
        if (const auto found = look.find(name); found != look.end()) read(*found, value, name);
    };
    single("environment", state.environment.value);
    single("active_camera", state.active_camera.value);
    single("film", state.film.value);
    return state;
}

void LookReader::make_sky(Scene& state, const Scene& scene, const std::string& name, io::Report& report) {
    const auto &sky = state.environment.value, &own = scene.environment.value;
    if (!sky || sky->sky.empty()) return;
    if (own && own->sky == sky->sky && own->sky_params == sky->sky_params && own->image == sky->image) return;
    const Image* image = state.images.find(sky->image);
    if (!image) return;
    auto made =
        std::ranges::find_if(skies_, [&](const Sky& s) { return s.type == sky->sky && s.params == sky->sky_params; });
    if (made == skies_.end()) {
        const auto plugin = io::find_sky(registry_, sky->sky);
        auto pixels = plugin ? io::make_sky(*plugin, sky->sky_params, {})
                             : Result<std::shared_ptr<const PixelData>>(fail("its plugin is missing"));
        if (!pixels)
            return report.add(io::Fate::approximated, "sky \"" + sky->sky + "\" of look \"" + name + "\"",
                              pixels.error().message + "; another picture replaces it, and its values are kept", file_);
        made = skies_.insert(skies_.end(), {sky->sky, sky->sky_params, std::move(*pixels)});
    }
    Image again = *image;
    again.data = made->pixels;
    state.images.set(sky->image, std::move(again), state.clock);
}

Result<std::shared_ptr<const Looks>> LookReader::run(const json& list, const Scene& scene, io::Report& report) {
    if (!list.is_array()) return fail(file_ + ": looks: expected a list");
    auto looks = std::make_shared<Looks>();
    for (const json& look : list) {
        const auto named = look.is_object() ? look.find("name") : look.end();
        if (!look.is_object() || named == look.end() || !named->is_string())
            return fail(fmt::format("{}: looks: number {} has no name", file_, looks->list.size() + 1));
        const std::string name = named->get<std::string>();
        if (looks->find(name)) return fail(fmt::format("{}: looks: two are called \"{}\"", file_, name));
        where_ = fmt::format("looks: {}", name);
        lost_.clear();
        Scene state = read_look(look, scene);
        if (!error_.empty()) return fail(error_);
        for (const std::string& what : lost_)
            report.add(io::Fate::dropped, what,
                       fmt::format("look \"{}\" changes it, but it is no longer in the scene", name), file_);
        make_sky(state, scene, name, report);
        if (const auto current = look.find("current"); current != look.end() && *current == true)
            looks->current = looks->list.size();
        looks->list.push_back({name, look_state(state)});
    }
    return looks;
}

} // namespace restage::document
