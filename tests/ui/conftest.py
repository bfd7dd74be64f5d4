# SPDX-License-Identifier: Apache-2.0
"""Fixtures of the tests that use the editor like a user."""
import os
import pathlib

import pytest

from desk import Desk, Editor

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def binary():
    path = pathlib.Path(os.environ.get("RESTAGE_BIN", ROOT / "build/bin/restage"))
    assert path.exists(), f"{path} is not built; run tools/build or set RESTAGE_BIN"
    return path


@pytest.fixture(scope="session")
def desk(tmp_path_factory):
    desk = Desk(tmp_path_factory.mktemp("desk"))
    yield desk
    desk.close()


@pytest.fixture
def launch(desk, binary, tmp_path):
    """launch(*arguments) starts an editor with its own configuration folder; it ends with the test."""
    running = []

    def start(*arguments, config=None, **more):
        editor = Editor(desk, binary, *arguments, config=config or tmp_path / "config",
                        probe=tmp_path / f"probe{len(running)}.json", **more)
        running.append(editor)
        return editor

    yield start
    for editor in running:
        editor.close()
