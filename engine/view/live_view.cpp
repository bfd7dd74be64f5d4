// SPDX-License-Identifier: Apache-2.0
#include "view/live_view.hpp"

#include "base/thread_priority.hpp"
#include "plugin/registry.hpp"
#include "render/film_error.hpp"
#include "render/renderer.hpp"
#include "scene/projection.hpp"
#include "view/pictures.hpp"
#include "view/region.hpp"
#include "view/view_denoiser.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

namespace restage::view {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr double coarse_budget = 0.045;  // for the first picture after a change, traced and denoised [s]
constexpr double coarse_pixels = 3000;   // minimum: smaller pictures at one sample per pixel denoise to dark blots
constexpr double publish_interval = 0.3; // between pictures that only gain samples [s]
constexpr double compile_patience = 0.15; // after this a newer request may replace a document's first picture [s]
constexpr double clay_pixels = 200e3;     // about 30 ms on two cores
constexpr std::uint32_t dividers[] = {1, 2, 3, 4, 5, 6, 8, 12, 16}; // each halved (rounded down) is in the list, or 1

struct Request {
    scene::Scene scene;
    ViewOptions options;
    std::uint64_t number = 0;
    Clock::time_point time;
    std::optional<scene::Film> film; // of the scene as given, without settings that only affect finished pictures
};

} // namespace

struct LiveView::Impl {
    const plugin::Registry& registry;
    Log& log;
    std::function<void()> on_news;

    mutable std::mutex mutex;
    std::condition_variable wake_render;
    bool stop = false;
    std::optional<Request> mail; // the newest request, not yet taken
    std::optional<render::RendererOptions> new_options;
    std::uint64_t last_number = 0; // last issued
    bool taking = false; // a request was taken from `mail`, and may show the same picture
    std::uint64_t visible = 0; // the newest request that shows something different from its predecessor
    Pictures pictures;
    ViewStatus now;

    double denoise_rate = 0; // of coarse pictures [pixels/s]; 0 = not measured yet

    std::thread render_thread;
    std::optional<ViewDenoiser> denoiser;

    Impl(const plugin::Registry& r, Log& l, render::RendererOptions options, std::function<void()> news)
        : registry(r), log(l), on_news(std::move(news)), new_options(std::move(options)) {
        denoiser.emplace(registry, ViewDenoiser::Host{
                                       // A coarse picture is always finished; a fine one is dropped when the scene has
                                       // changed.
                                       .wanted =
                                           [this](const Frame& frame) {
                                               const std::lock_guard lock(mutex);
                                               return !stop && (frame.divider > 1 || visible == frame.request);
                                           },
                                       .done =
                                           [this](auto frame) {
                                               if (frame->divider > 1) note_denoising(*frame);
                                               put(std::move(frame));
                                               on_news();
                                           },
                                       .says = [this](const std::string& problem) { denoiser_says(problem); }});
        render_thread = std::thread([this] { render_loop(); });
    }

    ~Impl() {
        {
            std::lock_guard lock(mutex);
            stop = true;
        }
        wake_render.notify_all();
        render_thread.join();
        denoiser.reset();
    }

    void set_state(ViewState state, std::string text = {}) {
        {
            std::lock_guard lock(mutex);
            now.state = state;
            now.text = std::move(text);
        }
        on_news();
    }
    void failed(const Error& error) {
        log.error(error.message);
        set_state(ViewState::failed, error.message);
    }

    // --- the render thread
    // ---------------------------------------------------------------------------------------------

    struct Work { // state of the render thread
        std::unique_ptr<render::Renderer> renderer;
        std::optional<Request> request;
        scene::Version film_version = std::uint64_t(1) << 62; // version of reduced-resolution films
        std::uint64_t document = 0, variant = 0;
        bool pictured = false; // a picture of this document exists; until then: clay
        bool compiling = false; // as of the last pass
        std::optional<scene::Film> film; // the scene's own
        std::uint64_t shown = 0; // number of the film's request; 0 = none
        glm::uvec2 size{0}; // of the full picture
        std::shared_ptr<const Frame> around; // of the region, while there is one
        std::optional<glm::vec4> region; // of the film
        std::uint32_t divider = 1;
        double rate = 0; // pixels times samples per second
        bool shares_cores = false; // tracing and denoising run on the same cores
        bool finished = false; // idle until a new request
        Clock::time_point last_publish;
        std::uint32_t published_samples = 0;
    };

    void render_loop() {
        lower_thread_priority(5);
        Work work;
        for (;;) {
            // Side by side both would end later, and the next request would be older.
            if (work.shares_cores) denoiser->finish_coarse();
            {
                std::unique_lock lock(mutex);
                wake_render.wait(lock, [&] { return stop || mail || new_options || (work.request && !work.finished); });
                if (stop) return;
                if (new_options) {
                    auto options = std::move(*new_options);
                    new_options.reset();
                    lock.unlock();
                    open(work, std::move(options));
                    continue;
                }
                if (mail) {
                    work.request = std::move(mail);
                    mail.reset();
                    taking = true;
                    lock.unlock();
                    begin(work);
                    lock.lock();
                    taking = false;
                    continue;
                }
            }
            advance(work);
        }
    }

    void open(Work& work, render::RendererOptions options) {
        set_state(ViewState::starting);
        work.renderer.reset();
        options.stand_ins = true; // never wait for a compiler
        auto made = render::Renderer::create(options, render::material_lookup(registry), log);
        work.shown = 0;
        if (!made) return failed(made.error());
        work.renderer = std::move(*made);
        {
            std::lock_guard lock(mutex);
            now.device = work.renderer->device().info().name;
            now.tracer = work.renderer->tracer_name();
        }
        work.rate = 0;
        work.shares_cores = work.renderer->device().info().type == gpu::DeviceType::cpu;
        if (work.request) begin(work);
    }

    // A new request: the first, coarse picture; or, if nothing visible has changed (a name, say), the same picture
    // continues.
    void begin(Work& work) {
        work.finished = true; // until the scene is ready
        if (!work.renderer) return;
        Request& request = *work.request;
        const glm::uvec2 size = glm::max(request.options.size, glm::uvec2(1));
        const bool another_document = work.document != request.options.document;
        const bool another_scene = another_document || work.variant != request.options.variant;
        if (request.options.look) return show_look(work, size, another_document, another_scene);
        work.around = !another_scene && has_pixels(request.options.region, size) ? surroundings() : nullptr;
        if (!another_scene && work.size == size && work.shown) {
            const std::uint32_t before = work.renderer->samples();
            if (!sync(work)) return;
            if (before > 0 && work.renderer->samples() == before) {
                request.number = work.shown;
                work.finished = work.divider == 1 && target_met(work);
                return;
            }
        }
        work.size = size;
        work.shown = request.number;
        {
            std::lock_guard lock(mutex);
            visible = request.number;
        }
        work.divider = 1;
        const double pixels = double(size.x) * size.y;
        const double rate = coarse_rate(work);
        for (const std::uint32_t d : dividers) {
            if (d > 1 && pixels / (d * d) < coarse_pixels) break;
            if (work.around) break;
            work.divider = d;
            if (pixels / (d * d) <= rate * coarse_budget) break;
        }
        if (another_document) work.pictured = false;
        if (another_scene) change_scene(work);
        if (work.pictured) work.renderer->forget_clay(); // of a look
        if (!prepare(work)) return;
        if (!work.pictured) show_clay(work, clay_divider(work), {});
        pass(work, true);
    }

    // Pixels of a first picture per second.
    double coarse_rate(const Work& work) {
        const double traced = work.rate > 0 ? work.rate : 1e5; // unknown yet: be conservative
        const std::lock_guard lock(mutex);
        if (!work.request->options.denoise || denoise_rate <= 0) return traced;
        return 1 / (1 / traced + 1 / denoise_rate);
    }

    void note_denoising(const Frame& frame) { // [any]
        const std::lock_guard lock(mutex);
        const double rate = double(frame.image.pixels()) / std::max(frame.denoise_seconds, 1e-6);
        denoise_rate = denoise_rate > 0 ? 0.7 * denoise_rate + 0.3 * rate : rate;
    }

    static bool has_pixels(const std::optional<glm::vec4>& region, glm::uvec2 size) {
        scene::Film film;
        film.width = size.x;
        film.height = size.y;
        film.crop = region.value_or(glm::vec4(0));
        const glm::uvec4 window = scene::crop_window(film);
        return window.y > window.x && window.w > window.z;
    }
    // The picture that stays around a region; null if there is none yet.
    std::shared_ptr<const Frame> surroundings() const {
        const std::lock_guard lock(mutex);
        return pictures.raw();
    }

    void change_scene(Work& work) {
        work.document = work.request->options.document;
        work.variant = work.request->options.variant;
        work.renderer->forget_scene();
        set_state(ViewState::preparing);
    }

    // First hits, coarse and then at full resolution. The film keeps its samples unless the scene changed.
    void show_look(Work& work, glm::uvec2 size, bool another_document, bool another_scene) {
        if (another_document) work.pictured = false;
        if (another_scene) change_scene(work);
        if (work.size != size || another_scene) work.shown = 0; // the picture starts again after this
        work.size = size;
        if (!sync(work)) return;
        const std::uint32_t coarse = clay_divider(work);
        show_clay(work, coarse, work.request->options.look);
        bool newer = false;
        {
            std::lock_guard lock(mutex);
            newer = stop || mail || new_options;
        }
        if (coarse > 1 && !newer) show_clay(work, 1, work.request->options.look);
        set_state(ViewState::done);
    }

    static std::uint32_t clay_divider(const Work& work) {
        const double pixels = double(work.size.x) * work.size.y;
        std::uint32_t divider = 1;
        while (pixels / (divider * divider) > clay_pixels)
            ++divider;
        return divider;
    }

    // An immediate preview of the geometry, which is optional; or the look that was asked for.
    void show_clay(Work& work, std::uint32_t divider, std::optional<render::ClayLook> look) {
        auto image =
            work.renderer->clay(glm::max(work.size / divider, glm::uvec2(1)), look.value_or(render::ClayLook::clay));
        if (!image) return log.debug("no preview: " + image.error().message);
        auto frame = std::make_shared<Frame>();
        frame->image = std::move(*image);
        frame->request = work.request->number;
        frame->document = work.document;
        frame->divider = divider;
        frame->clay = true;
        frame->look = look;
        frame->seconds = seconds_since(work.request->time);
        put(std::move(frame));
        on_news();
    }

    // The next step of the same request: refine, or gather samples.
    void advance(Work& work) {
        if (!work.pictured && work.compiling) { // clay is shown: leave the CPUs to the compiler
            {
                std::unique_lock lock(mutex);
                wake_render.wait_for(lock, std::chrono::milliseconds(20), [&] { return stop || mail || new_options; });
                if (stop || mail || new_options) return;
            }
            return pass(work, true);
        }
        if (work.divider > 1) {
            work.divider /= 2;
            if (!prepare(work)) return;
        }
        pass(work, false);
    }

    bool prepare(Work& work) {
        ++work.film_version;
        if (!sync(work)) return false;
        work.renderer->provisional(work.divider > 1);
        work.finished = false;
        work.published_samples = 0;
        return true;
    }

    bool sync(Work& work) {
        scene::Scene& scene = work.request->scene;
        const glm::uvec2 size = glm::max(work.size / work.divider, glm::uvec2(1));
        scene::Film& film = scene.film.value;
        if (!work.request->film) {
            work.request->film = film;
            work.request->film->exposure = 1;
            work.request->film->development = {};
            work.request->film->filename.clear();
        }
        if (std::exchange(work.film, work.request->film) != work.request->film) ++work.film_version;
        const auto region = work.around ? work.request->options.region : std::nullopt;
        if (std::exchange(work.region, region) != region) ++work.film_version;
        film.width = size.x;
        film.height = size.y;
        film.crop = region.value_or(glm::vec4(0, 1, 0, 1));
        scene.film.version = work.film_version;
        const auto start = Clock::now();
        auto ready = work.renderer->sync(scene);
        if (!ready && work.renderer->lost()) ready = revive(work);
        {
            std::lock_guard lock(mutex);
            now.update_seconds = seconds_since(start);
        }
        if (!ready) give_up(work, ready.error());
        return bool(ready);
    }

    // The device is lost: retry once, from the scene.
    Result<void> revive(Work& work) {
        set_state(ViewState::starting);
        auto revived = work.renderer->revive(work.request->scene);
        if (!revived) work.renderer.reset(); // until another device is chosen
        return revived;
    }

    void give_up(Work& work, const Error& error) {
        work.finished = true;
        work.shown = 0;
        failed(error);
    }

    bool target_met(const Work& work) const {
        const ViewOptions& o = work.request->options;
        return o.paused || (o.samples && work.renderer->samples() >= o.samples) ||
               (o.seconds > 0 && seconds_since(work.request->time) >= o.seconds) ||
               (o.error > 0 && render::is_look(work.renderer->samples()) && work.renderer->relative_error() <= o.error);
    }

    // One sample per pixel. The first pass of a request is always finished, so that something shows however fast
    // requests arrive.
    void pass(Work& work, bool first) {
        render::Renderer& renderer = *work.renderer;
        const auto start = Clock::now();
        const std::uint32_t before = renderer.samples();
        bool stopped = false;
        double said = 0; // [s]
        auto traced = renderer.trace(1, [&] {
            const double now_at = seconds_since(start);
            const auto compiling = now_at > said + 0.1 ? renderer.compiling() : std::nullopt;
            {
                std::lock_guard lock(mutex);
                stopped = stop || ((mail || new_options) && (!first || (!work.pictured && now_at > compile_patience)));
                if (compiling) say(*compiling);
            }
            if (compiling) {
                said = now_at;
                on_news();
            }
            return !stopped;
        });
        if (!traced && renderer.lost()) {
            if (traced = revive(work); traced) {
                work.published_samples = 0;
                return;
            }
        }
        if (!traced) return give_up(work, traced.error());
        if (stopped) return; // the new request is next
        if (renderer.samples() <= before) work.published_samples = 0; // something compiled: the film started again
        const double took = seconds_since(start);
        const double rate = double(renderer.film()->width()) * renderer.film()->height() / std::max(took, 1e-6);
        // The first pass of new code is slow, hence no measure: a fast pass counts immediately, a slow one gradually.
        work.rate = work.rate <= 0 ? rate : std::max(rate, work.rate) * 0.3 + std::min(rate, work.rate) * 0.7;
        const auto compiling = renderer.compiling();
        work.compiling = bool(compiling);
        if (!compiling && !work.pictured) {
            work.pictured = true;
            renderer.forget_clay();
        }
        work.finished = work.divider == 1 && !compiling && target_met(work);
        const bool doubled = renderer.samples() >= 2 * work.published_samples;
        if (work.pictured &&
            (work.finished || work.published_samples == 0 ||
             (seconds_since(work.last_publish) > publish_interval && (doubled || renderer.samples() < 64)) ||
             seconds_since(work.last_publish) > 10 * publish_interval))
            publish(work);
        {
            std::lock_guard lock(mutex);
            now.state = work.finished ? ViewState::done : ViewState::rendering;
            now.samples = renderer.samples();
            now.divider = work.divider;
            now.samples_per_second = work.rate;
            now.sample_seconds = took;
            now.gpu_bytes = renderer.gpu_scene().bytes();
            now.not_finite = renderer.stats().not_finite;
            say(compiling.value_or(render::CompileProgress{}));
        }
        on_news();
    }

    void say(const render::CompileProgress& compiling) { // locked
        now.compiling = compiling.what;
        now.compiling_left = compiling.left;
    }

    void publish(Work& work) {
        auto frame = std::make_shared<Frame>();
        frame->image = work.renderer->image();
        frame->counts.resize(frame->image.pixels());
        for (std::size_t i = 0; i < frame->counts.size(); ++i)
            frame->counts[i] = work.renderer->film()->samples_of(i);
        frame->request = work.request->number;
        frame->document = work.document;
        frame->divider = work.divider;
        frame->seconds = seconds_since(work.request->time);
        frame->relative_error = render::relative_error(frame->image);
        if (work.around) put_around(work, *frame);
        const std::uint32_t samples = work.renderer->samples();
        // Denoise at powers of two, and the last one.
        const bool denoise = work.request->options.denoise &&
                             (std::bit_floor(samples) > std::bit_floor(work.published_samples) || work.finished);
        work.published_samples = samples;
        work.last_publish = Clock::now();
        put(frame);
        if (denoise) denoiser->add(std::move(frame));
    }

    static void put_around(const Work& work, Frame& frame) {
        const render::FilmImage &around = work.around->image, part = std::move(frame.image);
        const glm::uvec4 window = scene::crop_window(work.request->scene.film.value);
        const glm::uvec2 lower(window.x, window.z);
        frame.image = with_part(around, work.size, part, lower);
        frame.counts = with_part(work.around->counts, {around.width, around.height}, work.size, frame.counts,
                                 {part.width, part.height}, lower);
    }

    void put(std::shared_ptr<const Frame> frame) { // [any]
        std::lock_guard lock(mutex);
        pictures.put(std::move(frame));
    }

    void denoiser_says(const std::string& problem) { // [any]
        {
            std::lock_guard lock(mutex);
            if (pictures.denoiser_missing() == problem) return;
            pictures.denoiser(problem);
        }
        if (!problem.empty()) log.debug("pictures stay noisy: " + problem); // shown in the toolbar
        on_news();
    }
};

LiveView::LiveView(const plugin::Registry& registry, Log& log, render::RendererOptions options,
                   std::function<void()> on_news)
    : impl_(std::make_unique<Impl>(registry, log, std::move(options), std::move(on_news))) {}

LiveView::~LiveView() = default;

std::uint64_t LiveView::show(scene::Scene scene, const ViewOptions& options) {
    std::uint64_t number = 0;
    {
        std::lock_guard lock(impl_->mutex);
        number = ++impl_->last_number;
        impl_->pictures.ask(options.document, options.denoise, options.look);
        impl_->mail = Request{std::move(scene), options, number, Clock::now()};
    }
    impl_->wake_render.notify_one();
    return number;
}

void LiveView::configure(render::RendererOptions options) {
    {
        std::lock_guard lock(impl_->mutex);
        impl_->new_options = std::move(options);
    }
    impl_->wake_render.notify_one();
}

void LiveView::denoise_by(const std::string& name) { impl_->denoiser->choose(name); }

std::shared_ptr<const Frame> LiveView::frame() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->pictures.raw();
}

std::shared_ptr<const Frame> LiveView::denoised() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->pictures.clean();
}

std::shared_ptr<const Frame> LiveView::best(bool want_denoised) const {
    std::lock_guard lock(impl_->mutex);
    return impl_->pictures.best(want_denoised);
}

ViewStatus LiveView::status() const {
    std::lock_guard lock(impl_->mutex);
    ViewStatus status = impl_->now;
    const bool looks = impl_->pictures.wants_look();
    const auto newest = looks ? impl_->pictures.of_look() : impl_->pictures.raw();
    status.current = !impl_->mail && !impl_->new_options && !impl_->taking && newest &&
                     newest->request == (looks ? impl_->last_number : impl_->visible);
    return status;
}

std::string LiveView::denoiser_missing() const {
    std::lock_guard lock(impl_->mutex);
    return impl_->pictures.denoiser_missing();
}

} // namespace restage::view
