# SPDX-License-Identifier: Apache-2.0
"""One-feature pbrt-v4 scenes against pbrt-v4's pictures: each agrees, or a line of its import report says what is approximated.

Needs RESTAGE_CASES; without it tools/test reports this as left out; if it is set, a missing file fails. docs/pbrt.md has
the table.
"""
import os
import pathlib

import pytest

pytestmark = pytest.mark.skipif("RESTAGE_CASES" not in os.environ, reason="RESTAGE_CASES is not set")


def test_every_feature_agrees_or_is_reported():
    import features
    rows = features.run(samples=16, show=lambda line: None)
    assert len(rows) > 140
    unreported = [f"{r['name']}: luminance {r['luminance']:+.2f} % +- {r['sigma']:.2f}, blocks {100 * r['blocks']:.0f} %"
                  for r in rows if not features.agrees(r) and not r["said"]]
    assert unreported == []


def test_missing_pictures_are_an_error(tmp_path):
    import features
    (tmp_path / "a.1.exr").write_bytes(b"")
    with pytest.raises(FileNotFoundError, match=r"a\.pbrt"):
        features.scenes(tmp_path)


def test_comparison_sees_one_percent_and_forgives_noise():
    import features
    import numpy as np
    rng = np.random.default_rng(1)
    truth = rng.uniform(0.2, 1, (64, 64, 1)) * np.ones(3)
    noisy = [truth + rng.normal(0, 0.02, (64, 64, 1)) for _ in range(3)]
    error = np.full((64, 64), 0.02)
    row = dict(zip(("luminance", "sigma", "blocks"), features.compare(noisy[0], error, noisy[1:])))
    assert features.agrees(row) and row["sigma"] < 0.1
    bright = dict(zip(("luminance", "sigma", "blocks"), features.compare(1.01 * noisy[0], error, noisy[1:])))
    assert not features.agrees(bright)
    local = noisy[0].copy()
    local[8:24, 8:40] *= 1.2  # 8 of 64 blocks
    local *= truth.mean() / local.mean()
    assert not features.agrees(dict(zip(("luminance", "sigma", "blocks"), features.compare(local, error, noisy[1:]))))
