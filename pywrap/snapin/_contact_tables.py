"""The contact law's tables at one Tabor parameter: polynomials on the panels of a path.

tools/law/law_tables.py makes the tables and explains their coordinates. Gaps are in z0, contact
radii in sqrt(R z0), loads in pi w R, and energies in pi w R z0.
"""

import functools
import json
import pathlib
from typing import NamedTuple, Optional

import numpy as np
from numpy.polynomial import chebyshev, polynomial

from ._polynomials import composed, folded, local, powers, series, solved

# JKR theory's units of h0 and contact radius, with K = 4 E*/3: (pi^2 w^2 R/K^2)^(1/3) is GAP mu z0,
# and (pi w R^2/K)^(1/3) is SPREAD sigma^(1/3) sqrt(R z0), sigma = mu^(3/2)/2.
GAP = (9*np.pi**2/16)**(1/3)
SPREAD = (1.5*np.pi)**(1/3)
ROOT6 = np.sqrt(6)
DEEP_PANELS = 8
# JKR theory over the root q of the contact radius: displacement, load and their integral.
JKR_GAP = np.array([0, -2*ROOT6/3, 0, 0, 1])
JKR_LOAD = np.array([0, 0, 0, -ROOT6, 0, 0, 1])
JKR_ENERGY = polynomial.polyint(polynomial.polymul(JKR_LOAD, polynomial.polyder(JKR_GAP)))


@functools.cache
def coefficients():
    """Return the coefficients of the Lennard-Jones law 9-3: nested lists of whole numbers."""
    return json.loads(pathlib.Path(__file__).with_name("contact_law.json").read_text())


class Panel(NamedTuple):
    """Polynomials of xi from -1 (far) to 1 (near); `squared`: radius^2. `energy` is None in panels
    from the tables: it is the integral along the path."""

    gap: np.ndarray
    load: np.ndarray
    radius: np.ndarray
    squared: bool
    energy: Optional[np.ndarray] = None


def tabor_of(log_mu):
    """Return Tabor's parameter, infinite where its logarithm is beyond what can be computed."""
    return float(np.exp(log_mu)) if abs(log_mu) < 50 else np.inf


def jkr_units(log_mu):
    """Return JKR theory's units of h0 [z0] and contact radius [sqrt(R z0)]."""
    return GAP*tabor_of(log_mu), SPREAD*np.exp(log_mu/2)/2**(1/3)


def near_panels(table, log_mu):
    """Return the panels outside contact and near it, how many are outside, and the energy between
    the two where unstable states are left out."""
    jkr_gap, jkr_radius = jkr_units(log_mu)
    log_sigma = 1.5*log_mu - np.log(2)
    held = min(log_mu, np.log(table["largest"]))
    beyond = np.exp(held - log_mu)
    for near in table["near"]:
        value = np.exp(log_sigma) if near["variable"] == "sigma" else held
        if value <= near["high"]:
            break
    at = local(value, near["low"], near["high"])
    scale = np.exp(near["exponent"]*log_sigma)
    stretch = beyond**(-1.5*near["exponent"])
    panels = []
    edges = near["outside_edges"]
    for low, high, (gap, load) in reversed(list(zip(edges, edges[1:], near["outside"]))):
        base = composed([near["offset"], 0, scale], (low + high)/2, (low - high)/2)
        panels.append(Panel(
            polynomial.polysub(base, stretch*powers(folded(gap, at), -1)),
            stretch**-table["power"]*powers(folded(load, at), -1), np.zeros(1), False))
    edges = near["contact_edges"]
    for low, high, (gap, load) in zip(edges, edges[1:], near["contact"]):
        middle, half = (low + high)/2, (high - low)/2
        gap, load = powers(folded(gap, at)), powers(folded(load, at))
        if near["whole"]:
            spread = 1 + (0 if near["variable"] == "sigma" else jkr_gap)
            radius = spread*np.array([middle, half])
        else:
            gap[0] -= table["rest"]
            gap, load = beyond*gap, beyond**2*load
            gap[0] += table["rest"]
            gap = polynomial.polysub(gap, jkr_gap*composed(JKR_GAP, middle, half))
            load = polynomial.polyadd(load, composed(JKR_LOAD, middle, half))
            radius = jkr_radius*composed([0, 0, 1], middle, half)
        panels.append(Panel(gap, load, radius, near["whole"]))
    between = folded(near["energy"], at)[0]*(1 + jkr_gap) if near["energy"] else 0.0
    return panels, len(near["outside"]), between


def deep_panels(table, log_mu, last):
    """Return the last panel near contact, cut where deep contact begins, the panels from there on,
    and the root of JKR theory's contact radius at their end."""
    jkr_gap, jkr_radius = jkr_units(log_mu)
    least, largest = np.log(table["least"]), np.log(table["largest"])
    held, at = np.clip(log_mu, least, largest), max(log_mu, least)
    beyond = min(np.exp(held - log_mu), 1.0)
    deep = next(deep for deep in table["deep"]
                if held <= deep["high"] or deep is table["deep"][-1])
    tiles = [[folded(one, local(held, deep["low"], deep["high"])) for one in tile]
             for tile in deep["tiles"]]
    # For parameters below the least one gap and radius deviate as for that.
    unit = SPREAD*np.exp(at/2)/2**(1/3)
    ratio = jkr_radius/unit
    node = chebyshev.chebpts1(table["order"])
    start, found = _jkr_root(table["join_load"]), []
    for low in start*2.0**np.arange(DEEP_PANELS):
        root = low*(1.5 + 0.5*node)
        length = 2*np.log(root)
        held_length = np.minimum(length, table["deep_edges"][-1])
        tile = np.searchsorted(table["deep_edges"][1:-1], held_length)
        gap, radius = np.empty(len(node)), np.empty(len(node))
        for index, (gaps, radii) in enumerate(tiles):
            here = tile == index
            x = local(held_length[here], *table["deep_edges"][index:index + 2])
            gap[here] = chebyshev.chebval(x, gaps)
            radius[here] = chebyshev.chebval(x, radii)
        pressure = np.log(unit/np.pi) - 1.5*at + np.log(2) + length
        gap = _wall(table, pressure) + gap*beyond*np.exp(held_length - length)
        plain = unit*root**2
        radius = plain + radius*beyond
        if ratio < 1:
            radius = np.sqrt(radius**2 - (1 - ratio**2)*plain**2)
        found.append(Panel(
            polynomial.polysub(powers(series(gap)), jkr_gap*composed(JKR_GAP, 1.5*low, 0.5*low)),
            composed(JKR_LOAD, 1.5*low, 0.5*low), powers(series(radius)), False))
    end = solved(-last.load, -table["join_load"], -1, 1)
    cut = [composed(one, (end - 1)/2, (end + 1)/2) for one in last[:3]]
    last = last._replace(gap=cut[0], load=cut[1], radius=cut[2])
    shift = polynomial.polyval(1, last.gap) - polynomial.polyval(-1, found[0].gap)
    for panel in found:
        panel.gap[0] += shift
    return [last, *found], start*2.0**DEEP_PANELS


def _wall(table, pressure):
    """Return the mean gap of a wall under the pressures of Hertz, the largest by logarithm."""
    low, high = table["wall_low"], table["wall_high"]
    terms = np.array(table["wall"]["rows"][0])*table["wall"]["unit"]
    gap = chebyshev.chebval(local(np.clip(pressure, low, high), low, high), terms)
    rest = table["rest"]
    return np.where(pressure < low, rest + (gap - rest)*np.exp(np.minimum(pressure - low, 0)), gap)


def _jkr_root(load):
    """Return the root of JKR theory's larger contact radius under a load."""
    return ((ROOT6 + np.sqrt(6 + 4*load))/2)**(1/3)
