// @LABEL@: the parameter table; the physics is in @NAME@.glsl.
#include <restage/plugin.hpp>

namespace {

using namespace restage::sdk;

constexpr RestageParam params[] = {
    color("tint", "Tint", {0.8f, 0.4f, 0.2f}, {.tooltip = "Fraction of light that is reflected.", .texturable = true}),
};

constexpr RestageMaterial1 material{
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_LOSSLESS,
    .type = "@NAME@",
    .label = "@LABEL@",
    .prefix = "@NAME@",
    .glsl_file = "@NAME@.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "One sentence for users who are choosing a material.",
};

} // namespace

RESTAGE_PLUGIN("@ID@", "0.1.0", {RESTAGE_MATERIAL1, &material})
