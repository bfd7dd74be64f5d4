# SPDX-License-Identifier: Apache-2.0
"""A material whose files change while a script works with it."""

import json
import threading
from pathlib import Path

import numpy as np
import pytest
import restage

GLSL = (Path(__file__).resolve().parents[1] / "data" / "paint.glsl").read_text()
SCENE = """LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Material "paint" "rgb tint" [0.2 0.5 0.8]
Shape "disk" "float radius" 4
"""


def test_a_material_is_reloaded(tmp_path):
    folder = tmp_path / "paint"
    folder.mkdir()
    glsl = folder / "paint.glsl"

    def write(color):
        glsl.write_text(GLSL.replace("COLOR", color))

    write("m.tint")
    params = [{"id": "tint", "type": "color", "default": [0.5, 0.5, 0.5]}]
    material = {"type": "paint", "glsl": "paint.glsl", "params": params}
    manifest = {"id": "org.example.paint", "provides": ["restage.material/1"], "version": "1", "licence": "MIT", "needs": {"host": ">=0.2"}}
    (folder / "plugin.json").write_text(json.dumps({**manifest, "materials": [material]}))
    first = restage.load_plugins(folder)
    assert [p.id for p in restage.load_plugins(folder)] == [p.id for p in first], "a second call reloads nothing"
    (tmp_path / "scene.pbrt").write_text(SCENE)
    with restage.open(tmp_path / "scene.pbrt") as session:

        def mean():
            return np.asarray(session.render(samples=64, denoise=False).color).mean(axis=(0, 1))

        assert mean() == pytest.approx([0.2, 0.5, 0.8], abs=0.03)
        assert restage.reload_plugins() == {}
        write("m.tint.bgr")
        assert restage.reload_plugins() == {"org.example.paint": ""}
        assert mean() == pytest.approx([0.8, 0.5, 0.2], abs=0.03)
        write("m.hue")
        (error,) = restage.reload_plugins().values()
        assert "paint.glsl:4:" in error and "hue" in error
        assert mean() == pytest.approx([0.8, 0.5, 0.2], abs=0.03)
        # While another thread renders.
        write("vec3(m.tint.g)")
        stop = threading.Event()
        pictures = []

        def render():
            while not stop.is_set():
                pictures.append(mean())

        thread = threading.Thread(target=render)
        thread.start()
        while len(pictures) < 2:
            assert thread.is_alive()
        assert restage.reload_plugins() == {"org.example.paint": ""}
        seen = len(pictures)
        while len(pictures) < seen + 2:
            assert thread.is_alive()
        stop.set()
        thread.join()
        assert pictures[0] == pytest.approx([0.8, 0.5, 0.2], abs=0.03)
        assert pictures[-1] == pytest.approx([0.5, 0.5, 0.5], abs=0.03)
