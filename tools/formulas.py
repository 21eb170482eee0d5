#!/usr/bin/env python3
"""Renew the table and the picture of docs/formulas.md, errors of formulas in use: a minute.

    .venv/bin/python tools/formulas.py
"""

import functools
import sys
from typing import Callable, NamedTuple

import numpy as np
import pages

sys.path.append(str(pages.ROOT / "tools" / "reproduce"))

import spheres  # noqa: E402 (found through the line above)
import style  # noqa: E402
from others import ciavarella_2017, indentation_of_layers, wu_2010, zheng_yu_2007  # noqa: E402

PAGE = pages.ROOT / "docs" / "formulas.md"
PICTURE = pages.ROOT / "docs" / "formulas.png"
TABORS, JUMPING = spheres.spaced(0.01, 100, 65), spheres.spaced(0.7, 100, 40)
LOADED = 10.0
NAMES = {"dmt": "DMT", "jkr": "JKR", "maugis": "Maugis-Dugdale", "carpick": "Carpick et al.",
         "pietrement": "Piétrement and Troyon", "hertz": "Hertz"}


class Formula(NamedTuple):
    """A formula for a quantity; `error(x)` is its signed relative error, with `x` on `grid`."""

    quantity: str
    name: str
    error: Callable
    grid: tuple = TABORS
    symbol: str = "μ"


def _of_contact(theory, number, load):
    return lambda tabor: float(spheres.contact(tabor, load).errors[theory][number])


@functools.lru_cache(maxsize=None)
def _wu():
    """Return the factor of mu^(3/7) that fits at large mu."""
    return wu_2010.jump(1000.0)[0][0] / 1000.0 ** (3 / 7)


def _jump(name):
    def error(tabor):
        (h0, _, tension), (printed, _, force) = wu_2010.jump(tabor)
        found = {"(37)": printed, "power": _wu() * tabor ** (3 / 7)}
        return (force / tension if name == "tension" else found[name] / h0) - 1
    return error


def _loss(found):
    return lambda tabor: found(tabor) / ciavarella_2017._loss(tabor) - 1


def formulas():
    found = [Formula("pull-off", NAMES[name], _of_contact(name, 0, 0.0))
             for name in ("dmt", "jkr", "maugis", "carpick", "pietrement")]
    for load, title in ((0.0, "without load"), (LOADED, f"under {LOADED:g} πwR")):
        found += [Formula(f"contact radius {title}", NAMES[name], _of_contact(name, 1, load))
                  for name in ("hertz", "dmt", "jkr", "maugis", "carpick", "pietrement")
                  if load or name != "hertz"]
        found += [Formula(f"indentation {title}", NAMES[name], _of_contact(name, 2, load))
                  for name in ("hertz", "dmt", "jkr", "maugis", "pietrement")
                  if load or name != "hertz"]
    found += [
        Formula("h0 at snap-in", "Attard and Parker's (37)", _jump("(37)"), JUMPING),
        Formula("h0 at snap-in", f"{_wu():.4f} μ^(3/7) z0", _jump("power"), JUMPING),
        Formula("tension at snap-in", "(37)", _jump("tension"), JUMPING),
        Formula("tension at snap-off", "JKR, 5/6 πwR",
                lambda tabor: 5 / 6 / spheres.sphere(tabor).jump_out[1] - 1, JUMPING),
        Formula("energy lost in a cycle", "JKR, 7.0922 (R⁴w⁵/E\\*²)^(1/3)",
                _loss(lambda _: ciavarella_2017.jkr()), JUMPING[2:]),
        Formula("energy lost in a cycle", "the same − (4π/3) wR h0, h0 of the jump in",
                _loss(ciavarella_2017._solved), JUMPING[2:])]
    found += [Formula("pull-off of bodies f = B rⁿ", f"JKR, n = {n:g}",
                      lambda tabor, n=n: 1 / zheng_yu_2007.ratio(n, tabor) - 1,
                      zheng_yu_2007._MANY, "μn")
              for n in zheng_yu_2007.EXPONENTS if n != 2]
    chis = tuple(float(each) for each in np.arange(0.05, 2.001, 0.05))
    found += [Formula("load on a thin layer, ν = 0.5", name,
                      lambda chi, key=key: indentation_of_layers.error(key, chi) / 100, chis, "χ")
              for key, name in (("dimitriadis", "Dimitriadis et al."),
                                ("garcia", "García and García"))]
    return found


def good(errors, grid, symbol, within):
    """Return in words the range with errors within a bound: from the first good value to the
    last."""
    edges = np.flatnonzero(np.diff([False, *(abs(errors) <= within), False]))
    words = []
    for first, end in zip(edges[::2], edges[1::2]):
        low, high = _short(grid[first]), _short(grid[end - 1])
        if first == 0 and end == len(grid):
            return "everywhere"
        # A curve that only crosses zero has no such range.
        if end - first > 2:
            words.append(f"{symbol} ≤ {high}" if first == 0 else f"{symbol} ≥ {low}"
                         if end == len(grid) else f"{low} to {high}")
    return ", ".join(words) or "nowhere"


def _short(value):
    return f"{float(f'{value:.2g}'):g}"


def table(found):
    rows = []
    for one in found:
        errors = np.array([one.error(x) for x in one.grid])
        at = int(np.nanargmax(abs(errors)))
        rows.append((
            one.quantity, one.name,
            f"{_percent(errors[at])} at {one.symbol} = {_short(one.grid[at])}",
            f"{100 * np.median(abs(errors)):.2g} %",
            *(good(errors, one.grid, one.symbol, within) for within in (0.01, 0.05))))
    return pages.table(("quantity", "formula", "largest error", "typical", "within 1 %",
                        "within 5 %"), rows)


def _percent(error):
    shown = 100 * error
    return (f"{shown:+.1f} %" if abs(shown) < 100 else f"{shown:+.0f} %").replace("-", "−")


def draw(found):
    """Return the picture: errors of pull-off, radius and indentation against Tabor's parameter."""
    page, panels = style.figure(1, 3, height=3.9, width=9.6)
    colors = dict(zip(NAMES.values(), (style.ORANGE, style.GREEN, style.VERMILION, style.BLUE,
                                       style.PURPLE, style.SKY)))
    for panel, (quantity, title) in zip(panels, (
            ("pull-off", "pull-off"), ("contact radius without load", "contact radius, no load"),
            (f"indentation under {LOADED:g} πwR", f"indentation under {LOADED:g} $\\pi wR$"))):
        panel.axhspan(-1, 1, color=style.GREY, alpha=0.25, linewidth=0)
        for one in found:
            if one.quantity == quantity and one.name != NAMES["hertz"]:
                panel.semilogx(one.grid, [100 * one.error(x) for x in one.grid],
                               color=colors[one.name], label=one.name,
                               linestyle="--" if one.name in (NAMES["carpick"], NAMES["pietrement"])
                               else "-")
        panel.set_ylim(-30, 35)
        style.heading(panel, title)
        style.label(panel, "Tabor's parameter $\\mu$", zero_lines="y",
                    y="error [%]" if panel is panels[0] else "")
    style.legend(page, 5)
    return page


def main():
    found = formulas()
    pages.insert(PAGE, "formulas", table(found), "tools/formulas.py")
    style.save(draw(found), PICTURE)


if __name__ == "__main__":
    main()
