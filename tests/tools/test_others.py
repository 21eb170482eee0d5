"""What others published: errors of formulas beside what another program found of them."""

import csv
import math

import numpy as np
import pytest
from conftest import ROOT
from support.known import BY_TABOR, ERRORS, PUNCH, PUNCH_ON_FILM, SPHERE_ON_FILM

pytest.importorskip("matplotlib")
import formulas  # noqa: E402 (needs matplotlib)
import spheres  # noqa: E402
from report import Comparison, module as chapter  # noqa: E402


@pytest.mark.parametrize("tabor", BY_TABOR)
def test_spheres_are_those_of_another_program(tabor):
    found = spheres.sphere(tabor)
    mine = [found.tension, found.tension_h0]
    if found.jump_in:
        (in_h0, in_tension), (out_h0, out_tension) = found.jump_in, found.jump_out
        mine += [in_h0, -in_tension, out_h0, -out_tension, found.lost]
    assert len(mine) == len(BY_TABOR[tabor])
    for one, other, error in zip(mine, BY_TABOR[tabor], ERRORS):
        assert one == pytest.approx(other, abs=error)


def test_curves_are_s_shaped_from_the_cusp_on():
    """At sigma = 0.29108493, where another program found that two folds meet."""
    tabor = (4 * 0.29108493**2) ** (1 / 3)
    assert chapter("greenwood_1997").cusp() == pytest.approx(tabor, rel=2e-4)


def test_radius_of_a_contact_is_jkr_theory_s_when_the_range_is_short():
    for load in (0.0, 10.0):
        exact = spheres.theory("jkr", 1.0, load)[1]
        errors = [spheres.contact(tabor, load).radius / exact - 1 for tabor in (10.0, 100.0)]
        assert abs(errors[1]) < 2e-3 and abs(errors[1]) < abs(errors[0])


@pytest.mark.parametrize("chi, ratio", SPHERE_ON_FILM)
def test_loads_on_layers_are_those_of_another_program(chi, ratio):
    assert chapter("indentation_of_layers").solved(chi) == pytest.approx(ratio, rel=2e-5)


def test_errors_of_the_formulas_for_layers():
    layers = chapter("indentation_of_layers")
    for name, chi, percent in (("dimitriadis", 0.41721, -5.5), ("dimitriadis", 0.62011, -11),
                               ("dimitriadis", 1.05444, -17), ("garcia", 0.41721, 0.3),
                               ("garcia", 0.62011, 2), ("garcia", 1.05444, 17)):
        assert layers.error(name, chi) == pytest.approx(percent, abs=0.6)


@pytest.mark.parametrize("nu, values", PUNCH_ON_FILM.items())
def test_stiffness_of_a_sphere_is_that_of_a_flat_punch(nu, values):
    """kappa of another program's punches, by an equation of their own."""
    hayes = chapter("hayes_1972")
    assert [hayes.kappa(nu, ratio) for ratio in PUNCH] == pytest.approx(values, abs=7e-4)


def test_loss_of_jkr_theory_is_the_known_one():
    assert chapter("ciavarella_2017").jkr() == pytest.approx(7.09220, abs=5e-6)


def test_pull_offs_of_powers_have_their_closed_forms():
    powers = chapter("zheng_yu_2007")
    # A cone, f = r tan(beta): 54 w^2/(pi E* tan^3 beta).
    assert powers.formula(1.0, 0.7)[1] == pytest.approx(54 * 0.49 / (math.pi * 0.5 * 0.5**3))
    assert powers.formula(2.0, 0.7)[1] == pytest.approx(1.5 * math.pi * 0.7)
    # Of r^3 at sigma = 1, from another program.
    assert powers.ratio(3.0, 2 ** (3 / 5)) == pytest.approx(1.0215, abs=1e-4)


def test_dugdale_s_law_solved_goes_to_maugis_theory_as_its_step_sharpens():
    maugis = chapter("maugis_1992")
    excess = [solved / theory - 1 for solved, theory, _ in
              (maugis.dugdale(1.0, smoothing) for smoothing in (0.1, 0.04))]
    assert 0 < excess[1] < 0.5 * excess[0] < 0.01


def test_a_row_says_where_its_number_is_from():
    row = Comparison("x", "formula", 1.1, 1.0, "", "somewhere")
    assert row.error == pytest.approx(10) and len(row.cells()) == 7
    for kind, value in (("not read", None), ("formula", None), ("guess", 1.0)):
        with pytest.raises(ValueError, match="x"):
            Comparison("x", kind, value, 1.0).cells()


def test_every_published_row_has_its_kind_and_source():
    with (ROOT / "docs/reproduction/others.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) > 80
    for row in rows:
        assert row["source"] and row["published"], row


def test_the_page_of_formulas_has_the_errors_of_the_tool():
    """Of formulas that take no minute."""
    page = (ROOT / "docs" / "formulas.md").read_text(encoding="utf-8")
    lines = {tuple(cell.strip() for cell in line.split("|")[1:3]): line
             for line in page.splitlines() if line.startswith("| ")}
    wanted = [one for one in formulas.formulas()
              if one.quantity == "load on a thin layer, ν = 0.5" or one.name == "JKR, n = 6"]
    assert len(wanted) == 3
    for one in wanted:
        (line,) = formulas.table([one])[2:]
        assert lines[one.quantity, one.name] == line


def test_ranges_are_said_in_words():
    grid = np.arange(1.0, 11)
    errors = np.where(grid < 4, 0.2, 0.0)
    assert formulas.good(errors, grid, "x", 0.1) == "x ≥ 4"
    assert formulas.good(errors[::-1], grid, "x", 0.1) == "x ≤ 7"
    assert formulas.good(errors * 0, grid, "x", 0.1) == "everywhere"
    assert formulas.good(errors + 1, grid, "x", 0.1) == "nowhere"
