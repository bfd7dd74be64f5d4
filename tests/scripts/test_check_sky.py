# SPDX-License-Identifier: Apache-2.0
"""`restage check` of skies: shipped and correct ones pass, and each violation is found."""
import json
import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = pathlib.Path(os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))).resolve()
BROKEN = RESTAGE.parent.parent / "tests/plugins_broken"
STEPS = ["sky", "sky-params", "sky-stop", "sky-runs"]


def check(folder, *args):
    done = subprocess.run([RESTAGE, "check", folder, "--quick", "--json", "-", *map(str, args)], capture_output=True,
                          text=True, timeout=300)
    assert done.stdout, done.stderr
    return done.returncode, {s["step"]: s for s in json.loads(done.stdout)[0]["steps"]}


def folder_of(folder, case):
    folder.mkdir()
    shutil.copy(BROKEN / f"sky_{case}.so", folder / "broken.so")
    (folder / "plugin.json").write_text(json.dumps({
        "id": "org.example.broken", "provides": ["restage.sky/1"], "version": "1.0.0", "needs": {"host": ">=0.2"},
        "licence": "MIT", "library": "broken", "files": []}))
    return folder


def test_the_shipped_skies_pass():
    for folder in sorted((RESTAGE.parent.parent / "lib/restage/plugins").glob("sky-*")):
        code, steps = check(folder)
        assert code == 0 and all(s["verdict"] == "pass" for s in steps.values()), steps
        assert all(step in steps for step in STEPS)


def test_a_sound_one_passes(tmp_path):
    code, steps = check(folder_of(tmp_path / "plugin", "sound"))
    assert code == 0 and all(s["verdict"] == "pass" for s in steps.values()), steps
    assert [s for s in steps if s in STEPS] == STEPS


@pytest.mark.parametrize("case, step, says", [
    ("nan", "sky", ["texel (", "is nan"]),
    ("negative", "sky", ["texel (", "is -"]),
    ("varies", "sky", ["the same values give two different skies"]),
    ("sun", "sky", ["a sun's direction (", "is not a unit vector"]),
    ("overruns", "sky", ["writes past the end of its picture"]),
    ("silent", "sky", ["failed without giving a reason", "level="]),
    ("crashes", "sky", ["crashed: SIGSEGV", "make() of 1x1 texels", "a bug in make()"]),
    ("idle", "sky-params", ["no effect anywhere in the range of: tilt"]),
    ("deaf", "sky-stop", ["after progress() returned 0, it was called"]),
    ("leaks", "sky-runs", ["bytes allocated"]),
])
def test_a_violation_is_found(case, step, says, tmp_path):
    code, steps = check(folder_of(tmp_path / "plugin", case), "--only", step)
    assert code == 1 and steps[step]["verdict"] == "fail", steps
    for words in says:
        assert words in steps[step]["text"] + "\n" + steps[step]["cause"]
