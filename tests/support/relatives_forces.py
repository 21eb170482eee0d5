"""Random relatives of decks with noisy tables, steps of attraction, criterion (28) and creeping
bodies that start drawn out, judged by closed forms and the independent path of `reference`.

Each function draws a deck, runs it and returns its verdict.
"""

import math

import numpy as np
from support.decks_in_units import run_deck
from support.reference import Path
from support.relatives import Judged, is_told, numbers_verdict
from support.scenes import UNIT, deck, lennard_jones, read_groups, read_table, several
from support.states import EDGE, pressure, slope, solve
from support.study_cycles import logarithmic

SECONDS = 15
# Relative accuracy of closed forms that are solved here on a grid of the contact radius.
CLOSED = 1e-6
# A bulge that matters less than so many accuracies is not worth a warning.
BULGE = 3


def results_of(job, text):
    """Summary, warnings, status, standard error and folder of a run."""
    status, stderr, folder = run_deck(job.folder, "deck", text, SECONDS)
    if folder is None or not (folder / "summary.nml").exists():
        return {}, [], -1 if status is None else status, stderr, folder
    summary = read_groups(folder / "summary.nml")["summary"]
    return summary, several(summary.get("warnings", [])), status, stderr, folder


def noisy_table(job):
    """Lennard-Jones pressures with noise in each point: work of adhesion and pull-off."""
    rng, noise = job.rng, np.random.default_rng(job.number)
    sigma = float(f"{logarithmic(rng, 0.05, 20):.5g}")
    points, last = int(rng.uniform(40, 300)), rng.uniform(15, 60)
    relative = logarithmic(rng, 1e-5, 2e-2)
    gap = np.geomspace(0.55, last, points)
    values = sigma * pressure(gap) * (1 + relative * noise.standard_normal(points))
    job.folder.mkdir(parents=True, exist_ok=True)
    np.savetxt(job.folder / "table.csv", np.column_stack([gap, values]), "%.12e")
    text = f"sigma {sigma:g}, {points} points to {last:.3g}, noise {relative:.1e}"
    summary, warnings, status, stderr, _ = results_of(job, deck(
        bodies=UNIT, tabulated={"file": "table.csv", "tail_exponent": 3},
        equilibrium_path={"h0_end": -2.0}))
    told = is_told(warnings, status)
    if "max_tension" not in summary:
        return Judged.lost(job, text, told, stderr)
    right = {"max_tension": -Path(sigma, -0.5).pull_off.load * sigma, "surface_energy": sigma}
    by_table = summary["table_error"]
    off = [(key, abs(summary[key] - value),
            by_table * value + summary.get(f"{key}_error", 0.0))
           for key, value in right.items()]
    return numbers_verdict(job, text, told, off)


def creep(job):
    """A fast drive of creeping bodies: the largest tension is that of elastic bodies, unless they
    have kept the bulge with which they start."""
    rng = job.rng
    sigma = float(f"{logarithmic(rng, 0.05, 5):.5g}")
    relaxed = float(f"{logarithmic(rng, 0.02, 0.5):.3g}")
    reach = 3 + 3.5 * (sigma / relaxed) ** (2 / 3)
    start, turn = round(reach * rng.uniform(0.9, 4), 3), -round(rng.uniform(1, 6), 3)
    accuracy = float(f"{logarithmic(rng, 1e-5, 1e-3):.1g}")
    text = f"sigma {sigma:g}, relaxed {relaxed:g}, {start:g} to {turn:g}, accuracy {accuracy:g}"
    summary, warnings, status, stderr, _ = results_of(job, lennard_jones(
        sigma, viscoelastic={"stiffness_relaxed": relaxed, "retardation_time": 1.0},
        drive={"velocity": 1e9, "z_start": start, "z_turn": turn},
        numerics={"accuracy": accuracy}))
    told = is_told(warnings, status)
    if "max_tension" not in summary:
        return Judged.lost(job, text, told, stderr)
    right = -Path(sigma, -0.5).pull_off.load * sigma
    return numbers_verdict(job, text, told, [
        ("max_tension", abs(summary["max_tension"] - right),
         summary["max_tension_error"] + BULGE * accuracy * right)])


def maugis_pull_off(strength):
    """The largest tension over pi w R of Maugis' theory at its parameter."""
    m = 1 + np.geomspace(1e-9, 1e6, 400_001)
    root = np.sqrt(m**2 - 1)
    angle = np.arctan(root)
    # (lambda a^2/2) A + (4 lambda^2 a/3) B = 1.
    a_part = strength / 2 * (root + (m**2 - 2) * angle)
    b_part = 4 * strength**2 / 3 * (root * angle - m + 1)
    a = (-b_part + np.sqrt(b_part**2 + 4 * a_part)) / (2 * a_part)
    return -(a**3 - strength * a**2 * (root + m**2 * angle)).min()


def regime(job):
    """Errors of the theories for steps of attraction outside a repulsion, by closed forms; Maugis'
    own law is recognised."""
    rng = job.rng
    strength = float(f"{logarithmic(rng, 0.05, 3):.4g}")
    width, wall = rng.uniform(0.01, 0.03), rng.uniform(0.01, 0.04)
    stress = (strength / 2) ** 1.5 * math.sqrt(4 * math.pi / 9)
    groups = {
        "dugdale": {"stress": stress, "range": 1.0, "smoothing": width},
        "born": {"hamaker": 6 * math.pi * wall**3 * stress * rng.uniform(0.3, 3), "z0": wall},
    }
    if rng.random() < 0.4:
        angle = rng.uniform(0, 1.2)
        groups["capillary"] = {"surface_tension": stress / (2 * math.cos(angle)),
                               "kelvin_radius": 1 / (2 * math.cos(angle)),
                               "contact_angle": angle, "smoothing": width}
        del groups["dugdale"]
    text = f"lambda {strength:g}, smoothing {width:.3f}, wall {wall:.3f}, {list(groups)}"
    summary, warnings, status, stderr, _ = results_of(job, deck(
        bodies=UNIT, **groups, regime={}, numerics={"accuracy": 1e-5},
        equilibrium_path={"h0_end": -1.5 - 2 * strength}))
    told = is_told(warnings, status)
    if "regime_error_maugis" not in summary:
        return Judged.lost(job, text, told, stderr)
    work = summary["surface_energy"]
    unit = math.pi * work / summary["max_tension"]
    forms = {"jkr": 1.5, "dmt": 2.0, "maugis": maugis_pull_off(summary["regime_maugis_lambda"])}
    off = [(f"regime_error_{name}", abs(summary[f"regime_error_{name}"][0] - (form * unit - 1)),
            max(summary[f"regime_error_{name}_error"][0], CLOSED)) for name, form in forms.items()]
    off.append(("surface_energy", abs(work - stress * (1 - wall)), stress * 3 * wall))
    judged = numbers_verdict(job, text, told, off)
    if not told and summary["regime_recommended"] != "maugis":
        judged.silent.append(f"{summary['regime_recommended']} is recommended for Maugis' law")
    return judged


def criterion_28(job):
    """The paper's local criterion, the largest |2 u p'/p| where the attraction falls, from states
    of the reference."""
    rng = job.rng
    sigma = float(f"{logarithmic(rng, 0.1, 3):.5g}")
    last = round(rng.uniform(-4, -0.5), 3)
    accuracy = float(f"{logarithmic(rng, 1e-7, 1e-4):.1g}")
    places = [round(rng.uniform(last, 1.0), 3) for _ in range(2)]
    summary, warnings, status, stderr, folder = results_of(job, lennard_jones(
        sigma, stability={}, equilibrium_path={"h0_end": last}, profiles={"h0": places},
        numerics={"accuracy": accuracy}))
    text = f"sigma {sigma:g} to {last:g}, accuracy {accuracy:g}, profiles {places}"
    told = is_told(warnings, status)
    if "criterion_28_error" not in summary:
        return Judged.lost(job, text, told, stderr)
    rows, shapes = read_table(folder / "curve.csv"), read_table(folder / "profiles.csv")
    off = []
    for h0 in places:
        for state in np.unique(shapes["state"][shapes["h0"] == h0]):
            mine = (shapes["h0"] == h0) & (shapes["state"] == state)
            exact = criterion_of(sigma, h0, shapes["r"][mine], shapes["separation"][mine])
            near = abs(rows["criterion_28"][rows["h0"] == h0] - exact)
            off.append(("criterion_28", near.min(), summary["criterion_28_error"]))
    return numbers_verdict(job, text, told, off)


def criterion_of(sigma, h0, r, gap):
    """The criterion at h0, in the state whose profile is near this one."""
    path = Path(sigma, h0 - 0.3)
    axis = np.interp(0.0, r, gap)
    places = path.roots(lambda piece: np.polynomial.chebyshev.chebsub(piece.h0, [h0]))
    point = min(map(path.point, places), key=lambda one: abs(one.axis - axis))
    piece = path.pieces[min(int(point.place), len(path.pieces) - 1)]
    state = piece.last
    mesh = state.mesh
    if mesh.centre:
        radius = np.interp(EDGE, gap, r)
        # The radius of the edge that belongs to this h0, by secants.
        tried = []
        for step in range(8):
            r_nodes = radius * mesh.x
            begun = state.at(r_nodes) if step == 0 else tried[-1][1].gap
            found = solve(sigma, mesh, radius, np.log(begun), h0)
            tried.append((radius, found))
            if abs(found.h0 - h0) < 1e-10:
                break
            if len(tried) == 1:
                radius *= 1 + 1e-4
            else:
                (a, one), (b, two) = tried[-2:]
                radius = b - (two.h0 - h0) * (b - a) / (two.h0 - one.h0)
        state = tried[-1][1]
    else:
        state = solve(sigma, mesh, point.axis, np.log(state.gap), h0)
    r = np.sort(np.concatenate([[0.0], state.c * mesh.x]))
    r = (r[:-1, None] + np.diff(r)[:, None] * np.linspace(0, 1, 12)).ravel()
    r = r[r < 0.9 * state.c * mesh.x[-1]]
    h = state.at(np.maximum(r, 1e-12))
    deformation = h0 + r**2 / 2 - h
    falls = (pressure(h) < 0) & (slope(h) > 0)
    return abs(deformation * slope(h) / pressure(h))[falls].max()


KINDS = {function.__name__: function for function in (noisy_table, creep, regime, criterion_28)}


def examine(job):
    """The verdict on one relative."""
    return KINDS[job.kind](job)
