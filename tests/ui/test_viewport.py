# SPDX-License-Identifier: Apache-2.0
"""The viewport with a real mouse and real keys: pick, drag, copy, delete, navigate, undo; each step is checked on the document
and on the picture."""
import pathlib
import time

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEMO = ROOT / "scenes/demo/demo.pbrt"
CHAIR = ("picture", 0.62, 0.88)
SKY = ("picture", 0.1, 0.3)


@pytest.fixture
def editor(launch):
    editor = launch(DEMO)
    editor.settled()
    return editor


def names(state):
    return sorted(item["name"] for item in state["selection"])


def difference(a, b):
    """Mean absolute difference over 8x8 blocks, so that noise counts little."""
    def blocks(x):
        h, w = x.shape[0] // 8 * 8, x.shape[1] // 8 * 8
        return x[:h, :w].reshape(h // 8, 8, w // 8, 8, 3).mean((1, 3))
    return np.abs(blocks(a) - blocks(b))


def test_opens_and_shows_a_picture(editor):
    state = editor.state()
    assert state["counts"]["instances"] == 119 and not state["modified"]
    picture = editor.picture()
    assert picture.std() > 0.1, "the viewport shows one flat colour"


def test_a_chair_is_picked_moved_copied_and_deleted_and_all_is_undone_and_redone(editor):
    before = editor.picture()
    editor.click(CHAIR)
    state = editor.wait(lambda s: s["selection"], "a selection")
    assert names(state) == ["Chair cushion", "Chair frame"], "a click picks the whole group"
    start = np.array(state["selection"][0]["position"])

    # its handles: along x only
    x, y = editor.point("gizmo.x")
    editor.drag((x, y), (x + 60, y + 45))
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the drag as one step")
    moved = np.array(state["selection"][0]["position"]) - start
    assert abs(moved[0]) > 0.05 and abs(moved[1]) < 1e-6 and abs(moved[2]) < 1e-6
    assert state["history"]["undo"].startswith("Move")
    editor.settled()
    assert difference(before, editor.picture()).max() > 0.15, "the picture does not show the move"

    editor.key("ctrl+d")
    state = editor.wait(lambda s: s["history"]["position"] == 2, "a copy")
    assert state["counts"]["instances"] == 121
    assert names(state) == ["Chair cushion 4", "Chair frame 4"]
    editor.key("Delete")
    state = editor.wait(lambda s: s["history"]["position"] == 3, "the deletion")
    assert state["counts"]["instances"] == 119 and not state["selection"]

    for expected in (2, 1, 0):
        editor.key("ctrl+z")
        editor.wait(lambda s: s["history"]["position"] == expected, f"undo to {expected}")
    assert not editor.state()["modified"]
    editor.key("Escape")
    editor.move(SKY)
    editor.settled()
    # The same picture again, up to noise (and without the outline).
    assert np.percentile(difference(before, editor.picture()), 90) < 0.08
    for expected in (1, 2, 3):
        editor.key("ctrl+y")
        editor.wait(lambda s: s["history"]["position"] == expected, f"redo to {expected}")


def test_a_drag_with_shift_leaves_the_original_and_one_with_alt_lifts(editor):
    editor.click(CHAIR)
    state = editor.wait(lambda s: s["selection"], "a selection")
    start = np.array(state["selection"][0]["position"])
    x, y = editor.point("gizmo.y")
    editor.drag((x, y), (x - 50, y + 20), keys=["shift"])
    state = editor.wait(lambda s: s["history"]["size"] == 1, "one step")
    assert state["counts"]["instances"] == 121, "nothing was copied"
    assert "4" in state["selection"][0]["name"] and not np.allclose(state["selection"][0]["position"], start)
    editor.key("ctrl+z")
    state = editor.wait(lambda s: s["history"]["position"] == 0, "undo")
    assert state["counts"]["instances"] == 119

    editor.click(CHAIR)
    editor.wait(lambda s: names(s) == ["Chair cushion", "Chair frame"], "the chair again")
    x, y = editor.point("gizmo.center")
    editor.drag((x, y), (x + 10, y - 60), keys=["alt"])
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the lift as one step")
    moved = np.array(state["selection"][0]["position"]) - start
    assert moved[2] > 0.05 and np.allclose(moved[:2], 0, atol=1e-6) and state["counts"]["instances"] == 119, moved


def test_alt_orbits_from_anywhere_and_lifts_during_a_slide(editor):
    editor.click(CHAIR)
    start = editor.wait(lambda s: s["selection"], "a selection")
    rail = ("picture", 0.66, 0.735)  # of its back, beside the handles
    editor.drag(rail, ("picture", 0.60, 0.735), keys=["alt"])
    state = editor.wait(lambda s: s["views"]["apart"], "another view")
    assert state["history"]["size"] == 0 and state["selection"] == start["selection"], "looking around changed the scene"
    editor.key("bracketleft")
    editor.wait(lambda s: not s["views"]["apart"], "the view before")
    x, y = editor.point(rail)
    editor.move((x, y))
    editor.desk.xdotool("mousedown", 1)
    for i in range(1, 9):
        editor.desk.xdotool("mousemove", x + 5 * i, y)
        time.sleep(0.05)
    before = editor.wait(lambda s: s["history"]["size"] == 1 and s["selection"] != start["selection"], "it to slide")
    assert abs(before["selection"][0]["position"][2] - start["selection"][0]["position"][2]) < 1e-6
    editor.desk.xdotool("keydown", "alt")
    time.sleep(0.2)
    for i in range(1, 9):
        editor.desk.xdotool("mousemove", x + 40, y - 8 * i)
        time.sleep(0.05)
    time.sleep(0.2)
    editor.desk.xdotool("mouseup", 1, "keyup", "alt")
    state = editor.wait(lambda s: s["selection"][0]["position"][2] > start["selection"][0]["position"][2] + 0.05, "it to be lifted")
    assert state["history"]["size"] == 1 and not state["views"]["apart"]


def test_orbit_pan_zoom_and_back(editor):
    opened = editor.state()
    eye = np.array(opened["camera"])
    editor.drag(("picture", 0.8, 0.3), ("picture", 0.7, 0.35), keys=["alt"])
    orbited = editor.wait(lambda s: s["views"]["apart"], "orbiting")
    assert np.linalg.norm(np.array(orbited["camera"]) - eye) > 0.1
    editor.drag(("picture", 0.8, 0.3), ("picture", 0.75, 0.3), button=2)
    panned = editor.wait(lambda s: s["camera"] != orbited["camera"], "panning")
    editor.click(("picture", 0.5, 0.5), button=4)  # the wheel
    zoomed = editor.wait(lambda s: s["camera"] != panned["camera"], "zooming")
    assert zoomed["history"]["size"] == 0 and not zoomed["modified"] and zoomed["scene_camera"] == opened["camera"]
    for key, place in (("bracketleft", panned), ("bracketleft", orbited), ("bracketleft", opened), ("bracketright", orbited)):
        editor.key(key)
        editor.wait(lambda s: np.allclose(s["camera"], place["camera"]), f"{key}: one step further, not part of a gesture")
    editor.key("ctrl+shift+Home")  # the camera comes here
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the camera moved as one step")
    assert np.allclose(state["scene_camera"], orbited["camera"]) and not state["views"]["apart"] and state["modified"]
    editor.key("shift+Home")
    editor.wait(lambda s: np.allclose(s["camera"], eye) and s["views"]["apart"], "the camera of the file")
    editor.key("ctrl+z")
    state = editor.wait(lambda s: s["history"]["position"] == 0, "undo")
    assert np.allclose(state["scene_camera"], eye) and not state["modified"]


def test_looking_around_does_not_eat_undo(editor):
    """An object is hidden, then the user zooms: undo shows the object, and does not zoom back."""
    editor.click(CHAIR)
    editor.wait(lambda s: s["selection"], "a selection")
    editor.key("h")
    editor.wait(lambda s: s["counts"]["hidden"] == 2, "hiding")
    editor.click(("picture", 0.5, 0.5), button=4)
    zoomed = editor.wait(lambda s: s["views"]["apart"], "another view")
    editor.key("ctrl+z")
    state = editor.wait(lambda s: s["counts"]["hidden"] == 0, "undo of hiding")
    assert state["camera"] == zoomed["camera"] and not state["modified"]


def test_an_unlocked_camera_follows_and_each_move_is_a_step(editor):
    eye = editor.state()["camera"]
    editor.click("menu.view")
    editor.click("view.lock_camera")
    editor.drag(("picture", 0.8, 0.3), ("picture", 0.7, 0.35), keys=["alt"])
    state = editor.wait(lambda s: s["history"]["position"] == 1, "orbiting as one step")
    assert state["scene_camera"] == state["camera"] != eye and not state["views"]["apart"]
    editor.click(("picture", 0.5, 0.5), button=4)
    editor.wait(lambda s: s["history"]["position"] == 2, "zooming as one step")
    editor.key("ctrl+z", "ctrl+z")
    editor.wait(lambda s: s["history"]["position"] == 0 and np.allclose(s["camera"], eye), "undo of both")


def test_quick_keys_are_all_done_in_order(editor):
    """Forty undos and redos, faster than frames; each key of a frame counts."""
    editor.click(CHAIR)
    editor.wait(lambda s: s["selection"], "a selection")
    for steps in range(5):
        editor.key("ctrl+d")
        editor.wait(lambda s: s["history"]["size"] == steps + 1, "a copy")
    # Faster than any user; but GLFW drops the second of two presses of a key with the same X timestamp in milliseconds.
    editor.desk.xdotool(*["key", "--delay", "4"] + ["ctrl+z"] * 5 + ["ctrl+y"] * 5 + ["ctrl+z", "ctrl+y"] * 15)
    eye = editor.state()["camera"]
    editor.key("Home")  # comes after them; undo and redo leave the view alone
    state = editor.wait(lambda s: s["camera"] != eye, "the key after them")
    assert state["history"]["position"] == 5, "some were lost"


def test_a_click_on_the_same_place_picks_what_is_behind(editor):
    editor.key("q")  # no handles in the way
    editor.click(CHAIR)
    first = names(editor.wait(lambda s: s["selection"], "a selection"))
    editor.click(CHAIR)
    editor.wait(lambda s: names(s) != first and s["selection"], "something behind it")
    editor.key("Escape")
    editor.wait(lambda s: not s["selection"], "an empty selection")
    editor.click(CHAIR)
    assert names(editor.wait(lambda s: s["selection"], "a selection")) == first, "nothing is before it"


def test_the_selection_slides_over_the_floor_and_with_shift_a_copy_does(editor):
    editor.click(CHAIR)
    start = editor.wait(lambda s: s["selection"], "a selection")["selection"]
    rail, there = ("picture", 0.66, 0.735), ("picture", 0.76, 0.775)  # of its back, beside the handles
    editor.drag(rail, there, steps=16)
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the drag as one step")
    for part, was in zip(state["selection"], start):
        moved = np.array(part["position"]) - was["position"]
        assert min(abs(moved[:2])) > 0.02 and np.hypot(moved[0], moved[1]) > 0.2 and abs(moved[2]) < 1e-6, f"not over the floor: {moved}"
    editor.settled(1)
    editor.drag(there, rail, keys=["shift"], steps=16)
    state = editor.wait(lambda s: s["history"]["position"] == 2, "the copy as one step")
    assert state["counts"]["instances"] == 121 and names(state) == ["Chair cushion 4", "Chair frame 4"]
    assert np.allclose([part["position"] for part in state["selection"]], [was["position"] for was in start], atol=0.03), "back again"


def test_a_box_to_the_right_picks_what_is_inside_and_to_the_left_what_it_touches(editor):
    editor.key("q")
    upper, lower = ("picture", 0.53, 0.70), ("picture", 0.80, 0.92)  # the chair except for the ends of its legs
    editor.drag(upper, lower)
    assert "Chair frame" not in names(editor.state())
    editor.drag(lower, upper)
    editor.wait(lambda s: {"Chair cushion", "Chair frame"} <= set(names(s)), "the chair")


def test_a_box_picks_everything_visible_in_it(editor):
    editor.key("q")  # no handles
    editor.drag(("picture", 0.02, 0.02), ("picture", 0.98, 0.98))
    state = editor.wait(lambda s: len(s["selection"]) > 50, "many objects")
    assert state["history"]["size"] == 0
    editor.key("Escape")
    editor.wait(lambda s: not s["selection"], "an empty selection")


def test_view_settings_restart_nothing(editor):
    request = editor.state()["view"]["request"]
    editor.key("n")            # denoising off
    editor.key("v")            # overlays off
    editor.click(CHAIR)
    editor.wait(lambda s: s["selection"], "a selection")
    assert editor.state()["view"]["request"] == request
    editor.key("Tab")
    editor.wait(lambda s: s["view"]["request"] != request, "a larger picture once the panels are gone")


def test_the_validation_layers_are_silent(launch):
    editor = launch(DEMO, "--validation")
    editor.settled(1, 150)
    editor.click(CHAIR)
    editor.click("menu.edit")
    editor.key("Escape")
    for size in ((1000, 600), (1280, 720)):
        editor.desk.resize("Restage", size)
        time.sleep(1)
    assert not [line for line in editor.state()["log"] if "alidation" in line][:3]


def test_partial_redraws_equal_a_full_redraw(editor):
    """Menus, tooltips, handles and panels appear and vanish; afterwards the window's pixels equal a full redraw."""
    editor.click(CHAIR)
    editor.wait(lambda s: s["selection"], "a selection")
    for menu in ("menu.edit", "menu.panels"):
        editor.click(menu)
        editor.key("Escape")
    editor.drag("gizmo.x", ("picture", 0.8, 0.9))
    editor.move("material.type")
    time.sleep(1.5)  # its tip
    editor.key("question")
    editor.wait(lambda s: "help.standard" in s["marks"], "the help")
    editor.key("Escape")
    editor.wait(lambda s: "help.standard" not in s["marks"], "it to go again")
    editor.move(("picture", 0.3, 0.3))
    time.sleep(1)
    parts = editor.desk.screenshot()
    place = editor.state()["marks"]["picture"]
    editor.desk.resize("Restage", (1200, 700))
    editor.wait(lambda s: s["marks"]["picture"] != place, "the smaller window")
    editor.desk.resize("Restage", (1280, 720))
    editor.wait(lambda s: s["marks"]["picture"] == place, "the window's first size")
    x0, y0, x1, y1 = (int(v) for v in editor.state()["marks"]["picture"])  # it accumulates samples meanwhile
    for _ in range(20):  # a busy machine needs time to draw the larger window
        time.sleep(0.5)
        whole = editor.desk.screenshot()
        whole[y0:y1, x0:x1] = parts[y0:y1, x0:x1]
        rows, columns = np.nonzero((parts != whole).any(2))
        if not rows.size:
            break
    assert not rows.size, f"{rows.size} pixels in {columns.min()}..{columns.max()} x {rows.min()}..{rows.max()} differ"


def test_hiding_is_a_change_and_shows(editor):
    before = editor.picture()
    editor.click(CHAIR)
    editor.wait(lambda s: s["selection"], "a selection")
    editor.key("h")
    editor.wait(lambda s: s["history"]["position"] == 1, "hiding")
    editor.key("Escape")
    editor.settled()
    assert difference(before, editor.picture()).max() > 0.15
    editor.key("alt+h")
    editor.wait(lambda s: s["history"]["position"] == 2, "showing all")
