# SPDX-License-Identifier: Apache-2.0
"""The package restage of the build under test, and a folder per test in which its scenes are written."""
import os
import pathlib
import sys

import pytest

HERE = pathlib.Path(__file__).resolve().parent
BIN = pathlib.Path(os.environ.get("RESTAGE_BIN", HERE.parents[1] / "build/bin/restage")).resolve()
PACKAGES = BIN.parents[1] / "lib/python"
sys.path.insert(0, str(PACKAGES))
if not (PACKAGES / "restage").is_dir():
    raise pytest.UsageError(f"{PACKAGES}/restage is missing: build the target restage_python_stub, or set RESTAGE_BIN")


@pytest.fixture
def stage(tmp_path):
    import stage
    return stage.Stage(tmp_path)
