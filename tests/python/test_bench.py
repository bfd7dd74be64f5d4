# SPDX-License-Identifier: Apache-2.0
"""`restage bench`: errors, fits and bands in closed form; a tiny measurement, and the page that it writes."""
import html.parser
import json
import math
import os
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ET
import zlib

import numpy as np
import pytest

import restage
from restage.bench import __main__ as bench
from restage.bench import charts, errors, growth, page, renderers


def test_the_errors_leave_out_the_noise_of_the_reference():
    rng = np.random.default_rng(1)
    truth = np.full((128, 128, 3), 2.0)
    reference = errors.Reference([truth + rng.normal(0, 0.2, truth.shape) for _ in range(4)])
    expected = 0.1 ** 2 / (2 ** 2 + errors.EPSILON)
    assert math.isclose(reference.noise(), 0.2 ** 2 / 4 / (2 ** 2 + errors.EPSILON), rel_tol=0.1)
    whole, trimmed = reference.errors(truth + rng.normal(0, 0.1, truth.shape))
    assert math.isclose(whole, expected, rel_tol=0.15) and 0.8 * whole < trimmed < whole


def test_the_trimmed_error_leaves_out_a_firefly():
    reference = errors.Reference([np.ones((64, 64, 3))])
    picture = np.ones((64, 64, 3))
    picture[3, 5] = 1000
    whole, trimmed = reference.errors(picture)
    assert math.isclose(whole, 999 ** 2 / 1.01 / 4096, rel_tol=1e-9) and trimmed == 0 and reference.noise() == 0
    with pytest.raises(ValueError, match="32x16, the reference 64x64"):
        reference.errors(np.ones((16, 32, 3)))


def test_curves_are_medians_and_bands_the_range():
    runs = [{"samples": n, "seed": s, "cpu": n * (s + 1), "rel_mse": e / n} for n in (4, 1) for s, e in enumerate((5, 1, 2, 9, 3))]
    assert errors.curve(runs, "rel_mse") == [{"samples": 1, "cpu": 3, "error": 3, "low": 1, "high": 9},
                                             {"samples": 4, "cpu": 12, "error": 0.75, "low": 0.25, "high": 2.25}]


def test_slopes():
    x = np.array([1, 2, 4, 8])
    assert np.allclose(errors.slope(x, 3 * x ** -1.5), (-1.5, 0), atol=1e-12)
    p, se = errors.slope([1, math.e, math.e ** 2], [1, math.e ** 2, math.e])  # logarithms 0 2 1: slope 1/2, residuals -1/2 1 -1/2
    assert math.isclose(p, 0.5) and math.isclose(se, math.sqrt(1.5 / 1 / 2))
    assert math.isnan(errors.slope([1, 2], [1, 0])[0]) and math.isnan(errors.slope([1, 2], [1, 2])[1])


def test_time_to_an_error():
    points = [{"cpu": c, "error": 8 / c} for c in (1, 2, 4)]
    seconds, measured = errors.time_to(points, 8 / 3)
    assert math.isclose(seconds, 3) and measured
    seconds, measured = errors.time_to(points, 0.5)
    assert math.isclose(seconds, 16) and not measured
    assert errors.time_to([{"cpu": 1, "error": 1}, {"cpu": 2, "error": 1}], 0.5) is None


def test_pfm(tmp_path):
    picture = np.arange(2 * 3 * 3, dtype=np.float32).reshape(2, 3, 3)
    (tmp_path / "a.pfm").write_bytes(b"PF\n3 2\n-1\n" + picture[::-1].tobytes())
    assert (errors.read_pfm(tmp_path / "a.pfm") == picture).all()
    (tmp_path / "b.pfm").write_bytes(b"P6\n")
    with pytest.raises(ValueError, match="not a PFM"):
        errors.read_pfm(tmp_path / "b.pfm")


def test_png():
    data = page.png(np.array([[[0, 1, 0.5]], [[2, -1, math.nan]]]))
    at = data.index(b"IDAT")
    rows = zlib.decompress(data[at + 4:at + 4 + int.from_bytes(data[at - 4:at], "big")])
    assert list(rows) == [0, 0, 255, 188, 0, 255, 0, 0]


def test_rows_of_configurations(tmp_path):
    file = tmp_path / "rows.txt"
    file.write_text('# comment\n\ndefault:\na b: --guiding on --set "Wall.x=1 2"\nM: @mitsuba --sampler multijitter\n')
    assert renderers.read_rows(file) == [("default", "restage", []), ("a b", "restage", ["--guiding", "on", "--set", "Wall.x=1 2"]),
                                         ("M", "mitsuba", ["--sampler", "multijitter"])]
    for text, message in (("x\n", "rows.txt:1: a row is"), ("x: @blend\n", "no renderer @blend"), ("x:\nx:\n", "occurs twice"), ("#\n", "no rows")):
        file.write_text(text)
        with pytest.raises(ValueError, match=message):
            renderers.read_rows(file)
    assert renderers.read_rows(bench.HERE / "rows.txt")[0] == ("default", "restage", [])


def test_charts():
    svg = charts.chart("a < b", "x", "y", [("<one>", [{"x": 1, "y": 0.1, "low": 0.05, "high": 0.2}, {"x": 100, "y": 1e-6, "low": 5e-7, "high": 2e-6}]),
                                           ("two", [{"x": 1, "y": 0}])], (1e-5, "noise"))
    root = ET.fromstring(svg)
    texts = ["".join(t.itertext()) for t in root.iter("{http://www.w3.org/2000/svg}text")]
    assert {"a < b", "<one>", "two", "noise", "10⁻⁶"} <= set(texts) and len(list(root.iter("{http://www.w3.org/2000/svg}circle"))) == 2
    assert "prefers-color-scheme:dark" in svg and "nothing above zero" in charts.chart("t", "x", "y", [("a", [])])
    assert charts.ticks(3, 4000) == [10, 100, 1000] and charts.ticks(3, 7) == [5] or charts.ticks(3, 7) == [3, 4, 5, 6, 7]


@pytest.mark.parametrize("kind, size, count", [("triangles", 1000, 1), ("instances", 30, 31), ("lights", 9, 10), ("resolution", 32, 1), ("depth", 3, 1)])
def test_scenes_of_growth(tmp_path, kind, size, count):
    file, exact = growth.make(kind, size, tmp_path)
    assert abs(exact / size - 1) < 0.1
    with restage.open(file) as session:
        assert len(session.objects) == count and session.report.dropped == 0
        assert session.size == ((32, 32) if kind == "resolution" else (128, 128))


def test_memory_of_growth_is_the_programs_own(tmp_path):
    held = np.ones(100_000_000)  # 800 MB, which a child of this process has had before it becomes the program
    point = growth.measure_once(bench._program(), growth.make("depth", 1, tmp_path)[0], tmp_path, ())
    assert 20e6 < point["memory"] < 700e6 and held.any()


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.open, self.urls, self.selects, self.data, self.figures = [], [], 0, "", False
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        if tag not in ("meta", "img", "input", "path", "rect", "circle", "br"):
            self.open.append(tag)
        self.urls += [v for k, v in attrs.items() if k in ("src", "href", "data", "action", "xlink:href") and v]
        self.urls += [attrs["value"]] if tag == "option" else []
        self.selects += tag == "select"
        self.figures = attrs.get("id") == "figures"

    def handle_endtag(self, tag):
        if tag in self.open:
            assert self.open.pop() == tag
        self.figures = False

    def handle_data(self, data):
        self.data += data if self.figures else ""


def run(program, *arguments, **environment):
    return subprocess.run([str(program), "bench", *map(str, arguments)], capture_output=True, text=True,
                          env={**os.environ, "RESTAGE_PYTHON": sys.executable, **environment})


def test_a_tiny_measurement(program, tmp_path):
    rows = tmp_path / "rows.txt"
    rows.write_text("default:\nlight only: --strategy light\nnot there: @pbrt\n")
    done = run(program, "cornell", "-o", tmp_path / "page", "--size", "24x16", "--samples", 4, 2, "--seeds", 2, "--rows", rows, "--reference-spp", 64,
               "--reference-parts", 2, "--growth", "depth", "--budget", 0.1)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == str(tmp_path / "page/index.html") and "not there: left out" in done.stderr
    data = json.loads((tmp_path / "page/bench.json").read_text())
    scene = data["scenes"]["cornell"]
    assert (scene["width"], scene["height"], scene["seeds"]) == (24, 16, 2) and scene["reference_noise"] > 0
    assert [c["name"] for c in scene["configurations"]] == ["default", "light only"] and scene["configurations"][1]["options"] == ["--strategy", "light"]
    for c in scene["configurations"]:
        assert [(r["samples"], r["seed"]) for r in c["runs"]] == [(2, 0), (2, 1), (4, 0), (4, 1)]
        assert all(r["cpu"] > 0 and 0 < r["trimmed"] <= r["rel_mse"] * (1 + 1e-9) < 5 for r in c["runs"]), c["runs"]
        assert c["runs"][0]["rel_mse"] != c["runs"][1]["rel_mse"]
    point = data["growth"]["depth"][0]
    assert point["size"] == 1 and point["rays_per_second"] > 0 and point["memory"] > 1e6 and len(data["growth"]["depth"]) == 1
    text = (tmp_path / "page/index.html").read_text()
    parsed = Page(text)
    assert not parsed.open and json.loads(parsed.data) == data and parsed.selects == 2
    assert len(parsed.urls) == 3 and all(u.startswith("data:image/png;base64,") for u in parsed.urls)
    assert "url(" not in text and "@import" not in text and text.count("http") == text.count('xmlns="http://www.w3.org/2000/svg"')
    assert {p.name for p in (tmp_path / "page").glob("*.svg")} >= {"cornell-rel_mse-cpu.svg", "cornell-trimmed-samples.svg", "growth-depth-memory.svg"}


def test_a_given_reference(program, tmp_path):
    rows = tmp_path / "rows.txt"
    rows.write_text("one:\n")
    parts = []
    for seed in (7, 8):
        parts.append(tmp_path / f"{seed}.pfm")
        with restage.open(restage.bundled_scene("cornell")) as session:
            session.render(size=(16, 16), samples=8, seed=seed).save(parts[-1])
    done = run(program, "cornell", "-o", tmp_path / "page", "--size", "16x16", "--samples", 2, "--seeds", 1, "--rows", rows, "--reference", *parts)
    assert done.returncode == 0, done.stderr
    scene = json.loads((tmp_path / "page/bench.json").read_text())["scenes"]["cornell"]
    assert scene["reference"] == "2 given pictures" and scene["configurations"][0]["runs"][0]["rel_mse"] > 0


def test_mistakes_are_sentences(program, tmp_path):
    for arguments, message in ((["nowhere.pbrt"], "nowhere.pbrt"), ([], "a SCENE, or --growth, is needed"), (["cornell", "--size", "4"], "is not a size"),
                               (["cornell", "--samples", "1"], "at least 2")):
        done = run(program, *arguments, "-o", tmp_path)
        assert done.returncode != 0 and message in done.stderr and "Traceback" not in done.stderr
    done = run(program, "cornell", RESTAGE_PYTHON="/no/python")
    assert done.returncode == 1 and "/no/python: cannot be started" in done.stderr
    rows = tmp_path / "rows.txt"
    rows.write_text("wrong: --no-such-option 1\n")
    done = run(program, "cornell", "-o", tmp_path, "--size", "8x8", "--rows", rows, "--reference-spp", 8)
    assert done.returncode == 1 and "no-such-option" in done.stderr


@pytest.mark.parametrize("kind, options", [("mitsuba", "--sampler multijitter --variant scalar_rgb"), ("cycles", "")])
def test_peers(program, tmp_path, kind, options):
    """RESTAGE_MITSUBA_PYTHON and RESTAGE_CYCLES_PYTHON name other Pythons than this one."""
    python = renderers.python_with({"cycles": "bpy"}.get(kind, kind), os.environ.get(f"RESTAGE_{kind.upper()}_PYTHON"))
    if not python:
        pytest.skip(f"{kind} is not installed")
    rows = tmp_path / "rows.txt"
    rows.write_text(f"ours:\npeer: @{kind} {options}\n")
    done = run(program, "cornell", "-o", tmp_path / "page", "--size", "32x32", "--samples", 4, 16, "--seeds", 2, "--rows", rows, "--reference-spp", 256,
               f"--{kind}", python)
    assert done.returncode == 0, done.stderr
    ours, theirs = json.loads((tmp_path / "page/bench.json").read_text())["scenes"]["cornell"]["configurations"]
    assert theirs["renderer"] == kind and theirs["bias"] < 0.01 and all(r["cpu"] > 0 for r in theirs["runs"])
    assert errors.curve(theirs["runs"], "rel_mse")[1]["error"] < errors.curve(theirs["runs"], "rel_mse")[0]["error"]


def test_a_python_without_numpy_is_told_what_to_do():
    script = "import sys, runpy; sys.modules['numpy'] = None; runpy.run_module('restage.bench', run_name='__main__')"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(pathlib.Path(restage.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])}
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, env=environment)
    assert done.returncode == 1 and "needs numpy" in done.stderr and "RESTAGE_PYTHON" in done.stderr
