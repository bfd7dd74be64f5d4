// SPDX-License-Identifier: Apache-2.0
// The `embree` tracer: a wavefront. Kernels generate, shade (one per material type, over a queue of its hits) and
// accumulate; between two bounces one CPU pass lets Embree answer the shadow rays of the last vertex and find the next
// hits, in natural path order and in place, and queues each hit for its type's kernel.
#include "render/embree_scene.hpp"
#include "render/guiding.hpp"
#include "render/photon_map.hpp"
#include "render/sample_plan.hpp"
#include "render/wave_kernels.hpp"
#include "shared/wave_data.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <optional>

namespace restage::render {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr std::uint32_t wave_paths = WAVE_PATHS;
constexpr std::uint32_t group_size = 64;      // of the kernels
constexpr std::size_t chunk = 2048;           // paths per job
constexpr std::size_t most_asked = 1 << 18;   // undecided hits per submit
constexpr std::size_t ahead = 3; // paths prefetched: kernels left them in another cache
constexpr std::uint8_t type_none = 255, type_emit = WaveKernels::emit, type_escape = WaveKernels::escape;
// Kernels over paths run whole groups, without a test of the number of paths: on lavapipe everything behind such a test
// is masked, and a masked load is a branch per lane. A queue's last group is filled with copies of a path of the same
// type.
constexpr std::uint32_t spare_paths = (type_escape + 1) * group_size;
constexpr std::uint32_t all_paths = wave_paths + spare_paths;
constexpr std::uint32_t whole_groups(std::uint32_t n) { return (n + group_size - 1) / group_size * group_size; }

static_assert(sizeof(shared::WavePush) == 128);

class EmbreeTracer final : public Tracer {
  public:
    explicit EmbreeTracer(const TracerContext& c) : c_(c), kernels_(c), caustics_(c.device, c.jobs) {}
    const char* name() const override { return "embree"; }
    const EmbreeScene* embree() const override { return embree_.get(); }

    Result<void> start() {
        RESTAGE_TRY(embree_, EmbreeScene::create(c_.jobs.threads()));
        const auto host = gpu::BufferKind::readback; // both sides read and write
        RESTAGE_TRY(rays_, c_.device.create_buffer(all_paths * sizeof(shared::RayHit), host, "rays"));
        RESTAGE_TRY(shadows_, c_.device.create_buffer(all_paths * sizeof(shared::ShadowRay), host, "shadow rays"));
        RESTAGE_TRY(paths_, c_.device.create_buffer(all_paths * sizeof(shared::PathState), host, "paths"));
        RESTAGE_TRY(guides_, c_.device.create_buffer(all_paths * sizeof(shared::GuideSample), host, "guide samples"));
        RESTAGE_TRY(queue_, c_.device.create_buffer((wave_paths + all_paths) * sizeof(std::uint32_t), host, "queue"));
        RESTAGE_TRY(counters_, c_.device.create_buffer(COUNTER_COUNT * sizeof(std::uint32_t), host, "counters"));
        RESTAGE_TRY(picks_, c_.device.create_buffer(wave_paths * sizeof(shared::SamplePick), host, "samples"));
        RESTAGE_TRY(runs_, c_.device.create_buffer(wave_paths * sizeof(shared::SampleRun), host, "runs of samples"));
        RESTAGE_TRY(frame_, c_.device.create_buffer(sizeof(shared::FrameData), gpu::BufferKind::host, "frame"));
        std::memset(counters_.mapped(), 0, counters_.size());
        std::memset(rays_.mapped(), 0, rays_.size()); // for fields kernels never write
        std::memset(shadows_.mapped(), 0, shadows_.size());
        for (auto& ray : rays_.span<shared::RayHit>())
            ray.mask = ~0u;
        for (auto& shadow : shadows_.span<shared::ShadowRay>())
            shadow.mask = ~0u;
        types_.resize(wave_paths);
        emits_.resize(wave_paths);
        return {};
    }

    Result<void> update(const GpuScene& scene, const SceneChanges& changes) override {
        RESTAGE_CHECK(embree_->update(scene, changes));
        if (changes.shaders) guided_kernels_.reset();
        return changes.shaders ? kernels_.select(scene) : Result<void>{};
    }
    bool adopt() override { return kernels_.adopt(); }
    std::optional<CompileProgress> compiling() const override { return kernels_.compiling(); }
    void film_emptied() override {
        kernels_.film_emptied();
        caustics_.forget(); // the scene may be another, or a stand-in may have hidden casters
    }

    Result<void> trace(const GpuScene& scene, Film& film, const TraceRequest& request) override {
        const auto start = Clock::now();
        RESTAGE_CHECK(choose_kernels(scene, request.guiding));
        learning_ = false;
        RESTAGE_TRY(bool going, running_->begin(request.keep_going));
        if (going && scene.features().caustics && !caustics_.started()) {
            RESTAGE_TRY(going, find_casters(scene, film, request));
        }
        if (going && scene.features().caustics && caustics_.active()) {
            RESTAGE_CHECK(trace_maps(scene, film, request));
        } else if (going) {
            RESTAGE_CHECK(trace_samples(scene, film, request));
        }
        return finish(scene, start);
    }

  private:
    // Guided paths have kernels of their own, which are made when the first map is.
    Result<void> choose_kernels(const GpuScene& scene, const Guiding* guiding) {
        running_ = &kernels_;
        if (!guiding || !guiding->address()) return {};
        if (!guided_kernels_) {
            TracerContext context = c_;
            context.stand_ins = false;
            guided_kernels_ = std::make_unique<WaveKernels>(context);
            RESTAGE_CHECK(guided_kernels_->select(scene, true));
        }
        running_ = guided_kernels_.get();
        return {};
    }

    Result<void> finish(const GpuScene& scene, Clock::time_point start) {
        stats_.seconds += seconds_since(start);
        stats_.shader_bytes = running_->shader_bytes();
        auto counts = counters_.span<std::uint32_t>();
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
            if (done && *done && learning_)
                request.guiding->add(records_, plan.picks(), paths_.span<shared::PathState>());
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
        for (std::uint32_t map = first / per_map; map * per_map < end; ++map) {
            const auto clip = [&](const PixelSamples& s) {
                const std::uint32_t from = std::max(s.first, map * per_map);
                const std::uint32_t to = std::min(s.first + s.count, (map + 1) * per_map);
                return PixelSamples{from, to > from ? to - from : 0};
            };
            std::ranges::transform(asked, part.begin(), clip);
            TraceRequest of_map = request;
            if (request.pixels.empty())
                of_map.first_sample = part[0].first, of_map.samples = part[0].count;
            else
                of_map.pixels = part;
            RESTAGE_TRY(bool going, shoot(scene, film, request, map));
            if (going) {
                RESTAGE_TRY(going, trace_samples(scene, film, of_map));
            }
            if (!going) return false;
        }
        return true;
    }

    // Makes photon map `map` unless it is there.
    Result<bool> shoot(const GpuScene& scene, const Film& film, const TraceRequest& request, std::uint32_t map) {
        if (caustics_.has(map, request.seed)) return true;
        if (map > 0 && !caustics_.knows_radius(request.seed)) {
            RESTAGE_TRY(const bool going, shoot(scene, film, request, 0));
            if (!going) return false;
        }
        RESTAGE_TRY(const bool ready, running_->need_photons(request.keep_going));
        if (!ready || (request.keep_going && !request.keep_going())) return false;
        const std::uint32_t paths = CausticPhotons::paths_per_map(film.width() * film.rows());
        caustics_.begin(map, request.seed, paths);
        for (std::uint32_t first = 0; first < paths; first += wave_paths) {
            RESTAGE_CHECK(caustics_.next_wave(first));
            shared::FrameData f = frame_of(film, request);
            RESTAGE_CHECK(begin_wave(scene, f));
            RESTAGE_TRY(const bool done, bounces(scene, running_->photons(), std::min(paths - first, wave_paths),
                                                 request.keep_going, [&] { caustics_.collect(active_); }));
            if (!done) return false;
        }
        RESTAGE_CHECK(caustics_.finish(scene, *embree_));
        return true;
    }

    // Which instances have delta lobes is known only to materials: camera paths find out, whose samples do not count.
    Result<bool> find_casters(const GpuScene& scene, const Film& film, const TraceRequest& request) {
        const bool all = scene.all_caustics();
        RESTAGE_CHECK(caustics_.start(scene, std::vector<char>(scene.instances().size()), all));
        const std::uint32_t pixels = film.width() * film.height(), most = std::min(pixels, wave_paths / 16);
        std::vector<PixelSamples> some(std::size_t(film.width()) * film.rows());
        for (std::uint32_t k = 0; k < most; ++k)
            some[std::size_t(std::uint64_t(k) * pixels / most)] = {0, 1};
        TraceRequest asked = request;
        asked.pixels = some;
        asked.seed = 0;
        SamplePlan plan(asked, film.width() * film.rows(), wave_paths, 1);
        if (!plan.next()) return true;
        shared::FrameData f = frame_of(film, asked);
        f.picks = place(plan);
        RESTAGE_CHECK(begin_wave(scene, f));
        casters_.assign(scene.instances().size(), 0);
        const TraceStats before = stats_; // these are no samples
        auto done = bounces(scene, running_->generate(), std::uint32_t(plan.picks().size()), request.keep_going, [] {});
        std::vector<char> found = std::exchange(casters_, {});
        stats_.rays = before.rays, stats_.shadow_rays = before.shadow_rays;
        if (!done || !*done) {
            caustics_.forget();
            return done;
        }
        RESTAGE_CHECK(caustics_.start(scene, std::move(found), all));
        return true;
    }

    // Writes the plan's wave for the kernels. The address of its samples.
    std::uint64_t place(const SamplePlan& plan) {
        const std::size_t count = plan.picks().size();
        auto picks = picks_.span<shared::SamplePick>();
        std::ranges::copy(plan.picks(), picks.begin());
        std::fill(picks.begin() + std::ptrdiff_t(count),
                  picks.begin() + std::ptrdiff_t(whole_groups(std::uint32_t(count))), plan.picks().back());
        std::ranges::copy(plan.runs(), runs_.span<shared::SampleRun>().begin());
        return picks_.address();
    }

    // False: the film has nothing of this wave.
    Result<bool> wave(const GpuScene& scene, shared::FrameData& f, const SamplePlan& plan,
                      const std::function<bool()>& keep_going) {
        const auto count = std::uint32_t(plan.picks().size()), run_count = std::uint32_t(plan.runs().size());
        f.picks = place(plan);
        f.runs = runs_.address();
        f.run_count = run_count;
        RESTAGE_CHECK(begin_wave(scene, f));
        stats_.paths += count;
        RESTAGE_TRY(const bool done, bounces(scene, running_->generate(), count, keep_going, [] {}));
        if (!done) return false;
        RESTAGE_CHECK(submit([&](gpu::CommandList& list) { dispatch(list, running_->accumulate(), 0, run_count); }));
        return true;
    }

    Result<void> begin_wave(const GpuScene& scene, shared::FrameData& f) {
        f.scene = scene.address();
        f.rays = rays_.address();
        f.shadows = shadows_.address();
        f.paths = paths_.address();
        f.guides = guides_.address();
        if (scene.features().spectral && !fourths_) {
            RESTAGE_TRY(fourths_, c_.device.create_buffer(all_paths * sizeof(shared::FourthData),
                                                          gpu::BufferKind::readback, "fourth wavelengths"));
        }
        if (scene.features().spectral) f.fourths = fourths_.address();
        if (scene.features().caustics) f.photons = caustics_.address();
        f.queue = queue_.address();
        f.counters = counters_.address();
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
                 .max_depth = data.max_depth,
                 .russian_roulette = data.russian_roulette,
                 .clamp_direct = data.clamp_direct,
                 .clamp_indirect = data.clamp_indirect,
                 .ray_epsilon = data.ray_epsilon};
        return {};
    }

    // Paths from the kernel that starts them to their ends; after_bounce: each time the active ones were shaded.
    template <class AfterBounce>
    Result<bool> bounces(const GpuScene& scene, const gpu::ComputePipeline& start, std::uint32_t count,
                         const std::function<bool()>& keep_going, AfterBounce&& after_bounce) {
        const std::uint32_t max_depth = scene.data().max_depth;
        RESTAGE_CHECK(submit([&](gpu::CommandList& list) { dispatch(list, start, 0, count); }));
        if (learning_) records_.begin(count);
        active_.resize(count);
        for (std::uint32_t i = 0; i < count; ++i)
            active_[i] = i;
        for (std::uint32_t bounce = 0;; ++bounce) {
            trace_rays(scene, bounce >= max_depth);
            if (scene.any_undecided()) {
                RESTAGE_TRY(const bool decided, decide(scene, bounce >= max_depth, keep_going));
                if (!decided) return false;
            }
            if (learning_)
                records_.note(active_, paths_.span<shared::PathState>(), rays_.span<shared::RayHit>(), c_.jobs);
            queue_hits(scene);
            if (queued_ == 0) return true;
            RESTAGE_TRY(const bool ready, running_->need(std::span(type_count_).first(type_none), keep_going));
            if (!ready) return false;
            RESTAGE_CHECK(submit([&](gpu::CommandList& list) {
                if (type_count_[type_emit]) {
                    dispatch(list, running_->shade(type_emit), type_first_[type_emit], type_count_[type_emit]);
                    list.barrier(); // shading adds to the same radiance
                }
                for (std::size_t t = 0; t < type_none; ++t)
                    if (type_count_[t] && t != type_emit)
                        dispatch(list, running_->shade(t), type_first_[t], type_count_[t]);
            }));
            if (learning_)
                for (const std::size_t t : {type_emit, type_escape})
                    records_.note_light(queue_.span<const std::uint32_t>().subspan(type_first_[t], type_count_[t]),
                                        rays_.span<shared::RayHit>());
            after_bounce();
        }
    }

    void dispatch(gpu::CommandList& list, const gpu::ComputePipeline& kernel, std::uint32_t first,
                  std::uint32_t count) {
        push_.queue_first = first;
        push_.queue_count = count;
        list.dispatch(kernel, gpu::push_bytes(push_), (count + group_size - 1) / group_size);
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

    // A path's last vertex contributes only emission or denoiser guides; but lamps without surface are no vertices.
    static bool ends(const GpuScene& scene, const shared::PathState& path, std::uint32_t instance) {
        const std::uint32_t depth = path.flags & PATH_DEPTH_MASK;
        return depth > 0 && depth >= scene.data().max_depth && !(path.flags & PATH_GUIDED) &&
               !(scene.instances()[instance].flags & INSTANCE_PASSES);
    }

    // Rays of one chunk with hits that native code cannot decide, and these hits.
    struct Open {
        std::uint32_t path = 0;
        bool shadow = false;
        float distance = 0; // of a shadow ray
        std::size_t first = 0, count = 0; // of `hits`
    };
    struct Undecided {
        std::vector<EmbreeScene::Undecided> hits;
        std::vector<Open> open;
    };

    // nullptr in RGB mode.
    shared::FourthData* fourth_of(const GpuScene& scene, std::uint32_t path) {
        return scene.features().spectral ? &fourths_.span<shared::FourthData>()[path] : nullptr;
    }

    // Light that arrives along an unoccluded shadow ray.
    void add_light(const GpuScene& scene, std::uint32_t path, float distance) {
        const shared::ShadowRay& shadow = shadows_.span<shared::ShadowRay>()[path];
        shared::FourthData* fourth = fourth_of(scene, path);
        glm::vec4 c(shadow.contribution, fourth ? fourth->contribution : 0.f);
        if (scene.features().borders) {
            const EmbreeScene::Stretch way{shadow.origin, shadow.direction, 0, distance};
            c *= embree_->pass_borders(way, shadow.medium, fourth ? fourth->hero : 0.f).transmittance;
        }
        paths_.span<shared::PathState>()[path].radiance += glm::vec3(c);
        if (fourth) fourth->radiance += c.w;
    }

    // Adds the unoccluded shadow-ray contributions of these paths. Returns the number of rays.
    std::uint32_t trace_shadows(const GpuScene& scene, std::span<const std::uint32_t> active, Undecided* undecided) {
        auto shadows = shadows_.span<shared::ShadowRay>();
        auto paths = paths_.span<shared::PathState>();
        std::uint32_t traced = 0;
        for (std::size_t a = 0; a < active.size(); ++a) {
            if (a + ahead < active.size()) {
                __builtin_prefetch(&shadows[active[a + ahead]]);
                __builtin_prefetch(&paths[active[a + ahead]]);
            }
            shared::ShadowRay& shadow = shadows[active[a]];
            if (!(shadow.tfar > 0)) continue;
            ++traced;
            const float distance = shadow.tfar;
            const std::size_t first = undecided ? undecided->hits.size() : 0;
            embree_->occluded(shadow, undecided ? &undecided->hits : nullptr);
            const bool is_free = shadow.tfar > 0;
            shadow.tfar = -1;
            if (undecided && !is_free) undecided->hits.resize(first);
            if (undecided && undecided->hits.size() > first)
                undecided->open.push_back({active[a], true, distance, first, undecided->hits.size() - first});
            else if (is_free)
                add_light(scene, active[a], distance);
        }
        return traced;
    }

    // The type that shades this hit or miss. `material`: of a hit, if already known.
    std::uint8_t shader_of(const GpuScene& scene, std::uint32_t i, bool last_vertex,
                           std::optional<std::uint32_t> material = std::nullopt) {
        shared::RayHit& ray = rays_.span<shared::RayHit>()[i];
        shared::PathState& path = paths_.span<shared::PathState>()[i];
        if (scene.features().borders) {
            shared::FourthData* fourth = fourth_of(scene, i);
            const auto passed = embree_->pass_borders({ray.origin, ray.direction, ray.tnear, ray.tfar}, path.medium,
                                                      fourth ? fourth->hero : 0.f);
            path.throughput *= glm::vec3(passed.transmittance);
            if (fourth) fourth->throughput *= passed.transmittance.w;
            path.medium = passed.medium;
        }
        emits_[i] = ray.inst != NONE && (scene.instances()[ray.inst].flags & INSTANCE_EMITS);
        if (ray.inst == NONE) return scene.features().environment ? type_escape : type_none;
        const bool shades = !last_vertex || !ends(scene, path, ray.inst);
        if (!shades && !emits_[i]) return type_none;
        ray.geom = material ? *material : scene.resolve_material(ray.inst, ray.prim, {ray.u, ray.v});
        if (ray.geom == MATERIAL_NOTHING) ray.geom = 0; // the filter accepted it: unreachable
        return shades ? std::uint8_t(scene.materials()[ray.geom].type) : type_none;
    }

    // The instance that a ray left by a delta lobe.
    void note_caster(const GpuScene& scene, std::uint32_t i) {
        const std::uint32_t flags = paths_.span<shared::PathState>()[i].flags,
                            inst = rays_.span<shared::RayHit>()[i].inst;
        if ((flags & PATH_DEPTH_MASK) > 0 && (flags & PATH_SPECULAR) && inst != NONE &&
            !(scene.instances()[inst].flags & INSTANCE_PASSES))
            std::atomic_ref(casters_[inst]).store(1, std::memory_order_relaxed);
    }

    // Next hits of these paths: types_ holds each one's type, `count` the number per type.
    std::uint32_t trace_closest(const GpuScene& scene, std::span<const std::uint32_t> active, bool last_vertex,
                                std::array<std::uint32_t, 256>& count, Undecided* undecided) {
        auto rays = rays_.span<shared::RayHit>();
        std::uint32_t traced = 0;
        for (std::size_t a = 0; a < active.size(); ++a) {
            if (a + ahead < active.size()) {
                __builtin_prefetch(&rays[active[a + ahead]]);
                __builtin_prefetch(&rays[active[a + ahead]].u);
            }
            const std::uint32_t i = active[a];
            std::uint8_t type = type_none;
            emits_[i] = 0;
            if (shared::RayHit& ray = rays[i]; ray.tfar > 0) {
                ++traced;
                if (!casters_.empty()) note_caster(scene, i);
                ray.geom = ray.inst = NONE;
                if (undecided && intersect_undecided(scene, i, *undecided)) continue;
                if (!undecided) embree_->intersect(ray);
                type = shader_of(scene, i, last_vertex);
                count[type_emit] += emits_[i];
            }
            types_[i] = type;
            ++count[type];
        }
        return traced;
    }

    // Finds the nearest hit, and undecided ones in front of it. Returns whether there are any.
    bool intersect_undecided(const GpuScene& scene, std::uint32_t i, Undecided& undecided) {
        shared::RayHit& ray = rays_.span<shared::RayHit>()[i];
        auto& hits = undecided.hits;
        const std::size_t first = hits.size();
        embree_->intersect(ray, &hits);
        if (ray.inst != NONE) // those behind it are irrelevant
            hits.erase(std::remove_if(hits.begin() + std::ptrdiff_t(first), hits.end(),
                                      [&](const auto& hit) { return hit.t >= ray.tfar; }),
                       hits.end());
        if (ray.inst != NONE && scene.undecided(ray.inst)) // a mix without gaps: nothing filters its mesh
            hits.push_back({ray.tfar, ray.inst, ray.prim, {ray.u, ray.v}, ray.prim});
        if (hits.size() == first) return false;
        std::sort(hits.begin() + std::ptrdiff_t(first), hits.end(),
                  [](const auto& a, const auto& b) { return a.t < b.t; });
        undecided.open.push_back({.path = i, .first = first, .count = hits.size() - first});
        return true;
    }

    // Lets the device decide all deferred hits, and completes the rays waiting for them. False: keep_going requested a
    // stop.
    Result<bool> decide(const GpuScene& scene, bool last_vertex, const std::function<bool()>& keep_going) {
        std::vector<shared::HitAsked> asked;
        for (const Undecided& u : undecided_)
            for (const auto& hit : u.hits)
                asked.push_back({hit.instance, hit.prim, hit.bary});
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
                list.dispatch(running_->decide(), gpu::push_bytes(push),
                              (std::uint32_t(n) + group_size - 1) / group_size);
            }));
            std::copy_n(decided_.span<shared::HitDecided>().data(), n, decided.data() + first);
        }
        std::vector<std::size_t> begins(undecided_.size());
        for (std::size_t k = 1; k < begins.size(); ++k)
            begins[k] = begins[k - 1] + undecided_[k - 1].hits.size();
        c_.jobs.parallel_for(undecided_.size(), 1, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t k = begin; k < end; ++k)
                settle(scene, undecided_[k], &decided[begins[k]], last_vertex, counts_[k]);
        });
        return true;
    }

    void settle(const GpuScene& scene, const Undecided& undecided, const shared::HitDecided* decided, bool last_vertex,
                std::array<std::uint32_t, 256>& count) {
        auto rays = rays_.span<shared::RayHit>();
        const auto shadows = shadows_.span<shared::ShadowRay>();
        for (const Open& open : undecided.open) {
            shared::RayHit& ray = rays[open.path];
            const shared::ShadowRay& shadow = shadows[open.path];
            const glm::vec3 origin = open.shadow ? shadow.origin : ray.origin;
            const glm::vec3 direction = open.shadow ? shadow.direction : ray.direction;
            std::size_t h = open.first;
            const std::size_t end = open.first + open.count;
            while (h < end &&
                   !scene.stops(undecided.hits[h].instance, undecided.hits[h].choice, decided[h], origin, direction))
                ++h;
            if (open.shadow) {
                if (h == end) add_light(scene, open.path, open.distance);
                continue;
            }
            std::optional<std::uint32_t> material;
            if (h < end) {
                const auto& hit = undecided.hits[h];
                ray.tfar = hit.t, ray.inst = hit.instance, ray.prim = hit.prim;
                ray.u = hit.bary.x, ray.v = hit.bary.y;
                material = decided[h].material;
            }
            const std::uint8_t type = shader_of(scene, open.path, last_vertex, material);
            types_[open.path] = type;
            ++count[type];
            count[type_emit] += emits_[open.path];
        }
    }

    // Shadow rays of the last vertex, then the next hits, for the active paths in natural order.
    void trace_rays(const GpuScene& scene, bool last_vertex) {
        const auto start = Clock::now();
        const std::size_t n = active_.size(), chunks = (n + chunk - 1) / chunk;
        counts_.assign(chunks, {});
        undecided_.resize(scene.any_undecided() ? chunks : 0);
        for (Undecided& u : undecided_) {
            u.hits.clear();
            u.open.clear();
        }
        std::atomic<std::uint64_t> rays_traced = 0, shadows_traced = 0;
        c_.jobs.parallel_for(chunks, 1, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t k = begin; k < end; ++k) {
                const auto paths = std::span(active_).subspan(k * chunk, std::min(chunk, n - k * chunk));
                Undecided* undecided = undecided_.empty() ? nullptr : &undecided_[k];
                shadows_traced += trace_shadows(scene, paths, undecided);
                rays_traced += trace_closest(scene, paths, last_vertex, counts_[k], undecided);
            }
        });
        stats_.rays += rays_traced;
        stats_.shadow_rays += shadows_traced;
        stats_.seconds_tracing += seconds_since(start);
    }

    // Afterwards `queue_` holds the hit paths sorted by type, type_count_ their numbers, active_ those that will be
    // shaded.
    void queue_hits(const GpuScene& scene) {
        const auto start = Clock::now();
        auto queue = queue_.span<std::uint32_t>();
        const std::size_t n = active_.size(), chunks = counts_.size();
        // Start of each chunk's paths of each type in the queue, and of its live ones in the next active list.
        type_count_.fill(0);
        for (auto& c : counts_)
            for (std::size_t t = 0; t < type_none; ++t)
                type_count_[t] += c[t];
        std::array<std::uint32_t, 256> next{};
        for (std::uint32_t t = 1; t < 256; ++t)
            next[t] = next[t - 1] + whole_groups(type_count_[t - 1]);
        type_first_ = next;
        queued_ = next[type_none];
        std::uint32_t live = 0;
        std::vector<std::uint32_t> live_first(chunks);
        for (std::size_t k = 0; k < chunks; ++k) {
            live_first[k] = live;
            for (std::size_t t = 0; t < type_none; ++t) {
                const std::uint32_t c = counts_[k][t];
                counts_[k][t] = next[t];
                next[t] += c;
                live += t < type_emit ? c : 0;
            }
        }
        next_active_.resize(live);
        c_.jobs.parallel_for(chunks, 4, [&](std::size_t begin, std::size_t end, unsigned) {
            for (std::size_t k = begin; k < end; ++k) {
                std::uint32_t to = live_first[k];
                for (std::size_t a = k * chunk; a < std::min(n, (k + 1) * chunk); ++a) {
                    const std::uint32_t i = active_[a];
                    if (emits_[i]) queue[counts_[k][type_emit]++] = i;
                    if (types_[i] == type_none) continue;
                    queue[counts_[k][types_[i]]++] = i;
                    if (types_[i] < type_emit) next_active_[to++] = i;
                }
            }
        });
        fill_groups(scene.features().spectral);
        active_.swap(next_active_);
        stats_.seconds_tracing += seconds_since(start);
    }

    // Completes the last group of each type's queue.
    void fill_groups(bool spectral) {
        auto queue = queue_.span<std::uint32_t>();
        std::uint32_t spare = wave_paths;
        for (std::size_t t = 0; t < type_none; ++t) {
            const std::uint32_t end = type_first_[t] + type_count_[t],
                                whole = type_first_[t] + whole_groups(type_count_[t]);
            for (std::uint32_t k = end; k < whole; ++k, ++spare) {
                const std::uint32_t i = queue[type_first_[t]];
                rays_.span<shared::RayHit>()[spare] = rays_.span<shared::RayHit>()[i];
                paths_.span<shared::PathState>()[spare] = paths_.span<shared::PathState>()[i];
                if (spectral) fourths_.span<shared::FourthData>()[spare] = fourths_.span<shared::FourthData>()[i];
                queue[k] = spare;
            }
        }
    }

    TracerContext c_;
    std::unique_ptr<EmbreeScene> embree_;
    gpu::Buffer rays_, shadows_, paths_, fourths_, guides_, queue_, counters_, picks_, runs_, frame_;
    WaveKernels kernels_;
    CausticPhotons caustics_;
    std::vector<char> casters_; // while they are looked for: by instance
    std::unique_ptr<WaveKernels> guided_kernels_; // where paths are guided
    WaveKernels* running_ = &kernels_;
    PathRecords records_; // of this wave, if
    bool learning_ = false;
    std::vector<Undecided> undecided_; // by chunk of active_
    gpu::Buffer asked_, decided_;
    gpu::CommandList list_;
    shared::WavePush push_{}; // of this wave
    std::vector<std::uint32_t> active_, next_active_;
    std::vector<std::uint8_t> types_, emits_; // by path
    std::vector<std::array<std::uint32_t, 256>> counts_;
    std::array<std::uint32_t, 256> type_count_{}, type_first_{}; // of `queue_`
    std::uint32_t queued_ = 0;
};

} // namespace

Result<std::unique_ptr<Tracer>> make_embree_tracer(const TracerContext& context) {
    auto tracer = std::make_unique<EmbreeTracer>(context);
    RESTAGE_CHECK(tracer->start());
    return tracer;
}

} // namespace restage::render
