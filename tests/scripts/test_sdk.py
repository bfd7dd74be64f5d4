# SPDX-License-Identifier: Apache-2.0
"""The SDK from a third party's view: Restage is installed, plugins are written by `restage new-plugin`, built outside of the
tree against the installation, checked and rendered. And a crashing plugin does the program little harm."""

import json
import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

RESTAGE = Path(os.environ["RESTAGE_BIN"]).resolve() if "RESTAGE_BIN" in os.environ else None
pytestmark = pytest.mark.skipif(RESTAGE is None, reason="RESTAGE_BIN names no program")
SOURCE = Path(__file__).resolve().parents[2]


def run(*command, ok=True, cwd=None, env=None):
    done = subprocess.run(
        [str(c) for c in command], capture_output=True, text=True, cwd=cwd, env={**os.environ, **(env or {})}, timeout=300
    )
    if ok:
        assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done


@pytest.fixture(scope="session")
def installed(tmp_path_factory):
    """The prefix Restage was installed to."""
    prefix = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", RESTAGE.parents[1], "--prefix", prefix)
    return prefix


def build(folder, prefix, kind="material"):
    run("cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release")
    run("cmake", "--build", folder / "build")
    return folder / "build" / "lib" / "restage" / "plugins" / f"{kind}-{folder.name}"


def picture(restage, plugins, scene, out):
    run(restage, "-q", "--plugin-path", plugins, "render", scene, "-o", out, "--spp", "4", "--size", "60x50")
    return out.read_bytes()


def test_plugins_from_the_templates(installed, tmp_path):
    """JSON, C and C++: each loads, passes the checker and renders the same ball."""
    restage = installed / "bin" / "restage"
    pictures = {}
    for language in ("json", "c", "cpp"):
        home = tmp_path / language
        home.mkdir()
        run(restage, "new-plugin", "velours", "--language", language, "--label", "Velours", cwd=home)
        folder = home / "velours"
        assert "Velours" in (folder / "README.md").read_text()
        assert not [f for f in folder.iterdir() if "@" in f.read_text()], "a placeholder was left"
        plugin = folder if language == "json" else build(folder, installed)
        done = run(restage, "check", plugin, "--quick")
        assert "velours" in done.stdout
        pictures[language] = picture(restage, plugin, folder / "scene.pbrt", home / "ball.png")
    assert pictures["json"] == pictures["c"] == pictures["cpp"]
    # The material itself is visible, with its parameters, not a placeholder.
    scene = tmp_path / "json" / "velours" / "scene.pbrt"
    info = json.loads(run(restage, "--plugin-path", tmp_path / "json", "info", scene, "--json").stdout)
    assert info["materials"]["velours"] == 1 and not info["materials_without_plugin"]
    assert info["report_counts"]["dropped"] == info["report_counts"]["approximated"] == 0


def test_textures_from_the_templates(installed, tmp_path):
    """JSON and C: each loads, passes the checker, with its native code if any, and renders the same scene."""
    restage = installed / "bin" / "restage"
    pictures = {}
    for language in ("json", "c"):
        home = tmp_path / language
        home.mkdir()
        run(restage, "new-plugin", "slats", "--kind", "texture", "--language", language, "--label", "Slats", cwd=home)
        folder = home / "slats"
        assert not [f for f in folder.iterdir() if "@" in f.read_text()], "a placeholder was left"
        plugin = folder if language == "json" else build(folder, installed, "texture")
        done = run(restage, "check", plugin, "--quick")
        assert "pass  texture-params" in done.stdout
        assert ("pass  texture-native" in done.stdout) == (language == "c")
        scene = folder / "scene.pbrt"
        info = json.loads(run(restage, "--plugin-path", plugin, "info", scene, "--json").stdout)
        assert info["report_counts"]["dropped"] == info["report_counts"]["approximated"] == 0
        pictures[language] = picture(restage, plugin, scene, home / "scene.png")
        (home / "none").mkdir()
        assert pictures[language] != picture(restage, home / "none", scene, home / "without.png"), "it shows nothing"
    assert pictures["json"] == pictures["c"]


def test_new_plugin_refuses(installed, tmp_path):
    restage = installed / "bin" / "restage"

    def said(*arguments):
        done = run(restage, "new-plugin", *arguments, ok=False, cwd=tmp_path)
        assert done.returncode == 1
        return done.stderr

    for name in ("Velvet", "9x", "a-b", "float", "x_", "a__b", "material"):
        assert "cannot be the name of a material" in said(name)
    assert 'the material "diffuse" exists already' in said("diffuse")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file").write_text("mine")
    assert "exists already and is not empty" in said("velours", "--folder", "full")
    assert (tmp_path / "full" / "file").read_text() == "mine"
    assert "full/file: exists already and is not a folder" in said("velours", "--folder", "full/file")
    assert "--label: quotes, backslashes" in said("velours", "--label", 'So "soft"')
    assert '"nonsense" is not in reverse-DNS form' in said("velours", "--id", "nonsense")
    assert 'the importer "pbrt" exists already' in said("pbrt", "--kind", "importer")
    assert 'the denoiser "oidn" exists already' in said("oidn", "--kind", "denoiser")
    assert "an exporter is written in cpp" in said("soup", "--kind", "exporter", "--language", "json")
    assert '"no-dash" cannot be the name of an importer' in said("no-dash", "--kind", "importer")
    assert [p.name for p in tmp_path.iterdir()] == ["full"], "a failed command leaves nothing behind"
    unknown = run(restage, "new-plugin", "x", "--kind", "nonsense", ok=False, cwd=tmp_path)
    assert unknown.returncode != 0 and "importer" in unknown.stderr


def test_the_tutorial(installed, tmp_path):
    """docs/plugins.md, literally: performs the steps of the page, and checks their results."""
    restage = installed / "bin" / "restage"
    text = (SOURCE / "docs" / "plugins.md").read_text()
    text, _, kinds = text.partition("\n## The other kinds\n")
    blocks = re.findall(r"```(\w+)\n(.*?)```", text + kinds.split("### A texture\n")[1].split("\n### ")[0], re.S)
    row, ui, file_row, reader = (b for language, b in blocks if language == "c")
    glsl, stripes = (b for language, b in blocks if language == "glsl")
    run(restage, "new-plugin", "minnaert", "--language", "c", "--label", "Minnaert", cwd=tmp_path)
    folder = tmp_path / "minnaert"
    source = folder / "minnaert.c"
    table = source.read_text()
    table = table.replace("};\n\nstatic const RestageMaterial1", row + "};\n\nstatic const RestageMaterial1")
    source.write_text(table)
    (folder / "minnaert.glsl").write_text(glsl)
    plugin = build(folder, installed)
    failed = run(restage, "check", plugin, "--quick", ok=False)
    assert failed.returncode == 1 and "furnace" in failed.stdout  # still declared lossless
    table = table.replace(".flags = RESTAGE_MATERIAL_LOSSLESS", ".flags = 0")
    before, _, _ = table.partition("RESTAGE_PLUGIN(")
    source.write_text(before + ui)
    manifest = folder / "plugin.json"
    manifest.write_text(manifest.read_text().replace('"restage.material/1"', '"restage.material/1", "restage.inspector/1"'))
    cmake = folder / "CMakeLists.txt"
    cmake.write_text(cmake.read_text().replace("MANIFEST plugin.json)", "MANIFEST plugin.json LINK m)"))
    plugin = build(folder, installed)
    run(restage, "check", plugin, "--quick")
    assert picture(restage, plugin.parent, folder / "scene.pbrt", tmp_path / "ball.png")
    # A table from a file.
    (folder / "silk.dat").write_bytes(bytes(4 * 7))
    source.write_text(before.replace(row, row + file_row) + reader)
    manifest.write_text(manifest.read_text().replace("inspector", "table"))
    cmake.write_text(cmake.read_text().replace(" LINK m)", " FILES silk.dat)"))
    plugin = build(folder, installed)
    assert "parameters 3" in run(restage, "check", plugin, "--quick", "--only", "params").stdout
    (plugin / "silk.dat").unlink()
    (plugin / "silk.dat").write_bytes(bytes(3))
    failed = run(restage, "check", plugin, "--quick", "--only", "params", ok=False)
    assert failed.returncode == 1 and "silk.dat: is not a list of floats" in failed.stdout
    # A texture.
    texture = tmp_path / "stripes"
    texture.mkdir()
    (manifest,) = (b for language, b in blocks if language == "json" and "org.example.texture.stripes" in b)
    (texture / "plugin.json").write_text(manifest)
    (texture / "stripes.glsl").write_text(stripes)
    run(restage, "check", texture, "--quick")


def section(heading):
    """Of docs/plugins.md: the line that makes the plugin, and the blocks of code."""
    text = (SOURCE / "docs" / "plugins.md").read_text()
    text = text.split(f"\n### {heading}\n")[1].split("\n## ")[0].split("\n### ")[0]
    (make,) = re.findall(r"^    restage (new-plugin .*)$", text, re.M)
    return shlex.split(make), re.findall(r"```c(?:pp)?\n(.*?)```", text, re.S)


def made(installed, tmp_path, heading):
    """The initial plugin of a tutorial, built and checked."""
    make, blocks = section(heading)
    run(installed / "bin" / "restage", *make, cwd=tmp_path)
    folder, kind = tmp_path / make[1], make[make.index("--kind") + 1]
    files = [f for f in folder.rglob("*") if f.is_file()]
    assert not [f for f in files if "@" in f.read_text() or "NAME" in f.name], "a placeholder was left"
    plugin = build(folder, installed, kind)
    run(installed / "bin" / "restage", "check", plugin)
    return folder, plugin, blocks


def change(source, before, after):
    text = source.read_text()
    assert text.count(before) == 1, before
    source.write_text(text.replace(before, after))


def test_the_importer_of_the_tutorial(installed, tmp_path):
    restage = installed / "bin" / "restage"
    folder, plugin, (lamp,) = made(installed, tmp_path, "An importer")
    sample = folder / "samples" / "pyramid.tris"

    def info():
        return json.loads(run(restage, "--plugin-path", plugin.parent, "info", sample, "--json").stdout)

    assert info()["objects"] == 2 and info()["lights"]["point"] == 0
    change(folder / "tris.cpp", "        // Further keywords go here.\n", lamp)
    sample.write_text(sample.read_text() + "lamp 2 -2 3 40\nnonsense 1\n")
    build(folder, installed, "importer")
    run(restage, "check", plugin, "--quick")
    assert info()["lights"]["point"] == 1
    assert info()["report_counts"]["dropped"] == 1
    sample.write_text(sample.read_text() + "lamp 2\n")
    refused = run(restage, "--plugin-path", plugin.parent, "info", sample, ok=False)
    assert refused.returncode == 1 and "pyramid.tris:24:1: expected: lamp X Y Z INTENSITY" in refused.stderr


def test_the_exporter_of_the_tutorial(installed, tmp_path):
    restage = installed / "bin" / "restage"
    folder, plugin, (row, options) = made(installed, tmp_path, "An exporter")
    cornell = SOURCE / "scenes" / "cornell" / "cornell.pbrt"

    def extent(*arguments):
        run(restage, "--plugin-path", plugin.parent, "convert", cornell, tmp_path / "out.soup", *arguments)
        lines = (tmp_path / "out.soup").read_text().splitlines()
        assert sum(line.startswith("o ") for line in lines) > 3 and sum(line.startswith("f ") for line in lines) > 10
        return max(float(word) for line in lines if line.startswith("v ") for word in line.split()[1:])

    before = extent("--set", "hidden=true")
    source = folder / "soup.cpp"
    change(source, "};\n\n// The values of the table", row + "};\n\n// The values of the table")
    text = source.read_text()
    source.write_text(text[: text.index("struct Options")] + options + text[text.index("\nclass Writing") :])
    change(source, "number(m[row] * p[0] + m[row + 4] * p[1] + m[row + 8] * p[2] + m[row + 12]);",
           "number(options_.scale * (m[row] * p[0] + m[row + 4] * p[1] + m[row + 8] * p[2] + m[row + 12]));")
    build(folder, installed, "exporter")
    run(restage, "check", plugin, "--quick")
    assert extent("--set", "scale=0.25") == pytest.approx(before / 4, rel=1e-5)


def test_the_denoiser_of_the_tutorial(installed, tmp_path):
    restage = installed / "bin" / "restage"
    folder, plugin, (radius,) = made(installed, tmp_path, "A denoiser")
    cornell = SOURCE / "scenes" / "cornell" / "cornell.pbrt"

    def denoised(quality):
        out = tmp_path / f"{quality}.png"
        run(restage, "-q", "--plugin-path", plugin.parent, "render", cornell, "-o", out, "--spp", "4", "--size", "32x32",
            "--denoise", quality, "--denoiser", "smooth")
        return out.read_bytes()

    assert denoised("fast") == denoised("high")
    change(folder / "smooth.c", "    const int radius = 3;\n", radius)
    build(folder, installed, "denoiser")
    run(restage, "check", plugin, "--quick")
    assert denoised("fast") != denoised("high")


@pytest.fixture
def crashing(tmp_path):
    """A home with a plugin that ends the program when it is loaded."""
    built = RESTAGE.parents[1] / "tests" / "plugins_bad" / "crashes.so"
    folder = tmp_path / "data" / "restage" / "plugins" / "velvet"
    folder.mkdir(parents=True)
    shutil.copy(built, folder / "velvet.so")
    (folder / "velvet.glsl").write_text("// empty")
    (folder / "plugin.json").write_text(
        json.dumps(
            {
                "id": "org.example.velvet",
                "provides": ["restage.material/1"],
                "version": "1.0.0",
                "licence": "MIT",
                "needs": {"host": ">=0.2"},
                "library": "velvet",
            }
        )
    )
    return {"XDG_DATA_HOME": str(tmp_path / "data")}


def test_a_plugin_that_crashed_is_left_out_and_named(crashing):
    assert run(RESTAGE, "--safe-mode", "plugins", env=crashing).stdout.count("REFUSED") == 0
    assert run(RESTAGE, "plugins", ok=False, env=crashing).returncode == -6  # SIGABRT
    listed = run(RESTAGE, "plugins", env=crashing).stdout
    assert "it crashed (SIGABRT) while it was being loaded" in listed
    assert "restage plugins --enable org.example.velvet" in listed
    entry = next(
        p for p in json.loads(run(RESTAGE, "plugins", "--json", env=crashing).stdout) if p["id"] == "org.example.velvet"
    )
    assert entry["quarantined"] and not entry["loaded"]
    # Everything else still works.
    run(RESTAGE, "-q", "info", SOURCE / "scenes" / "demo" / "demo.pbrt", env=crashing)
    run(RESTAGE, "plugins", "--enable", "org.example.velvet", env=crashing)
    assert run(RESTAGE, "plugins", ok=False, env=crashing).returncode == -6
