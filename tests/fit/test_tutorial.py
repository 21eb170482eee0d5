"""docs/tutorial.md: its commands give what it says, and its spoilt curves the messages it shows."""

import re

import pytest
from conftest import ROOT
from snapin import read_results

FOLDER = ROOT / "inputs/tutorial"
PAGE = (ROOT / "docs/tutorial.md").read_text(encoding="utf-8")
DECK = (FOLDER / "probe.nml").read_text(encoding="utf-8")


@pytest.fixture
def fit(snapin, tmp_path):
    """Runs the deck with another file, and with further keys of &measurement."""

    def run(name="probe", keys="", columns="'Z', 'Force', 'Segment'", spring="42"):
        text = DECK.replace("'probe.txt'", f"'{FOLDER}/{name}.txt'").replace(
            "spring_constant = 42", f"{keys} spring_constant = {spring}").replace(
            "'Z', 'Force', 'Segment'", columns)
        (tmp_path / "d.nml").write_text(text)
        done = snapin("--out", tmp_path, tmp_path / "d.nml")
        said = " ".join(done.stderr.split())
        found = read_results(tmp_path / "d").fitted
        if not found:
            return said, {}
        return said, dict(zip(found["fit"]["parameters"], found["fit"]["estimate"]))

    return run


def phrases(row):
    """The parts of a message in a row of the table, without the marks of code."""
    message = next(line for line in PAGE.splitlines() if f"`{row}.txt`" in line).split(" | ")[2]
    return [part.strip() for part in message.replace("`", "").split("...")]


def test_the_curve_gives_the_numbers_of_the_page(fit):
    said, _ = fit()
    lines = [line.strip() for line in PAGE.splitlines() if line.startswith("    fit: ")]
    assert len(lines) == 3
    number = r"[0-9][0-9.]*(?:e-[0-9]+)?"
    for line in lines:
        # The last digits may differ between compilers.
        pattern = "(" + f")({number})(".join(map(re.escape, re.split(number, line))) + ")"
        (found,) = re.findall(pattern, said)
        for text, expected in zip(found[1::2], re.findall(number, line)):
            assert float(text) == pytest.approx(float(expected), rel=2e-2)
    assert "warning" not in said
    # A fitted value that also follows from the fit, in the field's words, is told once.
    assert said.count("0.042") == 1, said
    assert "force.work_of_adhesion =" not in said


@pytest.mark.slow
@pytest.mark.parametrize("name", ["probe_sign", "probe_exchanged", "probe_ripple", "probe_bow"])
def test_a_spoilt_curve_has_the_message_of_the_page(fit, name):
    said, _ = fit(name)
    for phrase in phrases(name):
        start = re.sub(r"\d.*", "", phrase)
        assert start in said, (phrase, said)
    # What noise might hide is not told beside what the data show.
    assert "by as little as noise hides" not in said


@pytest.mark.parametrize(("name", "keys", "columns"), [
    ("probe_sign", "", "'Z', '-Force', 'Segment'"),
    ("probe_exchanged", "approach = 'Retract', retract = 'Extend',", "'Z', 'Force', 'Segment'"),
    ("probe_ripple", "ripple = .true.,", "'Z', 'Force', 'Segment'"),
    ("probe_bow", "baseline = 'quadratic',", "'Z', 'Force', 'Segment'")])
def test_the_remedy_of_the_page_gives_the_truth(fit, name, keys, columns):
    said, found = fit(name, keys, columns)
    assert "does not describe" not in said, said
    assert found["force.work_of_adhesion"] == pytest.approx(0.042, rel=0.02)
    assert found["bodies.young(2)"] == pytest.approx(1.3e9, rel=0.05)


def test_a_spring_constant_ten_times_too_small_is_refused(fit):
    said, _ = fit(spring="4.2")
    assert "where the spring permits 3.6e-7 N at most" in said
