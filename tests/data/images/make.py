# SPDX-License-Identifier: Apache-2.0
# Writes the pictures next to it, all of the same motif: 16 x 8 texels, (200,100,50) left of column 8 and (20,60,220) right of
# it, with the top left texel (255,255,255). Needs Pillow. The results are checked in; this is their source.
import pathlib
import struct
import zlib

from PIL import Image

here = pathlib.Path(__file__).parent
LEFT, RIGHT, WHITE = (200, 100, 50), (20, 60, 220), (255, 255, 255)


def texel(x, y):
    return WHITE if x == y == 0 else LEFT if x < 8 else RIGHT


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png16(path):  # 16-bit RGB, which Pillow cannot write: v * 257 is the same value
    rows = b"".join(b"\0" + b"".join(struct.pack(">3H", *(c * 257 for c in texel(x, y))) for x in range(16)) for y in range(8))
    header = struct.pack(">IIBBBBB", 16, 8, 16, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def png(path, color, depth, rows, extra=b"", interlace=0):
    header = struct.pack(">IIBBBBB", 16, 8, depth, color, 0, 0, interlace)
    body = chunk(b"IHDR", header) + extra + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + body)


def adam7():  # the seven passes: first column and row, steps
    rows = b""
    for x0, y0, dx, dy in ((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)):
        for y in range(y0, 8, dy):
            rows += b"\0" + b"".join(bytes(texel(x, y)) for x in range(x0, 16, dx))
    return rows


def tga16(path):  # X1R5G5B5, bottom up
    rows = b""
    for y in reversed(range(8)):
        for x in range(16):
            r, g, b = (c >> 3 for c in texel(x, y))
            rows += struct.pack("<H", r << 10 | g << 5 | b)
    path.write_bytes(struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 16, 8, 16, 0) + rows)


rgb = Image.new("RGB", (16, 8))
rgb.putdata([texel(x, y) for y in range(8) for x in range(16)])
rgba = rgb.convert("RGBA")
rgba.putalpha(128)
grey_alpha = Image.new("LA", (16, 8), (100, 128))
flat = Image.new("RGB", (16, 8), LEFT)  # lossy formats: nothing to ring

rgb.save(here / "rgb8.png", optimize=True)
rgba.save(here / "rgba8.png", optimize=True)
grey_alpha.save(here / "grey_alpha8.png", optimize=True)
rgb.quantize(16).save(here / "palette.png", optimize=True)
png16(here / "rgb16.png")
flat.save(here / "baseline.jpg", quality=95, optimize=True, subsampling=0)
flat.save(here / "progressive.jpg", quality=95, progressive=True, subsampling=2)
flat.convert("L").save(here / "grey.jpg", quality=95, optimize=True)
rgb.save(here / "rgb24.bmp")
rgb.save(here / "rgb24.tga")
rgb.save(here / "rgb24_rle.tga", compression="tga_rle")
rgba.save(here / "rgba32_rle.tga", compression="tga_rle")
rgb.convert("L").save(here / "grey8.tga")
tga16(here / "rgb16.tga")
# What only some decoders know.
png(here / "interlaced.png", 2, 8, adam7(), interlace=1)
gamma = chunk(b"gAMA", struct.pack(">I", 100000)) + chunk(b"sRGB", b"\0")  # neither changes a number
png(here / "gamma.png", 2, 8, b"".join(b"\0" + b"".join(bytes(texel(x, y)) for x in range(16)) for y in range(8)), gamma)
ramp = b"".join(b"\0" + b"".join(struct.pack(">H", 256 * (16 * y + x) + 77) for x in range(16)) for y in range(8))
png(here / "grey16.png", 0, 16, ramp)  # 256 i + 77: 8 bits would lose the 77
bits = b"".join(b"\0" + (b"\xaa\xaa" if y % 2 else b"\x55\x55") for y in range(8))
png(here / "palette1.png", 3, 1, bits, chunk(b"PLTE", bytes(LEFT + RIGHT)) + chunk(b"tRNS", b"\x40"))  # odd rows start with RIGHT
png(here / "grey2.png", 0, 2, b"".join(b"\0" + b"\x1b" * 4 for y in range(8)), chunk(b"tRNS", struct.pack(">H", 2)))  # 0 1 2 3, 2 is clear
rgb.save(here / "rgb8.webp", lossless=True, quality=100)
rgba.save(here / "rgba8.webp", lossless=True, quality=100, exact=True)
flat.save(here / "lossy.webp", quality=95)
flat.convert("CMYK").save(here / "cmyk.jpg", quality=95)  # with Adobe's marker, inverted
ycck = (here / "cmyk.jpg").read_bytes()
marker = ycck.index(b"Adobe")
plain = ycck[: marker - 4] + ycck[marker + 12 :]
(here / "cmyk_plain.jpg").write_bytes(plain)  # without the marker: the same numbers are the inks themselves
solid = struct.pack(">IIBBBBB", 2048, 2048, 1, 3, 0, 0, 0)  # 4 million texels of one colour in 600 bytes
solid = chunk(b"IHDR", solid) + chunk(b"PLTE", bytes(LEFT)) + chunk(b"IDAT", zlib.compress(bytes(257 * 2048), 9)) + chunk(b"IEND", b"")
(here / "solid1.png").write_bytes(b"\x89PNG\r\n\x1a\n" + solid)
