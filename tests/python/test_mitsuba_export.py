# SPDX-License-Identifier: Apache-2.0
"""The exporter to Mitsuba's XML: values, transforms and losses; and, if `mitsuba` is installed, both renderers' pictures of
the same scene, in 64 blocks, which any mistake of orientation changes."""
import math
import struct
import xml.etree.ElementTree as ET

import numpy as np
import pytest

import restage

HEAD = """Film "rgb" "integer xresolution" 64 "integer yresolution" {height}
PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
Sampler "zsobol" "integer pixelsamples" 64
Integrator "volpath" "integer maxdepth" {depth}
"""
CAMERA = 'LookAt 0 -4 1  0 0 1  0 0 1\nCamera "perspective" "float fov" 50\n'
QUAD = ('"point3 P" [ -1.5 0 -0.5  1.5 0 -0.5  1.5 0 2.5  -1.5 0 2.5 ] "integer indices" [ 0 1 2 0 2 3 ] '
        '"point2 uv" [ 0 0 1 0 1 1 0 1 ]\n')
WALL = 'Shape "trianglemesh" ' + QUAD
LAMP = ('AttributeBegin\nTranslate 0 -3 4 AreaLightSource "diffuse" "rgb L" [ 20 20 20 ] Shape "trianglemesh" '
        '"point3 P" [ -.5 -.5 0 -.5 .5 0 .5 .5 0 .5 -.5 0 ] "integer indices" [ 0 1 2 0 2 3 ]\nAttributeEnd\n')
CROP = ' "float cropwindow" [ .25 1 0 .5 ]'
PICTURE = 'Texture "t" "spectrum" "imagemap" "string filename" "picture.pfm" '
MATTE = '\nMaterial "diffuse" "texture reflectance" "t"\n'


def pfm(path, pixels):
    height, width, _ = pixels.shape
    path.write_bytes(f"PF\n{width} {height}\n-1\n".encode() + pixels[::-1].astype("<f4").tobytes())


def picture():
    y, x = np.mgrid[0:32, 0:64].astype(np.float32)
    return np.stack([0.1 + 0.8 * x / 64, 0.1 + 0.8 * y / 32, np.where((x > 40) & (y < 10), 0.9, 0.1)], -1)


def sky():
    y, x = np.mgrid[0:32, 0:32].astype(np.float32)
    return np.stack([0.05 + x / 32, 0.05 + (y / 32) ** 2, np.where((x > 5) & (x < 9) & (y > 18) & (y < 25), 3.0, 0.1)], -1)


@pytest.fixture
def export(tmp_path):
    """export(world, ...) -> (root element, report, path of the .pbrt, path of the .xml)"""
    def run(world, camera=CAMERA, height=64, depth=4, film="", **options):
        pfm(tmp_path / "picture.pfm", picture())
        pfm(tmp_path / "sky.pfm", sky())
        source, target = tmp_path / "scene.pbrt", tmp_path / "scene.xml"
        head = HEAD.format(height=height, depth=depth).replace("\nPixel", film + "\nPixel")
        source.write_text(camera + head + "WorldBegin\n" + world)
        with restage.open(source) as session:
            report = session.export(target, **options)
        return ET.parse(target).getroot(), report, source, target
    return run


def find(element, tag, **attributes):
    found = [e for e in element.iter(tag) if all(e.get(k) == v for k, v in attributes.items())]
    assert len(found) == 1, f"{len(found)} of <{tag} {attributes}>"
    return found[0]


def value(element, name):
    return next(e.get("value") for e in element if e.get("name") == name)


def numbers(element, name):
    return [float(x) for x in value(element, name).split()]


def matrix(element, name="to_world"):
    return np.array(find(element, "transform", name=name).find("matrix").get("value").split(), float).reshape(4, 4)


def test_camera_film_and_depth(export):
    root, report, _, _ = export(WALL)
    assert report.dropped == 0, str(report)
    sensor = find(root, "sensor", type="perspective")
    assert value(sensor, "fov_axis") == "x" and math.isclose(float(value(sensor, "fov")), 50, rel_tol=1e-6)
    # pbrt's x is to the right (-x of the world here), Mitsuba's to the left
    assert np.allclose(matrix(sensor), [[1, 0, 0, 0], [0, 0, 1, -4], [0, 1, 0, 1], [0, 0, 0, 1]])
    film = find(sensor, "film")
    assert (value(film, "width"), value(film, "height"), find(film, "rfilter").get("type")) == ("64", "64", "box")
    assert value(find(sensor, "sampler"), "sample_count") == "64" and value(find(root, "integrator"), "max_depth") == "5"


def test_field_of_view_is_of_the_shorter_side(export):
    root, *_ = export(WALL, height=32)
    assert math.isclose(float(value(find(root, "sensor"), "fov")), 2 * math.degrees(math.atan(2 * math.tan(math.radians(25)))), rel_tol=1e-6)


def test_crop_window_lens_and_scaled_camera(export):
    camera = ('Scale 2 2 2\nLookAt 0 -2 .5  0 0 .5  0 0 1\nCamera "perspective" "float screenwindow" [ -1.5 .5 -1 2 ] '
              '"float lensradius" .05 "float focaldistance" 1.2\n')
    root, report, _, _ = export(WALL, camera=camera, film=CROP)
    sensor = find(root, "sensor", type="thinlens")
    assert math.isclose(float(value(sensor, "principal_point_offset_x")), -0.25)
    assert math.isclose(float(value(sensor, "principal_point_offset_y")), -1 / 6, rel_tol=1e-6)
    assert math.isclose(float(value(sensor, "aperture_radius")) / float(value(sensor, "focus_distance")), .05 / 1.2, rel_tol=1e-5)
    assert np.allclose(np.abs(np.linalg.det(matrix(sensor))), 1)
    assert "not square" in str(report)


def test_materials(export):
    world = """MakeNamedMaterial "a < \\"b\\" & c" "string type" "conductor" "float roughness" 0.25 "rgb eta" [ 0.2 0.9 1.1 ] "rgb k" [ 3.9 2.4 2.1 ]
MakeNamedMaterial "glass" "string type" "dielectric" "float eta" 1.33
MakeNamedMaterial "rough glass" "string type" "dielectric" "float roughness" 0.04 "bool remaproughness" false
MakeNamedMaterial "pane" "string type" "thindielectric"
MakeNamedMaterial "coat" "string type" "coateddiffuse" "float roughness" 0
MakeNamedMaterial "mix" "string type" "mix" "string materials" [ "glass" "coat" ] "float amount" 0.3
"""
    for name in ('a < \\"b\\" & c', "glass", "rough glass", "pane", "coat", "mix"):
        world += f'NamedMaterial "{name}"\n' + WALL
    root, report, _, _ = export(world)
    metal = find(root, "bsdf", type="roughconductor")
    assert [float(value(metal, n)) for n in ("alpha_u", "alpha_v")] == [0.5, 0.5] and value(metal, "distribution") == "ggx"
    assert np.allclose(numbers(metal, "eta"), [0.2, 0.9, 1.1]) and np.allclose(numbers(metal, "k"), [3.9, 2.4, 2.1])
    sides = [e for e in root.findall("bsdf") if e.get("type") == "twosided"]
    assert [e[0].get("type") for e in sides] == ["roughconductor", "plastic"]
    assert math.isclose(float(value(find(root, "bsdf", type="dielectric"), "int_ior")), 1.33, rel_tol=1e-6)
    assert math.isclose(float(value(find(root, "bsdf", type="roughdielectric"), "alpha_u")), 0.04, rel_tol=1e-6)
    find(root, "bsdf", type="thindielectric")
    blend = find(root, "bsdf", type="blendbsdf")
    ids = {e.get("id") for e in root.findall("bsdf")}
    assert math.isclose(float(value(blend, "weight")), 0.3, rel_tol=1e-6) and [r.get("id") for r in blend.findall("ref")] == ["material-glass", "material-coat"]
    assert all(r.get("id") in ids for e in root.findall("shape") for r in e.findall("ref"))
    assert "plastic is the nearest" in str(report) and report.dropped == 0


def test_textures(export):
    root, report, _, target = export(LAMP + PICTURE + '"float uscale" 2 "float vscale" 3 "float udelta" 0.25' + MATTE + WALL)
    bitmap = find(root, "texture", type="bitmap")
    assert value(bitmap, "filename") == "picture.pfm" and report.approximated == 0, str(report)
    # rows count from the top there: 1 - (3 v)
    assert np.allclose(matrix(bitmap, "to_uv")[:2], [[2, 0, 0, 0.25], [0, -3, 0, 1]])
    assert find(root, "ref", name="reflectance").get("id") == bitmap.get("id")


def test_a_scaled_picture_is_written_as_such(export):
    root, _, _, target = export(PICTURE + '"float scale" 0.5' + MATTE + WALL)
    data = (target.parent / value(find(root, "texture"), "filename")).read_bytes()
    assert np.allclose(np.frombuffer(data[-64 * 32 * 12:], "<f4").reshape(32, 64, 3)[::-1], 0.5 * picture(), rtol=1e-6)


def test_instances_share_a_group_and_single_ones_do_not(export):
    world = ('ObjectBegin "o"\n' + WALL + "ObjectEnd\n" + 'Translate 1 2 3 ObjectInstance "o"\nScale 1 1 -1 ObjectInstance "o"\n'
             "Translate 0 0 5 ReverseOrientation\n" + WALL.replace("1.5", "1.6"))
    root, report, _, target = export(world)
    group = find(root, "shape", type="shapegroup")
    instances = [e for e in root.findall("shape") if e.get("type") == "instance"]
    assert [e.find("ref").get("id") for e in instances] == [group.get("id")] * 2
    assert np.allclose(matrix(instances[0])[:3, 3], [1, 2, 3]) and np.allclose(matrix(instances[1])[2], [0, 0, -1, 3])
    alone = [e for e in root.findall("shape") if e.get("type") == "ply"]
    assert len(alone) == 1 and np.allclose(matrix(alone[0])[2], [0, 0, -1, -2])
    assert not any(b.get("name") == "flip_normals" for b in alone[0].findall("boolean"))  # reversed, and mirrored
    head = (target.parent / value(alone[0], "filename")).read_bytes()
    assert head.startswith(b"ply\nformat binary_little_endian") and struct.unpack("<fff", head.split(b"end_header\n")[1][:12])[0] == np.float32(-1.6)


def test_lights(export):
    world = """LightSource "point" "point3 from" [ 1 2 3 ] "rgb I" [ 4 5 6 ]
LightSource "spot" "point3 from" [ 0 0 2 ] "point3 to" [ 0 0 0 ] "rgb I" [ 1 2 3 ] "float coneangle" 30 "float conedeltaangle" 10
LightSource "distant" "point3 from" [ 0 0 1 ] "point3 to" [ 0 0 0 ] "rgb L" [ 3 2 1 ]
LightSource "infinite" "rgb L" [ .5 .6 .7 ]
"""
    root, report, _, _ = export(world + LAMP + WALL)
    point = find(root, "emitter", type="point")
    assert [point.find("point").get(a) for a in "xyz"] == ["1", "2", "3"] and numbers(point, "intensity") == [4, 5, 6]
    spot = find(root, "emitter", type="spot")
    assert np.allclose(matrix(spot)[:3, 2], [0, 0, -1]) and float(value(spot, "cutoff_angle")) == 30 and float(value(spot, "beam_width")) == 20
    sun = find(root, "emitter", type="directional")
    assert float(sun.find("vector").get("z")) == -1 and numbers(sun, "irradiance") == [3, 2, 1]
    assert np.allclose(numbers(find(root, "emitter", type="constant"), "radiance"), [.5, .6, .7])
    assert numbers(find(root, "emitter", type="area"), "radiance") == [20, 20, 20]
    assert "spots fade" in str(report)


@pytest.mark.parametrize("world, loss", [
    ('Material "hair"\n' + WALL, "hair on curves only"),
    ('Texture "n" "spectrum" "marble"\nMaterial "diffuse" "texture reflectance" "n"\n' + WALL, "its average is written"),
    ('MakeNamedMedium "m" "string type" "homogeneous"\nMediumInterface "m" ""\n' + WALL, "media are not written"),
    ('AreaLightSource "diffuse" "bool twosided" true\n' + WALL, "one side only"),
    (PICTURE + '"string wrap" "black"' + MATTE + WALL, "repeats its border"),
    ('Scale 1 2 1 Shape "sphere"\n', "written as triangles"),
])
def test_losses_are_reported(export, world, loss):
    _, report, _, _ = export(world)
    assert loss in str(report), str(report)
    assert report.approximated + report.dropped > 0


def test_the_same_scene_gives_the_same_bytes(export):
    world = LAMP + PICTURE + MATTE + WALL
    first = export(world)[3].read_bytes()
    assert export(world)[3].read_bytes() == first


SKY = 'LightSource "infinite" "string filename" "sky.pfm"'
TRIANGLE = '"integer indices" [ 0 1 2 ]'
WORLDS = {  # world, camera, height, depth; most of a block's error, of the means
    "texture": (LAMP + PICTURE + '"float uscale" 2 "float vscale" 1.5 "float udelta" 0.2' + MATTE + WALL, CAMERA, 64, 4, 0.03, 0.002),
    "inverted": (LAMP + PICTURE + '"float scale" 0.7 "bool invert" true' + MATTE + WALL, CAMERA, 64, 4, 0.03, 0.002),
    "checkerboard": (LAMP + 'Texture "t" "spectrum" "checkerboard" "float uscale" 3 "float vscale" 2 "rgb tex1" [ .9 .1 .1 ] '
                     '"rgb tex2" [ .1 .1 .9 ]' + MATTE + WALL, CAMERA, 64, 4, 0.05, 0.002),
    "environment": ("AttributeBegin\nRotate 30 0 0 1 Rotate 20 1 0 0 " + SKY + ' "float scale" 0.8\nAttributeEnd\nMaterial "diffuse"\n'
                    'Shape "trianglemesh" "point3 P" [ -.5 0 .5 .5 0 .5 0 0 1.5 ] ' + TRIANGLE + "\n", CAMERA, 64, 4, 0.05, 0.01),
    "lights": ('LightSource "distant" "point3 from" [ 1 -2 1 ] "rgb L" [ 3 2 1 ]\nLightSource "point" "point3 from" [ -1 -1 2 ] '
               '"rgb I" [ 1 1 3 ]\nLightSource "spot" "point3 from" [ 1 -2 1 ] "point3 to" [ -.3 0 .7 ] "rgb I" [ 5 4 3 ] '
               '"float coneangle" 25 "float conedeltaangle" 0\nMaterial "diffuse"\n' + WALL, CAMERA, 64, 4, 0.1, 0.003),
    "sides of lamps": (
        "AttributeBegin\nScale 1 1 -1 Translate 0 -3 -4 AreaLightSource \"diffuse\" \"rgb L\" [ 20 20 20 ] Shape \"trianglemesh\" "
        '"point3 P" [ -.5 -.5 0 .5 -.5 0 .5 .5 0 -.5 .5 0 ] "integer indices" [ 0 1 2 0 2 3 ]\nAttributeEnd\n'
        'AttributeBegin ReverseOrientation Translate 1 -1 1 AreaLightSource "diffuse" "rgb L" [ 9 1 1 ] Shape "sphere" "float radius" .2 '
        'AttributeEnd AttributeBegin Scale -1 1 1 Translate .5 -1 .5 AreaLightSource "diffuse" "rgb L" [ 1 9 1 ] Shape "sphere" '
        '"float radius" .2 AttributeEnd\nAttributeBegin ReverseOrientation Scale 1 -1 1 Translate 0 1 2 AreaLightSource "diffuse" '
        '"rgb L" [ 1 1 9 ] Shape "trianglemesh" "point3 P" [ -.5 0 0 .5 0 0 0 0 .5 ] ' + TRIANGLE + " AttributeEnd\n"
        'AttributeBegin Translate 0 -1 1.2 AreaLightSource "diffuse" "rgb L" [ 9 1 9 ] Shape "trianglemesh" "point3 P" '
        '[ -.5 0 0 .5 0 0 0 0 .5 ] "normal N" [ 0 1 0 0 1 0 0 1 0 ] ' + TRIANGLE + ' AttributeEnd\nMaterial "diffuse"\n' + WALL,
        'Scale -1 1 1\nLookAt 0.5 -4 1.4  0.2 0 1.1  0.1 0 1\nCamera "perspective" "float fov" 50\n', 64, 4, 0.15, 0.01),
    "glass": (SKY + '\nMaterial "dielectric" "float eta" 1.5\nAttributeBegin Translate -.5 0 1 Shape "sphere" "float radius" .5 '
              'AttributeEnd AttributeBegin Scale 1 1 -1 Translate .6 0 -1 Shape "sphere" "float radius" .5 AttributeEnd\n'
              'Material "thindielectric" AttributeBegin Translate 0 -1 .5 Shape "sphere" "float radius" .2 AttributeEnd\n', CAMERA, 64, 9, 0.15, 0.015),
    "metal": (LAMP + 'Material "conductor" "float roughness" 0.3 "rgb reflectance" [ .9 .5 .2 ]\n' + WALL, CAMERA, 64, 2, 0.15, 0.02),
    "mix": (LAMP + 'MakeNamedMaterial "a" "string type" "diffuse" "rgb reflectance" [ .9 .1 .1 ]\nMakeNamedMaterial "b" "string type" '
            '"diffuse" "rgb reflectance" [ .1 .1 .9 ]\nMakeNamedMaterial "m" "string type" "mix" "string materials" [ "a" "b" ] '
            '"float amount" 0.3\nNamedMaterial "m"\n' + WALL, CAMERA, 64, 4, 0.15, 0.01),
    "cut-out": (SKY + '\nTexture "a" "float" "imagemap" "string filename" "picture.pfm"\nMaterial "diffuse" "rgb reflectance" '
                '[ .9 .1 .1 ]\nShape "trianglemesh" "texture alpha" "a" ' + QUAD, CAMERA, 64, 4, 0.15, 0.02),
    "bump": ('LightSource "distant" "point3 from" [ 1 -1 1 ] "rgb L" [ 3 2 1 ]\nTexture "b" "float" "imagemap" "string filename" '
             '"picture.pfm" "float uscale" 2 "float scale" 0.3\nMaterial "diffuse" "texture displacement" "b"\n' + WALL, CAMERA, 64, 4, 0.3, 0.03),
    "window and crop": (LAMP + PICTURE + MATTE + WALL, 'LookAt 0 -4 1  .3 0 1.2  0.1 0 1\nCamera "perspective" "float fov" 40 '
                        '"float screenwindow" [ -1.5 0.5 -1 2 ]\n', 96, 4, 0.1, 0.004),
    "orthographic": (LAMP + PICTURE + MATTE + WALL, 'LookAt 0 -4 1  .3 0 1.2  0.1 0 1\nCamera "orthographic" "float screenwindow" '
                     "[ -1.5 1 -1 2 ]\n", 96, 4, 0.1, 0.004),
    "lens": (LAMP + PICTURE + MATTE + WALL, 'Scale 2 2 2\nLookAt 0 -2 .5  .2 0 .5  0 0 1\nCamera "perspective" "float fov" 50 "float '
             'lensradius" .05 "float focaldistance" 1.2\n', 64, 4, 0.08, 0.004),
}


@pytest.mark.parametrize("name", WORLDS)
def test_mitsuba_renders_the_same_picture(export, name):
    mi = pytest.importorskip("mitsuba", reason="mitsuba is not installed: pip install mitsuba, to compare with it")
    mi.set_variant("scalar_rgb")
    world, camera, height, depth, worst, mean = WORLDS[name]
    _, _, source, target = export(world, camera=camera, height=height, depth=depth, film=CROP if "crop" in name else "")
    with restage.open(source) as session:
        ours = np.asarray(session.render(samples=64, seed=1).color)[..., :3]
    theirs = np.array(mi.render(mi.load_file(str(target)), spp=64, seed=1))[..., :3]
    assert ours.shape == theirs.shape

    def blocks(image):
        rows, columns = (n // 8 * 8 for n in image.shape[:2])
        return image[:rows, :columns].reshape(8, rows // 8, 8, columns // 8, 3).mean((1, 3))

    difference = np.abs(blocks(theirs) - blocks(ours)) / (blocks(ours) + 0.1 * ours.mean())
    print(name, "worst block", difference.max(), "means", theirs.mean((0, 1)) / ours.mean((0, 1)))
    assert difference.max() < worst and np.allclose(theirs.mean((0, 1)), ours.mean((0, 1)), rtol=mean)
