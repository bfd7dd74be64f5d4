# SPDX-License-Identifier: Apache-2.0
"""`restage check` finds light that sampling never reaches, invalid directions and undeclared anisotropy, and does not
fail a correct stochastic material."""
import json
import os
import pathlib
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESTAGE = pathlib.Path(os.environ.get("RESTAGE_BIN", str(ROOT / "build/bin/restage"))).resolve()

# Lambert's reflection; $NAME is replaced by each case.
LAMBERT = """#include <restage/v1/sampling.glsl>
Spectrum grey_eval(grey_Params m, vec3 wo, vec3 wi) { return $EVAL; }
float grey_pdf(grey_Params m, vec3 wo, vec3 wi) { return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs_cos(wi)) : 0.0; }
BsdfSample grey_sample(grey_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = cosine_hemisphere_pdf(wi.z);
    if (!(pdf > 0.0) || wo.z == 0.0)
        return BSDF_NONE;
    if (wo.z < 0.0)
        wi.z = -wi.z;
    $EXTRA
    return BsdfSample(wi, grey_eval(m, wo, wi) / pdf, pdf, BSDF_REFLECT, 1.0);
}
Spectrum grey_albedo(grey_Params m, vec3 wo) { return Spectrum(0.5 * m.share); }
"""
PLAIN = "Spectrum(same_hemisphere(wo, wi) ? 0.5 * m.share * INV_PI * abs_cos(wi) : 0.0)"

# A rough pane whose lobe transmits and whose share varies between evaluations; a coarse sum of pdf gets the sharp lobe
# wrong. $PDF multiplies the density that it states.
STOCHASTIC = """#include <restage/v1/sampling.glsl>
#include <restage/v1/microfacet.glsl>
#include <restage/v1/rng.glsl>
const float grey_delta = 0.35;
vec2 grey_alpha() { return vec2(0.03); }
float grey_density(vec3 o, vec3 i) { return (1.0 - grey_delta) * ggx_d(normalize(o + i), grey_alpha()) / (4.0 * ggx_sigma(o, grey_alpha())); }
Spectrum grey_eval(grey_Params m, vec3 wo, vec3 wi, inout Rng rng) {
    if (!(wo.z * wi.z < 0.0)) return Spectrum(0);
    vec3 o = vec3(wo.xy, abs(wo.z)), i = vec3(wi.xy, abs(wi.z));
    float lobe = ggx_d(normalize(o + i), grey_alpha()) * smith_visibility(o.z, ggx_sigma(o, grey_alpha()), i.z, ggx_sigma(i, grey_alpha())) * i.z * 0.25;
    return Spectrum(lobe * m.share * (0.5 + rng_next(rng)) * 0.6);
}
float grey_pdf(grey_Params m, vec3 wo, vec3 wi, inout Rng rng) {
    return wo.z * wi.z < 0.0 ? $PDF * grey_density(vec3(wo.xy, abs(wo.z)), vec3(wi.xy, abs(wi.z))) : 0.0;
}
BsdfSample grey_sample(grey_Params m, vec3 wo, vec3 u, inout Rng rng) {
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    vec3 o = vec3(wo.xy, abs(wo.z));
    if (o.z <= 0.0) return BSDF_NONE;
    if (u.z < grey_delta) return BsdfSample(vec3(-wo.xy, wo.z), Spectrum(0.3), grey_delta, BSDF_REFLECT | BSDF_DELTA, 1.0);
    vec3 h = ggx_sample(o, grey_alpha(), u.xy);
    vec3 i = 2.0 * dot(o, h) * h - o;
    if (i.z <= 0.0) return BSDF_NONE;
    float pdf = grey_density(o, i);
    if (!(pdf > 0.0)) return BSDF_NONE;
    vec3 wi = vec3(i.xy, -side * i.z);
    return BsdfSample(wi, grey_eval(m, wo, wi, rng) / pdf, pdf, BSDF_TRANSMIT, 1.0);
}
Spectrum grey_albedo(grey_Params m, vec3 wo) { return Spectrum(0.4); }
"""


def material(folder, glsl, flags):
    folder.mkdir(exist_ok=True)
    (folder / "grey.glsl").write_text(glsl)
    (folder / "plugin.json").write_text(json.dumps({
        "id": "org.example.grey", "provides": ["restage.material/1"], "version": "1.0.0", "needs": {"host": ">=0.2"}, "licence": "MIT", "files": ["grey.glsl"],
        "materials": [{"type": "grey", "label": "Grey", "prefix": "grey", "glsl": "grey.glsl", "tooltip": "Grey.", "flags": flags,
                       "params": [{"id": "share", "label": "Share", "type": "float", "default": 0.8, "min": 0.2, "max": 1,
                                   "tooltip": "Of light."}]}]}))
    return folder


def check(folder, *args):
    done = subprocess.run([RESTAGE, "check", folder, "--quick", "--json", "-", *map(str, args)], capture_output=True, text=True,
                          timeout=300)
    assert done.stdout, done.stderr
    return done.returncode, {s["step"]: s for s in json.loads(done.stdout)[0]["steps"]}


@pytest.mark.parametrize("fault, step, says", [
    (None, "reach", None),
    (None, "isotropy", None),
    ({"EVAL": "Spectrum(0.5 * m.share * INV_PI * abs_cos(wi))"}, "reach", ["transmitted 0.0000", "BSDF and light sampling"]),
    ({"EVAL": PLAIN.replace("0.5 *", "0.5 * (1.0 + 0.8 * wi.x * wo.x) *")}, "isotropy", ["TANGENT is not declared"]),
    ({"EXTRA": "if (u.x > 0.999) return BsdfSample(vec3(0.0 / (u.x - u.x)), Spectrum(1), pdf, BSDF_REFLECT, 1.0);"}, "chi-square",
     ["have an invalid direction"]),
])
def test_what_sampling_does_not_reach_is_found(fault, step, says, tmp_path):
    fault = {"EVAL": PLAIN, "EXTRA": "", **(fault or {})}
    glsl = LAMBERT
    for name, text in fault.items():
        glsl = glsl.replace("$" + name, text)
    code, steps = check(material(tmp_path / "grey", glsl, ["transmissive"]), "--only", step)
    assert (code, steps[step]["verdict"]) == ((1, "fail") if says else (0, "pass")), steps[step]
    for words in says or []:
        assert words in steps[step]["text"]


@pytest.mark.parametrize("factor, passes", [("1.0", True), ("1.8", False)])
def test_a_sharp_lobe_of_a_stochastic_material_is_integrated_with_its_error(factor, passes, tmp_path):
    """The non-delta fraction is 0.65; a sum over a coarse grid gave 1.45 for such a lobe."""
    code, steps = check(material(tmp_path / "grey", STOCHASTIC.replace("$PDF", factor), ["transmissive", "stochastic"]),
                        "--only", "expectation")
    step = steps["expectation"]
    assert (code == 0) == passes, step
    if passes:
        figures = {f["name"]: f["value"] for f in step["figures"]}
        assert 0.6 < figures["largest integral of pdf"] < 0.7  # the largest of many estimates
    else:
        assert "not a density" in step["text"]
