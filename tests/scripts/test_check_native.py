# SPDX-License-Identifier: Apache-2.0
"""`restage check` runs a plugin's native code: load, save, run, draw and read, with arbitrary input."""
import json
import os
import pathlib
import shutil
import subprocess

import exr_file
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = pathlib.Path(os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))).resolve()
BROKEN = RESTAGE.parent.parent / "tests/plugins_broken"

GLSL = """#include <restage/v1/sampling.glsl>
Spectrum broken_eval(broken_Params m, vec3 wo, vec3 wi) { return Spectrum(same_hemisphere(wo, wi) ? abs(wi.z) * INV_PI * m.share : 0.0); }
float broken_pdf(broken_Params m, vec3 wo, vec3 wi) { return same_hemisphere(wo, wi) ? abs(wi.z) * INV_PI : 0.0; }
BsdfSample broken_sample(broken_Params m, vec3 wo, vec3 u) { return BSDF_NONE; }
Spectrum broken_albedo(broken_Params m, vec3 wo) { return Spectrum(0.5); }
"""


def folder_of(folder, case):
    kind = case.split("_")[0]
    provides = {"inspector": ["material", "inspector", "table"], "table": ["material", "inspector", "table"],
                "both": ["importer", "exporter"]}.get(kind, [kind])
    folder.mkdir(exist_ok=True)
    shutil.copy(BROKEN / f"{case}.so", folder / "broken.so")
    (folder / "samples").mkdir(exist_ok=True)
    lines = ["#tri", "0 0 1", "1 2 0.5", "", "-1 0.25 3"] + ["2 2 1"] * (150 if case == "importer_deaf" else 0)
    (folder / "samples/two.tri").write_text("\n".join(lines) + "\n")
    (folder / "broken.glsl").write_text(GLSL)
    (folder / "plugin.json").write_text(json.dumps({
        "id": "org.example.broken", "provides": [f"restage.{p}/1" for p in provides], "version": "1.0.0", "needs": {"host": ">=0.2"}, "licence": "MIT", "library": "broken",
        "files": ["broken.glsl"] if "material" in provides else []}))
    return folder


def steps_of(folder, *args):
    done = subprocess.run([RESTAGE, "check", folder, "--quick", "--json", "-", *map(str, args)], capture_output=True,
                          text=True, timeout=120)
    assert done.stdout, done.stderr
    return done.returncode, {s["step"]: s for s in json.loads(done.stdout)[0]["steps"]}


@pytest.mark.parametrize("case", ["importer_sound", "exporter_sound", "denoiser_sound"])
def test_a_sound_one_passes(case, tmp_path):
    code, steps = steps_of(folder_of(tmp_path / "plugin", case))
    skipped = {"exporter_sound": ["roundtrip"], "importer_sound": ["options"]}.get(case, [])
    assert code == 0 and all(s["verdict"] == ("skipped" if n in skipped else "pass") for n, s in steps.items()), steps
    assert len(steps) >= 7


def test_an_importer_and_an_exporter_of_one_format_pass_the_round_trip(tmp_path):
    code, steps = steps_of(folder_of(tmp_path / "plugin", "both_sound"), "--only", "roundtrip")
    assert code == 0 and steps["roundtrip"]["verdict"] == "pass" and "importer both" in steps["roundtrip"]["text"], steps


@pytest.mark.parametrize("step", ["inspector", "tables"])
def test_a_sound_inspector_and_reader_pass(step, tmp_path):
    code, steps = steps_of(folder_of(tmp_path / "plugin", "inspector_sound"), "--only", step)
    assert code == 0 and steps[step]["verdict"] == "pass", steps


@pytest.mark.parametrize("case, step, says", [
    ("importer_crashes", "read", ["crashed: SIGSEGV", "load() of its two.tri", "a bug in load()"]),
    ("importer_silent", "read", ["returns 0, and error() was not called"]),
    ("importer_leaks", "read", ["files remain open"]),
    ("importer_varies", "read", ["two.tri twice gives different scenes"]),
    ("importer_sure", "probe", ["returns 1000, which is not in 0..100"]),
    ("importer_denies", "probe", ["probe() of its own two.tri returns 0"]),
    ("importer_cut", "cut", ["crashed: SIGSEGV", "bytes of its two.tri", "a bug in load()"]),
    ("importer_deaf", "stop", ["two.tri: stopped on request; the plugin continued, with 1"]),
    ("importer_leaks", "read-leaks", ["files are left open by 100 times load()"]),
    ("importer_loses", "read-leaks", ["bytes allocated", "not freed"]),
    ("exporter_in_place", "write-stop", ["the existing file is gone or changed"]),
    ("exporter_in_place", "place", ["to a full disk: the existing file is gone or changed"]),
    ("exporter_litters", "write-stop", ["it leaves scene.names.part next to the file"]),
    ("exporter_deaf", "write-stop", ["the existing file is gone or changed"]),
    ("exporter_careless", "place", ["to a full disk: save() returns 1"]),
    ("exporter_silent", "place", ["through a file: save() returns 0, and error() was not called"]),
    ("exporter_loses", "write-leaks", ["bytes allocated", "not freed"]),
    ("both_transposed", "roundtrip", ["read back by the importer both, the mean of the vertices is"]),
    ("both_digits", "roundtrip", ["read back by the importer both, the mean of the vertices is"]),
    ("both_refused", "roundtrip", ["the importer both cannot read it", "expected: nine numbers"]),
    ("both_loses", "roundtrip", ["9 triangles became 6"]),
    ("denoiser_loses", "denoise-leaks", ["bytes allocated", "not freed"]),
    ("denoiser_darkens", "denoise", ["% in the mean"]),
    ("denoiser_varies", "robust", ["twice"]),
    ("denoiser_deaf", "robust", ["of progress(), run() returns 1"]),
    ("exporter_crashes", "write", ["crashed: SIGSEGV", "save() of a scene with every feature", "a bug in save()"]),
    ("exporter_varies", "write", ["saving twice gives different bytes, first in scene.names"]),
    ("denoiser_size", "sizes", ["1x1 pixels with guides: refused: only 96x64"]),
    ("denoiser_nan", "robust", ["nan in some pixels"]),
    ("denoiser_guides", "denoise", ["crashed: SIGSEGV", "no guides", "a bug in run()"]),
    ("denoiser_overruns", "denoise", ["writes past the end of its output"]),
    ("inspector_range", "inspector", ["set() of \"share\": 2.000000 is out of its range"]),
    ("inspector_crashes", "inspector", ["crashed: SIGSEGV", "draw() number", "a bug in draw()"]),
    ("inspector_group", "inspector", ["an open group"]),
    ("table_crashes", "tables", ["crashed: SIGSEGV", "read() of noise", "a bug in read()"]),
])
def test_a_violation_is_found(case, step, says, tmp_path):
    code, steps = steps_of(folder_of(tmp_path / "plugin", case), "--only", step)
    assert code == 1 and steps[step]["verdict"] == "fail", steps
    for words in says:
        assert words in steps[step]["text"] + "\n" + steps[step]["cause"]


def test_a_draw_that_does_not_return_is_ended(tmp_path):
    code, steps = steps_of(folder_of(tmp_path / "plugin", "inspector_hangs"), "--only", "inspector", "--time-limit", 2)
    assert code == 1 and "no answer from the plugin within 2 s" in steps["inspector"]["text"]
    assert steps["inspector"]["cause"] == "draw() does not return"


def test_a_crash_in_one_step_leaves_the_others_to_be_checked(tmp_path):
    code, steps = steps_of(folder_of(tmp_path / "plugin", "importer_crashes"))
    assert code == 1
    assert {name: s["verdict"] for name, s in steps.items()} == {
        "manifest": "pass", "load": "pass", "reload": "pass", "probe": "pass", "read": "fail", "options": "skipped", "cut": "fail", "stop": "fail", "read-leaks": "fail"}


def test_without_a_vulkan_driver_it_is_not_the_plugin_that_fails(tmp_path):
    done = subprocess.run([RESTAGE, "check", "diffuse", "--quick", "--only", "sound", "--json", "-"], capture_output=True,
                          text=True, timeout=120, env={**os.environ, "VK_DRIVER_FILES": str(tmp_path / "none.json"),
                                                       "VK_ICD_FILENAMES": str(tmp_path / "none.json")})
    (report,) = json.loads(done.stdout)
    assert done.returncode == 1 and report["verdict"] == "fail" and report["unable"]
    assert [s["verdict"] for s in report["steps"] if s["step"] == "sound"] == ["skipped"]
    assert "this machine cannot run it" in done.stderr


def test_a_third_party_denoiser_is_used_if_named_and_the_file_says_so(tmp_path):
    """Regression: the first one on the path replaced the program's own, but the file named "oidn high"."""
    folder_of(tmp_path / "plugin", "denoiser_sound")
    cornell = ROOT / "scenes/cornell/cornell.pbrt"
    for name, extra, label in (("own", ["--denoise"], "oidn high"), ("type", ["--denoiser", "copy"], "copy high"),
                               ("id", ["--denoise", "fast", "--denoiser", "org.example.broken"], "copy fast")):
        done = subprocess.run([RESTAGE, "--plugin-path", tmp_path, "render", cornell, "-o", tmp_path / f"{name}.exr", "--size", "24x24",
                               "--spp", "2", *extra], capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        data = (tmp_path / f"{name}.exr").read_bytes()
        assert exr_file.header(data)[0]["restage:denoiser"].decode() == label
    picture = exr_file.read(tmp_path / "type.exr")
    assert (picture["R"] == picture["noisy.R"]).all()  # it copies
    picture = exr_file.read(tmp_path / "own.exr")
    assert (picture["R"] != picture["noisy.R"]).any()
