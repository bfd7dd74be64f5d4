// SPDX-License-Identifier: Apache-2.0
#include "gpu/pipeline_builder.hpp"

#include "base/file.hpp"
#include "base/thread_priority.hpp"
#include "gpu/device.hpp"

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>

namespace restage::gpu {

namespace {

// Everything under our control that the driver's generated code depends on.
std::uint64_t identity(const std::vector<Spirv>& shaders, const std::vector<SpecConstant>& constants,
                       const DeviceInfo& info) {
    std::uint64_t hash = hash64(info.uuid.data(), info.uuid.size());
    for (const Spirv& shader : shaders)
        hash = hash64(shader.key, hash);
    for (const SpecConstant& c : constants)
        hash = hash64(&c, sizeof c, hash);
    return hash;
}

// Marks the pipelines expected in the driver's disk cache: one empty file each, inside that cache, so that
// deleting the cache deletes the marks. A wrong mark costs one stall, the one this class avoids.
class Marks {
  public:
    Marks() {
        if (const char* cache = std::getenv("MESA_SHADER_CACHE_DIR"))
            folder_ = std::filesystem::path(cache) / "restage-built";
    }
    bool has(std::uint64_t id) const {
        std::error_code failed;
        return !folder_.empty() && std::filesystem::exists(folder_ / std::to_string(id), failed);
    }
    void add(std::uint64_t id) const {
        if (folder_.empty()) return;
        std::error_code failed;
        std::filesystem::create_directories(folder_, failed);
        (void)write_file_atomic(folder_ / std::to_string(id), "");
    }

  private:
    std::filesystem::path folder_;
};

Result<void> run_nothing(Device& device, const ComputePipeline& pipeline) {
    const std::vector<std::byte> zero(pipeline.push_constant_bytes());
    RESTAGE_TRY(CommandList list, device.begin());
    list.dispatch(pipeline, zero, 0);
    return device.submit_and_wait(list);
}

Result<void> run_nothing(Device& device, const RayTracingPipeline& pipeline) {
    const std::vector<std::byte> zero(pipeline.push_constant_bytes());
    RESTAGE_TRY(CommandList list, device.begin());
    list.trace(pipeline, zero, 0, 0);
    return device.submit_and_wait(list);
}

Result<ComputePipeline> create(Device& device, const ComputeRequest& request, const std::vector<Spirv>& shaders) {
    return ComputePipeline::create(device, shaders.front(), request.push_constant_bytes, request.constants,
                                   request.name.c_str());
}

Result<RayTracingPipeline> create(Device& device, const RayTracingRequest& request, const std::vector<Spirv>& shaders) {
    const auto at = [&](std::size_t i) { return i == RayTracingRequest::none ? nullptr : &shaders[i]; };
    std::vector<const Spirv*> misses, callables;
    std::vector<HitGroup> groups;
    for (std::size_t i : request.misses)
        misses.push_back(at(i));
    for (std::size_t i : request.callables)
        callables.push_back(at(i));
    for (const auto& group : request.hit_groups)
        groups.push_back({at(group.closest_hit), at(group.any_hit), at(group.intersection)});
    return RayTracingPipeline::create(device,
                                      {.raygen = at(request.raygen),
                                       .misses = misses,
                                       .hit_groups = groups,
                                       .callables = callables,
                                       .callable_constants = request.callable_constants},
                                      request.push_constant_bytes, request.constants, request.name.c_str());
}

std::vector<SpecConstant> constants_of(const ComputeRequest& request) { return request.constants; }
std::vector<SpecConstant> constants_of(const RayTracingRequest& request) {
    std::vector<SpecConstant> all = request.constants;
    for (const auto& own : request.callable_constants)
        all.insert(all.end(), own.begin(), own.end());
    return all;
}

std::vector<const ShaderSource*> sources_of(const ComputeRequest& request) { return {&request.shader}; }
std::vector<const ShaderSource*> sources_of(const RayTracingRequest& request) {
    std::vector<const ShaderSource*> sources;
    for (const ShaderSource& source : request.shaders)
        sources.push_back(&source);
    return sources;
}

std::string was_cancelled(const std::string& name) { return "building pipeline " + name + " was cancelled"; }

} // namespace

struct PipelineBuilder::Impl {
    Device& device;
    const ShaderCompiler& compiler;
    const Stalls stalls;
    const Marks marks;
    std::mutex mutex;
    std::condition_variable wake;
    using Job = std::function<void(bool stop)>; // stop: only reply
    std::deque<Job> jobs;
    bool stopping = false;
    std::vector<std::thread> threads;

    Impl(Device& d, const ShaderCompiler& c, Stalls s) : device(d), compiler(c), stalls(s) {}

    void work() {
        if (stalls == Stalls::avoid) lower_thread_priority(5); // who shows pictures meanwhile goes first
        for (;;) {
            Job job;
            {
                std::unique_lock lock(mutex);
                wake.wait(lock, [&] { return stopping || !jobs.empty(); });
                if (stopping) return;
                job = std::move(jobs.front());
                jobs.pop_front();
            }
            job(false);
        }
    }

    // On a CPU: once on a device local to this function. The driver writes its cache in the background
    // and waits for that only when the device (with its instance) goes; else the main device might look too early and
    // recompile on its own queue.
    template <class Request>
    void warm(const Request& request, const std::vector<Spirv>& shaders) {
        auto own = Device::create({.select = std::to_string(device.info().index)}, device.log());
        if (!own) return device.log().debug("pipelines are not built ahead: " + own.error().message);
        const auto pipeline = create(**own, request, shaders);
        if (pipeline) (void)run_nothing(**own, *pipeline); // a failure here recurs, and is reported, on the main device
    }

    template <class Pipeline, class Request>
    Result<Pipeline> make(const Request& request) {
        const CrashNote note(request.blame);
        std::vector<Spirv> shaders;
        for (const ShaderSource* source : sources_of(request)) {
            if (request.stop.stop_requested()) return cancelled(was_cancelled(request.name));
            RESTAGE_TRY(Spirv spirv, compiler.compile(*source));
            shaders.push_back(std::move(spirv));
        }
        const bool cpu = device.info().type == DeviceType::cpu;
        const std::uint64_t id = identity(shaders, constants_of(request), device.info());
        if (request.stop.stop_requested()) return cancelled(was_cancelled(request.name));
        if (cpu && stalls == Stalls::avoid && !marks.has(id)) warm(request, shaders);
        if (request.stop.stop_requested()) return cancelled(was_cancelled(request.name));
        RESTAGE_TRY(Pipeline pipeline, create(device, request, shaders));
        if (cpu) {
            RESTAGE_CHECK(run_nothing(device, pipeline));
            marks.add(id);
        }
        return pipeline;
    }

    template <class Pipeline, class Request>
    std::future<Result<Pipeline>> enqueue(Request request) {
        // Shared, because std::function copies its captures.
        auto promise = std::make_shared<std::promise<Result<Pipeline>>>();
        auto kept = std::make_shared<Request>(std::move(request));
        std::future<Result<Pipeline>> future = promise->get_future();
        {
            std::lock_guard lock(mutex);
            jobs.push_back([this, promise, kept](bool stop) {
                promise->set_value(stop ? Result<Pipeline>(cancelled(was_cancelled(kept->name)))
                                        : make<Pipeline>(*kept));
            });
        }
        wake.notify_one();
        return future;
    }
};

PipelineBuilder::PipelineBuilder(Device& device, const ShaderCompiler& compiler, unsigned threads, Stalls stalls)
    : impl_(std::make_unique<Impl>(device, compiler, stalls)) {
    for (unsigned i = 0; i < std::max(threads, 1u); ++i)
        impl_->threads.emplace_back([this] { impl_->work(); });
}

PipelineBuilder::~PipelineBuilder() {
    {
        std::lock_guard lock(impl_->mutex);
        impl_->stopping = true;
    }
    impl_->wake.notify_all();
    for (std::thread& thread : impl_->threads)
        thread.join();
    for (auto& job : impl_->jobs)
        job(true);
}

std::future<Result<ComputePipeline>> PipelineBuilder::build(ComputeRequest request) {
    return impl_->enqueue<ComputePipeline>(std::move(request));
}
std::future<Result<RayTracingPipeline>> PipelineBuilder::build(RayTracingRequest request) {
    return impl_->enqueue<RayTracingPipeline>(std::move(request));
}

} // namespace restage::gpu
