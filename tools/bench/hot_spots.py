"""Where the time goes: the program's own timers, and instructions counted by callgrind."""

import re
import shutil
import subprocess

import problems

# What a function belongs to, by the first pattern that its name matches.
_KINDS = (
    ("matrix-vector products (DGEMV)", r"dgemv"),
    ("factorisations (DGETRF)", r"getrf|gemm|dtrsm|laswp|dger|iamax|dswap|dscal"),
    ("solutions with factors (DGETRS)", r"getrs|trsv|trmv|ddot|daxpy"),
    ("kernel assembly", r"kernel|panel_weights|one_side|product_integration|undivided|lagrange"
     r"|discretisation|quadrature|barycentric"),
    ("force law", r"lennard_jones|exponential"),
    ("Jacobian", r"factorise_jacobian|border|scale_derivative"),
    ("equations, acceleration, extrapolation", r"equilibrium|anderson|tracer|trail|tangent|cycle"
     r"|quasi_static|locked_steps|state_t|_MOD_between|largest_step"),
    ("memory copied, set, allocated", r"mem(cpy|set|move)|malloc|free|calloc"),
    ("text in and out", r"gfortran|printf|scanf|strto|deck|assignments|results|write|read|fputs"
     r"|memchr|strlen|libquadmath|mpn"),
    ("start of the process", r"ld-|_dl_|do_lookup|strcmp|check_match|gotoblas|cpuid"),
)


def measure(program, quick, say):
    """Return rows of case, what, seconds or share of instructions."""
    cases = {
        "Fig. 10(c) cycle": problems.FIGURE_10C + "&numerics accuracy = 1e-6 /\n",
        "σ = 8.7 path": problems.ADHESIVE[2].path("accuracy = 1e-6"),
    }
    rows = []
    for case, run in program.best_of(3 if quick else 15, cases).items():
        rest = run.seconds - run.kernel_seconds - run.solve_seconds - run.estimate_seconds
        for what, seconds in (("kernel", run.kernel_seconds), ("solution", run.solve_seconds),
                              ("error estimate", run.estimate_seconds),
                              ("deck, results, start", rest)):
            rows.append({"case": case, "kind": "seconds", "what": what, "value": seconds,
                         "share": seconds / run.seconds})
    if not (shutil.which("valgrind") and shutil.which("callgrind_annotate")):
        say("no valgrind: the timers only")
        return rows
    for case, deck in cases.items():
        output = program.scratch / "callgrind.out"
        program.run(deck, cap=600, before=("valgrind", "--tool=callgrind", "-q",
                                           f"--callgrind-out-file={output}"))
        shares = _shares(subprocess.run(
            ["callgrind_annotate", "--threshold=100", "--show-percs=no", str(output)],
            check=True, capture_output=True, text=True).stdout)
        total = sum(shares.values())
        for what, count in sorted(shares.items(), key=lambda item: -item[1]):
            rows.append({"case": case, "kind": "instructions", "what": what,
                         "value": float(count), "share": count / total})
        say(f"{case}: {total / 1e9:.2f}e9 instructions")
    return rows


def _shares(text):
    """Return instructions by kind from callgrind_annotate's table."""
    shares = {}
    for match in re.finditer(r"^\s*([\d,]+) +(\S.*)$", text, re.MULTILINE):
        name = match[2]
        if "PROGRAM TOTALS" in name or ":" not in name:
            continue
        kind = next((kind for kind, pattern in _KINDS if re.search(pattern, name)), "other")
        shares[kind] = shares.get(kind, 0) + int(match[1].replace(",", ""))
    return shares


def tables(rows):
    """Return the guide's table: shares in the two cases, side by side."""
    cases = list(dict.fromkeys(row["case"] for row in rows))
    lines = []
    for kind, name in (("seconds", "time: "), ("instructions", "instructions: ")):
        for what in dict.fromkeys(row["what"] for row in rows if row["kind"] == kind):
            cells = [name + what]
            for case in cases:
                share = next((row["share"] for row in rows if row["case"] == case
                              and row["what"] == what and row["kind"] == kind), 0.0)
                cells.append(f"{100 * share:.1f} %")
            lines.append(cells)
    return {"hot_spots": (["share of", *cases], lines)}
