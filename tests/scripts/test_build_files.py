# SPDX-License-Identifier: Apache-2.0
"""A missing library's error names tools/setup, and parts that were not built do not stop an installation."""

import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parents[2]
FILES = [ROOT / "CMakeLists.txt", *sorted((ROOT / "cmake").glob("*.cmake"))]


def test_every_missing_dependency_names_tools_setup():
    for path in FILES:
        text = re.sub(r"#.*", "", path.read_text())
        for call in re.findall(r"\bfind_(?:package|path|library|program)\([^)]*\)", text):
            assert "REQUIRED" not in call, f"{path.name}: {call}: use restage_find_package or restage_find_path"
    text = (ROOT / "cmake" / "Deps.cmake").read_text()
    assert "tools/setup" in re.search(r'set\(RESTAGE_HOW_TO_GET "([^"]+)"', text)[1]
    for error in re.findall(r"FATAL_ERROR \"[^\"]*\"", text):
        assert "RESTAGE_HOW_TO_GET" in error, error


def test_an_installation_does_without_the_python_module():
    text = (ROOT / "python" / "CMakeLists.txt").read_text().split("return()")[-1]  # behind the wheel's part
    for rule in re.findall(r"install\((?:TARGETS|FILES)[^)]*\)", text):
        assert "OPTIONAL" in rule, rule


def test_a_wheel_compiles_no_tests():
    assert 'cmake.define.RESTAGE_BUILD_TESTS = "OFF"' in (ROOT / "pyproject.toml").read_text()
    imgui = (ROOT / "cmake" / "DepsImgui.cmake").read_text()
    engine = imgui.index("restage_imgui_library(imgui_test_engine")
    assert imgui.rindex("if(", 0, engine) == imgui.index("if(RESTAGE_BUILD_TESTS) # not needed in a wheel")
