# SPDX-License-Identifier: Apache-2.0
"""The package restage of the build under test, next to the program."""
import os
import pathlib
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ.get("RESTAGE_BIN", ROOT / "build/bin/restage")).resolve()
PACKAGES = BIN.parents[1] / "lib/python"
sys.path.insert(0, str(PACKAGES))


if not (PACKAGES / "restage").is_dir():
    raise pytest.UsageError(f"{PACKAGES}/restage is missing: build the target restage_python_stub, or set RESTAGE_BIN")


@pytest.fixture(scope="session")
def program():
    return BIN


@pytest.fixture
def scenes():
    return ROOT / "scenes"


@pytest.fixture
def cornell(scenes):
    import restage

    with restage.open(scenes / "cornell/cornell.pbrt") as session:
        yield session


@pytest.fixture(scope="module")
def demo_document():
    """A shared demo scene for tests that undo their changes."""
    import restage

    with restage.open(ROOT / "scenes/demo/demo.pbrt") as session:
        yield session


@pytest.fixture
def demo(demo_document):
    before = len(demo_document.history)
    yield demo_document
    while len(demo_document.history) > before:
        demo_document.undo()
