// SPDX-License-Identifier: Apache-2.0
// The GLSL of each closed-form material against the formula of its paper in double precision (bsdf_reference.hpp), at
// random parameters and directions, both anywhere and inside the material's own lobes.
#include "gpu/bench.hpp"
#include "gpu/bsdf_reference.hpp"

#include <catch2/catch_test_macros.hpp>

#include <functional>

using namespace restage;
using namespace restage::test;
namespace ref = restage::test::reference;
using ref::Alpha;
using ref::V;

namespace {

V vec(const Vec3& v) { return ref::normalize({v[0], v[1], v[2]}); }
V mirrored(V w) { return {w.x, w.y, -w.z}; }

// A parameter set in the form of a reference formula.
struct Params {
    const scene::ParamSet& set;
    const model::Material& table;
    const model::Param& line(const char* id) const {
        return *std::find_if(table.params.begin(), table.params.end(),
                             [&](const model::Param& p) { return std::string_view(p.id) == id; });
    }
    double number(const char* id) const { return set.number(id, line(id).def[0]); }
    bool flag(const char* id) const { return number(id) != 0; }
    double color(const char* id, int channel) const {
        const auto& d = line(id).def;
        return set.color(id, {d[0], d[1], d[2]})[static_cast<std::size_t>(channel)];
    }
    int index(const char* id) const {
        const auto c = set.choice(id, choice(line(id), static_cast<std::size_t>(line(id).int_def)));
        return line(id).choice_index(c).value();
    }
    Alpha alpha(const char* u, const char* v, double least = 0) const {
        const int remap = index("remap");
        return {std::max(least, ref::roughness_to_alpha(number(u), remap)),
                std::max(least, ref::roughness_to_alpha(number(v), remap))};
    }
};

using Formula = std::function<double(const Params&, V wo, V wi, int channel)>; // f |cos wi|

struct Comparison {
    int compared = 0, bad = 0;
    double worst = 0;
    std::ostringstream examples; // of failures
};

// `prepare` draws the configurations; at least `least` values must have been compared.
void compare(const char* type, const Formula& formula, const std::function<void(scene::ParamSet&, Engine&)>& prepare,
             int least = 2000) {
    Bench& bench = Bench::get();
    BsdfLab lab(bench, bench.material(type));
    Engine e(11);
    std::vector<scene::ParamSet> configs;
    for (int i = 0; i < 1500; ++i) {
        configs.push_back(random_config(lab.table(), e));
        prepare(configs.back(), e);
    }
    std::vector<BsdfJob> jobs(6000);
    for (BsdfJob& job : jobs)
        job = {.wo = random_direction(e), .wi = random_direction(e), .u = unit3(e), .config = e() % 1500};
    const auto answers = lab.run(configs, jobs);
    Comparison c;
    const auto check = [&](std::size_t i, const Vec3& wi, const Vec3& value) {
        const Params params{configs[jobs[i].config], lab.table()};
        if (std::abs(wi[2]) < 1e-3f || std::abs(jobs[i].wo[2]) < 1e-3f) return;
        for (int k = 0; k < 3; ++k) {
            const double expected = formula(params, vec(jobs[i].wo), vec(wi), k);
            // The last term: where F is 0, single precision leaves some 1e-8 of a lobe that may be 1e3 high.
            const double scale = expected + 1e-3 + 1e-4 * std::max({value[0], value[1], value[2]});
            const double error = std::abs(value[static_cast<std::size_t>(k)] - expected) / scale;
            c.compared += expected > 1e-3;
            c.worst = std::max(c.worst, error);
            // exp(-(tan/alpha)^2) at alpha 1e-3 in transmission: the rounding of wo + eta wi (and of 1/eta, seen from
            // inside) alone moves it by at most 2.9e-4 at eta 1.5, but 4.4e-3 at eta 1.05, where they nearly cancel
            // (2e5 directions in float against double, D > 1e-3). A fused product would fix the first cause only.
            if (!(error < 2.5e-3) && ++c.bad <= 3)
                c.examples << "channel " << k << ": expected " << expected << " for wi " << wi[0] << ' ' << wi[1] << ' '
                           << wi[2] << "\n  " << describe(jobs[i], answers[i]) << "\n  "
                           << describe(configs[jobs[i].config]) << '\n';
        }
    };
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        check(i, jobs[i].wi, answers[i].eval);
        if (answers[i].flags != 0 && !(answers[i].flags & delta)) check(i, answers[i].wi, answers[i].eval_sampled);
    }
    INFO(type << ": " << c.compared << " values compared, worst relative error " << c.worst << '\n'
              << c.examples.str());
    CHECK(c.compared >= least);
    CHECK(c.bad == 0);
}

// Roughnesses whose alpha is at least 0.02, so that single precision can match double precision.
void rough(scene::ParamSet& set, Engine& e) {
    for (const char* id : {"uroughness", "vroughness", "roughness"})
        if (set.find(id)) set.set(id, scene::Value::number(uniform(e, 0.02f, 1.f)));
}

// The papers' formulas are single scattering; multiple scattering is tested in multiscatter_test.cpp.
void single(scene::ParamSet& set) { set.set("multiscatter", scene::Value::boolean(false)); }

// No index of 0, for which the complex formula is undefined.
void dense(scene::ParamSet& set, Engine& e) {
    set.set("eta", scene::Value::color(uniform(e, 0.05f, 10), uniform(e, 0.05f, 10), uniform(e, 0.05f, 10)));
}

double clamped(double x) { return std::clamp(x, 0.0, 1.0); }
bool same_side(V a, V b) { return a.z * b.z > 0; }
V up(V w) { return {w.x, w.y, std::abs(w.z)}; }

} // namespace

TEST_CASE("diffuse: Lambert and Oren-Nayar against their papers", "[materials]") {
    compare(
        "diffuse",
        [](const Params& p, V wo, V wi, int k) {
            if (!same_side(wo, wi)) return 0.0;
            const double sigma = p.number("sigma") * ref::pi / 180, s2 = sigma * sigma;
            const double a = 1 - s2 / (2 * (s2 + 0.33)), b = 0.45 * s2 / (s2 + 0.09);
            const double to = std::acos(std::abs(wo.z)), ti = std::acos(std::abs(wi.z));
            const double cos_dphi = std::cos(std::atan2(wi.y, wi.x) - std::atan2(wo.y, wo.x));
            const double oren =
                a + b * std::max(0.0, cos_dphi) * std::sin(std::max(to, ti)) * std::tan(std::min(to, ti));
            return clamped(p.color("reflectance", k)) / ref::pi * oren * std::abs(wi.z);
        },
        [](scene::ParamSet&, Engine&) {});
}

TEST_CASE("diffusetransmission against its definition", "[materials]") {
    compare(
        "diffusetransmission",
        [](const Params& p, V wo, V wi, int k) {
            return p.color(same_side(wo, wi) ? "reflectance" : "transmittance", k) / ref::pi * std::abs(wi.z);
        },
        [](scene::ParamSet&, Engine&) {});
}

TEST_CASE("conductor: GGX and Beckmann with complex Fresnel against Walter and Heitz", "[materials]") {
    compare(
        "conductor",
        [](const Params& p, V wo, V wi, int k) {
            if (!same_side(wo, wi)) return 0.0;
            Alpha a = p.alpha("uroughness", "vroughness");
            a.beckmann = p.index("distribution") == 1;
            std::complex<double> eta(p.color("eta", k), p.color("k", k));
            if (p.flag("use_reflectance")) {
                const double r = std::min(p.color("reflectance", k), 0.9999);
                eta = {1, 2 * std::sqrt(r) / std::sqrt(1 - r)};
            }
            return ref::microfacet_reflection(up(wo), up(wi), a, eta);
        },
        [](scene::ParamSet& set, Engine& e) {
            rough(set, e);
            dense(set, e);
            single(set);
        });
}

TEST_CASE("dielectric: rough reflection and transmission against Walter", "[materials]") {
    compare(
        "dielectric",
        [](const Params& p, V wo, V wi, int k) {
            Alpha a = p.alpha("uroughness", "vroughness");
            a.beckmann = p.index("distribution") == 1;
            double eta = p.number("eta");
            if (wo.z < 0) {
                eta = 1 / eta;
                wo = mirrored(wo), wi = mirrored(wi);
            }
            return wi.z > 0 ? p.color("reflectance", k) * ref::microfacet_reflection(wo, wi, a, eta)
                            : p.color("transmittance", k) * ref::microfacet_transmission(wo, wi, a, eta);
        },
        [](scene::ParamSet& set, Engine& e) {
            rough(set, e);
            single(set);
            set.set("thin", scene::Value::boolean(false));
            set.set("eta", scene::Value::number(uniform(e, 1.1f, 3.f)));
        });
}

TEST_CASE("substrate against Ashikhmin and Shirley", "[materials]") {
    compare(
        "substrate",
        [](const Params& p, V wo, V wi, int k) {
            if (!same_side(wo, wi)) return 0.0;
            wo = up(wo), wi = up(wi);
            const double kd = p.color("kd", k), ks = p.color("ks", k);
            const V h = ref::normalize(wo + wi);
            const double diffuse =
                28 * kd / (23 * ref::pi) * (1 - ks) * (1 - std::pow(1 - wi.z / 2, 5)) * (1 - std::pow(1 - wo.z / 2, 5));
            const double schlick = ks + (1 - ks) * std::pow(1 - ref::dot(wi, h), 5);
            const double specular = ref::distribution(h, p.alpha("uroughness", "vroughness", 1e-3)) * schlick /
                                    (4 * ref::dot(wi, h) * std::max(wi.z, wo.z));
            return (diffuse + specular) * wi.z;
        },
        rough);
}

TEST_CASE("plastic, uber and translucent against pbrt-v3's definitions", "[materials]") {
    compare(
        "plastic",
        [](const Params& p, V wo, V wi, int k) {
            if (!same_side(wo, wi)) return 0.0;
            const double eta = wo.z > 0 ? 1 / 1.5 : 1.5;
            return p.color("kd", k) / ref::pi * std::abs(wi.z) +
                   p.color("ks", k) *
                       ref::microfacet_reflection(up(wo), up(wi), p.alpha("roughness", "roughness", 1e-3), eta);
        },
        rough);
    compare(
        "uber",
        [](const Params& p, V wo, V wi, int k) { // its other lobes are delta
            if (!same_side(wo, wi)) return 0.0;
            const double eta = wo.z > 0 ? p.number("eta") : 1 / p.number("eta");
            return p.color("opacity", k) *
                   (p.color("kd", k) / ref::pi * std::abs(wi.z) +
                    p.color("ks", k) *
                        ref::microfacet_reflection(up(wo), up(wi), p.alpha("uroughness", "vroughness", 1e-3), eta));
        },
        rough);
    compare(
        "translucent",
        [](const Params& p, V wo, V wi, int k) {
            const double eta = wo.z > 0 ? 1.5 : 1 / 1.5;
            const Alpha a = p.alpha("roughness", "roughness", 1e-3);
            const bool reflects = same_side(wo, wi);
            if (wo.z < 0) wo = mirrored(wo), wi = mirrored(wi);
            const double glossy =
                reflects ? ref::microfacet_reflection(wo, wi, a, eta) : ref::microfacet_transmission(wo, wi, a, eta);
            return p.color(reflects ? "reflect" : "transmit", k) *
                   (p.color("kd", k) / ref::pi * std::abs(wi.z) + p.color("ks", k) * glossy);
        },
        rough);
}

TEST_CASE("principled: anisotropic metal under a thin film against Belcour and Barla", "[materials]") {
    compare(
        "principled",
        [](const Params& p, V wo, V wi, int k) {
            if (!same_side(wo, wi)) return 0.0;
            const double a = p.number("roughness") * p.number("roughness"), s = p.number("anisotropy");
            const double angle = p.number("anisotropy_rotation") * ref::pi / 180; // of the surface against the light
            const auto turned = [&](V w) {
                const double phi = std::atan2(w.y, w.x) - angle, r = std::hypot(w.x, w.y);
                return V{r * std::cos(phi), r * std::sin(phi), std::abs(w.z)};
            };
            const Alpha alpha{a + (1 - a) * s * s, a};
            wo = turned(wo), wi = turned(wi);
            const V h = ref::normalize(wo + wi);
            const double c = ref::dot(wo, h), base = p.color("base_color", k), share = p.number("iridescence");
            const auto film =
                ref::thin_film(c, p.number("iridescence_ior"), p.number("iridescence_thickness"),
                               {p.color("base_color", 0), p.color("base_color", 1), p.color("base_color", 2)});
            const double f = (1 - share) * ref::schlick(base, 1, c) + share * film[static_cast<std::size_t>(k)];
            return f * ref::distribution(h, alpha) * ref::g2(wo, wi, alpha) / (4 * wo.z);
        },
        [](scene::ParamSet& set, Engine& e) {
            single(set);
            set.set("roughness", scene::Value::number(uniform(e, 0.2f, 1.f)));
            set.set("metallic", scene::Value::number(1));
            set.set("clearcoat", scene::Value::number(0));
            set.set("sheen_color", scene::Value::color(0, 0, 0));
            set.set("anisotropy_rotation", scene::Value::number(uniform(e, -180, 180)));
            if (e() % 2) set.set("iridescence_thickness", scene::Value::number(uniform(e, 0, 60))); // where it begins
        });
}

TEST_CASE("principled: sheen against Estevez and Kulla", "[materials]") {
    compare(
        "principled",
        [](const Params& p, V wo, V wi, int k) {
            const double r = p.number("sheen_roughness") * p.number("sheen_roughness");
            return same_side(wo, wi) ? p.color("sheen_color", k) * ref::sheen(up(wo), up(wi), r) : 0.0;
        },
        [](scene::ParamSet& set, Engine& e) {
            single(set);
            for (const char* id : {"metallic", "transmission", "clearcoat", "specular", "iridescence"})
                set.set(id, scene::Value::number(0));
            set.set("base_color", scene::Value::color(0, 0, 0));
            set.set("sheen_roughness", scene::Value::number(uniform(e, 0.4f, 1.f))); // below, it would return too much
        });
}

// Delta lobes: direction, probability and weight. Probability times weight is the energy of a lobe.
TEST_CASE("smooth dielectric, thin dielectric, smooth conductor, mirror, uber: the delta lobes", "[materials]") {
    Bench& bench = Bench::get();
    for (const char* type : {"dielectric", "conductor", "mirror", "uber"}) {
        BsdfLab lab(bench, bench.material(type));
        Engine e(12);
        std::vector<scene::ParamSet> configs;
        for (int i = 0; i < 1000; ++i) {
            configs.push_back(random_config(lab.table(), e));
            if (type != std::string_view("uber"))
                for (const char* id : {"uroughness", "vroughness"})
                    if (configs.back().find(id)) configs.back().set(id, scene::Value::number(0));
            if (type == std::string_view("conductor")) dense(configs.back(), e);
            if (type == std::string_view("uber")) // at 1 refraction and passing through are indistinguishable
                configs.back().set("eta", scene::Value::number(uniform(e, 1.1f, 3.f)));
            if (type != std::string_view("dielectric") && configs.back().find("remap"))
                configs.back().set("remap", scene::Value::choice("none"));
        }
        std::vector<BsdfJob> jobs(8000);
        for (BsdfJob& job : jobs)
            job = {.wo = random_direction(e), .u = unit3(e), .config = e() % 1000};
        const auto answers = lab.run(configs, jobs);
        int compared = 0, bad = 0;
        std::ostringstream examples;
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            const BsdfAnswer& a = answers[i];
            const V wo = vec(jobs[i].wo);
            if (!(a.flags & delta) || std::abs(wo.z) < 1e-3) continue;
            const Params p{configs[jobs[i].config], lab.table()};
            const bool thin = type == std::string_view("dielectric") && p.flag("thin");
            double eta = 1;
            if (type == std::string_view("dielectric") || type == std::string_view("uber"))
                eta = wo.z > 0 || thin ? p.number("eta") : 1 / p.number("eta");
            double f = ref::fresnel(std::abs(wo.z), eta);
            if (thin) {
                double sum = f; // face by face: R + T R T + T R^3 T + ...
                for (int bounce = 1; bounce < 20000; bounce += 2) // F is near 1 at grazing angles
                    sum += (1 - f) * std::pow(f, bounce) * (1 - f);
                f = sum;
            }
            V wi{-wo.x, -wo.y, wo.z};
            bool passes = false; // uber's opacity
            if (a.flags & transmit) {
                passes = type == std::string_view("uber") && a.eta == 1.f && eta != 1;
                const double s = thin || passes ? 1 : eta;
                wi = {-wo.x / s, -wo.y / s, 0};
                wi.z = -std::copysign(std::sqrt(std::max(0.0, 1 - wi.x * wi.x - wi.y * wi.y)), wo.z);
            }
            bool ok = std::sqrt(std::pow(wi.x - a.wi[0], 2) + std::pow(wi.y - a.wi[1], 2) +
                                std::pow(wi.z - a.wi[2], 2)) < 2e-3;
            for (int k = 0; k < 3; ++k) {
                double carries = 0;
                const bool through = (a.flags & transmit) != 0;
                if (type == std::string_view("mirror"))
                    carries = p.color("kr", k);
                else if (type == std::string_view("conductor")) {
                    std::complex<double> ior(p.color("eta", k), p.color("k", k));
                    if (p.flag("use_reflectance")) {
                        const double r = std::min(p.color("reflectance", k), 0.9999);
                        ior = {1, 2 * std::sqrt(r) / std::sqrt(1 - r)};
                    }
                    carries = ref::fresnel(std::abs(wo.z), ior);
                } else if (type == std::string_view("dielectric"))
                    carries = through ? p.color("transmittance", k) * (1 - f) / (thin ? 1 : eta * eta)
                                      : p.color("reflectance", k) * f;
                else if (passes)
                    carries = 1 - p.color("opacity", k);
                else
                    carries = p.color("opacity", k) *
                              (through ? p.color("kt", k) * (1 - f) / (eta * eta) : p.color("kr", k) * f);
                const double got = static_cast<double>(a.weight[static_cast<std::size_t>(k)]) * a.sample_pdf;
                ok = ok && std::abs(got - carries) < 2e-3 * carries + 2e-5;
            }
            ++compared;
            if (!ok && ++bad <= 3)
                examples << "expected wi " << wi.x << ' ' << wi.y << ' ' << wi.z << ", F " << f << "\n  "
                         << describe(jobs[i], a) << "\n  " << describe(configs[jobs[i].config]) << '\n';
        }
        INFO(type << ": " << compared << " delta samples\n" << examples.str());
        CHECK(compared >= 1000);
        CHECK(bad == 0);
    }
}
