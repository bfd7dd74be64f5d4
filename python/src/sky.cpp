// SPDX-License-Identifier: Apache-2.0
// Skies of plugins.
#include "document/sky.hpp"
#include "io/sky.hpp"
#include "pulse.hpp"
#include "scene/sky_blur.hpp"
#include "values.hpp"

#include <shared_mutex>

namespace restage::python {

using namespace scene;
using Shared = std::shared_ptr<Workspace>;

namespace {

void make_sky(const Shared& w, const std::string& type, const nb::kwargs& values) {
    const auto plugin = io::find_sky(w->host().registry(), type);
    if (!plugin) throw Failure("there is no sky \"" + type + "\"; " + document::known_skies(w->host().registry()));
    ParamSet set;
    for (const auto& [key, value] : values) {
        const auto id = nb::cast<std::string>(key);
        const model::Param* line = plugin->table->find(id);
        if (!line) take(io::check_sky_value(*plugin->table, id, {})); // lists the known ones
        set.set(id, to_value(w.get(), line->type, value, "parameter \"" + id + "\""));
    }
    Pulse pulse([] { return true; });
    auto edit = [&] {
        const Scene before = w->scene();
        const glm::dvec3 up = w->up();
        const nb::gil_scoped_release release;
        const std::shared_lock plugins(w->host().in_use());
        return document::plugin_sky(before, w->host().registry(), type, set, up,
                                    [&](float, std::string_view) { return pulse.keep_going(); });
    }();
    pulse.rethrow();
    w->host().flush_log();
    w->edit(take(std::move(edit)));
}

void blur(const Shared& w, double degrees) {
    auto edit = [&] {
        const Scene before = w->scene();
        const nb::gil_scoped_release release;
        return blur_sky(before, degrees);
    }();
    w->edit(take(std::move(edit)));
}

} // namespace

void bind_sky(nb::class_<Workspace>& c) {
    c.def("make_sky", &make_sky, "type"_a, "values"_a,
          "The sky of a plugin: make_sky(\"sunsky\", elevation=12, turbidity=4). restage.sky_types() lists them and "
          "their\n"
          "parameters. If the sky is already of that type, other values are kept.",
          nb::sig("def make_sky(self, type: str, **values: float | bool | str | collections.abc.Sequence[float]) -> "
                  "None"));
    c.def(
        "blur_sky", &blur, "degrees"_a,
        "Softens the sky's image by a Gaussian of this standard deviation, 0.5 to 180; its light stays. Error: it has "
        "no image.");
}

} // namespace restage::python
