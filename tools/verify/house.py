"""Prints how much of the sources one run goes through, and how much there is.

    .venv/bin/python tools/verify/house.py [--runs]

Without options the measures that are read from the sources: the longest chain of `use`, the modules
with most uses, real constants, real literals without a name in formulas, names of types that occur
twice, and lines. With --runs also the modules, procedures, lines of procedures and calls between
modules of four runs, counted by callgrind in a build without optimisation (build-counted), in which
no procedure is inlined. A line of a procedure counts whether or not the run executes it.
"""

import argparse
import collections
import functools
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = ROOT / "src"
BUILD = ROOT / "build-counted"

FIRST = """&bodies radius = 1.5e-2, stiffness = 1e10 /
&force law = 'lennard_jones', hamaker = 1e-20, z0 = 0.5e-9 /
"""
DRIVE = """&bodies radius = 1e-6, stiffness = 2.2e10 /
&viscoelastic stiffness_relaxed = 2.2e9, retardation_time = 1e-3 /
&force law = 'lennard_jones', z0 = 0.5e-9, surface_energy = 0.05 /
&drive velocity = 1e-6, z_start = 10e-9, z_turn = 1e-9 /
&numerics accuracy = 1e-2 /
"""
FIT = f"""&bodies radius = 20e-9, stiffness = 1e10 /
&force law = 'lennard_jones', surface_energy = 0.1, z0 = 0.3e-9 /
&measurement file = '{ROOT}/inputs/examples/afm_force_curve_sin.csv',
  columns = 'height_measured', 'force', 'segment', spring_constant = 1.1841 /
&fit parameters = 'force.surface_energy', 'measurement.contact_point' /
"""
PATH = "&equilibrium_path h0_end = -2e-9 /\n"
RUNS = {
    "path": FIRST + PATH,
    "cycle": (ROOT / "inputs/first.nml").read_text(),
    "drive": DRIVE,
    "fit": FIT,
    "case of a sweep": FIRST + PATH +
    "&sweep key = 'bodies.stiffness', from = 1e10, to = 2e10, count = 2 /\n",
}

LITERAL = re.compile(r"(?<![\w.])(\d+\.\d*(?:e[+-]?\d+)?|\d+e[+-]?\d+)(?:_wp)?(?![\w.])")
BEGIN = re.compile(r"^(?:(?:pure|elemental|impure|recursive|module|real\(\w+\)|integer(?:\(\w+\))?"
                   r"|logical|type\(\w+\)|character(?:\([^)]*\))?)\s+)*"
                   r"(?:subroutine|function)\s+(\w+)")


def statements(path):
    """Yield line number and text of each statement, without comments and strings, continued lines
    joined."""
    whole, begin = "", 0
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        line = re.sub(r"'[^'\n]*'|\"[^\"\n]*\"", "''", line).split("!")[0].strip().lower()
        if not line:
            continue
        if not whole:
            begin = number
        whole += line.lstrip("&").rstrip("&")
        if not line.endswith("&"):
            yield begin, number, whole
            whole = ""


@functools.cache
def sources():
    return {path.name.split(".")[0]: path for path in sorted(SOURCE.rglob("*.f90*"))}


@functools.cache
def uses():
    """Return the modules of this project that each module names in its use lines."""
    return {name: {other for _, _, text in statements(path)
                   for other in re.findall(r"^use\s+(\w+)", text) if other in sources()}
            for name, path in sources().items()}


@functools.cache
def longest_chain(name):
    """Return the longest chain of `use` that begins with a module."""
    return [name, *max((longest_chain(other) for other in uses()[name]), key=len, default=[])]


def room_of(name):
    return sources()[name].relative_to(SOURCE).parts[0]


def is_plain(value):
    """Return whether a literal needs no name: eighths up to 12, which are coefficients of formulas,
    and percent."""
    return value == 100 or (value <= 12 and 8*value == int(8*value))


def constants():
    """Return the numbers of real constants with names, and the literals without: path, line,
    text."""
    named, unnamed = 0, []
    for path in sources().values():
        for line, _, text in statements(path):
            literals = [found[1] for found in LITERAL.finditer(text)]
            declared = re.match(r"^(real\(|integer|logical|character|type\(|complex)[^:]*::(.*)",
                                text)
            if declared and ", parameter" in text.split("::")[0]:
                if declared[1] == "real(":
                    # Entities are separated by commas outside parentheses and brackets.
                    flat = declared[2]
                    while re.search(r"[(\[][^()\[\]]*[)\]]", flat):
                        flat = re.sub(r"[(\[][^()\[\]]*[)\]]", "", flat)
                    named += flat.count("=")
            elif not declared:
                unnamed += [(path, line, text) for value in literals if not is_plain(float(value))]
    return named, unnamed


def procedures(path):
    """Return {(name, occurrence): own lines}: those of internal procedures are not counted in the
    one around them."""
    found, stack = {}, []
    interface = False
    for begin, end, text in statements(path):
        if re.match(r"^(abstract\s+)?interface\b", text):
            interface = True
        elif re.match(r"^end interface", text):
            interface = False
        elif not interface and (match := BEGIN.match(text)):
            stack.append([match[1], begin, 0])
        elif not interface and re.match(r"^end (subroutine|function)", text):
            name, first, inside = stack.pop()
            found.setdefault(name, []).append((first, end - first + 1 - inside))
            if stack:
                stack[-1][2] += end - first + 1
    return found


def executed(counts):
    """Return modules, procedures, their lines, and calls between modules, from callgrind's file."""
    names, files = {}, {}
    module_of = {path.name: name for name, path in sources().items()}
    here = there = caller = None
    called = None
    lines, pairs = collections.defaultdict(set), set()

    def full(table, text):
        number, _, name = text.partition(" ")
        if name:
            table[number] = name
        return table.get(number, text)

    for row in counts.read_text().splitlines():
        key, _, value = row.partition("=")
        if key == "fl":
            here = there = module_of.get(os.path.basename(full(files, value)))
        elif key in ("fi", "fe"):
            there = module_of.get(os.path.basename(full(files, value)))
        elif key == "fn":
            caller = full(names, value)
            if here:
                lines[here].add(caller)
        elif key == "cfi" or key == "cfl":
            called = module_of.get(os.path.basename(full(files, value)))
        elif key == "cfn":
            full(names, value)
            # A call without a file of its own stays in the file.
            target = called or there
            if here and target and here != target:
                pairs.add((here, target))
            called = None
    total, count, modules = 0, 0, set()
    for module, functions in lines.items():
        known = procedures(sources()[module])
        # Internal procedures are called name.0, name.1, ...; copies of one are one procedure.
        for name in {re.sub(r"^__\w+?_MOD_|\.\d+$", "", found) for found in functions}:
            if name in known:
                modules.add(module)
                count += 1
                total += max(own for _, own in known[name])
    return len(modules), count, total, len({pair for pair in pairs if set(pair) <= modules})


def build():
    meson = [str(ROOT / ".venv/bin/meson")]
    environment = {**os.environ, "PATH": f"{ROOT}/.venv/bin:{os.environ['PATH']}"}
    if not (BUILD / "build.ninja").exists():
        subprocess.run([*meson, "setup", str(BUILD), str(ROOT), "-Dbuildtype=debug",
                        "-Dpython=disabled"], check=True, stdout=sys.stderr, env=environment)
    subprocess.run([str(ROOT / ".venv/bin/ninja"), "-C", str(BUILD), "snapin"], check=True,
                   stdout=sys.stderr)


def measure_runs(names):
    build()
    yield "| run | modules | procedures | their lines | calls between modules |"
    yield "|---|---|---|---|---|"
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            deck = pathlib.Path(folder) / "deck.nml"
            deck.write_text(RUNS[name])
            counts = pathlib.Path(folder) / "counts"
            subprocess.run(
                ["valgrind", "--tool=callgrind", "-q", f"--callgrind-out-file={counts}",
                 str(BUILD / "snapin"), "--quiet", "--out", folder, str(deck)], check=True,
                env={**os.environ, "OMP_NUM_THREADS": "1"}, stdout=subprocess.DEVNULL)
            yield f"| {name} | " + " | ".join(f"{n:,}" for n in executed(counts)) + " |"


def lines_in(folder, kinds):
    return sum(len(path.read_text(encoding="utf-8").splitlines())
               for path in (ROOT / folder).rglob("*")
               if path.suffix in kinds and "minpack" not in path.parts)


def measure_sources():
    chain = max(map(longest_chain, sources()), key=len)
    yield f"modules: {len(sources())}"
    yield f"longest chain of use: {len(chain)}: " + " -> ".join(chain)
    most = sorted(uses(), key=lambda name: -len(uses()[name]))[:5]
    yield "most uses: " + ", ".join(f"{name} {len(uses()[name])}" for name in most)
    named, unnamed = constants()
    yield f"real constants: {named}; literals without a name in formulas: {len(unnamed)}"
    files = collections.Counter(path.relative_to(ROOT) for path, _, _ in unnamed)
    yield "most literals: " + ", ".join(f"{path.name} {n}" for path, n in files.most_common(12))
    types = collections.Counter(
        found[1] for path in sources().values() for _, _, text in statements(path)
        if (found := re.match(r"^type(?:,[^:]*)?(?:\s*::)?\s+(\w+)$", text)))
    yield "types defined twice: " + (
        ", ".join(name for name, n in types.items() if n > 1) or "none")
    rooms = {}
    for name, path in sources().items():
        rooms.setdefault(room_of(name), []).append(path)
    yield "lines by room: " + ", ".join(
        f"{room} {sum(len(path.read_text(encoding='utf-8').splitlines()) for path in paths)}"
        for room, paths in rooms.items() if (SOURCE / room).is_dir())
    program = sum(lines_in(folder, {".f90", ".in", ".c", ".h"}) for folder in ("src", "pywrap"))
    yield f"Fortran and C of src and pywrap: {program}"
    yield f"tests: {lines_in('tests', {'.py', '.f90'})}"
    yield f"tools: {lines_in('tools', {'.py', '.sh', '.f90', '.c'})}"
    yield f"CONTRIBUTING: {(ROOT / 'CONTRIBUTING.md').stat().st_size / 1000:.1f} kB"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", nargs="*", choices=RUNS, metavar="RUN",
                        help="count runs too: " + ", ".join(RUNS))
    parser.add_argument("--literals", action="store_true", help="list literals without a name")
    arguments = parser.parse_args()
    for line in measure_sources():
        print(line)
    if arguments.literals:
        for path, line, text in constants()[1]:
            print(f"{path.relative_to(ROOT)}:{line}: {text}")
    if arguments.runs is not None:
        for line in measure_runs(arguments.runs or RUNS):
            print(line, flush=True)


if __name__ == "__main__":
    from snapin.command import as_command

    sys.exit(as_command(main)())
