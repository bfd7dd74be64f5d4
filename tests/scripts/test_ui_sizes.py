# SPDX-License-Identifier: Apache-2.0
"""Sizes in the editor follow the scale of its text: no width, gap, rounding or thickness is a plain number of pixels."""
import pathlib
import re

import pytest

EDITOR = pathlib.Path(__file__).resolve().parents[2] / "app/editor"
# Calls that take lengths, and what makes a length follow the scale.
LENGTHS = re.compile(r"\b(SetNextItemWidth|Dummy|BeginChild|SetNextWindowSize\w*|TableSetupColumn|SameLine|Indent|InvisibleButton|"
                     r"PushTextWrapPos|AddLine|AddRect|AddRectFilled|AddCircle|AddCircleFilled)\(")
SCALED = re.compile(r"scale|FontScaleMain|GetFontSize|GetTextLineHeight|GetFrameHeight|GetStyle\(\)|FLT_M")
NUMBER = re.compile(r"(?<![\w.%])(\d+(?:\.\d*)?)f?(?![\w.])")
FACTOR = re.compile(r"[*/]\s*\d+(?:\.\d*)?f?\b|\b\d+(?:\.\d*)?f?\s*\*")


def calls(text):
    """(line, text between the parentheses) of each call that takes lengths."""
    for found in LENGTHS.finditer(text):
        depth, end = 1, found.end()
        while depth and end < len(text):
            depth += {"(": 1, ")": -1}.get(text[end], 0)
            end += 1
        yield text.count("\n", 0, found.start()) + 1, found.group(1), text[found.end():end - 1]


def plain_lengths(text):
    """Lines of calls with a length of 3 pixels or more that is not scaled; 0, 1 and 2 are flags, fractions and hair lines."""
    for line, name, inside in calls(text):
        bare = FACTOR.sub("", re.sub(r'"[^"]*"', "", inside))
        if name == "TableSetupColumn" and "WidthFixed" not in inside:  # weights
            continue
        if any(float(n) >= 3 for n in NUMBER.findall(bare)) and not SCALED.search(inside):
            yield line, inside


@pytest.mark.parametrize("line, wrong", [
    ("ImGui::SetNextItemWidth(120);", True), ("ImGui::SetNextItemWidth(120 * scale);", False),
    ("draw->AddRectFilled(a, b, color, 4);", True), ("draw->AddRectFilled(a, b, color, side * 0.15f);", False),
    ('ImGui::TableSetupColumn("what", 0, 6);', False), ('ImGui::BeginChild("list 200", {0, 0});', False)])
def test_the_check_itself(line, wrong):
    assert bool(list(plain_lengths(line))) == wrong


def test_lengths_are_scaled():
    wrong = [f"{path.name}:{line}: {inside}" for path in sorted(EDITOR.rglob("*.[ch]pp"))
             for line, inside in plain_lengths(path.read_text())]
    assert not wrong, "\n".join(wrong)
