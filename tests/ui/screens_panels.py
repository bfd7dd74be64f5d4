# SPDX-License-Identifier: Apache-2.0
"""States for screens.py: the other panels: arranging, looks, libraries, lists."""
import time

from screens_base import DEMO, ROOT, state

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
