# SPDX-License-Identifier: Apache-2.0
"""`restage check` of actions and panels: each step finds violations of its requirement."""
import json
import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = pathlib.Path(os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))).resolve()
BROKEN = RESTAGE.parent.parent / "tests/plugins_broken"


def steps_of(folder, case, *args):
    folder.mkdir()
    shutil.copy(BROKEN / f"{case}.so", folder / "broken.so")
    (folder / "plugin.json").write_text(json.dumps({
        "id": "org.example.broken", "provides": ["restage.action/1", "restage.panel/1"], "version": "1.0.0",
        "needs": {"host": ">=0.2"}, "licence": "MIT", "library": "broken"}))
    done = subprocess.run([RESTAGE, "check", folder, "--quick", "--json", "-", *args], capture_output=True, text=True,
                          timeout=120)
    assert done.stdout, done.stderr
    return done.returncode, {s["step"]: s for s in json.loads(done.stdout)[0]["steps"]}


def test_a_sound_one_passes(tmp_path):
    code, steps = steps_of(tmp_path / "plugin", "action_sound")
    assert code == 0 and all(s["verdict"] == "pass" for s in steps.values()), steps
    assert list(steps) == ["manifest", "load", "reload", "act", "act-stop", "act-leaks", "panel"]


@pytest.mark.parametrize("case, step, says", [
    ("action_crashes", "act", ["crashed: SIGSEGV", "run() on a scene with every kind of thing", "a bug in run()"]),
    ("action_silent", "act", ["run() returns 0, and error() was not called"]),
    ("action_varies", "act", ["two identical runs give different edits"]),
    ("action_unsound", "act", ["its edits are invalid"]),
    ("action_deaf_seed", "act", ['another "seed" gives the same edit']),
    ("action_throws", "act", ["threw an exception: no room on the stack"]),
    ("action_throws", "panel", ["draw() threw an exception: nothing to draw with"]),
    ("action_stubborn", "act-stop", ["after progress() returned 0, run() made", "more changes"]),
    ("action_leaks", "act-leaks", ["times runs leave", "bytes allocated"]),
    ("panel_range", "panel", ['set() of "copies": 21', "out of its range"]),
    ("panel_group", "panel", ["an open group"]),
    ("panel_id", "panel", ['run() names "stck", which is not an action of the plugin']),
])
def test_a_violation_is_found(case, step, says, tmp_path):
    code, steps = steps_of(tmp_path / "plugin", case, "--only", step)
    assert code == 1 and steps[step]["verdict"] == "fail", steps
    for words in says:
        assert words in steps[step]["text"] + "\n" + steps[step]["cause"]


def test_the_shipped_scatter_passes():
    done = subprocess.run([RESTAGE, "check", "org.restage.action.scatter", "--quick", "--json", "-"], capture_output=True,
                          text=True, timeout=240)
    steps = json.loads(done.stdout)[0]["steps"]
    assert done.returncode == 0 and all(s["verdict"] == "pass" for s in steps), steps
    act, stop = ({f["name"]: f["value"] for f in s["figures"]} for name in ("act", "act-stop") for s in steps if s["step"] == name)
    assert act["objects added by default, at most"] >= 100 and act["seeds compared"] >= 2, act  # its default count, over hills
    assert act["changed something"] >= 6 and stop["stopped"] > 40 and stop["calls of progress()"] > 100, (act, stop)
