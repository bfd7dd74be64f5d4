# SPDX-License-Identifier: Apache-2.0
"""Renders a scene that was exported for Mitsuba with Cycles; run by a Python that has bpy, without Restage. Prints a JSON line
{"loss": ...} for whatever it cannot express, and one for each picture."""
import argparse
import json
import math
import os
import pathlib
import re
import resource
import sys
import time
import xml.etree.ElementTree as ET

import bpy
import numpy as np
from mathutils import Matrix


def lost(what):
    print(json.dumps({"loss": what}))


def cpu():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def value(element, name, default=None):
    for child in element:
        if child.get("name") == name and child.get("value") is not None:
            return child.get("value")
    return default


def number(element, name, default):
    return float(value(element, name, default))


def color(element, name, default=(0.5, 0.5, 0.5)):
    text = value(element, name)
    return tuple(default) if text is None else tuple((list(map(float, text.split())) * 3)[:3])


def transform(element, name="to_world"):
    found = element.find(f"transform[@name='{name}']/matrix")
    return Matrix(np.array(found.get("value").split(), float).reshape(4, 4).tolist()) if found is not None else Matrix.Identity(4)


class Materials:
    def __init__(self, root, folder):
        self.bsdfs = {b.get("id"): b for b in root.findall("bsdf")}
        self.textures = {t.get("id"): t for t in root.findall("texture")}
        self.folder, self.made = folder, {}

    def get(self, ident, radiance=None):
        if (ident, radiance) in self.made:
            return self.made[ident, radiance]
        material = bpy.data.materials.new(ident)
        material.use_nodes = True
        nodes, links = material.node_tree.nodes, material.node_tree.links
        nodes.clear()
        out = nodes.new("ShaderNodeOutputMaterial")
        shader = self.emission(nodes, links, radiance, material) if radiance else self.shader(nodes, links, self.bsdfs[ident])
        links.new(shader, out.inputs["Surface"])
        self.made[ident, radiance] = material
        return material

    def emission(self, nodes, links, radiance, material):
        """From the front only; black from behind and to other light."""
        node, side, turn = nodes.new("ShaderNodeEmission"), nodes.new("ShaderNodeNewGeometry"), nodes.new("ShaderNodeMath")
        most = max(radiance) or 1
        node.inputs["Color"].default_value = (*(c / most for c in radiance), 1)
        turn.operation = "MULTIPLY_ADD"
        turn.inputs[1].default_value, turn.inputs[2].default_value = -most, most
        links.new(side.outputs["Backfacing"], turn.inputs[0])
        links.new(turn.outputs[0], node.inputs["Strength"])
        material.cycles.emission_sampling = "FRONT"
        return node.outputs[0]

    def put(self, nodes, links, socket, bsdf, name, default):
        ref = bsdf.find(f"ref[@name='{name}']")
        if ref is not None:
            texture = self.textures[ref.get("id")]
            if texture.get("type") == "bitmap":
                node, uv, place = nodes.new("ShaderNodeTexImage"), nodes.new("ShaderNodeUVMap"), nodes.new("ShaderNodeMapping")
                node.image = bpy.data.images.load(str((self.folder / value(texture, "filename")).resolve()), check_existing=True)
                if value(texture, "raw") == "true":
                    node.image.colorspace_settings.name = "Non-Color"
                node.extension = "EXTEND" if value(texture, "wrap_mode") == "clamp" else "REPEAT"
                m = transform(texture, "to_uv")
                if m[0][1] or m[1][0]:
                    lost("a texture that is turned on its surface")
                place.inputs["Location"].default_value = (m[0][3], 1 - m[1][3], 0)  # rows count from the bottom here
                place.inputs["Scale"].default_value = (m[0][0], -m[1][1], 1)
                links.new(uv.outputs[0], place.inputs["Vector"])
                links.new(place.outputs[0], node.inputs["Vector"])
                links.new(node.outputs["Color"], socket)
                return
            lost(f"a texture of type {texture.get('type')}")
        given = color(bsdf, name, default)
        socket.default_value = (*given, 1) if hasattr(socket.default_value, "__len__") and len(socket.default_value) == 4 else given[0]

    def shader(self, nodes, links, bsdf):
        kind = bsdf.get("type")
        inner = [self.bsdfs[r.get("id")] for r in bsdf.findall("ref") if r.get("id") in self.bsdfs] + bsdf.findall("bsdf")
        if kind in ("twosided", "bumpmap", "normalmap"):
            if kind != "twosided":
                lost(f"a {kind}")
            return self.shader(nodes, links, inner[0])
        if kind in ("blendbsdf", "mask"):
            mix = nodes.new("ShaderNodeMixShader")
            first = nodes.new("ShaderNodeBsdfTransparent").outputs[0] if kind == "mask" else self.shader(nodes, links, inner[0])
            links.new(first, mix.inputs[1])
            links.new(self.shader(nodes, links, inner[-1]), mix.inputs[2])
            self.put(nodes, links, mix.inputs[0], bsdf, "opacity" if kind == "mask" else "weight", (0.5,) * 3)
            return mix.outputs[0]
        if kind == "diffuse":
            node = nodes.new("ShaderNodeBsdfDiffuse")
            self.put(nodes, links, node.inputs["Color"], bsdf, "reflectance", (0.5,) * 3)
        elif kind == "conductor" and value(bsdf, "material") == "none":
            node = nodes.new("ShaderNodeBsdfGlossy")
            node.inputs["Roughness"].default_value = 0
            self.put(nodes, links, node.inputs["Color"], bsdf, "specular_reflectance", (1,) * 3)
        elif kind in ("conductor", "roughconductor"):
            node = nodes.new("ShaderNodeBsdfMetallic")
            node.fresnel_type, node.distribution = "PHYSICAL_CONDUCTOR", "BECKMANN" if value(bsdf, "distribution") == "beckmann" else "GGX"
            node.inputs["IOR"].default_value, node.inputs["Extinction"].default_value = color(bsdf, "eta"), color(bsdf, "k")
            a, b = number(bsdf, "alpha_u", 0), number(bsdf, "alpha_v", 0)
            node.inputs["Roughness"].default_value = (a * b) ** 0.25
            if a != b:
                lost("an anisotropic metal")
        elif kind in ("dielectric", "roughdielectric"):
            node = nodes.new("ShaderNodeBsdfGlass")
            node.distribution = "GGX"
            node.inputs["IOR"].default_value = number(bsdf, "int_ior", 1.5)
            node.inputs["Roughness"].default_value = math.sqrt(number(bsdf, "alpha_u", 0))
            node.inputs["Color"].default_value = (1, 1, 1, 1)
        elif kind == "null":
            node = nodes.new("ShaderNodeBsdfTransparent")
        else:
            node = nodes.new("ShaderNodeBsdfPrincipled")
            principled = kind.startswith("principled")
            if not principled or kind == "principledthin":
                lost(f"{kind} is rendered as Blender's principled material")
            self.put(nodes, links, node.inputs["Base Color"], bsdf, "base_color" if principled else "diffuse_reflectance", (0.5,) * 3)
            node.inputs["IOR"].default_value = max(number(bsdf, "eta" if principled else "int_ior", 1.5), 1.0)
            node.inputs["Roughness"].default_value = number(bsdf, "roughness", 0.5) if principled else math.sqrt(number(bsdf, "alpha", 0))
            node.inputs["Metallic"].default_value = number(bsdf, "metallic", 0)
        return node.outputs[0]


def read_ply(path):
    """(points, normals or None, uv or None, triangles) of the exporter's binary PLY."""
    data = path.read_bytes()
    head, _, body = data.partition(b"end_header\n")
    names = re.findall(rb"property float (\w+)", head)
    vertices, faces = (int(re.search(rb"element %s (\d+)" % e, head)[1]) for e in (b"vertex", b"face"))
    table = np.frombuffer(body, "<f4", vertices * len(names)).reshape(vertices, len(names))
    rows = np.frombuffer(body, np.dtype([("n", "u1"), ("v", "<i4", 3)]), faces, vertices * len(names) * 4)["v"]
    return table[:, :3], table[:, 3:6] if b"nx" in names else None, table[:, -2:] if b"u" in names else None, rows


class Shapes:
    def __init__(self, root, folder, materials):
        self.folder, self.materials, self.meshes = folder, materials, {}
        groups = {s.get("id"): s for s in root.findall("shape") if s.get("type") == "shapegroup"}
        for shape in root.findall("shape"):
            if shape.get("type") == "instance":
                self.place(groups[shape.find("ref").get("id")].find("shape"), transform(shape), shape.get("id"))
            elif shape.get("type") != "shapegroup":
                self.place(shape, transform(shape), shape.get("id"))

    def place(self, shape, matrix, name):
        if shape.get("type") == "sphere":
            centre = shape.find("point")
            matrix = Matrix.Translation([float(centre.get(a)) for a in "xyz"]) @ Matrix.Scale(number(shape, "radius", 1), 4)
        thing = bpy.data.objects.new(name, self.mesh(shape))
        thing.matrix_world = matrix
        bpy.context.scene.collection.objects.link(thing)

    def mesh(self, shape):
        emitter = shape.find("emitter")
        radiance = color(emitter, "radiance") if emitter is not None else None
        key = (value(shape, "filename", "sphere"), shape.find("ref").get("id"), radiance, value(shape, "flip_normals"))
        if key in self.meshes:
            return self.meshes[key]
        mesh = self.meshes[key] = bpy.data.meshes.new(key[0])
        if key[0] == "sphere":
            import bmesh
            made = bmesh.new()
            bmesh.ops.create_icosphere(made, subdivisions=5, radius=1)
            made.to_mesh(mesh)
            made.free()
            mesh.polygons.foreach_set("use_smooth", np.ones(len(mesh.polygons), bool))
        else:
            points, normals, uv, triangles = read_ply(self.folder / key[0])
            if (key[3] == "true") != (transform(shape).determinant() < 0):
                triangles, normals = triangles[:, ::-1], None if normals is None else -normals
            mesh.vertices.add(len(points))
            mesh.vertices.foreach_set("co", points.ravel())
            mesh.loops.add(triangles.size)
            mesh.loops.foreach_set("vertex_index", np.ascontiguousarray(triangles).ravel())
            mesh.polygons.add(len(triangles))
            mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3))
            if uv is not None:
                mesh.uv_layers.new(name="uv").data.foreach_set("uv", np.ascontiguousarray(uv[triangles.ravel()]).ravel())
            mesh.update()
            mesh.polygons.foreach_set("use_smooth", np.full(len(triangles), normals is not None))
            if normals is not None:
                mesh.normals_split_custom_set_from_vertices(normals.tolist())
        mesh.materials.append(self.materials.get(key[1], radiance))
        return mesh


def world(root, folder):
    background = bpy.data.worlds.new("world")
    bpy.context.scene.world = background
    background.use_nodes = True
    node = background.node_tree.nodes["Background"]
    node.inputs["Color"].default_value = (0, 0, 0, 1)
    for emitter in root.findall("emitter"):
        if emitter.get("type") == "constant":
            node.inputs["Color"].default_value = (*color(emitter, "radiance"), 1)
        else:
            raise SystemExit(f"cycles_worker: lights of type {emitter.get('type')} are not translated")


def camera(sensor):
    if sensor.get("type") != "perspective":
        raise SystemExit(f"cycles_worker: cameras of type {sensor.get('type')} are not translated")
    scene, film = bpy.context.scene, sensor.find("film")
    data = bpy.data.cameras.new("camera")
    data.sensor_fit, data.angle = "HORIZONTAL", math.radians(number(sensor, "fov", 45))
    data.clip_start, data.clip_end = number(sensor, "near_clip", 0.01), number(sensor, "far_clip", 1e4)
    thing = bpy.data.objects.new("camera", data)
    thing.matrix_world = transform(sensor) @ Matrix.Diagonal((-1, 1, -1, 1))  # Blender's looks along -z, with +x to the right
    if thing.matrix_world.determinant() < 0:
        raise SystemExit("cycles_worker: mirrored cameras are not translated")
    scene.collection.objects.link(thing)
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = int(value(film, "width")), int(value(film, "height"))
    scene.render.resolution_percentage = 100


def settings(root):
    scene = bpy.context.scene
    scene.render.engine, cycles = "CYCLES", scene.cycles
    cycles.device, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", False, False
    bounces = max(int(value(root.find("integrator"), "max_depth", 9)) - 2, 0)  # 0: direct light
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = cycles.transmission_bounces = bounces
    cycles.transparent_max_bounces, cycles.blur_glossy = 64, 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    scene.render.use_persistent_data = True
    image = scene.render.image_settings
    image.file_format, image.color_depth, image.color_mode = "OPEN_EXR", "32", "RGB"


def write_pfm(source, target):
    picture = bpy.data.images.load(str(source))
    width, height = picture.size
    pixels = np.empty(width * height * picture.channels, np.float32)
    picture.pixels.foreach_get(pixels)
    bpy.data.images.remove(picture)
    rows = pixels.reshape(height, width, -1)[..., :3]  # the bottom first, as in a PFM
    target.write_bytes(f"PF\n{width} {height}\n-1\n".encode() + np.ascontiguousarray(rows).astype("<f4").tobytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--jobs", nargs="+", help="SAMPLES:SEED")
    parser.add_argument("--light-tree", choices=("on", "off"), default="on")
    args = parser.parse_args()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    root, folder = ET.parse(args.scene).getroot(), args.scene.parent
    settings(root)
    bpy.context.scene.cycles.use_light_tree = args.light_tree == "on"
    world(root, folder)
    camera(root.find("sensor"))
    Shapes(root, folder, Materials(root, folder))

    def render(samples, seed):
        scene, file = bpy.context.scene, args.folder / "cycles.exr"
        scene.cycles.samples, scene.cycles.seed, scene.render.filepath = samples, seed, str(file)
        sys.stdout.flush()
        out, nothing = os.dup(1), os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1)  # Blender talks there
        start, used = time.monotonic(), cpu()
        bpy.ops.render.render(write_still=True)
        spent = cpu() - used, time.monotonic() - start, file
        os.dup2(out, 1)
        os.close(out)
        os.close(nothing)
        return spent

    render(1, 0)  # builds its acceleration structures
    base = render(1, 0)[0]
    for job in args.jobs:
        samples, seed = map(int, job.split(":"))
        used, wall, file = render(samples, seed)
        target = args.folder / f"{samples}-{seed}.pfm"
        write_pfm(file, target)
        print(json.dumps({"samples": samples, "seed": seed, "cpu": max(used - base, 1e-6) * samples / max(samples - 1, 1), "wall": wall,
                          "file": str(target), "version": bpy.app.version_string}), flush=True)


if __name__ == "__main__":
    main()
