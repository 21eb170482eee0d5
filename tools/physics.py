#!/usr/bin/env python3
"""The drawing of docs/physics.md: the geometry of a contact, and its force curve with a spring.

    .venv/bin/python tools/physics.py [FILE]

Both panels are a calculation of the program: soft spheres just before they separate.
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "pywrap"))
import snapin  # noqa: E402

RADIUS, SPRING, H0 = 1e-6, 40.0, 9e-9
SCENE = {
    "bodies": {"radius": RADIUS, "reduced_modulus": 3e8},
    "force": {"law": "lennard_jones", "work_of_adhesion": 0.05, "z0": 1e-9},
    "equilibrium_path": {"h0_start": 1.6e-8, "h0_end": -1.2e-8},
    "profiles": {"h0": [2.5e-9]}, "device": {"spring_constant": SPRING},
}
BLUE, ORANGE, GREY = "#0072b2", "#d55e00", "0.45"
ARROW = {"arrowstyle": "<->", "shrinkA": 0, "shrinkB": 0, "lw": 0.9}
PUSH = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "lw": 1.6, "color": "black"}


def geometry(axes, result):
    """Draw the surfaces of both bodies in tension, and the undeformed ones dashed."""
    rows = result.profiles
    # Several equilibria share this h0; that in contact has the largest pressure.
    states = {state: rows[rows["state"] == state] for state in np.unique(rows["state"])}
    rows = max((part for part in states.values() if part["stable"][0] > 0),
               key=lambda part: part["pressure"].max())
    r, gap, h0 = 1e9*rows["r"], 1e9*rows["separation"], 1e9*rows["h0"][0]
    inside = r < 150
    r, gap = r[inside], gap[inside]
    ground = h0 + r**2/(2e9*RADIUS)
    lower = (ground - gap)/2
    across = np.concatenate([-r[::-1], r])
    both = [np.concatenate([side[::-1], side]) for side in (lower, lower + gap, ground)]
    axes.fill_between(across, both[0], -16, color="0.87", lw=0)
    axes.fill_between(across, both[1], 30, color="0.87", lw=0)
    for side in both[:2]:
        axes.plot(across, side, color=BLUE, lw=1.8)
    for side in (0*across, both[2]):
        axes.plot(across, side, "--", color=GREY, lw=1)
    axes.annotate("", (0, 0), (0, h0), arrowprops=ARROW)
    axes.annotate("$h_0$", (3, h0/2), va="center")
    axes.annotate("$h(r)$", (r[-1]*0.72 + 4, 3.2), va="center")
    k = np.searchsorted(r, 0.72*r[-1])
    axes.annotate("", (r[k], lower[k]), (r[k], lower[k] + gap[k]), arrowprops=ARROW)
    axes.annotate("sphere of radius $R$:\nundeformed surface at $h_0 + r^2/2R$",
                  (-70, h0 + 70**2/(2e9*RADIUS)), (-128, 21), fontsize=8,
                  arrowprops={"arrowstyle": "-", "color": GREY, "lw": 0.8})
    axes.annotate("undeformed surface\nof the other body", (115, 0), (55, -11), fontsize=8,
                  arrowprops={"arrowstyle": "-", "color": GREY, "lw": 0.8})
    axes.annotate("", (0, 29), (0, 22), arrowprops=PUSH)
    axes.annotate("load $F < 0$: tension", (6, 25), fontsize=9)
    axes.set(xlim=(-r[-1], r[-1]), ylim=(-16, 30), xlabel="distance from the axis $r$ [nm]",
             ylabel="height [nm]")


def curve(axes, result):
    """Draw load against h0 with its jumps, and the line of a spring."""
    path = result.curve[result.curve["branch"] == "path"]
    h0, load = 1e9*path["h0"], 1e6*path["load"]
    axes.axhline(0, color=GREY, lw=0.8)
    axes.plot(h0, load, ":", color=BLUE, lw=1.4, label="unstable at prescribed $h_0$")
    axes.plot(h0, np.where(path["stable"] > 0, load, np.nan), color=BLUE, lw=2, label="stable")
    numbers = result.summary
    for key, text, at in (("jump_in", "snap-in", (0.2, -0.1)), ("jump_out", "snap-off", (6.3, -0.075))):
        x, y = 1e9*numbers[f"{key}_h0"], 1e6*numbers[f"{key}_load"]
        others = [float(v) for a, b, v in zip(h0[:-1], h0[1:], load[:-1]) if (a - x)*(b - x) <= 0]
        landing = min(others) if key == "jump_in" else max(others)
        axes.annotate("", (x, landing), (x, y), arrowprops={**PUSH, "color": ORANGE})
        axes.annotate(text, (x, y), at, color=ORANGE)
    low = load.argmin()
    axes.plot(h0[low], load[low], "o", color=BLUE)
    axes.annotate("pull-off force", (h0[low], load[low]), (-2.5, load[low] - 0.004))
    z, force = 1e9*numbers["device_jump_out_z"][0], 1e6*numbers["device_jump_out_load"][0]
    x = z + force*1e3/SPRING
    axes.plot([z, x], [0, force], color="black", lw=1)
    axes.plot(z, 0, "s", color="black", ms=5)
    axes.annotate("base of the spring, $z = h_0 - F/k$;\nhere the bodies snap off", (z, 0), (6.6, -0.215),
                  fontsize=8, arrowprops={"arrowstyle": "-", "lw": 0.8})
    axes.set(xlabel="approach $h_0$ [nm]", ylabel="load $F$ [µN]", xlim=(-9, 14.5),
             ylim=(1.15*load[low], 0.12))
    axes.legend(frameon=False, loc="upper center", fontsize=8)


def main(file=ROOT / "docs/physics.png"):
    result = snapin.run(SCENE)
    page, (left, right) = plt.subplots(1, 2, figsize=(10.5, 4.2), layout="constrained")
    geometry(left, result)
    curve(right, result)
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
    page.savefig(file, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
