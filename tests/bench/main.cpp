// SPDX-License-Identifier: Apache-2.0
// restage_bench: one measurement per call, its figures as JSON on stdout. tests/bench/run.py calls it.
#include "bench.hpp"

#include <CLI/CLI.hpp>

int main(int argc, char** argv) {
    using namespace restage::bench;
    CLI::App program{"One measurement of Restage, as JSON"};
    Options o;
    Json result;
    program.require_subcommand(1);
    program.fallthrough();
    program.add_option("--runs", o.runs, "How often each figure is measured")->capture_default_str();
    program.add_flag("--quick", o.quick, "Less of everything");
    program.add_option("--threads", o.threads, "0 = all")->capture_default_str();
    program.add_subcommand("rays", "Rays per second in the room")->callback([&] { result = measure_rays(o); });
    program.add_subcommand("cutouts", "Rays per second among cards: opaque, cut out by native code, by GLSL only")
        ->callback([&] { result = measure_cutouts(o); });
    program.add_subcommand("lamps", "Many lamps")->callback([&] { result = measure_lamps(o); });
    program.add_subcommand("edits", "Edits of one of 1000 instances")->callback([&] { result = measure_edits(o); });
    program.add_subcommand("copies", "Copies of a scene of many objects, and a frame of a drag")->callback([&] {
        result = measure_copies(o);
    });
    program.add_subcommand("actions", "Copies scattered over a large surface by an action")->callback([&] {
        result = measure_actions(o);
    });
    std::string variant, scene, folder;
    std::uint32_t reference_spp = 256;
    auto* features = program.add_subcommand("features", "The Cornell box and what else its scene uses");
    features->add_option("VARIANT", variant, "alone, types, features or all")->required();
    features->callback([&] { result = measure_features(o, variant); });
    program.add_subcommand("multiscatter", "The cost of multiple scattering, by material")->callback([&] {
        result = measure_multiscatter(o);
    });
    auto* first = program.add_subcommand("first-image", "Breakdown of the time to a file's first picture");
    first->add_option("SCENE", scene)->required();
    first->callback([&] { result = measure_first_image(scene); });
    auto* standard = program.add_subcommand("standard", "Samples per second and error of cornell, room or room-flat");
    standard->add_option("NAME", scene)->required()->check(CLI::IsMember({"cornell", "room", "room-flat"}));
    standard->add_option("--folder", folder, "Where references are kept")->required();
    standard->add_option("--reference-spp", reference_spp)->capture_default_str();
    standard->callback([&] { result = measure_standard(o, scene, folder, reference_spp); });
    CLI11_PARSE(program, argc, argv);
    std::printf("%s\n", result.dump().c_str());
    return 0;
}
