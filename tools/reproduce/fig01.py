"""Fig. 1: displacement against load, with and without adhesion."""

import style
from published import Row

DECKS = ("fig01_hertz_exponential", "fig01_lennard_jones")
TITLE = "Fig. 1: displacement against load, repulsion and adhesion"
CAPTION = """Largest tension {tension:.1f} µN."""


def numbers(runs):
    """Return what the caption quotes."""
    return {"tension": runs["fig01_lennard_jones"].summary["max_tension"] * 1e6}


def draw(runs):
    """Return the picture."""
    page, panel = style.figure()
    curve = runs["fig01_lennard_jones"].branch("loading")
    panel.plot(curve["load"] * 1e6, curve["displacement"] * 1e9, "^", color=style.VERMILION)
    style.label(panel, "load [µN]", "central displacement [nm]", "xy")
    return page


def rows(runs):
    """Return the statements of the paper."""
    return [Row("Fig. 1, largest tension", 59, None,
                runs["fig01_lennard_jones"].summary["max_tension"] * 1e6, "µN")]
