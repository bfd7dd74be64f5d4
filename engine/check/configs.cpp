// SPDX-License-Identifier: Apache-2.0
#include "check/configs.hpp"

#include <algorithm>
#include <cmath>
#include <locale>
#include <numbers>
#include <set>
#include <sstream>

namespace restage::check {

using scene::ParamSet;
using scene::Value;

namespace {

template <class F>
void each_line(const model::Material& table, F&& f) {
    for (const model::Param& p : table.params)
        f(p);
}

// The upper or lower end of its range.
Value bound(const model::Param& p, bool upper) {
    const float x = upper ? p.max : p.min;
    switch (p.type) {
        case model::ParamType::color:
            return Value::color(x, x, x);
        case model::ParamType::integer:
            return Value::integer(upper ? p.int_max : p.int_min);
        default:
            return Value::number(x);
    }
}

} // namespace

float uniform(Engine& e, float lo, float hi) { return std::uniform_real_distribution<float>(lo, hi)(e); }

Vec3 direction(float z, float phi) {
    const float r = std::sqrt(std::max(0.f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

Vec3 from_degrees(double theta, double phi) {
    const double t = theta * std::numbers::pi / 180, p = phi * std::numbers::pi / 180;
    return {static_cast<float>(std::sin(t) * std::cos(p)), static_cast<float>(std::sin(t) * std::sin(p)),
            static_cast<float>(std::cos(t))};
}

Vec3 random_direction(Engine& e, float z_min) {
    const float z = uniform(e, z_min, 1);
    return direction(z, uniform(e, 0, 2 * std::numbers::pi_v<float>));
}

std::string choice(const model::Param& p, std::size_t i) { return i < p.choices.size() ? p.choices[i] : ""; }

std::size_t choices(const model::Param& p) { return p.choices.size(); }

void keep_sum(const model::Material& table, ParamSet& set) {
    if (!table.additive) return;
    float sum = 0;
    each_line(table, [&](const model::Param& p) {
        if (p.type != model::ParamType::color || is_opacity(p)) return;
        const auto c = set.color(p.id, {p.def[0], p.def[1], p.def[2]});
        sum += std::max({c[0], c[1], c[2]});
    });
    each_line(table, [&](const model::Param& p) {
        if (p.type != model::ParamType::color || is_opacity(p)) return;
        const auto c = set.color(p.id, {p.def[0], p.def[1], p.def[2]});
        const float s = 1 / std::max(1.f, sum);
        set.set(p.id, Value::color(c[0] * s, c[1] * s, c[2] * s));
    });
}

ParamSet random_values(model::ParamTable table, Engine& e) {
    ParamSet set;
    const auto between = [&](float min, float max) {
        const float x = uniform(e);
        return x < 0.1f ? min : x < 0.2f ? max : uniform(e, min, max);
    };
    const auto number = [&](const model::Param& p) { return between(p.min, p.max); };
    for (const model::Param& p : table) {
        switch (p.type) {
            case model::ParamType::number:
                set.set(p.id, Value::number(number(p)));
                break;
            case model::ParamType::color: {
                const float r = number(p), g = number(p), b = number(p);
                set.set(p.id, Value::color(r, g, b));
                break;
            }
            case model::ParamType::integer:
                set.set(p.id,
                        Value::integer(static_cast<int>(std::lround(between(float(p.int_min), float(p.int_max))))));
                break;
            case model::ParamType::boolean:
                set.set(p.id, Value::boolean(uniform(e) < 0.5f));
                break;
            case model::ParamType::choice:
                set.set(p.id, Value::choice(choice(p, e() % choices(p))));
                break;
            default:
                break;
        }
    }
    return set;
}

ParamSet random_config(const model::Material& table, Engine& e) {
    ParamSet set = random_values(table.params, e);
    keep_sum(table, set);
    return set;
}

ParamSet wide_config(const model::Material& table, Engine& e) {
    ParamSet set = random_config(table, e);
    each_line(table, [&](const model::Param& p) {
        if (is_roughness(p)) set.set(p.id, Value::number(uniform(e, 0.2f, 0.8f)));
        if (std::string_view(p.id) == "remap") set.set(p.id, Value::choice("none"));
        if (p.type == model::ParamType::integer) set.set(p.id, Value::integer(p.int_def));
    });
    return set;
}

ParamSet white_config(const model::Material& table) {
    ParamSet set;
    each_line(table, [&](const model::Param& p) {
        if (p.type == model::ParamType::color) set.set(p.id, Value::color(1, 1, 1));
    });
    keep_sum(table, set);
    return set;
}

ParamSet rough_config(const model::Material& table, float r, float r_other) {
    ParamSet set;
    bool second = false;
    each_line(table, [&](const model::Param& p) {
        if (!is_roughness(p) || p.type != model::ParamType::number) return;
        set.set(p.id, Value::number(std::clamp(second ? r_other : r, p.min, p.max)));
        second = !second;
    });
    return set;
}

std::vector<ParamSet> config_grid(const model::Material& table, Engine& e, std::size_t count) {
    std::vector<ParamSet> grid{{}};
    const auto add = [&](ParamSet set) {
        keep_sum(table, set);
        if (grid.size() < count && std::find(grid.begin(), grid.end(), set) == grid.end())
            grid.push_back(std::move(set));
    };
    add(rough_config(table, 0.1f, 0.4f));
    add(rough_config(table, 0.5f, 0.5f));
    add(wide_config(table, e));
    add(rough_config(table, 0.003f, 0.003f));
    add(rough_config(table, 1, 1));
    add(random_config(table, e));
    add(rough_config(table, 0, 0));
    const ParamSet base = rough_config(table, 0.3f, 0.3f);
    each_line(table, [&](const model::Param& p) {
        ParamSet set = base;
        if (p.type == model::ParamType::choice) {
            for (std::size_t i = 0; i < choices(p); ++i)
                if (i != static_cast<std::size_t>(p.int_def)) set.set(p.id, Value::choice(choice(p, i))), add(set);
        } else if (p.type == model::ParamType::boolean) {
            set.set(p.id, Value::boolean(p.int_def == 0)), add(set);
        } else if (p.type == model::ParamType::number || p.type == model::ParamType::integer ||
                   p.type == model::ParamType::color) {
            if (is_roughness(p)) return;
            for (const bool upper : {true, false})
                if (bound(p, upper).scalar() != scene::default_value(p).scalar())
                    set.set(p.id, bound(p, upper)), add(set);
        }
    });
    while (grid.size() < count && table.params.size() > 0) {
        const std::size_t before = grid.size();
        add(wide_config(table, e)), add(random_config(table, e));
        if (grid.size() == before) break; // nothing left in the table to draw at random
    }
    return grid;
}

std::string describe(const ParamSet& set) {
    if (set.entries().empty()) return "the defaults";
    std::ostringstream out;
    out.imbue(std::locale::classic()); // the global locale may use decimal commas
    out.precision(9);
    for (const auto& [id, v] : set.entries()) {
        out << (&id == &set.entries().front().id ? "" : " ") << id << '=';
        if (v.type == model::ParamType::choice || v.type == model::ParamType::table)
            out << v.text;
        else if (v.type == model::ParamType::color)
            out << '(' << v.v[0] << ' ' << v.v[1] << ' ' << v.v[2] << ')';
        else
            out << v.scalar();
    }
    return out.str();
}

std::string describe(const Vec3& v) {
    std::ostringstream out;
    out.imbue(std::locale::classic()); // the global locale may use decimal commas
    out.precision(9);
    out << '(' << v[0] << ", " << v[1] << ", " << v[2] << ')';
    return out.str();
}

std::string describe(const BsdfJob& job, const BsdfAnswer& a) {
    std::ostringstream out;
    out.imbue(std::locale::classic()); // the global locale may use decimal commas
    out.precision(9);
    out << "wo " << describe(job.wo) << " wi " << describe(job.wi) << " u " << describe(job.u) << " seed " << job.seed
        << " -> eval " << describe(a.eval) << " pdf " << a.pdf << " sample: wi " << describe(a.wi) << " weight "
        << describe(a.weight) << " pdf " << a.sample_pdf << " flags " << a.flags << " eta " << a.eta << " there: eval "
        << describe(a.eval_sampled) << " reverse " << describe(a.eval_reverse) << " albedo " << describe(a.albedo)
        << " pdf " << a.pdf_sampled;
    return out.str();
}

std::vector<scene::Value> ends(const model::Param& line) {
    std::vector<scene::Value> all;
    const auto add = [&](float x, int i) {
        scene::Value value = scene::default_value(line);
        if (line.type == model::ParamType::number || line.type == model::ParamType::color)
            std::fill_n(value.v.begin(), line.components(), x);
        else
            value.i = i;
        all.push_back(value);
    };
    switch (line.type) {
        case model::ParamType::number:
        case model::ParamType::color:
        case model::ParamType::integer:
            add(line.min, line.int_min), add(line.max, line.int_max);
            break;
        case model::ParamType::boolean:
            add(0, 0), add(0, 1);
            break;
        case model::ParamType::choice:
            for (const std::string& choice : line.choices)
                all.push_back(scene::Value::choice(choice));
            break;
        default:
            break;
    }
    return all;
}

} // namespace restage::check
