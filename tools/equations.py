#!/usr/bin/env python3
"""The index of the paper's equations: where each is computed, tested and drawn.

    tools/equations.py           renew docs/equations.md

The index is made from comments: a number in brackets, as in "equation (17)" or "(39) of the paper",
in a comment of `src/` (with the procedure that the comment precedes or is in), in the texts and
comments of a test, and in those of a figure's chapter. A number in brackets in these comments is
always an equation of the paper. Equations that no comment names have a reason here.
"""

import ast
import io
import pathlib
import re
import tokenize

TOP = pathlib.Path(__file__).resolve().parents[1]
PAGE = TOP / "docs" / "equations.md"
EQUATIONS = range(1, 42)

# What each equation is.
NAMES = {
    1: "pull-off force of JKR theory", 2: "pull-off force of DMT theory", 3: "pressure of Hertz",
    4: "displacement of Hertz", 5: "load of Hertz", 6: "displacement and load of Hertz",
    7: "pressure that JKR theory adds", 8: "surface energy of the contact in JKR theory",
    9: "strength of the added pressure", 10: "contact radius of JKR theory",
    11: "displacement of JKR theory", 12: "pull-off at fixed displacement, JKR theory",
    13: "deformation of a half-space", 14: "deformation with axial symmetry", 15: "kernel",
    16: "pressure from the separation", 17: "separation", 18: "separation without deformation",
    19: "central displacement", 20: "load", 21: "deformation that varies slowly",
    22: "its displacement", 23: "its load: Derjaguin's approximation",
    24: "response to a perturbation", 25: "condition of stability", 26: "a convenient perturbation",
    27: "response to this perturbation", 28: "local criterion of stability",
    29: "criterion of stability on the axis", 30: "exponential repulsion",
    31: "displacement under it", 32: "load under it", 33: "Lennard-Jones pressure",
    34: "its surface energy", 35: "displacement under it", 36: "load under it",
    37: "separation at the jump", 38: "form without units", 39: "Λ", 40: "σ",
    41: "no equation of the paper"}

# Its formula, in the symbols that the page explains. No bar: it would end the cell of a table.
FORMULAS = {
    1: "F = −(3/2) πwR", 2: "F = −2πwR", 3: "p(r) = (2E*/(πR)) √(a² − r²), r < a", 4: "δ = a²/R",
    5: "F = 4E*a³/(3R)", 6: "δ = (3F/(4E*√R))^(2/3), that is F = (4/3) E* √R δ^(3/2)",
    7: "p1/√(1 − r²/a²), r < a", 8: "−πa²w", 9: "p1 = −√(2wE*/(πa))",
    10: "4E*a³/(3R) = F + 3πwR + √(6πwRF + (3πwR)²), that is F = 4E*a³/(3R) − √(8πwE*a³)",
    11: "δ = a²/R − √(2πwa/E*)", 12: "F = −(5/6) πwR, where a³ = πwR²/(8E*)",
    13: "u = −(1/(2πE*)) ∫ (p/s) dA, with the distance s of the area dA",
    14: "u(r) = −(1/(2E*)) ∫ p(t) k(r,t) t dt",
    15: "k(r,t) = 4 K(m)/(π max(r,t)), m = (min(r,t)/max(r,t))²", 16: "p(r) = p_s(h(r))",
    17: "h(r) = h0(r) − 2u(r)", 18: "h0(r) = h0 + r²/(2R)", 19: "δ = h(0) − h0 = −2u(0)",
    20: "F = 2π ∫ p r dr", 21: "u(r) = u(0)", 22: "δ = (2/E*) ∫ p_s(h(0) + t²/(2R)) dt",
    23: "F = 2πR ∫ p_s dh, from h(0) to infinity",
    24: "μ = (1/(πE*)) ∫ (p_s′(h) ε/s) dA, for a perturbation ε of u", 25: "−1 < μ/ε < 1",
    26: "ε = α p_s(h)/p_s′(h), with a small α", 27: "μ = −2αu", 28: "−1 < 2u p_s′(h)/p_s(h) < 1",
    29: "2u(0) p_s′(h(0))/p_s(h(0)) > −1", 30: "p_s = p0 exp(−h/L)",
    31: "δ = p_s(h(0)) √(2πRL)/E*", 32: "F = 2πRL p_s(h(0))",
    33: "p_s = A/(6πh³) ((z0/h)⁶ − 1)", 34: "w = A/(16πz0²)",
    35: "(a) δ = (A√(2R)/(3πE*)) (I₈ (z0/h)⁶ − I₂)/h^(5/2), with h = h(0), I₈ = 6435π/65536 and "
        "I₂ = 3π/16; (b) attraction alone: δ = −A√(2R)/(16E*h^(5/2))",
    36: "(a) F = (AR/(6h²)) ((z0/h)⁶/4 − 1), with h = h(0); (b) attraction alone: F = −AR/(6h²)",
    37: "(29) for (35b): h(0) = (3A√(2R)/(16E*))^(2/7), with h0 = (4/3) h(0)",
    38: "u/λ = Θ U, F/(2E*√(Rλ³)) = Θ W, with functionals U and W of u/λ, and λ = L or z0",
    39: "Λ = p0 exp(−h0/L) √(R/L)/(2E*)", 40: "σ = w √(R/z0³)/(2E*) = μ^(3/2)/2, with Tabor's μ",
    41: ""}

# Why an equation has no place in the program.
REASONS = {
    8: "JKR theory is used in its results, (9) to (12), which follow from this energy",
    13: "the bodies have axial symmetry: (14) is (13) integrated over the angle",
    26: "a step of the derivation of (28)",
    27: "a step of the derivation of (28)",
    41: "the paper's last equation is (40)"}

_NUMBER = re.compile(r"(?<![\w)\]\"])\((\d{1,2})([ab]?)\)(?![\^\w])")
_IN_NAME = re.compile(r"equations?_(\d+)(?:_and_(\d+))?")
_NAMED = re.compile(
    r"^\s*(?:(?:pure|elemental|recursive|impure|logical|integer|real\(wp\)|type\(\w+\))\s+)*"
    r"(?:subroutine|function)\s+(\w+)", re.IGNORECASE)
_ENDED = re.compile(r"^\s*end (?:subroutine|function)\b", re.IGNORECASE)


def numbers(text):
    return {int(found[1]) for found in _NUMBER.finditer(text) if int(found[1]) in EQUATIONS}


def in_fortran(path):
    """Yield (equation, procedure) for each comment; the procedure is empty for those of the
    module."""
    inside, waiting = [], set()
    for line in path.read_text(encoding="utf-8").splitlines():
        comment = line[line.index("!"):] if "!" in line else ""
        if line.strip().startswith("!"):
            if inside:
                yield from ((number, inside[-1]) for number in numbers(comment))
            else:
                waiting |= numbers(comment)
            continue
        begun = _NAMED.match(line)
        if begun:
            inside.append(begun[1])
        if line.strip():
            name = inside[-1] if inside else ""
            yield from ((number, name) for number in waiting | numbers(comment))
            waiting = set()
        if _ENDED.match(line) and inside:
            inside.pop()


def in_python(path):
    """Yield (equation, function) for the comments, docstrings and names of the tests of a file."""
    text = path.read_text(encoding="utf-8")
    spans = [(node.lineno, node.end_lineno, node.name) for node in ast.walk(ast.parse(text))
             if isinstance(node, ast.FunctionDef)]
    for *_, name in spans:
        for found in _IN_NAME.finditer(name):
            yield from ((int(number), name) for number in found.groups() if number)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        said = token.type == tokenize.COMMENT or (
            token.type == tokenize.STRING and token.string.startswith('"""'))
        for number in numbers(token.string) if said else ():
            around = [name for first, last, name in spans if first <= token.start[0] <= last]
            yield number, around[-1] if around else ""


def index():
    """Return for each equation its places in the program, tests and figures."""
    found = {number: {"source": {}, "test": {}, "figure": []} for number in EQUATIONS}
    for path in sorted((TOP / "src").rglob("*.f90")):
        for number, name in in_fortran(path):
            names = found[number]["source"].setdefault(path.relative_to(TOP).as_posix(), [])
            if name and name not in names:
                names.append(name)
    for path in sorted((TOP / "tests").rglob("test_*.py")):
        for number, name in in_python(path):
            names = found[number]["test"].setdefault(path.relative_to(TOP).as_posix(), [])
            if name and name not in names:
                names.append(name)
    for number, figure in figures():
        if figure not in found[number]["figure"]:
            found[number]["figure"].append(figure)
    return found


def figures():
    """Yield (equation, figure) from the chapters of the report on the paper."""
    page = (TOP / "tools" / "reproduce" / "paper.md").read_text(encoding="utf-8")
    chapter = ""
    for line in page.splitlines():
        begun = re.match(r"#+ .*?Fig(?:ure|\.) (\d+)", line)
        if begun:
            chapter = int(begun[1])
        elif line.startswith("#"):
            chapter = ""
        if chapter:
            yield from ((number, chapter) for number in numbers(line))
    for path in sorted((TOP / "tools" / "reproduce").glob("fig*.py")):
        for number, _ in in_python(path):
            yield number, int(path.stem[3:])


def page():
    """Return the text of docs/equations.md."""
    lines = [
        "# Equations of the paper", "",
        "Each equation of Attard and Parker (1992), where the program computes it, the tests that",
        "name it, and the [figures](reproduction/report.md) of the paper in whose chapters it",
        "occurs. `tools/equations.py` makes this page from the comments of the sources.", "",
        "The formulas have w for the paper's γ, L for its 1/κ, and E\\* = E/(2(1−ν²)). F is positive",
        "in compression, a is the contact radius, δ the displacement, p_s(h) the force law;",
        "integrals without limits are over the whole surface. [Methods](methods.md) has all other",
        "symbols, and how the program solves (14) to (20). The program applies (28) where surfaces",
        "attract each other less as they separate, where it reads 2u p_s′/p_s > −1 as in (29).", "",
        "In JKR and DMT theory the gap of the contact is 0, in the model about z0. At one load both",
        "have the same δ, but h0 of a theory is lower by z0: see",
        "[theories of a run](results.md#theories).", "",
        "The method of section II C, (14) to (20), can be read in `src/equilibrium/`, beginning",
        "with `h0_step.f90`.", "",
        "| equation | what it is | file and procedure | test | figure |", "|---|---|---|---|---|"]
    for number, where in index().items():
        source = "<br>".join(_place(path, names) for path, names in where["source"].items())
        test = "<br>".join(_place(path, names) for path, names in _few(where["test"]))
        drawn = ", ".join(map(str, sorted(where["figure"])))
        formula = FORMULAS[number].replace("*", r"\*")
        named = "<br>".join(filter(None, [NAMES[number], formula]))
        lines.append(f"| ({number}) | {named} | {source or REASONS[number]} | {test} | {drawn} |")
    return "\n".join(lines) + "\n"


def _few(places, most=3):
    return list(places.items())[:most]


def _place(path, names):
    short = path.removeprefix("src/").removeprefix("tests/")
    shown = ", ".join(f"`{name}`" for name in names[:3])
    return f"[{short}](../{path})" + (f": {shown}" if shown else "")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
