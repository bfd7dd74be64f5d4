// SPDX-License-Identifier: Apache-2.0
// Picture for Python: arrays, denoising, saving, pickling, and merging parts that were rendered separately.
#include "picture.hpp"

#include "pulse.hpp"

#include "base/file.hpp"
#include "render/catcher.hpp"
#include "render/denoise.hpp"
#include "render/film_error.hpp"
#include "scene/development.hpp"
#include "view/merge_pictures.hpp"
#include "view/picture.hpp"

#include <fmt/ranges.h>
#include <nanobind/stl/map.h>
#include <cmath>
#include <cstring>
#include <map>
#include <shared_mutex>

namespace restage::python {

namespace {

using Owner = std::shared_ptr<Picture>;
template <class T, class... Shape>
using Array = nb::ndarray<nb::numpy, T, Shape...>;
using Rgb = Array<float, nb::shape<-1, -1, 3>>;
using Scalar = Array<float, nb::shape<-1, -1>>;
using Ids = Array<std::uint32_t, nb::shape<-1, -1>>;

// The array is a view of the picture, which it keeps alive.
template <class A, class V>
A view(nb::handle self, std::vector<V>& data) {
    const Picture& p = *nb::cast<Owner>(self);
    auto* at = reinterpret_cast<typename A::Scalar*>(data.data());
    if constexpr (std::is_same_v<A, Rgb>)
        return A(at, {p.film.height, p.film.width, 3}, self);
    else
        return A(at, {p.film.height, p.film.width}, self);
}

template <class V>
void array(nb::class_<Picture>& c, const render::FilmLayer<V>& layer) {
    if constexpr (!std::is_same_v<V, glm::vec2>) { // those are internal
        using A = std::conditional_t<std::is_same_v<V, glm::vec3>, Rgb,
                                     std::conditional_t<std::is_same_v<V, float>, Scalar, Ids>>;
        c.def_prop_ro(
            layer.name,
            [values = layer.values](nb::handle self) { return view<A>(self, nb::cast<Owner>(self)->film.*values); },
            layer.doc);
    }
}

nb::object mask(const Owner& p, nb::handle thing) {
    std::vector<bool> wanted;
    const auto want = [&](std::uint32_t id) {
        if (id >= wanted.size()) wanted.resize(id + 1);
        wanted[id] = true;
    };
    const std::vector<std::uint32_t>* ids = &p->film.instance_id;
    Handle<scene::Material> material;
    if (nb::try_cast(thing, material, false)) {
        ids = &p->film.material_id;
        want(material.id.value);
    } else {
        Handle<scene::Group> group;
        Handle<scene::Instance> object;
        Selection selection;
        Objects objects;
        if (nb::try_cast(thing, object, false))
            objects = {object.id}; // also for a removed one: its pixels are still in the picture
        else if (nb::try_cast(thing, group, false))
            objects = objects_of(group);
        else if (nb::try_cast(thing, selection, false))
            objects = selection.objects;
        else
            throw nb::type_error("mask: expected an Object, a Group, a Selection or a Material");
        for (const auto id : objects)
            want(id.value);
    }
    auto* data = new bool[ids->size()];
    nb::capsule owner(data, [](void* at) noexcept { delete[] static_cast<bool*>(at); });
    for (std::size_t i = 0; i < ids->size(); ++i)
        data[i] = (*ids)[i] < wanted.size() && wanted[(*ids)[i]];
    return nb::cast(Array<bool, nb::ndim<2>>(data, {p->film.height, p->film.width}, owner));
}

void save(const Picture& p, const std::filesystem::path& path, const std::string& aovs, float exposure) {
    if (!std::isfinite(exposure)) throw Failure("save: an exposure is a finite number of stops");
    const nb::gil_scoped_release release;
    view::Picture out{
        .film = p.film, .denoised = std::nullopt, .exposure = 1, .development = p.development, .window = p.window};
    if (!p.denoised.empty()) out.denoised = p.denoised;
    take(view::check_picture_path(path.string()));
    view::PictureOptions options;
    options.aovs = aovs;
    options.exposure_stops = exposure;
    options.metadata = {{"restage:scene", p.scene},
                        {"restage:device", p.device},
                        {"restage:tracer", p.tracer},
                        {"restage:samples", std::to_string(p.film.samples)},
                        {"restage:seed", std::to_string(p.seed)},
                        {"restage:denoiser", p.denoiser}}; // no times: equal renders are equal files
    take(view::write_picture(path.string(), out, options));
}

// For notebooks: as written to .png by save().
nb::bytes png_of(const Picture& p) {
    const nb::object folder = nb::module_::import_("tempfile").attr("TemporaryDirectory")();
    const auto path = std::filesystem::path(nb::cast<std::string>(folder.attr("name"))) / "picture.png";
    save(p, path, "none", 0);
    const std::string bytes = take(read_file(path));
    folder.attr("cleanup")();
    return nb::bytes(bytes.data(), bytes.size());
}

// numpy.asarray(picture): a copy of the picture as shown.
nb::object as_array(nb::handle self, nb::handle type, nb::handle copy) {
    auto& p = *nb::cast<Owner>(self);
    if (!copy.is_none() && !nb::cast<bool>(copy))
        throw nb::value_error("a Picture gives a copy; its arrays `color` and `denoised` are views of its memory");
    const nb::object array = nb::cast(view<Rgb>(self, p.denoised.empty() ? p.film.color : p.denoised));
    return nb::module_::import_("numpy").attr("array")(array, "dtype"_a = type);
}

// --- parts rendered separately
// -----------------------------------------------------------------------------------------------

Owner merge(const std::vector<Owner>& parts) {
    if (parts.empty()) throw Failure("merge: there are no pictures");
    const Picture& first = *parts[0];
    auto out = std::make_shared<Picture>(first);
    out->denoised.clear();
    out->denoiser = "none";
    out->not_finite.clear();
    out->seconds = 0;
    std::vector<view::PicturePart> films;
    for (const Owner& p : parts) {
        films.push_back({.film = &p->film, .first_sample = p->first_sample});
        out->seconds += p->seconds;
        out->finished = out->finished && p->finished;
        if (p->first_sample < out->first_sample) out->first_sample = p->first_sample;
        for (const auto& [type, count] : p->not_finite)
            out->not_finite[type] += count;
    }
    out->film = take(view::merge_films(films));
    return out;
}

// --- pickling
// -----------------------------------------------------------------------------------------------------------

template <class V>
nb::bytes bytes(const std::vector<V>& v) {
    return nb::bytes(reinterpret_cast<const char*>(v.data()), v.size() * sizeof(V));
}
template <class V>
void from_bytes(const nb::handle h, std::vector<V>& v) {
    const auto b = nb::cast<nb::bytes>(h);
    v.resize(b.size() / sizeof(V));
    std::memcpy(static_cast<void*>(v.data()), b.c_str(), v.size() * sizeof(V));
}

nb::tuple get_state(const Picture& p) {
    const auto& f = p.film;
    const scene::Development& d = p.development;
    nb::list layers;
    render::each_film_layer([&](const auto& layer) { layers.append(bytes(f.*layer.values)); });
    return nb::make_tuple(f.width, f.height, f.samples, layers, bytes(p.denoised), p.seed, p.first_sample, p.seconds,
                          p.finished, p.not_finite, p.scene, p.device, p.tracer, p.denoiser,
                          nb::make_tuple(scene::tone_name(d.tone), d.temperature, d.tint, d.vignette, d.bloom),
                          nb::make_tuple(p.window.x, p.window.y, p.window.z, p.window.w));
}

void set_state(Picture& p, const nb::tuple& t) {
    new (&p) Picture();
    p.host = Host::get();
    auto& f = p.film;
    f.width = nb::cast<std::uint32_t>(t[0]);
    f.height = nb::cast<std::uint32_t>(t[1]);
    f.samples = nb::cast<std::uint32_t>(t[2]);
    const auto layers = nb::cast<nb::list>(t[3]);
    std::size_t at = 0;
    render::each_film_layer([&](const auto& layer) { from_bytes(layers[at++], f.*layer.values); });
    if (render::has_catchers(f)) render::set_alpha(f, render::shadow_ratios(f));
    from_bytes(t[4], p.denoised);
    p.seed = nb::cast<std::uint32_t>(t[5]);
    p.first_sample = nb::cast<std::uint32_t>(t[6]);
    p.seconds = nb::cast<double>(t[7]);
    p.finished = nb::cast<bool>(t[8]);
    p.not_finite = nb::cast<std::map<std::string, std::uint64_t>>(t[9]);
    p.scene = nb::cast<std::string>(t[10]);
    p.device = nb::cast<std::string>(t[11]);
    p.tracer = nb::cast<std::string>(t[12]);
    p.denoiser = nb::cast<std::string>(t[13]);
    const auto d = nb::cast<nb::tuple>(t[14]), w = nb::cast<nb::tuple>(t[15]);
    p.development = {.tone = scene::find_tone(nb::cast<std::string>(d[0])).value_or(scene::ToneCurve::srgb),
                     .temperature = nb::cast<float>(d[1]),
                     .tint = nb::cast<float>(d[2]),
                     .vignette = nb::cast<float>(d[3]),
                     .bloom = nb::cast<float>(d[4])};
    for (int i = 0; i < 4; ++i)
        p.window[i] = nb::cast<float>(w[std::size_t(i)]);
}

} // namespace

void denoise(Picture& p, const std::string& quality, unsigned threads, const std::string& denoiser,
             const std::function<bool(double)>& ask) {
    if (quality != "fast" && quality != "balanced" && quality != "high")
        throw Failure("unknown denoising quality \"" + quality + "\"; known: fast, balanced, high");
    if (p.film.color.empty() || p.film.samples == 0) throw Failure("denoise: the picture has no samples");
    Host::begin_threads();
    const auto chosen = take(render::choose_denoiser(p.host->registry(), denoiser));
    const auto as = quality == "fast"       ? plugin::DenoiseQuality::fast
                    : quality == "balanced" ? plugin::DenoiseQuality::balanced
                                            : plugin::DenoiseQuality::high;
    double fraction = 0;
    Pulse pulse([&] { return !ask || ask(fraction); }, true);
    Result<std::vector<glm::vec3>> clean = [&] {
        const nb::gil_scoped_release release;
        const std::shared_lock plugins(p.host->in_use());
        return render::denoise(p.film, chosen, as, threads, [&](double done) {
            fraction = done;
            return pulse.keep_going();
        });
    }();
    pulse.rethrow();
    p.host->flush_log();
    p.denoised = take(std::move(clean));
    p.denoiser = render::denoiser_label(chosen, as);
}

void bind_picture(nb::module_& m) {
    static const std::string save_doc = fmt::format(
        "Writes .exr (linear, all layers), .png or .jpg (8-bit sRGB, with the session's tone,\nwhite balance ... of "
        "the render), .pfm or .hdr; the denoised picture if there "
        "is one.\n"
        "aovs: of an .exr, comma-separated {}; all; none. exposure: of a .png or .jpg [stops].",
        fmt::join(view::aov_names(), ", "));
    nb::class_<Picture> c(
        m, "Picture",
        "A rendered picture. Its arrays are views of its memory (writing to them changes it); row 0 is the top.\n"
        "Colours are linear sRGB radiance times the exposure of the scene.");
    render::each_film_layer([&](const auto& layer) {
        if (*layer.name) array(c, layer);
    });
    c.def_prop_ro(
         "denoised",
         [](nb::handle self) -> nb::object {
             auto& p = *nb::cast<Owner>(self);
             return p.denoised.empty() ? nb::none() : nb::cast(view<Rgb>(self, p.denoised));
         },
         "float32 (H, W, 3): the denoised picture, or None before denoise().",
         nb::sig("def denoised(self) -> numpy.typing.NDArray[numpy.float32] | None"))
        .def_prop_ro(
            "size", [](const Picture& p) { return std::make_tuple(p.film.width, p.film.height); },
            "Width and height [pixel].")
        .def_prop_ro(
            "samples", [](const Picture& p) { return p.film.samples; }, "Samples per pixel (the minimum over all).")
        .def_prop_ro(
            "relative_error", [](const Picture& p) { return render::relative_error(p.film); },
            "Root mean square of standard error over luminance, the measure of render(error=...).")
        .def_ro("seconds", &Picture::seconds, "Time it took to trace [s].")
        .def_ro("seed", &Picture::seed, "Seed of its random numbers.")
        .def_ro("first_sample", &Picture::first_sample, "Number of its first sample in a pixel; 0 unless requested.")
        .def_ro("finished", &Picture::finished, "False: a callback stopped it before its target.")
        .def_ro("not_finite", &Picture::not_finite, "Samples omitted because they were non-finite, by material type.")
        .def_ro("device", &Picture::device, "The Vulkan device.")
        .def_ro("tracer", &Picture::tracer, "Name of the tracer.")
        .def("mask", &mask, "thing"_a,
             "bool (H, W): true where the first hit is on this object, group, selection or material.",
             nb::sig(
                 "def mask(self, thing: Object | Group | Selection | Material) -> numpy.typing.NDArray[numpy.bool_]"))
        .def(
            "denoise",
            [](const Owner& p, const std::string& quality, unsigned threads, const std::string& denoiser,
               const nb::object& callback) {
                denoise(*p, quality, threads, denoiser,
                        [&](double done) { return callback.is_none() || goes_on(callback(done)); });
                return p;
            },
            "quality"_a = "high", "threads"_a = 0, "denoiser"_a = "", "progress"_a = nb::none(),
            "Fills `denoised`, through a denoiser plugin. quality: fast, balanced or high. denoiser: its type or the "
            "id "
            "of\nits plugin; \"\" = the one shipped with Restage. progress(fraction): called about 20 times a "
            "second; "
            "on\nFalse restage.Cancelled is raised, and the picture is unchanged. Returns the picture.",
            nb::sig("def denoise(self, quality: str = 'high', threads: int = 0, denoiser: str = '', progress: "
                    "collections.abc.Callable[[float], bool | None] | None = None) -> Picture"))
        .def_ro("denoiser", &Picture::denoiser, "The denoiser of `denoised`: \"oidn high\", or \"none\".")
        .def("save", &save, "path"_a, "aovs"_a = "all", "exposure"_a = 0.f, save_doc.c_str())
        .def("_repr_png_", &png_of, "For notebooks: the .png that save() writes.")
        .def("__array__", &as_array, "dtype"_a = nb::none(), "copy"_a = nb::none(),
             "float32 (H, W, 3), a copy: the denoised picture if there is one, else `color`.",
             nb::sig("def __array__(self, dtype: numpy.typing.DTypeLike | None = None, copy: bool | None = None) -> "
                     "numpy.typing.NDArray[typing.Any]"))
        .def("__getstate__", &get_state)
        .def("__setstate__", &set_state)
        .def("__repr__", [](const Picture& p) {
            return "<restage.Picture " + std::to_string(p.film.width) + "x" + std::to_string(p.film.height) + ", " +
                   std::to_string(p.film.samples) + " samples a pixel" + (p.finished ? ">" : ", stopped early>");
        });
    m.def(
        "merge", &merge, "pictures"_a,
        "One picture of several of the same view: means weighted by their samples, errors from sums of squares. Parts\n"
        "of one seed with adjoining sample ranges (render's first_sample) give the same as one render of all samples.");
}

} // namespace restage::python
