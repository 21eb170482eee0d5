"""Claims about force laws from files, whose tables are those of laws with a formula."""

import math

import numpy as np
import pytest
import snapin
from conftest import ROOT
from support.calculus import derivative, integrals

HAMAKER, Z0 = 1e-20, 0.5e-9
LAW = snapin.lennard_jones(hamaker=HAMAKER, z0=Z0)
FIRST, LAST = 0.3e-9, 50e-9


def points(a_decade):
    """Return gaps [m] that are so many a decade."""
    return np.geomspace(FIRST, LAST, round(a_decade * math.log10(LAST / FIRST)) + 1)


def table(folder, gap, value, **keys):
    """Return the group of a law from a file that is written into the folder."""
    np.savetxt(folder / "law.txt", np.column_stack([gap, value]), fmt="%.17e")
    return {"tabulated": {"file": str(folder / "law.txt"), "tail_exponent": 3, **keys}}


def lennard_jones(folder, a_decade=40, **keys):
    """Return a table of the Lennard-Jones law."""
    gap = points(a_decade)
    values = snapin.force_law(LAW, gap)
    energy = keys.get("quantity") == "energy"
    return table(folder, gap, values.energy if energy else values.pressure, **keys)


KINDS = [
    {"interpolation": interpolation, "quantity": quantity, **tail}
    for interpolation in ("spline", "monotone")
    for quantity in ("pressure", "energy")
    for tail in ({}, {"tail_exponent": None, "tail_decay_length": 9e-9})
]


@pytest.mark.parametrize("keys", KINDS, ids=lambda keys: "-".join(map(str, keys.values())))
def test_slope_is_the_derivative_and_energy_the_integral(tmp_path, keys):
    groups = lennard_jones(tmp_path, 20, **keys)
    # Between points, before the first and after the last.
    ends = np.r_[0.1e-9, points(20), 2 * LAST, 4 * LAST]

    def pressure(at):
        return snapin.force_law(groups, at).pressure

    integral, size = integrals(pressure, ends)
    energy = snapin.force_law(groups, ends).energy
    assert (abs(energy[:-1] - energy[1:] - integral) <= 1e-12 * (size + abs(energy[:-1]))).all()
    length, middle = np.diff(ends), (ends[:-1] + ends[1:]) / 2
    slope = derivative(pressure, middle, 1e-2 * length)
    size = np.maximum(abs(pressure(middle - 1e-2 * length)), abs(pressure(middle))) / length
    assert (abs(snapin.force_law(groups, middle).slope - slope) <= 2e-8 * size).all()


@pytest.mark.parametrize("quantity", ["pressure", "energy"])
@pytest.mark.parametrize("interpolation", ["spline", "monotone"])
def test_points_are_met_and_nothing_jumps(tmp_path, interpolation, quantity):
    groups = lennard_jones(tmp_path, quantity=quantity, interpolation=interpolation)
    gap = points(40)
    exact = getattr(snapin.force_law(LAW, gap), quantity)
    np.testing.assert_allclose(getattr(snapin.force_law(groups, gap), quantity), exact, rtol=1e-11)
    before, after = (snapin.force_law(groups, gap * (1 + e)) for e in (-1e-12, 1e-12))
    size = snapin.force_law(snapin.lennard_jones(hamaker=HAMAKER, z0=Z0, part="repulsive"), gap)
    for one, two, scale in zip(before, after, size):
        # The curvature of a monotone interpolant jumps, which is in the slope where that of the
        # energy is interpolated.
        if scale is size.slope and (interpolation, quantity) == ("monotone", "energy"):
            continue
        assert (abs(one - two) <= 1e-9 * (abs(scale) + abs(one))).all()


@pytest.mark.parametrize(
    ("interpolation", "order", "best"), [("spline", 3.7, 5e-7), ("monotone", 3.5, 2e-6)])
def test_table_converges_to_its_law(tmp_path, interpolation, order, best):
    exact = snapin.law_numbers(LAW).surface_energy
    errors = []
    for a_decade in (20, 40, 80):
        groups = lennard_jones(tmp_path, a_decade, interpolation=interpolation)
        errors.append(abs(snapin.law_numbers(groups).surface_energy / exact - 1))
    assert errors[2] <= best
    assert math.log2(errors[0] / errors[2]) / 2 >= order


def test_what_is_beyond_the_table_is_its_tail(tmp_path):
    far = np.array([2, 10, 1e3]) * LAST
    values = snapin.force_law(lennard_jones(tmp_path), far)
    np.testing.assert_allclose(values.pressure, -HAMAKER / (6 * math.pi * far**3), rtol=1e-11)
    np.testing.assert_allclose(values.energy, -HAMAKER / (12 * math.pi * far**2), rtol=1e-11)


def test_an_exponential_law_is_met_with_its_tail_by_any_table(tmp_path):
    gap = np.linspace(0.2e-9, 4e-9, 9)
    exponential = snapin.exponential(p0=1e7, decay_length=0.7e-9)
    keys = {"tail_exponent": None, "tail_decay_length": 0.7e-9}
    groups = table(tmp_path, gap, snapin.force_law(exponential, gap).pressure, **keys)
    at = np.linspace(0.2e-9, 20e-9, 40)
    for found, exact in zip(snapin.force_law(groups, at), snapin.force_law(exponential, at)):
        np.testing.assert_allclose(found, exact, rtol=1e-12)


def test_before_the_table_repulsion_is_a_power(tmp_path):
    gap = np.geomspace(1e-9, 1e-8, 9)
    groups = table(tmp_path, gap, 1e-20 * gap**-3.0, tail_exponent=3)
    near = np.array([1e-11, 1e-10, 9e-10])
    values = snapin.force_law(groups, near)
    np.testing.assert_allclose(values.pressure, 1e-20 * near**-3.0, rtol=1e-11)
    np.testing.assert_allclose(values.energy, 1e-20 * near**-2.0 / 2, rtol=1e-11)


def test_order_commas_and_comments_are_as_one_likes(tmp_path):
    plain = lennard_jones(tmp_path)
    lines = (tmp_path / "law.txt").read_text().splitlines()
    freely = ["# law", "", *(line.replace(" ", " ,\t") + "  # point" for line in lines[::-1])]
    (tmp_path / "freely.txt").write_text("\r\n".join(freely))
    other = {"tabulated": {"file": str(tmp_path / "freely.txt"), "tail_exponent": 3}}
    gap = np.geomspace(0.2e-9, 1e-7, 50)
    for one, two in zip(snapin.force_law(plain, gap), snapin.force_law(other, gap)):
        assert (one == two).all()


def test_the_file_is_in_the_folder_of_the_deck(tmp_path, monkeypatch):
    groups = lennard_jones(tmp_path)
    groups["tabulated"]["file"] = "law.txt"
    bodies = {"radius": 1e-2, "rigid": True}
    deck = {"bodies": bodies, **groups, "classical": {"h0_start": 1e-9, "h0_end": 0.0}}
    (tmp_path / "deck.nml").write_text(snapin.deck_text(deck))
    monkeypatch.chdir(tmp_path.parent)
    assert snapin.run(tmp_path / "deck.nml").summary["surface_energy"] > 0
    with pytest.raises(snapin.DeckError, match=r"law\.txt: no such file"):
        snapin.law_numbers(groups)


@pytest.mark.filterwarnings("ignore::snapin.SnapinWarning")
def test_summary_tells_what_the_points_leave_open(tmp_path):
    bodies = {"radius": 1e-2, "stiffness": 1e10}
    path = {"bodies": bodies, "equilibrium_path": {"h0_end": 0.0}}
    exact = snapin.run({**path, **LAW}).summary
    # Of too few points the estimate is that of the worse table. It covers what depends on the depth
    # of the well and what depends on the largest tension, of which the points tell less.
    for a_decade, most in ((10, 40), (40, 5)):
        found = snapin.run({**path, **lennard_jones(tmp_path, a_decade)}).summary
        error = max(abs(found[key] / exact[key] - 1)
                    for key in ("max_tension", "jump_in_load", "jump_out_load"))
        assert error <= found["table_error"] <= most * error
        warned = any("points of the table" in line for line in found.get("warnings", []))
        assert warned == (found["table_error"] > 1e-3) == (a_decade == 10)
    assert "table_error" not in exact


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::snapin.SnapinWarning")
def test_noise_of_the_points_is_part_of_the_error_of_the_table(tmp_path):
    """The error of the interpolation alone was up to 71 times too small."""
    gap = np.geomspace(0.28e-9, 10e-9, 90)
    smooth = snapin.force_law(LAW, gap).pressure
    path = {"bodies": {"radius": 1e-2, "stiffness": 1e10}, "equilibrium_path": {"h0_end": 0.0}}
    exact = snapin.run({**path, **LAW}).summary
    for noise, seed in ((1e-4, 0), (1e-4, 1), (1e-3, 2), (1e-3, 3), (1e-2, 1)):
        noisy = smooth * (1 + noise * np.random.default_rng(seed).standard_normal(gap.size))
        found = snapin.run({**path, **table(tmp_path, gap, noisy)}).summary
        error = max(abs(found[key] / exact[key] - 1) for key in ("surface_energy", "max_tension"))
        assert error < found["table_error"] < 5 * noise, (noise, seed)


def test_example_is_the_first_scene():
    names = "first.nml", "examples/tabulated.nml"
    first, found = (snapin.run(ROOT / "inputs" / name).summary for name in names)
    for key in ("max_tension", "jump_in_h0", "jump_out_h0"):
        assert found[key] == pytest.approx(first[key], rel=3e-5)
    assert 1e-6 < found["table_error"] < 3e-5


def test_a_line_of_names_is_no_row(tmp_path):
    groups = lennard_jones(tmp_path)
    file = tmp_path / "named.txt"
    named = {"tabulated": {**groups["tabulated"], "file": str(file)}}
    for header in ("gap pressure", '"gap (m)" "pressure, Pa"'):
        file.write_text(header + "\n" + (tmp_path / "law.txt").read_text())
        assert snapin.law_numbers(named) == snapin.law_numbers(groups)


# --- Mistakes

GOOD = [f"{gap:.6e} {(Z0 / gap) ** 9 - (Z0 / gap) ** 3:.6e}" for gap in points(8)]


@pytest.mark.parametrize(("lines", "line", "what"), [
    ([*GOOD[:3], "nan 1", *GOOD[3:]], 4, "not a finite number"),
    ([*GOOD[:3], "1e-9 inf", *GOOD[3:]], 4, "not a finite number"),
    ([*GOOD[:3], "1e-9", *GOOD[3:]], 4, "1 column where 2"),
    ([*GOOD[:3], "1e-9 2 3", *GOOD[3:]], 4, "3 columns where 2"),
    ([*GOOD[:3], "1e-9 two", *GOOD[3:]], 4, "not a number"),
    ([*GOOD[:3], GOOD[2], *GOOD[3:]], 4, "neither increase"),
    ([*GOOD[:3], GOOD[0], *GOOD[3:]], 4, "neither increase"),
    (["0.0 1", *GOOD], 1, "not positive"),
    (GOOD[:7], 7, "fewer than 8"),
    ([], 1, "fewer than 8"),
])
def test_a_mistake_in_the_file_is_shown_with_its_line(tmp_path, lines, line, what):
    (tmp_path / "law.txt").write_text("\n".join(lines))
    with pytest.raises(snapin.DeckError) as told:
        snapin.law_numbers({"tabulated": {"file": str(tmp_path / "law.txt"), "tail_exponent": 3}})
    assert "&tabulated" in str(told.value) and "file" in str(told.value)
    assert f"law.txt:{line}: " in str(told.value) and what in str(told.value)


def test_a_force_that_ends_before_its_first_gap_cannot_be_continued(tmp_path):
    gap = np.linspace(0.5e-9, 5e-9, 12)
    with pytest.raises(snapin.DeckError, match="does not grow towards the first gap"):
        snapin.law_numbers(table(tmp_path, gap, 1e6 * (gap / 1e-9) * np.exp(-gap / 1e-9)))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::snapin.SnapinWarning")
@pytest.mark.parametrize("tail", [{"tail_exponent": 6}, {"tail_exponent": 2},
                                  {"tail_exponent": None, "tail_decay_length": 0.3e-9}])
def test_a_tail_that_the_last_points_do_not_lead_into_counts_as_an_error_of_the_table(
        tmp_path, tail):
    """Surface energies were off by some per cent, and nothing said so."""
    gap = np.geomspace(0.3e-9, 3e-9, 60)
    groups = table(tmp_path, gap, snapin.force_law(LAW, gap).pressure, **tail)
    path = {"bodies": {"radius": 1e-2, "stiffness": 1e10}, "equilibrium_path": {"h0_end": 0.0}}
    found = snapin.run({**path, **groups}).summary
    exact = snapin.run({**path, **LAW}).summary["surface_energy"]
    # The decay length of a power, seen at the end, grows farther out.
    assert found["table_error"] == pytest.approx(
        abs(found["surface_energy"] / exact - 1), rel=0.6 if "tail_decay_length" in tail else 0.2)
    assert any("do not lead into its tail" in line for line in found["warnings"])
