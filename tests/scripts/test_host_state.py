# SPDX-License-Identifier: Apache-2.0
"""The host process's state must not matter: a locale with decimal commas, and child processes started at
any time. Nor may the assumptions of shader compilers, which may exclude NaN unless its bits are tested."""

import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
ALL = [p for folder in ("engine", "plugins", "app", "python", "shaders") for p in sorted((ROOT / folder).rglob("*"))]
NATIVE = [p for p in ALL if p.suffix in (".c", ".cpp", ".h", ".hpp")]
SHADERS = [p for p in ALL if p.suffix in (".glsl", ".comp", ".rgen", ".rchit", ".rahit", ".rmiss", ".rint")]


def found(pattern, paths):
    hits = []
    for path in paths:
        code = re.sub(r"//[^\n]*|/\*.*?\*/", "", path.read_text(), flags=re.S)
        hits += [f"{path.relative_to(ROOT)}: {m.group(0)}" for m in re.finditer(pattern, code)]
    return hits


def test_no_number_is_read_or_written_by_the_locale():
    """from_chars, to_chars and fmt ignore it. printf may print integers."""
    assert found(r"\b(?:strto(?:d|f|ld)|ato[f]|sto(?:d|f|ld))\s*\([^;]*;", NATIVE) == []
    assert found(r"\bsscanf\s*\([^;]*%l?[aefg][^;]*;", NATIVE) == []
    calls = [hit for hit in found(r"printf\s*\([^;]*;", NATIVE) if re.search(r"%[-+ #0-9*]*(?:\.[0-9*]+)?l?[aefgEFG]", hit)]
    assert [c for c in calls if re.findall(r"%[-+ #0-9*]*(?:\.[0-9*]+)?l?[aefgEFG]", c) != re.findall(r"%[-+ #0-9*]*\.0l?f", c)] == []


def test_descriptors_are_closed_in_children():
    assert found(r"\bmkstemp\s*\(|\bpopen\s*\(", NATIVE) == []
    assert [hit for hit in found(r"[^_]\bfopen\s*\([^;]*;", NATIVE) if not re.search(r'e"|_WIN32', hit) and '"wb")' not in hit] == []
    assert [hit for hit in found(r"::open(?:at)?\s*\([^;]*O_[^;]*;", NATIVE) if "O_CLOEXEC" not in hit] == []


def test_shaders_test_the_bits_of_possible_nans():
    """Without SignedZeroInfNanPreserve, isnan(x) is false and !(x > 0.0) is x <= 0.0 (see shaders/restage/v1/numbers.glsl)."""
    assert found(r"\bis(?:nan|inf)\s*\(", SHADERS) == []
    assert found(r"!\((?:[^()&|]|\([^()]*\))*[<>]=?[^()&|]*\)", SHADERS) == []
