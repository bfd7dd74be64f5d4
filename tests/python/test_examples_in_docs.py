# SPDX-License-Identifier: Apache-2.0
"""The Python code in docstrings and documents runs: blocks of code, and calls within sentences."""
import pathlib
import re
import shutil
import textwrap

import numpy as np
import pytest

import restage

ROOT = pathlib.Path(__file__).resolve().parents[2]
QUICK = [("size=(640, 360), samples=64", "size=(64, 36), samples=1"), ("samples=1024, parts=16, size=(640, 360)", "samples=2, parts=2, size=(32, 18)"),
         ("range(500)", "range(2)")]


def blocks(text):
    """Indented paragraphs after an empty line."""
    text = textwrap.dedent(text.split("\n", 1)[-1]) if "\n" in text else text
    return [textwrap.dedent(m.group(0)) for m in re.finditer(r"(?:^ {4}.*\n|^\n(?= {4}))+", text + "\n", re.M)]


def shown():
    for owner in (restage, restage.Bsdf, restage.spread):
        for i, block in enumerate(blocks(owner.__doc__)):
            yield pytest.param(block, id=f"{owner.__name__}-{i}")
    for page in sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), *ROOT.glob("python/**/*.md"), *ROOT.glob("plugins/**/*.md")]):
        for i, block in enumerate(re.findall(r"```python\n(.*?)```", page.read_text(), re.S)):
            yield pytest.param(block, id=f"{page.relative_to(ROOT)}-{i}")


@pytest.mark.parametrize("code", list(shown()))
def test_a_block_of_code_runs(code, tmp_path, monkeypatch):
    if "spread" in code:
        pytest.importorskip("ray", reason="ray is not installed")
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ROOT / "scenes/demo", tmp_path / "demo")
    for long, short in QUICK:
        code = code.replace(long, short)
    exec(code.replace('"room.pbrt"', '"demo/demo.pbrt"'),
         {"restage": restage, "np": np, "wo": (0, 0, 1), "u": np.full((2, 3), 0.4), "make_frame": lambda i: i})


INLINE = [
    (restage.Session.add_material, 'add_material("Brass", "conductor", uroughness=0.2, vroughness=0.2)', "session."),
    (restage.Session.select, "select(a, b).move((1, 0, 0))", "session."),
    (restage.Session.export, 'export("a.pbrt", version="v3")', "session."),
    (restage.Session.step, 'with session.step("Restyle"): ', ""),
    (restage.Objects.match, '"Chair*"', "objects.match"),
    (restage.Material, 'm["roughness"] = 0.2', ""),
    (restage.Texture, 't["uscale"] = 2.0', ""),
    (restage.Material.keys, "dict(m)", ""),
    (restage.check, 'check(plugin, seed=report.seed)', "restage."),
]


@pytest.mark.parametrize("owner, example, before", INLINE, ids=[example for _, example, _ in INLINE])
def test_a_call_in_a_sentence_runs(owner, example, before, tmp_path, monkeypatch):
    text = owner.__doc__ + (restage.checking.CheckReport.__doc__ or "") + pathlib.Path(restage.checking.__file__).read_text()
    assert example.strip().rstrip(":") in text
    monkeypatch.chdir(tmp_path)
    with restage.open(restage.bundled_scene("demo")) as session:
        names = {"session": session, "objects": session.objects, "a": session.objects[0], "b": session.objects[1],
                 "m": session.add_material("Coat", "principled"), "t": session.add_texture(np.zeros((2, 2, 3))), "restage": restage}
        if owner is restage.check:
            names |= {"plugin": "diffuse", "report": restage.check("diffuse", only="names")}
            example = example.replace("seed=", 'only="names", seed=')
        code = f"{before}({example})" if before == "objects.match" else before + example
        exec(code + ("pass" if code.rstrip().endswith(":") else ""), names)
