// SPDX-License-Identifier: Apache-2.0
// Native code of materials that runs in the editor: drawing a part of the inspector, with widgets that simulate
// any user input; and reading files of table parameters, with any file.
#include "check/fake_ui.hpp"
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "base/file.hpp"
#include "plugin/table_reader.hpp"
#include "render/material_types.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace restage::check {

namespace fs = std::filesystem;
Result<StepResult> check_inspector(Subject& s) {
    const plugin::Inspector* const inspector = s.registry().find_inspector(s.table().type);
    if (!inspector) return StepResult::skip("it has no inspector");
    Engine e = s.random("inspector");
    std::size_t shown = 0, sets = 0;
    const std::size_t draws = s.size(400, 120);
    FakeUi ui(s.table().params, e);
    for (std::size_t i = 0; i < draws; ++i) {
        // What one draw sets, the next one shows; occasionally another material is selected.
        if (i % 8 == 7) ui.values = random_config(s.table(), e);
        s.doing(fmt::format("draw() number {} with {}", i + 1, describe(ui.values)));
        inspector->draw(ui);
        s.alive();
        shown += ui.widgets, sets += ui.sets;
        ui.widgets = ui.sets = 0;
        if (ui.problem.empty() && !ui.groups.empty()) ui.note("draw() returns with an open group: call end_group()");
        if (!ui.problem.empty())
            return StepResult::failed(
                fmt::format("{}\n  in draw() number {} with {}", ui.problem, i + 1, describe(ui.values)));
    }
    return StepResult::passed({{"draws", double(draws)}, {"widgets", double(shown)}, {"values set", double(sets)}});
}

Result<StepResult> check_tables(Subject& s) {
    std::vector<const model::Param*> lines;
    for (const model::Param& line : s.table().params)
        if (line.type == model::ParamType::table) lines.push_back(&line);
    if (lines.empty()) return StepResult::skip("it has no table parameter");
    const auto reader = s.material().source->table_reader();
    if (!reader) return StepResult::failed("it has a table parameter, but no restage.table/1 to read it");
    const TemporaryFolder folder;
    Engine e = s.random("tables");
    std::size_t files = 0, taken = 0, defaults = 0;
    for (const model::Param* p : lines) {
        std::string good;
        if (const std::string file = render::table_path(*p, {}); !file.empty()) {
            s.doing("read() of the default file of \"" + std::string(p->id) + "\"");
            RESTAGE_CHECK(reader->read(p->id, file));
            RESTAGE_TRY(good, read_file(file));
            ++defaults;
        }
        const std::string head = good.substr(0, 64);
        for (std::size_t k = 0; k < s.size(300, 100); ++k) {
            const bool broken = !good.empty() && good.size() <= 4 << 20 && k % 2;
            const std::string bytes = broken ? broken_version(e, good, k / 2) : noise(e, k, k % 3 ? "" : head);
            // Each has a unique name: results are cached.
            const fs::path file = folder.path / fmt::format("{} {}.{}", p->id, k, reader->extensions()[0]);
            RESTAGE_CHECK(write_file_atomic(file, bytes));
            s.doing(fmt::format("read() of {} for \"{}\", {} bytes",
                                broken ? "a broken version of the default" : "noise", p->id, bytes.size()));
            const auto read = reader->read(p->id, file.string());
            std::error_code ignored;
            fs::remove(file, ignored);
            s.alive();
            ++files, taken += read.has_value();
            if (!read && read.error().message.ends_with("refused it without giving a reason"))
                return StepResult::failed(
                    fmt::format("read() of {} bytes returns 0, and error() was not called", bytes.size()));
        }
    }
    return StepResult::passed(
        {{"default files", double(defaults)}, {"broken files and noise", double(files)}, {"accepted", double(taken)}});
}

} // namespace restage::check
