# SPDX-License-Identifier: Apache-2.0
"""Actions of plugins, with a real mouse: scatter from the menu, and one undo; one that crashes."""
import json
import os
import pathlib
import shutil
import signal

SCENE = """LookAt 0 -9 4  0 0 0  0 0 1
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 320 "integer yresolution" 180
WorldBegin
LightSource "infinite" "rgb L" [0.7 0.7 0.7]
Material "diffuse"
Shape "trianglemesh" "integer indices" [0 1 2] "point3 P" [0 0 0  0.1 0 0.6  -0.1 0 0.6]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point3 P" [-3 -3 0  3 -3 0  3 3 0  -3 3 0]
"""


def test_scatter_from_the_menu_is_one_step(launch, tmp_path):
    file = tmp_path / "meadow.pbrt"
    file.write_text(SCENE)
    editor = launch(file)
    editor.settled(samples=1)
    editor.click("tab.Outliner")
    editor.key("ctrl+a")
    editor.wait(lambda s: len(s["selection"]) == 2, "both objects")
    editor.click("menu.tools")
    editor.click("tools.scatter")
    editor.click("action.run")
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the copies", 60)
    assert state["history"]["labels"] == ["Scatter"] and len(state["selection"]) == 100
    editor.key("ctrl+z")
    editor.wait(lambda s: s["history"]["position"] == 0, "undo")


def test_an_action_that_crashes_costs_no_work_and_is_off_afterwards(launch, binary, tmp_path):
    file, plugin = tmp_path / "meadow.pbrt", tmp_path / "stack"
    file.write_text(SCENE)
    plugin.mkdir()
    shutil.copy(binary.resolve().parent.parent / "tests/plugins_broken/action_crashes.so", plugin / "stack.so")
    (plugin / "plugin.json").write_text(json.dumps({
        "id": "org.example.broken", "provides": ["restage.action/1", "restage.panel/1"], "version": "1.0.0",
        "needs": {"host": ">=0.2"}, "licence": "MIT", "library": "stack"}))
    data = {"XDG_DATA_HOME": str(tmp_path / "data")}  # of the quarantine
    editor = launch("--plugin-path", plugin, "--autosave", 0.3, file, environment=data)
    editor.settled(samples=1)
    editor.click("tab.Outliner")
    editor.key("ctrl+a", "ctrl+g")  # it crashes on objects in groups
    editor.wait(lambda s: s["history"]["position"] == 1, "the group")
    aside = pathlib.Path(editor.wait(lambda s: s["recovery"] and os.path.exists(s["recovery"]), "the recovery copy")["recovery"])
    kept = aside.read_text()
    editor.click("menu.tools")
    editor.click("tools.stack")
    editor.click("action.run")
    assert editor.process.wait(180) == -signal.SIGSEGV
    assert aside.read_text() == kept  # with the group, without changes by the action
    again = launch("--plugin-path", plugin, environment=data)
    again.wait(lambda s: s["modal"] == "Unsaved work was found", "the offer to recover")
    again.click("recovery.recover")
    state = again.wait(lambda s: s["counts"]["instances"] == 2 and s["modal"] == "", "the recovered scene", 60)
    assert state["history"]["labels"] == ["Recovered changes"]
    assert any('it crashed (SIGSEGV) while it ran "Stack"; it stays off' in line for line in state["log"]), state["log"]
    again.click("menu.tools")
    state = again.wait(lambda s: "tools.scatter" in s["marks"], "the menu")
    assert "tools.stack" not in state["marks"]
