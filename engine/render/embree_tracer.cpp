// SPDX-License-Identifier: Apache-2.0
// The `embree` tracer: a wavefront. Kernels generate, shade (one per material type, over a queue of its hits) and
// accumulate; between two bounces one CPU pass finds hits (wave_hits) and queues them for their types' kernels
// (wave_queues).
#include "render/embree_scene.hpp"
#include "render/guiding.hpp"
#include "render/photon_map.hpp"
#include "render/photon_pilot.hpp"
#include "render/sample_plan.hpp"
#include "render/wave_kernels.hpp"
#include "render/wave_queues.hpp"
#include "shared/wave_data.h"

#include <algorithm>
#include <chrono>
#include <optional>

namespace restage::render {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr std::uint32_t wave_paths = WaveMemory::most_paths;
constexpr std::size_t most_asked = 1 << 18; // undecided hits per submit
// Triangles of a scene to be flattened. In one with fewer, the bounds of its objects save more.
constexpr std::uint64_t flat_from = 4096;
constexpr std::uint8_t type_emit = WaveMemory::type_emit;

static_assert(sizeof(shared::WavePush) == 128);

class EmbreeTracer final : public Tracer {
  public:
    explicit EmbreeTracer(const TracerContext& c) : c_(c), kernels_(c), caustics_(c.device, c.jobs) {}
    const char* name() const override { return "embree"; }
    const EmbreeScene* embree() const override { return embree_.get(); }

    Result<void> start() {
        RESTAGE_TRY(embree_, EmbreeScene::create(c_.jobs.threads(),
                                                 {.flat_from = c_.stand_ins ? EmbreeScene::never : flat_from}));
        RESTAGE_CHECK(memory_.create(c_.device));
        RESTAGE_TRY(frame_, c_.device.create_buffer(sizeof(shared::FrameData), gpu::BufferKind::host, "frame"));
        return {};
    }

    Result<void> update(const GpuScene& scene, const SceneChanges& changes) override {
        RESTAGE_CHECK(embree_->update(scene, changes));
        if (!changes.shaders) return {};
        guided_.use = gathering_.use = std::nullopt;
        return kernels_.select(scene, {.photons = c_.stand_ins});
    }
    bool settled() const override { return embree_->settled(); }
    Result<void> settle() override { return embree_->settle(); }
    bool adopt() override { return kernels_.adopt(); }
    std::optional<CompileProgress> compiling() const override { return kernels_.compiling(); }
    void film_emptied() override {
        kernels_.film_emptied();
        caustics_.forget(); // the scene may be another, or a stand-in may have hidden casters
    }

    Result<void> trace(const GpuScene& scene, Film& film, const TraceRequest& request) override {
        const auto start = Clock::now();
        learning_ = false;
        bool going = true;
        if (!caustics_.started()) {
            const bool all = scene.all_caustics();
            const bool wanted = scene.features().caustics;
            if (wanted && (all || caustics_.active() || !request.provisional)) {
                RESTAGE_TRY(going, look_for_caustics(scene, film, request));
            } else if (wanted || caustics_.address()) { // kernels made when they were wanted may still run
                RESTAGE_CHECK(caustics_.start(scene, std::vector<char>(scene.instances().size()), all));
            }
        }
        if (going) {
            RESTAGE_CHECK(choose_kernels(scene, request.guiding));
            RESTAGE_TRY(going, running_->begin(request.keep_going));
        }
        if (going && photons(scene)) {
            RESTAGE_CHECK(trace_maps(scene, film, request));
        } else if (going) {
            RESTAGE_CHECK(trace_samples(scene, film, request));
        }
        return finish(scene, start);
    }

  private:
    // Guided paths have kernels of their own, which are made when the first map is; and so have paths that gather
    // photons, once it is known that they pay. But an editor's stand-ins are replaced one by one, in one set of
    // kernels.
    Result<void> choose_kernels(const GpuScene& scene, const Guiding* guiding) {
        const KernelUse use{.guiding = guiding && guiding->address(), .photons = photons(scene)};
        running_ = &kernels_;
        return use.guiding || (use.photons && !c_.stand_ins) ? choose(scene, use) : Result<void>{};
    }
    bool photons(const GpuScene& scene) const { return scene.features().caustics && caustics_.active(); }
    Result<void> choose(const GpuScene& scene, KernelUse use) {
        auto& special = use.guiding ? guided_ : gathering_;
        if (!special.kernels) {
            TracerContext context = c_;
            context.stand_ins = false;
            special.kernels = std::make_unique<WaveKernels>(context);
        }
        if (special.use != use) {
            RESTAGE_CHECK(special.kernels->select(scene, use));
            special.use = use;
        }
        running_ = special.kernels.get();
        return {};
    }

    Result<void> finish(const GpuScene& scene, Clock::time_point start) {
        stats_.seconds += seconds_since(start);
        stats_.shader_bytes = running_->shader_bytes();
        auto counts = memory_.counters.span<std::uint32_t>();
        for (std::size_t i = 0; i < std::min<std::size_t>(scene.types().size(), COUNTER_MAX_TYPES); ++i)
            if (counts[i]) stats_.not_finite[scene.types()[i].type] += std::exchange(counts[i], 0);
        if (counts[COUNTER_FILM]) stats_.dropped += std::exchange(counts[COUNTER_FILM], 0);
        return {};
    }

    static shared::FrameData frame_of(const Film& film, const TraceRequest& request) {
        shared::FrameData f{};
        f.crop_x = request.crop_x;
        f.crop_y = request.crop_y;
        f.crop_width = film.width();
        f.crop_height = film.height();
        f.seed = request.seed;
        f.film = film.pixels();
        f.film_guides = film.guides();
        if (request.guiding) f.guiding = request.guiding->address();
        return f;
    }

    // These return false if keep_going requested a stop.
    Result<bool> trace_samples(const GpuScene& scene, const Film& film, const TraceRequest& request) {
        // A wave covers all pixels with several samples each, or some pixels with one sample each.
        SamplePlan plan(request, film.width() * film.rows(), wave_paths, wave_paths);
        while (plan.next()) {
            if (request.keep_going && !request.keep_going()) return false;
            shared::FrameData f = frame_of(film, request);
            learning_ = request.guiding && request.guiding->learns();
            const auto done = wave(scene, f, plan, request.keep_going);
            if (done && *done && learning_) request.guiding->add(records_, plan.picks(), memory_.paths());
            learning_ = false;
            if (!done || !*done) return done;
        }
        return true;
    }

    // The samples of each photon map with that map.
    Result<bool> trace_maps(const GpuScene& scene, const Film& film, const TraceRequest& request) {
        const std::uint32_t pixels = film.width() * film.rows(), per_map = CausticPhotons::samples_per_map(pixels);
        const PixelSamples all{request.first_sample, request.samples};
        const auto asked = request.pixels.empty() ? std::span(&all, 1) : request.pixels;
        std::uint32_t first = ~0u, end = 0;
        for (const PixelSamples& s : asked)
            if (s.count > 0) first = std::min(first, s.first), end = std::max(end, s.first + s.count);
        std::vector<PixelSamples> part(asked.size());
        for (std::uint32_t map = first / per_map; map * per_map < end;) {
            const auto maps = caustics_.maps_with(map, pixels);
            const auto clip = [&](const PixelSamples& s) {
                const std::uint32_t from = std::max(s.first, maps.first * per_map);
                const std::uint32_t to = std::min(s.first + s.count, (maps.first + maps.count) * per_map);
                return PixelSamples{from, to > from ? to - from : 0};
            };
            std::ranges::transform(asked, part.begin(), clip);
            TraceRequest of_maps = request;
            if (request.pixels.empty())
                of_maps.first_sample = part[0].first, of_maps.samples = part[0].count;
            else
                of_maps.pixels = part;
            RESTAGE_TRY(bool going, shoot(scene, film, request, maps));
            if (going) {
                RESTAGE_TRY(going, trace_samples(scene, film, of_maps));
            }
            if (!going) return false;
            map = maps.first + maps.count;
        }
        return true;
    }

    // Makes these photon maps unless they are there.
    Result<bool> shoot(const GpuScene& scene, const Film& film, const TraceRequest& request,
                       const CausticPhotons::Maps& maps) {
        if (caustics_.has(maps, request.seed)) return true;
        const std::uint32_t pixels = film.width() * film.rows();
        if (maps.first > 0 && !caustics_.knows_radius(request.seed)) {
            RESTAGE_TRY(const bool going, shoot(scene, film, request, caustics_.maps_with(0, pixels)));
            if (!going) return false;
        }
        RESTAGE_TRY(const bool ready, running_->need_photons(request.keep_going));
        if (!ready || (request.keep_going && !request.keep_going())) return false;
        RESTAGE_CHECK(caustics_.begin(maps, request.seed, pixels));
        for (std::uint64_t first = 0; first < caustics_.all(); first += wave_paths) {
            RESTAGE_CHECK(caustics_.next_wave(first));
            shared::FrameData f = frame_of(film, request);
            RESTAGE_CHECK(begin_wave(scene, f));
            const auto count = std::uint32_t(std::min<std::uint64_t>(caustics_.all() - first, wave_paths));
            RESTAGE_TRY(const bool done, bounces(
                                             scene, running_->photons(), count, request.keep_going,
                                             [&] { caustics_.collect(queues_.active()); }, [](std::uint32_t) {}));
            if (!done) return false;
        }
        RESTAGE_CHECK(caustics_.finish(scene, *embree_));
        return true;
    }

    // Which instances have delta lobes is known only to materials: camera paths find out, whose samples do not count.
    // Then photons that do not count tell whether any are seen.
    Result<bool> look_for_caustics(const GpuScene& scene, const Film& film, const TraceRequest& request) {
        const bool all = scene.all_caustics(); // then kernels that gather are needed anyway
        running_ = &kernels_;
        if (all && !c_.stand_ins) RESTAGE_CHECK(choose(scene, {.photons = true}));
        RESTAGE_TRY(bool going, running_->begin(request.keep_going));
        if (!going) return false;
        PhotonPilot pilot(memory_);
        RESTAGE_CHECK(caustics_.start(scene, std::vector<char>(scene.instances().size()), all));
        const TraceStats before = stats_; // these are no samples
        RESTAGE_TRY(going, find_casters(scene, film, request, pilot));
        if (going) {
            RESTAGE_CHECK(caustics_.start(scene, casters_, all));
            if (caustics_.active()) {
                RESTAGE_TRY(going, try_photons(scene, film, request, pilot));
            }
        }
        stats_.rays = before.rays, stats_.shadow_rays = before.shadow_rays;
        if (!going) caustics_.forget();
        return going;
    }

    Result<bool> find_casters(const GpuScene& scene, const Film& film, const TraceRequest& request,
                              PhotonPilot& pilot) {
        const std::uint32_t pixels = film.width() * film.height(), most = std::min(pixels, wave_paths / 16);
        std::vector<PixelSamples> some(std::size_t(film.width()) * film.rows());
        for (std::uint32_t k = 0; k < most; ++k)
            some[std::size_t(std::uint64_t(k) * pixels / most)] = {0, 1};
        TraceRequest asked = request;
        asked.pixels = some;
        asked.seed = 0;
        casters_.assign(scene.instances().size(), 0);
        SamplePlan plan(asked, film.width() * film.rows(), wave_paths, 1);
        if (!plan.next()) return true;
        shared::FrameData f = frame_of(film, asked);
        f.picks = memory_.place(plan);
        RESTAGE_CHECK(begin_wave(scene, f));
        hits_.look_for_casters(scene.instances().size());
        const auto count = std::uint32_t(plan.picks().size());
        pilot.begin(count);
        auto done = bounces(
            scene, running_->generate(), count, request.keep_going,
            [&] { pilot.after_camera_bounce(queues_.active()); },
            [&](std::uint32_t) { pilot.before_bounce(queues_.active()); });
        casters_ = hits_.found_casters();
        pilot.end_camera();
        return done;
    }

    Result<bool> try_photons(const GpuScene& scene, const Film& film, const TraceRequest& request, PhotonPilot& pilot) {
        RESTAGE_TRY(const bool ready, running_->need_photons(request.keep_going));
        if (!ready) return false;
        RESTAGE_CHECK(caustics_.begin_pilot());
        shared::FrameData f = frame_of(film, request);
        RESTAGE_CHECK(begin_wave(scene, f));
        pilot.begin(CausticPhotons::pilot_paths);
        RESTAGE_TRY(const bool done, bounces(
                                         scene, running_->photons(), CausticPhotons::pilot_paths, request.keep_going,
                                         [&] { pilot.after_photon_bounce(queues_.active(), casters_); },
                                         [&](std::uint32_t bounce) {
                                             if (bounce == 0) pilot.photons_started(caustics_.deposits());
                                             pilot.before_bounce(queues_.active());
                                         }));
        if (!done) return false;
        RESTAGE_CHECK(caustics_.learn(scene, pilot, scene.all_caustics()));
        return true;
    }

    // False: the film has nothing of this wave.
    Result<bool> wave(const GpuScene& scene, shared::FrameData& f, const SamplePlan& plan,
                      const std::function<bool()>& keep_going) {
        const auto count = std::uint32_t(plan.picks().size()), run_count = std::uint32_t(plan.runs().size());
        f.picks = memory_.place(plan);
        f.runs = memory_.runs.address();
        f.run_count = run_count;
        RESTAGE_CHECK(begin_wave(scene, f));
        stats_.paths += count;
        RESTAGE_TRY(const bool done,
                    bounces(scene, running_->generate(), count, keep_going, [] {}, [](std::uint32_t) {}));
        if (!done) return false;
        RESTAGE_CHECK(submit([&](gpu::CommandList& list) { dispatch(list, running_->accumulate(), 0, run_count); }));
        return true;
    }

    Result<void> begin_wave(const GpuScene& scene, shared::FrameData& f) {
        f.scene = scene.address();
        f.rays = memory_.ray_buffer.address();
        f.shadows = memory_.shadow_buffer.address();
        f.paths = memory_.path_buffer.address();
        f.guides = memory_.guide_buffer.address();
        if (scene.features().spectral) {
            RESTAGE_CHECK(memory_.create_fourths(c_.device));
            f.fourths = memory_.fourth_buffer.address();
        }
        f.photons = caustics_.address();
        f.queue = memory_.queue_buffer.address();
        f.counters = memory_.counters.address();
        RESTAGE_CHECK(c_.device.upload(frame_, 0, std::as_bytes(std::span(&f, 1))));
        const shared::SceneData& data = scene.data();
        push_ = {.frame = frame_.address(),
                 .rays = f.rays,
                 .shadows = f.shadows,
                 .paths = f.paths,
                 .guides = f.guides,
                 .queue = f.queue,
                 .scene = f.scene,
                 .instances = data.instances,
                 .materials = data.materials,
                 .params = data.params,
                 .lights = data.lights,
                 .light_nodes = data.light_nodes,
                 .queue_first = 0,
                 .queue_count = 0,
                 .world_copies = embree_->flat() ? 1.f : 0.f,
                 .max_depth = data.max_depth,
                 .russian_roulette = data.russian_roulette,
                 .clamp_direct = data.clamp_direct,
                 .clamp_indirect = data.clamp_indirect,
                 .ray_epsilon = data.ray_epsilon};
        return {};
    }

    // Paths from the kernel that starts them to their ends; after_bounce: each time the active ones were shaded;
    // before_bounce: when their hits are known.
    template <class AfterBounce, class BeforeBounce>
    Result<bool> bounces(const GpuScene& scene, const gpu::ComputePipeline& start, std::uint32_t count,
                         const std::function<bool()>& keep_going, AfterBounce&& after_bounce,
                         BeforeBounce&& before_bounce) {
        const std::uint32_t max_depth = scene.data().max_depth;
        RESTAGE_CHECK(submit([&](gpu::CommandList& list) { dispatch(list, start, 0, count); }));
        if (learning_) records_.begin(count);
        queues_.begin(count);
        for (std::uint32_t bounce = 0;; ++bounce) {
            if (bounce > 0 && keep_going && !keep_going()) return false;
            const bool last_vertex = bounce >= max_depth;
            find_hits(scene, last_vertex);
            if (scene.any_undecided()) {
                RESTAGE_TRY(const bool decided, decide(scene, last_vertex, keep_going));
                if (!decided) return false;
            }
            if (learning_) records_.note(queues_.active(), memory_.paths(), memory_.rays(), c_.jobs);
            before_bounce(bounce);
            queue_hits(scene);
            if (queues_.empty()) return true;
            RESTAGE_TRY(const bool ready, running_->need(queues_.counts(), keep_going));
            if (!ready) return false;
            RESTAGE_CHECK(submit([&](gpu::CommandList& list) {
                const auto counts = queues_.counts();
                const auto shade = [&](std::size_t t) {
                    dispatch(list, running_->shade(t), queues_.first(t), counts[t]);
                };
                if (counts[type_emit]) {
                    shade(type_emit);
                    list.barrier(); // shading adds to the same radiance
                }
                for (std::size_t t = 0; t < counts.size(); ++t)
                    if (counts[t] && t != type_emit) shade(t);
            }));
            if (learning_)
                for (const std::size_t t : {WaveMemory::type_emit, WaveMemory::type_escape})
                    records_.note_light(queues_.of(t), memory_.rays());
            after_bounce();
        }
    }

    void dispatch(gpu::CommandList& list, const gpu::ComputePipeline& kernel, std::uint32_t first,
                  std::uint32_t count) {
        push_.queue_first = first;
        push_.queue_count = count;
        list.dispatch(kernel, gpu::push_bytes(push_), WaveMemory::groups(count));
    }

    template <class Record>
    Result<void> submit(Record&& record) {
        const auto start = Clock::now();
        if (!list_) {
            RESTAGE_TRY(list_, c_.device.begin());
        } else {
            list_.reset();
        }
        record(list_);
        RESTAGE_CHECK(c_.device.submit_and_wait(list_));
        stats_.seconds_shading += seconds_since(start);
        return {};
    }

    // Shadow rays of the last vertex, then the next hits.
    void find_hits(const GpuScene& scene, bool last_vertex) {
        const auto start = Clock::now();
        const auto traced = hits_.trace(scene, *embree_, queues_.active(), last_vertex);
        stats_.rays += traced.rays;
        stats_.shadow_rays += traced.shadow_rays;
        stats_.seconds_tracing += seconds_since(start);
    }

    void queue_hits(const GpuScene& scene) {
        const auto start = Clock::now();
        queues_.sort(hits_, scene.features().spectral);
        stats_.seconds_tracing += seconds_since(start);
    }

    // Lets the device decide all deferred hits, and completes the rays waiting for them. False: keep_going requested a
    // stop.
    Result<bool> decide(const GpuScene& scene, bool last_vertex, const std::function<bool()>& keep_going) {
        const std::vector<shared::HitAsked> asked = hits_.asked();
        if (asked.empty()) return true;
        RESTAGE_TRY(const bool ready, running_->need_decide(keep_going));
        if (!ready) return false;
        if (!asked_) {
            RESTAGE_TRY(asked_, c_.device.create_buffer(most_asked * sizeof(shared::HitAsked),
                                                        gpu::BufferKind::readback, "undecided hits"));
            RESTAGE_TRY(decided_, c_.device.create_buffer(most_asked * sizeof(shared::HitDecided),
                                                          gpu::BufferKind::readback, "decided hits"));
        }
        std::vector<shared::HitDecided> decided(asked.size());
        for (std::size_t first = 0; first < asked.size(); first += most_asked) {
            const std::size_t n = std::min(most_asked, asked.size() - first);
            std::copy_n(asked.data() + first, n, asked_.span<shared::HitAsked>().data());
            const shared::DecidePush push{scene.address(), asked_.address(), decided_.address(), std::uint32_t(n), 0};
            RESTAGE_CHECK(submit([&](gpu::CommandList& list) {
                list.dispatch(running_->decide(), gpu::push_bytes(push), WaveMemory::groups(std::uint32_t(n)));
            }));
            std::copy_n(decided_.span<shared::HitDecided>().data(), n, decided.data() + first);
        }
        hits_.settle(scene, *embree_, decided, last_vertex);
        return true;
    }

    TracerContext c_;
    std::unique_ptr<EmbreeScene> embree_;
    WaveMemory memory_;
    WaveHits hits_{memory_, c_.jobs};
    WaveQueues queues_{memory_, c_.jobs};
    gpu::Buffer frame_;
    WaveKernels kernels_;
    CausticPhotons caustics_;
    std::vector<char> casters_; // by instance
    struct SpecialKernels {
        std::unique_ptr<WaveKernels> kernels;
        std::optional<KernelUse> use; // what they were selected for
    };
    SpecialKernels guided_, gathering_; // where paths are guided; where they gather photons, if not always
    WaveKernels* running_ = &kernels_;
    PathRecords records_; // of this wave, if
    bool learning_ = false;
    gpu::Buffer asked_, decided_;
    gpu::CommandList list_;
    shared::WavePush push_{}; // of this wave
};

} // namespace

Result<std::unique_ptr<Tracer>> make_embree_tracer(const TracerContext& context) {
    auto tracer = std::make_unique<EmbreeTracer>(context);
    RESTAGE_CHECK(tracer->start());
    return tracer;
}

} // namespace restage::render
