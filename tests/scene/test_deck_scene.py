"""What a deck asks for: ranges, keys against each other, and the deck as the summary repeats it.

As in test_deck.py, every mistake is named by line, group and key.
"""

import pytest
from support.decks import (
    BODIES, FORCE, GOOD, LAYERED, LOADING, assert_refused, body, extra, with_bodies, with_extra)

# --- Refused

# name: (deck, line, group, key, phrase)
REFUSED = {
    # ranges of single keys
    "negative radius": body("radius = -1, stiffness = 1 /", "radius",
                            "-1 is out of range; allowed: a number > 0 m"),
    # keys against each other
    "device without a path": extra("&device stiffness = 1 /", "", "needs &equilibrium_path"),
    "regime of rigid bodies": (
        GOOD.replace("stiffness = 1.0e10", "rigid = T") + "&equilibrium_path /\n&regime /", 5,
        "regime", "", "elastic bodies"),
    "table of bodies that repel": (
        GOOD.replace("/\n&load", ", part = 'repulsive' /\n&load") + "&equilibrium_path /\n&table /",
        5, "table", "", "a force that attracts"),
    "device upwards": extra("&equilibrium_path /\n&device z_start = 1e-9,\n z_end = 2e-9 /",
                            "z_start", "not above z_end", line=5),
    "derivative by an accuracy": extra(
        "&equilibrium_path /\n&sensitivity parameters = 'numerics.accuracy' /", "parameters",
        "bodies.radius, bodies.stiffness, force.hamaker, force.z0", line=5),
    "derivative by a range": extra(
        "&equilibrium_path /\n&sensitivity parameters = 'loading.h0_end' /", "parameters",
        "not a number of bodies, shape or forces", line=5),
    "derivative by a word": extra("&equilibrium_path /\n&sensitivity parameters = 'force.part' /",
                                  "parameters", "not a number of bodies, shape or forces", line=5),
    "derivative by no term of a list": (
        with_bodies("radius = 1, young = 1, 2, poisson = 0.3 /") + "&equilibrium_path /\n"
        "&sensitivity parameters = 'bodies.young' /", 5, "sensitivity", "parameters",
        "bodies.young(1), bodies.young(2), bodies.poisson"),
    "derivative by what is nothing": (
        GOOD.replace("&loading", "&structural amplitude = 1e5, period = 1e-9, decay_length = 1e-9, "
                     "phase = 0 /\n&morse surface_energy = 0.01, z0 = 0, decay_length = 1e-9 /\n"
                     "&loading") + "&equilibrium_path /\n&sensitivity parameters = 'morse.z0' /", 7,
        "sensitivity", "parameters", "is 0"),
    "derivatives in a sweep": (
        with_extra("&equilibrium_path /\n&sensitivity parameters = 'force.z0' /\n"
                   "&sweep key = 'force.z0', values = 1e-9 /"), 5, "sensitivity", "",
        "not together with &sweep"),
    "derivatives without a path": extra("&sensitivity parameters = 'force.z0' /", "",
                                        "needs &equilibrium_path"),
    "derivatives by nothing": extra("&equilibrium_path /\n&sensitivity /", "parameters", "missing",
                                    line=5),
    "two names in one": extra(
        "&equilibrium_path /\n&sensitivity parameters = 'force.z0, bodies.radius' /", "parameters",
        "is not one name", line=5),
    "no load": extra("&equilibrium_path /\n&fixed_load /", "load", "missing", line=5),
    # Once it was at work for ever.
    "layer of next to no thickness": (LAYERED.replace("1e-6,", "1e-14,"), 2, "layer", "thickness",
                                      "too wide beside it"),
    # Once the table of waves had no end.
    "layers too unlike": (LAYERED.replace("1e6, 2e6", "1e-6, 2e6"), 2, "layer", "young",
                          "more than a factor of"),
    "base too unlike": (LAYERED.replace("70e9", "70e-9"), 2, "layer", "young",
                        "more than a factor of"),
    "layers without thickness": (LAYERED.replace("thickness = 1e-6, 2e-6, ", ""), 2, "layer",
                                 "thickness", "missing"),
    "fewer moduli than layers": (LAYERED.replace("1e6, 2e6", "1e6"), 2, "layer", "young",
                                 "1 for 2 layers"),
    "more ratios than layers": (LAYERED.replace("0.5, body", "0.5, 0.3, 0.3, body"), 2, "layer",
                                "poisson", "4 for 2 layers"),
    "layers of a third body": (LAYERED.replace("body = 1", "body = 3"), 2, "layer", "body",
                               "not known"),
    "layers on what is not known": (
        LAYERED.replace("young = 70e9, poisson = 0.2", "stiffness = 1e9"), 1, "bodies",
        "stiffness", "must be known"),
    "layers without a base": (
        LAYERED.replace(", young = 70e9, poisson = 0.2", "").replace("body = 1", "body = 'both'"),
        1, "bodies", "stiffness", "give one of"),
    "an elastic base of rigid bodies": (
        LAYERED.replace("young = 70e9, poisson = 0.2", "rigid = T").replace(
            "body = 1", "base = 'elastic'"), 2, "layer", "base", "the bodies are rigid"),
    "an elastic partner of rigid bodies": (
        LAYERED.replace("young = 70e9, poisson = 0.2", "rigid = T").replace(
            "body = 1", "partner = 'elastic'"), 2, "layer", "partner", "the bodies are rigid"),
    "a partner of layers on both": (
        LAYERED.replace("body = 1", "body = 'both', partner = 'rigid'"), 2, "layer", "partner",
        "both bodies have layers"),
    "approximations of layers": (LAYERED + "&approximations /", 5, "approximations", "",
                                 "half-spaces"),
    "no stiffness": body("radius = 1 /", "stiffness", "give one of"),
    "rigid false alone": body("radius = 1, rigid = .false. /", "stiffness", "give one of"),
    "stiffness and young": body("radius = 1, stiffness = 1,\n young = 1, poisson = 0 /", "young",
                                "more than one way", line=2),
    "rigid and stiffness": body("radius = 1, stiffness = 1,\n rigid = .true. /", "rigid",
                                "more than one way", line=2),
    "young alone": body("radius = 1,\n young = 1 /", "poisson", "go together"),
    "poisson alone": body("radius = 1, poisson = 0 /", "young", "go together"),
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
    "too many steps": (GOOD.replace("0.05e-9", "0.05e-18"), 3, "loading", "h0_step", "10 million"),
    "too many steps by far": (GOOD.replace("0.05e-9", "1e-49").replace("7e-9", "1e49"),
                                       3, "loading", "h0_step", "10 million"),
    "unloading without loading": (BODIES + FORCE + "&equilibrium_path h0_end = 0 /\n&unloading /",
                                  4, "unloading", "", "needs &loading"),
    "unloading from outside": extra("&unloading\n from = 1e-9, -3e-9 /", "from",
                                    "outside the range of &loading", line=5),
    "unloading downwards": extra("&unloading from = 1e-9\n h0_end = 0.5e-9 /", "h0_end",
                                 "not above the turning point", line=5),
    "too many unloading steps": extra("&unloading h0_step = 1e-18 /", "h0_step", "10 million"),
    "path without an end": (BODIES + FORCE + "&equilibrium_path /", 3, "equilibrium_path",
                            "h0_end", "missing"),
    "path upwards": extra("&equilibrium_path h0_start = -3e-9 /", "h0_start", "not above h0_end"),
    "profiles of nothing": (BODIES + FORCE + "&classical h0_start = 1, h0_end = 0 /\n"
                            "&profiles h0 = 0.5 /", 4, "profiles", "", "needs &loading"),
    "profiles without h0": extra("&profiles /", "h0", "missing"),
    "profile outside": extra("&profiles h0 = 1e-9, 8e-9 /", "h0", "outside the range"),
    "classical without a range": (BODIES + FORCE + "&classical /", 3, "classical", "h0_start",
                                  "&equilibrium_path to take the range from"),
    "approximations without an end": (BODIES + FORCE + "&approximations h0_start = 1 /", 3,
                                      "approximations", "h0_end", "take the range from"),
    "a theory that there is not": extra("&classical theories = 'carpik' /", "theories",
                                        'did you mean "carpick"'),
    "a theory of half-spaces beside layers": (
        LAYERED + "&classical theories = 'jkr', 'carpick' /", 5, "classical",
        "theories", "half-spaces"),
    "a theory of the parabola beside a shape": extra(
        "&shape kind = 'sphere' /\n&classical theories = 'dmt' /", "theories", "parabola", line=5),
    "classical upwards": extra("&classical h0_end = 8e-9 /", "h0_end", "not below h0_start"),
    "stability of nothing": (BODIES + FORCE + "&classical h0_start = 1, h0_end = 0 /\n"
                             "&stability /", 4, "stability", "", "needs &loading"),
    "nothing to compute": (BODIES + FORCE, 1, "", "", "nothing to compute"),
    # sweeps
    "sweep of an unknown key": extra("&sweep key = 'force.hamacker', values = 1 /", "key",
                                     'did you mean "force.hamaker"'),
    "sweep of a group": extra("&sweep key = 'force', values = 1 /", "key",
                              "not a key that holds a number"),
    "sweep of a word": extra("&sweep key = 'force.law', values = 1 /", "words", "holds a word"),
    "sweep of itself": extra("&sweep key = 'sweep.count', values = 1 /", "key", "no &sweep"),
    "sweep of an absent group": extra("&sweep key = 'unloading.h0_end', values = 1 /", "key",
                                      "no &unloading"),
    "sweep of a term too many": (
        with_bodies("radius = 1, young = 1, 2, poisson = 0.3 /")
        + "&sweep key = 'bodies.young(3)', values = 1 /", 4, "sweep", "key", "no such term"),
    "sweep out of range": extra("&sweep key = 'bodies.radius',\n values = 1, -1 /", "values",
                                "out of range", line=5),
    "sweep to a wrong deck": (with_extra("&sweep key = 'loading.h0_end',\n from = 0, to = 9e-9, "
                                         "count = 3 /"), 5, "sweep", "from", "not below h0_start"),
    "sweep of a missing parameter's rival": extra("&sweep key = 'force.p0', values = 1 /", "values",
                                                  "belongs to"),
    "sweep by halves": extra("&sweep key = 'bodies.radius', from = 1, to = 2 /", "count",
                             "missing"),
    "sweep both ways": extra("&sweep key = 'bodies.radius', values = 1, 2\n from = 1 /", "from",
                             "not together with values", line=5),
    "scale beside values": extra("&sweep key = 'bodies.radius', values = 1 scale = 'log' /",
                                 "scale", "not together with values"),
    "log sweep to zero": (with_extra("&sweep key = 'bodies.radius', from = 1, to = 0, count = 3,"
                                     " scale = 'log' /"), 4, "sweep", "to", "> 0"),
    "log sweep from zero": (with_extra("&sweep key = 'bodies.radius', from = 0, to = 1, count = 3,"
                                       " scale = 'log' /"), 4, "sweep", "from", "> 0"),
    "sweep of one value": extra("&sweep key = 'bodies.radius' from = 1 to = 1 count = 3 /", "to",
                                "the same as from"),
    "fractional whole number": extra("&sweep key = 'numerics.nodes', values = 100, 100.5 /",
                                     "values", "out of range"),
}


@pytest.mark.parametrize("case", REFUSED.values(), ids=REFUSED.keys())
def test_bad_scene_is_refused_by_line_group_and_key(check, case):
    assert_refused(check, *case)


# --- The deck as resolved

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


def resolved(run, text):
    """The groups of a deck as the summary of its run repeats them."""
    groups = run(text, status=None).groups
    del groups["summary"], groups["cost"]
    return groups


def test_resolved_deck_holds_every_value_and_default(run):
    values = resolved(run, CHEAP)
    assert list(values) == ["scene", "bodies", "force", "loading", "unloading", "profiles",
                            "approximations", "classical", "stability", "numerics"]
    assert values["scene"]["title"] == "it's \"so\""
    assert values["bodies"] == {
        "radius": 0.1, "young": [1.1e10, 1.1e10], "poisson": 0.3, "rigid": False}
    assert values["force"]["hamaker"] == 1.2345678901234567e-19
    assert values["force"]["part"] == "full"
    assert values["unloading"] == {"from": 6.9e-9, "h0_end": 7e-9, "h0_step": 0.1e-9}
    assert values["approximations"]["count"] == 3
    assert values["classical"] == {"h0_start": 7e-9, "h0_end": 6.95e-9, "count": 200}
    assert values["stability"] == {}
    assert values["numerics"]["accuracy"] == 1e-2
    assert values["numerics"]["method"] == "auto"
    assert "nodes" not in values["numerics"]


def test_resolved_deck_of_the_other_law_reads_back(run):
    text = ("&bodies radius = 1e-2 rigid = T /\n&force law = 'exponential' p0 = 2.5e8 "
            "decay_length = 2e-10 /\n&loading h0_start = 5e-9 h0_end = 4.9e-9 h0_step = 1e-10 /\n"
            "&profiles h0 = " + " ".join(f"{4.9 + i/100:.2f}e-9" for i in range(11)) + " /\n")
    values = resolved(run, text)
    assert "part" not in values["force"]
    assert resolved(run, (run(text).folder / "summary.nml").read_text()) == values
