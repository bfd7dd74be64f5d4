# SPDX-License-Identifier: Apache-2.0
"""An action of a plugin, with a real mouse: scatter from the menu, and one step back."""

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
