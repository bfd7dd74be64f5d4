#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A screenshot of every panel and dialog of the editor, in the states that matter, for visual inspection:

    RESTAGE_BIN=build/bin/restage build/venv/bin/python tests/ui/screens.py OUT [--size 1600x1000] [--scale 2] [--theme light] [STATE ...]

Without states all of them; `--list` names them. Widgets are found by their marks (desk.py), so it is a test of those, too:
it exits with 1 if a state could not be reached."""
import argparse
import json
import os
import pathlib
import shutil
import sys
import tempfile
import time
import traceback

from PIL import Image

from desk import Desk, Editor

ROOT = pathlib.Path(__file__).resolve().parents[2]
DEMO = ROOT / "scenes/demo/demo.pbrt"
# Unsupported content, and a missing file.
TROUBLED = """LookAt 0 1 4  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 640 "integer yresolution" 360
WorldBegin
LightSource "infinite" "rgb L" [0.8 0.8 0.8]
Texture "planks" "spectrum" "imagemap" "string filename" "textures/planks of the old floor.png"
Texture "wool" "spectrum" "imagemap" "string filename" "textures/wool.png"
Material "diffuse" "texture reflectance" "planks"
Shape "disk" "float radius" 3
Material "subsurface" "float scale" 10
AttributeBegin
  Translate 0 0.5 0
  Material "hair" "float beta_m" 0.3
  Shape "sphere" "float radius" 0.5
AttributeEnd
"""
states = {}


def state(function):
    states[function.__name__] = function
    return function


class Screens:
    def __init__(self, desk, binary, out, size, scale, theme, jpeg, folder):
        self.theme = theme
        self.desk, self.binary, self.out, self.size, self.scale = desk, binary, out, size, scale
        self.folder = pathlib.Path(folder)
        self.jpeg = jpeg
        self.editor, self.opened = None, None
        self.failed = []

    # --- reaching states ---
    def start(self, *arguments, config="config", fresh=False, settle=True, hint=False, recover=False):
        """An editor with these arguments; reuses the running one if it has them."""
        key = (config, *map(str, arguments))
        if not fresh and self.opened == key and self.editor.process.poll() is None:
            return self.editor
        self.stop()
        place = self.folder / config
        if not recover:  # recovery files of editors killed here
            shutil.rmtree(place / "recovery", ignore_errors=True)
        if not (place / "preferences.json").exists():
            place.mkdir(parents=True, exist_ok=True)
            (place / "preferences.json").write_text(json.dumps({"hint_seen": not hint, "theme": self.theme}))
        self.editor = Editor(self.desk, self.binary, "--scale", self.scale, *arguments, config=place,
                             probe=self.folder / "probe.json", size=self.size, hint=hint)
        self.opened = key
        if settle:
            self.editor.settled(samples=1, seconds=240)
        return self.editor

    def stop(self):
        if self.editor:
            self.editor.close()
            self.editor = None
        self.opened = None

    def tab(self, name):
        self.editor.click("tab." + name)
        self.rest()

    def rest(self):
        """Moves the mouse to an empty place."""
        self.editor.move((self.size[0] - 3, 3))
        time.sleep(0.3)

    def show(self, mark, clicks=30):
        """Scrolls the panel at the right until the widget is well inside the window."""
        tab = self.editor.point("tab.Scene")
        self.desk.xdotool("mousemove", tab[0], self.size[1] * 0.45)
        for _ in range(clicks):
            found = self.editor.state()["marks"].get(mark)
            if found and found[3] < self.size[1] * 0.6:
                break
            self.desk.xdotool("click", 5)
            time.sleep(0.12)

    def wheel(self, over, mark, lowest):
        """Scrolls the menu or dialog at the widget `over` until `mark` is above `lowest`, a fraction of the window's height."""
        self.editor.move(over)
        for _ in range(30):
            found = self.editor.wait(lambda t: mark in t["marks"], mark)["marks"][mark]
            if found[3] < self.size[1] * lowest:
                return
            self.desk.xdotool("click", 5)
            time.sleep(0.12)

    def top(self):
        tab = self.editor.point("tab.Scene")
        self.desk.xdotool("mousemove", tab[0], self.size[1] * 0.45, "click", "--repeat", 60, "--delay", 5, 4)
        time.sleep(0.3)

    def select(self, *names):
        for i, name in enumerate(names):
            self.editor.key("Escape") if i == 0 else None
            self.editor.click("outliner.search")
            self.editor.key("ctrl+a")
            self.editor.type(name + "\n")
            self.editor.click("outliner." + name, keys=["ctrl"] if i else [])
        self.editor.click("outliner.search")
        self.editor.key("ctrl+a", "BackSpace", "Return")
        self.rest()

    def dialog(self, keys, title):
        self.editor.key(keys)
        self.editor.wait(lambda s: s["modal"] == title, title)
        self.rest()

    def calm(self):
        """Closes and releases everything that the previous state left open or pressed."""
        if not self.editor or self.editor.process.poll() is not None:
            return
        self.rest()
        self.desk.xdotool("mouseup", 1, "keyup", "shift")
        for _ in range(3):
            self.editor.key("Escape")
            if not self.editor.state()["modal"]:
                break

    # --- taking them ---
    def shoot(self, name):
        image = Image.fromarray(self.desk.screenshot()[: self.size[1], : self.size[0]])
        if self.jpeg:
            image.save(self.out / f"{name.replace('_', '-')}.jpg", quality=85, optimize=True)
        else:
            image.save(self.out / f"{name}.png")

    def run(self, names):
        for name in names:
            begin = time.monotonic()
            try:
                self.calm()
                states[name](self)
                time.sleep(0.7)  # popups opened by a click appear in the next frames
                self.shoot(name)
                print(f"{name}: {time.monotonic() - begin:.1f} s", flush=True)
            except Exception:  # continue with the others
                traceback.print_exc()
                self.failed.append(name)
                self.shoot(name + ".failed")
                self.stop()
        self.stop()


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
def nothing_selected(s):
    s.start(DEMO)
    s.tab("Inspector")


@state
def object_place_and_material(s):
    s.start(DEMO)
    s.tab("Inspector")
    s.select("Chair frame")
    s.top()


@state
def texture_choice(s):
    object_place_and_material(s)
    s.select("Floor")
    s.show("material.reflectance.texture")
    s.editor.click("material.reflectance.texture")


@state
def texture_types(s):
    texture_choice(s)
    s.editor.click("material.reflectance.texture.new")


@state
def texture_parameters(s):
    texture_types(s)
    s.editor.click("material.reflectance.texture.new.mix")
    s.show("material.reflectance.of")
    s.editor.click("material.reflectance.of")
    s.show("material.reflectance.of.tex2.texture")
    s.editor.click("material.reflectance.of.tex2.texture")
    s.editor.click("material.reflectance.of.tex2.texture.new")
    s.editor.click("material.reflectance.of.tex2.texture.new.marble")
    s.show("material.reflectance.of.tex2.of")
    s.editor.click("material.reflectance.of.tex2.of")
    s.show("material.reflectance.of.tex2.of.scale")
    s.rest()


@state
def material_type_choice(s):
    s.start(DEMO)
    object_place_and_material(s)
    s.show("material.type")
    s.editor.click("material.type")


@state
def material_choice(s):
    object_place_and_material(s)
    s.show("material.choose")
    s.editor.click("material.choose")


@state
def object_light_and_flags(s):
    s.start(DEMO)
    object_place_and_material(s)
    s.show("inspector.light")
    s.editor.click("inspector.light")
    s.editor.click("light.emits")
    s.show("inspector.object")
    s.editor.click("inspector.object")
    s.show("inspector.flip")
    s.rest()


@state
def several_selected(s):
    s.start(DEMO)
    s.tab("Inspector")
    s.select("Chair frame", "Chair cushion")
    s.top()


@state
def light_selected(s):
    s.start(DEMO)
    s.tab("Scene")
    s.top()
    s.show("scene.lights")
    s.editor.click("scene.lights")
    s.show("lights.add_spot")
    s.editor.click("lights.add_spot")
    s.tab("Inspector")
    s.top()


@state
def scene_sky_and_camera(s):
    s.start(DEMO)
    s.tab("Scene")
    s.top()


@state
def scene_depth_of_field(s):
    scene_sky_and_camera(s)
    s.show("camera.dof")
    s.editor.click("camera.dof")
    s.rest()


@state
def scene_picture(s):
    s.start(DEMO)
    s.tab("Scene")
    s.show("scene.film")
    s.editor.click("scene.film")
    s.show("film.sigma")
    s.rest()


@state
def scene_development(s):
    s.start(DEMO)
    s.tab("Scene")
    s.top()
    s.show("scene.development")
    s.editor.click("scene.development")
    s.show("development.reset")
    s.editor.click("development.tone")


@state
def exposure_in_false_colours(s):
    s.start(DEMO, config="exposure")
    s.rest()
    s.editor.key("shift+e")


@state
def lights_soloed(s):
    s.start(DEMO, config="lights")
    s.tab("Scene")
    s.top()
    s.show("scene.lights")
    s.editor.click("scene.lights")
    s.show("lights.solo.sky")
    s.editor.click("lights.mute.sky")
    s.rest()


@state
def transparent_backdrop(s):
    s.start(DEMO, config="backdrop")
    s.tab("Scene")
    s.top()
    s.editor.click("sky.hidden")
    s.show("sky.backdrop")
    s.editor.click("sky.backdrop")
    s.editor.click("sky.backdrop.transparent")
    s.rest()


@state
def scene_rendering(s):
    s.start(DEMO)
    s.tab("Scene")
    s.show("scene.render")
    s.editor.click("scene.render")
    s.show("render.threads")
    s.rest()


@state
def arrange(s):
    s.start(DEMO)
    s.select("Chair frame", "Vase")
    s.editor.key("ctrl+shift+a")
    s.editor.wait(lambda t: "arrange.replace" in t["marks"], "the panel")
    s.rest()


@state
def arrange_array(s):
    s.start(DEMO)
    s.select("Vase")
    s.editor.key("ctrl+shift+d")
    s.editor.wait(lambda t: "array.keep" in t["marks"], "the array")
    s.rest()
    s.editor.settled(samples=8, seconds=240)


@state
def arrange_path(s):
    s.stop()
    s.start(DEMO)
    s.select("Vase")
    s.editor.key("ctrl+shift+a")
    s.editor.click("array.kind")
    s.editor.click("array.kind.3")
    s.editor.click("array.draw")
    for point in (("picture", 0.25, 0.8), ("picture", 0.5, 0.93), ("picture", 0.8, 0.85)):
        s.editor.move(point)
        s.editor.click(point)
    s.editor.settled(samples=2, seconds=240)
    s.editor.move(("picture", 0.85, 0.75))
    time.sleep(0.5)


@state
def placing_a_texture(s):
    s.stop()
    s.start(DEMO)
    s.select("Floor")
    s.editor.key("p")
    s.editor.wait(lambda t: "placing.middle" in t["marks"], "the frame")
    s.rest()


@state
def turning_a_texture(s):
    placing_a_texture(s)
    ring = s.editor.point("placing.ring")
    s.editor.move("placing.ring")
    s.desk.xdotool("keydown", "shift", "mousedown", 1)
    for i in range(1, 6):
        s.desk.xdotool("mousemove", ring[0] - 25 * i, ring[1] + 6 * i)
        time.sleep(0.1)
    s.editor.settled(samples=2, seconds=240)


@state
def projecting_a_texture(s):
    s.stop()
    s.start(ROOT / "scenes/cornell/cornell.pbrt")
    s.select("Floor")
    s.editor.key("ctrl+p")
    s.editor.type("project texture")
    time.sleep(1)  # until it is found
    s.editor.key("Return")
    s.editor.wait(lambda t: t["modal"] == "Project texture", "the dialog")
    s.rest()


@state
def snapping(s):
    s.stop()
    s.start(DEMO)
    s.select("Vase")
    s.editor.click("toolbar.snap")
    for target in ("grid", "surface", "wall"):
        s.editor.click("snap." + target)
    s.editor.key("Escape")
    s.select("Vase")
    start = s.editor.point("gizmo.center")
    s.editor.move("gizmo.center")
    s.desk.xdotool("mousedown", 1)
    for i in range(1, 9):
        s.desk.xdotool("mousemove", start[0] + 14 * i, start[1] + 5 * i)
        time.sleep(0.1)
    time.sleep(0.5)


@state
def colliding(s):
    s.stop()
    s.start(DEMO)
    s.select("Chair frame")
    s.editor.click("view.collide")
    start = s.editor.point("gizmo.center")
    s.editor.move("gizmo.center")
    s.desk.xdotool("mousedown", 1)
    for i in range(1, 9):
        s.desk.xdotool("mousemove", start[0] - 20 * i, start[1] - 8 * i)
        time.sleep(0.1)
    time.sleep(0.5)


@state
def history(s):
    s.start(DEMO)
    s.tab("History")


@state
def looks(s):
    s.stop()
    s.start(DEMO)
    s.tab("Looks")
    for name in ("Chair frame", "Floor"):
        s.editor.click("look.new")
        s.select(name)
        s.editor.key("h")
    s.editor.click("look.new")
    time.sleep(12)
    s.rest()


@state
def light_mixer(s):
    s.start(DEMO)
    s.editor.click("menu.panels")
    s.editor.click("panels.Light mixer")  # in front of its neighbours then
    s.editor.wait(lambda t: "mixer.mixed" in t["marks"], "the mix", 240)
    s.editor.click("mixer.spot")
    s.editor.click("picture")
    s.rest()


@state
def looks_compared(s):
    looks(s)
    s.editor.click("look.Look 1")
    s.editor.settled(samples=4, seconds=240)
    s.editor.click("look.keep")
    s.editor.click("look.Look 3")
    s.editor.settled(samples=4, seconds=240)
    s.editor.click("kept.wipe")
    s.rest()


@state
def assets(s):
    s.start(DEMO)
    s.tab("Assets")
    time.sleep(2)


def balls(s, shown=6, seconds=300):
    """Until the visible presets have their pictures."""
    s.editor.wait(lambda t: sum(m.startswith("materials.ball.") for m in t["marks"]) >= shown, "balls", seconds)


@state
def materials(s):
    s.start(DEMO)
    s.tab("Materials")
    balls(s)


@state
def materials_searched(s):
    s.start(DEMO)
    s.tab("Materials")
    s.editor.click("materials.search")
    s.editor.type("glass")
    balls(s, 4)
    s.editor.move("materials.Crown glass")
    time.sleep(1)


@state
def material_tried(s):
    s.start(DEMO)
    s.select("Chair frame")
    s.tab("Materials")
    s.editor.click("materials.search")
    s.editor.type("gold")
    balls(s, 2)
    s.editor.move("materials.Gold")
    time.sleep(4)


@state
def dragging_a_material(s):
    s.start(DEMO)
    s.tab("Materials")
    s.editor.click("materials.search")
    s.editor.type("gold")
    balls(s, 2)
    s.editor.move("materials.Gold")
    s.desk.xdotool("mousedown", 1)
    for i in range(1, 6):
        x, y = s.editor.point(("picture", 0.5, 0.95 - 0.08 * i))
        s.desk.xdotool("mousemove", x, y)
        time.sleep(0.1)


@state
def saving_a_preset(s):
    s.start(DEMO)
    s.select("Chair frame")
    s.editor.click("material.save_preset")
    time.sleep(0.5)


@state
def dragging_an_asset(s):
    assets(s)
    marks = s.editor.state()["marks"]
    name = next(m for m in sorted(marks) if m.startswith("asset."))
    s.editor.move(name)
    s.desk.xdotool("mousedown", 1)
    for i in range(1, 6):
        x, y = s.editor.point(("picture", 0.5, 0.95 - 0.08 * i))
        s.desk.xdotool("mousemove", x, y)
        time.sleep(0.1)


@state
def palette(s):
    s.start(DEMO)
    s.editor.key("ctrl+p")
    s.editor.wait(lambda t: "palette.query" in t["marks"], "the palette")
    s.editor.type("cha")
    time.sleep(0.5)


def layer(s, key):
    s.stop()
    s.start(DEMO)
    s.editor.key(key)
    s.editor.wait(lambda t: "layer.back" in t["marks"], "the note")
    s.rest()
    time.sleep(1.5)


@state
def wireframe(s):
    layer(s, "alt+3")


@state
def uv_checker(s):
    layer(s, "alt+4")


@state
def error_map(s):
    layer(s, "alt+8")


@state
def grid_and_measure(s):
    s.stop()
    s.start(DEMO)
    s.editor.key("g", "m")
    for point in (("picture", 0.35, 0.75), ("picture", 0.6, 0.85)):
        s.editor.move(point)
        s.editor.click(point)
    time.sleep(0.5)


@state
def render_region(s):
    s.stop()
    s.start(DEMO)
    s.editor.key("ctrl+b")
    s.editor.drag(("picture", 0.3, 0.35), ("picture", 0.7, 0.75))
    time.sleep(2)


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
def statistics(s):
    s.stop()
    s.start(DEMO)
    s.editor.click("menu.panels")
    s.editor.click("panels.Statistics")
    s.tab("Statistics")


@state
def convergence(s):
    s.start(DEMO)
    s.tab("Convergence")
    s.editor.settled(samples=12, seconds=400)


@state
def plugins(s):
    s.start(DEMO)
    s.editor.click("menu.panels")
    s.editor.click("panels.Plugins")
    s.tab("Plugins")


@state
def log(s):
    s.start(DEMO)
    s.tab("Log")


@state
def import_report(s):
    scene = s.folder / "troubled.pbrt"
    scene.write_text(TROUBLED)
    s.start(scene)
    s.tab("Import report")


@state
def help_panel(s):
    s.start(DEMO)
    s.editor.key("question")
    s.rest()


@state
def outliner_menu(s):
    s.start(DEMO)
    s.editor.click("outliner.search")
    s.editor.type("chair\n")
    s.editor.click("outliner.Chair frame", button=3)


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
def materials_of_a_file(s):
    s.start(ROOT / "scenes/cornell/cornell.pbrt", config="borrow")
    s.tab("Materials")
    s.editor.click("materials.borrow")
    s.editor.wait(lambda t: t["modal"] == "Materials of a file", "the browser")
    s.editor.key("ctrl+a")
    s.editor.type(str(DEMO))
    s.editor.key("Return")
    s.editor.wait(lambda t: "materials.Oak" in t["marks"], "the materials", 120)
    balls(s, 4)


@state
def pixel_values(s):
    s.stop()
    s.start(DEMO)
    s.editor.key("i")
    s.editor.move(("picture", 0.4, 0.6))
    time.sleep(0.5)


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
def tools_menu(s):
    s.start(DEMO)
    s.tab("Outliner")
    s.editor.key("ctrl+a")
    s.editor.wait(lambda t: len(t["selection"]) > 1, "a selection")
    s.editor.click("menu.tools")


@state
def plugin_action(s):
    tools_menu(s)
    s.editor.click("tools.scatter")
    s.editor.wait(lambda t: "action.run" in t["marks"], "the dialog")


@state
def plugin_action_advanced(s):
    plugin_action(s)
    s.wheel("action.scatter.count", "action.scatter.advanced", 0.7)
    s.editor.click("action.scatter.advanced")
    s.wheel("action.scatter.offset", "action.scatter.group", 0.7)


@state
def panels_menu(s):
    s.stop()
    s.start(DEMO, config="plugin panel")
    s.editor.click("menu.panels")
    s.editor.wait(lambda t: "panels.scatter" in t["marks"], "the menu")


@state
def plugin_panel(s):
    panels_menu(s)
    s.wheel("panels.Scene", "panels.scatter", 0.95)
    s.editor.click("panels.scatter")
    s.editor.wait(lambda t: "panel.scatter.count" in t["marks"], "the panel")
    s.editor.key("Escape")


@state
def empty(s):
    s.stop()
    s.start(config="nothing", settle=False)
    time.sleep(1)


def main():
    parse = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parse.add_argument("out", type=pathlib.Path, nargs="?")
    parse.add_argument("states", nargs="*")
    parse.add_argument("--size", default="1280x720")
    parse.add_argument("--scale", type=float, default=1)
    parse.add_argument("--theme", choices=["dark", "light"], default="dark")
    parse.add_argument("--jpeg", action="store_true", help="for docs/images/editor: named with dashes")
    parse.add_argument("--list", action="store_true")
    given = parse.parse_intermixed_args()
    if given.list or not given.out:
        print("\n".join(states))
        return 0
    unknown = set(given.states) - set(states)
    assert not unknown, f"no such state: {', '.join(sorted(unknown))}"
    size = tuple(int(v) for v in given.size.split("x"))
    binary = pathlib.Path(os.environ.get("RESTAGE_BIN", ROOT / "build/bin/restage"))
    given.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        desk = Desk(pathlib.Path(folder) / "desk", size)
        screens = Screens(desk, binary, given.out, size, given.scale, given.theme, given.jpeg, folder)
        try:
            screens.run([name for name in states if not given.states or name in given.states])
        finally:
            screens.stop()
            desk.close()
    return 1 if screens.failed else 0


if __name__ == "__main__":
    sys.exit(main())
