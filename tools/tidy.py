# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy on the files a build tree compiles, those changed last first, until the time budget is used up.

A file whose preprocessed text, compile command and .clang-tidy passed before is not checked again (the record is in the
user's cache directory), so after a first full run only changes cost time.
"""
import argparse
import hashlib
import json
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

ROOT = pathlib.Path(__file__).resolve().parent.parent
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "restage" / "tidy"


def tracked_by_age():
    """Tracked sources, the most recently changed first."""
    log = subprocess.run(["git", "log", "--name-only", "--format="], cwd=ROOT, capture_output=True, text=True, check=True)
    recent = {name: rank for rank, name in reversed(list(enumerate(log.stdout.split("\n"))))}
    files = subprocess.run(["git", "ls-files", "*.cpp"], cwd=ROOT, capture_output=True, text=True, check=True)
    return sorted(files.stdout.split(), key=lambda name: recent.get(name, 0))


def fingerprint(command, directory):
    """Hash of everything the result depends on, or None if the file does not preprocess (then tidy reports why)."""
    # Without the compiler launcher, the output file and the dependency file; preprocess only.
    words = [w for w in shlex.split(command) if w != "-c" and not w.endswith("ccache")]
    if "-o" in words:
        at = words.index("-o")
        del words[at : at + 2]
    run = subprocess.run([*words, "-E", "-P"], cwd=directory, capture_output=True)
    if run.returncode != 0:
        return None
    text = run.stdout + (ROOT / ".clang-tidy").read_bytes() + " ".join(words[1:]).replace(str(ROOT), "").encode()
    return hashlib.sha256(text).hexdigest()


def check(tidy, build, name, command, directory):
    """-> (verdict, output); verdict is 'known', 'clean' or 'dirty'."""
    mark = fingerprint(command, directory)
    if mark and (CACHE / mark).exists():
        return "known", ""
    run = subprocess.run(  # the compiler's own warnings are left to the build
        [tidy, "--quiet", "-p", str(build), "--extra-arg=-Wno-unknown-warning-option", "--extra-arg=-Wno-error", str(ROOT / name)],
        cwd=ROOT, capture_output=True, text=True)
    if run.returncode != 0:
        return "dirty", run.stdout + run.stderr
    if mark:
        CACHE.mkdir(parents=True, exist_ok=True)
        (CACHE / mark).touch()
    return "clean", ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", default="build/release", help="build tree with compile_commands.json")
    parser.add_argument("--budget", type=float, default=0, help="start no file after this many seconds (0: no limit)")
    parser.add_argument("files", nargs="*", help="default: every tracked .cpp that the build compiles")
    args = parser.parse_args()

    tidy = shutil.which("clang-tidy-19") or shutil.which("clang-tidy")
    if not tidy:
        sys.exit("tidy: clang-tidy is missing; run tools/setup")
    build = (ROOT / args.build).resolve()
    database = build / "compile_commands.json"
    if not database.exists():
        sys.exit(f"tidy: {database} is missing; build first")
    for_clang = build / "tidy"  # the same commands without the flags that only GCC knows
    for_clang.mkdir(exist_ok=True)
    text = database.read_text().replace(" -fno-gnu-unique", "")
    (for_clang / "compile_commands.json").write_text(text)
    commands = {e["file"]: e for e in json.loads(text)}
    wanted = [str(pathlib.Path(f).resolve().relative_to(ROOT)) for f in args.files] or tracked_by_age()
    names = [n for n in wanted if str(ROOT / n) in commands]

    started = time.monotonic()
    counts = {"known": 0, "clean": 0, "dirty": 0, "left": 0}

    def job(name):
        if args.budget and time.monotonic() - started > args.budget:
            return "left", ""
        entry = commands[str(ROOT / name)]
        return check(tidy, for_clang, name, entry["command"], entry["directory"])

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for verdict, output in pool.map(job, names):
            counts[verdict] += 1
            if output:
                print(output, flush=True)
    print(f"clang-tidy: {counts['clean']} files clean, {counts['known']} unchanged since they were, "
          f"{counts['dirty']} with findings, {counts['left']} left for lack of time, {time.monotonic() - started:.0f} s")
    sys.exit(1 if counts["dirty"] else 0)


main()
