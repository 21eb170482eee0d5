"""The small programs that measure, most of which the usual builds do not make."""

import json
import math
import re
import subprocess
from pathlib import Path

import pytest
from conftest import ROOT
from snapin import read_results
from support.known import BY_SIGMA


@pytest.mark.parametrize("source", sorted((ROOT / "tools/bench").glob("*.f90")),
                         ids=lambda source: source.stem)
def test_a_measuring_program_fits_the_modules(snapin_path, tmp_path, source):
    """The dispatcher called a procedure with arguments of former times, and no build with MPI could
    be made."""
    build = Path(snapin_path).parent
    compilers = build / "meson-info" / "intro-compilers.json"
    if not compilers.is_file():
        pytest.skip("the program is in no build folder, beside its modules")
    compiler = json.loads(compilers.read_text())["host"]["fortran"]["exelist"]
    done = subprocess.run([*compiler, "-fsyntax-only", "-I", build / "libsnapin.a.p", "-J",
                           tmp_path, source], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize(("args", "phrase"), [
    (["--build", "nowhere"], "no program in nowhere"),
    (["--draw", "--out", "nowhere"], "no measurements in .*nowhere"),
])
def test_what_bench_lacks_is_said_in_one_line(called, snapin_path, args, phrase):
    pytest.importorskip("matplotlib")
    done = called(ROOT / "tools/bench/bench.py", "--build", snapin_path.parent, *args)
    assert done.returncode == 2
    assert re.search(rf"^./bench: error: {phrase}$", done.stderr, re.MULTILINE), done.stderr


@pytest.fixture
def bench(monkeypatch, snapin_path):
    """The folder of the measuring programs can be imported from."""
    pytest.importorskip("matplotlib")
    monkeypatch.syspath_prepend(ROOT / "tools/bench")


@pytest.mark.parametrize("sigma", BY_SIGMA)
def test_true_numbers_are_those_of_others(bench, sigma):
    import truth

    found = truth.numbers(sigma, 20.0, -5.0, length=1.0, load=1.0)
    pull_off, at, in_h0, in_load, out_h0, out_load = BY_SIGMA[sigma]
    assert found["max_tension"] / (1.5 * math.pi) == pytest.approx(pull_off, abs=1e-8)
    for name, value in (("max_tension_h0", at), ("jump_in_h0", in_h0), ("jump_in_load", in_load),
                        ("jump_out_h0", out_h0), ("jump_out_load", out_load)):
        assert found[name] == pytest.approx(value, abs=2e-7), name


def test_the_true_numbers_of_the_deck_of_accuracy_are_those_of_the_program(bench, snapin, tmp_path):
    """The finest case of inputs/accuracy.nml has the numbers of docs/bench/independent.csv."""
    import truth

    deck = (ROOT / "inputs/accuracy.nml").read_text(encoding="utf-8").split("&sweep")[0]
    (tmp_path / "d.nml").write_text(deck + "&numerics accuracy = 1e-10 /\n")
    assert snapin("--quiet", "--out", ".", "d.nml", cwd=tmp_path).returncode == 0
    summary = read_results(tmp_path / "d").summary
    lines = truth.NUMBERS.read_text(encoding="utf-8").splitlines()[1:]
    assert len(lines) == 9
    for name, value in (line.split(",") for line in lines):
        assert summary[name] == pytest.approx(float(value), rel=2e-10), name


def test_the_tables_of_methods_are_made_of_their_measurements(bench):
    import methods_page
    import pages
    import tables

    rows, cycles = (tables.read(ROOT / "docs/bench" / name)
                    for name in ("methods.csv", "methods_cycles.csv"))
    page = (ROOT / "docs/records/ladder.md").read_text(encoding="utf-8")
    assert pages.replaced(page, "methods", methods_page.lines(rows, cycles)) == page


# Jumps begin at this strength of adhesion.
CUSP = 0.29108493


class Known:
    """A program that knows methods, and whose runs end at once; of the truth it knows what is in
    it."""

    def __init__(self, snapin, asked):
        self.snapin, self.asked = snapin, asked

    def reference(self, problem):
        import program

        jumps = ("jump_in", "jump_out") if problem.sigma > CUSP else ()
        return program.Run(values=dict.fromkeys(("pull_off", "load", *jumps), 1.0))

    def best_of(self, rounds, decks, *args, **options):
        import program

        self.asked.append(decks[0])
        return {0: program.Run(seconds=1.0)}


def test_hard_cases_leave_out_methods_that_the_program_does_not_know(
        bench, snapin_path, monkeypatch, tmp_path):
    """And a run without the jump of the true path is a lost scene."""
    import hard_cases

    monkeypatch.setattr(hard_cases, "METHODS", (
        *hard_cases.METHODS, ("invented", "method = 'invented'", ("invented",))))
    asked, said = [], []
    rows = hard_cases.measure(Known(snapin_path, asked), True, said.append)
    assert len(said) == 5 and {row["method"] for row in rows} >= {"auto", "mixing, uniform grid"}
    assert "invented" not in {row["method"] for row in rows}
    assert not any("invented" in deck for deck in asked)
    assert [row["failure"] for row in rows if row["sigma"] == 1e4][0] == "no jump_in"
    assert [row["failure"] for row in rows if row["sigma"] == 1e-4][0] == ""
    hard_cases.draw(rows, tmp_path)
    assert (tmp_path / "hard_cases.png").stat().st_size > 2e4
    ((head, lines),) = hard_cases.tables(rows, []).values()
    lost = dict(zip(head, lines[0]))
    assert lost["scenes"] == "5" and int(lost["lost"]) == 3
