// SPDX-License-Identifier: Apache-2.0
// Batches of final pictures: their order, pause, cancelling one, "enough"; and series of a camera that moves.
#include "headless.hpp"

#include "editor/files.hpp"
#include "editor/final_batch.hpp"
#include "editor/final_pictures.hpp"
#include "scene/edits.hpp"
#include "temporary_folder.hpp"

#include <fstream>
#include <iterator>

using namespace restage;
using editor::FinalBatch;
using State = FinalBatch::State;
using tests::Headless;

namespace {

std::string order(const FinalBatch& batch) {
    std::string text;
    for (const FinalBatch::Line& line : batch.lines())
        text += line.name;
    return text;
}

std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// A picture of 16 x 16 pixels, and cameras "Second" and "Third" besides the file's.
void prepare(Headless& h) {
    document::Session& session = h.editor().session_for_changes();
    scene::Film film = h.scene().film.value;
    film.width = film.height = 16;
    REQUIRE(session.edit(scene::set_film(h.scene(), film)));
    for (const char* name : {"Second", "Third"}) {
        scene::Camera camera = h.editor().scene_camera();
        camera.name = name;
        camera.camera_to_world[3].x += name[0] == 'S' ? 0.3 : 0.6;
        REQUIRE(session.edit(scene::insert(h.scene(), camera, "Camera")));
    }
}

bool wait_until(ImGuiTestContext* ctx, const std::function<bool()>& done) {
    for (int i = 0; i < 60000 && !done(); ++i) {
        ctx->Yield();
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return done();
}

} // namespace

TEST_CASE("a batch renders in the order that the user makes", "[ui]") {
    FinalBatch batch({"a", "b", "c", "d"});
    CHECK(batch.next() == 0);
    batch.move(3, -1);
    CHECK(order(batch) == "abdc");
    batch.move(3, -1);
    batch.move(3, -1); // not before what renders
    CHECK(order(batch) == "adbc");
    batch.move(0, 1); // nor does that move
    batch.move(2, 1);
    batch.move(9, 1);
    CHECK(order(batch) == "adbc");
    batch.cancel(1);
    batch.move(2, -1); // past the cancelled one
    CHECK(order(batch) == "acbd");
    batch.report(0.5);
    CHECK(batch.done() == 0.5 / 3);
    CHECK(batch.count() == "1 of 3, ");
    CHECK_FALSE(batch.enough());
    batch.finish_early(0);
    CHECK(batch.enough());
    batch.finish(State::done);
    CHECK(batch.next() == 2);
    CHECK(batch.count() == "2 of 3, ");
    CHECK_FALSE(batch.cancelled());
    batch.cancel(2); // while it renders
    CHECK(batch.cancelled());
    batch.finish(State::done); // too late
    CHECK(batch.next() == 3);
    batch.finish(State::failed);
    batch.cancel(3);
    CHECK_FALSE(batch.next());
    CHECK(batch.done() == 1);
    std::vector<State> states;
    for (const FinalBatch::Line& line : batch.lines())
        states.push_back(line.state);
    CHECK((states == std::vector{State::done, State::cancelled, State::cancelled, State::failed}));
}

TEST_CASE("a dragged picture takes the place of the one it is dropped on", "[ui]") {
    FinalBatch batch({"a", "b", "c", "d", "e"});
    CHECK(batch.next() == 0);
    batch.put(4, 1);
    CHECK(order(batch) == "aebcd");
    batch.put(4, 3);
    CHECK(order(batch) == "abcde");
    batch.put(1, 2);
    CHECK(order(batch) == "acbde");
    batch.put(3, 0); // not before what renders
    batch.put(0, 3); // nor does that move
    batch.put(3, 3);
    batch.put(9, 3);
    CHECK(order(batch) == "acbde");
    CHECK(batch.next() == 2);
}

TEST_CASE("a batch is reordered, paused and resumed, and one of its pictures cancelled", "[ui]") {
    const test::TemporaryFolder folder;
    Headless h("cornell/cornell.pbrt");
    prepare(h);
    const std::string first = h.editor().scene_camera().name;
    const editor::BackgroundJobs& jobs = h.editor().files().jobs;
    h.play("batch", [&](ImGuiTestContext* ctx) {
        editor::start_final_pictures(
            h.editor(),
            {.samples = 1u << 20, .denoise = false, .all_cameras = true, .path = folder.path() / "box.pfm"});
        h.wait_for(ctx, "batch.enough");
        IM_CHECK(jobs.picture_paused());
        IM_CHECK(wait_until(ctx, [&] { return jobs.progress() > 0; }));
        h.click(ctx, "batch.up.Third");
        const auto is_above = [&](const char* a, const char* b) {
            return h.find(ctx, std::string("batch.state.") + a).y < h.find(ctx, std::string("batch.state.") + b).y;
        };
        IM_CHECK(is_above("Third", "Second"));
        const auto drag_onto = [&](const char* a, const char* b) {
            const ImVec4 from = h.find(ctx, std::string("batch.row.") + a),
                         to = h.find(ctx, std::string("batch.row.") + b);
            ctx->MouseMoveToPos({from.x + 10, (from.y + from.w) / 2});
            ctx->MouseDown();
            ctx->MouseMoveToPos({from.x + 20, (from.y + from.w) / 2 + 4});
            ctx->MouseMoveToPos({to.x + 20, (to.y + to.w) / 2});
            ctx->MouseUp();
            ctx->Yield(2);
        };
        drag_onto("Third", "Second");
        IM_CHECK(is_above("Second", "Third"));
        drag_onto("Third", "Second");
        IM_CHECK(is_above("Third", "Second"));

        h.click(ctx, "job.pause");
        IM_CHECK(!jobs.picture_paused()); // the editor has the processor meanwhile
        IM_CHECK(wait_until(ctx, [&] { // the batch that was being traced ends
            const double before = jobs.progress();
            std::this_thread::sleep_for(std::chrono::milliseconds(400));
            return jobs.progress() == before;
        }));
        h.click(ctx, "batch.enough");
        IM_CHECK(wait_until(ctx, [&] { return !h.has(ctx, "batch.enough"); }));
        IM_CHECK(std::filesystem::exists(folder.path() / ("box - " + first + ".pfm")));
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        IM_CHECK(h.has(ctx, "batch.up.Third")); // it waits

        h.click(ctx, "job.pause");
        h.wait_for(ctx, "batch.enough");
        IM_CHECK(h.has(ctx, "batch.up.Second") && !h.has(ctx, "batch.up.Third"));
        h.click(ctx, "batch.cancel.Third");
        IM_CHECK(wait_until(ctx, [&] { return !h.has(ctx, "batch.up.Second"); }));
        IM_CHECK(wait_until(ctx, [&] { return jobs.progress() > 0.5; })); // it has samples
        h.click(ctx, "batch.enough");
        IM_CHECK(wait_until(ctx, [&] { return !jobs.running(); }));
    });
    CHECK(std::filesystem::exists(folder.path() / "box - Second.pfm"));
    CHECK_FALSE(std::filesystem::exists(folder.path() / "box - Third.pfm"));
}

TEST_CASE("a turntable and a path through all cameras are series of pictures", "[ui]") {
    const test::TemporaryFolder folder;
    Headless h("cornell/cornell.pbrt");
    prepare(h);
    const auto render = [&](editor::CameraMove move, const char* name, std::uint32_t frames) {
        h.play(name, [&](ImGuiTestContext* ctx) {
            editor::start_final_pictures(
                h.editor(),
                {.samples = 2, .denoise = false, .move = move, .frames = frames, .path = folder.path() / name});
            IM_CHECK(wait_until(ctx, [&] { return !h.editor().files().jobs.running(); }));
        });
    };
    render(editor::CameraMove::none, "still.pfm", 0);
    render(editor::CameraMove::turntable, "turn.pfm", 2);
    render(editor::CameraMove::path, "path.pfm", 3);
    const std::string still = bytes_of(folder.path() / "still.pfm");
    CHECK_FALSE(still.empty());
    CHECK(bytes_of(folder.path() / "turn 0001.pfm") == still);
    CHECK(bytes_of(folder.path() / "turn 0002.pfm") != still);
    CHECK(bytes_of(folder.path() / "path 0001.pfm") == still);
    CHECK(bytes_of(folder.path() / "path 0003.pfm") != still);
    CHECK_FALSE(std::filesystem::exists(folder.path() / "path 0004.pfm"));
    CHECK(editor::shots_of(h.editor(), {.all_cameras = true, .path = "a.png"}).size() == 3);
    CHECK(
        editor::shots_of(h.editor(), {.all_cameras = true, .move = editor::CameraMove::path, .path = "a.png"}).size() ==
        1);
}
