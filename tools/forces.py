#!/usr/bin/env python3
"""Renew the pictures of docs/forces.md: a minute.

    .venv/bin/python tools/forces.py [NAME ...]
"""

import pathlib
import sys
import tempfile

import f90nml
import pages
import snapin
from snapin.command import as_command
from snapin.plots.law_and_curve import draw_law_and_curve

EXAMPLES = pages.ROOT / "inputs" / "examples"
PICTURES = pages.ROOT / "docs" / "forces"
# Decks with a picture; the picture of a deck with one force shows other forces beside it.
NAMES = ("van_der_waals", "lennard_jones_10_4", "morse", "dlvo", "double_layer", "hydration",
         "hydrophobic", "steric", "structural", "depletion", "capillary", "dugdale", "tabulated")
# Pictures whose name differs from that of their deck.
DECKS = {"double_layer": "dlvo"}
DPI = 90
# If a term is too small to be visible beside the whole law: limits of the first panel and, for the
# secondary minimum of DLVO forces, of the second.
VIEWS = {"steric": [{"xlim": (9.3, 12), "ylim": (-5, 12)}],
         "double_layer": [{"xlim": (0.3, 8), "ylim": (-0.15, 0.6)},
                          {"xlim": (15, 60), "ylim": (-0.012, 0.024)}]}


def variants(name, keys):
    """Return the curves beside the law of a deck, or None for the deck's own terms."""
    if name == "double_layer":
        return {model: {name: {**keys[name], "model": model}}
                for model in ("superposition", "linear", "nonlinear")}
    if name == "steric":
        models = {"alexander_de_gennes": "Alexander, de Gennes",
                  "milner_witten_cates": "Milner et al."}
        return {label: {name: {**keys[name], "model": model}} for model, label in models.items()}
    if name == "lennard_jones_10_4":
        return {f"{n:g}, {m:g}": {"force": {**keys["force"], "exponents": [n, m]}}
                for n, m in ((9.0, 3.0), (12.0, 6.0))}
    if name == "morse":
        law = {"law": "lennard_jones", "exponents": [9.0, 3.0]}
        same = {key: keys["morse"][key] for key in ("work_of_adhesion", "z0")}
        return {"Lennard-Jones of the same energy": {"force": {**law, **same}}}
    return None


def main():
    PICTURES.mkdir(exist_ok=True)
    for name in sys.argv[1:] or NAMES:
        deck = EXAMPLES / f"{DECKS.get(name, name)}.nml"
        picture = PICTURES / f"{name}.png"
        with tempfile.TemporaryDirectory() as folder:
            snapin.run(deck, out=pathlib.Path(folder))
            figure = draw_law_and_curve(
                deck, folder, variants(name, f90nml.read(deck).todict()),
                "energy" if name == "dlvo" else "pressure")
            for panel, limits in zip(figure.axes, VIEWS.get(name, [])):
                panel.set(**limits)
                # Arrows are not clipped at the frame.
                for arrow in list(panel.texts):
                    arrow.remove()
            figure.savefig(picture, dpi=DPI)
        print(picture.relative_to(pages.ROOT))


if __name__ == "__main__":
    sys.exit(as_command(main)())
