# SPDX-License-Identifier: Apache-2.0
# Writes the broken files next to it and expected.txt, which lists the required part of each error. Nothing but the
# Python library; the results are checked in.
# expected.txt: path, '|', part of the message ("report:" in front: the scene opens, and the report contains that message). tests/fuzz/broken_test.cpp documents how each folder is used.
import base64
import gzip
import json
import pathlib
import struct
import zlib

here = pathlib.Path(__file__).parent
expected = []


def put(path, data, message):
    target = here / path
    target.parent.mkdir(exist_ok=True)
    target.write_bytes(data if isinstance(data, bytes) else data.encode())
    expected.append(f"{path}|{message}\n")


# --- PLY ---------------------------------------------------------------------------------------------------------------
XYZ = "property float x\nproperty float y\nproperty float z\n"
FACES = "property list uchar int vertex_indices\n"
POINTS = "0 0 0\n1 0 0\n0 1 0\n"


def ply(vertices="3", faces="1", kind="ascii", xyz=XYZ, list_=FACES, before="", end="end_header\n"):
    return f"ply\nformat {kind} 1.0\n{before}element vertex {vertices}\n{xyz}element face {faces}\n{list_}{end}"


def binary(kind, body, **more):
    return ply(kind=f"binary_{kind}_endian", **more).encode() + body


TRIANGLE = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)

put("ply/empty.ply", "", "the header does not end")
put("ply/no-magic.ply", "plx\nformat ascii 1.0\nend_header\n", "not a PLY file")
put("ply/header-open.ply", ply(end="") + "property", "the header does not end")
put("ply/one-long-line.ply", "ply\n" + "comment" * 3000, "the header does not end")
put("ply/format-unknown.ply", ply(kind="ebcdic") + POINTS + "3 0 1 2\n", "format 'ebcdic' is unknown")
put("ply/format-missing.ply", ply().replace("format ascii 1.0\n", "") + POINTS + "3 0 1 2\n", "names no format")
put("ply/count-negative.ply", ply(vertices="-3") + POINTS, "not readable")
put("ply/count-word.ply", ply(vertices="many") + POINTS, "not readable")
put("ply/count-2e31.ply", ply(vertices="2147483648") + POINTS, "declared")
put("ply/count-2e63.ply", ply(vertices="18446744073709551615") + POINTS, "declared")
put("ply/count-too-long.ply", ply(vertices="99999999999999999999999") + POINTS, "not readable")
put("ply/vertices-short.ply", ply() + "0 0 0\n1 0 0\n", "truncated")
put("ply/faces-short.ply", ply(faces="2") + POINTS + "3 0 1 2\n", "truncated")
put("ply/type-unknown.ply", ply(xyz=XYZ.replace("float y", "quaternion y")) + POINTS, "unknown type")
put("ply/line-unknown.ply", ply(before="elephant vertex 3\n") + POINTS, "elephant")
put("ply/no-z.ply", ply(xyz="property float x\nproperty float y\n") + "0 0\n1 0\n0 1\n3 0 1 2\n", "no x, y and z")
put("ply/no-vertices.ply", "ply\nformat ascii 1.0\nelement face 1\n" + FACES + "end_header\n3 0 1 2\n", "no vertices")
put("ply/zero-vertices.ply", binary("little", b"\3" + struct.pack("<3i", 0, 1, 2), vertices="0"), "no vertices")
put("ply/no-faces.ply", ply(faces="0") + POINTS, "no faces")
put("ply/no-list.ply", ply(list_="property int material\n") + POINTS + "7\n", "no list")
put("ply/index-over.ply", ply() + POINTS + "3 0 1 3\n", "vertex 3 of 3")
put("ply/index-billion.ply", ply() + POINTS + "3 0 1 1000000000\n", "vertex 1000000000")
put("ply/index-negative.ply", ply() + POINTS + "3 0 1 -1\n", "vertex -1")
put("ply/nan.ply", ply() + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "")
put("ply/infinite.ply", binary("little", struct.pack("<9f", 0, 0, 0, float("inf"), 0, 0, 0, 1, 0) + b"\3" + struct.pack("<3i", 0, 1, 2)), "not finite")
put("ply/words.ply", ply() + "0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n", "zero")
put("ply/list-billion.ply", binary("little", TRIANGLE + struct.pack("<I3i", 1000000000, 0, 1, 2), list_="property list uint int vertex_indices\n"), "1000000000")
put("ply/list-negative.ply", binary("little", TRIANGLE + struct.pack("<i3i", -1, 0, 1, 2), list_="property list int int vertex_indices\n"), "-1")
put("ply/list-nan.ply", binary("little", TRIANGLE + struct.pack("<f3i", float("nan"), 0, 1, 2), list_="property list float int vertex_indices\n"), "")
put("ply/cut-vertex.ply", binary("little", TRIANGLE[:30]), "truncated")
put("ply/cut-face.ply", binary("big", struct.pack(">9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + b"\3\0\0\0\0\0\0"), "truncated")
put("ply/cut.ply.gz", gzip.compress(ply().encode() + POINTS.encode() + b"3 0 1 2\n", mtime=0)[:-12], "report:gzip data ends early")
put("ply/checksum.ply.gz", gzip.compress(ply().encode() + POINTS.encode() + b"3 0 1 2\n", mtime=0)[:-8] + b"\0" * 8, "report:gzip data is damaged")

# --- images --------------------------------------------------------------------------------------------------------------


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(width, height, body, depth=8, color=2):
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + header + body + chunk(b"IEND", b"")


def tga(kind, width, height, bits, body, palette=b"", palette_size=0):
    head = struct.pack("<BBBHHBHHHHBB", 0, 1 if palette else 0, kind, 0, palette_size, 24 if palette else 0, 0, 0, width, height, bits, 0)
    return head + palette + body


def attribute(name, kind, data):
    return name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data


def exr(width, height, body, channels=b"Y\0" + struct.pack("<iiii", 2, 0, 1, 1) + b"\0", compression=0):
    box = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    return (b"\x76\x2f\x31\x01" + struct.pack("<i", 2) + attribute(b"channels", b"chlist", channels)
            + attribute(b"compression", b"compression", bytes([compression])) + attribute(b"dataWindow", b"box2i", box)
            + attribute(b"displayWindow", b"box2i", box) + attribute(b"lineOrder", b"lineOrder", b"\0")
            + attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1))
            + attribute(b"screenWindowCenter", b"v2f", struct.pack("<ff", 0, 0))
            + attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0" + body)


JPEG = bytes.fromhex("ffd8ffe000104a46494600010100000100010000ffdb004300" + "01" * 64)
put("images/empty.png", "", "the file is empty")
put("images/text.jpg", "this is no picture\n", "not a picture")
put("images/cut.png", png(4, 4, chunk(b"IDAT", zlib.compress(b"\0" * 52)))[:50], "truncated")
put("images/huge.png", png(100000, 100000, chunk(b"IDAT", zlib.compress(b"\0" * 52))), "100000 x 100000")
put("images/large.png", png(16000, 16000, chunk(b"IDAT", zlib.compress(b"\0" * 52))), "the file has only")
put("images/no-size.png", png(0, 4, chunk(b"IDAT", zlib.compress(b"\0" * 52))), "")
put("images/few-rows.png", png(4, 4, chunk(b"IDAT", zlib.compress(b"\0" * 20))), "broken")
put("images/no-data.png", png(4, 4, b""), "broken")
put("images/bad-zlib.png", png(4, 4, chunk(b"IDAT", b"\x78\x9c" + b"\xff" * 40)), "broken")
put("images/chunk-2e31.png", png(4, 4, struct.pack(">I", 0x80000000) + b"IDAT" + b"\0" * 40), "")
put("images/palette.png", png(4, 4, chunk(b"IDAT", zlib.compress(b"\0\xff\xff\xff\xff" * 4)), color=3), "broken")
put("images/no-scan.jpg", JPEG + b"\xff\xd9", "")
put("images/huge.jpg", JPEG + bytes.fromhex("ffc0000b08ffffffff01011100") + b"\xff\xd9", "broken")
put("images/codes.jpg", JPEG + bytes.fromhex("ffc4028600" + "28" * 16) + bytes(640) + b"\xff\xd9", "broken")
put("images/cut.webp", b"RIFF\x1a\0\0\0WEBPVP8L\x0d\0\0\0\x2f\xff\xff\xff\x0f", "truncated")
put("images/huge.webp", b"RIFF\x16\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0\xff\xff\xff\xff\xff\xff", "")
put("images/wide-row.png", png(16384, 16384, chunk(b"IDAT", zlib.compress(bytes(1 << 20), 9)), depth=1, color=0), "only")
put("images/huge.bmp", b"BM" + struct.pack("<IHHIIiiHHIIiiII", 100, 0, 0, 54, 40, 0x7fffffff, 0x7fffffff, 1, 24, 0, 0, 0, 0, 0, 0) + b"\0" * 40, "")
put("images/cut.bmp", b"BM" + struct.pack("<IHHIIiiHHIIiiII", 100, 0, 0, 54, 40, 8, 8, 1, 24, 0, 0, 0, 0, 0, 0) + b"\0" * 40, "truncated")
put("images/cut.tga", tga(2, 8, 8, 24, b"\0" * 50), "truncated")
put("images/huge.tga", tga(10, 65535, 65535, 32, b"\xff\0\0\0\0"), "65535 x 65535")
put("images/run-over.tga", tga(10, 2, 2, 24, b"\xff\1\2\3")[:-1], "truncated")
put("images/palette-short.tga", tga(1, 4, 4, 8, b"\0\1", b"\1\2\3" * 2, 2), "truncated")
put("images/run.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 16\n\2\2\0\x10\xff\1\xff\1", "row 0 is broken")
put("images/cut.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 16\n\2\2\0\x10\x90\1", "truncated")
put("images/huge.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 99999999 +X 99999999\n\2\2\0\x10", "99999999 x 99999999")
put("images/no-resolution.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\nsixteen by two\n", "'-Y height +X width' expected")
put("images/xyz.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n\1\1\1\1", "32-bit_rle_rgbe")
put("images/cut.pfm", b"PF\n4 4\n-1.0\n" + b"\0" * 191, "truncated")
put("images/huge.pfm", b"PF\n2147483647 2147483647\n-1.0\n", "2147483647 x 2147483647")
put("images/no-scale.pfm", b"Pf\n1 1\nbig\n\0\0\0\0", "the scale expected")
put("images/cut.exr", exr(4, 2, struct.pack("<QQ", 279, 303)), "EXR")
put("images/huge.exr", exr(0x7fffffff, 0x7fffffff, b"\0" * 64), "")
put("images/large.exr", exr(60000, 4000, b"\0" * 64), "")
put("images/inside-out.exr", exr(-5, 4, b"\0" * 64), "")
put("images/no-channels.exr", exr(2, 2, b"\0" * 64, channels=b"\0"), "")
put("images/channel-type.exr", exr(2, 2, b"\0" * 64, channels=b"Y\0" + struct.pack("<iiii", 77, 0, 1, 1) + b"\0"), "")
put("images/sampling-zero.exr", exr(2, 2, b"\0" * 64, channels=b"Y\0" + struct.pack("<iiii", 2, 0, 0, 0) + b"\0"), "")
put("images/compression.exr", exr(2, 2, b"\0" * 64, compression=99), "")
put("images/no-header.exr", b"\x76\x2f\x31\x01" + struct.pack("<i", 2), "")
put("images/attribute-2e31.exr", b"\x76\x2f\x31\x01" + struct.pack("<i", 2) + b"channels\0chlist\0" + struct.pack("<i", 0x7fffffff), "attribute 'channels'")
put("images/attribute-own.exr", b"\x76\x2f\x31\x01" + struct.pack("<i", 2) + b"mine\0unheard\0" + struct.pack("<i", 0x64000000) + b"\0" * 80, "attribute 'mine'")

# --- scenes: what pbrt files refer to ------------------------------------------------------------------------------------
TRI = 'Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]\n'
put("scenes/cycle-a.pbrt", 'WorldBegin\nInclude "cycle-b.pbrt"\n', "cycle-b.pbrt:1:")
put("scenes/cycle-b.pbrt", 'Include "cycle-a.pbrt"\n', "")
put("scenes/include-missing.pbrt", 'WorldBegin\nInclude "not-there.pbrt"\n' + TRI, "report:not-there.pbrt")
put("scenes/include-folder.pbrt", 'WorldBegin\nInclude "../scenes"\n' + TRI, "report:not a regular file")
put("scenes/include-part.pbrt", 'WorldBegin\nInclude "part-broken.inc"\n' + TRI, "part-broken.inc:3:")
put("scenes/part-broken.inc", '# line 1\n# line 2\nShape "sphere" "float radius" "wide"\n', "")
put("scenes/object-in-itself.pbrt", 'WorldBegin\nObjectBegin "a"\n' + TRI + 'ObjectInstance "a"\nObjectEnd\nObjectInstance "a"\n', "object-in-itself.pbrt:4:")
put("scenes/utf16.pbrt", "WorldBegin\n".encode("utf-16"), "utf16.pbrt")
put("scenes/nul.pbrt", b"World\0Begin\n", "nul.pbrt")
put("scenes/cut.pbrt.gz", gzip.compress(b"WorldBegin\n" * 50, mtime=0)[:-10], "cut.pbrt.gz")
put("scenes/rubbish.pbrt.gz", b"\x1f\x8b\x08" + b"\xa5" * 60, "rubbish.pbrt.gz")
put("scenes/bomb.pbrt.gz", gzip.compress(b"#" * 40_000_000 + b"\n[", 9, mtime=0), "bomb.pbrt.gz")
put("scenes/spheres.pbrt", 'WorldBegin\nShape "loopsubdiv" "integer levels" 30 "point3 P" [0 0 0 1 0 0 0 1 0] "integer indices" [0 1 2]\n', "spheres.pbrt:2:")
put("scenes/brackets.pbrt", "WorldBegin\n" + "[" * 5000 + "\n", "brackets.pbrt:2:")
put("scenes/long-word.pbrt", "WorldBegin\n" + "A" * 20000 + "\n", "long-word.pbrt:2:")

# --- models: OBJ, STL, glTF; opened by themselves ------------------------------------------------------------------------
V = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
put("models/empty.obj", "", "no faces")
put("models/no-faces.obj", V, "no faces")
put("models/index-over.obj", V + "f 1 2 4\n", "index-over.obj:4:7:")
put("models/index-zero.obj", V + "f 0 1 2\n", "index-zero.obj:4:3:")
put("models/index-billion.obj", V + "f 1 2 1000000000\n", "index-billion.obj:4:7:")
put("models/index-2e40.obj", V + "f 1 2 1099511627776\n", "index-2e40.obj:4:7:")
put("models/index-back.obj", V + "f -1 -2 -9\n", "index-back.obj:4:9:")
put("models/index-word.obj", V + "f 1 2 three\n", "index-word.obj:4:7:")
put("models/nan.obj", "v 0 0 nan\n" + V + "f 1 2 3\n", "nan.obj:1:7:")
put("models/infinite.obj", "v 0 1e999 0\n" + V + "f 1 2 3\n", "infinite.obj:1:5:")
put("models/short-vertex.obj", "v 0 0\n" + V + "f 1 2 3\n", "short-vertex.obj:1:")
put("models/flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "no faces")
put("models/utf16.obj", (V + "f 1 2 3\n").encode("utf-16"), "UTF-16")
put("models/nul.obj", V.encode() + b"f 1 2\0 3\n", "is zero")
put("models/itself.obj", "mtllib itself.obj\n" + V + "f 1 2 9\n", "itself.obj:5:7:")
put("models/polygon.obj", V + "f" + " 1 2 3" * 3000 + " 9\n", "polygon.obj:4:")

FACET = struct.pack("<12f", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0) + b"\0\0"
put("models/empty.stl", "", "the header ends early")
put("models/head.stl", b"\0" * 60, "the header ends early")
put("models/cut.stl", b"\0" * 80 + struct.pack("<I", 2) + FACET + FACET[:30], "2 facets declared, 1 found")
put("models/count-2e32.stl", b"\0" * 80 + struct.pack("<I", 0xFFFFFFFF) + FACET, "4294967295 facets declared")
put("models/none.stl", b"\0" * 84, "no faces")
put("models/nan.stl", b"\0" * 80 + struct.pack("<I", 1) + struct.pack("<12f", 0, 0, 1, 0, 0, 0, 1, float("nan"), 0, 0, 1, 0) + b"\0\0", "byte 108")
put("models/word.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n", "word.stl:4:12:")
put("models/open.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex", "ends inside a facet")
put("models/four.stl", "solid a\nfacet normal 0 0 1\nouter loop\n" + "vertex 0 0 0\n" * 4 + "endloop\nendfacet\nendsolid\n", "four.stl:7:1:")

BUFFER = struct.pack("<9f3H", 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2)


def gltf(**change):
    root = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}, {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "buffers": [{"byteLength": len(BUFFER), "uri": "data:application/octet-stream;base64," + base64.b64encode(BUFFER).decode()}],
    }
    for path, value in change.items():
        *keys, last = [int(k) if k.isdigit() else k for k in path.split("__")]
        target = root
        for key in keys:
            target = target[key]
        if isinstance(target, list) and last == len(target):
            target.append(value)
        else:
            target[last] = value
    return json.dumps(root)


def glb(text, version=2, length=None, chunk=None, kind=b"JSON"):
    data = text.encode() + b" " * (-len(text) % 4)
    body = struct.pack("<I", len(data) if chunk is None else chunk) + kind + data
    return b"glTF" + struct.pack("<II", version, 12 + len(body) if length is None else length) + body


put("models/syntax.gltf", '{\n "asset": {"version": "2.0"},\n nodes\n}', "syntax.gltf:3:3:")
put("models/empty.gltf", "", "empty.gltf")
put("models/array.gltf", "[1, 2, 3]", "array.gltf")
put("models/version-1.gltf", gltf(asset={"version": "1.0"}), "glTF 1.0")
put("models/no-mesh.gltf", gltf(nodes=[{"name": "nothing"}]), "shows nothing")
put("models/scene-9.gltf", gltf(scene=9), "scene 9")
put("models/node-9.gltf", gltf(scenes__0__nodes=[9]), "node 9")
put("models/node-itself.gltf", gltf(nodes__0__children=[0]), "twice")
put("models/node-circle.gltf", gltf(nodes=[{"mesh": 0, "children": [1]}, {"children": [0]}]), "twice")
put("models/node-deep.gltf", gltf(nodes=[{"children": [i + 1]} for i in range(600)] + [{"mesh": 0}]), "deep")
put("models/matrix-nan.gltf", gltf(nodes__0__matrix=[1e999] * 16).replace("Infinity", "1e999"), "")
put("models/matrix-projective.gltf", gltf(nodes__0__matrix=[1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), "not affine")
put("models/mesh-9.gltf", gltf(nodes__0__mesh=9), "mesh 9")
put("models/accessor-9.gltf", gltf(meshes__0__primitives__0__attributes={"POSITION": 9}), "accessor 9")
put("models/count-over.gltf", gltf(accessors__0__count=4), "accessor 0 reads 4 elements")
put("models/count-2e40.gltf", gltf(accessors__0__count=1 << 40), "accessor 0")
put("models/count-negative.gltf", gltf(accessors__0__count=-3), "")
put("models/count-no-view.gltf", gltf(accessors__0={"componentType": 5126, "count": 1 << 40, "type": "VEC3"}), "has no data")
put("models/offset-over.gltf", gltf(accessors__0__byteOffset=1 << 33), "from byte 8589934592")
put("models/view-9.gltf", gltf(accessors__0__bufferView=9), "buffer view 9")
put("models/view-over.gltf", gltf(bufferViews__0__byteLength=4000), "buffer view 0 reaches to byte")
put("models/view-offset.gltf", gltf(bufferViews__0__byteOffset=(1 << 63) - 1), "buffer view 0 reaches to byte")
put("models/stride-small.gltf", gltf(bufferViews__0__byteStride=4), "accessor 0")
put("models/buffer-9.gltf", gltf(bufferViews__0__buffer=9), "buffer 9")
put("models/buffer-missing.gltf", gltf(buffers__0__uri="not-there.bin"), "not-there.bin")
put("models/buffer-base64.gltf", gltf(buffers__0__uri="data:application/octet-stream;base64,%%%"), "")
put("models/index-over.gltf", gltf(accessors__1__count=2, accessors__2={"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"}, meshes__0__primitives__0__indices=0), "accessor 0")
put("models/vertex-over.gltf", gltf(accessors__0__count=2), "vertex 2 of 2")
put("models/type-wrong.gltf", gltf(accessors__0__type="MAT4"), "accessor 0 has the wrong type")
put("models/component-unknown.gltf", gltf(accessors__0__componentType=5130), "")
put("models/sparse-over.gltf", gltf(accessors__0__sparse={"count": 1, "indices": {"bufferView": 1, "componentType": 5123, "byteOffset": 4}, "values": {"bufferView": 9}}), "buffer view 9")
put("models/sparse-index.gltf", gltf(accessors__0__count=2, accessors__0__sparse={"count": 1, "indices": {"bufferView": 1, "componentType": 5123, "byteOffset": 4}, "values": {"bufferView": 0}}), "a sparse index is beyond")
put("models/skin-joint.gltf", gltf(nodes__0__skin=0, skins=[{"joints": [77]}], meshes__0__primitives__0__attributes={"POSITION": 0, "JOINTS_0": 9, "WEIGHTS_0": 9}), "accessor 9")
put("models/texture-9.gltf", gltf(meshes__0__primitives__0__material=0, materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 9}}}]), "texture 9")
put("models/material-9.gltf", gltf(meshes__0__primitives__0__material=9), "material 9")
put("models/image-view.gltf", gltf(meshes__0__primitives__0__material=0, materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], textures=[{"source": 0}], images=[{"bufferView": 1, "mimeType": "image/png"}]), "report:not a picture")
put("models/image-huge.gltf", gltf(meshes__0__primitives__0__material=0, materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], textures=[{"source": 0}], images=[{"uri": "data:image/png;base64," + base64.b64encode(png(16000, 16000, chunk(b"IDAT", b"\x78\x9c"))).decode()}]), "report:has only")
def pictured(data, kind="image/png"):
    return gltf(meshes__0__primitives__0__material=0, materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}], textures=[{"source": 0}],
                images=[{"uri": f"data:{kind};base64," + base64.b64encode(data).decode()}])


put("models/image-codes.gltf", pictured(JPEG + bytes.fromhex("ffc4028600" + "28" * 16) + bytes(640) + b"\xff\xd9", "image/jpeg"), "report:broken")
put("models/image-cut.gltf", pictured(png(4, 4, chunk(b"IDAT", zlib.compress(b"\0" * 52)))[:50]), "report:truncated")
put("models/deep-20000.gltf", gltf()[:-1] + ', "extras": ' + "[" * 20000 + "]" * 20000 + "}", "deep-20000.gltf:1:")
put("models/deep-20000.glb", glb(gltf()[:-1] + ', "extras": ' + '{"a":' * 20000 + "1" + "}" * 20000 + "}"), "nested more than 256 deep")
put("models/draco.gltf", gltf(extensionsRequired=["KHR_draco_mesh_compression"]), "KHR_draco_mesh_compression")
put("models/light-9.gltf", gltf(nodes__0__extensions={"KHR_lights_punctual": {"light": 9}}), "light 9")
put("models/camera-9.gltf", gltf(nodes__0__camera=9), "camera 9")
put("models/short.glb", b"glTF\2\0\0\0", "header ends early")
put("models/version-1.glb", glb("{}", version=1), "GLB version 1")
put("models/length.glb", glb(gltf(), length=99999), "byte 8")
put("models/chunk.glb", glb(gltf(), chunk=0xFFFFFF00), "byte 12")
put("models/kind.glb", glb(gltf(), kind=b"LATN"), "kind.glb")
put("models/text.glb", glb("{}"), "text.glb")
put("models/no-magic.glb", b"GLTF" + b"\0" * 60, "no-magic.glb")

(here / "expected.txt").write_text("".join(expected))
