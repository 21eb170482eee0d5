"""Claims about tools/contact_law.py: the files of the project are what it makes, from solved paths,
and it makes the law of another force."""

import json
import re

import contact_law as tool
import law_calculator
import law_errors
import law_header
import law_states
import law_tables
import numpy as np
import pytest
from snapin.contact_law import ContactLaw, coefficients
from support.contact_header import COMPILER, NUMBERS, Header, bodies_at, parted


@pytest.mark.parametrize("place, text", [
    (tool.HEADER, law_header.header_text), (tool.SCRIPT, law_calculator.script_text),
    (tool.CALCULATOR, law_calculator.page_text)], ids=["header", "script", "calculator"])
def test_files_of_the_project_are_made_from_its_table(place, text):
    assert place.read_text(encoding="utf-8") == text(coefficients()), (
        "bring them up to date with: tools/contact_law.py --remake")


def test_the_page_has_the_errors_of_the_table():
    page = (tool.pages.ROOT / "docs" / "tables.md").read_text(encoding="utf-8")
    told = re.findall(r"^\| .* \| (\d\.\de-\d) \|$", page, re.MULTILINE)
    measured = coefficients()["errors"]["within"]["largest"]
    assert told == [f"{error:.1e}".replace("e-0", "e-") for error, _ in measured.values()]
    assert list(measured) == list(law_errors.KINDS) and len(told) == 6


def whole_numbers(tables):
    """The numbers of some tables in one array, rows filled up with zeros."""
    rows = [row + [0]*(law_tables.ORDER - len(row)) for table in tables
            for row in table["rows"] + [[]]*(law_tables.NODES - len(table["rows"]))]
    return np.array(rows, float)


@pytest.mark.slow
@pytest.mark.parametrize("number", [
    pytest.param(2, id="whole path"),
    pytest.param(-2, id="two pieces", marks=pytest.mark.long)])
def test_the_table_is_computed_from_solved_paths(number, monkeypatch):
    """One panel anew. The error of paths of accuracy 1e-9 is in its last few digits."""
    # It takes most of the time, and test_contact_law compares it between panels.
    monkeypatch.setattr(law_tables.Near, "_energy", lambda *_: 0.0)
    stored = coefficients()["near"][number]
    panel = law_tables.Near(law_states.Force(tool.LENNARD_JONES), stored["whole"],
                            stored["variable"], stored["low"], stored["high"])
    found = panel.tables()
    for name in ("outside", "contact"):
        tables = [law_tables.rounded(tile[:, :, one])
                  for tile in np.moveaxis(found[name], 1, 0) for one in (0, 1)]
        difference = whole_numbers(tables) - whole_numbers(
            [table for tile in stored[name] for table in tile])
        assert np.abs(difference).max() <= 5
    assert panel.outside == pytest.approx(stored["outside_edges"], rel=1e-9)
    assert panel.contact == pytest.approx(stored["contact_edges"], rel=1e-6)


def test_deep_contact_is_computed_from_solved_paths():
    force = law_states.Force(tool.LENNARD_JONES)
    wall = law_tables.wall_series(force)
    table = coefficients()
    stored = np.array(table["wall"]["rows"][0])*law_tables.UNIT
    assert stored == pytest.approx(wall[:stored.size], abs=law_tables.UNIT)
    # The mean gap under a small pressure: (8/3) (h^-9 - h^-3) = P s at 1 - P s/16.
    assert law_tables.wall_gap(wall, np.array([1e-4]), 1.0) == pytest.approx(1 - 1e-4/32, abs=1e-6)


@pytest.mark.slow
@pytest.mark.skipif(COMPILER is None, reason="no C compiler")
def test_the_law_of_another_force(tmp_path, monkeypatch, capsys):
    """Morse's law from an example, over a short range of Tabor's parameter: its header is as exact
    as its first comment says."""
    deck = tool.pages.ROOT / "inputs" / "examples" / "morse.nml"
    monkeypatch.setattr(law_tables, "NODES", 8)
    monkeypatch.setattr("sys.argv", ["contact_law.py", "--deck", str(deck), "--out", str(tmp_path),
                                     "--tabor", "1.3", "2.5", "--states", "100"])
    tool.main()
    assert "pull-off force, relative" in capsys.readouterr().out
    table = json.loads((tmp_path / "contact_law.json").read_text())
    largest = table["errors"]["within"]["largest"]
    head = (tmp_path / "snapin_contact.h").read_text().split("*/")[0]
    assert "morse" in head and f"{largest['load'][0]:.1e}" in head
    assert largest["load"][0] < 1e-4
    force = law_states.Force(deck)
    errors = law_errors.errors_at(table, force, 1.9, np.random.default_rng(2))
    for kind, error in errors.items():
        assert np.max(error) < 1e-4, kind
    header = Header(tmp_path, tmp_path / "snapin_contact.h")
    law = ContactLaw(*bodies_at(1.9), table=table)
    h0 = law.z0*np.array([30.0, 4.0, 1.0, -5.0])
    failed, found, _, numbers = header(bodies_at(1.9), h0, 0)
    assert failed == 0 and numbers["snap_in"] == pytest.approx(law.snap_in, rel=1e-9)
    assert found["load"] == pytest.approx(law.load(h0), rel=1e-8)
    # Beyond the range there is no law, rather than a wrong one.
    assert header(bodies_at(1.0), h0, 0)[0] == 2
    assert np.isnan(header(bodies_at(1.0), h0, 0)[1]["load"]).all()
    with pytest.raises(ValueError):
        ContactLaw(*bodies_at(1.0), table=table)


@pytest.mark.skipif(COMPILER is None, reason="no C compiler")
def test_functions_that_round_to_nothing_are_nothing(tmp_path):
    """As the deformation under forces that decrease exponentially, far outside contact."""
    table = json.loads(json.dumps(coefficients()))
    for panel in table["near"]:
        panel["outside"][-1][0]["rows"] = [[]]
    for panel in table["deep"]:
        panel["tiles"][-1][0]["rows"] = [[]]
    header = tmp_path / "snapin_contact.h"
    header.write_text(law_header.header_text(table), encoding="utf-8")
    law, h0 = ContactLaw(*bodies_at(0.5), table=table), np.array([-1e-6, -1e-9, 2e-9])
    failed, found, *_ = Header(tmp_path, header)(bodies_at(0.5), h0, 0)
    assert failed == 0 and found["load"] == pytest.approx(law.load(h0), rel=1e-8)
    # Without what was rounded away the law is nearly the same.
    assert law.load(h0) == pytest.approx(ContactLaw(*bodies_at(0.5)).load(h0), rel=1e-2)


@pytest.mark.skipif(COMPILER is None, reason="no C compiler")
def test_a_turn_between_two_panels_is_found(tmp_path):
    """The slopes of two tiles may differ so that a turn lies in neither. In Python such a law had
    no jumps, where the header found them."""
    table, mus = parted(coefficients())
    header = tmp_path / "snapin_contact.h"
    header.write_text(law_header.header_text(table), encoding="utf-8")
    called = Header(tmp_path, header)
    for mu in mus:
        law, exact = ContactLaw(*bodies_at(mu), table=table), ContactLaw(*bodies_at(mu))
        assert law.jumps
        # As far as the change of the table goes.
        assert law.snap_in == pytest.approx(exact.snap_in, abs=1e-3*law.z0)
        numbers = called(bodies_at(mu), [], 0)[3]
        for name in NUMBERS:
            assert numbers[name] == pytest.approx(getattr(law, name), rel=1e-7), name


@pytest.mark.parametrize("groups, reason", [
    ({"force": {"law": "lennard_jones", "surface_energy": 0.05, "z0": 3e-10},
      "layer": {"thickness": 1e-9, "young": 1e9, "poisson": 0.3}}, "layer"),
    ({"dugdale": {"stress": 1e8, "range": 1e-9}}, "dugdale"),
    ({"van_der_waals": {"hamaker": 1e-20}, "hydration": {"pressure": 1e9, "decay_length": 2e-10}},
     "z0"),
    ({"force": {"law": "exponential", "p0": 1e6, "decay_length": 1e-9}}, "z0")])
def test_a_force_without_such_a_law_is_refused(groups, reason):
    with pytest.raises(law_states.Unsuitable, match=reason):
        law_states.Force(groups)
