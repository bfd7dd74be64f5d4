# SPDX-License-Identifier: Apache-2.0
"""FLIP and the other numbers of `restage compare` against their authors' program (flip-evaluator) and numpy."""
import json
import os
import pathlib
import subprocess

import flip_evaluator
import numpy as np
import pytest

RESTAGE = pathlib.Path(os.environ.get("RESTAGE_BIN", pathlib.Path(__file__).resolve().parents[2] / "build/bin/restage"))


def write_pfm(path, image):
    height, width, _ = image.shape
    path.write_bytes(f"PF\n{width} {height}\n-1.0\n".encode() + image[::-1].astype("<f4").tobytes())


def compare(*arguments):
    done = subprocess.run([RESTAGE, "compare", "--json", *arguments], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def smooth(image, times):
    for _ in range(times):
        image = (image + np.roll(image, 1, 0) + np.roll(image, 1, 1) + np.roll(image, -1, 0) + np.roll(image, -1, 1)) / 5
    return image


def pictures():
    """Pairs (test, reference), linear: noise, edges, hue shifts, over-range values, sizes smaller than the filters."""
    random = np.random.default_rng(7)
    y, x = np.mgrid[0:90, 0:120]
    scene = np.stack([0.5 + 0.5 * np.sin(x / 9), 0.5 + 0.5 * np.cos(y / 7), (x + y) / 210], -1)
    edges = np.where(((x // 20 + y // 15) % 2)[..., None] == 1, [0.8, 0.6, 0.1], [0.05, 0.1, 0.3])
    lights = smooth(random.random((64, 80, 3)) ** 8, 2) * 20
    yield "noise", np.abs(scene + random.normal(0, 0.2, scene.shape)), scene
    yield "blurred edges", smooth(edges, 6), edges
    yield "shifted edges", np.roll(edges, 1, 1), edges
    yield "hue", scene[..., ::-1], scene
    yield "slightly darker", scene * 0.98, scene
    yield "over range", lights * random.random((64, 80, 1)) * 2, lights
    yield "tiny", random.random((3, 5, 3)), random.random((3, 5, 3))


@pytest.mark.parametrize("name,test,reference", list(pictures()), ids=lambda v: v if isinstance(v, str) else "")
def test_flip_is_the_authors(tmp_path, name, test, reference):
    test, reference = test.astype(np.float32), reference.astype(np.float32)
    write_pfm(tmp_path / "a.pfm", test)
    write_pfm(tmp_path / "b.pfm", reference)
    ours = compare(tmp_path / "a.pfm", tmp_path / "b.pfm")
    shown = [np.ascontiguousarray(np.clip(image, 0, 1)) for image in (reference, test)]
    theirs = flip_evaluator.evaluate(*shown, "LDR", inputsRGB=False, applyMagma=False)[1]
    assert ours["flip"] == pytest.approx(theirs, abs=1e-3)
    assert ours["flip"] > 0.002  # every pair differs visibly

    a, b = test.astype(np.float64), reference.astype(np.float64)
    assert ours["rmse"] == pytest.approx(np.sqrt(((a - b) ** 2).mean()), rel=1e-6)
    assert ours["rel_mse"] == pytest.approx(((a - b) ** 2 / (b**2 + 0.01)).mean(), rel=1e-6)
    assert ours["mean_a"] == pytest.approx(a.mean((0, 1)).tolist(), rel=1e-6)
    assert ours["luminance_b"] == pytest.approx(b.mean((0, 1)) @ [0.2126, 0.7152, 0.0722], rel=1e-6)


def test_exit_codes(tmp_path):
    write_pfm(tmp_path / "a.pfm", np.ones((2, 2, 3), np.float32))

    def run(*arguments):
        return subprocess.run([RESTAGE, "compare", *arguments], capture_output=True, text=True)

    missing = run(tmp_path / "a.pfm", tmp_path / "absent.pfm")
    assert missing.returncode == 1
    assert "absent.pfm" in missing.stderr and not missing.stdout
    assert run(tmp_path / "a.pfm").returncode == 2
    assert run("--no-such-option").returncode == 2
    assert run("--help").returncode == 0
    same = run(tmp_path / "a.pfm", tmp_path / "a.pfm", "--diff", tmp_path / "d.png")
    assert same.returncode == 0 and "FLIP    0.0" in same.stdout and not same.stderr
    assert (tmp_path / "d.png").read_bytes().startswith(b"\x89PNG")
