# SPDX-License-Identifier: Apache-2.0
"""--isolate: scenes are read in a separate process, with the same contents; failures there become messages."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

RESTAGE = Path(os.environ["RESTAGE_BIN"]).resolve() if "RESTAGE_BIN" in os.environ else None
pytestmark = pytest.mark.skipif(RESTAGE is None, reason="RESTAGE_BIN names no program")
SCENES = Path(__file__).resolve().parents[2] / "scenes"


def run(*arguments, env=None):
    return subprocess.run(
        [str(RESTAGE), *map(str, arguments)], capture_output=True, text=True, timeout=120, env={**os.environ, **(env or {})}
    )


def test_an_isolated_scene_is_the_same(tmp_path):
    scene = SCENES / "demo" / "demo.pbrt"
    plain = run("info", scene, "--json")
    isolated = run("--isolate", "info", scene, "--json")
    assert isolated.returncode == 0, isolated.stderr
    assert json.loads(isolated.stdout) == json.loads(plain.stdout)
    for name, first in (("plain", []), ("isolated", ["--isolate"])):
        assert run(*first, "convert", scene, tmp_path / name / "scene.pbrt").returncode in (0, 1)
        (tmp_path / name).mkdir(exist_ok=True)
        done = run(*first, "convert", scene, tmp_path / name / "scene.pbrt")
        assert done.returncode == 0, done.stderr
    same = run("compare", tmp_path / "plain/scene.pbrt", tmp_path / "isolated/scene.pbrt")
    assert same.returncode == 0, same.stdout


def test_errors_in_a_file_are_reported_as_usual(tmp_path):
    broken = tmp_path / "broken.pbrt"
    broken.write_text('WorldBegin\nShape "sphere" "float radius" [ 1\n')
    plain, isolated = run("info", broken), run("--isolate", "info", broken)
    assert plain.returncode == isolated.returncode == 1
    assert plain.stderr == isolated.stderr


@pytest.mark.parametrize(
    "case, limits, said",
    [
        ("importer_crashes", [], "reading it ended with SIGABRT"),
        ("importer_hangs", ["--isolate-time", "2"], "no end within 2 s"),
        ("importer_eats", ["--isolate-memory", "1.5"], "reading it ended with SIGSEGV"),
    ],
)
def test_a_misbehaving_importer_ends_only_itself(tmp_path, case, limits, said):
    folder = tmp_path / "plugins" / "test"
    folder.mkdir(parents=True)
    shutil.copy(RESTAGE.parents[1] / "tests" / "plugins_bad" / f"{case}.so", folder / "test.so")
    manifest = {"id": "org.example.velvet", "provides": ["restage.importer/1"], "version": "1.0.0", "licence": "MIT", "needs": {"host": ">=0.2"}}
    (folder / "plugin.json").write_text(json.dumps({**manifest, "library": "test"}))
    scene = tmp_path / "scene.test"
    scene.write_text("TEST")
    env = {"XDG_DATA_HOME": str(tmp_path / "data")}
    done = run("--plugin-path", tmp_path / "plugins", "--isolate", *limits, "info", scene, env=env)
    assert done.returncode == 1, done
    assert said in done.stderr and "nothing was imported" in done.stderr
    if case == "importer_crashes":  # and is stored from now on
        listed = run("--plugin-path", tmp_path / "plugins", "plugins", env=env).stdout
        assert f"it crashed (SIGABRT) while it read {scene}" in listed


def test_pipes_and_deep_nesting_are_explained(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "deep.gltf").write_text('{"asset": {"version": "2.0"}, "extras": ' + "[" * 20000 + "]" * 20000 + "}")
    (tmp_path / "image.pbrt").write_text(
        'WorldBegin\nTexture "t" "spectrum" "imagemap" "string filename" "pipe"\n'
        'Material "diffuse" "texture reflectance" "t"\nShape "sphere"\nInclude "pipe"\n'
    )
    (tmp_path / "a.obj").write_text("mtllib pipe\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for first in ([], ["--isolate"]):
        deep = run(*first, "info", tmp_path / "deep.gltf")
        assert deep.returncode == 1 and "nested more than 256 deep" in deep.stderr
        assert run(*first, "info", tmp_path / "pipe").returncode == 1
        for name, lines in (("image.pbrt", 2), ("a.obj", 1)):
            report = json.loads(run(*first, "info", tmp_path / name, "--json").stdout)["report"]
            assert sum("regular file" in json.dumps(line) for line in report) == lines, report


def test_pictures_are_decoded_by_the_child(tmp_path):
    """An isolated scene has the pixels, and the child pays for decoding: a memory limit ends only the child."""
    png = Path(__file__).resolve().parents[1] / "data" / "images" / "rgb8.png"
    (tmp_path / "a.pbrt").write_text(
        f'WorldBegin\nTexture "t" "spectrum" "imagemap" "string filename" "{png}"\n'
        'Material "diffuse" "texture reflectance" "t"\nShape "sphere"\n'
    )
    plain = json.loads(run("info", tmp_path / "a.pbrt", "--json").stdout)
    isolated = json.loads(run("--isolate", "info", tmp_path / "a.pbrt", "--json").stdout)
    assert isolated == plain


def test_options_of_the_importer_reach_the_child(tmp_path):
    model, project = tmp_path / "t.obj", tmp_path / "p.restage"
    model.write_text("v 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\no a\nf 1 3 2\no b\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
    options = ["--import-set", "units=mm", "--import-set", "up=z", "--import-set", "merge=true"]
    assert json.loads(run("info", model, "--json").stdout)["objects"] == 2
    plain, isolated = run("info", model, "--json", *options), run("--isolate", "info", model, "--json", *options)
    assert isolated.returncode == 0, isolated.stderr
    assert json.loads(isolated.stdout) == json.loads(plain.stdout) and json.loads(plain.stdout)["objects"] == 1
    for name, first in (("plain", []), ("isolated", ["--isolate"])):
        (tmp_path / name).mkdir()
        done = run(*first, "convert", model, tmp_path / name / "scene.pbrt", *options)
        assert done.returncode == 0, done.stderr
    same = run("compare", tmp_path / "plain/scene.pbrt", tmp_path / "isolated/scene.pbrt")
    assert same.returncode == 0, same.stdout
    other = run("compare", tmp_path / "plain/scene.pbrt", model)
    assert other.returncode == 1, "the options made no difference"
    # Unknown options and malformed assignments are refused with the same messages.
    for wrong, says in (("height=2", 'importer "obj": there is no option "height"; known: units='), ("merge", "write name=value"),
                        ("up=x", "as_is|y|z are possible"), ("merge=maybe", '"maybe" is neither true nor false')):
        plain, isolated = (run(*first, "info", model, "--import-set", wrong) for first in ([], ["--isolate"]))
        assert plain.returncode == isolated.returncode == 1 and says in plain.stderr, plain.stderr
        assert plain.stderr == isolated.stderr
    # A project is read with its own options, or with others on request.
    base = {"file": "t.obj", "format": "obj", "hash": "0", "options": {"merge": True}}
    project.write_text(json.dumps({"restage": 1, "base": base}))
    for first in ([], ["--isolate"]):
        assert json.loads(run(*first, "info", project, "--json").stdout)["objects"] == 1
        assert json.loads(run(*first, "info", project, "--json", "--import-set", "units=mm").stdout)["objects"] == 2
