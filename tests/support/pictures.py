"""What tests read of pictures, and the groups of decks whose results are drawn."""

import struct

BODIES = "&bodies radius = 1.5e-2, stiffness = 1.0e10 /\n"
FORCE = "&force law = 'lennard_jones', hamaker = 1.0e-20, z0 = 0.5e-9 /\n"
CYCLE = """&loading h0_start = 4e-9, h0_end = -1e-9, h0_step = 0.25e-9 /
&unloading from = 0e-9, -1e-9 /
"""
PATH = "&equilibrium_path h0_end = 0 /\n"
SWEEP = BODIES + FORCE + PATH + "&sweep key = 'force.hamaker', values = 1e-21, 1e-20 /\n"


def size_of(png):
    """Return width and height in pixels of a PNG file."""
    head = png.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">2I", head[16:])
