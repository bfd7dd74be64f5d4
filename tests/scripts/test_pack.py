# SPDX-License-Identifier: Apache-2.0
"""restage pack: the bundled room in a zip file and in a folder, opened elsewhere. Needs RESTAGE_BIN."""
import json
import os
import pathlib
import shutil
import subprocess
import zipfile

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))


def restage(*args):
    return subprocess.run([RESTAGE, *map(str, args)], capture_output=True, text=True, timeout=300)


def contents(scene):
    """What `restage info` says, but for places."""
    info = json.loads(restage("info", scene, "--json").stdout)
    assert info["missing"] == []
    return {key: value for key, value in info.items() if key not in ("report", "report_counts", "missing")}


@pytest.fixture
def copy(tmp_path):
    shutil.copytree(ROOT / "scenes/demo", tmp_path / "original/demo")
    return tmp_path / "original/demo/demo.pbrt"


@pytest.mark.parametrize("out", ["room.zip", "room"])
def test_a_packed_scene_opens_elsewhere(copy, tmp_path, out):
    before = contents(copy)
    done = restage("pack", copy, "-o", tmp_path / out)
    assert done.returncode == 0 and "written" in done.stderr and "warning" not in done.stderr
    if out.endswith(".zip"):  # as other programs read it, too
        with zipfile.ZipFile(tmp_path / out) as archive:
            assert archive.testzip() is None and "room.restage" in archive.namelist()
    shutil.rmtree(tmp_path / "original")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / out).rename(tmp_path / "elsewhere" / out)
    moved = tmp_path / "elsewhere" / out
    assert contents(moved if moved.is_file() else moved / "room.restage") == before
    assert (tmp_path / "elsewhere/room/room.restage").is_file()


def test_zip_files_of_other_programs_are_read(copy, tmp_path):
    assert restage("pack", copy, "-o", tmp_path / "room").returncode == 0
    shutil.make_archive(str(tmp_path / "other"), "zip", tmp_path / "room")
    assert contents(tmp_path / "other.zip") == contents(tmp_path / "room/room.restage")


def test_nothing_is_packed_over_other_files(copy, tmp_path):
    done = restage("pack", copy, "-o", copy.parent)
    assert done.returncode == 1 and "is not an empty folder" in done.stderr
