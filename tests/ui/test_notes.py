# SPDX-License-Identifier: Apache-2.0
"""The editor's notes if something is missing: light, folders to write to. And a camera without perspective."""
import numpy as np

BALL = """LookAt 0 0 5  0 0 0  0 1 0
Camera %s
Film "rgb" "integer xresolution" 640 "integer yresolution" 360
WorldBegin
%s
Material "diffuse" "rgb reflectance" [0.8 0.3 0.2]
Translate 1 0 0
Shape "sphere" "float radius" 0.5
"""
LIGHT = 'LightSource "infinite" "rgb L" [0.7 0.7 0.7]'
PERSPECTIVE = '"perspective" "float fov" 30'


def scene(tmp_path, camera=PERSPECTIVE, light=LIGHT):
    file = tmp_path / "ball.pbrt"
    file.write_text(BALL % (camera, light))
    return file


def test_a_scene_without_light_offers_the_studio(launch, tmp_path):
    editor = launch(scene(tmp_path, light=""))
    editor.wait(lambda s: s["view"]["denoised_samples"] >= 1, "the black picture", 90)
    editor.move((2, 2))
    editor.click("viewport.studio")
    state = editor.wait(lambda s: s["history"]["position"] == 1, "the studio as one step")
    assert state["sky"]
    state = editor.settled(samples=1)
    assert "viewport.studio" not in state["marks"], "the note stays although there is light"
    assert editor.picture().mean() > 0.1
    editor.key("ctrl+z")
    editor.wait(lambda s: s["history"]["position"] == 0 and "viewport.studio" in s["marks"], "the offer again", 60)


def test_unwritable_folders_are_reported_once(launch, tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("no folder")
    nowhere = str(blocked / "below")
    names = ("HOME", "TMPDIR", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_STATE_HOME")
    editor = launch(scene(tmp_path), environment=dict.fromkeys(names, nowhere), config=blocked / "config", hint=True)
    state = editor.settled(samples=1)
    for words in "recompiled", "will not be kept":
        assert len([line for line in state["log"] if words in line]) == 1, words


def test_things_are_picked_through_an_orthographic_camera(launch, tmp_path):
    """Handles are where objects are visible: a unit of the scene is one of the film, at any distance."""
    window = '"orthographic" "float screenwindow" [-3.5556 3.5556 -2 2]'
    editor = launch(scene(tmp_path, camera=window))
    editor.settled(samples=1)
    editor.key("v")  # no axes in the corner
    editor.move((2, 2))
    picture = editor.picture()
    ball = np.argwhere(picture[..., 0] - picture[..., 2] > 0.1)
    y, x = ball.mean(axis=0)
    height, width = picture.shape[:2]
    assert abs(abs(x / width - 0.5) - 1 / 7.1111) < 0.02 and abs(y / height - 0.5) < 0.02
    area = len(ball) / (width * height)
    assert abs(area - np.pi * 0.25 / (7.1111 * 4)) < 0.006, area
    editor.click(("picture", 1 - x / width, y / height))
    assert not editor.state()["selection"], "nothing is there"
    edge = 0.42 / 7.1111 * (1 if x > width / 2 else -1)  # near its outer edge
    editor.click(("picture", x / width + edge, y / height))
    state = editor.wait(lambda s: s["selection"], "the ball")
    assert [thing["name"] for thing in state["selection"]] == ["sphere"]


def test_the_wheel_zooms_through_an_orthographic_camera(launch, tmp_path):
    """Moving closer does not enlarge: the film shrinks around the point under the mouse, and undoing the view restores it."""
    editor = launch(scene(tmp_path, camera='"orthographic" "float screenwindow" [-3.5556 3.5556 -2 2]'))
    editor.settled(samples=1)

    def area():
        picture = editor.picture()
        return np.mean(picture[..., 0] - picture[..., 2] > 0.1)

    editor.move((2, 2))
    before = area()
    for _ in range(3):
        editor.click(("picture", 0.5, 0.5), button=4)
    editor.move((2, 2))
    ratio = 0.88 ** -6
    editor.wait(lambda s: s["view"]["current"] and abs(area() / before / ratio - 1) < 0.1, "a larger ball", 60)
    assert editor.state()["history"]["position"] == 0, "navigation does not change the document"
