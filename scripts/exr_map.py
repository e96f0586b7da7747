# SPDX-License-Identifier: Apache-2.0
"""Writes small OpenEXR maps, for the scripts beside this one."""
import math
import struct
import zlib


def rounded_half(value):
    """Two bytes of a half with 7 significant bits."""
    mantissa, exponent = math.frexp(value)
    return struct.pack("<e", math.ldexp(round(mantissa * 128) / 128, exponent))


def zip_block(data):
    """OpenEXR's ZIP: bytes split by parity, differences, deflate."""
    split = data[0::2] + data[1::2]
    different = bytes([split[0]]) + bytes(
        (b - a + 128) & 255 for a, b in zip(split, split[1:]))
    packed = zlib.compress(different, 9)
    return packed if len(packed) < len(data) else data


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def exr(rows, script):
    """A lat-long map from rows of pixels (R, G, B); the script is named in its comments."""
    width, height = len(rows[0]), len(rows)
    channels = b"".join(c + b"\0" + struct.pack("<iiii", 1, 0, 1, 1) for c in (b"B", b"G", b"R"))
    window = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    comments = b"Made by scripts/%s of the Airlight project; CC0." % script.encode()
    header = b"\x76\x2f\x31\x01" + struct.pack("<i", 2)
    header += attribute("channels", "chlist", channels + b"\0")
    header += attribute("comments", "string", comments)
    header += attribute("compression", "compression", b"\x03")
    header += attribute("dataWindow", "box2i", window)
    header += attribute("displayWindow", "box2i", window)
    header += attribute("envmap", "envmap", b"\0")
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    blocks = []
    for first in range(0, height, 16):
        data = b"".join(b"".join(rounded_half(p[c]) for p in row)
                        for row in rows[first:first + 16] for c in (2, 1, 0))
        packed = zip_block(data)
        blocks.append(struct.pack("<ii", first, len(packed)) + packed)
    offset = len(header) + 8 * len(blocks)
    table = b""
    for block in blocks:
        table += struct.pack("<Q", offset)
        offset += len(block)
    return header + table + b"".join(blocks)
