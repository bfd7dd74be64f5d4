// SPDX-License-Identifier: Apache-2.0
// restage merge A.exr B.exr ... -o OUT: combines separately rendered parts of one picture.
#include "commands.hpp"
#include "developing.hpp"
#include "render/film_error.hpp"
#include "rendering.hpp"
#include "standard_streams.hpp"
#include "view/merge_pictures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>

namespace restage::app {
namespace {

struct Options {
    std::vector<std::string> parts;
    std::string output;
    RenderOptions denoising;
    PictureOptions picture;
    DevelopmentOptions development;
};

Result<int> run(Context& context, Options& o) {
    RESTAGE_TRY(const Output output, Output::create(o.output));
    RESTAGE_CHECK(check_picture_path(output.path()));
    std::vector<view::StoredPicture> parts;
    for (const std::string& path : o.parts) {
        RESTAGE_TRY(parts.emplace_back(), view::read_picture(path));
    }
    auto merged = view::merge_pictures(parts);
    if (!merged) return fail(fmt::format("{}", fmt::join(o.parts, ", ")), merged.error());
    Picture picture{.film = std::move(merged->film), .denoised = {}, .development = o.development.over({})};
    RESTAGE_CHECK(denoise_picture(context, o.denoising, picture));
    o.picture.metadata = std::move(merged->metadata);
    o.picture.metadata["restage:denoiser"] = picture.denoiser;
    o.picture.aovs = merged->layers.empty() ? "none" : fmt::format("{}", fmt::join(merged->layers, ","));
    RESTAGE_CHECK(write_picture(output.path(), picture, o.picture));
    RESTAGE_CHECK(output.finish());
    context.log.info(fmt::format("{}: {} spp, relative error {:.4f}", o.output, picture.film.samples,
                                 render::relative_error(picture.film)));
    return int(exit_ok);
}

} // namespace

void add_merge(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command =
        program.add_subcommand("merge", "Combine parts of one render: other seeds, or other samples of one seed");
    command->add_option("PART", o->parts, "Pictures that `restage render` wrote as .exr, of one scene and size")
        ->required();
    command
        ->add_option("-o,--output", o->output,
                     "Picture to write: .exr, .png, .jpg, .pfm or .hdr; - = stdout as .exr, png:- as .png")
        ->required();
    command->add_option("--denoise", o->denoising.denoise, "Denoise it; --denoise alone is high quality")
        ->expected(0, 1)
        ->default_str("high")
        ->check(CLI::IsMember({"fast", "balanced", "high"}));
    command->add_option("--denoiser", o->denoising.denoiser,
                        "Use this denoiser: its type or the id of its plugin (default: the one shipped with "
                        "Restage); implies --denoise");
    command->add_option("--exposure", o->picture.exposure_stops, "Brighten a .png or .jpg [stops] (default: 0)")
        ->check(CLI::Range(-64.f, 64.f));
    add_development_options(*command, o->development, "srgb");
    add_example(*command, "restage merge part1.exr part2.exr -o whole.exr");
    command->callback([&context, o] { context.choose([&context, o] { return run(context, *o); }); });
}

} // namespace restage::app
