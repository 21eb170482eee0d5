"""Decks for the tests of the deck reader: good decks, and the beginnings of bad decks."""

import re

BODIES = "&bodies radius = 1.5e-2, stiffness = 1.0e10 /\n"
FORCE = "&force law = 'lennard_jones', hamaker = 1.0e-19, z0 = 0.5e-9 /\n"
LOADING = "&loading h0_start = 7e-9, h0_end = -2e-9, h0_step = 0.05e-9 /\n"
GOOD = BODIES + FORCE + LOADING
LAYERED = (
    "&bodies radius = 1.5e-2, young = 70e9, poisson = 0.2 /\n"
    "&layer thickness = 1e-6, 2e-6, young = 1e6, 2e6, poisson = 0.45, 0.5, body = 1 /\n"
    + FORCE + LOADING)

FULL = """! every group of a scene at once
&scene  title = 'Fig. 10(c), it''s "full"' /
&bodies radius = 1.5e-2, young = 70e9, 3e6, poisson = 0.3, 0.5 /
&force  law = 'lennard_jones', hamaker = 1.0e-19, z0 = 0.5e-9, part = 'full' /
&loading   h0_start = 7e-9, h0_end = -2e-9, h0_step = 0.05e-9 /
&unloading from = 1e-9, -2e-9, h0_end = 7e-9, h0_step = 0.05e-9 /
&equilibrium_path h0_start = 6e-9, h0_end = -2e-9 /
&device    stiffness = 1e5, 0, z_start = 8e-9, z_end = -1e-9 /
&fixed_load load = 0, -1e-4 /
&table /
&regime /
&profiles  h0 = 4.3e-9, 3.6e-9 /
&approximations count = 50 /
&classical theories = 'hertz', 'jkr', 'carpick' /
&stability /
&numerics  method = 'anderson', accuracy = 1e-6, nodes = 400, r_max = 1e-6 /
"""

RUNTIME_ERROR = re.compile(r"fortran runtime error|backtrace|sigsegv|at line \d+ of file", re.I)

ACCEPTED = {
    "one line a group": GOOD,
    "comment at the end": GOOD + "! the end",
    "comment right after a value": GOOD.replace("1.0e10 /", "1.0e10! soft\n/"),
    "quote and slash in a comment": "! don't / stop &here\n" + GOOD,
    "no final newline": GOOD.rstrip("\n"),
    "slash right after a value": GOOD.replace("1.0e10 /", "1.0e10/"),
    "crlf": GOOD.replace("\n", "\r\n"),
    "old mac line ends": GOOD.replace("\n", "\r"),
    "tabs": GOOD.replace(" ", "\t"),
    "byte-order mark": b"\xef\xbb\xbf" + GOOD.encode(),
    "utf-16 with a mark": ("! Müller, µ\n" + GOOD).encode("utf-16"),
    "utf-16, high byte first": GOOD.encode("utf-16-be"),
    "accents in a comment": "! Müller, σ = 1\n" + GOOD,
    "&end": GOOD.replace("/", "&end"),
    "&END at the end of the file": BODIES + FORCE + LOADING.replace("/\n", "&END"),
    "all groups on one line": GOOD.replace("\n", " "),
    "blanks for commas": GOOD.replace(",", " "),
    "a comma after the last value": GOOD.replace("1.0e10", "1.0e10,"),
    "a key a line": GOOD.replace(", ", "\n   "),
    "value on the line after =": GOOD.replace("radius = ", "radius =\n ! here\n "),
    "no blanks": GOOD.replace(" = ", "="),
    "capitals": GOOD.upper().replace("LENNARD_JONES", "lennard_jones"),
    "capitals in a choice": GOOD.replace("lennard_jones", "Lennard_Jones"),
    "double quotes": GOOD.replace("'", '"'),
    "doubled quotes": "&scene title = 'it''s' /\n" + GOOD,
    "the other quote inside": "&scene title = \"it's / & ! = ,\" /\n" + GOOD,
    "empty title": "&scene title = '' /\n" + GOOD,
    "empty group": "&scene /\n" + GOOD,
    "keyless groups": GOOD + "&stability /\n&classical /\n",
    "fortran exponents": GOOD.replace("1.0e10", "1d10").replace("1.5e-2", "1.5D-2"),
    "plain number forms": GOOD.replace("1.0e10", "5").replace("1.5e-2", ".5"),
    "the largest and smallest numbers": GOOD.replace("1.0e10", "9.9e50").replace("1.5e-2", "1e-50"),
    "a trailing point": GOOD.replace("1.0e10", "5.").replace("1.5e-2", "+5.e-1"),
    "list over several lines": GOOD + "&profiles h0 = 1e-9,\n  2e-9\n  3e-9 /\n",
    "a long line": GOOD + "&profiles h0 = " + ", ".join(["1.00000e-9"] * 1000) + " /\n",
    "a long comment": "!" + "x" * 100000 + "\n" + GOOD,
    "repeat count in a list": GOOD.replace("stiffness = 1.0e10", "young = 2*1e9, poisson = 2*0.3"),
    "rigid": GOOD.replace("stiffness = 1.0e10", "rigid = .true."),
    "rigid false beside stiffness": GOOD.replace("stiffness", "rigid = F, stiffness"),
    "one value for both bodies": GOOD.replace("stiffness = 1.0e10", "young = 1e9, poisson = 0.3"),
    "one body far stiffer": GOOD.replace("stiffness = 1.0e10", "young = 1e6 1e30 poisson = 0.5 0"),
    "layers": LAYERED,
    "a word of digits in quotes": LAYERED.replace("body = 1", "body = '1'"),
    "layers on both": LAYERED.replace("body = 1", "body = 'both'"),
    "regime of layers": LAYERED + "&equilibrium_path /\n&regime /\n",
    "layers under a rigid body": LAYERED.replace("body = 1", "body = 2, partner = 'rigid'"),
    "layers alone yield": LAYERED.replace(", young = 70e9, poisson = 0.2", "").replace(
        "body = 1", "body = 'both', base = 'rigid'"),
    "rigid bodies with layers": LAYERED.replace("young = 70e9, poisson = 0.2", "rigid = .true."),
    "layers on something rigid": LAYERED.replace("young = 70e9, poisson = 0.2", "stiffness = 1e9")
    .replace("body = 1", "base = 'rigid'"),
    "exponential law": BODIES + "&force law = 'exponential', p0 = 2.5e8, decay_length = 2e-10 /\n"
    + LOADING,
    "defaults of unloading": GOOD + "&unloading /\n",
    "path alone": BODIES + FORCE + "&equilibrium_path h0_end = -2e-9 /\n",
    "path beside loading": GOOD + "&equilibrium_path /\n",
    "classical with the range of a path": BODIES + FORCE
    + "&equilibrium_path h0_end = -2e-9 / &classical /\n",
    "classical alone": BODIES + FORCE + "&classical h0_start = 1e-9, h0_end = -1e-9 /\n",
    "approximations alone": BODIES + FORCE + "&approximations h0_start = 2e-9, h0_end = 1e-9 /\n",
    "a device that prescribes h0": BODIES + FORCE
    + "&equilibrium_path h0_end = -2e-9 / &device /\n",
    "profiles on a path": BODIES + FORCE
    + "&equilibrium_path h0_end = -2e-9 / &profiles h0 = 1e-9 /\n",
    "sweep by values": GOOD + "&sweep key = 'bodies.radius', values = 1e-3, 2e-3, 1e-2 /\n",
    "sweep of a default": GOOD + "&sweep key = 'numerics.accuracy' from = 1e-8 to = 1e-3 "
    "count = 6 scale = 'log' /\n",
    "sweep of a whole number": GOOD + "&sweep key = 'numerics.nodes' from = 100 to = 1600 "
    "count = 5 scale = 'log' /\n",
    "downward sweep": GOOD + "&sweep key = 'bodies.radius', from = 2, to = 1, count = 3 /\n",
    "every group": FULL,
    "every group of a sweep": re.sub("&(table|stability|profiles).*\n", "", FULL) +
    "&sweep key = 'force.hamaker', from = 1e-21, to = 1e-19, count = 20, scale = 'log' /\n",
    "a summary as a deck": "&summary title = 'a', sigma = NaN, unload_from = 1, 3, odd = 1e999 /\n"
    "&cost wall_seconds = 1.0 /\n" + GOOD,
}


def with_bodies(text):
    """A deck whose first line is `&bodies text` and whose other lines are correct."""
    return f"&bodies {text}\n" + FORCE + LOADING


def with_extra(text):
    return GOOD + text


def body(text, key, phrase, line=1):
    """The case of a mistake in &bodies: the deck, line, group, key and a phrase of the message."""
    return with_bodies(text), line, "bodies", key, phrase


def extra(text, key, phrase, line=4):
    """The case of a mistake in the last of the groups that follow a good deck."""
    return with_extra(text), line, re.findall(r"&(\w+)", text)[-1], key, phrase


def assert_refused(check, text, line, group, key, phrase):
    """The deck is refused, and the first mistake is that of this key of a group in this line."""
    status, out, err = check(text)
    assert (status, out) == (2, "")
    first = err.splitlines()[0]
    place = f"d.nml:{line}: " + (f"&{group}: " if group else "") + (f'key "{key}": ' if key else "")
    assert first.startswith(place), err
    if not group:
        assert not first[len(place):].startswith("&"), err
    assert phrase in err, err
