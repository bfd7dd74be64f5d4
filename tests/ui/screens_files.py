# SPDX-License-Identifier: Apache-2.0
"""States for screens.py: files, dialogs, final pictures, and the start."""
import pathlib
import shutil
import time

from screens_base import DEMO, state


@state
def opening(s):
    s.stop()
    scene = s.folder / "slow.pbrt"
    ball = "AttributeBegin Translate {} {} 0 Shape \"sphere\" \"float radius\" 0.4 AttributeEnd\n"
    scene.write_text("WorldBegin\n" + "".join(ball.format(i % 500, i // 500) for i in range(200000)))
    s.start(scene, config="slow", fresh=True, settle=False)
    time.sleep(0.7)
    s.editor.wait(lambda t: "opening.cancel" in t["marks"], "the progress", 20)


@state
def first_start(s):
    shutil.rmtree(s.folder / "first", ignore_errors=True)
    s.start(DEMO, config="first", fresh=True, hint=True)


@state
def palette(s):
    s.start(DEMO)
    s.editor.key("ctrl+p")
    s.editor.wait(lambda t: "palette.query" in t["marks"], "the palette")
    s.editor.type("cha")
    time.sleep(0.5)


@state
def tour(s):
    s.stop()
    s.start(DEMO)
    s.editor.click("menu.help")
    s.editor.click("help.tour")
    s.editor.wait(lambda t: "tour.next" in t["marks"], "the first step", 120)
    time.sleep(3)


@state
def pack_project(s):
    s.start(DEMO)
    s.editor.click("menu.file")
    s.editor.click("file.pack")
    time.sleep(1)


@state
def file_menu(s):
    s.start(DEMO)
    s.editor.click("menu.file")


@state
def file_browser(s):
    s.start(DEMO)
    s.dialog("ctrl+o", "Open")


@state
def save_as(s):
    s.start(DEMO)
    s.dialog("ctrl+s", "Save as")


@state
def export(s):
    s.start(DEMO)
    s.dialog("ctrl+e", "Export")


@state
def save_picture(s):
    s.start(DEMO)
    s.dialog("ctrl+shift+e", "Save picture")


@state
def final_picture(s):
    s.start(DEMO)
    s.dialog("ctrl+r", "Final picture")


@state
def final_picture_goes_on(s):
    final_picture(s)
    s.editor.click("final.choose")
    s.editor.wait(lambda t: t["modal"] == "Final picture as", "the browser")
    s.editor.key("ctrl+a")
    s.editor.type(str(s.folder / "final.png"))
    s.editor.key("Return")
    s.editor.wait(lambda t: t["jobs"] and t["job"] > 0.01, "the job", 120)
    s.rest()


@state
def final_pictures_of_a_moving_camera(s):
    final_picture(s)
    s.editor.click("final.move")
    s.editor.click("final.move.turntable")
    s.rest()


@state
def final_pictures_in_a_batch(s):
    s.stop()
    s.start(DEMO, config="batch")
    for key in ("b", "b"):
        s.editor.key(key)
        time.sleep(0.5)
    s.dialog("ctrl+r", "Final picture")
    s.editor.click("final.cameras")
    s.editor.click("final.choose")
    s.editor.wait(lambda t: t["modal"] == "Final picture as", "the browser")
    s.editor.key("ctrl+a")
    s.editor.type(str(s.folder / "batch.png"))
    s.editor.key("Return")
    s.editor.wait(lambda t: "batch.enough" in t["marks"], "the list", 120)
    s.rest()


@state
def unsaved(s):
    s.start(DEMO)
    s.editor.key("ctrl+a", "h")
    s.editor.wait(lambda t: t["modified"], "a change")
    s.dialog("ctrl+q", "Unsaved changes")


@state
def recovery(s):
    s.stop()
    s.start(DEMO, "--autosave", 0.3, config="crash")
    s.editor.key("ctrl+a", "h")
    s.editor.wait(lambda t: t["modified"] and t["recovery"] and pathlib.Path(t["recovery"]).exists(), "work written aside")
    s.stop()
    s.start(config="crash", settle=False, recover=True)
    s.editor.wait(lambda t: t["modal"] == "Unsaved work was found", "the offer")
    s.rest()


@state
def empty(s):
    s.stop()
    s.start(config="nothing", settle=False)
    time.sleep(1)
