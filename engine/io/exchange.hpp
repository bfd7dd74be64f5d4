// SPDX-License-Identifier: Apache-2.0
// Shared by SceneWriter (import) and SceneReader (export): a running plugin's reports (fates, progress, its
// error), the barrier that stops exceptions, and conversion between the ABI's plain C values and the engine's.
#pragma once

#include "io/report.hpp"
#include "scene/scene.hpp"

#include <exception>
#include <glm/glm.hpp>
#include <string>
#include <utility>

namespace restage::io {

class Exchange {
  public:
    const std::string& error() const { return error_; } // "file:line:column: message"; "" = none raised
    bool cancelled() const { return cancelled_; }
    // ": stopped on request", and that the plugin continued if it did, which `restage check` looks for.
    std::string how_stopped() const;

    Report report;

  protected:
    explicit Exchange(Progress progress) : progress_(std::move(progress)) {}
    Exchange(const Exchange&) = delete; // its tables hold its address
    Exchange& operator=(const Exchange&) = delete;
    ~Exchange() = default;

    void tell(int fate, const char* what, const char* note, const char* file = nullptr, std::uint32_t line = 0);
    void raise(const char* file, std::uint32_t line, std::uint32_t column, const char* message); // the first one counts
    bool proceed(float done, const char* what); // false: stop requested

    // f(self) -> a handle or bool. An exception (out of memory) becomes 0 and a line in the report.
    template <class Self, class F>
    static auto guarded(void* ctx, const char* what, F&& f) noexcept {
        Self& self = *static_cast<Self*>(ctx);
        const decltype(f(self)) nothing{};
        try {
            return f(self);
        } catch (const std::exception& e) {
            try {
                self.report.add(Fate::dropped, what, std::string("out of memory (") + e.what() + ")");
            } catch (...) {
                return nothing; // out of memory for the report, too
            }
        }
        return nothing;
    }

  private:
    Progress progress_;
    std::string error_;
    bool cancelled_ = false;
    std::size_t unheard_ = 0; // calls of progress after the first that returned false
};

inline std::string text(const char* c) { return c ? c : ""; }

glm::dmat4 matrix(const double m[16]); // column-major
inline glm::vec3 vec3(const float* v) { return {v[0], v[1], v[2]}; }
void copy(const glm::dmat4& from, double to[16]);
void copy(const glm::vec3& from, float to[3]);

scene::FilterKind filter_kind(const std::string& name); // box for unknown names
const char* filter_name(scene::FilterKind);

} // namespace restage::io
