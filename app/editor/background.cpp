// SPDX-License-Identifier: Apache-2.0
#include "background.hpp"

#include "base/thread_priority.hpp"
#include "panel_context.hpp"
#include "theme.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cfloat>
#include <cmath>

namespace restage::editor {

namespace {

std::string duration(double seconds) {
    const long s = std::lround(seconds);
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
    return fmt::format("{}:{:02} h", s / 3600, s / 60 % 60);
}

} // namespace

bool BackgroundJob::report(double done, std::string_view stage) {
    {
        std::lock_guard lock(mutex_);
        done_ = done;
        stage_ = stage;
    }
    wake_();
    return !stopping();
}

void BackgroundJob::wait_while_paused(const std::function<bool()>& given_up) {
    if (!paused_) return;
    const auto begin = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    while (paused_ && !stopping() && !(given_up && given_up()))
        goes_on_.wait_for(lock, std::chrono::milliseconds(100)); // given_up may change unnoticed
    seconds_paused_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

BackgroundJobs::~BackgroundJobs() {
    for (auto& job : jobs_)
        job->cancelled_ = true;
    for (auto& job : jobs_)
        job->thread_.join();
}

void BackgroundJobs::start(Options options, Work work) {
    auto job = std::make_unique<BackgroundJob>();
    job->title_ = std::move(options.title);
    job->can_finish_early_ = options.can_finish_early;
    job->pauses_picture_ = options.pauses_picture;
    job->can_pause_ = options.can_pause;
    job->details_ = std::move(options.details);
    job->wake_ = wake_;
    BackgroundJob& started = *job;
    jobs_.push_back(std::move(job));
    started.thread_ = std::thread([&started, work = std::move(work)] {
        lower_thread_priority(3);
        auto then = work(started);
        {
            std::lock_guard lock(started.mutex_);
            started.then_ = std::move(then);
        }
        started.finished_ = true;
        started.wake_();
    });
}

bool BackgroundJobs::picture_paused() const {
    return std::any_of(jobs_.begin(), jobs_.end(),
                       [](const auto& job) { return job->pauses_picture_ && !job->paused_; });
}

double BackgroundJobs::progress() const {
    if (jobs_.empty()) return 1;
    std::lock_guard lock(jobs_[0]->mutex_);
    return jobs_[0]->done_;
}

void BackgroundJobs::update(PanelContext& editor) {
    for (std::size_t i = 0; i < jobs_.size();) {
        if (!jobs_[i]->finished_) {
            ++i;
            continue;
        }
        const std::unique_ptr<BackgroundJob> job = std::move(jobs_[i]);
        jobs_.erase(jobs_.begin() + std::ptrdiff_t(i));
        job->thread_.join();
        if (job->cancelled_ && !job->keeps_result_)
            editor.notices.add(LogLevel::info, job->title_ + ": stopped");
        else if (job->then_)
            job->then_(editor);
    }
    if (jobs_.empty()) return;

    const float scale = ImGui::GetStyle().FontScaleMain;
    const ImGuiViewport* main = ImGui::GetMainViewport();
    ImGui::SetNextWindowPos({main->WorkPos.x + main->WorkSize.x / 2, main->WorkPos.y + main->WorkSize.y - 12 * scale},
                            ImGuiCond_Always, {0.5f, 1.f});
    ImGui::SetNextWindowSizeConstraints({420 * scale, 0}, {420 * scale, FLT_MAX});
    if (ImGui::Begin("##background", nullptr,
                     ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoDocking | ImGuiWindowFlags_NoSavedSettings |
                         ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoFocusOnAppearing |
                         ImGuiWindowFlags_AlwaysAutoResize))
        for (auto& job : jobs_) {
            ImGui::PushID(job.get());
            double done = 0, paused = 0;
            std::string stage;
            {
                std::lock_guard lock(job->mutex_);
                done = std::clamp(job->done_, 0.0, 1.0);
                stage = job->stage_;
                paused = job->seconds_paused_;
            }
            const double elapsed =
                std::chrono::duration<double>(std::chrono::steady_clock::now() - job->start_).count() - paused;
            ImGui::TextUnformatted(job->title_.c_str());
            if (done > 0.02 && !job->paused_)
                stage += fmt::format("{}{} left", stage.empty() ? "" : ", ", duration(elapsed * (1 - done) / done));
            ImGui::ProgressBar(float(done), {-1, 0}, fmt::format("{:.0f} %", done * 100).c_str());
            editor.mark("job.bar");
            ImGui::TextColored(colors::dim, "%s",
                               job->cancelled_ ? "stopping"
                               : job->paused_  ? "paused"
                                               : stage.c_str());
            if (job->details_) job->details_(editor);
            if (job->can_finish_early_) {
                if (ImGui::Button("Enough")) job->finish_early_ = true;
                ImGui::SetItemTooltip("Stop here and write the picture as it is now");
                editor.mark("job.enough");
                ImGui::SameLine();
            }
            if (job->can_pause_ && !job->cancelled_) {
                if (ImGui::Button(job->paused_ ? "Resume###pause" : "Pause###pause")) {
                    job->paused_ = !job->paused_;
                    job->goes_on_.notify_all();
                }
                ImGui::SetItemTooltip("%s", job->paused_ ? "Goes on where it stopped"
                                                         : "Stops for a while and leaves the processor to the editor");
                editor.mark("job.pause");
                ImGui::SameLine();
            }
            if (ImGui::Button("Cancel")) job->cancelled_ = true;
            editor.mark("job.cancel");
            ImGui::PopID();
        }
    ImGui::End();
}

} // namespace restage::editor
