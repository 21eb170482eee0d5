#!/usr/bin/env python3
"""Renew the pictures of docs/rates.md and print its tables: some minutes.

    .venv/bin/python tools/rates.py [drainage | prices]

With drainage: those of fluids alone; with prices: the cost of 1,000 steps, on an idle machine.
"""

import contextlib
import math
import os
import sys
import warnings

import numpy as np
import pages
import snapin
from matplotlib.figure import Figure
from snapin.command import as_command
from snapin.plots.drawing import COLOURS, arrow, plain

sys.path.append(str(pages.ROOT / "tools" / "bench"))

import gauge  # noqa: E402

DOCS = pages.ROOT / "docs"
# Instantaneous adhesion strength, and the velocities of the bell curve in law's lengths over the
# time of retardation.
SIGMA = 0.2
SPEEDS = [0.002 * 10 ** (k / 3) for k in range(25)]
RATIOS = [2.0, 5.0, 10.0]
# In these units R is as short as the range of the force.
warnings.simplefilter("ignore", snapin.SnapinWarning)


def driven(ratio, velocity, accuracy=1e-3, **drive):
    """The result of a cycle in units of z0, of the instantaneous stiffness and of the time of
    retardation."""
    deck = {
        "bodies": {"radius": 1.0, "stiffness": 1.0},
        "force": {"law": "lennard_jones", "work_of_adhesion": SIGMA, "z0": 1.0},
        "drive": {"velocity": velocity, "z_start": 20.0, "z_turn": -4.0, **drive},
        "numerics": {"accuracy": accuracy}}
    if ratio > 1:
        deck["viscoelastic"] = {"stiffness_relaxed": 1 / ratio, "retardation_time": 1.0}
    return snapin.run(deck)


@contextlib.contextmanager
def picture(name, panels=1, width=6.4):
    """The panels of a picture, which is written when they are drawn."""
    figure = Figure((width, 4.2), layout="constrained")
    axes = figure.subplots(1, panels)
    for one in np.atleast_1d(axes):
        plain(one)
    yield axes
    figure.savefig(DOCS / name, dpi=110)


def draw_bell():
    with picture("rates_bell.png") as axes:
        for ratio in RATIOS:
            tension = [driven(ratio, v).summary["max_tension"] / (1.5 * math.pi * SIGMA)
                       for v in SPEEDS]
            axes.semilogx(SPEEDS, tension, "o-", ms=3, label=f"$E_0/E_\\infty$ = {ratio:g}")
            print(ratio, " ".join(f"{t:.4f}" for t in tension))
        axes.set(xlabel=r"velocity $\times$ retardation time / $z_0$",
                 ylabel="pull-off force over that of JKR theory")
        axes.legend(frameon=False)


def draw_cycles():
    with picture("rates_cycles.png") as axes:
        for velocity in (0.002, 0.2, 2.0, 20.0, 200.0, 2.0e5):
            curve = driven(10.0, velocity).curve
            line, = axes.plot(curve["h0"], curve["load"] / (math.pi * SIGMA), lw=1.2,
                              label=f"{velocity:g}")
            _direct(axes, curve, line.get_color())
        axes.set(xlabel="approach $h_0/z_0$", ylabel="load $F/\\pi w R$", xlim=(-4.2, 12),
                 ylim=(-5, 6))
        axes.axhline(0, color="0.8", lw=0.8, zorder=0)
        axes.legend(frameon=False, title="velocity $\\times\\,\\tau/z_0$")


def _direct(axes, curve, colour):
    """Show with an arrow which way approach and retract go, in the middle of the picture."""
    for branch, place in (("approach", -2.5), ("retreat", 1.0)):
        rows = curve[curve["branch"] == branch]
        k = np.clip(np.argmin(abs(rows["h0"] - place)), 1, len(rows) - 2)
        ends = [(rows["h0"][i], rows["load"][i] / (math.pi * SIGMA)) for i in (k - 1, k + 1)]
        arrow(axes, *ends, colour, linewidth=0.1)


def off(found, exact):
    """The errors of the largest tension and of the dissipated energy, as cells."""
    return " | ".join(f"{abs(found.summary[key] / exact.summary[key] - 1):.1e}"
                      for key in ("max_tension", "energy_dissipated"))


def print_orders():
    exact = driven(4.0, 8.0, 1e-6)
    for parts in (50, 100, 200, 400, 800, 1600):
        found = driven(4.0, 8.0, 1e-6, time_step=24 / 8.0 / parts)
        print(f"| {2 * parts} | {off(found, exact)} |")


def print_prices():
    """Print the cost of 1,000 steps of bodies with an instantaneous stiffness ten times the
    relaxed one, in G: the least of several runs."""
    unit = gauge.Gauge(os.environ | {"OMP_NUM_THREADS": "1"})
    for sigma, start, step in ((0.2, 20.0, 0.006), (8.7, 40.0, 0.011)):
        deck = {
            "bodies": {"radius": 1.0, "stiffness": 1.0},
            "force": {"law": "lennard_jones", "work_of_adhesion": sigma / 10, "z0": 1.0},
            "drive": {"velocity": 8.0, "z_start": start, "z_turn": -4.0, "time_step": step},
            "viscoelastic": {"stiffness_relaxed": 0.1, "retardation_time": 1.0},
            "numerics": {"accuracy": 1e-3}}
        prices = []
        for _ in range(7):
            seconds = unit.pieces((400,), ("dgesv",))[0]["dgesv"]
            found = snapin.run(deck)
            steps = found.summary["time_steps"]
            prices.append(1000 * found.cost["solve_seconds"] / seconds / steps)
        print(f"| {sigma} | {steps} | {found.cost['nodes']} | {min(prices):.0f} |")


# A bead of 10 um and a flat in a viscous liquid, SI units.
BEAD = {
    "bodies": {"radius": 1e-5, "stiffness": 7e10},
    "force": {"law": "lennard_jones", "work_of_adhesion": 5e-3, "z0": 3e-10}}
VISCOSITY, VELOCITY = 1e-2, 2e-5


def drained(slip, accuracy=1e-3):
    """The result of a cycle of the bead; slip: length on both walls [m]."""
    deck = BEAD | {
        "fluid": {"viscosity": VISCOSITY}, "numerics": {"accuracy": accuracy},
        "drive": {"velocity": VELOCITY, "z_start": 1e-6, "z_turn": -5e-9}}
    if slip:
        deck["fluid"]["slip_length"] = slip
    return snapin.run(deck)


def draw_drainage():
    """Draw load against separation with and without slip, and the results of Reynolds and
    Vinogradova."""
    h = np.logspace(-9.2, -6, 201)
    with picture("rates_drainage.png", 2, 9.6) as (left, right):
        for slip, colour in zip((0, 5e-9, 20e-9, 100e-9), COLOURS):
            curve = drained(slip).curve
            approach, retreat = (curve[curve["branch"] == way] for way in ("approach", "retreat"))
            name = f"b = {slip * 1e9:g} nm" if slip else "no slip"
            inward = approach[1:][np.logical_and.accumulate(approach["load"][1:] > 0)]
            left.loglog(inward["h_centre"] * 1e9, inward["load"] * 1e9, color=colour, label=name)
            film = 6 * math.pi * VISCOSITY * 1e-10 * VELOCITY / h
            if slip:
                film *= h / (3 * slip) * ((1 + h / (6 * slip)) * np.log1p(6 * slip / h) - 1)
            left.loglog(h * 1e9, film * 1e9, ":", color=colour)
            right.plot(approach["h0"] * 1e9, approach["load"] * 1e9, color=colour, lw=1)
            right.plot(retreat["h0"] * 1e9, retreat["load"] * 1e9, color=colour, lw=2)
        left.set(xlabel="separation on the axis [nm]", ylabel="load on approach [nN]",
                 xlim=(0.5, 1e3), ylim=(0.1, 300))
        right.set(xlabel="approach $h_0$ [nm]", ylabel="load [nN]", xlim=(-1, 10),
                  ylim=(-1500, 300))
        left.plot([], [], "k:", label="rigid bodies")
        left.legend(frameon=False)
        for width, way in ((1, "approach"), (2, "retract")):
            right.plot([], [], "k-", lw=width, label=way)
        right.legend(frameon=False)


def print_drained():
    """Print the cost of the accuracy of a drive with a fluid. The errors of the finest run, with
    which the others are compared, are its estimates."""
    exact = drained(0, 1e-4)
    keys = ("max_tension", "energy_dissipated")
    estimated = " | ".join(
        f"{exact.summary[key + '_error'] / exact.summary[key]:.1e}" for key in keys)
    for accuracy in (1e-2, 1e-3, 1e-4):
        found = exact if accuracy == 1e-4 else drained(0, accuracy)
        errors = estimated if found is exact else off(found, exact)
        print(f"| {accuracy:g} | {found.summary['time_steps']} | {errors} | "
              f"{found.cost['nodes']} | {found.cost['factorisations']} | "
              f"{found.cost['solve_seconds']:.2g} |")


def main():
    if sys.argv[1:] == ["prices"]:
        print_prices()
        return
    if sys.argv[1:] != ["drainage"]:
        draw_cycles()
        print_orders()
        draw_bell()
    draw_drainage()
    print_drained()


if __name__ == "__main__":
    sys.exit(as_command(main)())
