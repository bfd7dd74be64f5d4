# SPDX-License-Identifier: Apache-2.0
"""Reads the EXR files that Restage writes (one part, scan lines, ZIP), with only zlib and NumPy: an independent check of
their contents, not a general reader. After the "OpenEXR File Layout" document."""
import struct
import zlib

import numpy as np

DTYPES = [np.dtype("<u4"), np.dtype("<f2"), np.dtype("<f4")]
ZIP = 3


def header(data):
    """({attribute: bytes}, where the header ends)"""
    assert data[:4] == b"\x76\x2f\x31\x01", "not an EXR file"
    attributes, at = {}, 8
    while data[at]:
        name_end = data.index(0, at)
        type_end = data.index(0, name_end + 1)
        size = struct.unpack_from("<i", data, type_end + 1)[0]
        attributes[data[at:name_end].decode()] = data[type_end + 5:type_end + 5 + size]
        at = type_end + 5 + size
    return attributes, at + 1


def channels(value):
    """[(name, dtype)] in the order of the file"""
    found, at = [], 0
    while value[at]:
        end = value.index(0, at)
        found.append((value[at:end].decode(), DTYPES[struct.unpack_from("<i", value, end + 1)[0]]))
        at = end + 17
    return found


def unzip(block, size):
    """Undoes deflate, the differences between bytes, and the split into even and odd ones."""
    if len(block) == size:
        return block
    steps = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    steps[1:] -= 128
    halves = (np.cumsum(steps) & 255).astype(np.uint8)
    out = np.empty(size, np.uint8)
    out[0::2], out[1::2] = halves[:(size + 1) // 2], halves[(size + 1) // 2:]
    return out.tobytes()


def read(path):
    """{"R": array[height, width], "stderr.Y": ..., ...}"""
    data = path.read_bytes()
    attributes, at = header(data)
    assert attributes["compression"] == bytes([ZIP])
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height, rows = x1 - x0 + 1, y1 - y0 + 1, 16
    names = channels(attributes["channels"])
    image = {name: np.empty((height, width), dtype) for name, dtype in names}
    for offset in struct.unpack_from(f"<{-(-height // rows)}Q", data, at):
        first, size = struct.unpack_from("<2i", data, offset)
        first -= y0
        count = min(rows, height - first)
        pixels = unzip(data[offset + 8:offset + 8 + size], count * width * sum(dtype.itemsize for _, dtype in names))
        position = 0
        for y in range(first, first + count):
            for name, dtype in names:
                image[name][y] = np.frombuffer(pixels, dtype, width, position)
                position += width * dtype.itemsize
    return image
