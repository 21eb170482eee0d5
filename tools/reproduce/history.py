"""What makes pull-off depend on the penetration: the grid and the stopping rule, taken apart."""

import draws
import numpy as np
import penetrations
import style
from matplotlib.ticker import FuncFormatter, NullFormatter
from published import Row

# Letter of Fig. 10, sigma as the paper gives it, turning points [m].
_CASES = (("a", "1.7", (0.0, -2e-9, -5e-9)),
          ("b", "4.4", (0.0, -2e-9, -5e-9)),
          ("c", "8.7", (1e-9, -2e-9, -4e-9, -10e-9)))
_RULES = ("paper", "residual")
# The deck of each case, those that take longest first.
_SWEEPS = {(letter, rule): f"history_{letter}_{rule}"
           for letter, *_ in reversed(_CASES) for rule in _RULES}
DECKS = (*_SWEEPS.values(),
         *(f"fig10{letter}_converged" for letter, *_ in _CASES))
TITLE = "The memory of the penetration: the grid, or the stopping rule?"
CAPTION = """Largest tension of the cycles of Fig. 10 against the spacing of a uniform grid, in
widths of the neck, σ = 1.7 (a), 4.4 (b), 8.7 (c). Above, the paper's rule stops the iteration;
below, the equations are solved on the same grids. One line a turning point; above, the median of
{runs_a} runs ({runs_c} in (c)) that differ in A's twelfth digit, with a bar from the least to the
largest; dashed, the converged value; left of the thin line the grid resolves the neck.

**The grid** inflates the pull-off. With the equations solved, and for σ = 1.7, 4.4 and 8.7, it is
{coarse_a:.2f}, {coarse_b:.2f} and {coarse_c:.2f} of JKR's where nodes are 4 neck widths apart
(deepest penetration), {one_a:.2f}, {one_b:.2f} and {one_c:.2f} at 1 width, and {fine_a:.4f},
{fine_b:.4f} and {fine_c:.4f} at {finest_a:.2g}, {finest_b:.2g} and {finest_c:.2g}; converged it is {true_a:.4f}, {true_b:.4f} and
**{true_c:.4f}**. Pinning makes a memory too, but only on grids much coarser than the neck: pull-off
from different penetrations differs by up to {spread_coarse:.0f} % at 4 widths, {spread_two} %
at 2, {spread_one} % at 1 and {spread_fine} % on grids that resolve the neck.

**The stopping rule** gives another pull-off on every grid. On the finest
({rule_finest_a:.2g}, {rule_finest_b:.2g} and {rule_finest_c:.2g} widths), where it stops
{left_a}, {left_b} and {left_c} z0 from equilibrium at worst, pull-off is {rule_a} of JKR's for
σ = 1.7 and {rule_b} for 4.4 (from h0 = {turns_b} nm), {rule_c} for 8.7 (from {turns_c} nm). In
{grows} of {cases} cycles the deepest penetration gives a larger one than the shallowest,
{factor:.1f} times as large in the median. That is the rule's scatter and no memory of the bodies: each value is the
largest of many states stopped anywhere, of which a deeper retreat has more, and from run to run
one and the same value differs by a factor of {scatter:.1f} in the median, {scatter_most:.0f} at
most. Refining the grid does not help; solving the equations does.

**Shown:** a pull-off that is too large comes out of this model by pinning the contact edge and by
stopping early, and one that differs with the penetration by pinning on grids much coarser than the
neck and, as scatter, by stopping early. All are gone when both are: the model has one contact
branch and no memory of the penetration. **Not shown:** what the authors' own program did. That depends on
how its mixing ratio adapted, on its steps of h0 (here 0.25 nm) and on how its kernel was integrated, which the
paper does not say. A ratio kept from one h0 to the next, instead of started anew as here, stops early without
scatter and gives the paper's loops: [readings of the mixing rule](#fig-10s-smooth-loops-readings-of-the-mixing-rule)."""

_COLORS = (style.ORANGE, style.GREEN, style.PURPLE, style.BLUE)
_MARKERS = ("s", "^", "D", "o")
# Spacing over the width of the neck up to which the program calls a grid resolved.
_RESOLVED = 0.2


def joined(runs, letter, rule):
    """Return the columns of a case's sweep, finest grid first."""
    return _sorted(runs[_SWEEPS[letter, rule]].sweep)


def stopped(runs, letter):
    """Return the same of all runs of the sweep by the paper's rule."""
    return [_sorted(results.sweep) for results in runs.draws(_SWEEPS[letter, "paper"])]


def _sorted(columns):
    order = np.argsort(columns["spacing_over_neck"])
    return {name: values[order] for name, values in columns.items()}


def ratios(columns, turns):
    """Return spacings over the neck and pull-offs over JKR's, a row a turning point."""
    pulls = [columns[f"unload_max_tension_{number}"] / columns["jkr_pull_off"]
             for number in range(1, len(turns) + 1)]
    return columns["spacing_over_neck"], np.array(pulls)


def by_rule(runs, letter, turns):
    """Return spacings over the neck and pull-offs by the paper's rule: run, turning point, grid."""
    pairs = [ratios(columns, turns) for columns in stopped(runs, letter)]
    return pairs[0][0], np.array([pulls for _, pulls in pairs])


def _true(runs, letter):
    return penetrations.of_cycle(runs[f"fig10{letter}_converged"])[-1].ratio


def _at(spacing, wanted):
    return int(np.argmin(abs(np.log(spacing / wanted))))


def _percent(pulls):
    """Return how much pull-off differs between turning points [%], over the spacings given."""
    return 100 * float(np.max(np.ptp(pulls, axis=0) / np.min(pulls, axis=0)))


def _shown(percent):
    """Return per cent as text; of what is left to rounding no digit means anything."""
    return f"{percent:.1g}" if percent >= 1e-7 else "less than 1e-7"


def _listed(values, digits=2):
    return ", ".join(f"{value:.{digits}f}" for value in values)


def _named(turns):
    return ", ".join(f"{turn * 1e9:.0f}" for turn in turns)


def numbers(runs):
    """Return what the caption quotes."""
    found = {"turns_b": _named(_CASES[1][2]), "turns_c": _named(_CASES[2][2])}
    coarse, two, one, fine, factors, scatter = [], [], [], [], [], []
    for letter, _, turns in _CASES:
        spacing, pulls = ratios(joined(runs, letter, "residual"), turns)
        for spread, width in ((coarse, 4), (two, 2), (one, 1)):
            spread.append(_percent(pulls[:, [_at(spacing, width)]]))
        fine.append(_percent(pulls[:, spacing < 1.05 * _RESOLVED]))
        stopped_spacing, pulls_by_rule = by_rule(runs, letter, turns)
        factors.extend(np.ravel(pulls_by_rule[:, -1] / pulls_by_rule[:, 0]))
        scatter.extend(np.ravel(pulls_by_rule.max(axis=0) / pulls_by_rule.min(axis=0)))
        found.update({
            f"coarse_{letter}": pulls[-1, _at(spacing, 4)],
            f"one_{letter}": pulls[-1, _at(spacing, 1)],
            f"fine_{letter}": pulls[-1, 0], f"finest_{letter}": spacing[0],
            f"true_{letter}": _true(runs, letter),
            f"rule_finest_{letter}": stopped_spacing[0],
            f"left_{letter}": draws.ranged([columns["worst_residual"][0]
                                            for columns in stopped(runs, letter)], 0),
            f"runs_{letter}": len(pulls_by_rule),
            f"rule_{letter}": draws.several(pulls_by_rule[:, :, 0].T)})
    return {**found, "spread_coarse": max(coarse), "spread_two": _shown(max(two)),
            "spread_one": _shown(max(one)), "spread_fine": _shown(max(fine)),
            "grows": sum(factor > 1 for factor in factors),
            "cases": len(factors), "factor": np.median(factors), "scatter": np.median(scatter),
            "scatter_most": max(scatter)}


def draw(runs):
    """Return the picture: the paper's rule above, the equations solved below."""
    page, panels = style.figure(2, 3, height=5.6, sharex=True, sharey="row")
    for row, rule in zip(panels, _RULES):
        for panel, (letter, sigma, turns) in zip(row, _CASES):
            spacing, pulls = (by_rule(runs, letter, turns) if rule == "paper"
                              else ratios(joined(runs, letter, rule), turns))
            panel.axhline(_true(runs, letter), color=style.BLACK, dashes=(5, 2), linewidth=1.2,
                          zorder=6, label="converged")
            panel.axvline(_RESOLVED, color=style.GREY, linewidth=0.6, zorder=0)
            # The larger markers below: solved, the lines lie on each other.
            for number, turn in enumerate(turns):
                if rule == "paper":
                    # Side by side, so that the bars do not hide each other.
                    at = spacing * 1.06 ** (number - 1)
                    pull = np.median(pulls[:, number], axis=0)
                    panel.vlines(at, pulls[:, number].min(axis=0), pulls[:, number].max(axis=0),
                                 color=_COLORS[number], linewidth=1.1)
                else:
                    at, pull = spacing, pulls[number]
                panel.plot(at, pull, color=_COLORS[number], marker=_MARKERS[number],
                           markersize=4 if rule == "paper" else 6.5 - 1.3 * number,
                           linewidth=0.7 if rule == "paper" else 2.6 - 0.6 * number,
                           zorder=2 + number,
                           label=f"from {_named([turn])} nm".replace("-", "\N{MINUS SIGN}"))
            panel.set_xscale("log")
            panel.set_yscale("log")
            plain = FuncFormatter(lambda value, _: f"{value:g}")
            panel.set_xticks([0.1, 0.3, 1, 3])
            panel.set_yticks([0.5, 1, 2, 5] if rule == "paper" else [1, 1.5, 2, 3, 4])
            for axis in (panel.xaxis, panel.yaxis):
                axis.set_major_formatter(plain)
                axis.set_minor_formatter(NullFormatter())
            panel.set_xlim(0.085, 5)
            panel.set_ylim(*((0.3, 12) if rule == "paper" else (0.95, 4.6)))
            if rule == "paper":
                style.letter(panel, letter)
                panel.set_title(f"$\\sigma$ = {sigma}")
            else:
                panel.legend(loc="upper left", handlelength=1.4, labelspacing=0.3,
                             borderaxespad=0.1, frameon=True, facecolor="white",
                             edgecolor="none", framealpha=1)
    panels[0, 0].set_ylabel("pull-off / JKR,\npaper's stopping rule")
    panels[1, 0].set_ylabel("pull-off / JKR,\nequations solved")
    panels[1, 1].set_xlabel("distance between nodes / width of the neck")
    return page


def rows(runs):
    """Return pull-off against penetration on the finest grids, by the rule and solved."""
    found = []
    words = {"a": "independent of penetration, within the noise", "b": "depends on penetration",
             "c": "greater for larger penetrations"}
    for letter, sigma, turns in _CASES:
        spacing, solved = ratios(joined(runs, letter, "residual"), turns)
        stopped_spacing, pulls = by_rule(runs, letter, turns)
        left = [columns["worst_residual"][0] for columns in stopped(runs, letter)]
        # Side by side: the finest grid that both were computed on.
        both, one = _at(spacing, stopped_spacing[0]), _at(spacing, 1)
        found.append(Row(
            f"Fig. 10({letter}) with nodes {spacing[both]:.2g} neck widths apart, largest tension "
            f"over JKR, sigma = {sigma}", words[letter],
            draws.several(pulls[:, :, 0].T),
            _listed(solved[:, both], 4), "",
            f"unloading from h0 = {_named(turns)} nm. Computed: the paper's rule, {len(pulls)} "
            f"runs, {draws.ranged(left, 0)} z0 from equilibrium; converged: the same grid, "
            f"solved. Nodes {spacing[one]:.2g} neck width apart: "
            f"{draws.several(pulls[:, :, _at(stopped_spacing, 1)].T)} and "
            f"{_listed(solved[:, one], 4)}"))
    return found
