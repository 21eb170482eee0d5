#!/usr/bin/env python3
"""Renew the table of indentation of layers, the pictures and the table of prices in
docs/records/costs.md: two minutes.

    .venv/bin/python tools/layers.py            # all of them
    .venv/bin/python tools/layers.py --prices   # the table of prices alone, on an idle machine
"""

import dataclasses
import math
import sys
import tempfile
import warnings

import numpy as np
import pages
import snapin
from matplotlib.figure import Figure
from snapin.plots.drawing import plain

sys.path.append(str(pages.ROOT / "tools" / "bench"))

import problems  # noqa: E402
from program import Program  # noqa: E402

TABLE = pages.ROOT / "docs" / "layers_indentation.csv"
PICTURE = pages.ROOT / "docs" / "layers.png"
FILMS = pages.ROOT / "docs" / "layers_films.png"
PAGE = pages.ROOT / "docs" / "records" / "costs.md"
CHI = [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0]
# Films on a rigid base by their Poisson's ratio; incompressible films on bases of Poisson's ratio
# 0.5 by the ratio of moduli, film over base.
BONDED = [0.3, 0.4, 0.45, 0.49, 0.5]
ON_ELASTIC = [0.01, 0.1, 0.5, 2.0, 10.0, 100.0]
SIGMA = 25.0
# Cases of the table of prices: coats by their modulus over that of the base (0: rigid) and their
# Poisson's ratio, their thickness over the radius of the contact without load, sigma; the accuracy.
COATS = {"film on a rigid base, ν = 0.5": (0, 0.5), "the same, ν = 0.3": (0, 0.3),
         "five times as soft as its base": (0.2, 0.3), "five times as stiff": (5, 0.3),
         "100 times as soft": (0.01, 0.3), "100 times as stiff": (100, 0.3)}
THIN, STRENGTHS, ACCURACY = (3, 1, 0.3, 0.1, 0.03), (0.1, 1, 25), 1e-6
ROUNDS = 7
# In these units R is as short as the range of the force.
warnings.simplefilter("ignore", snapin.SnapinWarning)


def film(thickness, nu, ratio, sigma, h0_end, **groups):
    """The summary of theory for a film under a rigid body, in units of z0 and of its modulus;
    ratio: of the shear moduli, film over base, 0 for a rigid base; groups: further groups of the
    deck."""
    young = (1 - nu**2) / 2
    bodies = {"radius": 1.0, "rigid": True}
    if ratio:
        bodies = {"radius": 1.0, "young": young / (1 + nu) * 1.5 / ratio, "poisson": 0.5}
    return snapin.run({
        "bodies": bodies,
        "layer": {"thickness": thickness, "young": young, "poisson": nu, "partner": "rigid"},
        "force": {"law": "lennard_jones", "work_of_adhesion": sigma, "z0": 1.0},
        "classical": {"h0_start": 20.0, "h0_end": h0_end, "count": 2}, **groups}).summary


def over_hertz(chi, nu, ratio):
    """Load over Hertz's load at the same indentation, chi = sqrt(R delta)/thickness."""
    found = film(1 / chi, nu, ratio, 1.0, -1.0)
    return found["effective_modulus"] / found["top_modulus"]


def dimitriadis(chi):
    """For incompressible films: Dimitriadis et al. (2002), equation (12)."""
    return 1 + 1.133 * chi + 1.283 * chi**2 + 0.769 * chi**3 + 0.0975 * chi**4


def garcia(chi):
    """For incompressible films: Garcia and Garcia (2018)."""
    return 1 + 1.133 * chi + 1.497 * chi**2 + 1.469 * chi**3 + 0.755 * chi**4


def write_table():
    """Write the table and return it, one column for each film."""
    columns = {"chi": CHI}
    columns |= {f"rigid_base_nu_{nu:g}": [over_hertz(chi, nu, 0) for chi in CHI] for nu in BONDED}
    columns["dimitriadis_2002_nu_0.5"] = [dimitriadis(chi) for chi in CHI]
    columns["garcia_2018_nu_0.5"] = [garcia(chi) for chi in CHI]
    columns |= {f"film_over_base_{ratio:g}": [over_hertz(chi, 0.5, ratio) for chi in CHI]
                for ratio in ON_ELASTIC}
    header = (
        "# Load over Hertz's load on a half-space of the film, at the same indentation delta.",
        "# chi = sqrt(R delta)/thickness; sphere rigid, parabola; film bonded, no adhesion.",
        "# film_over_base: ratio of moduli, film and base incompressible.", ",".join(columns))
    np.savetxt(TABLE, np.transpose([*columns.values()]), "%.6g", ",", header="\n".join(header),
               comments="")
    return columns


def draw(table):
    """Draw load over Hertz's load, and pull-off against thickness."""
    figure = Figure((10, 4.2), layout="constrained")
    (left, right) = figure.subplots(1, 2)
    plain(left)
    plain(right)
    for nu in BONDED:
        left.plot(CHI, table[f"rigid_base_nu_{nu:g}"], label=f"rigid base, ν = {nu:g}")
    left.plot(CHI, table["dimitriadis_2002_nu_0.5"], "k--", label="Dimitriadis 2002, ν = 0.5")
    left.plot(CHI, table["garcia_2018_nu_0.5"], "k:", label="García 2018, ν = 0.5")
    left.set(xlabel="√(Rδ)/t, with indentation δ and thickness t",
             ylabel="load over Hertz's of the film", yscale="log", xlim=(0, 2), ylim=(1, 40))
    left.legend(fontsize=9, frameon=False)
    contact = (9 * math.pi * SIGMA) ** (1 / 3)
    parts = np.geomspace(0.1, 10, 40)
    for ratio in (0, 0.2, 1, 5):
        pull = [film(part * contact, 0.5, ratio, SIGMA, -2.0)["jkr_pull_off"]
                / (math.pi * SIGMA) for part in parts]
        label = f"film {ratio:g} times its base" if ratio else "rigid base"
        line, = right.plot(parts, pull, label=label)
        solved = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0]
        found = [film(part * contact, 0.5, ratio, SIGMA, -2.0, equilibrium_path={"h0_end": -2.0})
                 for part in solved]
        right.plot(solved, [one["max_tension"] / (math.pi * SIGMA) for one in found], "o",
                   color=line.get_color(), markersize=4)
    right.set(xlabel="thickness over contact radius without load, t/a₀",
              ylabel="pull-off force over πwR", xscale="log", ylim=(0.9, 2.5))
    right.legend(fontsize=9, frameon=False, title="modulus, ν = 0.5")
    figure.savefig(PICTURE, dpi=90)


def draw_films():
    """Draw load against indentation for rubber films on glass under a sphere of glass: the solved
    paths, and JKR theory of layers."""
    figure = Figure((6.4, 4.4), layout="constrained")
    axes = figure.subplots()
    plain(axes)
    axes.axhline(0, color="0.8", linewidth=0.8)
    for micrometres, thickness in ((0.5, 0.5e-6), (1, 1e-6), (2, 2e-6), (5, 5e-6), (None, None)):
        glass, rubber = {"young": 70e9, "poisson": 0.2}, {"young": 3e6, "poisson": 0.49}
        bodies = {"radius": 100e-6, **glass}
        layer = {"layer": {"thickness": thickness, **rubber}}
        if not thickness:
            bodies |= {key: [rubber[key], glass[key]] for key in glass}
            layer = {}
        run = snapin.run({
            "bodies": bodies, **layer,
            "force": {"law": "lennard_jones", "work_of_adhesion": 0.02, "z0": 20e-9},
            "equilibrium_path": {"h0_end": -200e-9}, "classical": {"h0_start": 400e-9}})
        label = f"film of {micrometres:g} µm" if thickness else "rubber half-space"
        path = run.curve[run.curve["branch"] == "path"]
        line, = axes.plot(-path["h0"] * 1e9, path["load"] * 1e6, label=label)
        theory = run.classical[run.classical["theory"] == ("jkr_layered" if thickness else "jkr")]
        # Bodies of the theory touch at the equilibrium separation.
        touching = run.summary["rest_gap"] - theory["displacement"]
        axes.plot(-touching * 1e9, theory["load"] * 1e6, "--", color=line.get_color(), linewidth=1)
    axes.set(xlabel="indentation $-h_0$ [nm]", ylabel="load [µN]", xlim=(-310, 205), ylim=(-16, 40))
    axes.legend(fontsize=9, frameon=False, title="dashed: JKR theory of layers")
    figure.savefig(FILMS, dpi=90)


def coated(sigma, thin=None, ratio=0, nu=0.0):
    """The deck for the path of a coat, or of a half-space; thin: thickness over radius without
    load."""
    half = problems.lennard_jones(sigma)
    numerics = f"accuracy = {ACCURACY}"
    if thin is None:
        return half.path(numerics)
    # E* of the half-space's deck is half of the stiffness there: here one body is elastic.
    young = problems.stiffness_of(sigma) / 2 * (1 - nu**2)
    thickness = thin * math.sqrt(problems.RADIUS * half.length) * (9 * math.pi * sigma) ** (1 / 3)
    base = f"young = {young / ratio!r}, poisson = {nu}" if ratio else "rigid = .true."
    bodies = (f"&bodies radius = {problems.RADIUS}, {base} /\n&layer thickness = {thickness!r}, "
              f"young = {young!r}, poisson = {nu}, partner = 'rigid' /")
    physics = half.physics.replace(half.physics.split("\n")[0], bodies)
    return dataclasses.replace(half, physics=physics).path(numerics)


def write_prices():
    """Measure the cost of paths, and write its table into the page: processor time of a run
    without the start over that of the half-space, and estimates above the requested accuracy."""
    decks = {(sigma, None, None): coated(sigma) for sigma in STRENGTHS}
    decks |= {(sigma, thin, coat): coated(sigma, thin, *COATS[coat])
              for sigma in STRENGTHS for thin in THIN for coat in COATS}
    with tempfile.TemporaryDirectory() as folder:
        program = Program(pages.ROOT / "build", folder)
        runs = program.best_of(ROUNDS, decks)
        start = program.start_up() * program.gauge.unit()

    def cell(sigma, thin, coat):
        run = runs[sigma, thin, coat]
        if run.failure:
            return "–"
        price = (run.seconds - start) / (runs[sigma, None, None].seconds - start)
        return f"{price:.1f}" + (f" ({run.estimate:.0e})" if run.estimate > ACCURACY else "")

    rows = [[str(thin), str(sigma), *(cell(sigma, thin, coat) for coat in COATS)]
            for thin in THIN for sigma in STRENGTHS]
    pages.insert(PAGE, "prices", pages.table(["t/a₀", "σ", *COATS], rows),
                 "tools/layers.py --prices")


if __name__ == "__main__":
    write_prices()
    if "--prices" not in sys.argv[1:]:
        draw(write_table())
        draw_films()
