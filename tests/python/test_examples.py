# SPDX-License-Identifier: Apache-2.0
"""The data-set example: complete, reproducible, resumable, and without overlapping objects."""
import json
import pathlib
import sys

import numpy as np
import pytest

import restage

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python/examples"))
import room_variations as example


def make(folder, count, *more):
    example.main(["-o", str(folder), "--count", str(count), "--size", "48x27", "--samples", "1", "--no-denoise", *more])


def test_variations_are_complete_deterministic_and_resumable(tmp_path, capsys):
    make(tmp_path / "a", 2)
    assert sorted(p.name for p in (tmp_path / "a").iterdir()) == [
        f"{i:04}.{kind}" for i in range(2) for kind in ("exr", "json", "npz", "png")]
    first, second = (json.loads((tmp_path / f"a/000{i}.json").read_text()) for i in range(2))
    assert first["changes"] != second["changes"] and set(first["changes"]) == {"materials", "layout", "sky", "camera"}
    data = np.load(tmp_path / "a/0001.npz")
    counts = np.bincount(data["label"].ravel(), minlength=len(second["things"]) + 1)[1:]
    assert data["label"].shape == (27, 48) and counts.tolist() == [t["pixels"] for t in second["things"]]
    names = {t["name"] for t in second["things"] if t["pixels"]}
    assert {"Back wall", "Floor", "Table"} <= names
    assert ((data["label"] > 0) == (data["depth"] > 0)).mean() > 0.95

    (tmp_path / "a/0001.json").unlink()  # as if it had been interrupted
    before = (tmp_path / "a/0000.json").stat().st_mtime_ns
    capsys.readouterr()
    make(tmp_path / "a", 2)
    assert "1 made, 1 existed" in capsys.readouterr().out
    assert (tmp_path / "a/0000.json").stat().st_mtime_ns == before
    assert json.loads((tmp_path / "a/0001.json").read_text()) == second
    assert np.array_equal(np.load(tmp_path / "a/0001.npz")["label"], data["label"])
    make(tmp_path / "b", 1, "--seed", "2")
    assert json.loads((tmp_path / "b/0000.json").read_text())["changes"] != first["changes"]


@pytest.mark.parametrize("index", range(4))
def test_moved_chairs_stand_free(demo, index):
    with demo.step("vary"):
        changes = example.vary(demo, np.random.default_rng([1, index]))
    moved = [demo.groups[name] for name in changes["layout"] if changes["layout"][name] != "removed"]
    for thing in moved:
        mine = {o.id for o in thing.objects}
        for other in moved:
            if other != thing:
                assert not any(example.overlaps(a.bounds, b.bounds, gap=0) for a in thing.objects for b in other.objects)
        table = [o.bounds for o in demo.find("Table").objects]
        assert not any(example.overlaps(o.bounds, t, gap=0) for o in thing.objects for t in table), (thing, mine)


def test_boxes():
    a = np.array([[0, 0, 0], [1, 1, 1.0]])
    assert example.overlaps(a, a + 0.5) and not example.overlaps(a, a + (1.5, 0, 0))
    assert example.overlaps(a, a + (1.005, 0, 0)) and not example.overlaps(a, a + (1.005, 0, 0), gap=0)


def test_the_readme_example_runs(tmp_path, monkeypatch):
    readme = (pathlib.Path(__file__).resolve().parents[2] / "README.md").read_text()
    code = readme.split("```python\n")[1].split("```")[0]
    assert "restage.open" in code and "size=(640, 360), samples=64" in code
    monkeypatch.chdir(tmp_path)
    shown = {}
    exec(code.replace("size=(640, 360), samples=64", "size=(64, 36), samples=1"), shown)
    assert shown["picture"].color.shape == (36, 64, 3) and (tmp_path / "room.png").exists()
