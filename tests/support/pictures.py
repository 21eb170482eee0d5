"""What tests read of pictures."""

import struct


def size_of(png):
    """Return width and height in pixels of a PNG file."""
    head = png.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">2I", head[16:])
