# SPDX-License-Identifier: Apache-2.0
"""`restage check`: every shipped plugin passes, and plugins with one fault each are caught, with the right message."""
import json
import os
import pathlib
import shutil
import subprocess
import xml.etree.ElementTree as xml

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = pathlib.Path(os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))).resolve()
BROKEN = RESTAGE.parent.parent / "tests/plugins_broken"


ADDED = {  # faults that are an extra line
    "prefix": "float helper(float x) { return x; }",
    "binding": "layout(binding = 0) uniform sampler2D broken_picture;",
    "library": '#include "lib/microfacet.glsl"',
    "outside": '#include "../other/secret.glsl"',
    "engine": "#include <path/surface.glsl>",
    "newer": "#include <restage/v2/bsdf.glsl>",
    "extension": "#extension GL_EXT_buffer_reference : require",
    "builtin": "uint broken_who() { return gl_GlobalInvocationID.x; }",
    "scene": "float broken_peek(uint64_t at) { return FloatArray(at).at[0]; }",
    "texture": "vec3 broken_look(vec2 uv) { SceneData scene; return texture_eval(scene, 0u, uv); }",
    "three": "vec3 broken_copy(broken_Params m) { return m.tint; }",
    "rgb": "Spectrum broken_copy(broken_Params m) { return m.tint.rgb; }",
    "both": "Spectrum broken_copy(broken_Params m) { return max(m.tint, spectrum_from_rgb(vec3(1, 0, 0)) / average(wavelengths())); }",
    "syntax": "float broken_typo(float x) { return x + y; }",
}


def check(*args, timeout=120):
    return subprocess.run([RESTAGE, "check", *map(str, args)], capture_output=True, text=True, timeout=timeout)


def plugins():
    done = subprocess.run([RESTAGE, "--quiet", "plugins", "--json"], capture_output=True, text=True, timeout=60)
    return [p["id"] for p in json.loads(done.stdout)] if done.returncode == 0 else []


def broken(folder, library="sound", fault=None, **manifest):
    """A folder with the rough metal of tests/plugins_broken, with one fault."""
    folder.mkdir(exist_ok=True)
    shutil.copy(BROKEN / f"{library}.so", folder / "broken.so")
    text = (BROKEN / "broken.glsl").read_text()
    if fault in ADDED:
        text = ADDED[fault] + "\n" + text
    elif fault:
        text = f"#define broken_{fault} 1\n" + text
    (folder / "broken.glsl").write_text(text)
    (folder / "plugin.json").write_text(json.dumps({
        "id": "org.example.broken", "provides": ["restage.material/1"], "version": "1.0.0", "needs": {"host": ">=0.2"}, "licence": "MIT", "library": "broken",
        "files": ["broken.glsl"], **manifest}))
    return folder


def failures(folder, *args):
    """Exit code, and the text of each failed step."""
    done = check(folder, "--quick", "--json", "-", *args)
    assert done.stdout, done.stderr
    steps = json.loads(done.stdout)[0]["steps"]
    return done.returncode, {s["step"]: s["text"] + "\n" + s["cause"] for s in steps if s["verdict"] == "fail"}


@pytest.mark.parametrize("name", plugins())
def test_every_plugin_passes(name):
    done = check(name, "--quick")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "passed: " in done.stdout and "FAIL" not in done.stdout


def test_there_are_plugins():
    assert len(plugins()) >= 15


def test_the_rough_metal_without_a_fault_passes(tmp_path):
    """The control for the tests below: they find the fault and nothing else."""
    code, failed = failures(broken(tmp_path / "plugin"))
    assert failed == {} and code == 0


@pytest.mark.parametrize("fault, step, says", [
    ("pdf_factor", "chi-square", ["samples do not follow pdf", "Jacobian"]),
    ("pdf_factor", "integral", ["pdf integrates to"]),
    ("missing_cosine", "reciprocity", ["f(wo, wi) is", "lacks the factor |cos wi|"]),
    ("grazing_gain", "energy", ["times the light that arrives leaves", "shadowing"]),
    ("nan_at_alpha_0", "sound", ["nan", "roughness=0"]),
    ("non_reciprocal", "reciprocity", ["f(wo, wi) is", "NONRECIPROCAL"]),
    ("back_side", "chi-square", ["samples do not follow pdf", "back side"]),
    ("prefix", "names", ["broken.glsl:1: \"helper\" does not start with the plugin's prefix \"broken_\""]),
    ("binding", "glsl", ["broken.glsl:1: \"layout\": a plugin's GLSL has no bindings"]),
    ("library", "glsl", ["broken.glsl:1: cannot include \"lib/microfacet.glsl\": write <restage/v1/microfacet.glsl>"]),
    ("outside", "glsl", ["broken.glsl:1: cannot include \"../other/secret.glsl\": a plugin's GLSL may include <restage/v1/...> and"]),
    ("engine", "glsl", ["broken.glsl:1: cannot include <path/surface.glsl>: a plugin's GLSL may include"]),
    ("newer", "glsl", ["broken.glsl:1: cannot include <restage/v2/bsdf.glsl>: write <restage/v1/bsdf.glsl>"]),
    ("extension", "glsl", ["broken.glsl:1: a plugin's GLSL cannot enable extensions"]),
    ("builtin", "glsl", ["broken.glsl:1: \"gl_GlobalInvocationID\": a plugin's GLSL has no"]),
    ("scene", "glsl", ["broken.glsl:1: 'FloatArray'", "nothing of the scene"]),
    ("texture", "glsl", ["broken.glsl:1: 'SceneData' : undeclared identifier", "nothing of the scene"]),
    ("three", "glsl", ["broken.glsl:1: 'return'", "in spectral mode"]),
    ("rgb", "glsl", ["broken.glsl:1: 'return'", "in spectral mode"]),
    ("syntax", "glsl", ["broken.glsl:1: 'y' : undeclared identifier"]),
])
def test_a_fault_in_glsl_is_found(tmp_path, fault, step, says):
    code, failed = failures(broken(tmp_path / "plugin", fault=fault), "--only", step)
    assert code == 1 and list(failed) == [step]
    for words in says:
        assert words in failed[step]


def test_a_material_that_asks_for_its_site_passes():
    done = check(ROOT / "tests" / "plugins_site" / "dots", "--quick")
    assert done.returncode == 0, done.stdout + done.stderr


def test_code_for_any_number_of_wavelengths_passes(tmp_path):
    code, failed = failures(broken(tmp_path / "plugin", fault="both"), "--only", "glsl")
    assert failed == {} and code == 0


@pytest.mark.parametrize("library, step, says", [
    ("small_size", "load", ["16 bytes", "rebuild it with this SDK"]),
    ("count_lies", "load", ["crashed: SIGSEGV", "misstates its size, its count or its pointers"]),
    ("crashes", "load", ["crashed: SIGSEGV", "init()"]),
    ("exits", "load", ["ended the program (exit code 3)", "never calls exit()"]),
    ("leaks", "reload", ["memory grew by", "shutdown() does not free"]),
])
def test_a_fault_in_native_code_is_found(tmp_path, library, step, says):
    code, failed = failures(broken(tmp_path / "plugin", library), "--only", "reload")
    assert code == 1 and list(failed) == [step]
    for words in says:
        assert words in failed[step]


@pytest.mark.parametrize("taken", [False, True])
def test_a_parameter_that_a_pbrt_file_cannot_give_back_is_found(tmp_path, taken):
    """A parameter whose id is the keyword that names the plugin in pbrt files; any other is the control."""
    (tmp_path / "grey.glsl").write_text("""#include <restage/v1/sampling.glsl>
Spectrum grey_eval(grey_Params m, vec3 wo, vec3 wi) { return Spectrum(same_hemisphere(wo, wi) ? abs(wi.z) * INV_PI * m.%s : 0.0); }
float grey_pdf(grey_Params m, vec3 wo, vec3 wi) { return same_hemisphere(wo, wi) ? abs(wi.z) * INV_PI : 0.0; }
BsdfSample grey_sample(grey_Params m, vec3 wo, vec3 u) { return BSDF_NONE; }
Spectrum grey_albedo(grey_Params m, vec3 wo) { return Spectrum(0.5); }
""" % ("plugin" if taken else "share"))
    (tmp_path / "plugin.json").write_text(json.dumps({
        "id": "org.example.grey", "provides": ["restage.material/1"], "version": "1.0.0", "needs": {"host": ">=0.2"}, "licence": "MIT", "files": ["grey.glsl"],
        "materials": [{"type": "grey", "label": "Grey", "prefix": "grey", "glsl": "grey.glsl", "tooltip": "Grey.", "params": [
            {"id": "plugin" if taken else "share", "label": "Share", "type": "float", "default": 0.5, "min": 0, "max": 1,
             "tooltip": "Of light."}]}]}))
    code, failed = failures(tmp_path, "--only", "params")
    assert (code, list(failed)) == ((1, ["params"]) if taken else (0, [])), failed
    assert not taken or "a pbrt file" in failed["params"]


def test_an_endless_loop_in_glsl_is_ended(tmp_path):
    code, failed = failures(broken(tmp_path / "plugin", fault="endless"), "--time-limit", 4)
    assert code == 1 and list(failed) == ["cost"]
    assert "no answer from the GPU within 4 s: an endless loop in its GLSL?" in failed["cost"]


def test_an_endless_loop_in_native_code_is_ended(tmp_path):
    code, failed = failures(broken(tmp_path / "plugin", "hangs"), "--time-limit", 1)
    assert code == 1 and "no answer from the plugin within 1 s" in failed["load"]


def test_a_plugins_output_is_not_mistaken_for_a_report(tmp_path):
    code, failed = failures(broken(tmp_path / "plugin", "talks"), "--only", "reload")
    assert code == 0 and failed == {}


def test_a_crash_of_one_does_not_keep_others_from_being_checked(tmp_path):
    done = check(broken(tmp_path / "a", "crashes"), broken(tmp_path / "b"), "--quick", "--only", "names",
                 "--junit", tmp_path / "junit.xml", "--markdown", tmp_path / "table.md")
    assert done.returncode == 1
    assert "FAIL  load" in done.stdout and "pass  names" in done.stdout
    suites = xml.parse(tmp_path / "junit.xml").getroot().findall("testsuite")
    assert [(s.get("failures"), s.get("tests")) for s in suites] == [("1", "1"), ("0", "2")]
    assert "SIGSEGV" in suites[0].find("testcase/failure").get("message")
    assert "**FAIL**" in (tmp_path / "table.md").read_text()


def test_a_declared_exception_has_its_limit(tmp_path):
    """The gain without shadowing: accepted up to the manifest's limit, with its reason; not beyond."""
    for limit, passes in ((1e9, True), (1.01, False)):
        folder = broken(tmp_path / "plugin", fault="grazing_gain",
                        exceptions=[{"step": "energy", "limit": limit, "why": "as in a paper"}])
        done = check(folder, "--quick", "--only", "energy")
        assert (done.returncode == 0) == passes, done.stdout
        assert ("as in a paper" in done.stdout) == passes


def test_a_failure_names_the_command_that_replays_it(tmp_path):
    folder = broken(tmp_path / "plugin", fault="non_reciprocal")
    texts = []
    for seed in (7, 7, 8):
        done = check(folder, "--quick", "--only", "reciprocity", "--seed", seed)
        assert f"again: restage check {folder} --only reciprocity --seed {seed} --quick" in done.stdout
        texts.append(done.stdout.split("FAIL")[1].split("again")[0])
    assert texts[0] == texts[1] != texts[2]


def test_missing_things_are_reported(tmp_path):
    (tmp_path / "empty").mkdir()
    for name, says in (("nosuchplugin", "no plugin has this id"), (tmp_path / "empty", "no plugin.json in this folder")):
        done = check(name, "--quick")
        assert done.returncode == 1 and says in done.stderr
    done = check("mirror", "--quick", "--only", "nosuchstep")
    assert done.returncode == 2 and '--only: "nosuchstep" is not one of' in done.stderr
