# SPDX-License-Identifier: Apache-2.0
"""Type checkers: the documented use passes, wrong use does not."""
import importlib.util
import os
import pathlib
import subprocess
import sys

import pytest

import typed_use
from conftest import PACKAGES

HERE = pathlib.Path(__file__).resolve().parent
mypy = pytest.mark.skipif(importlib.util.find_spec("mypy") is None, reason="mypy is not installed (tools/python.txt)")


def check(file, cache):
    # Strict except for untyped parts of a stub (`**values`, plain `os.PathLike`); of the package only the stub is checked.
    options = ["--strict", "--allow-any-generics", "--allow-incomplete-defs", "--allow-untyped-defs", "--follow-imports", "silent"]
    return subprocess.run([sys.executable, "-m", "mypy", *options, "--cache-dir", str(cache), str(file)], capture_output=True, text=True,
                          cwd=cache, env={**os.environ, "MYPYPATH": str(PACKAGES)})


def test_the_typed_use_runs(tmp_path):
    typed_use.use(tmp_path)
    assert (tmp_path / "picture.png").exists() and (tmp_path / "out.pbrt").exists()


@mypy
def test_mypy_accepts_what_is_shown(tmp_path):
    done = check(HERE / "typed_use.py", tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


@mypy
def test_mypy_refuses_what_is_wrong(tmp_path):
    wrong = ['session.render(sampels=4)', 'session.render(size=3)', 'session.objects[0].move()', 'session.camera = 3', 'session.find(3)',
             'session.crop = "all"', 'session.objects[1.5]', 'restage.merge(3)', 'session.nothing', 'restage.open(3)']
    (tmp_path / "wrong.py").write_text("import restage\nsession = restage.new()\n" + "\n".join(wrong) + "\n")
    done = check(tmp_path / "wrong.py", tmp_path)
    refused = {int(line.split(":")[1]) for line in done.stdout.splitlines() if ": error:" in line}
    assert refused == set(range(3, 3 + len(wrong))), done.stdout
