// SPDX-License-Identifier: Apache-2.0
// The action and panel of action.c, rebuilt: "copies" has another range, "step" was removed, "gap" added. OTHER_THROWS:
// both throw exceptions, the action after it has added an object.
#include <restage/action.h>
#include <stdexcept>

#include <restage/plugin.hpp>

namespace {

using namespace restage::sdk;

constexpr RestageParam params[] = {
    number("gap", "Gap", 0, 10, 2, {.tooltip = "From one to the next."}),
    integer("copies", "Copies", 0, 50, 4, {.tooltip = "Of each object."}),
};

int run(const RestageSceneReader1* scene, const RestageSelection1* selection, const RestageValue* values, std::uint32_t,
        RestageEditWriter1* edits) {
    for (std::uint32_t i = 0; i < selection->instance_count; ++i) {
        RestageInstance object{};
        if (!scene->instance(scene->ctx, selection->instances[i], &object)) continue;
        for (int k = 0; k < RESTAGE_AT(RestageValue, values, 1).i; ++k) {
            object.object_to_world[12] += static_cast<double>(RESTAGE_AT(RestageValue, values, 0).v[0]);
            edits->add_instance(edits->ctx, &object);
#if defined(OTHER_THROWS)
            throw std::runtime_error("no room on the stack");
#endif
        }
    }
    return 1;
}

constexpr RestageAction1 action{.size = sizeof(RestageAction1),
                                .id = "stack",
                                .label = "Stack",
                                .tooltip = "Copies of the selected objects, one after the other.",
                                .params = params,
                                .param_count = RESTAGE_COUNT(params),
                                .flags = 0,
                                .run = run};

void draw(const RestageUi1* ui, void* ctx) {
    ui->param(ctx, "copies");
    if (ui->button(ctx, "Stack", "")) ui->run(ctx, "stack");
#if defined(OTHER_THROWS)
    ui->begin_group(ctx, "Where");
    RestageValue value{};
    if (ui->get(ctx, "copies", &value)) {
        value.i = 50;
        ui->set(ctx, "More", &value, 1);
    }
    throw std::runtime_error("nothing to draw with");
#else
    ui->param(ctx, "gap");
#endif
}

constexpr RestagePanel1 panel{.size = sizeof(RestagePanel1),
                              .id = "stack",
                              .label = "Stack",
                              .params = params,
                              .param_count = RESTAGE_COUNT(params),
                              .draw = draw};

} // namespace

RESTAGE_PLUGIN("org.example.broken", "1.0.0", {RESTAGE_ACTION1, &action}, {RESTAGE_PANEL1, &panel})
