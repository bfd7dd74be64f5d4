// SPDX-License-Identifier: Apache-2.0
// The `vulkan` tracer: one ray-tracing pipeline. Raygen loops over a path, a callable a material type does the path
// step, a Blas a mesh and one Tlas over the instances find the hits. A frame goes to the device in rectangles whose
// size follows from measured time, so that no submission holds the device for long.
#include "base/file.hpp"
#include "gpu/accel.hpp"
#include "gpu/pipeline.hpp"
#include "render/tracer.hpp"

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

constexpr double submit_seconds = 0.02; // aimed at; the window stays alive
constexpr std::uint32_t least_side = 8; // of a rectangle, in pixels: coherent rays

constexpr std::uint32_t group_opaque = 0, group_cut_out = 1;

struct Rectangle {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

class VulkanTracer final : public Tracer {
  public:
    explicit VulkanTracer(const TracerContext& c) : c_(c) {}
    const char* name() const override { return "vulkan"; }

    Result<void> start() {
        if (!c_.device.info().ray_tracing)
            return fail("the vulkan tracer needs a device that traces rays: " + c_.device.info().missing_ray_tracing);
        RESTAGE_TRY(counters_, c_.device.create_buffer(COUNTER_COUNT * sizeof(std::uint32_t), gpu::BufferKind::readback,
                                                       "counters"));
        RESTAGE_TRY(frame_, c_.device.create_buffer(sizeof(shared::FrameData), gpu::BufferKind::host, "frame"));
        std::memset(counters_.mapped(), 0, counters_.size());
        return {};
    }

    Result<void> update(const GpuScene& scene, const SceneChanges& changes) override {
        if (changes.shaders) pipeline_ready_ = false;
        if (!changes.meshes.empty()) RESTAGE_CHECK(build_meshes(scene, changes));
        const auto n = std::uint32_t(scene.instances().size());
        const bool grown = !tlas_ || n > tlas_.capacity();
        if (grown) {
            RESTAGE_TRY(tlas_, gpu::Tlas::create(c_.device, n + n / 2, "instances"));
        }
        // fewer: a larger scene was forgotten, and with it the meshes that the acceleration structure points at
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

    Result<void> trace(const GpuScene& scene, Film& film, const TraceRequest& request) override {
        const auto start = Clock::now();
        shared::FrameData f{};
        f.scene = scene.address();
        f.film = film.pixels();
        f.film_guides = film.guides();
        f.counters = counters_.address();
        f.first_sample = request.first_sample;
        f.crop_x = request.crop_x;
        f.crop_y = request.crop_y;
        f.crop_width = film.width();
        f.pixel_count = film.width() * film.height();
        f.seed = request.seed;
        RESTAGE_CHECK(make_pipeline(scene, request, f));
        f.samples = request.samples;
        RESTAGE_CHECK(c_.device.upload(frame_, 0, std::as_bytes(std::span(&f, 1))));
        RESTAGE_CHECK(trace_rectangles(film, request));
        stats_.seconds += seconds_since(start);
        auto counts = counters_.span<std::uint32_t>();
        for (std::size_t i = 0; i < std::min<std::size_t>(scene.types().size(), COUNTER_MAX_TYPES); ++i)
            if (counts[i]) stats_.not_finite[scene.types()[i].type] += std::exchange(counts[i], 0);
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

    gpu::TlasInstance tlas_instance(const GpuScene& scene, std::uint32_t i) const {
        gpu::TlasInstance out;
        if (!scene.traced(i)) return out; // nothing is there
        const shared::InstanceData& data = scene.instances()[i];
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                out.transform[std::size_t(row * 4 + column)] = data.object_to_world[column][row];
        out.blas = blas_.at(scene.mesh_of(i).value).address();
        out.custom_index = i;
        const bool cut_out = data.flags & INSTANCE_HAS_ALPHA;
        out.hit_group = cut_out ? group_cut_out : group_opaque;
        out.force_any_hit = cut_out;
        return out;
    }

    // One callable a material type, at the type's index. `f`: what a dry run is given.
    Result<void> make_pipeline(const GpuScene& scene, const TraceRequest& request, const shared::FrameData& f) {
        if (pipeline_ready_ && guides_on_ == request.guides && strategy_ == request.strategy) return {};
        stats_.shader_bytes = 0;
        const auto compile = [&](const gpu::ShaderSource& source) -> Result<gpu::Spirv> {
            auto spirv = c_.compiler.compile(source);
            if (spirv) stats_.shader_bytes += spirv->words.size() * 4;
            return spirv;
        };
        const auto file = [&](const char* name, gpu::ShaderStage stage) -> Result<gpu::Spirv> {
            RESTAGE_TRY(auto text, read_file(c_.shader_dir / name));
            return compile({.name = (c_.shader_dir / name).string(), .text = std::move(text), .stage = stage});
        };
        RESTAGE_TRY(const auto raygen, file("trace.rgen", gpu::ShaderStage::raygen));
        RESTAGE_TRY(const auto miss, file("trace.rmiss", gpu::ShaderStage::miss));
        RESTAGE_TRY(const auto closest_hit, file("trace.rchit", gpu::ShaderStage::closest_hit));
        RESTAGE_TRY(const auto any_hit, file("trace.rahit", gpu::ShaderStage::any_hit));

        const auto& types = scene.types();
        std::vector<gpu::Spirv> steps(types.size());
        std::vector<const gpu::Spirv*> callables(types.size(), nullptr);
        std::vector<std::vector<gpu::SpecConstant>> callable_constants(types.size());
        bool mixes = false;
        for (std::size_t i = 0; i < types.size(); ++i) {
            mixes |= types[i].mix();
            if (!types[i].plugin.table || !types[i].plugin.table->glsl_file) continue;
            RESTAGE_TRY(steps[i],
                        compile(compose_material(types[i], "trace_material.glsl", gpu::ShaderStage::callable)));
            callables[i] = &steps[i];
            callable_constants[i] = spec_constants(scene.features(), request.guides, request.strategy, &types[i]);
        }
        // Types without GLSL (mixes are resolved before, interfaces are not hit) keep their index.
        const std::size_t placeholder = scene.materials()[0].type;
        for (std::size_t i = 0; i < types.size(); ++i)
            if (!callables[i]) {
                callables[i] = callables[placeholder];
                callable_constants[i] = callable_constants[placeholder];
            }
        auto constants = spec_constants(scene.features(), request.guides, request.strategy);
        constants.push_back({9, mixes});
        const gpu::Spirv* const misses[] = {&miss};
        const gpu::HitGroup groups[] = {{&closest_hit, nullptr}, {&closest_hit, &any_hit}};
        RESTAGE_TRY(pipeline_, gpu::RayTracingPipeline::create(c_.device,
                                                               {.raygen = &raygen,
                                                                .misses = misses,
                                                                .hit_groups = groups,
                                                                .callables = callables,
                                                                .callable_constants = callable_constants},
                                                               sizeof(shared::TracePush), constants, "path tracer"));
        // The driver compiles at the first launch (lavapipe); out of the way of the time measured below.
        RESTAGE_CHECK(c_.device.upload(frame_, 0, std::as_bytes(std::span(&f, 1)))); // no samples: raygen returns
        RESTAGE_CHECK(submit({0, 0, 1, 1}, 0, 1));
        pipeline_ready_ = true;
        guides_on_ = request.guides;
        strategy_ = request.strategy;
        return {};
    }

    Result<void> trace_rectangles(const Film& film, const TraceRequest& request) {
        const std::uint32_t width = film.width(), height = film.height();
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

    Result<void> submit_timed(const Rectangle& r, std::uint32_t first_sample, std::uint32_t samples) {
        const auto start = Clock::now();
        RESTAGE_CHECK(submit(r, first_sample, samples));
        const double seconds = std::max(seconds_since(start), 1e-6);
        const std::uint32_t paths = r.width * r.height * samples;
        stats_.paths += paths;
        auto counts = counters_.span<std::uint32_t>();
        stats_.rays += std::exchange(counts[COUNTER_RAYS], 0);
        stats_.shadow_rays += std::exchange(counts[COUNTER_SHADOW_RAYS], 0);
        // Half way to what would have taken the time aimed at; up to four times as much.
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
            list_.trace(pipeline_, gpu::push_bytes(push), r.width, r.height);
        }
        return c_.device.submit_and_wait(list_);
    }

    TracerContext c_;
    std::map<std::uint32_t, gpu::Blas> blas_; // by Id<Mesh>::value
    gpu::Tlas tlas_; // index = InstanceData index
    gpu::RayTracingPipeline pipeline_;
    gpu::Buffer counters_, frame_;
    bool pipeline_ready_ = false, guides_on_ = false;
    Strategy strategy_ = Strategy::mis;
    gpu::CommandList list_;
    std::uint32_t instances_ = 0; // in tlas_
    std::uint32_t paths_now_ = 1024; // a submission
};

} // namespace

Result<std::unique_ptr<Tracer>> make_vulkan_tracer(const TracerContext& context) {
    auto tracer = std::make_unique<VulkanTracer>(context);
    RESTAGE_CHECK(tracer->start());
    return tracer;
}

} // namespace restage::render
