# SPDX-License-Identifier: Apache-2.0
"""Exit codes of commands: done, failed, invalid, stopped. Stopped is distinguished from failed everywhere: while a file is
read, in this process or a separate one, and while a picture is denoised."""
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = pathlib.Path(os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))).resolve()
BROKEN = RESTAGE.parent.parent / "tests/plugins_broken"
CORNELL = ROOT / "scenes/cornell/cornell.pbrt"


def restage(*args, **more):
    return subprocess.run([RESTAGE, *map(str, args)], capture_output=True, text=True, timeout=300, **more)


def plugin_that_waits(folder, kind):
    """A plugin that signals by a file that it is running, and continues until progress() returns 0."""
    folder.mkdir(parents=True)
    shutil.copy(BROKEN / f"{kind}_waits.so", folder / "broken.so")
    (folder / "plugin.json").write_text(json.dumps({
        "id": "org.example.broken", "provides": [f"restage.{kind}/1"], "version": "1.0.0", "needs": {"host": ">=0.2"},
        "licence": "MIT", "library": "broken"}))
    (folder.parent / "wait.tri").write_text("#tri\n0 0 1\n")
    return folder


def stopped(command, mark, name=signal.SIGINT, **environment):
    """The exit code of a command that is stopped while the plugin runs."""
    process = subprocess.Popen([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               env={**os.environ, **environment, "RESTAGE_TEST_MARK": str(mark)}, start_new_session=True)
    try:
        while not mark.exists():
            assert process.poll() is None, process.communicate()
            time.sleep(0.01)
        process.send_signal(name)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    return process.returncode, out, err


@pytest.mark.parametrize("first", [[], ["--isolate"]])
@pytest.mark.parametrize("name", [signal.SIGINT, signal.SIGTERM])
def test_reading_a_scene_is_stopped(first, name, tmp_path):
    plugin_that_waits(tmp_path / "plugin", "importer")
    code, out, err = stopped([RESTAGE, "--plugin-path", tmp_path, *first, "info", tmp_path / "wait.tri"], tmp_path / "mark", name)
    assert code == 128 + name and not out and "stopped on request" in err and "error" not in err.lower(), err


def test_denoising_is_stopped(tmp_path):
    plugin_that_waits(tmp_path / "plugin", "denoiser")
    code, out, err = stopped([RESTAGE, "--plugin-path", tmp_path, "render", CORNELL, "-o", tmp_path / "x.png", "--size", "16x16",
                              "--spp", 1, "--denoiser", "copy"], tmp_path / "mark")
    assert code == 128 + signal.SIGINT, (code, err)
    assert (tmp_path / "x.png").exists() and "denoising was stopped: the picture is written without it" in err


def test_ctrl_c_stops_denoising_in_python(tmp_path):
    """As Ctrl-C everywhere in Python; the picture remains, not denoised. (A callback's False raises restage.Cancelled:
    tests/python/test_editing.py.)"""
    package = RESTAGE.parent.parent / "lib/python"
    if not (package / "restage").is_dir():
        pytest.skip("the package restage is not next to the program")
    script = f"""
import sys
sys.path.insert(0, {str(package)!r})
import restage
with restage.open({str(CORNELL)!r}) as session:
    picture = session.render(size=(8, 8), samples=1)
    try:
        picture.denoise(denoiser="copy")
    except KeyboardInterrupt:
        print("stopped", picture.denoised)
"""
    plugin_that_waits(tmp_path / "plugin", "denoiser")
    code, out, err = stopped([sys.executable, "-c", script], tmp_path / "mark", RESTAGE_PLUGIN_PATH=str(tmp_path / "plugin"))
    assert code == 0 and out.strip() == "stopped None", (out, err)


# Exit codes are documented in README.md and at the end of `restage --help`.
DONE = [["info", CORNELL], ["plugins"], ["compare", CORNELL, CORNELL], ["convert", CORNELL, "out.pbrt"],
        ["check", "diffuse", "--only", "manifest"], ["new-plugin", "velours"], ["--help"], ["--version"],
        ["render", CORNELL, "-o", "a.png", "--size", "8x8", "--spp", "1"]]
FAILED = [["info", "none.pbrt"], ["plugins", "--enable", "org.example.none"], ["compare", "none.exr", "none.exr"],
          ["convert", "none.pbrt", "out.pbrt"], ["check", "nosuchplugin"], ["new-plugin", "No"], ["edit", "none.pbrt"],
          ["render", "none.pbrt", "-o", "a.png"], ["merge", "none.exr", "-o", "a.exr"]]
USAGE = [["info"], ["plugins", "--nonsense"], ["compare", "one"], ["convert", "one"], ["check", "--seed", "x"], ["new-plugin"],
         ["edit", "--nonsense"], ["render"], ["merge"], ["demo", "--nonsense"], ["nonsense"]]


@pytest.mark.parametrize("code, args", [(c, a) for c, list_of in ((0, DONE), (1, FAILED), (2, USAGE)) for a in list_of],
                         ids=lambda v: " ".join(map(str, v)) if isinstance(v, list) else str(v))
def test_exit_codes(code, args, tmp_path):
    done = restage(*args, cwd=tmp_path)
    assert done.returncode == code, done.stdout + done.stderr
    assert bool(done.stderr.strip()) == (code != 0) or code == 0


def test_exit_codes_are_said_where_they_are_looked_for():
    said = restage("--help").stdout
    for words in ("0 done", "1 failed", "2 invalid command line", "128 + N stopped by signal N"):
        assert words in said and words in (ROOT / "README.md").read_text()
