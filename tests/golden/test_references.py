# SPDX-License-Identifier: Apache-2.0
"""Eleven public scenes against pbrt-v4's pictures of them, and pbrt-v3 files against v4 ones.

Needs RESTAGE_SCENES and RESTAGE_REFERENCES; without the first, tools/test reports these as left out; if it is set, a
missing file fails. Tolerances are for few samples; docs/accuracy.md has the figures at 256 samples and explains the exceptions.
"""
import json
import os
import pathlib

import pytest

import references

SCENES = ("coffee cornell-box dining-room kitchen living-room material-testball staircase2 teapot-full veach-bidir "
          "veach-mis water-caustic").split()
V3 = ["coffee", "cornell-box", "kitchen", "living-room", "material-testball", "teapot-full", "veach-mis"]
RESTAGE = os.environ.get("RESTAGE_BIN", str(references.ROOT / "build/bin/restage"))

# Mean luminance [%] and percentage of 8x8 blocks with |z| < 3.
LIMITS = {name: (2.0, 95.0) for name in SCENES}
# RGB against spectra (docs/accuracy.md); with --spectral they agree, see below. Measured at 24 samples: 92.2, 87.7, 89.8.
LIMITS["coffee"] = (3.5, 90.0)       # saturated orange under a coat
LIMITS["cornell-box"] = (2.0, 84.0)  # between red and green walls
LIMITS["material-testball"] = (2.0, 87.0)  # by up to 0.4 % a channel
LIMITS["veach-bidir"] = (6.0, 85.0)  # light that is hard to find: noise not estimated with few samples
LIMITS["water-caustic"] = (2.0, 85.0)  # saturated walls in RGB

pytestmark = pytest.mark.skipif("RESTAGE_SCENES" not in os.environ, reason="RESTAGE_SCENES is not set")


def table(tmp_path, monkeypatch, names, *options):
    monkeypatch.setattr("sys.argv", ["references.py", "--restage", RESTAGE, "--out", str(tmp_path), *options, *names])
    assert references.main() == 0
    return {row["scene"]: row for row in json.loads((tmp_path / "references.json").read_text())}


@pytest.mark.parametrize("name", SCENES)
def test_scene_against_its_reference(name, tmp_path, monkeypatch):
    row = table(tmp_path, monkeypatch, [name], "--spp", "24")[name]
    luminance, blocks = LIMITS[name]
    assert abs(row["luminance_percent"]) < luminance
    assert 100 * row["z_test"]["share_passing"] > blocks


# Mean of each channel [%] and percentage of blocks, at 64 samples; docs/accuracy.md has 256.
@pytest.mark.parametrize("name", ["coffee", "cornell-box", "material-testball"])
def test_spectral_scene_against_its_reference(name, tmp_path, monkeypatch):
    row = table(tmp_path, monkeypatch, [name], "--spp", "64", "--spectral")[name]
    assert max(abs(x) for x in row["channel_percent"]) < 0.8
    assert 100 * row["z_test"]["share_passing"] > 96.0


def test_spectral_caustics_against_their_reference(tmp_path, monkeypatch):
    row = table(tmp_path, monkeypatch, ["water-caustic"], "--spp", "24", "--spectral")["water-caustic"]
    assert abs(row["luminance_percent"]) < 1.0  # measured: +0.2, and 96.0
    assert 100 * row["z_test"]["share_passing"] > 95.0


@pytest.mark.parametrize("name", V3)
def test_v3_file_agrees_with_v4(name, tmp_path, monkeypatch):
    assert (pathlib.Path(os.environ["RESTAGE_SCENES"]) / name / "scene-v3.pbrt").exists()
    row = table(tmp_path, monkeypatch, [name], "--spp", "16", "--v3")[f"{name}-v3"]
    assert abs(row["luminance_percent"]) < V3_LIMITS.get(name, 5.0)


# Scenes whose v3 file differs from the v4 one, with the reason (docs/accuracy.md).
V3_LIMITS = {
    "coffee": 30.0,            # v3 substrate: no light is lost under the coat
    "material-testball": 60.0, # the v3 file has a plain grey floor where the v4 one has a checkerboard
}
