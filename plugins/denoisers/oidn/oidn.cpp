// SPDX-License-Identifier: Apache-2.0
// Denoiser "oidn": the ray tracing filter ("RT") of Intel Open Image Denoise on the CPU.

#include "library.hpp"

#include <restage/denoiser.h>
#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace oidn;

struct State { // from the first query until shutdown
    std::mutex mutex;
    bool tried = false;
    std::optional<Api> api; // none = unavailable, see unavailable_reason
    std::string unavailable_reason, run_reason;
    Device device = nullptr;
    uint32_t device_threads = 0;
};

State& state() {
    static State instance;
    return instance;
}

std::string device_error(const Api& api, Device device, bool* cancelled = nullptr) {
    const char* message = nullptr;
    const int code = api.get_device_error(device, &message);
    if (cancelled) *cancelled = code == error_cancelled;
    if (code == error_none) return {};
    return message && *message ? message : "error " + std::to_string(code);
}

void release_device(State& s) {
    if (s.device) s.api->release_device(s.device);
    s.device = nullptr;
}

// "" or why there is no device. Kept between jobs: creating one starts threads.
std::string ensure_device(State& s, uint32_t threads) {
    if (s.device && s.device_threads == threads) return {};
    release_device(s);
    s.device = s.api->new_device(device_type_cpu);
    if (!s.device) return "Open Image Denoise has no device for this processor: " + device_error(*s.api, nullptr);
    s.device_threads = threads;
    s.api->set_device_bool(s.device, "setAffinity", false); // the renderer shares the cores
    if (threads > 0) s.api->set_device_int(s.device, "numThreads", static_cast<int>(threads));
    s.api->commit_device(s.device);
    std::string error = device_error(*s.api, s.device);
    if (!error.empty()) release_device(s);
    return error;
}

bool ensure_library(State& s) {
    if (s.tried) return s.api.has_value();
    s.tried = true;
    Api api;
    if (!load(api, s.unavailable_reason)) return false;
    s.api = api;
    s.unavailable_reason = ensure_device(s, 0);
    if (!s.unavailable_reason.empty()) s.api.reset();
    return s.api.has_value();
}

// One of the filters of a job, with its part of the total progress.
struct Pass {
    const RestageDenoiseJob& job;
    double start, end;

    static bool monitor(void* user, double done) {
        const auto& pass = *static_cast<const Pass*>(user);
        return pass.job.progress(pass.job.progress_ctx, pass.start + (pass.end - pass.start) * done) != 0;
    }
};

class RtFilter {
  public:
    RtFilter(const Api& api, Device device, const RestageDenoiseJob& job)
        : api_(api), device_(device), job_(job), filter_(api.new_filter(device, "RT")) {}
    ~RtFilter() {
        if (filter_) api_.release_filter(filter_);
    }
    RtFilter(const RtFilter&) = delete;

    void image(const char* name, const float* data) {
        if (filter_)
            api_.set_shared_filter_image(filter_, name, const_cast<float*>(data), format_float3, job_.width,
                                         job_.height, 0, 0, 0);
    }
    void flag(const char* name, bool value) {
        if (filter_) api_.set_filter_bool(filter_, name, value);
    }
    // "" or what went wrong.
    std::string execute(int quality, Pass pass) {
        if (filter_) {
            api_.set_filter_int(filter_, "quality", quality);
            if (job_.progress) api_.set_filter_progress_monitor(filter_, Pass::monitor, &pass);
            api_.commit_filter(filter_);
            api_.execute_filter(filter_);
        }
        bool cancelled = false;
        std::string error = device_error(api_, device_, &cancelled);
        return cancelled ? "stopped" : error;
    }

  private:
    const Api& api_;
    Device device_;
    const RestageDenoiseJob& job_;
    Filter filter_;
};

int oidn_quality(const State& s, uint32_t quality) {
    if (quality == RESTAGE_DENOISE_HIGH) return quality_high;
    const bool has_fast = s.api->get_device_int(s.device, "version") >= first_version_with_fast;
    return quality == RESTAGE_DENOISE_FAST && has_fast ? quality_fast : quality_balanced;
}

std::string denoise(State& s, const RestageDenoiseJob& job);

// The network treats everything outside a picture as black, so a tiny one is mostly border: its outermost
// pixels are repeated on all sides until it is large enough.
constexpr uint32_t least_side = 64;

std::string denoise_padded(State& s, const RestageDenoiseJob& job) {
    RestageDenoiseJob wide = job;
    wide.width = std::max(job.width, least_side);
    wide.height = std::max(job.height, least_side);
    const std::size_t left = (wide.width - job.width) / 2, top = (wide.height - job.height) / 2;
    const auto inside = [](std::size_t at, std::size_t border, uint32_t size) -> std::size_t {
        return std::min<std::size_t>(at - std::min(at, border), size - 1);
    };
    const auto pad = [&](const float* in, std::vector<float>& out) -> const float* {
        if (!in) return nullptr;
        out.resize(std::size_t{3} * wide.width * wide.height);
        for (std::size_t y = 0; y < wide.height; ++y)
            for (std::size_t x = 0; x < wide.width; ++x) {
                const std::size_t from = inside(y, top, job.height) * job.width + inside(x, left, job.width);
                std::copy_n(in + 3 * from, 3, &out[3 * (y * wide.width + x)]);
            }
        return out.data();
    };
    std::vector<float> color, albedo, normal;
    wide.color = pad(job.color, color);
    wide.albedo = pad(job.albedo, albedo);
    wide.normal = pad(job.normal, normal);
    wide.output = color.data();
    if (std::string error = denoise(s, wide); !error.empty()) return error;
    for (std::size_t y = 0; y < job.height; ++y)
        std::copy_n(&color[3 * ((y + top) * wide.width + left)], std::size_t{3} * job.width,
                    job.output + 3 * y * job.width);
    return {};
}

std::string denoise(State& s, const RestageDenoiseJob& job) {
    if (job.size < sizeof(RestageDenoiseJob)) return "the job is from a program older than this plugin";
    if (!job.color || !job.output || job.width == 0 || job.height == 0) return "the job has no picture";
    if (job.width < least_side || job.height < least_side) return denoise_padded(s, job);
    if (!ensure_library(s)) return s.unavailable_reason;
    if (std::string error = ensure_device(s, job.threads); !error.empty()) return error;

    const int quality = oidn_quality(s, job.quality);
    const float *albedo = job.albedo, *normal = job.albedo ? job.normal : nullptr; // no network for normals alone
    double done = 0;
    std::vector<float> clean_albedo, clean_normal;
    const bool prefilter = job.quality == RESTAGE_DENOISE_HIGH;
    const auto clean = [&](const char* name, const float*& guide, std::vector<float>& result) -> std::string {
        if (!prefilter || !guide) return {};
        result.resize(std::size_t{3} * job.width * job.height);
        RtFilter filter(*s.api, s.device, job);
        filter.image(name, guide);
        filter.image("output", result.data());
        std::string error = filter.execute(quality, {job, done, done + 0.25});
        guide = result.data();
        done += 0.25;
        return error;
    };
    if (std::string error = clean("albedo", albedo, clean_albedo); !error.empty()) return error;
    if (std::string error = clean("normal", normal, clean_normal); !error.empty()) return error;

    RtFilter filter(*s.api, s.device, job);
    filter.image("color", job.color);
    if (albedo) filter.image("albedo", albedo);
    if (normal) filter.image("normal", normal);
    filter.image("output", job.output);
    filter.flag("hdr", true);
    filter.flag("cleanAux", prefilter && albedo);
    return filter.execute(quality, {job, done, 1});
}

int available(const char** reason) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    const bool ok = ensure_library(s);
    if (reason) *reason = s.unavailable_reason.c_str();
    return ok;
}

int run(const RestageDenoiseJob* job, const char** reason) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    try {
        s.run_reason = job ? denoise(s, *job) : "there is no job";
    } catch (const std::bad_alloc&) {
        s.run_reason = "not enough memory to denoise this picture";
    } catch (const std::exception& error) {
        s.run_reason = error.what();
    }
    if (reason) *reason = s.run_reason.c_str();
    return s.run_reason.empty();
}

void shutdown() {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.api) release_device(s);
    s.api.reset();
    s.tried = false;
}

constexpr RestageDenoiser1 denoiser{.size = sizeof(RestageDenoiser1),
                                    .type = "oidn",
                                    .label = "Open Image Denoise",
                                    .available = available,
                                    .run = run};

} // namespace

RESTAGE_PLUGIN_INIT("org.restage.denoiser.oidn", "0.1.0", nullptr, shutdown, {RESTAGE_DENOISER1, &denoiser})
