# SPDX-License-Identifier: Apache-2.0
"""One folder with a plugin of each kind (tests/plugins_outside/bundle), built against an installed Restage like a third-party
project: checked, listed, used by the program, by Python and, with a real mouse, by the editor."""
import json
import os
import shutil
import subprocess
import sys
import textwrap

import numpy as np
import pytest

from conftest import ROOT

TOWERS = "towers 1\n-1.5 0 1\n-0.5 0 2\n0.5 0 0.5\n"
STRIPED = """Camera "orthographic"
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
WorldBegin
LightSource "infinite" "rgb L" [1 1 1]
Texture "s" "spectrum" "stripes" "rgb first" [1 0 0] "rgb second" [1 1 1] "float count" 2
Material "chalk" "texture tint" "s"
Shape "bilinearmesh" "point3 P" [-2 -2 1  2 -2 1  -2 2 1  2 2 1] "point2 uv" [0 0  1 0  0 1  1 1]
"""
KINDS = ["material", "texture", "sky", "action", "panel", "importer", "exporter", "denoiser"]


def run(*command, ok=True, **more):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=300, **more)
    if ok:
        assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done


@pytest.fixture(scope="module")
def bundle(binary, tmp_path_factory):
    """The folder of the built plugin."""
    home = tmp_path_factory.mktemp("bundle")
    binary = binary.resolve()
    run("cmake", "--install", binary.parents[1], "--prefix", home / "prefix")
    shutil.copytree(ROOT / "tests/plugins_outside/bundle", home / "source")
    run("cmake", "-S", home / "source", "-B", home / "build", f"-DCMAKE_PREFIX_PATH={home / 'prefix'}",
        "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", home / "build")
    (plugin,) = (home / "build/lib/restage/plugins").iterdir()
    return plugin


@pytest.fixture
def towers(tmp_path):
    file = tmp_path / "three.towers"
    file.write_text(TOWERS)
    return file


def test_a_bundle_is_checked_and_listed(binary, bundle):
    done = run(binary, "check", bundle, "--quick")
    assert "chalk" in done.stdout and "dusk" in done.stdout and "towers" in done.stdout
    listed = json.loads(run(binary, "--plugin-path", bundle, "plugins", "--json").stdout)
    (entry,) = (e for e in listed if e["id"] == "org.example.bundle")
    assert entry["loaded"]
    assert sorted(p.split()[0] for p in entry["provides"]) == sorted(KINDS)


def test_a_bundle_is_used_by_commands(binary, bundle, towers, tmp_path):
    def restage(*arguments, **more):
        return run(binary, "-q", "--plugin-path", bundle, *arguments, **more)

    restage("convert", towers, tmp_path / "back.towers", "--import-set", "scale=2")
    assert (tmp_path / "back.towers").read_text() == "towers 1\n-3 0 2\n-1 0 4\n1 0 1\n"
    refused = restage("convert", towers, tmp_path / "no.towers", "--import-set", "scale=0", ok=False)
    assert refused.returncode != 0 and "scale" in refused.stderr and not (tmp_path / "no.towers").exists()
    towers.write_text(TOWERS + "1 2\n")
    broken = restage("info", towers, ok=False)
    assert broken.returncode == 1 and "three.towers:5:1: expected: X Z HEIGHT" in broken.stderr
    towers.write_text(TOWERS)
    size = ["--size", "48x32", "--spp", "2", "--set", "sky.type=dusk"]
    restage("render", towers, "-o", tmp_path / "noisy.exr", *size)
    restage("render", towers, "-o", tmp_path / "clean.exr", *size, "--denoise", "fast", "--denoiser", "blur")
    compared = run(binary, "compare", tmp_path / "noisy.exr", tmp_path / "clean.exr", "--max-flip", "0.001", ok=False)
    assert compared.returncode == 1  # the blur is visible
    scene = tmp_path / "striped.pbrt"
    scene.write_text(STRIPED)
    restage("render", scene, "-o", tmp_path / "stripes.pfm", "--size", "16x16", "--spp", "16")
    header, size, _, data = (tmp_path / "stripes.pfm").read_bytes().split(b"\n", 3)
    picture = np.frombuffer(data, "<f4").reshape(16, 16, 3)
    green = picture[..., 1].mean(axis=0)
    assert header == b"PF" and picture[..., 0].mean() > 0.7  # the first stripe is red, the second white
    assert sum(g < 0.05 for g in green) >= 6 and sum(g > 0.7 for g in green) >= 6  # between them the pixel filter


PYTHON = """
    import sys
    import numpy as np
    import restage

    plugin, towers, out = sys.argv[1:]
    restage.load_plugins(plugin)
    assert "chalk" in restage.material_types() and "dusk" in restage.sky_types()
    with restage.open(towers) as s:
        one, two, three = s.objects
        assert np.allclose(two.transform[:3, 3], [-0.5, 0, 0]) and two.transform[1, 1] == 2
        done = s.run_action("lift", [two], height=3)
        assert done.changed and np.allclose(two.transform[:3, 3], [-0.5, 3, 0])
        s.undo()
        assert np.allclose(two.transform[:3, 3], [-0.5, 0, 0])
        s.make_sky("dusk", brightness=0.5, elevation=40)
        assert s.sky.type == "dusk" and s.sky.values["elevation"] == 40
        picture = s.render(samples=1, size=(32, 24))
        assert np.isfinite(picture.color).all() and picture.color.mean() > 0.05
        s.export(out, hidden=True)
"""


def test_a_bundle_is_used_by_python(binary, bundle, towers, tmp_path):
    out = tmp_path / "out.towers"
    packages = binary.resolve().parents[1] / "lib/python"
    run(sys.executable, "-c", textwrap.dedent(PYTHON), bundle, towers, out, env={**os.environ, "PYTHONPATH": str(packages)})
    assert out.read_text().startswith("towers 1\n-1.5 0 1\n")


def test_a_bundle_is_used_in_the_editor(launch, bundle, towers):
    editor = launch("--plugin-path", bundle, towers)
    editor.settled(samples=1)
    # The sky
    editor.click("tab.Scene")
    editor.reveal("sky.kind")
    editor.click("sky.kind")
    editor.click("sky.kind.dusk")
    editor.wait(lambda s: s["history"]["position"] == 1, "the sky")
    editor.settled(samples=1)
    # The action, from the menu; then from the panel.
    editor.click(("picture", 0.5, 0.5))
    editor.wait(lambda s: len(s["selection"]) == 1, "a tower")
    editor.click("menu.tools")
    editor.click("tools.lift")
    editor.click("action.run")
    editor.wait(lambda s: s["history"]["labels"][-1:] == ["Lift"], "the tower is lifted")
    editor.key("ctrl+z")
    editor.wait(lambda s: s["history"]["position"] == 1, "it stands again")
    editor.click("menu.panels")
    editor.click("panels.lift")
    editor.click("panel.lift.ui.button.0")
    editor.wait(lambda s: s["history"]["position"] == 2, "lifted by the panel")
    # The material
    editor.click("tab.Inspector")
    editor.reveal("material.tint")
    assert editor.state()["selection"][0]["type"] == "chalk"
    before = editor.picture()
    editor.key("ctrl+z")
    editor.settled(samples=1)
    editor.wait(lambda _: np.abs(editor.picture() - before).max() > 0.1, "the picture follows")
