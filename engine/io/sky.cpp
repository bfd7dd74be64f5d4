// SPDX-License-Identifier: Apache-2.0
#include "io/sky.hpp"

#include "base/crash_note.hpp"
#include "io/scene_reader.hpp"
#include "plugin/abi.hpp"
#include "scene/params.hpp"

#include <restage/sky.h>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::io {

using namespace scene;

namespace {

constexpr std::size_t most_suns = 16;
constexpr std::uint32_t least_width = 512, most_width = 2048;
constexpr double least_texels = 4; // under a sun's disk
constexpr std::size_t guard = 64; // guard floats after the picture that must stay unchanged
constexpr float guard_value = -12345.5f;

struct Job { // behind RestageSkyJob1::ctx
    const Progress& progress;
    std::string error, bad_sun;
    std::vector<Sun> suns;
    bool stopped = false;

    static Job& self(void* ctx) { return *static_cast<Job*>(ctx); }
    static int on_progress(void* ctx, float done) {
        Job& job = self(ctx);
        if (job.progress && !job.progress(std::isfinite(done) ? done : 0, "sky")) job.stopped = true;
        return job.stopped ? 0 : 1;
    }
    static void on_sun(void* ctx, const RestageSkySun* given) {
        Job& job = self(ctx);
        const RestageSkySun in = given ? plugin::sized(*given) : RestageSkySun{};
        const glm::dvec3 direction(in.direction[0], in.direction[1], in.direction[2]);
        if (!(std::abs(glm::length(direction) - 1) < 1e-3))
            job.bad_sun = fmt::format("a sun's direction ({:g}, {:g}, {:g}) is not a unit vector", direction.x,
                                      direction.y, direction.z);
        else if (!(in.angular_radius > 0 && in.angular_radius <= float(std::numbers::pi / 2)))
            job.bad_sun = fmt::format("a sun's angular radius is {:g}", in.angular_radius);
        else if (!std::ranges::all_of(in.radiance, [](float x) { return std::isfinite(x) && x >= 0; }))
            job.bad_sun =
                fmt::format("a sun's radiance is ({:g}, {:g}, {:g})", in.radiance[0], in.radiance[1], in.radiance[2]);
        else if (job.suns.size() == most_suns)
            job.bad_sun = fmt::format("it has more than {} suns", most_suns);
        else
            job.suns.push_back(
                {glm::normalize(direction), {in.radiance[0], in.radiance[1], in.radiance[2]}, in.angular_radius});
    }
    static void on_error(void* ctx, const char* message) {
        Job& job = self(ctx);
        if (job.error.empty()) job.error = message && *message ? message : "no reason given";
    }
};

} // namespace

std::optional<plugin::SkyEntry> find_sky(const plugin::Registry& registry, std::string_view type) {
    const auto catalogue = registry.catalogue();
    const auto found = std::ranges::find_if(catalogue->skies, [&](const auto& s) { return s.table->type == type; });
    return found == catalogue->skies.end() ? std::nullopt : std::optional(*found);
}

Result<> check_sky_value(const model::Sky& sky, std::string_view id, const Value& value) {
    const std::string who = "sky \"" + sky.type + "\": parameter \"" + std::string(id) + "\"";
    const model::Param* line = sky.find(id);
    if (!line) {
        std::string known;
        for (const model::Param& p : sky.params)
            known += (known.empty() ? "" : ", ") + p.id;
        return fail(who + " is unknown; known: " + known);
    }
    if (const std::string why = misfit(*line, value); !why.empty()) return fail(who + why);
    return {};
}

Result<SkyPicture> sky_picture(const plugin::SkyEntry& sky, const ParamSet& values, std::uint32_t width,
                               const Progress& progress) {
    const std::string who = "sky \"" + sky.table->type + "\"";
    ParamSet all; // every parameter, set or default, in the table's order
    for (const model::Param& line : sky.table->params) {
        const Value* given = values.find(line.id);
        all.set(line.id, given && misfit(line, *given).empty() ? *given : default_value(line));
    }
    const std::vector<RestageValue> list = give_values(all);
    SkyPicture out;
    out.pixels = {.width = width, .height = width, .channels = 3, .values = {}};
    const std::size_t numbers = std::size_t{width} * width * 3;
    out.pixels.values.resize(numbers);
    out.pixels.values.resize(numbers + guard, guard_value);
    Job job{progress, {}, {}, {}};
    const RestageSkyJob1 given{.width = width,
                               .pixels = out.pixels.values.data(),
                               .ctx = &job,
                               .progress = Job::on_progress,
                               .sun = Job::on_sun,
                               .error = Job::on_error};
    bool made = false;
    {
        const CrashNote note(sky.plugin->blame("while it made a sky"));
        made = sky.native->make(list.data(), static_cast<std::uint32_t>(list.size()), &given) != 0;
    }
    if (job.stopped) return cancelled(who + ": stopped on request");
    if (!job.error.empty()) return fail(who + ": " + job.error);
    if (!made) return fail(who + " failed without giving a reason");
    if (!job.bad_sun.empty()) return fail(who + ": " + job.bad_sun);
    if (std::ranges::any_of(out.pixels.values.begin() + std::ptrdiff_t(numbers), out.pixels.values.end(),
                            [](float x) { return x != guard_value; }))
        return fail(fmt::format("{} writes past the end of its picture, {}x{}", who, width, width));
    out.pixels.values.resize(numbers);
    for (std::size_t i = 0; i < out.pixels.values.size(); ++i)
        if (const float x = out.pixels.values[i]; !std::isfinite(x) || x < 0)
            return fail(fmt::format("{}: texel ({}, {}) of {}x{} is {:g}", who, i / 3 % width, i / 3 / width, width,
                                    width, std::isnan(x) ? std::abs(x) : x));
    out.suns = std::move(job.suns);
    return out;
}

Result<std::shared_ptr<const PixelData>> make_sky(const plugin::SkyEntry& sky, const ParamSet& values,
                                                  const Progress& progress) {
    std::uint32_t width = least_width;
    RESTAGE_TRY(SkyPicture picture, sky_picture(sky, values, width, progress));
    const auto too_coarse = [&](const Sun& sun) {
        return solid_angle(sun) * width * width < least_texels * 4 * std::numbers::pi;
    };
    while (width < most_width && std::ranges::any_of(picture.suns, too_coarse))
        width *= 2;
    if (width != least_width) {
        RESTAGE_TRY(picture, sky_picture(sky, values, width, progress));
    }
    for (const Sun& sun : picture.suns)
        draw_sun(picture.pixels, sun);
    return std::make_shared<const PixelData>(std::move(picture.pixels));
}

void make_missing_sky(Scene& scene, const plugin::Registry& registry, Report& report, const Progress& progress) {
    auto& environment = scene.environment.value;
    if (!environment || environment->sky.empty() || environment->image) return;
    const std::string who = "sky \"" + environment->sky + "\"";
    const auto sky = find_sky(registry, environment->sky);
    if (!sky) return report.add(Fate::approximated, who, "its plugin is missing; it is a single colour");
    auto pixels = make_sky(*sky, environment->sky_params, progress);
    if (!pixels) return report.add(Fate::approximated, who, pixels.error().message + "; it is a single colour");
    environment->image = scene.images.next();
    environment->mapping = scene::Mapping::octahedral;
    scene.images.set(environment->image,
                     Image{.name = sky->table->label, .encoding = scene::Encoding::linear, .data = std::move(*pixels)},
                     scene.clock);
}

} // namespace restage::io
