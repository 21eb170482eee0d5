"""The distribution of time: the program's own timers, and instructions counted by callgrind."""

import re
import shutil
import subprocess

import problems
from tables import chosen

# Functions that do not call each other, so that their shares add up.
_PIECES = (
    ("matrix-vector products (DGEMV)", r"dgemv_"),
    ("factorisations", r"__linear_algebra_MOD_factorise"),
    ("solutions with factors", r"__linear_algebra_MOD_solve"),
    ("kernel assembly", r"__mapped_mesh_MOD_new_mapped_mesh"),
    ("force law", r"__lennard_jones_MOD_(?:pressure|slope|energy)"),
    ("interpolation", r"__discretisation_MOD_interpolate"),
    ("rows of results", r"__results_MOD_take"),
)


def measure(program, quick, say):
    """Return rows of case, quantity, and seconds or share of instructions."""
    cases = {
        "Fig. 10(c) cycle": problems.FIGURE_10C + "&numerics accuracy = 1e-6 /\n",
        "σ = 8.7 path": problems.ADHESIVE[2].path("accuracy = 1e-6")}
    rows = []
    for case, run in program.best_of(3 if quick else 15, cases).items():
        rest = run.wall - run.kernel_seconds - run.solve_seconds - run.estimate_seconds
        for what, seconds in (("kernel", run.kernel_seconds), ("solution", run.solve_seconds),
                              ("error estimate", run.estimate_seconds),
                              ("deck, results, start", rest)):
            rows.append({"case": case, "kind": "seconds", "what": what, "value": seconds,
                         "share": seconds / run.wall})
    if not (shutil.which("valgrind") and shutil.which("callgrind_annotate")):
        say("no valgrind: the timers only")
        return rows
    for case, deck in cases.items():
        output = program.scratch / "callgrind.out"
        program.run(deck, cap=600, before=("valgrind", "--tool=callgrind", "-q",
                                           f"--callgrind-out-file={output}"))
        shares = _shares(subprocess.run(
            ["callgrind_annotate", "--inclusive=yes", "--threshold=100", "--show-percs=no",
             str(output)],
            check=True, capture_output=True, text=True).stdout)
        total = sum(shares.values())
        for what, count in sorted(shares.items(), key=lambda item: -item[1]):
            rows.append({"case": case, "kind": "instructions", "what": what,
                         "value": float(count), "share": count / total})
        say(f"{case}: {total / 1e9:.2f}e9 instructions")
    return rows


def _shares(text):
    """Return instructions of each piece, with all its calls, from callgrind_annotate's table."""
    total = _count(re.search(r"^ *([\d,]+) .*PROGRAM TOTALS", text, re.MULTILINE)[1])
    shares = {}
    for what, function in _PIECES:
        lines = re.findall(rf"^ *([\d,]+) .*:{function}[ \n]", text, re.MULTILINE)
        shares[what] = sum(map(_count, lines))
    shares["all else"] = total - sum(shares.values())
    return shares


def _count(digits):
    return int(digits.replace(",", ""))


def tables(rows, before):
    """Return the guide's table: shares in the two cases, side by side."""
    cases = list(dict.fromkeys(row["case"] for row in rows))
    lines = []
    for kind, name in (("seconds", "time: "), ("instructions", "instructions: ")):
        for what in dict.fromkeys(row["what"] for row in rows if row["kind"] == kind):
            shares = (sum(row["share"] for row in chosen(rows, case=case, what=what, kind=kind))
                      for case in cases)
            lines.append([name + what, *(f"{100 * share:.1f} %" for share in shares)])
    return {"hot_spots": (["share of", *cases], lines)}
