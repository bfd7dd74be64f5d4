// SPDX-License-Identifier: Apache-2.0
// The material lab for Python: a material's shipped GLSL over arrays of directions. python/restage/bsdf.py wraps it.
#include "values.hpp"

#include "base/file.hpp"
#include "check/bsdf_lab.hpp"

#include <cstddef>
#include <new>
#include <type_traits>

namespace restage::python {

namespace {

using Vectors = nb::ndarray<const float, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Indices = nb::ndarray<const std::uint32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

class Lab {
  public:
    explicit Lab(const std::string& type) : host_(Host::get()) {
        Host::begin_threads();
        const auto entry = host_->registry().find_material(type);
        if (!entry) throw Failure("there is no material type \"" + type + "\"; see restage.material_types()");
        table_ = entry->table->params;
        type_ = type;
        const nb::gil_scoped_release release;
        const auto cache = cache_dir().value_or(std::filesystem::path()); // if it is missing, the device reports it
        device_ = take(gpu::Device::create({.cache_dir = cache}, host_->log()));
        compiler_ = std::make_unique<gpu::ShaderCompiler>(
            gpu::ShaderCompilerOptions{.include_dirs = {Host::home() / "share/restage/shaders"},
                                       .cache_dir = cache.empty() ? cache : cache / "spirv"});
        lab_.emplace(
            take(check::BsdfLab::create(*device_, *compiler_, {entry->table, entry->plugin->folder, entry->source})));
    }

    // All arrays have n rows, `config` names one of the parameter sets for each. Returns raw records of 96 bytes.
    nb::bytes run(const Vectors& wo, const Vectors& wi, const Vectors& u, const Indices& config, const nb::list& sets,
                  std::uint32_t seed, std::uint32_t repeats) {
        Host::begin_threads();
        std::vector<scene::ParamSet> configs;
        for (const nb::handle set : sets) {
            scene::ParamSet& values = configs.emplace_back();
            for (const auto& [key, value] : nb::cast<nb::dict>(set)) {
                const auto id = nb::cast<std::string>(key);
                const std::string who = type_ + ": parameter \"" + id + "\"";
                const auto line =
                    std::find_if(table_.begin(), table_.end(), [&](const model::Param& p) { return p.id == id; });
                if (line == table_.end()) throw Failure(who + " does not exist in a " + type_);
                scene::Value v = to_value(nullptr, line->type, value, who);
                if (line->type == model::ParamType::choice && !line->choice_index(v.text))
                    throw Failure(who + " cannot be \"" + v.text + "\"; " + choices_text(*line) + " are possible");
                values.set(id, std::move(v));
            }
        }
        std::vector<check::BsdfJob> jobs(wo.shape(0));
        for (std::size_t i = 0; i < jobs.size(); ++i) {
            for (std::size_t k = 0; k < 3; ++k) {
                jobs[i].wo[k] = wo(i, k);
                jobs[i].wi[k] = wi(i, k);
                jobs[i].u[k] = u(i, k);
            }
            jobs[i].config = config(i);
            jobs[i].seed = seed * 0x9e3779b9u + std::uint32_t(i);
        }
        Result<std::vector<check::BsdfAnswer>> answers = [&] {
            const nb::gil_scoped_release release;
            return lab_->run(configs, jobs, repeats);
        }();
        host_->flush_log();
        const auto got = take(std::move(answers));
        return nb::bytes(reinterpret_cast<const char*>(got.data()), got.size() * sizeof(check::BsdfAnswer));
    }

    ~Lab() {
        if (!Host::forked()) return;
        new (std::nothrow) Kept{std::move(device_), std::move(compiler_), std::move(lab_)};
    }
    Lab(const Lab&) = delete;

  private:
    struct Kept { // never freed: a forked child must not destroy objects with threads
        std::unique_ptr<gpu::Device> device;
        std::unique_ptr<gpu::ShaderCompiler> compiler;
        std::optional<check::BsdfLab> lab;
    };
    std::shared_ptr<Host> host_;
    std::string type_;
    std::vector<model::Param> table_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<gpu::ShaderCompiler> compiler_;
    std::optional<check::BsdfLab> lab_;
};

// python/restage/bsdf.py reads the records by these offsets.
static_assert(sizeof(check::BsdfAnswer) == 96 && std::is_standard_layout_v<check::BsdfAnswer>);
static_assert(offsetof(check::BsdfAnswer, pdf) == 40 && offsetof(check::BsdfAnswer, wi) == 48 &&
              offsetof(check::BsdfAnswer, sample_pdf) == 72 && offsetof(check::BsdfAnswer, albedo) == 84);

} // namespace

void bind_bsdf(nb::module_& m) {
    nb::class_<Lab>(m, "BsdfLab", "Implementation of restage.Bsdf.")
        .def(nb::init<const std::string&>(), "type"_a)
        .def("run", &Lab::run, "wo"_a, "wi"_a, "u"_a, "config"_a, "sets"_a, "seed"_a, "repeats"_a);
}

} // namespace restage::python
