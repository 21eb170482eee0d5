"""The deck reader: what it accepts, and every mistake named by line, group and key.

All through `snapin --check`, which prints "DECK: ok" or the mistakes and computes nothing.
"""

import os
import re
import threading

import pytest

BODIES = "&bodies radius = 1.5e-2, stiffness = 1.0e10 /\n"
FORCE = "&force law = 'lennard_jones', hamaker = 1.0e-19, z0 = 0.5e-9 /\n"
LOADING = "&loading h0_start = 7e-9, h0_end = -2e-9, h0_step = 0.05e-9 /\n"
GOOD = BODIES + FORCE + LOADING

FULL = """! every group at once
&scene  title = 'Fig. 10(c), it''s "full"' /
&bodies radius = 1.5e-2, young = 70e9, 3e6, poisson = 0.3, 0.5 /
&force  law = 'lennard_jones', hamaker = 1.0e-19, z0 = 0.5e-9, part = 'full' /
&loading   h0_start = 7e-9, h0_end = -2e-9, h0_step = 0.05e-9 /
&unloading from = 1e-9, -2e-9, h0_end = 7e-9, h0_step = 0.05e-9 /
&equilibrium_path h0_start = 6e-9, h0_end = -2e-9 /
&profiles  h0 = 4.3e-9, 3.6e-9 /
&approximations count = 50 /
&classical /
&stability /
&sweep     key = 'force.hamaker', from = 1e-21, to = 1e-19, count = 20, scale = 'log' /
&numerics  method = 'anderson', accuracy = 1e-6, nodes = 400, r_max = 1e-6 /
"""

RUNTIME_ERROR = re.compile(r"fortran runtime error|backtrace|sigsegv|at line \d+ of file", re.I)


@pytest.fixture
def check(snapin, tmp_path):
    """check(text or bytes) -> (exit status, stdout, stderr) for a deck called d.nml."""

    def run(text):
        data = text if isinstance(text, bytes) else text.encode()
        (tmp_path / "d.nml").write_bytes(data)
        done = snapin("--check", "d.nml", cwd=tmp_path)
        assert not RUNTIME_ERROR.search(done.stderr + done.stdout), done.stderr
        return done.returncode, done.stdout, done.stderr

    return run


# ---------------------------------------------------------------- accepted

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
    "exponential law": BODIES + "&force law = 'exponential', p0 = 2.5e8, decay_length = 2e-10 /\n"
    + LOADING,
    "defaults of unloading": GOOD + "&unloading /\n",
    "path alone": BODIES + FORCE + "&equilibrium_path h0_end = -2e-9 /\n",
    "path beside loading": GOOD + "&equilibrium_path /\n",
    "classical with the range of a path": BODIES + FORCE
    + "&equilibrium_path h0_end = -2e-9 / &classical /\n",
    "classical alone": BODIES + FORCE + "&classical h0_start = 1e-9, h0_end = -1e-9 /\n",
    "approximations alone": BODIES + FORCE + "&approximations h0_start = 2e-9, h0_end = 1e-9 /\n",
    "profiles on a path": BODIES + FORCE
    + "&equilibrium_path h0_end = -2e-9 / &profiles h0 = 1e-9 /\n",
    "sweep by values": GOOD + "&sweep key = 'bodies.radius', values = 1e-3, 2e-3, 1e-2 /\n",
    "sweep of a default": GOOD + "&sweep key = 'numerics.accuracy' from = 1e-8 to = 1e-3 "
    "count = 6 scale = 'log' /\n",
    "sweep of a whole number": GOOD + "&sweep key = 'numerics.nodes' from = 100 to = 1600 "
    "count = 5 scale = 'log' /\n",
    "downward sweep": GOOD + "&sweep key = 'bodies.radius', from = 2, to = 1, count = 3 /\n",
    "every group": FULL,
    "a summary as a deck": "&summary title = 'a', sigma = NaN, unload_from = 1, 3, odd = 1e999 /\n"
    "&cost wall_seconds = 1.0 /\n" + GOOD,
}


@pytest.mark.parametrize("text", ACCEPTED.values(), ids=ACCEPTED.keys())
def test_good_deck_is_accepted(check, text):
    status, out, err = check(text)
    assert (status, out, err) == (0, "d.nml: ok\n", "")


# ---------------------------------------------------------------- refused


def with_bodies(text):
    """A deck whose first line is `&bodies text`, with all else in order."""
    return f"&bodies {text}\n" + FORCE + LOADING


def with_extra(text):
    """A good deck and `text` from line 4 on."""
    return GOOD + text


# name: (deck, line, group, key, phrase)
REFUSED = {
    # stray text and broken groups
    "text before a group": ("radius = 1\n" + GOOD, 1, "", "", "text before the first group"),
    "text between groups": (with_extra("\nhello\n"), 5, "", "", "text outside a group"),
    "text after the slash": (BODIES.replace("/", "/ radius = 2"), 1, "", "", "outside a group"),
    "an apostrophe outside": (with_extra("don't\n"), 4, "", "", "text outside a group"),
    "slash in a bare value": (with_bodies("radius = 1/2, stiffness = 1 /"), 1, "", "", "outside"),
    "slash alone": (with_extra("/\n"), 4, "", "", "without a group to close"),
    "dollar group": ("$bodies radius = 1 $end\n", 1, "", "", "&name"),
    "ampersand alone": ("& bodies radius = 1 /\n", 1, "", "", "must follow"),
    "not closed at the end": (GOOD + "&unloading\n from = 1e-9\n", 4, "unloading", "", "no \"/\""),
    "not closed before a group": (BODIES.replace(" /", "") + FORCE, 1, "bodies", "", "&force"),
    "nothing but an ampersand": ("&", 1, "", "", "must follow"),
    "unknown group": (with_extra("&unlading /\n"), 4, "", "", 'did you mean "&unloading"'),
    "unknown group lists groups": (with_extra("&x y = 1 /\n"), 4, "", "", "&equilibrium_path"),
    "second group": (with_extra("&bodies radius = 1 /\n"), 4, "", "", "the first is on line 1"),
    # keys
    "unknown key": (with_bodies("raduis = 1, stiffness = 1 /"), 1, "bodies", "raduis",
                    'did you mean "radius"'),
    "unknown key lists keys": (with_bodies("\n q = 1 /"), 2, "bodies", "q", "radius, stiffness"),
    "key of a keyless group": (with_extra("&stability\n x = 1 /"), 5, "stability", "x",
                               "no keys"),
    "duplicate key": (with_bodies("radius = 1,\n stiffness = 1\n radius = 1 /"), 3, "bodies",
                      "radius", "given twice; the first is on line 1"),
    "subscript": (with_extra("&profiles h0(2) = 1 /"), 4, "profiles", "h0", "subscripts"),
    "subscript with blanks": (with_extra("&profiles h0( 1, 2 ) = 1 /"), 4, "profiles", "h0",
                              "subscripts"),
    "component": (with_bodies("a%b = 1 /"), 1, "bodies", "a%b", "not the name of a key"),
    "digit first": (with_bodies("1radius = 1 /"), 1, "bodies", "1radius", "not the name of a key"),
    "value without a key": (with_bodies("1.5, stiffness = 1 /"), 1, "bodies", "", "without a key"),
    "equals without a key": (with_bodies("= 1 /"), 1, "bodies", "", "without the name"),
    "two equals": (with_bodies("radius == 1 /"), 1, "bodies", "radius", "without the name"),
    "missing separator": (with_bodies("radius = 1stiffness = 2 /"), 1, "bodies", "radius",
                          'no value between "=" and the next key "1stiffness"'),
    "missing required key": (with_bodies("\n stiffness = 1 /"), 1, "bodies", "radius",
                             "missing; give it a number > 0 m"),
    "missing group": (FORCE + LOADING, 1, "bodies", "", "missing"),
    # values
    "empty value before a key": (with_bodies("radius =\n stiffness = 1 /"), 1, "bodies", "radius",
                                 "no value"),
    "empty value at the end": (with_bodies("stiffness = 1,\n radius = /"), 2, "bodies", "radius",
                               "no value"),
    "empty value before a comma": (with_bodies("radius = , stiffness = 1 /"), 1, "bodies",
                                   "radius", "no value"),
    "null in a list": (with_extra("&profiles h0 = 1e-9,,2e-9 /"), 4, "profiles", "h0",
                       "no value before it"),
    "comma first": (with_bodies(", radius = 1 /"), 1, "bodies", "", "no value before it"),
    "null by repeat count": (with_extra("&profiles h0 = 3* /"), 4, "profiles", "h0",
                             "not a number"),
    "repeat count for a scalar": (with_bodies("radius = 2*1.0, stiffness = 1 /"), 1, "bodies",
                                  "radius", "where one is expected"),
    "too many repeats": (with_extra("&profiles h0 = 1001*1e-9 /"), 4, "profiles", "h0",
                         "too many values"),
    "huge repeat count": (with_extra("&profiles h0 = 999999999*1e-9 /"), 4, "profiles", "h0",
                          "too many values"),
    "a repeat count that overflows": (with_extra("&profiles h0 = 1e-9, 2147483647*1e-9 /"), 4,
                                      "profiles", "h0", "too many values"),
    "NaN": (with_bodies("radius = NaN, stiffness = 1 /"), 1, "bodies", "radius", "finite"),
    "Inf": (with_bodies("radius = 1, stiffness = -Inf /"), 1, "bodies", "stiffness", "finite"),
    "Infinity": (with_bodies("radius = +infinity /"), 1, "bodies", "radius", "finite"),
    "NaN with a payload": (with_bodies("radius = nan(1) /"), 1, "bodies", "radius", "not a number"),
    "overflow": (with_bodies("radius = 1e999 /"), 1, "bodies", "radius", "too large"),
    "overflow just": (with_bodies("radius = 9.9e308 /"), 1, "bodies", "radius", "too large"),
    "overflow by digits": (with_bodies("radius = 1" + "0" * 90 + "e250 /"), 1, "bodies", "radius",
                           "too large"),
    "an exponent that overflows with its digits": (
        with_bodies("radius = 10e2147483647 /"), 1, "bodies", "radius", "too large"),
    "a number that nothing has": (with_bodies("radius = 1e51 /"), 1, "bodies", "radius",
                                  "too large; numbers have decimal orders from -50 to 50"),
    "exponent beyond all": (with_bodies("radius = 1e99999999999 /"), 1, "bodies", "radius",
                            "too large or too small"),
    "underflow": (with_bodies("radius = 1e-999 /"), 1, "bodies", "radius", "too small"),
    "two points": (with_bodies("radius = 1.0.0 /"), 1, "bodies", "radius", "1.0.0 is not a number"),
    "decimal comma": (with_bodies("radius = 1,5 /"), 1, "bodies", "radius", "2 values"),
    "a unit": (with_bodies("radius = 15mm /"), 1, "bodies", "radius", "15mm is not a number"),
    "a unit after a blank": (with_bodies("radius = 15 mm /"), 1, "bodies", "radius", "2 values"),
    "an expression": (with_bodies("radius = 3-1 /"), 1, "bodies", "radius", "not a number"),
    "an exponent without a letter": (with_bodies("radius = 1.0-2 /"), 1, "bodies", "radius",
                                     "not a number"),
    "an exponent without digits": (with_bodies("radius = 1e /"), 1, "bodies", "radius",
                                   "not a number"),
    "an exponent alone": (with_bodies("radius = e5 /"), 1, "bodies", "radius", "not a number"),
    "a point alone": (with_bodies("radius = . /"), 1, "bodies", "radius", "not a number"),
    "a sign alone": (with_bodies("radius = - /"), 1, "bodies", "radius", "not a number"),
    "hexadecimal": (with_bodies("radius = 0x10 /"), 1, "bodies", "radius", "not a number"),
    "a complex number": (with_bodies("radius = (1,0) /"), 1, "bodies", "radius", "not a number"),
    "a semicolon": (with_bodies("radius = 1; stiffness = 1 /"), 1, "bodies", "radius",
                    "not a number"),
    "a quoted number": (with_bodies("radius = '1' /"), 1, "bodies", "radius", "text in quotes"),
    "a word for a number": (with_bodies("radius = big /"), 1, "bodies", "radius", "not a number"),
    "a logical for a number": (with_bodies("radius = .true. /"), 1, "bodies", "radius",
                               "not a number"),
    "tomato": (with_bodies("radius = 1, rigid = tomato /"), 1, "bodies", "rigid",
               "tomato is neither .true. nor .false."),
    "a number for a logical": (with_bodies("radius = 1, rigid = 1 /"), 1, "bodies", "rigid",
                               ".true. or .false."),
    "too many values for a scalar": (with_bodies("radius = 1 2 3, stiffness = 1 /"), 1, "bodies",
                                     "radius", "3 values where one is expected"),
    "too many values for a list": (with_bodies("radius = 1, young = 1, 2, 3, poisson = 0 /"), 1,
                                   "bodies", "young", "too many values"),
    "a real for a whole number": (with_extra("&numerics nodes = 20.5 /"), 4, "numerics", "nodes",
                                  "not a whole number"),
    "a whole number too large": (with_extra("&numerics nodes = 99999999999 /"), 4, "numerics",
                                 "nodes", "too large"),
    "a whole number out of range": (with_extra("&numerics nodes = 1 /"), 4, "numerics", "nodes",
                                    "from 2 to 20000"),
    "a bare word": (GOOD.replace("'lennard_jones'", "lennard_jones"), 2, "force", "law",
                    "not in quotes"),
    "a bare title": ("&scene title = Fig 10 /\n" + GOOD, 1, "scene", "title", "2 values"),
    "an unknown choice": (GOOD.replace("lennard_jones", "lenard_jones"), 2, "force", "law",
                          'did you mean "lennard_jones"'),
    "choices are listed": (GOOD.replace("lennard_jones", "x"), 2, "force", "law",
                           "one of 'lennard_jones', 'exponential'"),
    "an empty choice": (GOOD.replace("lennard_jones", ""), 2, "force", "law", "not known"),
    "two choices in one": (GOOD.replace("lennard_jones", "lennard_jones exponential"), 2, "force",
                           "law", "not known"),
    "a title too long": ("&scene title = '" + "x" * 201 + "' /\n" + GOOD, 1, "scene", "title",
                         "too long; allowed: text in quotes, at most 200 characters"),
    "a string not closed": ("&scene title = 'Fig. 10 /\n" + GOOD, 1, "scene", "title",
                            "no closing '"),
    "a string not closed at the end": (GOOD + '&scene title = "x', 4, "scene", "title",
                                       'no closing "'),
    "text after a string": ("&scene title = 'it's' /\n" + GOOD, 1, "scene", "title",
                            "right after a closing quote"),
    "a quote in a word": (with_bodies("radius = 1'm' /"), 1, "bodies", "", "middle of a word"),
    # bytes
    "a NUL byte": (GOOD.encode() + b"\n\0\n", 5, "", "", "NUL"),
    "utf-16": (GOOD.encode("utf-16"), 1, "", "", "NUL"),
    "a minus from a word processor": (with_bodies("radius = \u22121 /"), 1, "bodies", "",
                                      "not plain ASCII"),
    "accents in a string": ("&scene title = 'M\u00fcller' /\n" + GOOD, 1, "scene", "title",
                            "not plain ASCII"),
    "a no-break space": (with_bodies("radius =\u00a01 /"), 1, "bodies", "", "not plain ASCII"),
    "a control character": (with_bodies("radius = 1\x0b /"), 1, "bodies", "", "not plain ASCII"),
    # ranges of single keys
    "negative radius": (with_bodies("radius = -1, stiffness = 1 /"), 1, "bodies", "radius",
                        "-1 is out of range; allowed: a number > 0 m"),
    "zero stiffness": (with_bodies("radius = 1, stiffness = 0 /"), 1, "bodies", "stiffness",
                       "> 0 Pa"),
    "poisson too large": (with_bodies("radius = 1, young = 1, poisson = 0.51 /"), 1, "bodies",
                          "poisson", "<= 0.5"),
    "poisson at -1": (with_bodies("radius = 1, young = 1, poisson = -1 /"), 1, "bodies", "poisson",
                      "> -1"),
    "accuracy too small": (with_extra("&numerics accuracy = 1e-11 /"), 4, "numerics", "accuracy",
                           "out of range"),
    "mixing limit zero": (with_extra("&numerics mixing_limit = 0 /"), 4, "numerics",
                          "mixing_limit", "> 0 and <= 1"),
    "negative step": (GOOD.replace("0.05e-9", "-0.05e-9"), 3, "loading", "h0_step", "> 0 m"),
    # keys against each other
    "no stiffness": (with_bodies("radius = 1 /"), 1, "bodies", "stiffness", "give one of"),
    "rigid false alone": (with_bodies("radius = 1, rigid = .false. /"), 1, "bodies", "stiffness",
                          "give one of"),
    "stiffness and young": (with_bodies("radius = 1, stiffness = 1,\n young = 1, poisson = 0 /"),
                            2, "bodies", "young", "one way too many"),
    "rigid and stiffness": (with_bodies("radius = 1, stiffness = 1,\n rigid = .true. /"), 2,
                            "bodies", "rigid", "one way too many"),
    "young alone": (with_bodies("radius = 1,\n young = 1 /"), 1, "bodies", "poisson",
                    "go together"),
    "poisson alone": (with_bodies("radius = 1, poisson = 0 /"), 1, "bodies", "young",
                      "go together"),
    "parameter missing": (GOOD.replace(", z0 = 0.5e-9", ""), 2, "force", "z0",
                          "law 'lennard_jones' needs it"),
    "parameter of another law": (GOOD.replace("z0 =", "\n p0 = 1, z0 ="), 3, "force", "p0",
                                 "belongs to law 'exponential'"),
    "part of another law": (
        BODIES + "&force law = 'exponential', p0 = 1, decay_length = 1e-9,\n part = 'full' /\n"
        + LOADING, 3, "force", "part", "belongs to law 'lennard_jones'"),
    "loading upwards": (GOOD.replace("h0_end = -2e-9", "h0_end = 8e-9"), 3, "loading", "h0_end",
                        "not below h0_start"),
    "loading nowhere": (GOOD.replace("h0_end = -2e-9", "h0_end = 7e-9"), 3, "loading", "h0_end",
                        "not below h0_start"),
    "too many steps": (GOOD.replace("0.05e-9", "0.05e-18"), 3, "loading", "h0_step",
                       "10 million"),
    "too many steps by far": (GOOD.replace("0.05e-9", "1e-49").replace("7e-9", "1e49"),
                                       3, "loading", "h0_step", "10 million"),
    "unloading without loading": (BODIES + FORCE + "&equilibrium_path h0_end = 0 /\n&unloading /",
                                  4, "unloading", "", "needs &loading"),
    "unloading from outside": (with_extra("&unloading\n from = 1e-9, -3e-9 /"), 5, "unloading",
                               "from", "outside the range of &loading"),
    "unloading downwards": (with_extra("&unloading from = 1e-9\n h0_end = 0.5e-9 /"), 5,
                            "unloading", "h0_end", "not above the turning point"),
    "too many unloading steps": (with_extra("&unloading h0_step = 1e-18 /"), 4, "unloading",
                                 "h0_step", "10 million"),
    "path without an end": (BODIES + FORCE + "&equilibrium_path /", 3, "equilibrium_path",
                            "h0_end", "missing"),
    "path upwards": (with_extra("&equilibrium_path h0_start = -3e-9 /"), 4, "equilibrium_path",
                     "h0_start", "not above h0_end"),
    "profiles of nothing": (BODIES + FORCE + "&classical h0_start = 1, h0_end = 0 /\n"
                            "&profiles h0 = 0.5 /", 4, "profiles", "", "needs &loading"),
    "profiles without h0": (with_extra("&profiles /"), 4, "profiles", "h0", "missing"),
    "profile outside": (with_extra("&profiles h0 = 1e-9, 8e-9 /"), 4, "profiles", "h0",
                        "outside the range"),
    "classical without a range": (BODIES + FORCE + "&classical /", 3, "classical", "h0_start",
                                  "&equilibrium_path to take the range from"),
    "approximations without an end": (BODIES + FORCE + "&approximations h0_start = 1 /", 3,
                                      "approximations", "h0_end", "take the range from"),
    "classical upwards": (with_extra("&classical h0_end = 8e-9 /"), 4, "classical", "h0_end",
                          "not below h0_start"),
    "stability of nothing": (BODIES + FORCE + "&classical h0_start = 1, h0_end = 0 /\n"
                             "&stability /", 4, "stability", "", "needs &loading"),
    "nothing to compute": (BODIES + FORCE, 1, "", "", "nothing to compute"),
    # sweeps
    "sweep of an unknown key": (with_extra("&sweep key = 'force.hamacker', values = 1 /"), 4,
                                "sweep", "key", 'did you mean "force.hamaker"'),
    "sweep of a group": (with_extra("&sweep key = 'force', values = 1 /"), 4, "sweep", "key",
                         "not a key that holds a number"),
    "sweep of a word": (with_extra("&sweep key = 'force.law', values = 1 /"), 4, "sweep", "key",
                        "not a key that holds a number"),
    "sweep of itself": (with_extra("&sweep key = 'sweep.count', values = 1 /"), 4, "sweep",
                        "key", "no &sweep"),
    "sweep of an absent group": (with_extra("&sweep key = 'unloading.h0_end', values = 1 /"), 4,
                                 "sweep", "key", "no &unloading"),
    "sweep of the sweep": (with_extra("&sweep key = 'sweep.count', values = 3 /"), 4, "sweep",
                           "key", "no &sweep"),
    "sweep out of range": (with_extra("&sweep key = 'bodies.radius',\n values = 1, -1 /"), 5,
                           "sweep", "values", "out of range"),
    "sweep to a wrong deck": (with_extra("&sweep key = 'loading.h0_end',\n from = 0, to = 9e-9, "
                                         "count = 3 /"), 5, "sweep", "from", "not below h0_start"),
    "sweep of a missing parameter's rival": (
        with_extra("&sweep key = 'force.p0', values = 1 /"), 4, "sweep", "values", "belongs to"),
    "sweep by halves": (with_extra("&sweep key = 'bodies.radius', from = 1, to = 2 /"), 4, "sweep",
                        "count", "missing"),
    "sweep both ways": (with_extra("&sweep key = 'bodies.radius', values = 1, 2\n from = 1 /"), 5,
                        "sweep", "from", "not together with values"),
    "scale beside values": (with_extra("&sweep key = 'bodies.radius', values = 1 scale = 'log' /"),
                            4, "sweep", "scale", "not together with values"),
    "log sweep from zero": (with_extra("&sweep key = 'bodies.radius', from = 0, to = 1, count = 3,"
                                       " scale = 'log' /"), 4, "sweep", "from", "> 0"),
    "sweep of one value": (with_extra("&sweep key = 'bodies.radius' from = 1 to = 1 count = 3 /"),
                           4, "sweep", "to", "the same as from"),
    "fractional whole number": (with_extra("&sweep key = 'numerics.nodes', values = 100, 100.5 /"),
                                4, "sweep", "values", "out of range"),
}


@pytest.mark.parametrize("case", REFUSED.values(), ids=REFUSED.keys())
def test_bad_deck_is_refused_by_line_group_and_key(check, case):
    text, line, group, key, phrase = case
    status, out, err = check(text)
    assert status == 2
    assert out == ""
    first = err.splitlines()[0]
    place = f"d.nml:{line}: " + (f"&{group}: " if group else "") + (f'key "{key}": ' if key else "")
    assert first.startswith(place), err
    if not group:
        assert not first[len(place):].startswith("&"), err
    assert phrase in err, err


@pytest.mark.parametrize("text", ["", "\n\n", "! only a comment\n"])
def test_empty_deck_names_the_groups_it_needs(check, text):
    status, _, err = check(text)
    assert status == 2
    assert "d.nml:1: &bodies: this group is missing" in err
    assert "d.nml:1: &force: this group is missing" in err


def test_caret_stands_below_the_wrong_value(check):
    _, _, err = check(with_bodies("radius = 1,\n\tstiffness = -5 /"))
    _, source, caret = err.splitlines()
    assert source.index("-5") == caret.index("^")
    assert "stiffness = -5" in source


def test_caret_is_found_in_a_very_long_line(check):
    values = ", ".join(["1e-9"] * 500 + ["wrong"] + ["1e-9"] * 400)
    _, _, err = check(with_extra(f"&profiles h0 = {values} /"))
    _, source, caret = err.splitlines()
    assert len(source) < 120
    assert source.index("wrong") == caret.index("^")


def test_all_mistakes_are_reported_in_one_run(check):
    _, _, err = check("&bodies radius = -1\n stifness = 1 /\n&force law = 'x' /\n&bogus /\n")
    found = {line.split(": ")[0] for line in err.splitlines() if line.startswith("d.nml")}
    assert found == {"d.nml:1", "d.nml:2", "d.nml:3", "d.nml:4"}


def test_endless_mistakes_are_cut_short(check):
    _, _, err = check(with_extra("&stability\n" + "x = 1\n" * 5000 + "/\n"))
    assert len(err.splitlines()) < 100
    assert "further mistakes are not shown" in err


@pytest.mark.parametrize("key, length", [("x" * 100, 100), ("x" * 100000, 100000)])
def test_an_endless_name_is_shortened(check, key, length):
    status, _, err = check(with_bodies(f"{key} = 1 /"))
    assert status == 2
    assert len(key) == length
    assert "no such key" in err
    assert max(map(len, err.splitlines())) < 250


# ---------------------------------------------------------------- files


def refused_file(snapin, path, phrase):
    done = snapin("--check", path, timeout=60)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.startswith(f"{path}: ")
    assert phrase in done.stderr
    assert not RUNTIME_ERROR.search(done.stderr)


def test_missing_file_is_refused(snapin, tmp_path):
    refused_file(snapin, tmp_path / "none.nml", "no such file")


def test_blanks_at_the_end_of_a_name_count(snapin, tmp_path):
    (tmp_path / "d.nml").write_text(GOOD)
    refused_file(snapin, f"{tmp_path}/d.nml ", "no such file")
    (tmp_path / "d.nml  ").write_text(GOOD)
    assert snapin("--check", tmp_path / "d.nml  ").returncode == 0


def test_control_characters_of_a_name_stay_out_of_messages(snapin, tmp_path):
    (tmp_path / "a\n\x1b[31mb\u00e9.nml").write_text("?")
    done = snapin("--check", "a\n\x1b[31mb\u00e9.nml", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("a??[31mb\u00e9.nml:1: ")


def test_pipe_is_read(snapin, tmp_path):
    os.mkfifo(tmp_path / "pipe")
    writer = threading.Thread(target=(tmp_path / "pipe").write_text, args=(GOOD,))
    writer.start()
    done = snapin("--check", "pipe", cwd=tmp_path)
    writer.join()
    assert (done.returncode, done.stdout) == (0, "pipe: ok\n")


def test_what_stands_in_the_way_of_a_file_is_said(snapin, tmp_path):
    (tmp_path / "d.nml").write_text(GOOD)
    (tmp_path / "loop").symlink_to("loop")
    refused_file(snapin, tmp_path / "d.nml" / "x", "Not a directory")
    refused_file(snapin, tmp_path / "loop", "symbolic links")
    refused_file(snapin, tmp_path / ("x" * 300), "too long")
    refused_file(snapin, tmp_path / ("x/" * 3000), "too long")


def test_folder_is_refused(snapin, tmp_path):
    refused_file(snapin, tmp_path, "cannot")


def test_unreadable_file_is_refused(snapin, tmp_path):
    deck = tmp_path / "secret.nml"
    deck.write_text(GOOD)
    deck.chmod(0)
    if os.access(deck, os.R_OK):
        pytest.skip("this user may read everything")
    refused_file(snapin, deck, "cannot be opened")


def test_huge_file_is_refused(snapin, tmp_path):
    deck = tmp_path / "huge.nml"
    deck.write_text(GOOD + "! " + "x" * 2_000_000)
    refused_file(snapin, deck, "larger than")


def test_endless_device_is_refused(snapin):
    if os.path.exists("/dev/zero"):
        refused_file(snapin, "/dev/zero", "larger than")


def test_binary_file_is_refused(snapin, snapin_path):
    done = snapin("--check", snapin_path, timeout=60)
    assert done.returncode == 2
    assert not RUNTIME_ERROR.search(done.stderr)


@pytest.mark.parametrize(
    "text",
    ["!\n" * 500_000, "&bodies " * 120_000, "'" * 1_000_000, "&scene title = '" + "''" * 500_000,
     "&scene a=" + "1 " * 500_000, "&scene " + "a=1 " * 250_000 + "/", "&a/" * 300_000,
     "&profiles h0 = " + "1 " * 500_000 + "/", "&scene x((((" + "(" * 900_000],
    ids=["comments", "groups", "quotes", "string", "values", "keys", "unknown groups", "list",
         "parentheses"],
)
def test_pathological_file_is_refused_at_once(snapin, tmp_path, text):
    (tmp_path / "d.nml").write_text(text)
    done = snapin("--check", "d.nml", cwd=tmp_path, timeout=20)
    assert done.returncode == 2
    assert len(done.stderr) < 20_000


# ---------------------------------------------------------------- the table


def printed_keys(snapin):
    """{group: {key: description}} as --keys prints it, without groups that are skipped."""
    table, keys = {}, None
    for line in snapin("--keys").stdout.splitlines():
        if match := re.match(r"&(\w+)(.*)", line):
            keys = {}
            if "skipped" not in match[2]:
                table[match[1]] = keys
        elif match := re.match(r"  (\w+) +(\S.*)", line):
            keys[match[1]] = match[2]
    return table


SAMPLE = {
    "a number": "0.005",
    "a whole": "10",
    "up to": "0.005",
    ".true.": ".false.",
    "text in": "'x'",
}


def sample_value(description):
    """Some value that a key described so takes."""
    if match := re.match(r"one of ('\w+')", description):
        return match[1]
    return next(value for start, value in SAMPLE.items() if description.startswith(start))


def test_every_printed_key_is_accepted(snapin, check):
    """Each key in a deck by itself: the other keys may then be missing, but it is known."""
    table = printed_keys(snapin)
    assert len(table) >= 12
    for group, keys in table.items():
        for key, description in keys.items():
            _, _, err = check(f"&{group} {key} = {sample_value(description)} /")
            assert "no such key" not in err
            assert "unknown" not in err
            assert "allowed" not in err, err


def test_every_accepted_key_is_printed(snapin, check):
    """The reader lists the keys of a group when it meets a wrong one: the same as --keys."""
    table = printed_keys(snapin)
    _, _, err = check("&no_such_group_at_all /")
    groups = re.search(r"groups are (.*)", err)[1].split(", ")
    assert groups == ["&" + group for group in table]
    for group, keys in table.items():
        _, _, err = check(f"&{group} no_such_key_at_all = 1 /")
        known = re.search(r"keys of &\w+ are (.*)", err)
        assert (known[1].split(", ") if known else []) == list(keys)


def test_keys_name_unit_default_and_meaning(snapin):
    table = printed_keys(snapin)
    assert table["bodies"]["radius"] == "a number > 0 m; required"
    assert table["numerics"]["accuracy"] == "a number from 1e-10 to 0.1; default 1e-6"
    assert table["force"]["part"].endswith("default: full")
    lines = snapin("--keys").stdout.splitlines()
    assert all(len(line) > 30 for line in lines if line.startswith(" " * 20))


# ---------------------------------------------------------------- the deck as resolved

CHEAP = """&scene title = 'it''s "so"' /
&bodies radius = 0.1, young = 2*1.1e10 poisson = 0.3 /
&force law = 'lennard_jones' hamaker = 1.2345678901234567e-19 z0 = 3d-10 /
&loading h0_start = 7e-9 h0_end = 6.9e-9 h0_step = 0.1e-9 /
&unloading /
&approximations count = 3 /
&classical h0_end = 6.95e-9 /
&stability /
&profiles h0 = 7e-9 /
&numerics accuracy = 1e-2 /
"""


def resolved(snapin, folder, name, text):
    """Runs a deck; the deck as its summary repeats it, text and {group: {key: text}}."""
    (folder / name).write_text(text)
    done = snapin("--quiet", name, cwd=folder)
    assert done.returncode in (0, 1), done.stderr
    summary = (folder / "results" / name.removesuffix(".nml") / "summary.nml").read_text()
    lines = summary.splitlines()
    start = next(i for i, line in enumerate(lines)
                 if line.startswith("&") and line.split()[0] not in ("&summary", "&cost"))
    values = {}
    for line in lines[start:]:
        if line.startswith("&"):
            group = values.setdefault(line[1:], {})
        elif match := re.match(r"  (\w+) = (.*)", line):
            group[match[1]] = match[2]
    return summary, "\n".join(lines[start:]), values


def test_resolved_deck_holds_every_value_and_default(snapin, tmp_path):
    _, _, values = resolved(snapin, tmp_path, "a.nml", CHEAP)
    assert list(values) == ["scene", "bodies", "force", "loading", "unloading", "profiles",
                            "approximations", "classical", "stability", "numerics"]
    assert values["scene"]["title"] == "'it''s \"so\"'"
    assert values["bodies"] == {
        "radius": "1.0000000000000001E-001",
        "young": "1.1000000000000000E+010, 1.1000000000000000E+010",
        "poisson": "2.9999999999999999E-001",
        "rigid": ".false.",
    }
    assert float(values["force"]["hamaker"]) == 1.2345678901234567e-19
    assert values["force"]["part"] == "'full'"
    assert float(values["unloading"]["from"]) == 6.9e-9
    assert float(values["unloading"]["h0_end"]) == 7e-9
    assert float(values["unloading"]["h0_step"]) == 0.1e-9
    assert values["approximations"]["count"] == "3"
    assert values["classical"]["count"] == "200"
    assert float(values["classical"]["h0_start"]) == 7e-9
    assert float(values["classical"]["h0_end"]) == 6.95e-9
    assert values["stability"] == {}
    assert float(values["numerics"]["accuracy"]) == 1e-2
    assert values["numerics"]["method"] == "'auto'"
    assert "nodes" not in values["numerics"]


def test_summary_can_be_run_again(snapin, tmp_path):
    summary, deck, _ = resolved(snapin, tmp_path, "a.nml", CHEAP)
    _, again, _ = resolved(snapin, tmp_path, "b.nml", summary)
    assert again == deck


def test_resolved_deck_of_the_other_law_reads_back(snapin, tmp_path):
    text = ("&bodies radius = 1e-2 rigid = T /\n&force law = 'exponential' p0 = 2.5e8 "
            "decay_length = 2e-10 /\n&loading h0_start = 5e-9 h0_end = 4.9e-9 h0_step = 1e-10 /\n"
            "&profiles h0 = " + " ".join(f"{4.9 + i/100:.2f}e-9" for i in range(11)) + " /\n")
    _, deck, values = resolved(snapin, tmp_path, "a.nml", text)
    assert "part" not in values["force"]
    _, again, _ = resolved(snapin, tmp_path, "b.nml", deck)
    assert again == deck
