// SPDX-License-Identifier: Apache-2.0
// Skies: radiance is finite and not negative for any values and size; the same values give the same image; each
// parameter has an effect; a sky can be cancelled; nothing leaks.
#include "check/configs.hpp"
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "io/sky.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace restage::check {
namespace {

using scene::ParamSet;
using scene::Value;

struct Lab {
    Subject& s;
    const model::Sky& sky = *s.sky.table;
    model::Material as_material = {}; // for random_config, which uses only the parameters
    std::size_t runs = 0;

    explicit Lab(Subject& subject) : s(subject) { as_material.params = sky.params; }

    ParamSet random(Engine& e) { return random_config(as_material, e); }
    ParamSet corner(Engine& e) { // every line at one of its ends
        ParamSet set;
        for (const model::Param& line : sky.params)
            if (const auto all = ends(line); !all.empty()) set.set(line.id, all[e() % all.size()]);
        return set;
    }
    Result<io::SkyPicture> make(const ParamSet& set, std::uint32_t width, const io::Progress& progress = {}) {
        s.doing(fmt::format("make() of {}x{} texels with {}", width, width, check::describe(set)));
        ++runs;
        auto made = io::sky_picture(s.sky, set, width, progress);
        s.alive();
        return made;
    }
    std::string at(const ParamSet& set) const { return "; " + check::describe(set); }
};

bool same(const io::SkyPicture& a, const io::SkyPicture& b) {
    return a.pixels.values == b.pixels.values &&
           std::ranges::equal(a.suns, b.suns, [](const io::Sun& x, const io::Sun& y) {
               return x.direction == y.direction && x.radiance == y.radiance && x.angular_radius == y.angular_radius;
           });
}

} // namespace

Result<StepResult> check_sky(Subject& s) {
    Lab lab(s);
    Engine e = s.random("sky");
    std::vector<ParamSet> sets{{}};
    for (const model::Param& line : lab.sky.params)
        for (const Value& value : ends(line)) {
            ParamSet set;
            set.set(line.id, value);
            sets.push_back(std::move(set));
        }
    for (std::size_t i = 0; i < s.size(200, 40); ++i)
        sets.push_back(i % 2 ? lab.random(e) : lab.corner(e));
    std::size_t suns = 0;
    for (std::size_t i = 0; i < sets.size(); ++i) {
        const std::uint32_t width = i % 4 == 0 ? 64 : i % 4 == 1 ? 33 : i % 4 == 2 ? 7 : 1;
        const auto made = lab.make(sets[i], width);
        if (!made) return StepResult::failed(made.error().message + lab.at(sets[i]));
        suns += made->suns.size();
        const auto again = lab.make(sets[i], width);
        if (!again || !same(*made, *again))
            return StepResult::failed("the same values give two different skies" + lab.at(sets[i]));
    }
    for (const std::uint32_t width : {2u, 3u, 5u, 100u, 257u, 512u})
        if (const auto made = lab.make({}, width); !made) return StepResult::failed(made.error().message);
    return StepResult::passed({{"skies", double(lab.runs)}, {"suns", double(suns)}});
}

Result<StepResult> check_sky_params(Subject& s) {
    Lab lab(s);
    Engine e = s.random("sky-params");
    std::string idle;
    for (const model::Param& line : lab.sky.params) {
        const auto all = ends(line);
        bool matters = all.size() < 2;
        for (std::size_t k = 0; !matters && k < 48; ++k) { // with others at random, as one may hide its effect
            ParamSet set = k == 0 ? ParamSet() : lab.random(e);
            set.set(line.id, all[0]);
            auto first = lab.make(set, 24);
            set.set(line.id, all[1 + k % (all.size() - 1)]);
            // The ends of an angle may be equal: then a value between them.
            if (k % 2 && line.type == model::ParamType::number)
                set.set(line.id, Value::number(line.min + (line.max - line.min) * (0.1f + 0.8f * float(k) / 48)));
            auto second = lab.make(set, 24);
            if (!first || !second) return StepResult::failed((first ? second : first).error().message + lab.at(set));
            matters = !same(*first, *second);
        }
        if (!matters) idle += (idle.empty() ? "" : ", ") + line.id;
    }
    if (!idle.empty()) return StepResult::failed("no effect anywhere in the range of: " + idle);
    return StepResult::passed({{"parameters", double(lab.sky.params.size())}, {"skies", double(lab.runs)}});
}

Result<StepResult> check_sky_stop(Subject& s) {
    constexpr std::size_t patience = 3;
    constexpr std::uint32_t width = 256;
    Lab lab(s);
    std::size_t calls = 0, stop_at = ~std::size_t{0};
    const auto progress = [&](float, std::string_view) { return ++calls < stop_at; };
    if (const auto made = lab.make({}, width, progress); !made) return StepResult::failed(made.error().message);
    const std::size_t all = calls;
    for (std::size_t k = 1; k <= all; k += std::max<std::size_t>(all / s.size(64, 16), 1)) {
        calls = 0, stop_at = k;
        const auto made = lab.make({}, width, progress);
        if (made) return StepResult::failed(fmt::format("stopped at call {} of progress(), it still returns a sky", k));
        if (!made.error().cancelled()) return StepResult::failed(made.error().message);
        if (calls > k + patience)
            return StepResult::failed(
                fmt::format("after progress() returned 0, it was called {} more times", calls - k));
    }
    return StepResult::passed({{"calls of progress()", double(all)}, {"skies", double(lab.runs)}},
                              all == 0 ? "it never calls progress(), so it cannot be stopped" : "");
}

Result<StepResult> check_sky_runs(Subject& s) {
    Lab lab(s);
    return check_nothing_left("making a sky", [&]() -> Result<> {
        RESTAGE_CHECK(lab.make({}, 64));
        return {};
    });
}

} // namespace restage::check
