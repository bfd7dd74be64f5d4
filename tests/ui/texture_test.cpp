// SPDX-License-Identifier: Apache-2.0
// Textures of pictures whose size changes often.
#include "editor/texture.hpp"
#include "headless.hpp"

#include <vector>

using namespace restage;
using tests::Headless;

TEST_CASE("a texture may come back to a size that is just being freed", "[ui]") {
    editor::Texture texture; // outlives the window
    Headless h("cornell/cornell.pbrt");
    const std::vector<std::uint32_t> pixels(64 * 64, 0xff808080u);
    h.play("sizes", [&](ImGuiTestContext* ctx) {
        const auto show = [&](std::uint32_t side) {
            texture.set(side, side, pixels);
            ImGui::GetForegroundDrawList()->AddImage(texture.ref(), {0, 0}, {8, 8}); // asserts that it is alive
        };
        for (int round = 0; round < 3; ++round)
            for (std::uint32_t side = 1; side <= 12; ++side) { // more than are kept
                show(side);
                ctx->Yield();
                show(side > 1 ? side - 1 : 12);
                ctx->Yield();
                show(1);
                ctx->Yield();
            }
        IM_CHECK(texture.ready());
    });
}
