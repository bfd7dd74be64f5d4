# SPDX-License-Identifier: Apache-2.0
"""`restage check` of textures: shipped and correct ones pass, and each violation is found."""
import json
import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = pathlib.Path(os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))).resolve()
BROKEN = RESTAGE.parent.parent / "tests/plugins_broken"
STEPS = ["texture-glsl", "texture-names", "texture-values", "texture-params", "texture-native"]

ADDED = {  # faults that are an extra line
    "prefix": "float helper(float x) { return x; }",
    "binding": "layout(binding = 0) uniform sampler2D broken_picture;",
    "engine": "#include <path/surface.glsl>",
    "scene": "vec3 broken_look(vec2 uv) { SceneData scene; return texture_data(scene, 1u, uv); }",
    "place": "vec3 broken_where(TextureSite at) { return at.place.position; }",
    "three": "Spectrum broken_own() { return vec3(0.5, 0.1, 0.1); }",
    "rgb": "Spectrum broken_own(broken_Params m) { return m.one.rgb; }",
    "both": "Spectrum broken_own(TextureSite at) { return texture_color(at, vec3(0.5, 0.1, 0.1)); }",
    "syntax": "float broken_typo(float x) { return x + y; }",
}


def check(folder, *args):
    done = subprocess.run([RESTAGE, "check", folder, "--quick", "--json", "-", *map(str, args)], capture_output=True,
                          text=True, timeout=300)
    assert done.stdout, done.stderr
    return done.returncode, {s["step"]: s for s in json.loads(done.stdout)[0]["steps"]}


def folder_of(folder, library="sound", fault=None):
    folder.mkdir()
    shutil.copy(BROKEN / f"texture_{library}.so", folder / "broken.so")
    text = (BROKEN / "texture.glsl").read_text()
    if fault:
        text = ADDED.get(fault, f"#define broken_{fault} 1") + "\n" + text
    (folder / "broken.glsl").write_text(text)
    (folder / "plugin.json").write_text(json.dumps({
        "id": "org.example.broken", "provides": ["restage.texture/1"], "version": "1.0.0", "needs": {"host": ">=0.2"},
        "licence": "MIT", "library": "broken", "files": ["broken.glsl"]}))
    return folder


def test_the_shipped_textures_pass():
    folders = sorted((RESTAGE.parent.parent / "lib/restage/plugins").glob("texture-*"))
    assert len(folders) >= 11
    for folder in folders:
        code, steps = check(folder)
        assert code == 0 and all(s["verdict"] != "fail" for s in steps.values()), steps
        assert all(step in steps for step in STEPS)


@pytest.mark.parametrize("fault", [None, "both"])
def test_a_sound_one_passes(tmp_path, fault):
    code, steps = check(folder_of(tmp_path / "plugin", fault=fault))
    assert code == 0 and all(s["verdict"] == "pass" for s in steps.values()), steps
    assert [s for s in steps if s in STEPS] == STEPS


@pytest.mark.parametrize("fault, step, says", [
    ("syntax", "texture-glsl", ["broken.glsl:1: 'y' : undeclared identifier"]),
    ("binding", "texture-glsl", ["broken.glsl:1: \"layout\": a plugin's GLSL has no bindings"]),
    ("engine", "texture-glsl", ["broken.glsl:1: cannot include <path/surface.glsl>"]),
    ("scene", "texture-glsl", ["broken.glsl:1: 'SceneData' : undeclared identifier"]),
    ("place", "texture-glsl", ["broken.glsl:1:", "place"]),  # it has not requested its site
    ("three", "texture-glsl", ["broken.glsl:1:", "in spectral mode", "texture_color()"]),
    ("rgb", "texture-glsl", ["broken.glsl:1:", "in spectral mode"]),
    ("prefix", "texture-names", ["broken.glsl:1: \"helper\" does not start with the plugin's prefix \"broken_\""]),
    ("nan_beyond_half", "texture-values", ["it is", "nan", "at uv (", "part="]),
    ("inf_at_zero", "texture-values", ["it is", "inf", "at uv (0, "]),
    ("idle", "texture-params", ["\"part\" has no effect anywhere in its range"]),
])
def test_a_fault_in_glsl_is_found(fault, step, says, tmp_path):
    code, steps = check(folder_of(tmp_path / "plugin", fault=fault), "--only", step)
    assert code == 1 and steps[step]["verdict"] == "fail", steps
    for words in says:
        assert words in steps[step]["text"] + steps[step]["cause"], steps[step]


@pytest.mark.parametrize("library, says", [
    ("index", ["places it differs from the GLSL", "the index of a value"]),
    ("formula", ["places it differs from the GLSL", "a formula changed in one of the two only"]),
    ("crashes", ["crashed: SIGSEGV", "eval()"]),
])
def test_a_fault_in_native_code_is_found(library, says, tmp_path):
    code, steps = check(folder_of(tmp_path / "plugin", library), "--only", "texture-native")
    assert code == 1 and steps["texture-native"]["verdict"] == "fail", steps
    for words in says:
        assert words in steps["texture-native"]["text"] + steps["texture-native"]["cause"], steps["texture-native"]
