# SPDX-License-Identifier: Apache-2.0
"""Unpacks the members of an sdist or wheel that match one of the patterns, without the archive's top folder.

usage: unpack.py ARCHIVE TARGET PATTERN...   (fnmatch patterns over member paths; '*' also matches '/')
A pattern that matches nothing is an error: the archive is not the one deps.lock expects.
"""
import fnmatch
import pathlib
import sys
import tarfile
import zipfile


def members(archive):
    """Yields (path, read) for each regular file; a tar's single top folder is cut off."""
    if zipfile.is_zipfile(archive):
        with zipfile.ZipFile(archive) as z:
            for info in z.infolist():
                if not info.is_dir():
                    yield info.filename, lambda info=info: z.read(info)
    else:
        with tarfile.open(archive) as t:
            for info in t:
                if info.isfile():
                    yield info.name.partition("/")[2], lambda info=info: t.extractfile(info).read()


def main(archive, target, *patterns):
    target = pathlib.Path(target).resolve()
    unused = set(patterns)
    for path, read in members(archive):
        hits = {p for p in patterns if fnmatch.fnmatchcase(path, p)}
        if not hits:
            continue
        unused -= hits
        out = (target / path).resolve()
        if not out.is_relative_to(target):
            sys.exit(f"unpack: {archive}: member {path} would leave {target}")
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_bytes(read())
    if unused:
        sys.exit(f"unpack: {archive}: no member matches {', '.join(sorted(unused))}")


main(*sys.argv[1:])
