"""What others published: errors of formulas beside what another program found of them."""

import csv
import math

import numpy as np
import pytest
from conftest import ROOT

pytest.importorskip("matplotlib")
import formulas  # noqa: E402 (needs matplotlib)
import spheres  # noqa: E402
from report import Comparison, module as chapter  # noqa: E402

# From another program: Tabor's parameter, pull-off over pi w R and its h0; h0 and tension of both
# jumps; energy lost over w R z0.
SPHERES = [
    (0.1, 1.968956, 1.0586, None, None, 0),
    (0.8, 1.706360, 1.7087, (2.37954, 0.85003), (2.40423, 1.08670), 0.0336),
    (1, 1.670665, 1.8734, (2.62922, 0.68109), (2.74343, 1.03243), 0.2507),
    (5, 1.525718, 4.9594, (5.26358, 0.16712), (9.18977, 0.85177), 16.2459),
]


@pytest.mark.parametrize("tabor, tension, h0, jump_in, jump_out, lost", SPHERES)
def test_spheres_are_those_of_another_program(tabor, tension, h0, jump_in, jump_out, lost):
    found = spheres.sphere(float(tabor))
    assert found.tension == pytest.approx(tension, abs=1e-6)
    assert found.tension_h0 == pytest.approx(h0, abs=6e-5)
    for mine, theirs in ((found.jump_in, jump_in), (found.jump_out, jump_out)):
        assert (mine is None) == (theirs is None)
        if mine:
            assert mine == pytest.approx(theirs, abs=6e-6)
    assert found.lost == pytest.approx(lost, abs=1e-4)


def test_curves_are_s_shaped_from_the_cusp_on():
    """At sigma = 0.29108493, where another program found that two folds meet."""
    tabor = (4 * 0.29108493**2) ** (1 / 3)
    assert chapter("greenwood_1997").cusp() == pytest.approx(tabor, rel=2e-4)


def test_radius_of_a_contact_is_jkr_theory_s_when_the_range_is_short():
    for load in (0.0, 10.0):
        exact = spheres.theory("jkr", 1.0, load)[1]
        errors = [spheres.contact(tabor, load).radius / exact - 1 for tabor in (10.0, 100.0)]
        assert abs(errors[1]) < 2e-3 and abs(errors[1]) < abs(errors[0])


@pytest.mark.parametrize("chi, ratio", [(0.18507, 1.26977), (0.41721, 1.85712), (0.62011, 2.68406),
                                        (1.05444, 5.56319), (1.34893, 8.46801)])
def test_loads_on_layers_are_those_of_another_program(chi, ratio):
    assert chapter("indentation_of_layers").solved(chi) == pytest.approx(ratio, rel=2e-5)


def test_errors_of_the_formulas_for_layers():
    layers = chapter("indentation_of_layers")
    for name, chi, percent in (("dimitriadis", 0.41721, -5.5), ("dimitriadis", 0.62011, -11),
                               ("dimitriadis", 1.05444, -17), ("garcia", 0.41721, 0.3),
                               ("garcia", 0.62011, 2), ("garcia", 1.05444, 17)):
        assert layers.error(name, chi) == pytest.approx(percent, abs=0.6)


@pytest.mark.parametrize("nu, values", [
    (0.5, (1.2806, 1.6837, 2.2129, 2.8602, 3.6187, 6.003, 9.150)),
    (0.3, (1.2066, 1.4726, 1.7848, 2.1260, 2.4835, 3.4090, 4.3532))])
def test_stiffness_of_a_sphere_is_that_of_a_flat_punch(nu, values):
    """kappa of another program's punches, by an equation of their own."""
    hayes = chapter("hayes_1972")
    assert [hayes.kappa(nu, ratio) for ratio in hayes.RATIOS] == pytest.approx(values, abs=7e-4)


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
    assert Comparison("x", "not read", None, 1.0).error is None
    for kind, value in (("not read", 1.0), ("formula", None), ("guess", 1.0)):
        with pytest.raises(ValueError, match="x"):
            Comparison("x", kind, value, 1.0).cells()


def test_every_published_row_has_its_kind_and_source():
    with (ROOT / "docs/reproduction/others.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) > 200
    for row in rows:
        assert row["source"] and (row["published"] == "") == (row["kind"] == "not read"), row


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
