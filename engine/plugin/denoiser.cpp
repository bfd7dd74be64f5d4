// SPDX-License-Identifier: Apache-2.0
#include "plugin/denoiser.hpp"

#include "plugin/abi.hpp"

#include <restage/denoiser.h>
#include <atomic>

namespace restage::plugin {

namespace {

std::string reason_text(const char* reason) { return reason && *reason ? reason : Denoiser::no_reason; }

} // namespace

Result<Denoiser> Denoiser::read(const RestageDenoiser1& table) {
    if (const auto problem = too_short(table.size, RESTAGE_SIZE_UP_TO(RestageDenoiser1, run), RESTAGE_DENOISER1);
        !problem.empty())
        return fail(problem);
    Denoiser out;
    out.type = table.type ? table.type : "";
    out.label = table.label ? table.label : "";
    if (!table.available || !table.run) return fail("denoiser \"" + out.type + "\" lacks available or run");
    out.table_ = &table;
    return out;
}

Result<> Denoiser::available() const {
    const char* reason = nullptr;
    if (table_->available(&reason)) return {};
    return fail(reason_text(reason));
}

Result<> Denoiser::run(const DenoiseJob& job) const {
    RestageDenoiseJob out{};
    out.width = job.width, out.height = job.height;
    out.color = job.color, out.albedo = job.albedo, out.normal = job.normal;
    out.output = job.output;
    out.quality = static_cast<std::uint32_t>(job.quality);
    out.threads = job.threads;
    struct Progress {
        const std::function<bool(double)>& keep_going;
        std::atomic<bool> stopped{false}; // a denoiser may call it from any thread
    } progress{job.progress};
    if (job.progress) {
        out.progress_ctx = &progress;
        out.progress = [](void* ctx, double done) {
            auto& p = *static_cast<Progress*>(ctx);
            if (!p.keep_going(done)) p.stopped = true;
            return p.stopped ? 0 : 1;
        };
    }
    const char* reason = nullptr;
    if (table_->run(&out, &reason)) return {};
    if (progress.stopped) return cancelled(reason_text(reason));
    return fail(reason_text(reason));
}

} // namespace restage::plugin
