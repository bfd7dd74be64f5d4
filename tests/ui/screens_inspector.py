# SPDX-License-Identifier: Apache-2.0
"""States for screens.py: the inspector: objects, materials and textures of the selection."""
import time

from screens_base import DEMO, ROOT, state


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
def saving_a_preset(s):
    s.start(DEMO)
    s.select("Chair frame")
    s.editor.click("material.save_preset")
    time.sleep(0.5)
