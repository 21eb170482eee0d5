"""The paper reproduced: decks, what is run and what is not run again, and claims on quick decks."""

import csv
import os
import re
import subprocess
import sys

import f90nml
import numpy as np
import pytest
from conftest import ROOT
from support.processes import HANG

pytest.importorskip("matplotlib")
TOOLS = ROOT / "tools" / "reproduce"
INPUTS = ROOT / "inputs"


@pytest.fixture(scope="module")
def tools():
    """Makes the modules of tools/reproduce importable, as `./reproduce` does."""
    before = list(sys.path)
    # A module that other claims have imported already does not add its folders once more.
    sys.path[:0] = [str(TOOLS), str(ROOT / "pywrap" / "plots"), str(ROOT / "tools")]
    yield
    sys.path[:] = before


@pytest.fixture(scope="module")
def modules(tools):
    """The chapters of the reports, by name."""
    import chapters

    return {name: chapters.module(name) for name in chapters.names()}


@pytest.fixture(scope="module")
def runs(tools, snapin_path, tmp_path_factory):
    """Runs of the paper's decks, shared by the claims below."""
    from runs import Runs

    return Runs(tmp_path_factory.mktemp("reproduction"), snapin_path)


DECK = """&bodies radius = 1.5e-2, rigid = .true. /
&force law = 'exponential', p0 = 1e7, decay_length = 1e-9 /
&loading h0_start = 2e-9, h0_end = 0, h0_step = 1e-9 /
"""


def counting(program, folder):
    """Return a program that runs another and notes each time it does, and where it notes it."""
    log, script = folder / "log", folder / "counting"
    script.write_text(f'#!/bin/sh\necho run >> "{log}"\nexec "{program}" "$@"\n')
    script.chmod(0o755)
    return script, log


def test_a_deck_is_run_once_and_again_when_deck_or_program_change(tools, snapin_path, tmp_path):
    from runs import Runs

    program, log = counting(snapin_path, tmp_path)
    deck = tmp_path / "rigid.nml"
    deck.write_text(DECK)

    def times_run():
        assert Runs(tmp_path / "runs", program).run(deck).curve["h0"].size > 0
        return len(log.read_text().split())

    assert times_run() == 1
    assert times_run() == 1
    deck.write_text(DECK.replace("1e7", "2e7"))
    assert times_run() == 2
    assert times_run() == 2
    program.write_text(program.read_text() + "# changed\n")
    assert times_run() == 3


def test_what_was_interrupted_or_removed_is_run_again(tools, snapin_path, tmp_path):
    from runs import Runs

    deck = tmp_path / "rigid.nml"
    deck.write_text(DECK)
    runs = Runs(tmp_path / "runs", snapin_path)
    runs.run(deck)
    assert runs.is_done(deck)
    # The record is written last, so that an interruption leaves none.
    (tmp_path / "runs" / "rigid.json").unlink()
    assert not runs.is_done(deck)
    runs.execute(deck)
    assert runs.is_done(deck)
    (tmp_path / "runs" / "rigid" / "summary.nml").unlink()
    assert not runs.is_done(deck)


def test_an_interrupted_run_goes_on_or_starts_over_where_it_cannot(tools, snapin_path, tmp_path):
    from runs import Runs

    program, log = counting(snapin_path, tmp_path)
    text = program.read_text().replace("echo run", 'echo "$2"')
    program.write_text(text)
    deck = tmp_path / "rigid.nml"
    deck.write_text(DECK)
    runs = Runs(tmp_path / "runs", program)
    left = tmp_path / "runs" / "rigid" / "journal.partial"
    left.parent.mkdir(parents=True)

    def options_used():
        left.touch()
        log.unlink(missing_ok=True)
        runs.execute(deck)
        assert runs.is_done(deck)
        return log.read_text().split()

    assert options_used() == ["--resume"]
    # As the program does with a journal of another deck.
    program.write_text(text.replace("exec", '[ "$2" = --resume ] && exit 1\nexec'))
    assert options_used() == ["--resume", "--out"]


def test_a_failing_deck_is_named_and_the_others_are_run(tools, snapin_path, tmp_path):
    from runs import Runs

    good, bad = tmp_path / "good.nml", tmp_path / "bad.nml"
    good.write_text(DECK)
    bad.write_text(DECK.replace("p0 = 1e7", "p0 = -1"))
    said = []
    runs = Runs(tmp_path / "runs", snapin_path)
    problems = runs.run_all([bad, good, tmp_path / "absent.nml"], 2, said.append)
    assert sorted(problems) == ["absent", "bad"]
    assert "status 2" in problems["bad"] and "p0" in problems["bad"]
    assert runs.is_done(good) and not runs.is_done(bad)
    assert any("run 3 of 3" in line for line in said)


@pytest.mark.parametrize(("stem", "fails"), [("fig00_paper", False), ("fig00_converged", True)])
def test_only_decks_on_the_paper_s_rule_may_end_unconverged(tools, tmp_path, stem, fails):
    from runs import RunError, Runs

    program = tmp_path / "unconverged"
    program.write_text('#!/bin/sh\nmkdir -p "$3/$(basename "$4" .nml)"\n'
                       'printf "&summary\\n  converged = .false.\\n/\\n\\n&cost\\n/\\n" '
                       '> "$3/$(basename "$4" .nml)"/summary.nml\nexit 1\n')
    program.chmod(0o755)
    deck = tmp_path / f"{stem}.nml"
    deck.write_text(DECK)
    runs = Runs(tmp_path / "runs", program)
    if fails:
        with pytest.raises(RunError, match="status 1"):
            runs.run(deck)
    else:
        assert runs.run(deck).summary["converged"] is False


def test_a_deck_on_the_paper_s_rule_must_leave_a_summary_of_its_own(tools, tmp_path):
    from runs import RunError, Runs

    program = tmp_path / "nothing"
    program.write_text("#!/bin/sh\nexit 1\n")
    program.chmod(0o755)
    deck = tmp_path / "fig00_paper.nml"
    deck.write_text(DECK)
    left = tmp_path / "runs" / "fig00_paper" / "summary.nml"
    left.parent.mkdir(parents=True)
    left.write_text("&summary /\n")
    with pytest.raises(RunError, match="status 1"):
        Runs(tmp_path / "runs", program).run(deck)


def test_runs_of_a_deck_on_the_paper_s_rule_differ_in_the_twelfth_digit_of_hamaker_alone(
        tools, snapin_path, tmp_path):
    import draws
    from runs import Runs

    runs = Runs(tmp_path, snapin_path, count=3)
    names = runs.with_draws(["fig07_paper", "fig06_converged"])
    assert names == ["fig07_paper", "fig07_paper_draw1", "fig07_paper_draw2", "fig06_converged"]
    plain, *others = (f90nml.read(runs.path_of(name)) for name in names[:3])
    for number, groups in enumerate(others, 1):
        factor = groups["force"].pop("hamaker") / plain["force"]["hamaker"]
        assert factor == pytest.approx(1 + number * 1e-12, rel=1e-15)
        values = np.divide(groups["sweep"].pop("values"), plain["sweep"]["values"])
        np.testing.assert_allclose(values, 1 + number * 1e-12, rtol=1e-15)
        rest = f90nml.read(runs.path_of("fig07_paper"))
        del rest["force"]["hamaker"], rest["sweep"]["values"]
        assert groups == rest
    assert draws.COUNT >= 5


def test_what_differs_between_runs_is_printed_as_a_range_and_what_rounding_leaves_not_at_all(tools):
    import draws

    assert draws.ranged([1.234, 0.9, 2.0]) == "0.90 to 2.00"
    assert draws.ranged([1.0001, 1.0002]) == "1.00"
    assert draws.within(3e-15) == "better than 1e-9" and draws.within(2e-4) == "2e-4"


def test_figure_6_neck_and_tension_are_those_between_the_nodes(tools, runs):
    """Nodes alone would say 8.82137 um and 16.33 MPa."""
    import fig06

    radius, tension, _ = fig06._edge(fig06._states(runs)[-1])
    assert radius == pytest.approx(8.8238e-6, rel=5e-6)
    assert tension == pytest.approx(16.336e6, rel=5e-5)


def test_rows_are_written_as_csv_that_reads_back(tools, tmp_path):
    from published import Row, write_csv

    rows = [Row("a, b", -59, None, 60.71785243, "µN", 'a "note", with commas'),
            Row("words", "10-20", 0, 1e-19)]
    write_csv(tmp_path / "rows.csv", rows)
    with (tmp_path / "rows.csv").open(encoding="utf-8", newline="") as file:
        read = list(csv.DictReader(file))
    assert tuple(read[0]) == Row.COLUMNS
    assert read[0]["item"] == "a, b" and read[0]["note"] == 'a "note", with commas'
    values = [[row[column] for column in Row.COLUMNS[1:4]] for row in read]
    assert values == [["-59", "", "60.7179"], ["10-20", "0", "1e-19"]]
    assert not list(tmp_path.glob("*.partial"))


def test_a_cell_does_not_break_its_markdown_table(tools):
    from published import Row
    from report import table

    lines = table([Row("1/|r-t|", 1, 2, 3, "", "a_b*c")])
    assert lines[2].replace("\\|", "").count("|") == lines[0].count("|")


def test_all_decks_of_figures_pass_the_check(snapin):
    decks = sorted(INPUTS.glob("fig*.nml"))
    done = snapin("--check", *decks)
    assert done.returncode == 0, done.stderr


def test_every_deck_of_a_figure_belongs_to_a_chapter_and_exists(modules):
    used = {deck for module in modules.values() for deck in module.DECKS}
    assert {path.stem for path in INPUTS.glob("fig*.nml")} <= used
    for deck in used:
        assert (INPUTS / f"{deck}.nml").is_file(), deck


@pytest.mark.parametrize("paper", [path.stem for path in sorted(INPUTS.glob("fig*_paper.nml"))])
def test_the_paper_s_version_and_the_converged_one_differ_in_numerics_alone(paper):
    ours, theirs = (f90nml.read(INPUTS / f"{stem}.nml")
                    for stem in (paper.replace("_paper", "_converged"), paper))
    for group in ("bodies", "force"):
        assert ours[group] == theirs[group]
    rule = theirs["numerics"]
    assert rule["convergence"] == "displacement_change" and rule["method"] == "mixing"
    assert rule["grid"] == "uniform" and 200 <= rule["nodes"] <= 1500
    assert 10e-9 <= rule["r_max"] / (rule["nodes"] - 1) <= 100.5e-9
    assert rule["displacement_tolerance"] == 1e-13
    assert rule.get("mixing_limit", 0.2) == 0.2


def test_figure_1_pulls_off_7_9_percent_above_jkr(runs):
    summary = runs["fig01_lennard_jones"].summary
    # Known independently for sigma = 0.87; the deck's is 0.8717, and the ratio falls with sigma at
    # 0.07, which makes 1.1e-4.
    assert summary["max_tension"] == pytest.approx(1.07953786 * 56.25e-6, rel=2e-4)
    assert summary["max_tension"] < 1.07953786 * 56.25e-6


@pytest.mark.parametrize(("big_lambda", "percent"), [(0.01, -88.4), (1, -45.5), (1e4, -13.7)])
def test_figure_3_hertz_theory_is_off_by_the_known_amounts(tools, runs, big_lambda, percent):
    import fig03

    assert fig03.at(fig03.errors(runs), "hertz", big_lambda) == pytest.approx(percent, abs=0.05)


def test_figure_3_both_approximations_are_low_and_worse_for_larger_lambda(tools, runs):
    import fig03

    found = fig03.errors(runs)
    for key in ("displacement", "load"):
        assert (found[key] < 0).all() and (np.diff(found[key]) < 0).all()
    assert (found["load"] < found["displacement"]).all()
    assert (np.diff(found["hertz"]) > 0).all()
    assert fig03.at(found, "displacement", 0.01) == pytest.approx(-0.79, abs=0.005)
    assert fig03.at(found, "load", 0.01) == pytest.approx(-1.39, abs=0.005)


def test_figure_6_contact_radii_of_approach_and_retreat_agree(tools, runs):
    import fig06

    assert fig06._radii_differ(runs["fig06_converged"]) < 1e-4


def test_the_printed_kernel_is_a_misprint(tools, runs):
    import misprints

    found = misprints.evidence(runs)
    assert found["right"] == pytest.approx(1, abs=1e-12)
    assert found["parameter"] == pytest.approx(found["angular"], rel=1e-12)
    assert abs(found["modulus"] / found["angular"] - 1) > 0.05


def test_the_published_report_is_whole_and_its_pictures_are_small():
    folder = ROOT / "docs" / "reproduction"
    report = (folder / "report.md").read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#]+)\)", report)
    assert "published_vs_computed.csv" in links and "fig01.png" in links
    for link in links:
        assert (folder / link).is_file(), link
    assert "**Failed:**" not in report
    for picture in folder.glob("*.png"):
        assert picture.stat().st_size < 150_000, picture


def test_the_command_writes_report_table_and_picture_and_fails_on_a_bad_name(snapin_path, tmp_path):
    command = [sys.executable, str(TOOLS / "reproduce.py"), "--out", str(tmp_path), "-j", "2",
               "--program", str(snapin_path)]
    environment = {key: value for key, value in os.environ.items() if key != "SNAPIN"}

    def run(*args):
        return subprocess.run([*command, *args], capture_output=True, text=True, timeout=HANG,
                              check=False, env=environment)

    done = run("fig03")
    assert done.returncode == 0, done.stderr
    assert "run 1 of 1: fig03" in done.stderr
    picture = (tmp_path / "fig03.png").read_bytes()
    assert picture[:4] == b"\x89PNG" and len(picture) < 150_000
    report = (tmp_path / "report_part.md").read_text(encoding="utf-8")
    assert not (tmp_path / "report.md").exists()
    assert "](fig03.png)" in report and "{" not in report and str(ROOT) not in report
    assert "13.70 %" in report
    assert "Lambda = 1e4" in (tmp_path / "published_vs_computed_part.csv").read_text(
        encoding="utf-8")
    assert "1 of 1 runs are there already" in run("fig03").stderr
    assert run("fig99").returncode == 2
    assert run("-j", "0", "fig03").returncode == 2
