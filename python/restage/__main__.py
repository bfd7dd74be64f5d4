# SPDX-License-Identifier: Apache-2.0
"""python -m restage: the program, as `restage` on the command line."""
import os
import sys

from . import _program


def main() -> None:
    program = str(_program())
    os.environ.setdefault("RESTAGE_PYTHON", sys.executable)  # for `restage bench`
    if os.name == "posix":
        os.execv(program, [program, *sys.argv[1:]])
    import subprocess

    sys.exit(subprocess.run([program, *sys.argv[1:]]).returncode)


if __name__ == "__main__":
    main()
