"""Hayes, Keer, Herrmann and Mockros (1972): a flat punch on a bonded layer."""

import functools

import curves
import spheres
import style

POISSON = (0.3, 0.35, 0.4, 0.45, 0.5)
_COLORS = (style.BLACK, style.BLUE, style.GREEN, style.ORANGE, style.VERMILION)


@functools.lru_cache(maxsize=None)
def curve(nu):
    """Return a/t and kappa of a sphere of radius 1 on a layer of thickness 1."""
    found = spheres.solved(
        bodies={"radius": 1.0, "rigid": True},
        layer={"thickness": 1.0, "young": 1 - nu**2, "poisson": nu, "partner": "rigid"},
        force={"law": "lennard_jones", "surface_energy": 1e-6, "z0": 1e-3},
        classical={"h0_start": 0.001, "h0_end": -3.0, "count": 6001,
                   "theories": ["hertz"]}).classical
    delta, load, radius = (found[name] for name in ("displacement", "load", "contact_radius"))
    step = delta[1] - delta[0]
    stiffness = (8 * (load[3:-1] - load[1:-3]) - (load[4:] - load[:-4])) / (12 * step)
    return radius[2:-2], stiffness / (2 * radius[2:-2])


def kappa(nu, ratio):
    """Return kappa at a ratio a/t, by a cubic through the four nearest."""
    return float(curves.cubic(ratio, *curve(nu))[0])


def numbers(_):
    return {"half": kappa(0.5, 1.0), "third": kappa(0.3, 1.0)}


def draw(_):
    page, panel = style.figure(height=3.8)
    for nu, color in zip(POISSON, _COLORS):
        radius, values = curve(nu)
        shown = (radius > 0.1) & (radius < 2)
        panel.semilogy(radius[shown], values[shown], color=color, label=f"$\\nu$ = {nu:g}")
    panel.set_yticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    style.label(panel, "$a/t$", "$\\kappa = F/(2E'a\\delta)$", xlim=(0, 2), ylim=(1, 11))
    panel.legend(loc="upper left")
    return page
