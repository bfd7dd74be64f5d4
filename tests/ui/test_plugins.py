# SPDX-License-Identifier: Apache-2.0
"""Plugins in the editor, with a real mouse: a plugin's own part of the inspector, and a material that is
edited on disk while its picture is on the screen."""

import json
import shutil
import struct
from pathlib import Path

import numpy as np
import pytest

SCENE = """LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 640 "integer yresolution" 360
WorldBegin
LightSource "infinite" "rgb L" [0.7 0.7 0.7]
Material %s
Shape "sphere" "float radius" 1
"""
BALL = ("picture", 0.5, 0.5)

PAINT = (Path(__file__).resolve().parents[1] / "data" / "paint.glsl").read_text()


def scene(tmp_path, material):
    file = tmp_path / "ball.pbrt"
    file.write_text(SCENE % material)
    return file


def ball(editor):
    """The mean colour of the ball, below the handles."""
    picture = editor.picture()
    h, w = picture.shape[:2]
    return picture[int(0.6 * h) : int(0.68 * h), int(0.52 * w) : int(0.57 * w), :3].mean(axis=(0, 1))


def test_a_metal_is_chosen_by_its_name(launch, tmp_path):
    editor = launch(scene(tmp_path, '"conductor" "rgb eta" [0.2 0.92 1.1] "rgb k" [3.9 2.45 2.14] "float roughness" 0.2'))
    editor.settled(samples=1)
    editor.wait(lambda _: np.ptp(ball(editor)) > 0.1, "copper, tinted", 60)  # its own code, not the stand-in's
    editor.settled()
    copper = ball(editor)
    editor.click(BALL)
    editor.wait(lambda s: len(s["selection"]) == 1, "the ball")
    editor.click("tab.Inspector")
    editor.reveal("material.ui.combo.0")
    editor.click("material.ui.combo.0")
    editor.click("material.ui.combo.0.Silver")
    state = editor.wait(lambda s: s["history"]["position"] == 1, "silver")
    assert state["history"]["labels"] == ["Silver"]
    assert state["material"]["k"]["value"][0] == pytest.approx(4.4437)
    editor.wait(lambda _: np.ptp(ball(editor)) < np.ptp(copper) / 4, "silver, which is not", 60)
    assert ball(editor).mean() > copper.mean()
    # By its colour: one parameter replaces the optical constants.
    editor.click("material.ui.combo.0")
    editor.click("material.ui.combo.0.By its colour")
    editor.wait(lambda s: s["material"]["use_reflectance"]["value"][0] == 1, "the colour")
    editor.reveal("material.reflectance")
    editor.key("ctrl+z", "ctrl+z")
    state = editor.wait(lambda s: s["history"]["position"] == 0, "undo")
    editor.settled()
    assert np.abs(ball(editor) - copper).max() < 0.05


def test_a_plugin_is_checked_from_its_panel(launch, tmp_path):
    """It loses light though declared lossless; fixed on disk, it passes."""
    plugin = tmp_path / "paint"
    plugin.mkdir()
    glsl = plugin / "paint.glsl"
    glsl.write_text(PAINT.replace("COLOR", "(0.5 * m.tint)"))
    material = {"type": "paint", "glsl": "paint.glsl", "flags": ["lossless"], "params": [{"id": "tint", "type": "color"}]}
    manifest = {"id": "org.example.paint", "provides": ["restage.material/1"], "version": "1", "licence": "MIT", "needs": {"host": ">=0.2"}}
    (plugin / "plugin.json").write_text(json.dumps({**manifest, "materials": [material]}))
    editor = launch("--plugin-path", plugin, scene(tmp_path, '"diffuse"'))
    editor.settled(samples=1)
    editor.click("menu.panels")
    editor.click("panels.Plugins")
    editor.click("tab.Plugins")
    editor.click("plugins.check.org.example.paint")
    editor.wait(lambda s: any("org.example.paint: FAILED" in line for line in s["log"]), "the verdict", 120)
    glsl.write_text(PAINT.replace("COLOR", "m.tint"))
    editor.wait(lambda s: any("was reloaded" in line for line in s["log"]), "the fixed one")
    editor.click("plugins.check.org.example.paint")
    editor.wait(lambda s: any("org.example.paint: passed" in line for line in s["log"]), "the other verdict", 120)


def test_a_material_is_edited_on_disk_while_it_is_shown(launch, tmp_path):
    plugin = tmp_path / "paint"
    plugin.mkdir()
    params = [{"id": "tint", "label": "Tint", "type": "color", "default": [0.9, 0.2, 0.2]}]
    manifest = {
        "id": "org.example.paint",
        "provides": ["restage.material/1"],
        "version": "1.0.0",
        "licence": "MIT",
        "needs": {"host": ">=0.2"},
        "materials": [{"type": "paint", "glsl": "paint.glsl", "params": params}],
    }
    glsl = plugin / "paint.glsl"
    glsl.write_text(PAINT.replace("COLOR", "m.tint"))
    (plugin / "plugin.json").write_text(json.dumps(manifest))
    editor = launch(
        "--plugin-path", plugin, scene(tmp_path, '"paint" "rgb tint" [0.1 0.8 0.2]')
    )
    editor.settled(samples=2)
    green = ball(editor)
    assert green[1] > 2 * green[0]

    def until(condition, what):
        def seen(_):
            return condition(ball(editor))

        editor.wait(seen, what, 60)

    glsl.write_text(PAINT.replace("COLOR", "m.tint.bgr.grb"))  # the colours are swapped
    until(lambda c: c[0] > 1.5 * c[1], "the edited GLSL")
    red = ball(editor)
    # A compile error has no effect, and is reported with its place.
    glsl.write_text(PAINT.replace("COLOR", "m.tinted"))
    editor.wait(lambda s: "paint.glsl:4:" in editor.output(), "the error", 30)
    editor.settled()
    assert np.abs(ball(editor) - red).max() < 0.05
    # Another table: the value is in the scene, and survives.
    manifest["materials"][0]["params"] = [{"id": "gloss", "label": "Gloss", "type": "float", "default": 0.5}] + params
    (plugin / "plugin.json").write_text(json.dumps(manifest))
    glsl.write_text(PAINT.replace("COLOR", "m.tint"))
    until(lambda c: c[1] > 1.5 * c[0], "the edited table")
    editor.click(BALL)
    editor.click("tab.Inspector")
    editor.reveal("material.gloss")
    assert editor.state()["material"]["tint"]["value"][1] == pytest.approx(0.8)


def test_a_table_is_chosen_and_refused_in_red(launch, tmp_path):
    values = struct.pack("<3i", 4, 3, 2) + struct.pack("<72d", *[0.7 / np.pi / k for k in (1 / 1500, 1.15 / 1500, 1.66 / 1500) for _ in range(24)])
    (tmp_path / "grey.binary").write_bytes(values)
    (tmp_path / "short.binary").write_bytes(values[:-8])
    editor = launch(scene(tmp_path, '"measured"'))
    editor.settled(samples=1)
    editor.wait(lambda _: np.ptp(ball(editor)) > 0.1, "the default, which is red", 60)
    editor.click(BALL)
    editor.wait(lambda s: len(s["selection"]) == 1, "the ball")
    editor.click("tab.Inspector")

    def choose(name):
        editor.reveal("material.filename")
        editor.click("material.filename")
        editor.wait(lambda s: s["modal"] == "Choose a file", "the browser")
        editor.point("browser.name")
        editor.key("ctrl+a")
        editor.type(str(tmp_path / name))
        editor.key("Return")

    choose("grey.binary")
    editor.wait(lambda s: s.get("material", {}).get("filename", {}).get("text") == str(tmp_path / "grey.binary"), "the file")
    editor.wait(lambda _: np.ptp(ball(editor)) < 0.05, "grey", 60)
    grey = ball(editor).mean()
    x, y = editor.point(BALL)  # the other one is dropped on it
    commands = Path(str(editor.probe) + ".in")
    commands.with_suffix(".partial").write_text(f"drop {tmp_path / 'short.binary'} {x} {y}\n")
    commands.with_suffix(".partial").rename(commands)
    state = editor.wait(lambda s: "material.filename.problem" in s["marks"], "what is wrong with it", 60)
    assert state["history"]["position"] == 2
    x0, y0, x1, y1 = (int(v) for v in state["marks"]["material.filename.problem"])

    def is_red(_):  # the screen is a moment behind the state
        note = editor.desk.screenshot()[y0:y1, x0:x1].astype(int)
        return (note[..., 0] - note[..., 2] > 80).sum() > 100

    editor.wait(is_red, "the problem in red")
    editor.settled(samples=1)
    editor.wait(lambda _: ball(editor).mean() < grey - 0.03, "a darker grey: 0.5, not 0.7", 60)
    editor.key("ctrl+z")
    editor.wait(lambda s: "material.filename.problem" not in s["marks"] and s["history"]["position"] == 1, "undo")


def choose_denoiser(editor, name):
    """In the rows of "Rendering", which may be folded; "" = the built-in one."""
    editor.click("tab.Scene")
    state = editor.wait(lambda s: "scene.render" in s["marks"], "the panel")
    if "render.denoiser" not in state["marks"]:
        editor.reveal("scene.render")
        editor.click("scene.render")
    editor.reveal("render.denoiser")
    editor.click("render.denoiser")
    editor.click("render.denoiser." + name)


def test_another_denoiser_is_chosen_and_remembered(launch, binary, tmp_path):
    """Built-in by default; a plugin's by its name, at once and after a restart; a missing one is reported."""
    plugin = tmp_path / "copier"
    plugin.mkdir()
    shutil.copy(binary.resolve().parent.parent / "tests/plugins_broken/denoiser_sound.so", plugin / "copier.so")
    (plugin / "plugin.json").write_text(json.dumps({
        "id": "org.example.broken", "provides": ["restage.denoiser/1"], "version": "1.0.0", "needs": {"host": ">=0.2"}, "licence": "MIT", "library": "copier"}))
    file = scene(tmp_path, '"diffuse"')
    by = lambda name: lambda s: s["view"]["denoiser"] == name
    editor = launch("--plugin-path", plugin, file)
    editor.settled(samples=1)
    editor.wait(by("oidn"), "the built-in denoiser")
    choose_denoiser(editor, "copy")
    editor.wait(by("copy"), "the plugin's")
    assert not editor.state()["modified"], "it is not part of the document"
    editor.kill()
    editor = launch("--plugin-path", plugin, file)
    editor.wait(by("copy"), "the plugin's, after a restart", 90)
    editor.kill()
    editor = launch(file)  # without it: pictures are shown noisy, and the toolbar says why
    editor.wait(lambda s: s["view"]["samples"] >= 4, "a picture", 90)
    assert editor.state()["view"]["denoiser"] == "" and "copy" in editor.state()["view"]["denoiser_missing"]
    choose_denoiser(editor, "")
    editor.wait(by("oidn"), "the built-in one again")
