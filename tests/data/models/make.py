# SPDX-License-Identifier: Apache-2.0
# Writes the small valid models next to it, which the tests of broken input damage. Nothing but the Python library; the
# results are checked in.
import json
import pathlib
import struct
import zlib

here = pathlib.Path(__file__).parent


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(pixels, width, height, channels):
    rows = b"".join(b"\0" + pixels[y * width * channels:(y + 1) * width * channels] for y in range(height))
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6 if channels == 4 else 2, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


(here / "thing.png").write_bytes(png(bytes(range(64)), 4, 4, 4))
(here / "thing.mtl").write_text("""newmtl shiny
Kd 0.8 0.4 0.2
Ks 0.5 0.5 0.5
Ns 40
map_Kd -s 2 2 1 -o 0.5 0 0 thing.png
map_d thing.png
bump -bm 0.5 thing.png
newmtl metal
Kd 0.9 0.8 0.7
Pr 0.3
Pm 1
map_Pr thing.png
norm thing.png
newmtl glass
illum 7
Ni 1.5
Tf 0.9 1 0.9
Ke 0 0 1
""")
(here / "thing.obj").write_text("""mtllib thing.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0.5 0.5 1
vt 0 0
vt 1 0
vt 1 1
vt 0 1
vn 0 0 -1
o base
usemtl shiny
f 4/4/1 3/3/1 2/2/1 1/1/1
g sides
s 1
usemtl metal
f 1/1 2/2 5/3
f 2/1 3/2 5/3
s 2
usemtl glass
f -3 -2 -1
f 4 1 5
l 1 2
""")
points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
facets = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
(here / "thing.stl").write_text("solid thing\n" + "".join(
    "facet normal 0 0 0\nouter loop\n" + "".join("vertex %g %g %g\n" % points[i] for i in f) + "endloop\nendfacet\n"
    for f in facets) + "endsolid thing\n")
(here / "binary.stl").write_bytes(b"\0" * 80 + struct.pack("<I", len(facets)) + b"".join(
    struct.pack("<12f", 0, 0, 0, *points[f[0]], *points[f[1]], *points[f[2]]) + b"\0\0" for f in facets))

parts, views, accessors = [], [], []


def view(data):
    offset = sum(map(len, parts))
    parts.append(data + b"\0" * (-len(data) % 4))
    views.append({"buffer": 0, "byteOffset": offset, "byteLength": len(data)})
    return len(views) - 1


def accessor(form, kind, component, values, width):
    accessors.append({"bufferView": view(struct.pack("<%d%s" % (len(values), form), *values)), "componentType": component,
                      "type": kind, "count": len(values) // width})
    return len(accessors) - 1


P = accessor("f", "VEC3", 5126, [x for p in points for x in p], 3)
N = accessor("f", "VEC3", 5126, [0, 0, 1] * 4, 3)
T = accessor("f", "VEC2", 5126, [0, 0, 1, 0, 0, 1, 1, 1], 2)
I = accessor("H", "SCALAR", 5123, [i for f in facets for i in f], 1)
C = accessor("B", "VEC4", 5121, list(range(16)), 4)
accessors[C]["normalized"] = True
J = accessor("B", "VEC4", 5121, [0, 1, 0, 0] * 4, 4)
W = accessor("f", "VEC4", 5126, [0.5, 0.5, 0, 0] * 4, 4)
B = accessor("f", "MAT4", 5126, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] * 2, 16)
accessors.append({"componentType": 5126, "type": "VEC3", "count": 4, "sparse": {
    "count": 1, "indices": {"bufferView": view(struct.pack("<H", 2)), "componentType": 5123},
    "values": {"bufferView": view(struct.pack("<3f", 0, 0.5, 0))}}})
M = len(accessors) - 1
root = {
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 4, 5]}],
    "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform", "KHR_materials_transmission"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 20, "spot": {"outerConeAngle": 0.6}}]}},
    "nodes": [
        {"name": "root", "children": [1, 2, 3], "rotation": [0, 0.7071, 0, 0.7071]},
        {"mesh": 0, "name": "plain", "translation": [1, 0, 0]}, {"mesh": 1, "skin": 0}, {"name": "joint"},
        {"camera": 0, "translation": [0, 0, 5]}, {"extensions": {"KHR_lights_punctual": {"light": 0}}}],
    "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 1.5, "znear": 0.1}}],
    "skins": [{"joints": [3, 0], "inverseBindMatrices": B}],
    "meshes": [
        {"name": "solid", "primitives": [{"attributes": {"POSITION": P, "NORMAL": N, "TEXCOORD_0": T}, "indices": I, "material": 0}]},
        {"primitives": [{"attributes": {"POSITION": P, "COLOR_0": C, "JOINTS_0": J, "WEIGHTS_0": W}, "indices": I,
                         "targets": [{"POSITION": M}]}], "weights": [0.5]}],
    "materials": [{"name": "all", "alphaMode": "MASK", "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0},
                   "pbrMetallicRoughness": {
                       "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"rotation": 0.5, "scale": [2, 3]}}},
                       "metallicRoughnessTexture": {"index": 1}},
                   "normalTexture": {"index": 0, "scale": 0.5},
                   "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}}}],
    "textures": [{"source": 0, "sampler": 0}, {"source": 1}],
    "samplers": [{"wrapS": 33648, "wrapT": 33071}],
    "images": [{"uri": "thing.png"}, {"bufferView": view((here / "thing.png").read_bytes()), "mimeType": "image/png"}],
    "accessors": accessors, "bufferViews": views,
}
data = b"".join(parts)
root["buffers"] = [{"byteLength": len(data)}]
text = json.dumps(root, separators=(",", ":")).encode()
text += b" " * (-len(text) % 4)
body = struct.pack("<I", len(text)) + b"JSON" + text + struct.pack("<I", len(data)) + b"BIN\0" + data
(here / "thing.glb").write_bytes(b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body)
root["buffers"][0]["uri"] = "thing.bin"
(here / "thing.bin").write_bytes(data)
(here / "thing.gltf").write_text(json.dumps(root, indent=1) + "\n")
