# SPDX-License-Identifier: Apache-2.0
"""The table of biased switches: its statistics, and that a limit darkens a picture."""
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/bench"))
import bias  # noqa: E402


def test_differences_are_in_percent_with_their_error():
    mean, error = bias.difference([(1.01, 1.0), (2.06, 2.0)])
    assert mean == pytest.approx(2.0) and error == pytest.approx(1.0)
    row = {s: (0.5, 0.01) for s in bias.SWITCHES}
    text = bias.table({"room": row}, bias.SWITCHES)
    assert text.count("\n") == 2 and text.splitlines()[2].count("+0.50 ± 0.01") == len(bias.SWITCHES)


def test_a_limit_darkens_and_a_render_like_the_reference_does_not():
    switches = {"limit": lambda mean: ["--clamp-indirect", str(0.1 * mean)], "none": lambda mean: []}
    row = bias.measure(ROOT / "scenes/cornell/cornell.pbrt", switches, "16x12", 4, 2)
    assert row["limit"][0] < -5 and row["none"] == (0, 0)
