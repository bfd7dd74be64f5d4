# SPDX-License-Identifier: Apache-2.0
"""Looks with real keys: recorded, gone to, compared, and a final picture of each."""
import json
import pathlib

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]


def small_project(folder):
    """The Cornell box in 32 x 32 pixels, with a bright and a dark look."""
    path = folder / "two.restage"
    path.write_text(json.dumps({
        "restage": 1, "base": {"file": str(ROOT / "scenes/cornell/cornell.pbrt"), "format": "pbrt"},
        "film": {"width": 32, "height": 32}, "settings": {"samples": 4},
        "looks": [{"name": "bright"}, {"name": "dark", "film": {"exposure": 0.1}}]}))
    return path


def opened(launch, path):
    editor = launch(path)
    editor.wait(lambda s: s["counts"]["instances"] > 0 and not s["opening"], "the scene")
    return editor


def test_keys_go_from_look_to_look(launch, tmp_path):
    editor = opened(launch, small_project(tmp_path))
    editor.key("Next")
    editor.wait(lambda s: s["history"]["undo"] == "Go to look bright", "the first look")
    editor.key("Next")
    editor.wait(lambda s: s["history"]["undo"] == "Go to look dark", "the second one")
    editor.key("ctrl+shift+l")
    editor.wait(lambda s: s["history"]["undo"] == "New look Look 1", "a new look")
    editor.key("Prior")
    editor.wait(lambda s: s["history"]["undo"] == "Go to look dark" and s["history"]["position"] == 4, "back")
    editor.key("ctrl+z", "ctrl+z", "ctrl+z")
    editor.wait(lambda s: s["history"]["undo"] == "Go to look bright", "undone")


def test_every_look_has_its_final_picture(launch, tmp_path):
    editor = opened(launch, small_project(tmp_path))
    editor.key("ctrl+r")
    editor.wait(lambda s: s["modal"] == "Final picture", "the dialog")
    editor.click("final.looks")
    editor.click("final.choose")
    editor.wait(lambda s: s["modal"] == "Final picture as", "the browser")
    editor.point("browser.name")
    editor.key("ctrl+a")
    editor.type(str(tmp_path / "box.pfm"))
    editor.key("Return")
    editor.wait(lambda s: (tmp_path / "box - dark.pfm").exists() and not s["jobs"], "the pictures", 120)
    bright, dark = (np.frombuffer((tmp_path / f"box - {name}.pfm").read_bytes()[-32 * 32 * 12:], np.float32).mean()
                    for name in ("bright", "dark"))
    assert abs(dark / bright - 0.1) < 0.01
    assert not (tmp_path / "box.pfm").exists()
