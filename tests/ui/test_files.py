# SPDX-License-Identifier: Apache-2.0
"""The File menu with real keys: save, open, revert, quit, export, pictures; the file browser; files that are dropped."""
import json
import pathlib
import shutil
import struct

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORNELL = ROOT / "scenes/cornell/cornell.pbrt"


@pytest.fixture
def editor(launch):
    editor = launch(CORNELL)
    editor.wait(lambda s: s["counts"]["instances"] > 0 and not s["opening"], "the scene")
    return editor


def change(editor):
    """One undoable change."""
    hidden = editor.state()["counts"]["hidden"]
    editor.key("ctrl+a", "h") if hidden == 0 else editor.key("alt+h")
    editor.wait(lambda s: s["counts"]["hidden"] != hidden, "a change")


def modal(editor, title):
    return editor.wait(lambda s: s["modal"] == title, f"the dialog '{title}'")


def type_path(editor, path):
    """Into the browser's field, then Enter."""
    editor.point("browser.name")
    editor.key("ctrl+a")
    editor.type(str(path))
    editor.key("Return")


def idle(editor, what):
    return editor.wait(lambda s: not s["jobs"] and not s["opening"], what, 60)


def drop(editor, path, where):
    x, y = editor.point(where)
    commands = pathlib.Path(str(editor.probe) + ".in")
    partial = commands.with_suffix(".partial")
    partial.write_text(f"drop {path} {x} {y}\n")
    partial.rename(commands)


def test_save_undo_across_it_reopen_and_revert(editor, tmp_path):
    change(editor)
    assert editor.state()["modified"]
    editor.key("ctrl+s")
    modal(editor, "Save as")
    project = tmp_path / "room with a view"
    type_path(editor, project)
    project = project.with_suffix(".restage")
    state = editor.wait(lambda s: s["path"] == str(project), "the project to be the document")
    assert not state["modified"]
    saved = json.loads(project.read_text())
    assert saved["base"]["format"] == "pbrt" and (tmp_path / saved["base"]["file"]).resolve() == CORNELL
    assert all(item == {"hidden": True} for item in saved["instances"]["changed"].values())

    editor.key("ctrl+z")
    assert editor.wait(lambda s: s["counts"]["hidden"] == 0, "undo across the save")["modified"]
    editor.key("ctrl+s")  # no question this time
    editor.wait(lambda s: not s["modified"], "the second save")
    assert "instances" not in json.loads(project.read_text())
    change(editor)
    editor.click("menu.file")
    editor.click("file.revert")
    modal(editor, "Revert")
    editor.click("revert.revert")
    editor.wait(lambda s: s["counts"]["hidden"] == 0 and not s["modified"] and s["history"]["size"] == 0, "the file again")


def test_unsaved_work_is_never_discarded_without_asking(editor, tmp_path):
    change(editor)
    editor.key("ctrl+q")
    modal(editor, "Unsaved changes")
    editor.key("Escape")
    modal(editor, "")
    editor.key("ctrl+n")
    modal(editor, "Unsaved changes")
    editor.click("unsaved.cancel")
    assert modal(editor, "")["counts"]["hidden"] > 0
    editor.key("ctrl+n")
    modal(editor, "Unsaved changes")
    editor.click("unsaved.save")
    modal(editor, "Save as")
    type_path(editor, tmp_path / "kept.restage")
    state = editor.wait(lambda s: s["path"] == "" and s["sky"] == "Studio", "the new scene")
    assert not state["modified"] and state["counts"]["instances"] == 1
    assert (tmp_path / "kept.restage").exists()
    editor.key("ctrl+q")
    assert editor.process.wait(20) == 0


def test_the_browser_completes_filters_walks_and_asks_before_it_replaces(editor, tmp_path):
    folder = tmp_path / "models"
    (folder / "inner").mkdir(parents=True)
    (folder / "inner/scene_of_mine.pbrt").write_bytes(CORNELL.read_bytes())
    (folder / "inner/notes.txt").write_text("no scene")
    editor.key("ctrl+o")
    modal(editor, "Open")
    type_path(editor, folder)  # a folder: in
    editor.wait(lambda s: "browser.file.inner" in s["marks"], "the folder's contents")
    editor.type("in")
    editor.key("Tab")  # completed, with its slash: in
    state = editor.wait(lambda s: "browser.file.scene_of_mine.pbrt" in s["marks"], "the inner folder's contents")
    assert "browser.file.notes.txt" not in state["marks"], "no importer reads .txt"
    editor.key("Down", "Return")  # the first file
    editor.wait(lambda s: s["path"].endswith("scene_of_mine.pbrt"), "the chosen file to be open", 60)

    change(editor)
    taken = tmp_path / "taken.restage"
    taken.write_text("do not lose me")
    editor.key("ctrl+shift+s")
    modal(editor, "Save as")
    type_path(editor, taken)
    editor.click("browser.keep")
    assert taken.read_text() == "do not lose me"
    editor.click("browser.accept")
    editor.click("browser.replace")
    editor.wait(lambda s: s["path"] == str(taken), "the replaced file")
    assert json.loads(taken.read_text())["restage"] == 1
    # It is offered again.
    editor.click("menu.file")
    editor.move("file.recent")
    editor.wait(lambda s: "recent.taken.restage" in s["marks"], "the recent files")


def test_export_is_the_same_scene_again(editor, tmp_path):
    count = editor.state()["counts"]["instances"]
    change(editor)
    editor.key("ctrl+e")
    modal(editor, "Export")
    editor.click("export.choose")
    modal(editor, "Export as")
    type_path(editor, tmp_path / "out.pbrt")
    modal(editor, "Exported")
    editor.key("Escape")
    assert editor.state()["modified"], "an export does not count as a save"
    editor.key("ctrl+z")
    drop(editor, tmp_path / "out.pbrt", ("picture", 0.5, 0.5))
    state = editor.wait(lambda s: s["path"].endswith("out.pbrt"), "the exported file to be open", 60)
    assert state["counts"]["instances"] == count and state["counts"]["hidden"] in (0, count)


def png_size(path):
    head = path.read_bytes()[:24]
    assert head.startswith(b"\x89PNG")
    return struct.unpack(">II", head[16:24])


def test_the_live_picture_and_a_final_one(editor, tmp_path):
    editor.settled()
    editor.key("ctrl+shift+e")
    modal(editor, "Save picture")
    editor.click("image.choose")
    modal(editor, "Save picture as")
    type_path(editor, tmp_path / "seen.png")
    editor.wait(lambda s: (tmp_path / "seen.png").exists(), "the image")
    x0, y0, x1, y1 = editor.state()["marks"]["picture"]
    assert abs(png_size(tmp_path / "seen.png")[0] - (x1 - x0)) <= 1

    editor.key("ctrl+r")
    modal(editor, "Final picture")
    editor.click("final.choose")
    modal(editor, "Final picture as")
    type_path(editor, tmp_path / "final.png")
    editor.wait(lambda s: "job.enough" in s["marks"], "the job")
    change(editor)  # editing continues
    editor.wait(lambda s: not s["jobs"] or s["job"] > 0.03, "some samples", 60)
    if editor.state()["jobs"]:
        editor.click("job.enough")
    idle(editor, "the final picture")
    assert png_size(tmp_path / "final.png") == (400, 400)


def test_a_denoise_that_is_cancelled_leaves_the_picture_as_rendered(launch, binary, tmp_path):
    plugin = tmp_path / "plugins/waits"
    plugin.mkdir(parents=True)
    shutil.copy(binary.resolve().parents[1] / "tests/plugins_bad/denoiser_waits.so", plugin / "waits.so")
    (plugin / "plugin.json").write_text(json.dumps({
        "id": "org.example.denoiser.waits", "provides": ["restage.denoiser/1"], "version": "1.0.0", "licence": "MIT",
        "needs": {"host": ">=0.2"}, "library": "waits"}))
    config = tmp_path / "config"
    config.mkdir()
    (config / "preferences.json").write_text('{"hint_seen": true, "denoiser": "waits"}')
    editor = launch(CORNELL, config=config, environment={"RESTAGE_PLUGIN_PATH": str(tmp_path / "plugins")})
    editor.wait(lambda s: s["counts"]["instances"] > 0 and not s["opening"], "the scene")
    for name in ("first.png", "second.png"):  # the denoiser is free again
        editor.key("ctrl+r")
        modal(editor, "Final picture")
        editor.click("final.choose")
        modal(editor, "Final picture as")
        type_path(editor, tmp_path / name)
        editor.wait(lambda s: "job.enough" in s["marks"] and s["job"] > 0, "the job to render", 60)
        editor.click("job.enough")
        editor.wait(lambda s: s["jobs"] and s["job"] >= 0.97, "it to be denoised", 60)
        editor.click("job.cancel")
        state = editor.wait(lambda s: not s["jobs"], "it to be stopped", 60)
        assert any("denoising was cancelled: written without it" in line for line in state["log"]), state["log"]
        assert png_size(tmp_path / name) == (400, 400)


def test_a_failed_write_is_a_question_not_a_fading_notice(editor, tmp_path):
    change(editor)
    editor.key("ctrl+s")
    modal(editor, "Save as")
    type_path(editor, "/proc/nothing.restage")
    modal(editor, "Not saved")
    editor.click("failure.elsewhere")
    modal(editor, "Save as")
    type_path(editor, tmp_path / "saved.restage")
    editor.wait(lambda s: s["path"] == str(tmp_path / "saved.restage") and not s["modified"], "it to be saved elsewhere")

    # A final picture whose folder vanished meanwhile is kept, and written elsewhere.
    editor.settled()
    gone = tmp_path / "gone"
    gone.mkdir()
    editor.key("ctrl+r")
    modal(editor, "Final picture")
    editor.click("final.choose")
    modal(editor, "Final picture as")
    type_path(editor, gone / "final.png")
    editor.wait(lambda s: "job.enough" in s["marks"] and s["job"] > 0, "the job to render", 60)
    gone.rmdir()
    editor.click("job.enough")
    editor.wait(lambda s: s["modal"] == "The final picture was not written", "the question", 60)
    gone.mkdir()
    editor.click("failure.again")
    editor.wait(lambda s: not s["modal"] and (gone / "final.png").exists(), "the picture")
    assert png_size(gone / "final.png") == (400, 400)


def test_dropped_files_go_where_they_belong(editor, tmp_path):
    editor.settled()
    before = editor.state()["counts"]
    pixel = tmp_path / "red.pfm"
    pixel.write_bytes(b"PF\n2 1\n-1.0\n" + np.tile(np.float32([0.8, 0.1, 0.1]), 2).tobytes())
    drop(editor, pixel, ("picture", 0.5, 0.5))  # float pictures are skies
    editor.wait(lambda s: s["sky"] == "red" and s["history"]["position"] == 1, "the new sky")
    texture = tmp_path / "stripes.tga"
    texture.write_bytes(struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 2, 2, 24, 0) + bytes([255, 0, 0] * 4))
    drop(editor, texture, ("picture", 0.5, 0.85))  # the floor
    asked = editor.wait(lambda s: s["modal"] or s["history"]["position"] == 2, "the texture, or the question for which")
    if asked["modal"]:  # other objects have its material as well
        assert asked["modal"] == "Shared material"
        editor.click("scope.all")
    state = editor.wait(lambda s: s["history"]["position"] == 2, "the texture")
    assert state["counts"]["textures"] == before["textures"] + 1 and "Texture stripes" in state["history"]["labels"][1]
    cube = tmp_path / "cube.obj"
    cube.write_text("v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    drop(editor, cube, ("picture", 0.5, 0.85))
    state = editor.wait(lambda s: s["counts"]["instances"] == before["instances"] + 1, "the new object")
    assert state["selection"] and state["history"]["position"] == 3
    for _ in range(3):
        editor.key("ctrl+z")
    state = editor.wait(lambda s: s["history"]["position"] == 0, "undo of all three")
    assert state["counts"] == before
