# SPDX-License-Identifier: Apache-2.0
"""Missing or restricted folders: a temporary folder that forbids execution or is missing, an unwritable cache, no home. The
program works without them, and reports each loss in one line. A file in place of a folder stops root as well."""

import os
import pathlib
import shutil
import subprocess

import pytest

RESTAGE = pathlib.Path(os.environ["RESTAGE_BIN"]).resolve() if "RESTAGE_BIN" in os.environ else None
pytestmark = pytest.mark.skipif(RESTAGE is None, reason="RESTAGE_BIN names no program")
SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"
SPHERES = SCENES / "spheres" / "spheres.pbrt"


def run(*arguments, env=None, before=()):
    environment = {**os.environ, **(env or {})}
    done = subprocess.run(
        [*before, str(RESTAGE), *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=240,
        env={name: value for name, value in environment.items() if value is not None},
    )
    assert done.returncode == 0, done.stderr
    return done


def said(done, word):
    return [line for line in done.stderr.splitlines() if word in line]


@pytest.fixture
def blocked(tmp_path):
    (tmp_path / "blocked").write_text("no folder")
    return str(tmp_path / "blocked")


def render(tmp_path, **options):
    picture = tmp_path / "picture.exr"
    done = run("render", SPHERES, "--spp", "1", "--size", "16x16", "-o", picture, **options)
    assert picture.stat().st_size > 0
    return done


def test_rendering_without_home_and_cache(tmp_path):
    nothing = {name: None for name in ("HOME", "XDG_CACHE_HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME", "XDG_RUNTIME_DIR")}
    done = render(tmp_path, env=nothing)
    assert len(said(done, "recompiled at each start")) == 1, done.stderr


def test_rendering_with_a_cache_and_a_data_folder_that_cannot_be_made(tmp_path, blocked):
    # Keep the driver's own cache: without it this takes a minute.
    usual = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "restage" / "mesa"
    kept = os.environ.get("MESA_SHADER_CACHE_DIR", str(usual if usual.is_dir() else tmp_path))
    done = render(tmp_path, env={"XDG_CACHE_HOME": blocked, "XDG_DATA_HOME": blocked, "MESA_SHADER_CACHE_DIR": kept})
    assert len(said(done, "recompiled at each start")) == 1, done.stderr
    assert len(said(done, str(blocked))) == 1, done.stderr


def test_reading_without_a_temporary_folder(blocked):
    for before in ([], ["--isolate"]):
        done = run(*before, "info", SPHERES, env={"TMPDIR": blocked})
        assert done.stderr == run("info", SPHERES).stderr


def test_crashes_are_not_remembered_and_one_line_says_so(tmp_path, blocked):
    for name in ("one", "two"):
        run("new-plugin", name, "--language", "json", "--folder", tmp_path / "plugins" / name)
    done = run("--plugin-path", tmp_path / "plugins", "info", SPHERES, env={"XDG_DATA_HOME": blocked})
    assert len(said(done, "crashes of plugins will not be remembered")) == 1, done.stderr


def test_a_temporary_folder_that_forbids_execution(tmp_path):
    mount = f'mount -t tmpfs -o noexec none "{tmp_path}" && exec "$@"'
    if not shutil.which("unshare") or subprocess.run(["unshare", "-m", "sh", "-c", mount, "sh", "true"], capture_output=True).returncode:
        pytest.skip("this user cannot mount a folder")
    done = run("plugins", env={"TMPDIR": str(tmp_path)}, before=("unshare", "-m", "sh", "-c", mount, "sh"))
    assert "REFUSED" not in done.stdout and "material diffuse" in done.stdout, done.stdout
    assert "warning" not in done.stderr, done.stderr
