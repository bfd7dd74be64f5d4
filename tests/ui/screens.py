#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A screenshot of every panel and dialog of the editor, in the states that matter, for visual inspection:

    RESTAGE_BIN=build/bin/restage build/venv/bin/python tests/ui/screens.py OUT [--size 1600x1000] [--scale 2] [--theme light] [STATE ...]

Without states all of them; `--list` names them. Widgets are found by their marks (desk.py), so it is a test of those, too:
it exits with 1 if a state could not be reached."""
import argparse
import os
import pathlib
import sys
import tempfile

import screens_files  # noqa: F401: they fill `states`
import screens_inspector  # noqa: F401
import screens_panels  # noqa: F401
import screens_scene  # noqa: F401
from desk import Desk
from screens_base import ROOT, Screens, states


def main():
    parse = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parse.add_argument("out", type=pathlib.Path, nargs="?")
    parse.add_argument("states", nargs="*")
    parse.add_argument("--size", default="1280x720")
    parse.add_argument("--scale", type=float, default=1)
    parse.add_argument("--theme", choices=["dark", "light"], default="dark")
    parse.add_argument("--jpeg", action="store_true", help="for docs/images/editor: named with dashes")
    parse.add_argument("--list", action="store_true")
    given = parse.parse_intermixed_args()
    if given.list or not given.out:
        print("\n".join(states))
        return 0
    unknown = set(given.states) - set(states)
    assert not unknown, f"no such state: {', '.join(sorted(unknown))}"
    size = tuple(int(v) for v in given.size.split("x"))
    binary = pathlib.Path(os.environ.get("RESTAGE_BIN", ROOT / "build/bin/restage"))
    given.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        desk = Desk(pathlib.Path(folder) / "desk", size)
        screens = Screens(desk, binary, given.out, size, given.scale, given.theme, given.jpeg, folder)
        try:
            screens.run([name for name in states if not given.states or name in given.states])
        finally:
            screens.stop()
            desk.close()
    return 1 if screens.failed else 0


if __name__ == "__main__":
    sys.exit(main())
