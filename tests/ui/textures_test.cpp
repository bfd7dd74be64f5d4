// SPDX-License-Identifier: Apache-2.0
// Textures in the inspector: created of any loaded type, edited, nested, swapped and removed; each change is one undo
// step.
#include "headless.hpp"

#include "scene/edits_texture.hpp"

using namespace restage;
using tests::Headless;

namespace {

struct Clay { // an object of the scene "spheres" whose material has no textures
    editor::InstanceId object;
    scene::Id<scene::Material> material;
};

Clay clay(Headless& h) {
    Clay found;
    h.scene().instances.each([&](editor::InstanceId id, const scene::Instance& i) {
        const scene::Material* m = h.scene().materials.find(i.material);
        if (!found.object && m && m->name == "Clay") found = {id, i.material};
    });
    REQUIRE(found.object);
    const editor::InstanceId ids[] = {found.object};
    h.editor().selection.set(ids);
    return found;
}

} // namespace

TEST_CASE("a texture of any loaded type is created, edited, swapped and removed in the inspector", "[ui]") {
    Headless h("spheres/spheres.pbrt");
    const Clay at = clay(h);
    const auto in_slot = [&](const char* param) -> const scene::Texture* {
        return h.scene().textures.find(h.scene().materials[at.material].params.texture(param));
    };
    const auto undone = [&](ImGuiTestContext* ctx, std::size_t step) { // the step was one
        IM_CHECK_RETV(h.step() == step + 1, false);
        h.editor().run("edit.undo");
        ctx->Yield(2);
        IM_CHECK_RETV(h.step() == step, false);
        return true;
    };
    const std::string slot = "material.reflectance", of = slot + ".of";
    h.play("each type", [&](ImGuiTestContext* ctx) {
        h.focus(ctx, "Inspector");
        const auto before = h.scene().materials[at.material];
        for (const auto& entry : h.registry().textures()) {
            const std::size_t step = h.step();
            h.click(ctx, slot + ".texture");
            h.click(ctx, slot + ".texture.new");
            h.click(ctx, slot + ".texture.new." + entry.table->type);
            const scene::Texture* made = in_slot("reflectance");
            IM_CHECK(made && made->type == entry.table->type && !made->is_float);
            const auto first =
                std::ranges::find_if(entry.table->params, [](const model::Param& line) { return line.texturable; });
            if (first != entry.table->params.end()) // the slot's previous content
                IM_CHECK(made->params.find(first->id)->v == before.params.find("reflectance")->v);
            IM_CHECK(undone(ctx, step));
            IM_CHECK(h.scene().materials[at.material] == before);
        }
    });
    h.play("parameters", [&](ImGuiTestContext* ctx) {
        h.click(ctx, slot + ".texture");
        h.click(ctx, slot + ".texture.new");
        h.click(ctx, slot + ".texture.new.checkerboard");
        h.click(ctx, of); // unfolds it
        std::size_t step = h.step();
        h.drag(ctx, of + ".uscale");
        IM_CHECK(in_slot("reflectance")->params.number("uscale", 1) != 1);
        IM_CHECK(undone(ctx, step));
        h.drag(ctx, of + ".tex2");
        IM_CHECK(undone(ctx, step));
        h.click(ctx, of + ".advanced");
        h.drag(ctx, of + ".ushear");
        IM_CHECK(in_slot("reflectance")->params.number("ushear", 0) != 0);
        h.click(ctx, of + ".ushear", 1);
        h.click(ctx, of + ".ushear.reset");
        IM_CHECK(!in_slot("reflectance")->params.find("ushear"));
        h.click(ctx, of + ".advanced");
        h.click(ctx, of + ".name");
        ctx->KeyCharsReplaceEnter("Tiles");
        ctx->Yield(2);
        IM_CHECK(in_slot("reflectance")->name == "Tiles");
    });
    h.play("operands", [&](ImGuiTestContext* ctx) {
        const std::size_t step = h.step();
        h.click(ctx, of + ".tex1.texture");
        h.click(ctx, of + ".tex1.texture.new");
        h.click(ctx, of + ".tex1.texture.new.marble");
        IM_CHECK(h.step() == step + 1);
        const auto operand = in_slot("reflectance")->params.texture("tex1");
        IM_CHECK(operand && h.scene().textures[operand].type == "marble");
        h.click(ctx, of + ".tex1.of");
        h.drag(ctx, of + ".tex1.of.variation");
        IM_CHECK(h.step() == step + 2);
        IM_CHECK(h.scene().textures[operand].params.number("variation", 0.2f) != 0.2f);
        h.click(ctx, of + ".tex1.of"); // folds it
        h.click(ctx, of + ".tex2.texture"); // not itself
        IM_CHECK(h.has(ctx, of + ".tex2.texture." + h.scene().textures[operand].name));
        IM_CHECK(!h.has(ctx, of + ".tex2.texture.Tiles"));
        h.click(ctx, of + ".tex2.texture." + h.scene().textures[operand].name);
        IM_CHECK(h.step() == step + 3 && in_slot("reflectance")->params.texture("tex2") == operand);
        h.click(ctx, of + ".tex2.of");
        IM_CHECK(h.has(ctx, of + ".tex2.of.shared"));
        h.click(ctx, of + ".tex2.of");
    });
    h.play("type", [&](ImGuiTestContext* ctx) {
        const std::size_t step = h.step();
        const auto operand = in_slot("reflectance")->params.texture("tex1");
        h.click(ctx, of + ".type");
        h.click(ctx, of + ".type.dots");
        IM_CHECK(h.step() == step + 1);
        IM_CHECK(in_slot("reflectance")->type == "dots" && in_slot("reflectance")->name == "Tiles");
        IM_CHECK(in_slot("reflectance")->params.texture("inside") == operand);
    });
    h.play("remove", [&](ImGuiTestContext* ctx) {
        const std::size_t step = h.step();
        h.click(ctx, slot + ".texture");
        h.click(ctx, slot + ".texture.remove");
        IM_CHECK(h.step() == step + 1 && !in_slot("reflectance"));
        while (h.step() > 0) {
            h.editor().run("edit.undo");
            ctx->Yield(2);
        }
        IM_CHECK(h.scene().textures.live() == h.editor().original()->textures.live());
    });
    h.play("a number, and a height", [&](ImGuiTestContext* ctx) {
        for (const char* param : {"sigma", "bump"}) {
            const std::string mark = std::string("material.") + param;
            h.click(ctx, std::string(param) == "bump" ? mark : mark + ".texture");
            h.click(ctx, mark + ".texture.new");
            h.click(ctx, mark + ".texture.new.mix");
            IM_CHECK(in_slot(param) && in_slot(param)->is_float);
            h.click(ctx, mark + ".of");
            h.drag(ctx, mark + ".of.tex1"); // a number, not a colour
            const scene::Value* one = in_slot(param)->params.find("tex1");
            IM_CHECK(one && one->type == model::ParamType::color && one->v[0] == one->v[1] && one->v[1] == one->v[2]);
        }
    });
}
