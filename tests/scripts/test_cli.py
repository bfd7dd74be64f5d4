# SPDX-License-Identifier: Apache-2.0
"""The program from the outside: what commands print, write and return. Needs RESTAGE_BIN (tools/test sets it)."""
import json
import os
import pathlib
import re
import signal
import subprocess
import time

import numpy as np
import pytest

import exr_file

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))
CORNELL = ROOT / "scenes/cornell/cornell.pbrt"


def restage(*args, **kwargs):
    return subprocess.run([RESTAGE, *map(str, args)], capture_output=True, text=True, timeout=300, **kwargs)


def test_help_and_version_go_to_stdout_and_succeed():
    for args in (["--help"], ["render", "--help"], ["--version"]):
        done = restage(*args)
        assert done.returncode == 0 and done.stdout and not done.stderr
    for command in re.findall(r"^  ([a-z-]+) {3,}[A-Z]", restage("--help").stdout.split("Subcommands:")[1], re.M):
        text = restage(command, "--help").stdout
        assert f"Example: restage {command}" in text and "Exit codes: 0 done" in text, command


@pytest.mark.parametrize("args", [[], ["render"], ["render", "--nonsense"], ["nosuchcommand"],
                                  ["render", "a", "-o", "b.png", "--spp", "0"], ["render", "a", "-o", "b.png", "--spp", "4", "--time", "3"]])
def test_an_unknown_command_line_is_a_usage_error(args):
    done = restage(*args)
    assert done.returncode == 2 and done.stderr and not done.stdout


@pytest.mark.parametrize("args, says", [
    (["render", "nowhere.pbrt", "-o", "x.png"], "nowhere.pbrt"),
    (["render", CORNELL, "-o", "x.jpeg2000"], ".exr, .png, .jpg, .pfm or .hdr"),
    (["render", CORNELL, "-o", "no/such/folder/x.png"], "there is no folder"),
    (["render", CORNELL, "-o", "x.png", "--size", "12"], "WxH"),
    (["render", CORNELL, "-o", "x.png", "--device", "no such device"], "no such device"),
    (["info", "nowhere.pbrt"], "nowhere.pbrt"),
    (["info", "-"], "-: a scene on stdin is read by `restage render` only"),
    (["convert", "-", "x.pbrt"], "-: a scene on stdin is read by `restage render` only"),
    (["convert", CORNELL, "x.unknownformat"], "unknownformat"),
    (["convert", CORNELL, "x.pbrt", "--set", "version=v9"], "v9"),
    (["convert", CORNELL, "x"], "no extension to tell the format by"),
    (["convert", CORNELL, "x.png"], "use `restage render` to make a picture of a scene"),
    (["convert", CORNELL, "x.pbrt", "--exposure", 1], "--exposure is for pictures"),
    (["render", CORNELL, "-o", "x.png", "--format", "gltf"], "--format is for a scene on stdin"),
    (["render", CORNELL, "-o", "x.png", "--resume", "nowhere.exr"], "nowhere.exr: cannot be opened"),
    (["render", CORNELL, "-o", "x.png", "--statistics", "no/x.json"], "--statistics: no/x.json: there is no folder no"),
    (["render", CORNELL, "-o", "gif:-"], "-o gif:-: for stdout use exr:-, png:-"),
    (["edit", "nowhere.pbrt"], "nowhere.pbrt: cannot be opened"),
    (["compare", CORNELL, "x.png"], "one is a scene, the other is not"),
    (["compare", CORNELL, CORNELL, "--diff", "d.png"], "of two scenes only the differences are listed"),
    (["check", "diffuse", "--only", "manifest", "--json", "no/x.json"], "--json: no/x.json: there is no folder no"),
    (["check", "diffuse", "--only", "manifest", "--json", "x", "--junit", "x"], "both would be written to x"),
])
def test_a_failure_says_why(args, says, tmp_path):
    done = restage(*args, cwd=tmp_path)
    assert done.returncode == 1 and says in done.stderr and not done.stdout
    assert not list(tmp_path.iterdir()), "a failed command leaves nothing behind"


def test_a_project_without_a_camera_is_not_rendered(tmp_path):
    (tmp_path / "bare.restage").write_text('{"restage": 1}')
    done = restage("render", tmp_path / "bare.restage", "-o", tmp_path / "x.png", "--size", "8x8", "--spp", 1)
    assert done.returncode == 1 and "bare.restage: there is no camera to look through" in done.stderr
    assert not (tmp_path / "x.png").exists()


def test_render_writes_layers_and_settings_and_a_seed_repeats_it(tmp_path):
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        done = restage("render", CORNELL, "-o", tmp_path / f"{name}.exr", "--size", "64x48", "--spp", 8, "--seed", seed)
        assert done.returncode == 0, done.stderr
        assert "8 spp" in done.stderr and not done.stdout
    data = (tmp_path / "a.exr").read_bytes()
    for name in (b"stderr.R", b"albedo.R", b"normal.X", b"depth.Z", b"id.instance", b"restage:samples"):
        assert name in data

    def difference(x, y):
        done = restage("compare", tmp_path / x, tmp_path / y, "--json")
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    assert difference("a.exr", "b.exr")["rmse"] < 1e-6
    other = difference("a.exr", "c.exr")
    assert other["rmse"] > 1e-4 and other["z_test"]["share_passing"] > 0.95


def test_the_error_of_luminance_is_less_than_the_sum_of_its_channels_errors(tmp_path):
    scene = tmp_path / "scene.pbrt"
    scene.write_text("""
        LookAt 0 0 4  0 0 0  0 1 0  Camera "perspective" "float fov" 60  Film "rgb" "integer xresolution" 64 "integer yresolution" 32
        WorldBegin
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 4 4 4 ] Translate -1.5 0 1 Shape "sphere" "float radius" 0.4 AttributeEnd
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 9 0 0 ] Translate 1.5 1 1 Shape "sphere" "float radius" 0.3 AttributeEnd
        AttributeBegin AreaLightSource "diffuse" "rgb L" [ 0 3 9 ] Translate 1.5 -1 1 Shape "sphere" "float radius" 0.3 AttributeEnd
        Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
        Shape "bilinearmesh" "point3 P" [ -6 -6 -1  6 -6 -1  -6 6 -1  6 6 -1 ]""")
    out = tmp_path / "out.exr"
    assert restage("render", scene, "-o", out, "--spp", 64).returncode == 0
    layers = exr_file.read(out)
    r, g, b, y = (layers[f"stderr.{c}"].astype(float) for c in "RGBY")
    luminance = 0.2126 * layers["R"] + 0.7152 * layers["G"] + 0.0722 * layers["B"]
    sum_of_errors = 0.2126 * r + 0.7152 * g + 0.0722 * b # the bound for fully correlated channels
    rounding = 1e-6 + 1e-4 * luminance # sums of squares are floats
    assert y.min() >= 0 and y.max() > 0
    assert np.all(y <= sum_of_errors + rounding)
    # Each pixel chooses one of three independent lights per sample: the channels' errors differ.
    noisy = sum_of_errors > np.median(sum_of_errors)
    assert np.median(y[noisy] / sum_of_errors[noisy]) < 0.95
    # At least the remainder if the other channels cancel as much of green's error as they can.
    assert np.all(y >= 0.7152 * g - 0.2126 * r - 0.0722 * b - rounding)


def test_targets_of_time_and_error(tmp_path):
    start = time.monotonic()
    done = restage("render", CORNELL, "-o", tmp_path / "t.png", "--size", "64x64", "--time", 2)
    assert done.returncode == 0 and 2 <= time.monotonic() - start < 60
    done = restage("render", CORNELL, "-o", tmp_path / "e.exr", "--size", "64x64", "--error", 0.2)
    assert done.returncode == 0
    assert float(done.stderr.split("relative error ")[1].split(",")[0]) <= 0.2


@pytest.mark.parametrize("name", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_one_signal_writes_the_picture_so_far(tmp_path, name):
    """Ctrl-C; a batch system's time limit, `timeout`; a terminal that is closed."""
    out = tmp_path / "long.exr"
    process = subprocess.Popen([RESTAGE, "-v", "render", str(CORNELL), "-o", str(out), "--size", "64x64", "--spp", "10000000"],
                               stderr=subprocess.PIPE, text=True)
    log = ""
    while "tracer:" not in log:  # the renderer exists: from here on it can be stopped
        line = process.stderr.readline()
        assert line, log
        log += line
    time.sleep(1)  # a few samples, on most machines
    process.send_signal(getattr(signal, name))
    log += process.communicate(timeout=120)[1]
    assert process.returncode == 128 + getattr(signal, name) and "stopped after" in log
    assert restage("compare", out, out).returncode == 0


def test_a_lost_device_is_opened_again_once(tmp_path):
    """RESTAGE_TEST_DEVICE_LOST=AFTER,TIMES: the driver stops after AFTER submissions, TIMES times."""
    arguments = ["render", CORNELL, "--size", "48x48", "--spp", 8, "--tracer", "embree", "-o"]
    plain = restage(*arguments, tmp_path / "plain.exr")
    assert plain.returncode == 0 and "driver stopped" not in plain.stderr
    once = restage(*arguments, tmp_path / "once.exr", env={**os.environ, "RESTAGE_TEST_DEVICE_LOST": "10,1"})
    assert once.returncode == 0, once.stderr
    assert once.stderr.count("the graphics driver stopped (VK_ERROR_DEVICE_LOST); it is restarted") == 1
    same = restage("compare", tmp_path / "plain.exr", tmp_path / "once.exr")
    assert same.returncode == 0, same.stdout + same.stderr
    again = restage(*arguments, tmp_path / "again.exr", env={**os.environ, "RESTAGE_TEST_DEVICE_LOST": "10,9"})
    assert again.returncode == 1 and "VK_ERROR_DEVICE_LOST" in again.stderr and not (tmp_path / "again.exr").exists()
    assert again.stderr.count("it is restarted") == 1


def test_info_as_json_counts_and_reports():
    done = restage("info", CORNELL, "--json")
    assert done.returncode == 0, done.stderr
    info = json.loads(done.stdout)
    assert info["objects"] >= 6 and info["lights"]["area"] >= 1 and info["report_counts"]["dropped"] == 0


def test_plugins_lists_the_shipped_ones_and_a_refused_one_with_its_reason(tmp_path):
    bad = tmp_path / "material-bad"
    bad.mkdir()
    (bad / "plugin.json").write_text("{ this is no JSON")
    done = restage("plugins", "--json", env={**os.environ, "RESTAGE_PLUGIN_PATH": str(tmp_path)})
    assert done.returncode == 0, done.stderr
    entries = json.loads(done.stdout)
    loaded = " ".join(p for e in entries if e["loaded"] for p in e["provides"])
    for name in ("importer pbrt", "exporter pbrt", "denoiser oidn", "material diffuse", "material mix"):
        assert name in loaded
    refused = [e for e in entries if not e["loaded"]]
    assert len(refused) == 1 and "plugin.json" in refused[0]["reason"]


@pytest.mark.parametrize("version", ["v4", "v3"])
def test_convert_there_and_back_renders_the_same(version, tmp_path):
    out = tmp_path / "out.pbrt"
    assert restage("convert", CORNELL, out, "--set", f"version={version}").returncode == 0
    for name, scene in (("a", CORNELL), ("b", out)):
        done = restage("render", scene, "-o", tmp_path / f"{name}.exr", "--size", "64x64", "--spp", 16)
        assert done.returncode == 0, done.stderr
    z = json.loads(restage("compare", tmp_path / "a.exr", tmp_path / "b.exr", "--json").stdout)["z_test"]
    assert z["share_passing"] > 0.95


def test_compare_says_what_differs_between_two_scenes(tmp_path):
    out = tmp_path / "out.pbrt"
    assert restage("convert", CORNELL, out).returncode == 0
    done = restage("compare", CORNELL, out, "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["same"] is True
    out.write_text(re.sub(r"\bfov\b(.*?)[0-9.]+", r"fov\g<1>12", out.read_text(), count=1))
    done = restage("compare", CORNELL, out)
    assert done.returncode == 1 and "differ" in done.stdout and "camera" in done.stdout.lower(), done.stdout
    done = restage("compare", CORNELL, out, "--json")
    assert done.returncode == 1 and json.loads(done.stdout)["same"] is False


def test_demo_runs_the_main_job(tmp_path):
    done = restage("demo", "-o", tmp_path / "demo", "--spp", 2, "--size", "96x54")
    assert done.returncode == 0, done.stderr
    assert "the same scene" in done.stdout and "leads back" in done.stdout
    for name in ("before.png", "after.png", "before.exr", "after.exr", "edited.pbrt"):
        assert (tmp_path / "demo" / name).stat().st_size > 0
    changed = json.loads(restage("compare", tmp_path / "demo/before.exr", tmp_path / "demo/after.exr", "--json").stdout)
    assert changed["rmse"] > 0.01


def test_a_region_is_part_of_the_picture_and_equal_renders_are_equal_files(tmp_path):
    """pbrt's crop by fractions, likewise by pixels; the file contains no times; several outputs, statistics."""
    common = [CORNELL, "--size", "64x48", "--spp", 2, "--seed", 3]
    for name, extra in (("whole", []), ("again", []), ("region", ["--region", 16, 12, 32, 24]), ("crop", ["--crop", 0.25, 0.75, 0.25, 0.75])):
        done = restage("render", *common, "-o", tmp_path / f"{name}.exr", "-o", tmp_path / f"{name}.jpg",
                       "--statistics", tmp_path / f"{name}.json", *extra)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "whole.exr").read_bytes() == (tmp_path / "again.exr").read_bytes()
    assert (tmp_path / "whole.jpg").read_bytes().startswith(b"\xff\xd8")
    whole, region, crop = (exr_file.read(tmp_path / f"{name}.exr") for name in ("whole", "region", "crop"))
    assert np.array_equal(region["depth.Z"], whole["depth.Z"][12:36, 16:48])
    assert np.array_equal(region["R"], crop["R"]) and region["R"].shape == (24, 32)
    numbers = json.loads((tmp_path / "region.json").read_text())
    assert (numbers["width"], numbers["height"], numbers["samples"], numbers["denoiser"]) == (32, 24, 2, "none")
    for bad in (["--region", 60, 0, 10, 10], ["--crop", 0.5, 0.5, 0, 1]):
        done = restage("render", *common, "-o", tmp_path / "no.exr", *bad)
        assert done.returncode == 1 and bad[0] in done.stderr and not (tmp_path / "no.exr").exists()


def test_one_sample_has_no_error_and_unknown_layers_and_denoisers_are_refused(tmp_path):
    common = ["render", CORNELL, "-o", tmp_path / "one.exr", "--size", "16x16", "--spp", 1]
    done = restage(*common)
    assert done.returncode == 0 and "error unknown with one sample" in done.stderr and "e+3" not in done.stderr
    for extra, says in ((["--aov", "foo"], "there are stderr, albedo, normal, depth, coverage, id and catcher"),
                        (["--denoiser", "nosuch"], 'there is no denoiser "nosuch"; there are')):
        done = restage(*common, *extra)
        assert done.returncode == 1 and says in done.stderr


def test_a_picture_becomes_another_format_and_compare_has_a_verdict(tmp_path):
    for name, seed in (("a", 1), ("b", 2)):
        assert restage("render", CORNELL, "-o", tmp_path / f"{name}.exr", "--size", "32x32", "--spp", 4, "--seed", seed).returncode == 0
    for out in ("a.png", "a.jpg", "a.pfm", "a.hdr"):
        assert restage("convert", tmp_path / "a.exr", tmp_path / out).returncode == 0
    same = restage("compare", tmp_path / "a.pfm", tmp_path / "a.exr", "--max-flip", 0.0001)
    assert same.returncode == 0, same.stderr
    assert restage("compare", tmp_path / "a.png", tmp_path / "b.exr", "--max-flip", 0.0001).returncode == 1
    assert restage("convert", tmp_path / "a.exr", tmp_path / "bright.exr", "--exposure", 2).returncode == 0
    brighter = json.loads(restage("compare", tmp_path / "bright.exr", tmp_path / "a.exr", "--json").stdout)
    assert brighter["luminance_a"] == pytest.approx(4 * brighter["luminance_b"], rel=1e-5)
    # A different picture, with both errors known: the z-test decides the exit code, unless a fraction of blocks replaces it.
    assert restage("render", CORNELL, "-o", tmp_path / "dark.exr", "--size", "32x32", "--spp", 4, "--max-depth", 1).returncode == 0
    done = restage("compare", tmp_path / "a.exr", tmp_path / "dark.exr", "--json")
    assert done.returncode == 1 and "the z-test fails" in done.stderr and not json.loads(done.stdout)["passes"]
    assert restage("compare", tmp_path / "a.exr", tmp_path / "dark.exr", "--min-blocks", 0).returncode == 0
    assert restage("compare", tmp_path / "a.exr", tmp_path / "dark.exr", "--min-blocks", 0.99).returncode == 1


def test_set_changes_the_scene_that_is_rendered(tmp_path):
    common = ["render", CORNELL, "--size", "24x24", "--spp", 4, "-o", tmp_path / "x.exr", "--quiet"]
    means = []
    for extra in ([], ["--set", "film.exposure=2"], ["--set", "White.reflectance=0.05,0.05,0.05", "--set", "settings.max_depth=2"]):
        done = restage(*common, *extra)
        assert done.returncode == 0, done.stderr
        means.append(exr_file.read(tmp_path / "x.exr")["G"].mean())
    exposure = json.loads(restage("info", CORNELL, "--json").stdout).get("film", {}).get("exposure", 1)
    assert means[1] == pytest.approx(means[0] * 2 / exposure, rel=1e-5) and means[2] < 0.8 * means[0]
    done = restage(*common, "--set", "White.gloss=1")
    assert done.returncode == 1 and '--set: "White.gloss": material "White" has type, reflectance' in done.stderr


def test_a_render_is_resumed_and_parts_are_merged(tmp_path):
    common = ["render", CORNELL, "--size", "32x24", "--seed", 5]
    for name, extra in (("whole", ["--spp", 6]), ("first", ["--spp", 2]), ("rest", ["--spp", 4, "--first-sample", 2])):
        done = restage(*common, "-o", tmp_path / f"{name}.exr", *extra)
        assert done.returncode == 0, done.stderr
    done = restage(*common, "-o", tmp_path / "resumed.exr", "--resume", tmp_path / "first.exr", "--spp", 6)
    assert done.returncode == 0 and "6 spp" in done.stderr, done.stderr
    done = restage("merge", tmp_path / "first.exr", tmp_path / "rest.exr", "-o", tmp_path / "merged.exr")
    assert done.returncode == 0, done.stderr
    whole = exr_file.read(tmp_path / "whole.exr")
    for name in ("resumed", "merged"):
        picture = exr_file.read(tmp_path / f"{name}.exr")
        for layer in ("R", "G", "B", "stderr.Y", "albedo.R", "depth.Z"):
            assert np.allclose(picture[layer], whole[layer], rtol=1e-4, atol=1e-5), (name, layer)
        assert np.array_equal(picture["id.instance"], whole["id.instance"])
    done = restage("merge", tmp_path / "first.exr", tmp_path / "whole.exr", "-o", tmp_path / "no.exr")
    assert done.returncode == 1 and "hold the same samples, of seed 5" in done.stderr and not (tmp_path / "no.exr").exists()
    done = restage(*common, "-o", tmp_path / "no.exr", "--resume", tmp_path / "whole.exr", "--spp", 6)
    assert done.returncode == 1 and "has 6 samples per pixel already" in done.stderr and not (tmp_path / "no.exr").exists()


def test_scenes_from_stdin_and_pictures_to_stdout(tmp_path):
    """Also with the scene's own paths, which are relative to the current folder."""
    (tmp_path / "part.pbrt").write_text('Material "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]\nShape "sphere"\n')
    scene = ('LookAt 0 0 5 0 0 0 0 1 0\nCamera "perspective"\nFilm "rgb" "integer xresolution" 16 "integer yresolution" 12\n'
             'WorldBegin\nLightSource "infinite"\nInclude "part.pbrt"\n')
    for output, magic in (("-", b"\x76\x2f\x31\x01"), ("png:-", b"\x89PNG")):
        done = subprocess.run([RESTAGE, "render", "-", "-o", output, "--spp", "1"], input=scene.encode(), capture_output=True,
                              timeout=300, cwd=tmp_path)
        assert done.returncode == 0 and done.stdout.startswith(magic), done.stderr
    (tmp_path / "out.exr").write_bytes(subprocess.run([RESTAGE, "render", "-", "-o", "-", "--spp", "1"], input=scene.encode(),
                                                      capture_output=True, timeout=300, cwd=tmp_path).stdout)
    assert (exr_file.read(tmp_path / "out.exr")["id.instance"] > 0).any()
    assert sorted(p.name for p in tmp_path.iterdir()) == ["out.exr", "part.pbrt"]
    done = restage("render", "-", "-o", "x.exr", input="", cwd=tmp_path)
    assert done.returncode == 1 and "stdin: is empty" in done.stderr
    done = restage("render", CORNELL, "-o", "-", "--statistics", "-")
    assert done.returncode == 1 and "only one of them can go to stdout" in done.stderr


def test_frames_are_one_scene_file_each(tmp_path):
    for frame, grey in ((8, 0.2), (9, 0.4), (10, 0.6)):
        (tmp_path / f"shot.{frame:03}.pbrt").write_text(
            'LookAt 0 0 5 0 0 0 0 1 0\nCamera "perspective"\nFilm "rgb" "integer xresolution" 8 "integer yresolution" 8\n'
            f'WorldBegin\nLightSource "infinite" "rgb L" [ {grey} {grey} {grey} ]\nShape "sphere" "float radius" 0.1\n')
    done = restage("render", "shot.###.pbrt", "--frames", "8-10x2,9", "-o", "out-##.exr", "--spp", 1, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    for frame, grey in (("08", 0.2), ("09", 0.4), ("10", 0.6)):
        assert exr_file.read(tmp_path / f"out-{frame}.exr")["R"][0, 0] == pytest.approx(grey, rel=1e-3)
    for frames, output, says in (("8-", "o-#.exr", "frames are numbers and ranges"), ("8-10", "o.exr", "overwritten by each frame"),
                                 ("10-8", "o-#.exr", "frames are numbers and ranges")):
        done = restage("render", "shot.###.pbrt", "--frames", frames, "-o", output, cwd=tmp_path)
        assert done.returncode == 1 and says in done.stderr


DARK = """LookAt 0 0 -5  0 0 0  0 1 0  Camera "perspective" "float fov" 60  Film "rgb" "integer xresolution" 32 "integer yresolution" 16
#restage AttributeBegin
#restage     Identity
#restage     # name: "away"
#restage     LookAt 0 0 -5  0 0 -9  0 1 0
#restage     Camera "perspective" "float fov" 60
#restage AttributeEnd
WorldBegin
Material "diffuse" Shape "sphere"
"""


def test_a_scene_without_light_says_so_and_can_be_lit(tmp_path):
    (tmp_path / "dark.pbrt").write_text(DARK)
    out = tmp_path / "dark.pfm"
    done = restage("render", tmp_path / "dark.pbrt", "-o", out, "--spp", 1)
    assert done.returncode == 0 and "nothing emits light in this scene" in done.stderr and "--studio" in done.stderr
    black = np.frombuffer(out.read_bytes()[-32 * 16 * 12:], "<f4")
    assert black.max() == 0
    done = restage("render", tmp_path / "dark.pbrt", "-o", out, "--spp", 1, "--studio")
    assert done.returncode == 0 and "nothing emits" not in done.stderr
    assert np.frombuffer(out.read_bytes()[-32 * 16 * 12:], "<f4").reshape(16, 32, 3)[8, 16].mean() > 0.1
    assert "--studio" in restage("info", tmp_path / "dark.pbrt").stdout


def test_a_camera_is_chosen_by_name_or_number(tmp_path):
    (tmp_path / "two.pbrt").write_text(DARK)
    listed = restage("info", tmp_path / "two.pbrt").stdout
    assert '(active), 2 "away"' in listed, listed
    pictures = []
    for camera in ("1", "2", "away"):
        out = tmp_path / f"{camera}.pfm"
        done = restage("render", tmp_path / "two.pbrt", "-o", out, "--spp", 1, "--aov", "none", "--studio", "--camera", camera)
        assert done.returncode == 0, done.stderr
        pictures.append(out.read_bytes())
    assert pictures[1] == pictures[2] != pictures[0]
    done = restage("render", tmp_path / "two.pbrt", "-o", tmp_path / "x.pfm", "--spp", 1, "--camera", "front")
    assert done.returncode == 1 and '2 "away"' in done.stderr and "front" in done.stderr


@pytest.mark.parametrize("extra, says", [
    (["--samples", 3], "restage render has no option --samples"),
    (["more.pbrt"], '"more.pbrt" is one argument too many'),
    (["--size", ""], "--size: the value is empty"), (["--camera", ""], "--camera: the value is empty"),
    (["--statistics", ""], "--statistics: the value is empty"), (["--frames", ""], "--frames: the value is empty"),
    (["--error", "nan"], "nan is not a finite number"), (["--exposure", "inf"], "inf is out of range: it must be from -64 to 64"),
    (["--clamp-direct", "nan"], "nan is not a finite number"),
    (["--time", 0], "--time: 0 is out of range: it must be above 0"), (["--clamp-direct", -1], "-1 is out of range: it must be 0 or more"),
    (["--spp", -1], "--spp: -1 is out of range: it must be from 1 to 16777216"), (["--seed", -1], '--seed: "-1" is not a whole number from 0 to 4294967295'),
    (["--threads", 100000], "--threads: 100000 is out of range: it must be from 0 to 1024"), (["--tracer", "foo"], '--tracer: "foo" is not one of embree,vulkan'),
    (["--set"], "--set takes a value"), (["--exposure"], "--exposure takes a value"), (["--size", "8x8", "--size", "9x9"], "--size is given more than once"),
    (["--isolate-memory", "nan"], "nan is not a finite number"), (["--exposure", 65], "--exposure: 65 is out of range: it must be from -64 to 64"),
    (["--crop", 0, 1, 0], "--crop takes 4 values, not 3"), (["--crop", "a", "b", "c", "d"], "--crop: \"a,b,c,d\" is not a number"),
])
def test_wrong_values_of_options_are_explained(extra, says, tmp_path):
    done = restage("render", CORNELL, "-o", tmp_path / "x.png", *extra)
    assert done.returncode == 2 and says in done.stderr and "restage render --help" in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_file_that_would_be_written_twice_is_refused(tmp_path):
    for extra in (["-o", "x.png"], ["--statistics", "x.png"]):
        done = restage("render", CORNELL, "-o", "x.png", *extra, cwd=tmp_path)
        assert done.returncode == 1 and "x.png would be written twice" in done.stderr and not list(tmp_path.iterdir())


def test_an_impossible_resume_is_reported_before_rendering(tmp_path):
    common = ["--spp", 1, "--size", "16x12"]
    assert restage("render", CORNELL, "-o", "a.exr", *common, cwd=tmp_path).returncode == 0
    for scene, extra, says in ((CORNELL, ["--size", "20x12"], "has 16x12 pixels, not 20x12; give --size 16x12"),
                               (CORNELL, ["--region", 0, 0, 8, 12], "has 16x12 pixels, not 8x12; give the --size and the --crop or --region"),
                               (CORNELL, ["--size", "20x12", "--crop", 0, 0.5, 0, 1], "has 16x12 pixels, not 10x12; give the --size and the"),
                               (CORNELL, ["--set", "White.reflectance=0.1"], 'is from another render: its changes is "", not "White.reflectance=0.1"'),
                               (ROOT / "scenes/spheres/spheres.pbrt", [], 'its scene is "cornell.pbrt", not "spheres.pbrt"')):
        size = [] if "--size" in extra else ["--size", "16x12"]
        done = restage("render", scene, "-o", "r.exr", "--resume", "a.exr", "--spp", "16777216", *size, *extra, cwd=tmp_path)
        assert done.returncode == 1 and says in done.stderr and not (tmp_path / "r.exr").exists()


def test_inputs_and_non_files_are_never_overwritten(tmp_path):
    """Inputs of the same command, pipes, devices; a link's target is written, the link is not replaced."""
    for name, seed in (("a", 1), ("b", 2)):
        assert restage("render", CORNELL, "-o", tmp_path / f"{name}.exr", "--size", "16x12", "--spp", 2, "--seed", seed).returncode == 0
    assert restage("convert", "a.exr", "a.PNG", cwd=tmp_path).returncode == 0 # as cameras name them
    assert restage("convert", "a.PNG", "a.png", cwd=tmp_path).returncode == 0
    os.mkfifo(tmp_path / "fifo.png")
    (tmp_path / "null.png").symlink_to("/dev/null")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere/x.png").write_text("old")
    (tmp_path / "link.png").symlink_to("elsewhere/x.png")

    def files():
        return {p.name: (p.lstat().st_ino, p.lstat().st_mtime_ns) for p in tmp_path.iterdir()}

    before = files()
    for args, says in (
            (["compare", "a.png", "b.exr", "--diff", "./a.png"], "would overwrite one of the compared pictures"),
            (["compare", "a.exr", "b.exr", "--diff", "d.png", "--z-map", "d.png"], "d.png would be written twice"),
            (["compare", "a.exr", "--reference-halves", "b.exr", "./b.exr"], "b.exr twice: there would be no noise"),
            (["compare", "a.exr", "b.exr", "--diff", "d.jpg"], "its name must end with .png"),
            (["compare", "a.png", "b.exr", "--diff", "d.png", "--z-map", "z.png"], "--z-map: no z-test"),
            (["convert", "a.exr", "./a.exr"], "is the input file"),
            (["convert", "a.exr", "x.png", "--strict"], "are for scenes"),
            (["convert", "a.exr", "fifo.png"], "file that can be replaced"),
            (["convert", "a.exr", "null.png"], "file that can be replaced"),
            (["merge", "a.exr", "b.exr", "-o", "fifo.png"], "file that can be replaced"),
            (["check", "diffuse", "--only", "sizes"], "this step applies to none of the plugins that were checked")):
        done = restage(*args, cwd=tmp_path)
        assert done.returncode == 1 and says in done.stderr, (args, done.stderr)
    assert files() == before
    done = restage("convert", "a.exr", "link.png", cwd=tmp_path)
    assert done.returncode == 0 and "lacks the layers albedo, coverage, depth, id, normal, stderr of a.exr" in done.stderr
    assert (tmp_path / "link.png").is_symlink() and (tmp_path / "elsewhere/x.png").read_bytes().startswith(b"\x89PNG")


def test_a_clamp_of_the_scene_is_switched_off_by_0(tmp_path):
    (tmp_path / "dim.restage").write_text(json.dumps({"restage": 1, "base": {"file": str(CORNELL)}, "settings": {"clamp_indirect": 0.001}}))
    means = []
    for scene, extra in ((CORNELL, []), (tmp_path / "dim.restage", []), (tmp_path / "dim.restage", ["--clamp-indirect", 0]),
                         (tmp_path / "dim.restage", ["--reference"])):
        done = restage("render", scene, "-o", tmp_path / "x.exr", "--size", "16x12", "--spp", 4, *extra)
        assert done.returncode == 0, done.stderr
        means.append(exr_file.read(tmp_path / "x.exr")["G"].mean())
    assert means[1] < 0.95 * means[0] and means[2:] == pytest.approx([means[0]] * 2, rel=1e-5)
    done = restage("render", CORNELL, "-o", tmp_path / "x.exr", "--reference", "--clamp-direct", 1)
    assert done.returncode == 2 and "--clamp-direct excludes --reference" in done.stderr


def test_the_looks_of_a_project_are_listed_and_rendered(tmp_path):
    project = tmp_path / "looks.restage"
    project.write_text(json.dumps({
        "restage": 1, "base": {"file": str(CORNELL), "format": "pbrt"},
        "looks": [{"name": "plain", "current": True}, {"name": "dark/blue", "film": {"exposure": 0.25}}]}))
    info = restage("info", project)
    assert 'looks       "plain" (current), "dark/blue"' in info.stdout
    assert json.loads(restage("info", project, "--json").stdout)["looks"][1] == {"name": "dark/blue", "current": False}
    some = ["--spp", 1, "--size", "16x16"]
    done = restage("render", project, "--look", "all", "-o", tmp_path / "{look}.pfm", *some)
    assert done.returncode == 0, done.stderr
    assert sorted(p.name for p in tmp_path.glob("*.pfm")) == ["dark_blue.pfm", "plain.pfm"]
    plain, dark = ((tmp_path / name).read_bytes()[-16 * 16 * 12:] for name in ("plain.pfm", "dark_blue.pfm"))
    ratio = np.frombuffer(dark, np.float32).sum() / np.frombuffer(plain, np.float32).sum()
    assert abs(ratio - 0.25) < 1e-5
    both = restage("render", project, "--look", "all", "-o", tmp_path / "x.pfm", *some)
    assert both.returncode == 1 and "x.pfm would be written twice; put {look} in the name" in both.stderr
    none = restage("render", project, "--look", "plane", "-o", tmp_path / "x.pfm", *some)
    assert none.returncode == 1 and '--look plane: no such look; known: "plain", "dark/blue"' in none.stderr
    one = restage("render", CORNELL, "--look", "all", "-o", tmp_path / "x.pfm", *some)
    assert one.returncode == 1 and "known: none" in one.stderr
    assert not (tmp_path / "x.pfm").exists()


def test_a_camera_path_goes_through_all_cameras(tmp_path):
    (tmp_path / "two.pbrt").write_text(DARK)
    some = ["--spp", 1, "--size", "16x16", "--studio"]
    stills = []
    for camera in ("1", "2"):
        assert restage("render", tmp_path / "two.pbrt", "-o", tmp_path / "still.pfm", "--camera", camera, *some).returncode == 0
        stills.append((tmp_path / "still.pfm").read_bytes())
    done = restage("render", tmp_path / "two.pbrt", "-o", tmp_path / "way.#.pfm", "--camera-path", 3, *some)
    assert done.returncode == 0, done.stderr
    way = [(tmp_path / f"way.{n}.pfm").read_bytes() for n in (1, 2, 3)]
    assert [way[0], way[2]] == stills and way[1] not in stills
    one = restage("render", CORNELL, "-o", tmp_path / "x.#.pfm", "--camera-path", 3, *some)
    assert one.returncode == 1 and "--camera-path: the scene has one camera; a path needs two or more" in one.stderr
    both = restage("render", CORNELL, "-o", tmp_path / "x.#.pfm", "--camera-path", 3, "--turntable", 2, *some)
    assert both.returncode != 0 and "--turntable" in both.stderr


FFMPEG = """#!/bin/sh
for a in "$@"; do last="$a"; done
while [ "$1" != "-i" ]; do [ "$1" = "-framerate" ] && rate=$2; shift; done
echo "$rate $(ls "$(dirname "$2")" | wc -l)" > "$last"
"""


def test_a_video_is_made_by_ffmpeg(tmp_path, monkeypatch):
    some = ["--spp", 1, "--size", "16x16"]
    monkeypatch.setenv("PATH", str(tmp_path))
    none = restage("render", CORNELL, "-o", tmp_path / "turn.mp4", "--turntable", 3, *some)
    assert none.returncode == 1 and "videos are made by ffmpeg, which is not on PATH" in none.stderr
    monkeypatch.undo()
    (tmp_path / "ffmpeg").write_text(FFMPEG)  # a stand-in that notes what it is given
    (tmp_path / "ffmpeg").chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    still = restage("render", CORNELL, "-o", tmp_path / "still.mp4", *some)
    assert still.returncode == 1 and "a video needs --turntable or --camera-path" in still.stderr
    done = restage("render", CORNELL, "-o", tmp_path / "turn.mp4", "--turntable", 3, "--fps", 12, *some)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "turn.mp4").read_text() == "12 3\n"
    assert "turn.mp4 was written" in done.stderr


def test_a_turntable_turns_the_camera_once_around_the_scene(tmp_path):
    scene = tmp_path / "two.pbrt"  # a red ball at the left of the picture, a blue one at the right
    ball = 'AttributeBegin Translate {} 0 0 AreaLightSource "diffuse" "rgb L" [{}] Shape "sphere" "float radius" 0.5 AttributeEnd\n'
    scene.write_text('LookAt 0 0 -6  0 0 0  0 1 0\nCamera "perspective" "float fov" 40\nWorldBegin\n' + ball.format(-1, "1 0 0") + ball.format(1, "0 0 1"))
    some = ["--spp", 1, "--size", "32x32", "--turntable"]
    done = restage("render", scene, "-o", tmp_path / "turn.##.pfm", *some, 2)
    assert done.returncode == 0, done.stderr
    pixels = [np.frombuffer((tmp_path / f"turn.0{n}.pfm").read_bytes()[-32 * 32 * 12:], np.float32).reshape(32, 32, 3) for n in (1, 2)]
    left = [p[:, :16].sum(axis=(0, 1)) for p in pixels]
    assert all(color.max() > 0.9 * color.sum() > 10 for color in left)  # one ball each
    assert {int(color.argmax()) for color in left} == {0, 2}  # half a turn: the other one
    wrong = restage("render", scene, "-o", tmp_path / "turn.pfm", *some, 2)
    assert wrong.returncode == 1 and "put #### in the name" in wrong.stderr
