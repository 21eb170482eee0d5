"""Claims about a fluid that drains from between bodies driven in time."""

import math

import numpy as np
import pytest
from support.calculus import gauss
from support.drained import extrapolated
from support.scenes import deck, lennard_jones, several


def scene(sigma, viscosity, *, velocity=1.0, start=15.0, turn=-1.0, accuracy=1e-3, slip=None,
          creep=None, groups=(), **drive):
    """Units: z0, the stiffness, and the time in which h0 changes by z0 at a velocity of 1."""
    fluid = {"viscosity": viscosity}
    if slip is not None:
        fluid["slip_length"] = slip
    return lennard_jones(
        sigma, drive={"velocity": velocity, "z_start": start, "z_turn": turn, **drive}, fluid=fluid,
        viscoelastic=creep, numerics={"accuracy": accuracy}, **dict(groups))


def dry(h0, sigma):
    """The load of rigid bodies without a fluid."""
    return 2 * math.pi * sigma * (h0**-8 / 3 - 4 / 3 * h0**-2)


def of_way(table, way):
    return {name: np.array(table[name])[np.array(table["branch"]) == way]
            for name in ("time", "h0", "h_centre", "load")}


def of_film(viscosity, h0, one, other):
    """The load of a film at unit velocity, 12 pi eta R^2 Int (h - h0)/m dh, with the flow between
    walls of two slip lengths that Navier's condition gives."""
    y, weights = gauss(400, 0, 40)
    h = h0 * np.exp(y)
    # u = (z^2 + a z + b)/2 per pressure gradient over viscosity.
    a = -h * (h + 2 * other) / (h + one + other)
    mobility = -6 * (h**3 / 3 + a * h**2 / 2 + one * a * h)
    return 12 * math.pi * viscosity * weights @ ((h - h0) / mobility * h)


@pytest.mark.parametrize("slip", [None, [2.0], [0.5, 8.0], [0.0, 3.0]])
def test_rigid_bodies_feel_the_film_of_reynolds(run, slip):
    found = run(scene(1e-9, 1e-9, start=100.0, turn=2.0, accuracy=1e-4, slip=slip))
    table = found.table("curve.csv")
    walls = [0.0, 0.0] if slip is None else (slip * 2)[:2]
    for way, sign in (("approach", 1), ("retreat", -1)):
        rows = of_way(table, way)
        # After the turn until what bodies yield has followed.
        for i in np.linspace(0.3 * rows["h0"].size, rows["h0"].size - 1, 9).astype(int):
            h0 = rows["h0"][i]
            film = of_film(1e-9, h0, *walls)
            if slip is None:
                assert film == pytest.approx(6 * math.pi * 1e-9 / h0, rel=1e-9)
            elif len(slip) == 1:
                u = h0 / slip[0]
                factor = u / 3 * ((1 + u / 6) * math.log(1 + 6 / u) - 1)
                assert film == pytest.approx(6 * math.pi * 1e-9 / h0 * factor, rel=1e-9)
            # What bodies yield is 1e-8 of the gap.
            assert rows["load"][i] - dry(h0, 1e-9) == pytest.approx(sign * film, rel=5e-8)


def test_bodies_yield_to_first_order_as_davis_serayssol_and_hinch_have_it(run):
    off = []
    for viscosity in (2e-5, 1e-5):
        table = run(scene(1e-13, viscosity, start=50.0, turn=5.0)).table("curve.csv")
        rows = of_way(table, "approach")
        h0, centre = rows["h0"][-1], rows["h_centre"][-1]
        first = 3 * math.pi / math.sqrt(2) * viscosity / (0.5 * h0**1.5)
        off.append((centre - h0) / first - 1)
    assert abs(off[0]) < 2e-5
    assert 2 * off[1] - off[0] == pytest.approx(0, abs=1e-6)


@pytest.mark.slow
def test_steps_are_of_second_order(run):
    found = [run(scene(0.1, 0.025, turn=0.0, accuracy=1e-7, time_step=step)).summary
             for step in (0.02, 0.01, 0.005)]
    a, b, c = (summary["max_tension"] for summary in found)
    assert 3.5 < (a - b) / (b - c) < 4.5
    assert abs(a - c) < 1e-4 * c


@pytest.mark.slow
@pytest.mark.parametrize("case", [
    {"sigma": 0.1, "viscosity": 0.025},
    pytest.param({"sigma": 2.0, "viscosity": 0.05}, marks=pytest.mark.long),
    {"sigma": 0.1, "viscosity": 0.01, "stiffness": 0.5, "start": 20.0},
    {"sigma": 0.1, "viscosity": 0.01, "start": 20.0,
     "creep": {"stiffness_relaxed": 0.3, "retardation_time": 1.0}}])
def test_errors_hold_and_work_is_stored_or_dissipated(run, case):
    rough, fine = (run(scene(**case, accuracy=accuracy)).summary for accuracy in (1e-3, 1e-4))
    assert rough["converged"] and fine["converged"]
    for key in ("max_tension", "energy_dissipated", "end_load", "end_displacement", "max_suction"):
        off = abs(rough[key] - fine[key])
        assert off <= rough[key + "_error"] + fine[key + "_error"], key
    # The error of what is dissipated is no less than what the balance misses.
    assert fine["energy_dissipated_error"] < 1e-4 * fine["energy_dissipated"]


@pytest.mark.long
@pytest.mark.parametrize("sigma, viscosity, relaxed, time, turn", [
    (0.3035, 0.0028473, 0.09927, 0.03709, -1.466), (0.2574, 0.0034987, 0.0935, 0.0538, -3.0)])
def test_a_thin_fluid_between_bodies_that_creep_is_followed(run, sigma, viscosity, relaxed, time,
                                                            turn):
    # What the mesh of the memory does not resolve makes loads jump by as much in any step, however
    # short.
    found = run(scene(sigma, viscosity, turn=turn, creep={"stiffness_relaxed": relaxed,
                                                          "retardation_time": time})).summary
    assert found["converged"]
    for key in ("max_tension", "energy_dissipated"):
        assert found[key + "_error"] < 2e-3 * found[key], key


@pytest.mark.slow
def test_finite_volumes_agree(run):
    sigma, strength = 0.1, 3.0
    start, turn, parts = 15.0, -1.0, 10
    expected, left = extrapolated(sigma, strength, start, turn, 1.0)
    found = run(scene(sigma, strength * sigma / 12, accuracy=1e-4))
    table = found.table("curve.csv")
    time, load = (np.array(table[name]) for name in ("time", "load"))
    way = start - turn
    ends = np.concatenate([way / parts * np.arange(1, parts + 1), way + way / parts * np.arange(
        1, parts + 1)])
    for end, value, off in zip(ends, expected, left):
        i = np.searchsorted(time, end - 1e-9)
        near = slice(max(0, i - 3), i + 1)
        here = np.polyval(np.polyfit(time[near] - end, load[near], 3), 0) / sigma
        # Where steps are first halved the difference of extrapolations tells the error to a factor.
        assert abs(here - value) <= 3 * off + 1e-5, end


@pytest.mark.slow
def test_little_fluid_or_slow_drives_leave_elastic_cycles(run):
    for sigma in (0.1, 2.0):
        path = run(lennard_jones(sigma, equilibrium_path={"h0_end": -1.0})).summary
        lost = path.get("energy_lost", 0.0)
        above = []
        for strength, velocity in ((1e-2, 1.0), (1e-3, 1.0), (1e-2, 0.1)):
            found = run(scene(sigma, strength * sigma / 12, velocity=velocity)).summary
            above.append(found["energy_dissipated"] - lost)
            assert found["max_tension"] == pytest.approx(path["max_tension"], rel=3e-3)
        # What is left falls with the velocity, whatever the viscosity: one number tells both.
        assert 0 < above[1] < 0.3 * above[0]
        assert above[2] == pytest.approx(above[1], rel=0.02, abs=1e-3)


@pytest.mark.parametrize("sigma, viscosity", [(0.7, 1e-30), (7.0, 1e-30)])
def test_a_fluid_that_no_step_resolves_leaves_elastic_jumps(run, sigma, viscosity):
    """Such bodies were lost at their first jump, which is shorter than the rounding of times."""
    path = run(lennard_jones(sigma, equilibrium_path={"h0_end": -1.0})).summary
    result = run(scene(sigma, viscosity, start=20.0, accuracy=1e-2))
    # A suction of 1e-17 of the law's pressure asks for no further passes, with which there were
    # 26,000 states in place of 500.
    assert result.cost["states"] < 2000
    found = result.summary
    for key, exact in (("max_tension", path["max_tension"]),
                       ("energy_dissipated", path["energy_lost"])):
        assert abs(found[key] - exact) <= found[key + "_error"] + 1e-3 * exact
        assert found[key + "_error"] < 0.02 * exact


def test_ways_within_the_errors_of_positions_are_none(run):
    """Rates were those of rounding, and so were suctions; or the steps did not end."""
    without, *found = (run(scene(0.7, 1e-2, accuracy=1e-2, dwell=dwell)).summary
                       for dwell in (0.0, 1e-40, 1e-8, 1e-5))
    for summary in found:
        for key in ("max_tension", "energy_dissipated", "max_suction"):
            assert summary[key] == pytest.approx(without[key], rel=1e-5)


@pytest.mark.slow
def test_viscoelastic_bodies_with_a_fluid_have_their_limits(run):
    """Without creep to speak of they are elastic, at once or at rest."""
    elastic = run(scene(0.1, 0.01)).summary
    hardly = run(scene(0.1, 0.01, creep={
        "stiffness_relaxed": 0.999999, "retardation_time": 1.0})).summary
    at_rest = run(scene(0.1, 0.01, creep={
        "stiffness_relaxed": 0.5, "retardation_time": 1e-5})).summary
    for key in ("max_tension", "energy_dissipated"):
        assert hardly[key] == pytest.approx(elastic[key], rel=2e-3)
    # The same bodies at rest, in units of twice the load.
    assert at_rest["max_tension"] != pytest.approx(elastic["max_tension"], rel=1e-2)
    twice = run(scene(0.2, 0.02)).summary
    assert at_rest["max_tension"] == pytest.approx(twice["max_tension"] / 2, rel=2e-3)
    creep = {"stiffness_relaxed": 0.8, "retardation_time": 1.0}
    wet = run(scene(0.1, 1e-6, creep=creep)).summary
    without = lennard_jones(0.1, drive={"velocity": 1.0, "z_start": 15.0, "z_turn": -1.0},
                            viscoelastic=creep, numerics={"accuracy": 1e-4})
    for key in ("max_tension", "energy_dissipated"):
        assert wet[key] == pytest.approx(run(without).summary[key], rel=2e-3)


def test_a_stiff_spring_is_none(run):
    driven = run(scene(0.1, 0.01)).summary
    stiff = run(scene(0.1, 0.01, stiffness=1e5)).summary
    for key in ("max_tension", "energy_dissipated"):
        assert stiff[key] == pytest.approx(driven[key], rel=2e-3)


@pytest.mark.slow
def test_only_viscosity_times_velocity_counts(run):
    one = run(scene(0.1, 0.01, velocity=1.0, accuracy=1e-4)).summary
    other = run(scene(0.1, 1e-4, velocity=100.0, accuracy=1e-4)).summary
    for key in ("max_tension", "energy_dissipated", "max_suction"):
        assert abs(one[key] - other[key]) <= one[key + "_error"] + other[key + "_error"]


@pytest.mark.parametrize("seed", range(8))
def test_no_cycle_gives_energy(run, seed):
    rng = np.random.default_rng(seed)
    sigma = 10 ** rng.uniform(-2, 0.5)
    case = {"start": 40.0, "turn": rng.uniform(-4, 3), "accuracy": 1e-2}
    if rng.random() < 0.5:
        case["slip"] = [10 ** rng.uniform(-1, 1)]
    if rng.random() < 0.4:
        case["stiffness"] = 10 ** rng.uniform(-1, 1)
    summary = run(scene(sigma, sigma * 10 ** rng.uniform(-4, 1), **case)).summary
    assert summary["converged"]
    assert summary["energy_dissipated"] > -summary["energy_dissipated_error"]
    # A soft spring may still hold the bodies at the end.
    assert not [text for text in several(summary.get("warnings", []))
                if "drive" in text and "largest at the end" not in text]


def test_cavities_are_warned_of(run):
    """A bead of 10 um in glycerol, pulled fast."""
    def bead(velocity):
        return deck(
            bodies={"radius": 1e-5, "stiffness": 1e10},
            force={"law": "lennard_jones", "surface_energy": 0.01, "z0": 3e-10},
            drive={"velocity": velocity, "z_start": 1e-6, "z_turn": 2e-8},
            fluid={"viscosity": 1.0}, numerics={"accuracy": 1e-3})
    for velocity, warned in ((1e-7, False), (2e-6, True)):
        summary = run(bead(velocity)).summary
        # 3 eta R v/h0^2, at the turn.
        assert summary["max_suction"] == pytest.approx(3e-5 * velocity / 4e-16, rel=2e-2)
        said = " ".join(several(summary.get("warnings", [])))
        assert ("cavitate" in said) is warned
        assert ("at h0 = 2." in said) is warned


def test_cases_of_a_sweep_have_velocities_and_viscosities(run):
    found = run(scene(0.1, 0.01, groups={"sweep": {
        "key": ["fluid.viscosity", "drive.velocity"], "from": [0.001, 0.5], "to": [0.01, 1.0],
        "count": [2, 2]}}))
    table = found.table("sweep.csv")
    lost = np.array(table["energy_dissipated"])
    assert (np.diff(lost[[0, 1, 3]]) > 0).all()
    assert (np.array(table["max_suction"]) > 0).all()


@pytest.mark.long
@pytest.mark.parametrize("accuracy", [1e-3, 1e-4])
def test_a_suction_that_is_not_determined_has_a_warning(run, accuracy):
    """Between creeping bodies in a thin fluid, details that the mesh of the memory does not resolve
    make the film jump at the last moment of contact. Rounding decides how large the suction is."""
    found = run(deck(
        bodies={"radius": 1e-6, "stiffness": 2.2e10},
        viscoelastic={"stiffness_relaxed": 2.2e9, "retardation_time": 1e-3},
        fluid={"viscosity": 1e-3},
        force={"law": "lennard_jones", "surface_energy": 0.05, "z0": 0.5e-9},
        drive={"velocity": 1e-6, "z_start": 5e-8, "z_turn": -2e-9},
        numerics={"accuracy": accuracy})).summary
    said = " ".join(several(found.get("warnings", [])))
    unknown = found["max_suction_error"] > found["max_suction"]
    assert ("max_suction is not determined" in said) is unknown
    assert not (unknown and "cavitate" in said)
    # The right suction.
    assert abs(found["max_suction"] - 6.697e4) < found["max_suction_error"] + 1e-3 * 6.697e4


def test_the_error_estimate_includes_the_suction(run):
    found = run(scene(0.01, 0.1)).summary
    assert found["max_suction_error"] <= found["error_estimate"] * found["max_suction"] * (1 + 1e-9)
    assert found["error_estimate"] < 1e-3


def test_a_short_dwell_does_not_lose_the_finer_passes(run):
    # In the first steps of a way the rounding of gaps is a rate that the load of the film shows.
    found = run(scene(0.1, 0.5, velocity=0.1, turn=7.5, dwell=1e-7, accuracy=1e-4)).summary
    assert found["converged"]
    assert found["error_estimate"] < 1e-4


def test_steps_do_not_follow_what_the_iteration_leaves(run):
    rows = of_way(run(scene(0.01, 0.1)).table("curve.csv"), "approach")
    steps = np.diff(rows["time"])
    # The relaxation of stiff bodies after the first step needs shorter steps, but not much.
    assert steps.min() > 0.1 * steps[0]


@pytest.mark.slow
def test_the_error_of_the_suction_holds_where_two_passes_agree_by_chance(run):
    case = {"sigma": 0.026, "viscosity": 4.6095e-4, "slip": [0.0, 0.5], "z_end": 30.0}
    rough, fine = (run(scene(**case, accuracy=accuracy)).summary for accuracy in (1e-3, 1e-4))
    off = abs(rough["max_suction"] - fine["max_suction"])
    assert off <= rough["max_suction_error"] + fine["max_suction_error"]
