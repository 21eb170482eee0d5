"""Hayes, Keer, Herrmann and Mockros (1972): a flat punch on a bonded layer."""

import functools
import warnings

import numpy as np
import snapin
import spheres  # noqa: F401 (before anything loads OpenMP)
import style
from published import Comparison

DECKS = ()
TITLE = "Hayes et al. 1972: a flat punch on a bonded layer"
CAPTION = """W. C. Hayes, L. M. Keer, G. Herrmann and L. F. Mockros, J. Biomech. **5**, 541 (1972), tabulated the
stiffness of a layer of thickness t on a rigid base under a flat punch of radius a, as κ(a/t, ν) = F/(2 E' a δ) with
E' = E/(1 − ν²), which tests of cartilage are read with. Only the abstract was read; the tables are for who has
them at hand.

κ is found here without a punch: the stiffness dF/dδ of a sphere on the layer is that of a flat
punch of the same contact radius. Of thin layers it grows as (a/t)³ for ν = 0.5, as
a/t for any other ν. At a = t the layer is {half:.2f} times as stiff as a half-space for ν = 0.5, {third:.2f} times for ν = 0.3."""

POISSON = (0.3, 0.35, 0.4, 0.45, 0.5)
RATIOS = (0.2, 0.4, 0.6, 0.8, 1.0, 1.5, 2.0)
_COLORS = (style.BLACK, style.BLUE, style.GREEN, style.ORANGE, style.VERMILION)


@functools.lru_cache(maxsize=None)
def curve(nu):
    """Return a/t and kappa of a sphere of radius 1 on a layer of thickness 1."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", snapin.SnapinWarning)
        found = snapin.run({
            "bodies": {"radius": 1.0, "rigid": True},
            "layer": {"thickness": 1.0, "young": 1 - nu**2, "poisson": nu, "partner": "rigid"},
            "force": {"law": "lennard_jones", "surface_energy": 1e-6, "z0": 1e-3},
            "classical": {"h0_start": 0.001, "h0_end": -3.0, "count": 6001,
                          "theories": ["hertz"]}}).classical
    delta, load, radius = (found[name] for name in ("displacement", "load", "contact_radius"))
    step = delta[1] - delta[0]
    stiffness = (8 * (load[3:-1] - load[1:-3]) - (load[4:] - load[:-4])) / (12 * step)
    return radius[2:-2], stiffness / (2 * radius[2:-2])


def kappa(nu, ratio):
    """Return kappa at a ratio a/t, by a cubic through the four nearest."""
    radius, values = curve(nu)
    i = int(np.clip(np.searchsorted(radius, ratio) - 2, 0, radius.size - 4))
    return float(np.polyval(np.polyfit(radius[i:i + 4] - ratio, values[i:i + 4], 3), 0.0))


def numbers(_):
    """Return what the caption quotes."""
    return {"half": kappa(0.5, 1.0), "third": kappa(0.3, 1.0)}


def draw(_):
    """Return the picture."""
    page, panel = style.figure(height=3.8)
    for nu, color in zip(POISSON, _COLORS):
        radius, values = curve(nu)
        shown = (radius > 0.1) & (radius < 2)
        panel.semilogy(radius[shown], values[shown], color=color, label=f"$\\nu$ = {nu:g}")
    panel.set_xlim(0, 2)
    panel.set_ylim(1, 11)
    panel.set_yticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    style.label(panel, "$a/t$", "$\\kappa = F/(2E'a\\delta)$")
    panel.legend(loc="upper left")
    return page


def rows(_):
    """Return kappa over radius and Poisson's ratio."""
    return [Comparison(f"kappa at nu = {nu:g}, a/t = {ratio:g}", "not read", None, kappa(nu, ratio),
                       "", "Hayes et al. (1972), their table of kappa for flat punches")
            for nu in POISSON for ratio in RATIOS]
