# SPDX-License-Identifier: Apache-2.0
"""States for screens.py: the Scene panel, lights, and ways to see a picture."""
import time

from screens_base import DEMO, state


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
def light_mixer(s):
    s.start(DEMO)
    s.editor.click("menu.panels")
    s.editor.click("panels.Light mixer")  # in front of its neighbours then
    s.editor.wait(lambda t: "mixer.mixed" in t["marks"], "the mix", 240)
    s.editor.click("mixer.spot")
    s.editor.click("picture")
    s.rest()


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
def pixel_values(s):
    s.stop()
    s.start(DEMO)
    s.editor.key("i")
    s.editor.move(("picture", 0.4, 0.6))
    time.sleep(0.5)
