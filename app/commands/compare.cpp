// SPDX-License-Identifier: Apache-2.0
// restage compare A B: the difference of picture A from reference B, as text or JSON on stdout; or of two scenes.

#include "commands/commands.hpp"
#include "io/exr.hpp"
#include "io/image_compare.hpp"
#include "io/image_file.hpp"
#include "view/picture.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace restage::app {

namespace {

struct Options {
    std::string a, b;
    std::vector<std::string> halves;
    bool json = false;
    std::string diff, z_map;
    io::CompareOptions compare;
    std::optional<double> max_flip, min_blocks;
    bool for_pictures() const {
        return !halves.empty() || !diff.empty() || !z_map.empty() || max_flip || min_blocks || compare.clip != 0 ||
               compare.exposure != 0;
    }
};

Result<scene::PixelData> load(const std::string& path, Log& log) {
    std::string warning;
    auto image = io::read_image(path, scene::Encoding::srgb, 2.2f, &warning);
    if (!warning.empty()) log.warning(warning);
    return image;
}

// Luminance with the variance from the file's own "stderr" layer; empty if it has none.
Result<io::Estimate> load_estimate(const std::string& path, const scene::PixelData& image) {
    if (!path.ends_with(".exr") && !path.ends_with(".EXR")) return io::Estimate{};
    RESTAGE_TRY(const io::ExrImage exr, io::read_exr(path));
    const io::ExrLayer* layer = exr.find("stderr");
    if (!layer || layer->values.empty()) return io::Estimate{};
    const auto index = [&](const char* name) {
        return std::find(layer->channels.begin(), layer->channels.end(), name) - layer->channels.begin();
    };
    const auto count = static_cast<std::ptrdiff_t>(layer->channels.size());
    const std::ptrdiff_t y = index("Y"), rgb[3] = {index("R"), index("G"), index("B")};
    if (y == count && (rgb[0] == count || rgb[1] == count || rgb[2] == count)) return io::Estimate{};
    io::Estimate estimate{.width = image.width, .height = image.height, .luminance = io::luminance(image)};
    // Errors are those of the path-traced picture; in a denoised file it is the layer "noisy".
    if (const io::ExrLayer* noisy = exr.find("noisy"); noisy && noisy->channels.size() == 3 && !noisy->values.empty())
        estimate.luminance =
            io::luminance({.width = exr.width, .height = exr.height, .channels = 3, .values = noisy->values});
    for (std::size_t i = 0; i < estimate.luminance.size(); ++i) {
        const float* errors = &layer->values[i * layer->channels.size()];
        float error = 0; // of luminance: its own channel, else the bound for fully correlated channels
        if (y < count)
            error = errors[y];
        else
            for (std::size_t c = 0; c < 3; ++c)
                error += io::luminance_weights[c] * errors[rgb[c]];
        estimate.variance.push_back(std::isfinite(error) ? error * error : 0);
    }
    return estimate;
}

struct Reference {
    scene::PixelData image;
    io::Estimate estimate; // empty = unknown
};

Result<Reference> load_reference(const Options& options, Log& log) {
    if (options.halves.empty()) {
        RESTAGE_TRY(scene::PixelData image, load(options.b, log));
        RESTAGE_TRY(auto estimate, load_estimate(options.b, image));
        return Reference{std::move(image), std::move(estimate)};
    }
    RESTAGE_TRY(scene::PixelData image, load(options.halves[0], log));
    RESTAGE_TRY(const scene::PixelData other, load(options.halves[1], log));
    auto estimate = io::estimate_of_halves(image, other);
    if (!estimate) return fail(options.halves[0] + ", " + options.halves[1], estimate.error());
    if (image.channels != other.channels)
        return fail(options.halves[1] + ": has " + std::to_string(other.channels) + " channels, its other half " +
                    std::to_string(image.channels));
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = 0.5f * (image.values[i] + other.values[i]);
    return Reference{std::move(image), std::move(*estimate)};
}

// One pixel per block: black at z = 0, green up to the threshold; beyond it red where A is brighter, blue where darker,
// paler with distance.
scene::PixelData z_picture(const io::ZTest& test) {
    scene::PixelData image{.width = test.columns, .height = test.rows, .channels = 3};
    for (const float z : test.z) {
        const float t = std::abs(z) / static_cast<float>(test.threshold);
        const float over = 0.8f * std::clamp((t - 1) / 3, 0.f, 1.f), full = 0.7f + 0.3f * std::min(t - 1, 1.f);
        const glm::vec3 color = t <= 1  ? glm::vec3(0, 0.5f * t, 0.25f * t)
                                : z > 0 ? glm::vec3(full, over, over)
                                        : glm::vec3(over, over, full);
        for (int c = 0; c < 3; ++c)
            image.values.push_back(io::srgb_to_linear(color[c]));
    }
    return image;
}

// Why the pictures differ, or "". With a limit on the fraction of blocks, a single failing block does not matter.
std::string verdict(const Options& o, const io::Comparison& c, const std::optional<io::ZTest>& z) {
    if (o.max_flip && !(c.flip <= *o.max_flip))
        return fmt::format("FLIP is {:.5f}, more than --max-flip {:g}", c.flip, *o.max_flip);
    if (o.min_blocks && z && z->share_passing < *o.min_blocks)
        return fmt::format("{:.4f} of the blocks pass, less than --min-blocks {:g}", z->share_passing, *o.min_blocks);
    if (!o.min_blocks && z && !z->family_passes)
        return fmt::format("the z-test fails: worst block {:.2f}, limit {:.2f}", z->worst, z->family_threshold);
    return "";
}

nlohmann::ordered_json to_json(const Options& options, const io::Comparison& c, const std::optional<io::ZTest>& z) {
    nlohmann::ordered_json json;
    json["a"] = options.a;
    json["b"] = options.halves.empty() ? nlohmann::ordered_json(options.b) : nlohmann::ordered_json(options.halves);
    json["mean_a"] = c.mean_a;
    json["mean_b"] = c.mean_b;
    json["luminance_a"] = c.luminance_a;
    json["luminance_b"] = c.luminance_b;
    json["rmse"] = c.rmse;
    json["rel_mse"] = c.rel_mse;
    json["flip"] = c.flip;
    json["clip_luminance"] = c.clip_luminance;
    json["z_test"] = nullptr;
    if (z)
        json["z_test"] = {{"blocks", z->z.size()},
                          {"threshold", z->threshold},
                          {"share_passing", z->share_passing},
                          {"rms", z->rms},
                          {"worst", z->worst},
                          {"family_threshold", z->family_threshold},
                          {"family_passes", z->family_passes}};
    const std::string why = verdict(options, c, z);
    json["passes"] = why.empty();
    json["why"] = why;
    return json;
}

std::string to_text(const io::Comparison& c, const std::optional<io::ZTest>& z) {
    const auto row = [](const char* name, double a, double b) {
        const double percent = 100 * (a / b - 1);
        return fmt::format("{:<12}{:>12.6g}{:>12.6g}{:>12}\n", name, a, b,
                           !(b > 0)        ? ""
                           : percent < 1e4 ? fmt::format("{:+.2f} %", percent)
                                           : fmt::format("{:+.2e} %", percent));
    };
    std::string text = fmt::format("{:<12}{:>12}{:>12}{:>12}\n", "mean", "A", "B", "A to B");
    static constexpr const char* names[] = {"  red", "  green", "  blue"};
    for (std::size_t i = 0; i < 3; ++i)
        text += row(names[i], c.mean_a[i], c.mean_b[i]);
    text += row("  luminance", c.luminance_a, c.luminance_b);
    text += fmt::format("RMSE    {:.6g}\nrelMSE  {:.6g}\nFLIP    {:.5f}\n", c.rmse, c.rel_mse, c.flip);
    if (c.clip_luminance > 0) text += fmt::format("fireflies clipped to luminance {:.4g}\n", c.clip_luminance);
    if (z)
        text += fmt::format(
            "z-test  {:.2f} % of {} blocks within {:g} (by chance 99.73 %), rms {:.3f}, worst {:.2f}; "
            "all together (limit {:.2f}): {}\n",
            100 * z->share_passing, z->z.size(), z->threshold, z->rms, z->worst, z->family_threshold,
            z->family_passes ? "pass" : "fail");
    else
        text += "z-test  not possible: it needs a layer 'stderr' in A, and one in B or --reference-halves\n";
    return text;
}

bool same_file(const std::string& a, const std::string& b) {
    std::error_code code;
    return a == b || std::filesystem::equivalent(a, b, code);
}

// Problems with the named files, before anything is read.
Result<> check_files(const Options& o) {
    std::vector<std::string> inputs = o.halves;
    inputs.push_back(o.a);
    if (!o.b.empty()) inputs.push_back(o.b);
    for (const auto& [option, path] : {std::pair("--diff", &o.diff), std::pair("--z-map", &o.z_map)}) {
        if (path->empty()) continue;
        const std::string who = std::string(option) + " " + *path;
        if (!path->ends_with(".png")) return fail(who + ": is written as PNG; its name must end with .png");
        if (auto good = view::check_picture_path(*path); !good) return fail(option, good.error());
        for (const std::string& input : inputs)
            if (same_file(*path, input)) return fail(who + ": would overwrite one of the compared pictures");
    }
    if (o.halves.size() == 2 && same_file(o.halves[0], o.halves[1]))
        return fail("--reference-halves: " + o.halves[0] +
                    " twice: there would be no noise; name two renders with different seeds");
    if (!o.diff.empty() && o.diff == o.z_map) return fail("--diff, --z-map: " + o.diff + " would be written twice");
    return {};
}

Result<int> run(const Options& options, Log& log) {
    RESTAGE_CHECK(check_files(options));
    RESTAGE_TRY(const scene::PixelData a, load(options.a, log));
    RESTAGE_TRY(const io::Estimate estimate_a, load_estimate(options.a, a));
    RESTAGE_TRY(const Reference b, load_reference(options, log));
    const auto comparison = io::compare_images(a, b.image, options.compare);
    if (!comparison)
        return fail(options.a + ", " + (options.halves.empty() ? options.b : options.halves[0]), comparison.error());
    std::optional<io::ZTest> z;
    if (!estimate_a.luminance.empty() && !b.estimate.luminance.empty()) {
        RESTAGE_TRY(z, io::z_test(estimate_a, b.estimate));
    }
    for (const auto& [option, asked] :
         {std::pair("--z-map", !options.z_map.empty()), std::pair("--min-blocks", options.min_blocks.has_value())})
        if (asked && !z)
            return fail(std::string(option) +
                        ": no z-test without standard errors in both pictures (a layer 'stderr')");
    if (!options.diff.empty()) RESTAGE_CHECK(io::write_png(options.diff, io::difference_image(a, b.image)));
    if (!options.z_map.empty()) RESTAGE_CHECK(io::write_png(options.z_map, z_picture(*z)));
    const std::string why = verdict(options, *comparison, z);
    const std::string out = options.json ? to_json(options, *comparison, z).dump(2) + "\n" : to_text(*comparison, z);
    std::fputs(out.c_str(), stdout);
    if (why.empty()) return exit_ok;
    log.error("the pictures differ: " + why);
    return exit_failed;
}

} // namespace

void add_compare(CLI::App& program, Context& context) {
    auto options = std::make_shared<Options>();
    CLI::App* command = program.add_subcommand("compare",
                                               "Measure the difference of picture A from reference B, or list the "
                                               "differences of two scenes; exit code 1 = they "
                                               "differ");
    command
        ->add_option("A", options->a,
                     "Picture (EXR, HDR, PFM; PNG, JPG, WebP, TGA, BMP as sRGB), or a scene or project")
        ->required();
    auto* b = command->add_option("B", options->b, "Reference: a picture of the same size, or the other scene");
    auto* halves = command->add_option("--reference-halves", options->halves,
                                       "Two independent halves instead of B: their mean is the reference, their "
                                       "difference its noise");
    halves->expected(2)->type_name("B1 B2")->excludes(b);
    command->add_flag("--json", options->json, "Print the result as JSON");
    command
        ->add_option("--diff", options->diff,
                     "Write the relative difference of luminance: red where A is brighter, blue where darker")
        ->type_name("PNG");
    command
        ->add_option("--z-map", options->z_map,
                     "Write z of each 8x8 block: beyond 3, red where A is brighter, blue where darker")
        ->type_name("PNG");
    command
        ->add_option("--clip", options->compare.clip,
                     "Fraction of the brightest pixels to clip in both alike, for example 0.001 against fireflies "
                     "(default: 0)")
        ->check(CLI::Range(0.f, 1.f));
    command
        ->add_option("--max-flip", options->max_flip,
                     "Fail (exit code 1) if FLIP, the perceived difference, exceeds this, for example 0.05")
        ->check(CLI::Range(0.0, 1.0));
    command
        ->add_option(
            "--min-blocks", options->min_blocks,
            "Fail if a smaller fraction of the 8x8 blocks passes the z-test, for example 0.99 (default: the test "
            "of all blocks together decides)")
        ->check(CLI::Range(0.0, 1.0));
    command->add_option("--exposure", options->compare.exposure, "Brighten both pictures for FLIP [stops] (default: 0)")
        ->check(CLI::Range(-64.f, 64.f));
    add_example(*command, "restage compare new.exr reference.exr --diff where.png");
    command->callback([options, b, halves, &context] {
        if (b->count() + halves->count() == 0) throw CLI::RequiredError("B or --reference-halves");
        context.choose([options, &context] {
            const bool scenes = is_scene_file(options->a);
            if (!options->b.empty() && scenes != is_scene_file(options->b))
                return Result<int>(fail(options->a + ", " + options->b +
                                        ": one is a scene, the other is not; two "
                                        "pictures can be compared, or two scenes"));
            if (!scenes) return run(*options, context.log);
            if (options->for_pictures())
                return Result<int>(
                    fail("of two scenes only the differences are listed: --reference-halves, --diff, --z-map, "
                         "--clip, --max-flip, --min-blocks and --exposure are for pictures"));
            return compare_scenes(context, options->a, options->b, options->json);
        });
    });
}

} // namespace restage::app
