// SPDX-License-Identifier: Apache-2.0
#include "opening.hpp"

#include "base/thread_priority.hpp"

namespace restage::editor {

Opening::~Opening() {
    cancelled_ = true;
    if (thread_.joinable()) thread_.join();
}

void Opening::start(Request request) {
    if (thread_.joinable()) { // importers stop at their next progress call; the window does not wait for it
        cancelled_ = true;
        next_ = std::move(request);
        return;
    }
    request_ = std::move(request);
    cancelled_ = finished_ = false;
    progress_ = 0;
    problem_ = document::BaseProblem::none;
    {
        std::lock_guard lock(mutex_);
        stage_.clear();
    }
    thread_ = std::thread([this] { run(); });
}

void Opening::run() {
    lower_thread_priority(2);
    const io::Progress progress = [this](float done, std::string_view what) {
        progress_ = done;
        {
            std::lock_guard lock(mutex_);
            stage_ = what;
        }
        wake_();
        return !cancelled_;
    };
    const auto read = [&]() -> Result<Opened> {
        Opened opened;
        if (request_.purpose == Purpose::insert) {
            RESTAGE_TRY(opened.inserted, document::read_scene(request_.path.string(), registry_,
                                                              {.progress = progress,
                                                               .isolate = isolate_,
                                                               .expose = false,
                                                               .import_options = request_.import_options}));
        } else {
            const document::ReadOptions options{.progress = progress,
                                                .isolate = isolate_,
                                                .base = request_.base,
                                                .drop_lost = request_.drop_lost,
                                                .problem = &problem_,
                                                .import_options = request_.import_options};
            RESTAGE_TRY(opened.document, document::read_document(request_.path.string(), registry_, options));
        }
        return opened;
    };
    auto result = read();
    {
        std::lock_guard lock(mutex_);
        result_ = std::move(result);
    }
    finished_ = true;
    wake_();
}

void Opening::cancel() {
    next_.reset();
    cancelled_ = true;
}

std::string Opening::stage() const {
    std::lock_guard lock(mutex_);
    return stage_;
}

std::optional<Result<Opening::Opened>> Opening::take() {
    if (!thread_.joinable() || !finished_) return std::nullopt;
    thread_.join();
    auto result = std::exchange(result_, std::nullopt);
    if (cancelled_) result.reset();
    if (next_) start(*std::exchange(next_, std::nullopt));
    return result;
}

} // namespace restage::editor
