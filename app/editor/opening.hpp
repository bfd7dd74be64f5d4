// SPDX-License-Identifier: Apache-2.0
// Opening: reads a scene or project file on its own thread while the editor runs, with progress and cancellation.
#pragma once

#include "document/document.hpp"
#include "io/import.hpp"
#include "plugin/registry.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace restage::editor {

class Opening {
  public:
    enum class Purpose {
        replace,
        insert,
        recover
    }; // becomes the document; is inserted into it; becomes an unsaved document
    struct Request {
        std::filesystem::path path;
        Purpose purpose = Purpose::replace;
        std::filesystem::path base = {}; // of a project: instead of the one it names
        bool drop_lost = false;          // see document::ReadOptions
        bool link = false; // insert: as a link (document/linking.hpp)
        std::optional<glm::dvec2> film_point = {}; // insert: its position in the picture
        std::optional<scene::ParamSet> import_options = {}; // see document::ReadOptions
    };
    struct Opened {
        std::optional<document::Document> document;  // replace, recover
        std::optional<io::ImportedScene> inserted;
    };

    Opening(const plugin::Registry& registry, std::function<void()> wake,
            std::shared_ptr<const document::IsolateOptions> isolate)
        : registry_(registry), wake_(std::move(wake)), isolate_(std::move(isolate)) {}
    ~Opening();

    // Cancels the running read, if any.
    void start(Request request);
    void cancel();
    bool running() const { return thread_.joinable(); }
    float progress() const { return progress_; }
    std::string stage() const;
    const Request& request() const { return request_; }
    const std::filesystem::path& path() const { return request_.path; }
    // The result, once; nullopt while it runs and after it was cancelled.
    std::optional<Result<Opened>> take();
    document::BaseProblem problem() const { return problem_; } // if take() returned an error

  private:
    void run();

    const plugin::Registry& registry_;
    std::function<void()> wake_;
    std::shared_ptr<const document::IsolateOptions> isolate_;
    std::thread thread_;
    Request request_;
    std::optional<Request> next_; // starts once the running one has stopped
    std::atomic<bool> cancelled_ = false, finished_ = false;
    std::atomic<float> progress_ = 0;
    document::BaseProblem problem_ = document::BaseProblem::none;
    mutable std::mutex mutex_;
    std::string stage_;
    std::optional<Result<Opened>> result_;
};

} // namespace restage::editor
