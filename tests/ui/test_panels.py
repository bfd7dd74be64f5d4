# SPDX-License-Identifier: Apache-2.0
"""Transfers between panels and the picture, with a real mouse: materials picked and assets dragged there, missing
images relinked in the file browser, objects dragged between groups; and the hint at the first start."""
import json
import pathlib

import numpy as np
import pytest

from test_files import modal, type_path
from test_viewport import CHAIR, DEMO, difference, names

FLOOR = ("picture", 0.12, 0.93)
HOVER = np.float32([0.55, 0.78, 0.98])  # colors::hover
SCENE = """LookAt 0 1 4  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 640 "integer yresolution" 360
WorldBegin
LightSource "infinite" "rgb L" [0.8 0.8 0.8]
Texture "planks" "spectrum" "imagemap" "string filename" "gone/planks.png"
Texture "wool" "spectrum" "imagemap" "string filename" "gone/wool.png"
Material "diffuse" "texture reflectance" "planks"
Shape "disk" "float radius" 3
Material "diffuse" "texture reflectance" "wool"
Shape "sphere" "float radius" 0.5
"""


@pytest.fixture
def editor(launch):
    editor = launch(DEMO)
    editor.settled(samples=1)
    return editor


def tab(editor, name):
    editor.click("tab." + name)


def outlined(editor):
    """The pixels of the picture in the hover colour, as rows and columns; outlines are thin lines."""
    return np.nonzero(np.abs(editor.picture() - HOVER).max(2) < 0.02)


def test_the_eyedropper_takes_a_material_from_the_picture(editor):
    editor.click(FLOOR)
    floor = editor.wait(lambda s: names(s) == ["Floor"], "the floor")["selection"][0]["material"]
    editor.click(CHAIR)
    chair = editor.wait(lambda s: len(names(s)) == 2, "the chair")["selection"]
    assert floor not in {part["material"] for part in chair}
    tab(editor, "Inspector")
    editor.click("material.pick")
    editor.key("Escape")  # cancelled: nothing changes, and the chair is still selected
    assert names(editor.state()) == ["Chair cushion", "Chair frame"]
    before = editor.picture()
    editor.click("material.pick")
    editor.click(FLOOR)
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the material")
    assert {part["material"] for part in state["selection"]} == {floor}
    assert names(state) == ["Chair cushion", "Chair frame"], "a pick does not select"
    editor.settled()
    assert difference(before, editor.picture()).max() > 0.15


def test_a_plugins_sky_is_chosen_and_its_sun_dragged(editor):
    before, first = editor.state()["sky"], editor.picture()
    tab(editor, "Scene")
    editor.click("sky.kind")
    editor.click("sky.kind.sunsky")
    state = editor.wait(lambda s: s["sky"] == "Sun and sky", "the sky", 60)
    assert state["history"]["position"] == 1 and "sky_values" not in state
    editor.settled(samples=1)
    chosen = editor.picture()
    assert difference(first, chosen).max() > 0.1
    x, y = editor.point("sky.elevation")
    editor.drag((x, y), (x + 80, y), steps=20)  # images are generated meanwhile; the newest is used, and all are one undo step
    state = editor.wait(lambda s: s.get("sky_values", {}).get("elevation", 35) > 35, "another sun", 60)
    assert state["history"]["position"] == 2
    editor.click("sky.sun")
    state = editor.wait(lambda s: s.get("sky_values", {}).get("sun") == 0, "no sun", 60)
    assert state["history"]["position"] == 3 and state["sky_values"]["elevation"] > 35, "each in its turn"
    editor.settled(samples=1)
    assert difference(chosen, editor.picture()).max() > 0.1
    for position in (2, 1, 0):
        editor.key("ctrl+z")
        state = editor.wait(lambda s: s["history"]["position"] == position, f"undo to {position}")
    assert state["sky"] == before and len(state["history"]["labels"]) == 3


def test_assets_are_dragged_into_the_picture(editor):
    before = editor.state()["counts"]
    seen = editor.picture()
    tab(editor, "Assets")

    def search(asset):
        editor.click("assets.search")
        editor.key("ctrl+a")
        editor.type(asset)

    def drag(asset, where):
        search(asset)
        editor.drag("asset." + asset, where)

    # While it is held, its target is outlined, and the target's material named next to the mouse.
    search("oak")
    editor.move("asset.oak")
    editor.desk.xdotool("mousedown", 1)
    editor.move(("picture", 0.5, 0.8))
    editor.move(CHAIR)
    editor.wait(lambda s: "drop.onto.Cushion wool" in s["marks"], "the cushion's material to be named")
    editor.wait(lambda _: len(outlined(editor)[0]) > 50, "the cushion's outline")
    rows, columns = outlined(editor)
    height, width = editor.picture().shape[:2]
    assert np.ptp(columns) < 0.25 * width and abs(np.median(columns) / width - CHAIR[1]) < 0.1
    editor.move(FLOOR)
    state = editor.wait(lambda s: "drop.onto.Oak floor" in s["marks"], "the floor's material to be named")
    x0, y0, x1, y1 = (int(v) for v in state["marks"]["drop.onto.Oak floor"])
    assert x0 >= 0 and x1 <= editor.size[0] and x1 - x0 > 100
    editor.wait(lambda _: np.ptp(outlined(editor)[1]) > 0.8 * width, "the floor's outline")
    note = editor.desk.screenshot()[y0:y1, x0:x1]
    assert note.max() > 180 and note.std() > 20, "the words are not on the screen"
    editor.desk.xdotool("mouseup", 1)
    asked = editor.wait(lambda s: s["modal"] or s["history"]["position"] == 1, "the texture, or the question for which")
    if asked["modal"]:
        editor.click("scope.all")
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the texture on the floor", 60)
    assert state["history"]["labels"] == ["Texture oak on Oak floor"], state["history"]["labels"]
    editor.settled()
    assert difference(seen, editor.picture()).max() > 0.1

    drag("lemon", FLOOR)
    state = editor.wait(lambda s: s["history"]["position"] == 2, "the lemon", 60)
    assert state["counts"]["instances"] == before["instances"] + 1
    assert abs(state["selection"][0]["position"][2]) < 0.2, "it does not lie on the floor"

    drag("floor-planks", "outliner.search")  # nothing there accepts images
    drag("sky", ("picture", 0.5, 0.5))  # skies are skies, no matter what is under the mouse
    state = editor.wait(lambda s: s["history"]["position"] == 3, "the sky", 60)
    assert state["history"]["labels"][2].startswith("Sky") and state["sky"] == "sky"
    for _ in range(3):
        editor.key("ctrl+z")
    state = editor.wait(lambda s: s["history"]["position"] == 0, "undo of all three")
    assert state["counts"] == before


def test_missing_images_are_found_again(launch, tmp_path):
    scene = tmp_path / "missing.pbrt"
    scene.write_text(SCENE)
    moved = tmp_path / "moved" / "deeper"
    moved.mkdir(parents=True)
    (tmp_path / "other.png").write_bytes((DEMO.parent / "textures/leaf.png").read_bytes())
    (moved / "wool.png").write_bytes((DEMO.parent / "textures/oak.png").read_bytes())
    editor = launch(scene)
    editor.settled()
    before = editor.picture()
    tab(editor, "Import report")
    editor.click("report.find.planks")
    modal(editor, "Find planks.png")
    type_path(editor, tmp_path / "other.png")
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the first image", 30)
    assert state["history"]["labels"] == ["Find a missing image"]
    editor.wait(lambda s: "report.find.planks" not in s["marks"] and "report.find.wool" in s["marks"], "one to be left")
    editor.click("report.find_all")
    modal(editor, "The folder they are in")
    type_path(editor, tmp_path / "moved")  # into it
    editor.wait(lambda s: "browser.file.deeper" in s["marks"], "what is in the folder")
    editor.click("browser.accept")
    editor.wait(lambda s: s["history"]["position"] == 2 and not s["modal"], "the second image", 30)
    editor.wait(lambda s: "report.find_all" not in s["marks"], "nothing to be missing")
    editor.settled()
    assert difference(before, editor.picture()).max() > 0.1
    editor.key("ctrl+z", "ctrl+z")
    editor.wait(lambda s: "report.find.planks" in s["marks"], "what is missing after undo")


def test_objects_are_dragged_between_groups(editor):
    editor.click("outliner.search")
    editor.type("chair")
    editor.wait(lambda s: "outliner.Chair cushion 2" in s["marks"], "the chairs")
    editor.drag("outliner.Chair cushion 2", "outliner.group.Chair")
    editor.wait(lambda s: s["history"]["size"] == 1 and s["history"]["labels"] == ["Move to Chair"], "the move")
    editor.drag("outliner.Chair frame 3", "outliner.rest")
    state = editor.wait(lambda s: s["history"]["size"] == 2, "the move out of its group")
    assert state["history"]["labels"][1] == "Take out of group"
    editor.key("ctrl+z")
    editor.wait(lambda s: s["history"]["position"] == 1, "undo")
    editor.click("outliner.search")
    editor.key("ctrl+a", "BackSpace", "Escape")
    editor.click(CHAIR)
    state = editor.wait(lambda s: s["selection"], "the chair, whose group has three parts now")
    assert "Chair cushion 2" in names(state) and len(names(state)) == 3
    editor.key("ctrl+z")
    editor.wait(lambda s: s["history"]["position"] == 0, "undo")


def test_a_key_right_after_a_click_goes_where_the_click_went(editor):
    editor.click(CHAIR)
    def rows(state):
        return {mark for mark in state["marks"] if mark.startswith("outliner.group.")}

    before = rows(editor.wait(lambda s: s["selection"], "a selection"))
    x, y = editor.point("outliner.search")
    editor.desk.xdotool("mousemove", x, y, "click", 1, "key", "h")  # faster than any frame
    editor.wait(lambda s: rows(s) != before, "the search for an h")
    assert editor.state()["counts"]["hidden"] == 0, "the key hid the selection"


def test_a_first_start_says_how_to_begin_and_only_once(launch, tmp_path):
    editor = launch(DEMO, hint=True)
    editor.settled(samples=1)
    assert "hint" in editor.state()["marks"]
    editor.click(CHAIR)
    editor.wait(lambda s: s["selection"] and "hint" not in s["marks"], "the hint to go away")
    kept = json.loads((tmp_path / "config/preferences.json").read_text())
    assert kept["hint_seen"] is True
    editor.key("Escape")
    editor.key("ctrl+q")
    assert editor.process.wait(20) == 0
    again = launch(DEMO, hint=True)
    again.settled(samples=1)
    assert "hint" not in again.state()["marks"]


def test_a_part_of_the_library_is_inserted_whole(launch):
    editor = launch(DEMO.parents[1] / "room/room.pbrt")
    editor.settled(samples=1)
    before = editor.state()["counts"]
    tab(editor, "Assets")
    editor.click("assets.search")
    editor.type("armchair")
    editor.move("asset.armchair")
    editor.desk.xdotool("click", "--repeat", 2, "--delay", 60, 1)
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the armchair", 60)
    assert state["counts"]["instances"] == before["instances"] + 2
    assert sorted(names(state)) == ["Armchair", "Armchair legs"], "it is not selected as a whole"
    editor.key("ctrl+z")
    editor.wait(lambda s: s["counts"] == before, "undo")
    editor.drag("asset.armchair", ("picture", 0.5, 0.85))
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the dragged armchair", 60)
    assert sorted(names(state)) == ["Armchair", "Armchair legs"]
