"""The deck reader: what it accepts, and every mistake named by line, group and key.

All through `snapin --check`, which prints "DECK: ok" or the mistakes and computes nothing.
"""

import pytest
from support.decks import (
    ACCEPTED, BODIES, FORCE, GOOD, LOADING, assert_refused, body, extra, with_bodies, with_extra)


@pytest.mark.parametrize("text", ACCEPTED.values(), ids=ACCEPTED.keys())
def test_good_deck_is_accepted(check, text):
    status, out, err = check(text)
    assert (status, out) == (0, "d.nml: ok\n")
    # That results will be large, or that a sweep leaves tables out, is no mistake.
    assert all("its results take" in line or "a sweep writes no" in line
               for line in err.splitlines())


# --- Refused

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
    "unknown key": body("raduis = 1, stiffness = 1 /", "raduis", 'did you mean "radius"'),
    "unknown key lists keys": body("\n q = 1 /", "q", "radius, stiffness", line=2),
    "key of a keyless group": extra("&stability\n x = 1 /", "x", "no keys", line=5),
    "duplicate key": body("radius = 1,\n stiffness = 1\n radius = 1 /", "radius",
                          "given twice; the first is on line 1", line=3),
    "subscript": extra("&profiles h0(2) = 1 /", "h0", "subscripts"),
    "subscript with blanks": extra("&profiles h0( 1, 2 ) = 1 /", "h0", "subscripts"),
    "component": body("a%b = 1 /", "a%b", "not the name of a key"),
    "digit first": body("1radius = 1 /", "1radius", "not the name of a key"),
    "value without a key": body("1.5, stiffness = 1 /", "", "without a key"),
    "equals without a key": body("= 1 /", "", "without the name"),
    "two equals": body("radius == 1 /", "radius", "without the name"),
    "missing separator": body("radius = 1stiffness = 2 /", "radius",
                              'no value between "=" and the next key "1stiffness"'),
    "missing required key": body("\n stiffness = 1 /", "radius", "missing; give it a number > 0 m"),
    "missing group": (FORCE + LOADING, 1, "bodies", "", "missing"),
    # values
    **{f"{text} for a number": body(f"radius = {text} /", "radius", f"{text} is not a number")
       for text in ("1.0.0 3-1 1.0-2 1e e5 . - 0x10 (1,0) big .true. nan(1)").split()},
    "empty value before a key": body("radius =\n stiffness = 1 /", "radius", "no value"),
    "empty value at the end": body("stiffness = 1,\n radius = /", "radius", "no value", line=2),
    "empty value before a comma": body("radius = , stiffness = 1 /", "radius", "no value"),
    "null in a list": extra("&profiles h0 = 1e-9,,2e-9 /", "h0", "no value before it"),
    "comma first": body(", radius = 1 /", "", "no value before it"),
    "null by repeat count": extra("&profiles h0 = 3* /", "h0", "not a number"),
    "repeat count for a scalar": body("radius = 2*1.0, stiffness = 1 /", "radius",
                                      "where one is expected"),
    "too many repeats": extra("&profiles h0 = 1001*1e-9 /", "h0", "too many values"),
    "huge repeat count": extra("&profiles h0 = 999999999*1e-9 /", "h0", "too many values"),
    "a repeat count that overflows": extra("&profiles h0 = 1e-9, 2147483647*1e-9 /", "h0",
                                           "too many values"),
    "NaN": body("radius = NaN, stiffness = 1 /", "radius", "finite"),
    "Inf": body("radius = 1, stiffness = -Inf /", "stiffness", "finite"),
    "Infinity": body("radius = +infinity /", "radius", "finite"),
    "overflow": body("radius = 1e999 /", "radius", "too large"),
    "overflow just": body("radius = 9.9e308 /", "radius", "too large"),
    "overflow by digits": body("radius = 1" + "0" * 90 + "e250 /", "radius", "too large"),
    "an exponent that overflows with its digits": body("radius = 10e2147483647 /", "radius",
                                                       "too large"),
    "a number that nothing has": body("radius = 1e51 /", "radius",
                                      "too large; numbers have decimal orders from -50 to 50"),
    "exponent beyond all": body("radius = 1e99999999999 /", "radius", "too large or too small"),
    "underflow": body("radius = 1e-999 /", "radius", "too small"),
    "decimal comma": body("radius = 1,5 /", "radius", "the decimal sign is a point: 1.5;"),
    "decimal comma and order": body("radius = -1,5e-6 /", "radius", "is a point: -1.5e-6;"),
    "two values": body("radius = 1, 5 /", "radius", "2 values where one is expected"),
    "two values of a comma": body("radius = 1.5,5 /", "radius", "2 values where one is expected"),
    "a blank in a number": body("radius = 1.5 e-6 /", "radius", "a blank in it; write 1.5e-6;"),
    "a unit": body("radius = 15mm /", "radius", "numbers have no units in a deck; write 15e-3;"),
    "a unit after an order": body("radius = 15e-3m /", "radius", "in a deck; write 15e-3;"),
    "a unit after a blank": body("radius = 1 um /", "radius",
                                 "um after a number: numbers have no units in a deck; write 1e-6;"),
    "a unit of another quantity": body("radius = 1 nN /", "radius", "no units in a deck; allowed"),
    "units in a list": body("radius = 1, young = 70 GPa, 2 GPa /", "young", "write 70e9;"),
    "a Greek unit": (BODIES.replace("radius = ", "radius = 1 \u00b5m "), 1, "bodies", "",
                     "numbers have no units in a deck: 1e-6 for micro"),
    "a unit with a slash": (with_extra("&device stiffness = 42 N/m /\n"), 4, "", "",
                            "neither units nor fractions"),
    "a semicolon": body("radius = 1; stiffness = 1 /", "radius", "not a number"),
    "a quoted number": body("radius = '1' /", "radius", "text in quotes"),
    "tomato": body("radius = 1, rigid = tomato /", "rigid", "tomato is neither .true. nor .false."),
    "a number for a logical": body("radius = 1, rigid = 1 /", "rigid", ".true. or .false."),
    "too many values for a scalar": body("radius = 1 2 3, stiffness = 1 /", "radius",
                                         "3 values where one is expected"),
    "too many values for a list": body("radius = 1, young = 1, 2, 3, poisson = 0 /", "young",
                                       "too many values"),
    "a real for a whole number": extra("&numerics nodes = 20.5 /", "nodes", "not a whole number"),
    "a whole number too large": extra("&numerics nodes = 99999999999 /", "nodes", "too large"),
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
    "a quote in a word": body("radius = 1'm' /", "", "middle of a word"),
    # bytes
    "a NUL byte": (GOOD.encode() + b"\n\0\n", 5, "", "", "NUL"),
    "a minus from a word processor": body("radius = \u22121 /", "", "not plain ASCII"),
    "accents in a string": ("&scene title = 'M\u00fcller' /\n" + GOOD, 1, "scene", "title",
                            "not plain ASCII"),
    "a no-break space": body("radius =\u00a01 /", "", "not plain ASCII"),
    "a control character": body("radius = 1\x0b /", "", "not plain ASCII"),
}


@pytest.mark.parametrize("case", REFUSED.values(), ids=REFUSED.keys())
def test_bad_deck_is_refused_by_line_group_and_key(check, case):
    assert_refused(check, *case)


@pytest.mark.parametrize("text", ["", "\n\n", "! only a comment\n"])
def test_empty_deck_names_the_groups_it_needs(check, text):
    status, _, err = check(text)
    assert status == 2
    assert "d.nml:1: &bodies: this group is missing" in err


def test_deck_without_any_force_says_where_to_find_them(check):
    status, _, err = check(
        "&bodies radius = 1, rigid = .true. /\n&loading h0_start=2,h0_end=1,h0_step=1 /")
    assert status == 2
    assert "d.nml:1: &force: this group is missing" in err and "--keys" in err


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


@pytest.mark.parametrize("length", [100, 100000])
def test_an_endless_name_is_shortened(check, length):
    status, _, err = check(with_bodies(f"{'x' * length} = 1 /"))
    assert status == 2
    assert "no such key" in err
    assert max(map(len, err.splitlines())) < 250
