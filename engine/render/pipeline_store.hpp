// SPDX-License-Identifier: Apache-2.0
// PipelineStore: pipelines keyed by their inputs. A request returns an entry immediately; it is built on a worker,
// shared with later requests for the same, and cancelled when no longer wanted. One thread at a time.
#pragma once

#include "gpu/pipeline_builder.hpp"
#include "render/tracer.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <type_traits>
#include <unordered_map>

namespace restage::render {

// Hash of a pipeline's inputs. Files that a shader includes are not part of it.
std::uint64_t request_key(const gpu::ComputeRequest&);
std::uint64_t request_key(const gpu::RayTracingRequest&);

template <class Pipeline>
class PipelineStore {
  public:
    using Request =
        std::conditional_t<std::is_same_v<Pipeline, gpu::ComputePipeline>, gpu::ComputeRequest, gpu::RayTracingRequest>;
    using Clock = std::chrono::steady_clock;
    struct Entry {
        std::string what; // for display: "diffuse"
        std::shared_ptr<const Pipeline> pipeline; // nullptr: building, or failed
        std::string error;                        // why it failed
        bool building() const { return future.valid() && !cancelled(); }
        bool cancelled() const { return stop.stop_requested(); } // must be requested again

      private:
        friend class PipelineStore;
        std::future<Result<Pipeline>> future;
        std::stop_source stop;
        Clock::time_point begun;
        bool wanted = true;
    };

    explicit PipelineStore(const TracerContext& c)
        : builder_(c.device, c.compiler, c.jobs.threads(),
                   c.stand_ins ? gpu::PipelineBuilder::Stalls::avoid : gpu::PipelineBuilder::Stalls::allow) {}

    using EntryPtr = std::shared_ptr<Entry>;

    // The entry for `request`; the first request starts building it.
    EntryPtr want(const std::string& what, Request request) {
        EntryPtr& entry = entries_[request_key(request)];
        if (!entry) {
            entry = std::make_shared<Entry>();
            entry->what = what;
            entry->begun = Clock::now();
            request.stop = entry->stop.get_token();
            entry->future = builder_.build(std::move(request));
        }
        keep(entry);
        return entry;
    }
    void keep(const EntryPtr& entry) { // marks it as still wanted
        entry->wanted = true;
        poll(entry);
    }
    void poll(const EntryPtr& entry) { take(*entry, std::chrono::seconds(0)); } // checks whether it is built

    // Waits until it is built. False: keep_going requested a stop.
    Result<bool> wait(const EntryPtr& entry, const std::function<bool()>& keep_going) {
        entry->wanted = true;
        while (!take(*entry, std::chrono::milliseconds(10)))
            if (keep_going && !keep_going()) return false;
        if (!entry->pipeline) return fail(entry->error);
        return true;
    }

    // Cancels builds not wanted since the last call; forgets errors and, if there are many, idle pipelines.
    void settle() {
        const bool many = entries_.size() > 64;
        std::erase_if(entries_, [&](auto& e) {
            Entry& entry = *e.second;
            if (std::exchange(entry.wanted, false)) return false;
            if (!entry.pipeline) entry.stop.request_stop();
            return !entry.pipeline || (many && entry.pipeline.use_count() == 1);
        });
    }

    std::optional<CompileProgress> compiling(const Entry* but_for = nullptr) const {
        CompileProgress progress;
        const Entry* oldest = nullptr;
        for (const auto& [key, entry] : entries_) {
            if (!entry->building() || entry.get() == but_for) continue;
            ++progress.left;
            if (!oldest || entry->begun < oldest->begun) oldest = entry.get();
        }
        if (!oldest) return std::nullopt;
        progress.what = oldest->what;
        progress.seconds = std::chrono::duration<double>(Clock::now() - oldest->begun).count();
        return progress;
    }

  private:
    template <class Duration>
    bool take(Entry& entry, Duration patience) { // true: it is no longer being built
        if (!entry.future.valid()) return true;
        if (entry.future.wait_for(patience) != std::future_status::ready) return false;
        auto result = entry.future.get();
        if (result)
            entry.pipeline = std::make_shared<const Pipeline>(std::move(*result));
        else
            entry.error = result.error().message;
        return true;
    }

    std::unordered_map<std::uint64_t, EntryPtr> entries_;
    gpu::PipelineBuilder builder_; // destroyed first: it finishes started builds
};

} // namespace restage::render
