# SPDX-License-Identifier: Apache-2.0
"""The version is in CMakeLists.txt only; everything else reads it from there."""

import json
import os
import pathlib
import re
import subprocess
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))
VERSION = re.search(r"project\(restage VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]


def test_the_program_says_it():
    assert subprocess.run([RESTAGE, "--version"], capture_output=True, text=True, check=True).stdout.split()[-1] == VERSION


def test_the_wheel_reads_it():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert "version" not in project["project"] and project["project"]["dynamic"] == ["version"]
    how = project["tool"]["scikit-build"]["metadata"]["version"]
    assert re.search(how["regex"], (ROOT / how["input"]).read_text())["value"] == VERSION


def test_no_other_file_writes_it():
    assert not any("version" in key for key in json.loads((ROOT / "vcpkg.json").read_text()) if key != "$schema")
    for path in ("app", "engine/base", "engine/plugin", "python"):
        for file in (ROOT / path).rglob("*"):
            if file.suffix in (".cpp", ".hpp", ".py", ".txt"):
                assert f'"{VERSION}"' not in re.sub(r"//.*", "", file.read_text()), file
