// SPDX-License-Identifier: Apache-2.0
// The `vulkan` tracer: one ray-tracing pipeline. Raygen loops over a path, a callable per material type does the path
// step, a Blas per mesh and one Tlas over the instances find the hits. The pipeline is built on a worker. Frames go to
// the device in rectangles whose size follows from measured time, so that no submission holds the device for long.
#include "base/file.hpp"
#include "gpu/accel.hpp"
#include "gpu/pipeline.hpp"
#include "render/pipeline_store.hpp"
#include "render/sample_plan.hpp"
#include "render/texture_composer.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <utility>

namespace restage::render {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

constexpr double submit_seconds = 0.02; // target; keeps the window responsive
constexpr std::uint32_t least_side = 8; // of a rectangle, in pixels: coherent rays

constexpr std::uint32_t group_opaque = 0, group_cut_out = 1, group_quadrics = 2; // then the same two for quadrics
constexpr unsigned mask_surfaces = 1, mask_borders = 2, mask_shadows = 4; // of shaders/trace_common.glsl

// Number of callables for so many types: with room for more that are added while rendering continues.
std::size_t callable_slots(std::size_t types) { return (types / 32 + 1) * 32; }

// Photon maps are the wavefront's.
SceneFeatures without_caustics(SceneFeatures f) {
    f.caustics = false;
    return f;
}

struct Rectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

class VulkanTracer final : public Tracer {
  public:
    explicit VulkanTracer(const TracerContext& c) : c_(c), store_(c) {}
    const char* name() const override { return "vulkan"; }

    Result<void> start() {
        if (!c_.device.info().ray_tracing)
            return fail("the vulkan tracer needs a device with ray tracing: " + c_.device.info().missing_ray_tracing);
        RESTAGE_TRY(counters_, c_.device.create_buffer(COUNTER_COUNT * sizeof(std::uint32_t), gpu::BufferKind::readback,
                                                       "counters"));
        RESTAGE_TRY(frame_, c_.device.create_buffer(sizeof(shared::FrameData), gpu::BufferKind::host, "frame"));
        std::memset(counters_.mapped(), 0, counters_.size());
        return {};
    }

    Result<void> update(const GpuScene& scene, const SceneChanges& changes) override {
        if (changes.shaders) RESTAGE_CHECK(select(scene));
        if (!changes.meshes.empty()) RESTAGE_CHECK(build_meshes(scene, changes));
        const auto n = std::uint32_t(scene.instances().size());
        const bool grown = !tlas_ || n > tlas_.capacity();
        if (grown) {
            RESTAGE_TRY(tlas_, gpu::Tlas::create(c_.device, n + n / 2, "instances"));
        }
        // fewer: a larger scene was forgotten, and with it the meshes referenced by the acceleration structure
        const bool resized = n != std::exchange(instances_, n);
        if (!grown && !resized && changes.instances.empty() && changes.meshes.empty()) return {};
        tlas_.resize(n);
        if (grown)
            for (std::uint32_t i = 0; i < n; ++i)
                tlas_.set(i, tlas_instance(scene, i));
        else
            for (const auto id : changes.instances)
                tlas_.set(id.value, tlas_instance(scene, id.value));
        return tlas_.build();
    }

    bool adopt() override {
        store_.settle();
        if (!wanted_) return false;
        store_.keep(wanted_);
        if (wanted_->building()) return false;
        if (wanted_->pipeline) {
            arrive();
            return std::exchange(shown_, false);
        }
        if (shown_) c_.log.error(wanted_->error); // the current look stays until something changes
        if (shown_) wanted_ = nullptr;
        return false;
    }
    std::optional<CompileProgress> compiling() const override {
        auto progress = store_.compiling();
        if (!progress && wanted_ && shown_) progress = {.what = wanted_->what, .left = 1}; // built since adopt()
        return progress;
    }
    void film_emptied() override { shown_ = false; }

    Result<void> trace(const GpuScene& scene, Film& film, const TraceRequest& request) override {
        const auto start = Clock::now();
        RESTAGE_TRY(const bool ready, prepare(scene, request.keep_going));
        if (!ready) return {};
        shared::FrameData f{};
        f.scene = scene.address();
        f.film = film.pixels();
        f.film_guides = film.guides();
        f.counters = counters_.address();
        f.first_sample = request.first_sample;
        f.crop_x = request.crop_x;
        f.crop_y = request.crop_y;
        f.crop_width = film.width();
        f.crop_height = film.height();
        f.seed = request.seed;
        f.samples = request.samples;
        if (request.pixels.empty()) {
            RESTAGE_CHECK(c_.device.upload(frame_, 0, std::as_bytes(std::span(&f, 1))));
            RESTAGE_CHECK(trace_rectangles(film, request));
        } else {
            RESTAGE_CHECK(trace_picks(film, request, f));
        }
        stats_.seconds += seconds_since(start);
        stats_.shader_bytes = pipeline_->shader_bytes();
        auto counts = counters_.span<std::uint32_t>();
        for (std::size_t i = 0; i < std::min<std::size_t>(scene.types().size(), COUNTER_MAX_TYPES); ++i)
            if (counts[i]) stats_.not_finite[scene.types()[i].type] += std::exchange(counts[i], 0);
        if (counts[COUNTER_FILM]) stats_.dropped += std::exchange(counts[COUNTER_FILM], 0);
        return {};
    }

  private:
    Result<void> build_meshes(const GpuScene& scene, const SceneChanges& changes) {
        std::erase_if(blas_, [&](const auto& entry) { return !scene.mesh({entry.first}); });
        std::vector<gpu::BlasInput> inputs;
        std::vector<std::uint32_t> ids;
        for (const auto id : changes.meshes) {
            const GpuMesh* mesh = scene.mesh(id);
            if (!mesh) continue;
            if (mesh->quadric) {
                blas_.erase(id.value);
                if (!box_) RESTAGE_CHECK(build_box());
                continue;
            }
            inputs.push_back({.vertices = mesh->positions,
                              .vertex_count = mesh->vertex_count,
                              .indices = mesh->indices,
                              .triangle_count = mesh->triangle_count,
                              .name = mesh->buffer.name()});
            ids.push_back(id.value);
        }
        RESTAGE_TRY(auto built, gpu::build_blas(c_.device, inputs));
        for (std::size_t i = 0; i < ids.size(); ++i)
            blas_[ids[i]] = std::move(built[i]);
        return {};
    }

    // The geometry of all quadrics: one box, placed around each by its instance.
    Result<void> build_box() {
        const VkAabbPositionsKHR unit{-1, -1, -1, 1, 1, 1};
        RESTAGE_TRY(gpu::Buffer buffer, c_.device.create_buffer(sizeof unit, gpu::BufferKind::host, "box of quadrics"));
        RESTAGE_CHECK(c_.device.upload(buffer, 0, std::as_bytes(std::span(&unit, 1))));
        const gpu::BlasInput input{.boxes = buffer.address(), .box_count = 1, .name = "box of quadrics"};
        RESTAGE_TRY(auto built, gpu::build_blas(c_.device, std::span(&input, 1)));
        box_ = std::move(built[0]);
        return {};
    }

    gpu::TlasInstance tlas_instance(const GpuScene& scene, std::uint32_t i) const {
        gpu::TlasInstance out;
        if (!scene.traced(i) && !scene.border(i)) return out; // empty
        const shared::InstanceData& data = scene.instances()[i];
        const glm::mat4x3 placement = scene.placement(i);
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                out.transform[std::size_t(row * 4 + column)] = placement[column][row];
        const bool quadric = scene.is_quadric(i);
        out.blas = quadric ? box_.address() : blas_.at(scene.mesh_of(i).value).address();
        out.custom_index = i;
        out.mask = std::uint8_t((scene.traced(i) ? mask_surfaces : 0) | (scene.border(i) ? mask_borders : 0) |
                                (scene.opaque(i) ? mask_shadows : 0));
        const bool cut_out = data.flags & (INSTANCE_HAS_ALPHA | INSTANCE_HAS_GAPS);
        out.hit_group = (cut_out ? group_cut_out : group_opaque) + (quadric ? group_quadrics : 0);
        out.force_any_hit = cut_out;
        return out;
    }

    // One callable per material type, at the type's index. `plain`: a stand-in for all of them.
    Result<gpu::RayTracingRequest> request(const GpuScene& scene, bool plain) const {
        gpu::RayTracingRequest r{.misses = {1},
                                 .hit_groups = {{2, gpu::RayTracingRequest::none}, {2, 3}},
                                 .push_constant_bytes = sizeof(shared::TracePush),
                                 .name = "path tracer"};
        std::vector<std::pair<const char*, gpu::ShaderStage>> files = {{"trace.rgen", gpu::ShaderStage::raygen},
                                                                       {"trace.rmiss", gpu::ShaderStage::miss},
                                                                       {"trace.rchit", gpu::ShaderStage::closest_hit},
                                                                       {"trace.rahit", gpu::ShaderStage::any_hit}};
        if (scene.features().quadrics) {
            r.hit_groups.push_back({2, gpu::RayTracingRequest::none, 4});
            r.hit_groups.push_back({2, 3, 4});
            files.emplace_back("trace.rint", gpu::ShaderStage::intersection);
        }
        for (const auto& [name, stage] : files) {
            const auto path = c_.shader_dir / name;
            RESTAGE_TRY(auto text, read_file(path));
            gpu::ShaderSource source{.name = path.string(), .text = std::move(text), .stage = stage};
            set_color_mode(color_mode(scene.features()), source);
            if (stage != gpu::ShaderStage::miss && stage != gpu::ShaderStage::closest_hit)
                insert_textures(scene.texture_types(), source); // cut-outs, mixes
            r.shaders.push_back(std::move(source));
        }
        const auto& types = scene.types();
        const std::size_t placeholder = scene.materials()[0].type; // the first type
        const auto shader = [&](gpu::ShaderSource source) {
            r.shaders.push_back(std::move(source));
            return r.shaders.size() - 1;
        };
        std::size_t stand_in = 0; // index of its shader; 0: none yet
        const auto add_stand_in = [&] {
            if (!stand_in)
                stand_in = shader(compose_stand_in(types[placeholder], "trace_material.glsl",
                                                   gpu::ShaderStage::callable, color_mode(scene.features())));
            r.callables.push_back(stand_in);
            r.callable_constants.push_back(spec_constants(without_caustics(scene.features()), true, c_.strategy));
        };
        bool mixes = c_.stand_ins;
        for (const MaterialType& type : types) {
            mixes |= type.mix();
            if (!plain && type.used && type.plugin.table && type.plugin.table->has_code()) {
                r.callables.push_back(shader(compose_material(
                    type, "trace_material.glsl", gpu::ShaderStage::callable, color_mode(scene.features()),
                    evaluates_textures(scene.features(), type) ? scene.texture_types() : TextureTypes())));
                r.callable_constants.push_back(
                    spec_constants(without_caustics(scene.features()), true, c_.strategy, &type));
            } else if (plain || c_.stand_ins) {
                add_stand_in();
            } else { // never called (mixes are resolved earlier, interfaces are passed), but keeps its index
                r.callables.push_back(r.callables.at(placeholder));
                r.callable_constants.push_back(r.callable_constants.at(placeholder));
            }
        }
        while (c_.stand_ins && r.callables.size() < callable_slots(types.size()))
            add_stand_in();
        r.constants = spec_constants(without_caustics(scene.features()), true, c_.strategy);
        r.constants.push_back({9, mixes});
        return r;
    }

    Result<void> select(const GpuScene& scene) {
        if (std::exchange(scene_, &scene) != &scene) pipeline_ = nullptr; // with other numbers of texture types
        RESTAGE_TRY(auto made, request(scene, false));
        wanted_ = store_.want("path tracer", std::move(made));
        wanted_types_.clear();
        for (const auto& type : scene.types())
            wanted_types_.push_back(type.type + word_layout(type.plugin.table) +
                                    (scene.features().spectral ? "s" : ""));
        shown_ = false;
        if (wanted_->pipeline) arrive();
        return {};
    }
    void arrive() {
        pipeline_ = wanted_->pipeline;
        pipeline_types_ = wanted_types_;
        wanted_ = nullptr;
    }

    // A pipeline for the scene, possibly with stand-ins. False: keep_going requested a stop.
    Result<bool> prepare(const GpuScene& scene, const std::function<bool()>& keep_going) {
        if (!wanted_) return true;
        if (wanted_->cancelled()) RESTAGE_CHECK(select(scene)); // it was unwanted for too long
        if (!wanted_) return true;
        if (!c_.stand_ins) {
            RESTAGE_TRY(const bool built, store_.wait(wanted_, keep_going));
            if (built) arrive();
            return built;
        }
        store_.keep(wanted_);
        const std::size_t n = std::min(pipeline_types_.size(), wanted_types_.size());
        const bool fits =
            pipeline_ && wanted_types_.size() <= callable_slots(pipeline_types_.size()) &&
            std::equal(pipeline_types_.begin(), pipeline_types_.begin() + std::ptrdiff_t(n), wanted_types_.begin());
        if (!fits) { // the first pipeline, or one for another scene
            RESTAGE_TRY(auto made, request(scene, true));
            const auto plain = store_.want("stand-in", std::move(made));
            RESTAGE_TRY(const bool built, store_.wait(plain, keep_going));
            if (!built) return false;
            pipeline_ = plain->pipeline;
            pipeline_types_ = wanted_types_;
        }
        shown_ = true;
        return true;
    }

    Result<void> trace_rectangles(const Film& film, const TraceRequest& request) {
        const std::uint32_t width = film.width(), height = film.rows();
        for (std::uint32_t s = 0, samples = 0; s < request.samples; s += samples) {
            samples = std::clamp(paths_now_ / (width * height), 1u, request.samples - s);
            Rectangle r;
            for (r.y = 0; r.y < height; r.y += r.height) {
                r.height = std::min(std::max(paths_now_ / width, least_side), height - r.y);
                for (r.x = 0; r.x < width; r.x += r.width) {
                    if (request.keep_going && !request.keep_going()) return {};
                    r.width = std::min(std::max(paths_now_ / r.height, least_side), width - r.x);
                    RESTAGE_CHECK(submit_timed(r, s, samples));
                }
            }
        }
        return {};
    }

    // One sample of each of some pixels after the other.
    Result<void> trace_picks(const Film& film, const TraceRequest& request, shared::FrameData& f) {
        constexpr std::uint32_t most = 1 << 16;
        if (!picks_) {
            RESTAGE_TRY(picks_,
                        c_.device.create_buffer(most * sizeof(shared::SamplePick), gpu::BufferKind::host, "samples"));
        }
        f.picks = picks_.address();
        SamplePlan plan(request, film.width() * film.rows(), most, 1);
        while (plan.next()) {
            const auto count = std::uint32_t(plan.picks().size());
            f.samples = count;
            RESTAGE_CHECK(c_.device.upload(picks_, 0, std::as_bytes(plan.picks())));
            RESTAGE_CHECK(c_.device.upload(frame_, 0, std::as_bytes(std::span(&f, 1))));
            Rectangle r;
            r.height = 1;
            for (r.x = 0; r.x < count; r.x += r.width) {
                if (request.keep_going && !request.keep_going()) return {};
                r.width = std::min(std::max(paths_now_, least_side), count - r.x);
                RESTAGE_CHECK(submit_timed(r, 0, 1));
            }
        }
        return {};
    }

    Result<void> submit_timed(const Rectangle& r, std::uint32_t first_sample, std::uint32_t samples) {
        const auto start = Clock::now();
        RESTAGE_CHECK(submit(r, first_sample, samples));
        const double seconds = std::max(seconds_since(start), 1e-6);
        const std::uint32_t paths = r.width * r.height * samples;
        stats_.paths += paths;
        auto counts = counters_.span<std::uint32_t>();
        stats_.rays += std::exchange(counts[COUNTER_RAYS], 0);
        stats_.shadow_rays += std::exchange(counts[COUNTER_SHADOW_RAYS], 0);
        // Half way to what would have taken the target time; at most four times as much.
        const double wanted = std::min(paths / seconds * submit_seconds, 4.0 * paths_now_);
        paths_now_ = std::uint32_t(std::clamp(0.5 * (paths_now_ + wanted), 64.0, double(1 << 24)));
        return {};
    }

    Result<void> submit(const Rectangle& r, std::uint32_t first_sample, std::uint32_t samples) {
        if (!list_) {
            RESTAGE_TRY(list_, c_.device.begin());
        } else {
            list_.reset();
        }
        for (std::uint32_t s = 0; s < samples; ++s) {
            if (s > 0) list_.barrier(); // the next sample adds to the same pixels
            const shared::TracePush push{frame_.address(), tlas_.address(), r.x, r.y, first_sample + s, 0};
            list_.trace(*pipeline_, gpu::push_bytes(push), r.width, r.height);
        }
        return c_.device.submit_and_wait(list_);
    }

    TracerContext c_;
    std::map<std::uint32_t, gpu::Blas> blas_; // by Id<Mesh>::value
    gpu::Blas box_;
    gpu::Tlas tlas_; // index = InstanceData index
    PipelineStore<gpu::RayTracingPipeline> store_;
    const void* scene_ = nullptr; // of the last select(), to tell it from another
    std::shared_ptr<const gpu::RayTracingPipeline> pipeline_;
    std::vector<std::string> pipeline_types_; // of its callables
    PipelineStore<gpu::RayTracingPipeline>::EntryPtr wanted_; // nullptr: pipeline_ is up to date
    std::vector<std::string> wanted_types_;
    bool shown_ = false; // the film contains something other than the wanted pipeline's result
    gpu::Buffer counters_, frame_;
    gpu::Buffer picks_; // once needed
    gpu::CommandList list_;
    std::uint32_t instances_ = 0; // in tlas_
    std::uint32_t paths_now_ = 1024; // per submission
};

} // namespace

Result<std::unique_ptr<Tracer>> make_vulkan_tracer(const TracerContext& context) {
    auto tracer = std::make_unique<VulkanTracer>(context);
    RESTAGE_CHECK(tracer->start());
    return tracer;
}

} // namespace restage::render
