# SPDX-License-Identifier: Apache-2.0
"""Include rules: every #include of the engine, the program and the plugins is checked against CMake's link lists."""
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENGINE = ROOT / "engine"
MODULES = sorted(p.parent.name for p in ENGINE.glob("*/CMakeLists.txt"))
SOURCES = {".cpp", ".hpp", ".c", ".h"}


def declared(module):
    """The modules in DEPENDS of engine/<module>/CMakeLists.txt."""
    text = (ENGINE / module / "CMakeLists.txt").read_text()
    found = re.search(r"DEPENDS([a-z\s]*)", text)
    return found.group(1).split() if found else []


def visible(module):
    """The modules it may include: itself, its dependencies and theirs."""
    seen, todo = {module}, declared(module)
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += declared(name) if name != "sdk" else []
    return seen


def includes(folder):
    """(file, line number, included path) of every #include below a folder."""
    for path in sorted(folder.rglob("*")):
        if path.suffix in SOURCES:
            for number, line in enumerate(path.read_text().splitlines(), 1):
                found = re.match(r'\s*#\s*include\s*[<"]([^>"]+)[>"]', line)
                if found:
                    yield path.relative_to(ROOT), number, found.group(1)


def test_dependencies_are_those_of_the_design():
    assert {m: set(declared(m)) for m in MODULES} == {
        "base": set(), "model": set(), "plugin": {"sdk", "base", "model"}, "scene": {"base", "model"}, "io": {"plugin", "scene"},
        "gpu": {"base"}, "render": {"gpu", "scene", "plugin"}, "query": {"scene"}, "document": {"io", "query"}, "view": {"io", "render"},
        "check": {"document", "render"},
    }


def test_the_sdk_is_included_by_the_adapters_alone():
    """The engine has its own model; a revision of an interface affects one adapter in plugin/ or io/."""
    wrong = [f"{path}:{line}: includes {name}" for folder in (*(ENGINE / m for m in MODULES), ROOT / "app", ROOT / "python")
             for path, line, name in includes(folder)
             if name.startswith("restage/") and name.endswith(".h") and folder.name not in ("plugin", "io")]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("module", MODULES)
def test_modules_include_only_what_they_depend_on(module):
    wrong = []
    for path, line, name in includes(ENGINE / module):
        first = "sdk" if name.startswith("restage/") else name.split("/")[0]
        if first in {*MODULES, "sdk"} and "/" in name and first not in visible(module):
            wrong.append(f"{path}:{line}: includes {name}, but {module} may only see {', '.join(sorted(visible(module)))}")
    assert not wrong, "\n".join(wrong)


def test_window_and_vulkan_headers_stay_where_they_belong():
    wrong = []
    for module in MODULES:
        for path, line, name in includes(ENGINE / module):
            if re.match(r"imgui|GLFW/|ImGuizmo|implot", name):
                wrong.append(f"{path}:{line}: {name}: windows and widgets belong to app")
            if re.match(r"vulkan/|volk|vk_mem_alloc", name) and module not in {"gpu", "render"}:
                wrong.append(f"{path}:{line}: {name}: Vulkan belongs to gpu and render")
            if re.match(r"dlfcn|windows\.h", name) and module not in {"plugin", "base"}:
                wrong.append(f"{path}:{line}: {name}: shared libraries belong to plugin")
    assert not wrong, "\n".join(wrong)


def test_plugins_see_nothing_of_the_engine():
    wrong = [f"{path}:{line}: {name}" for path, line, name in includes(ROOT / "plugins")
             if "/" in name and name.split("/")[0] in MODULES]
    assert not wrong, "\n".join(wrong)


def test_the_engine_names_no_concrete_plugin():
    plugins = [p.parent.name for p in (ROOT / "plugins").glob("*/*/CMakeLists.txt")]
    wrong = [f"{path}:{line}: {name}" for module in MODULES for path, line, name in includes(ENGINE / module)
             if any(part in plugins for part in pathlib.PurePath(name).parts[:-1])]
    assert not wrong, "\n".join(wrong)


# The levels of app/editor/contexts.hpp, and the members of each: a file that takes one uses a member of it, or calls
# something that takes it.
LEVELS = {
    "PanelUi": "notices preferences panel_state files options log mark",
    "DocumentContext": "session scene registry camera_id scene_camera film_aspect up document original opened_camera",
    "EditContext": "edit later change end_gesture run action_state open insert show_modal",
    "SelectContext": "selection hovered locked pick_tool material_clipboard copied views camera",
}
# Panels that need the picture itself. Others may only pass it to a callback: std::function<void(PanelContext&)>.
WHOLE = {"panels.cpp", "panels.hpp", "assets_panel.cpp"}


def functions_taking(level, text):
    return re.findall(rf"(\w+)\((?:const )?{level}& ", text)


def test_panels_take_the_least_of_the_context_that_they_use():
    editor = ROOT / "app/editor"
    declared = "\n".join(p.read_text() for p in editor.rglob("*.hpp") if p.name != "contexts.hpp")
    wrong = []
    for path in sorted((editor / "panels").glob("*.cpp")):
        text = path.read_text()
        if path.name not in WHOLE and re.search(r"PanelContext& \w", text):
            wrong.append(f"{path.name}: takes all of PanelContext: name the parts it uses (contexts.hpp)")
        for function, level, name, body in re.findall(
                r"^[\w:<>&\* ]*?\b(\w+)\((?:const )?(\w+Context|PanelUi)& (\w+)[^;{]*\{\n(.*?)^\}", text, re.M | re.S):
            if level not in LEVELS:
                continue
            uses = {m for m in re.findall(rf"\b{name}\.(\w+)", body)} | {m for m in re.findall(rf"\b{name}\.\w+\(\)\.(\w+)", body)}
            hands_on = {f for at in (declared, text) for f in functions_taking(level, at)} - {function}
            calls = set(re.findall(rf"\b(\w+)\((?:{name}\b|\{{\.editor = {name})", body)) & hands_on
            if not uses & set(LEVELS[level].split()) and not calls and f".editor = {name}" not in body:
                wrong.append(f"{path.name}: {function}() takes {level} and uses nothing of it: a lower level suffices")
    assert not wrong, "\n".join(wrong)
