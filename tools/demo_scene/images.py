# SPDX-License-Identifier: Apache-2.0
"""Tileable noise, and PNG and EXR writers on the standard library: for the textures of the bundled scenes."""

import struct
import zlib

import numpy as np


def noise(shape, seed, beta=1.0, stretch=(1.0, 1.0), low=1.0):
    """Tileable 1/f^beta noise, unit variance; stretch > 1 elongates (rows, columns); nothing below `low` cycles."""
    white = np.random.default_rng(seed).standard_normal(shape)
    fy = np.fft.fftfreq(shape[0])[:, None] * shape[0] * stretch[0]
    fx = np.fft.rfftfreq(shape[1])[None, :] * shape[1] * stretch[1]
    f = np.hypot(fy, fx)
    gain = np.where(f >= low, 1 / np.maximum(f, 1e-9) ** beta, 0.0)
    out = np.fft.irfft2(np.fft.rfft2(white) * gain, shape)
    return (out - out.mean()) / out.std()


def smoothstep(a, b, x):
    t = np.clip((x - a) / (b - a), 0, 1)
    return t * t * (3 - 2 * t)


def mix(a, b, t):
    """Interpolates between two colours (or images); t is an image or a number."""
    t = np.asarray(t, float)
    a, b = np.asarray(a, float), np.asarray(b, float)
    if t.ndim == 2:
        t = t[..., None]
    return a * (1 - t) + b * t


def srgb(linear):
    x = np.clip(linear, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * np.maximum(x, 1e-9) ** (1 / 2.4) - 0.055)


def linear(encoded):
    x = np.asarray(encoded, float)
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def colour(hexadecimal):
    """'#a0703c' as sRGB-encoded floats (textures are painted in sRGB)."""
    return np.array([int(hexadecimal[k : k + 2], 16) for k in (1, 3, 5)]) / 255


def _filtered(rows):
    """PNG's filter 4 (Paeth) for every row: (height, width * channels) bytes, preceded by the filter byte."""
    height, width, channels = rows.shape
    x = rows.astype(np.int16)
    left = np.zeros_like(x)
    left[:, 1:] = x[:, :-1]
    above = np.zeros_like(x)
    above[1:] = x[:-1]
    corner = np.zeros_like(x)
    corner[1:, 1:] = x[:-1, :-1]
    p = left + above - corner
    pa, pb, pc = abs(p - left), abs(p - above), abs(p - corner)
    guess = np.where((pa <= pb) & (pa <= pc), left, np.where(pb <= pc, above, corner))
    body = ((x - guess) & 255).astype(np.uint8).reshape(height, width * channels)
    return np.concatenate([np.full((height, 1), 4, np.uint8), body], 1)


def write_png(path, encoded, levels=256):
    """8-bit grey (h,w) or RGB (h,w,3) from floats in 0..1, already encoded; row 0 is the top.

    With fewer levels grainy images compress better; the grain hides the steps.
    """
    image = np.asarray(encoded, float)
    image = image[..., None] if image.ndim == 2 else image
    rows = np.rint(np.rint(np.clip(image, 0, 1) * (levels - 1)) / (levels - 1) * 255).astype(np.uint8)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", rows.shape[1], rows.shape[0], 8, {1: 0, 3: 2}[rows.shape[2]], 0, 0, 0)
    packed = zlib.compress(_filtered(rows).tobytes(), 9)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", packed) + chunk(b"IEND", b""))


def write_exr(path, rgb):
    """Scanline OpenEXR, half floats, ZIP blocks of 16 lines; row 0 is the top. Layout: openexr.com, "File Layout"."""
    height, width = rgb.shape[:2]

    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(c + b"\0" + struct.pack("<iBxxxii", 1, 0, 1, 1) for c in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<ii", 20000630, 2) + attribute("channels", "chlist", channels)
    head += attribute("compression", "compression", b"\3") + attribute("dataWindow", "box2i", window)
    head += attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
    head += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    blocks = []
    for y in range(0, height, 16):
        lines = np.moveaxis(rgb[y : y + 16, :, ::-1], 2, 1).astype("<f2")  # line, then channel B G R, then pixel
        raw = np.frombuffer(lines.tobytes(), np.uint8)
        split = np.concatenate([raw[0::2], raw[1::2]]).astype(np.int16)
        predicted = np.concatenate([split[:1], np.diff(split) + 128]).astype(np.uint8)
        packed = zlib.compress(predicted.tobytes(), 9)
        data = packed if len(packed) < len(raw) else raw.tobytes()
        blocks.append(struct.pack("<ii", y, len(data)) + data)
    start = len(head) + 8 * len(blocks)
    offsets = start + np.cumsum([0] + [len(b) for b in blocks[:-1]])
    path.write_bytes(head + offsets.astype("<u8").tobytes() + b"".join(blocks))
