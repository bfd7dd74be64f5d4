# SPDX-License-Identifier: Apache-2.0
"""The scripts that measure where --error stops and what specialization saves."""
import pathlib
import sys

import numpy as np
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/bench"))
import needs  # noqa: E402
import stop  # noqa: E402

CORNELL = ROOT / "scenes/cornell/cornell.pbrt"


def test_the_true_error_is_the_relative_spread_of_pictures():
    light = np.full((8, 8), 0.99)
    light[:, 4:] = 9.99
    pictures = [light * (1 + sign * 0.1) + sign * 0.001 for sign in (-1, 1)]
    assert stop.true_error(pictures, light) == pytest.approx(0.1 * 2 ** 0.5)


def test_a_rendering_stops_near_the_error_asked_for():
    row, = stop.measure(CORNELL, "32x32", [24], 6)
    assert row["true"] / row["asked"] == pytest.approx(1, abs=0.35) and row["claimed"] <= row["asked"]
    assert all(16 <= n <= 48 for n in row["samples"]), row
    assert stop.table({"room": [row]}).count("\n") == 2


def test_features_that_a_scene_lacks_are_removed_and_change_no_picture():
    row = needs.measure(CORNELL, "32x32", 8, 1)
    assert row["all"]["machine"] > 1.3 * row["needed"]["machine"] > 0 and row["needed"]["kernels"] > 2
    assert row["z"] < 1.2 and row["needed"]["cpu"] > 0
    assert needs.table({"room": row}).count("\n") == 2


def test_equal_pictures_have_z_of_1():
    random = np.random.default_rng(3)
    a, b = ({**{c: random.normal(1, 0.1, (64, 64)) for c in "G"}, "R": np.ones((64, 64)), "B": np.ones((64, 64)), "stderr.Y": np.full((64, 64), 0.07152)}
            for _ in range(2))
    assert needs.rms_z(a, b) == pytest.approx(1, abs=0.05)
