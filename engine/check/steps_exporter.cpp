// SPDX-License-Identifier: Apache-2.0
// Exporters: a scene with every feature, with holes from removed items, with every choice of their
// options; twice the same bytes.
#include "check/export_scenes.hpp"
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "io/export.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace restage::check {

namespace fs = std::filesystem;
using namespace scene;

Result<StepResult> check_write(Subject& s) {
    const model::Exporter& exporter = *s.exporter;
    const TemporaryFolder folder;
    const std::string& extension = exporter.extensions[0];
    io::ExportOptions options;
    options.format = exporter.format;
    std::size_t saves = 0, bytes = 0;
    const auto save = [&](const Scene& scene, const fs::path& place, const std::string& what) -> Result<io::Report> {
        std::error_code code;
        fs::create_directories(place, code);
        s.doing("save() of " + what);
        ++saves;
        auto done = io::export_scene(scene, (place / ("scene." + extension)).string(), s.registry(), options);
        s.alive();
        return done;
    };
    const std::size_t open_before = open_files();
    const struct {
        Scene scene;
        const char* name;
    } scenes[] = {{everything_scene(), "a scene with every feature"}, {empty_scene(), "a scene without objects"}};
    for (const auto& [scene, name] : scenes)
        for (const ParamSet& set : option_sets(exporter)) {
            options.values = set;
            const std::string what = std::string(name) + ", options " + describe(set);
            Contents written[2];
            for (int k = 0; k < 2; ++k) {
                const fs::path place = folder.path / "saved"; // the same: the files may contain paths
                std::error_code ignored;
                fs::remove_all(place, ignored);
                if (const auto done = save(scene, place, what); !done)
                    return StepResult::failed(what + ": " + done.error().message);
                written[k] = contents_of(place);
            }
            if (written[0].empty()) return StepResult::failed(what + ": save() returns 1 but wrote nothing");
            if (const std::string off = first_difference(written[0], written[1]); !off.empty())
                return StepResult::failed(what + ": saving twice gives different bytes, first in " + off);
            for (const auto& [file, text] : written[0])
                bytes += text.size();
        }
    if (open_files() > open_before + 2)
        return StepResult::failed(fmt::format("{} files remain open", open_files() - open_before));
    return StepResult::passed({{"saved", double(saves)}, {"bytes", double(bytes)}});
}

} // namespace restage::check
