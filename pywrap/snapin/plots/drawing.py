"""Procedures that all figures share."""

import argparse
import dataclasses
import pathlib
import sys
import textwrap
from collections.abc import Callable

import numpy as np
from matplotlib.figure import Figure

from ..command import as_command
from ..results import ResultFiles, ResultsError

# Okabe and Ito's colours, which colour-blind readers can distinguish.
BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, VERMILION, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#999999"
#: The order in which curves of one kind have them.
COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK)

_PREFIXES = ((1e-12, "p"), (1e-9, "n"), (1e-6, "µ"), (1e-3, "m"), (1.0, ""), (1e3, "k"),
             (1e6, "M"), (1e9, "G"))

# What numbers raise that no run has written, in NumPy and Matplotlib.
_OF_DAMAGE = ArithmeticError, AttributeError, LookupError, RuntimeError, TypeError, ValueError

# Cosine of the largest angle between two steps that is drawn as a bend; a larger one is a corner.
_GENTLE = 0.5
# Characters of a title on an inch.
_A_LINE = 10
# A cubic with slopes at its ends up to this multiple of the slope of its chord is monotonic.
_STEEPEST = 3


def title_of(folder, summary):
    """Return the deck's title, or the folder's name, with marks of results that are not good."""
    title = summary.get("title") or pathlib.Path(folder).resolve().name
    if not summary.get("converged", True):
        title += " [not converged]"
    if not summary.get("resolved", True):
        title += " [under-resolved]"
    return title


def entitle(figure, title):
    """Write the title above a figure, as the deck has it, in lines that are no wider."""
    width = int(_A_LINE * figure.get_figwidth())
    figure.suptitle("\n".join(textwrap.wrap(title, width)), parse_math=False)


def smooth(points):
    """Return a curve through `points` (n, 2), in order, with more points in gentle bends.

    The curve is a cubic over the length of the polygon, with the tangents of parabolas through
    three neighbours. Sharp corners of the polygon stay, since there the states are too few.
    """
    points = np.asarray(points, float)
    if len(points) > 1:
        points = points[np.append(True, np.diff(points, axis=0).any(axis=1))]
    if len(points) < 3:
        return points
    extent = np.ptp(points, axis=0)
    chord = np.diff(points / np.where(extent > 0, extent, 1), axis=0)
    along = np.hypot(*chord.T)
    unit = chord / along[:, None]
    turn = np.append(np.append(1.0, (unit[1:] * unit[:-1]).sum(axis=1)), 1.0)
    slope = np.diff(points, axis=0) / along[:, None]
    weight = (along[1:] / (along[1:] + along[:-1]))[:, None]
    inner = weight * slope[:-1] + (1 - weight) * slope[1:]
    # Between steps of very different lengths a parabola overshoots its points.
    least = np.minimum(abs(slope[:-1]), abs(slope[1:]))
    bound = np.where(slope[:-1] * slope[1:] > 0, _STEEPEST * least, np.inf)
    inner = np.clip(inner, -bound, bound)
    ends = 2 * slope[[0, -1]] - inner[[0, -1]]
    ends = np.where(ends * slope[[0, -1]] > 0, ends, 0)
    tangent = np.vstack([ends[:1], inner, ends[1:]])
    t = np.linspace(0, 1, 12, endpoint=False)[:, None]
    curve = []
    for i, step in enumerate(along):
        if min(turn[i], turn[i + 1]) < _GENTLE:
            curve.append(points[i : i + 1])
            continue
        curve.append(
            (1 + 2 * t) * (1 - t) ** 2 * points[i]
            + t * (1 - t) ** 2 * step * tangent[i]
            + t**2 * (3 - 2 * t) * points[i + 1]
            + t**2 * (t - 1) * step * tangent[i + 1]
        )
    return np.vstack([*curve, points[-1:]])


def scale(values, unit):
    """Return the factor and the name of the prefixed unit in which `values` [unit] are short."""
    values = np.abs(np.asarray(values, float))
    largest = values[np.isfinite(values)].max(initial=0.0)
    factor, prefix = 1.0, ""
    if largest > 0:
        # 0.8 nm is easier to read than 800 pm.
        below = [pair for pair in _PREFIXES if pair[0] <= 2 * largest]
        factor, prefix = below[-1] if below else _PREFIXES[0]
    return factor, prefix + unit


def dress(axes, x_name, y_name):
    """Give a panel the names of its axes, a line at zero, and a frame on two sides."""
    axes.set_xlabel(x_name)
    axes.set_ylabel(y_name)
    axes.axhline(0, color=GREY, linewidth=0.6, zorder=0)
    axes.spines[["top", "right"]].set_visible(False)


def plain(axes):
    """Give a panel of any curves the colours of all pictures, and a frame on two sides."""
    axes.set_prop_cycle(color=COLOURS)
    axes.spines[["top", "right"]].set_visible(False)


def arrow(panel, tail, head, color, linewidth=1.2, style="-|>", dashes="-", scale=12, zorder=8):
    """Draw an arrow between two points of the data, such as a jump."""
    return panel.annotate("", head, tail, annotation_clip=False, zorder=zorder, arrowprops={
        "arrowstyle": style, "color": color, "linewidth": linewidth, "linestyle": dashes,
        "shrinkA": 0, "shrinkB": 0, "mutation_scale": scale})


def states_of(rows):
    """Return the rows of each state of profiles."""
    return [{x: values[rows["state"] == state] for x, values in rows.items()}
            for state in np.unique(rows["state"])]


@dataclasses.dataclass(frozen=True)
class Picture:
    """A kind of picture of results: its name, `draw(folder, **options)`, the name of its file, what
    it shows, whether `ResultFiles` allow it, and a procedure that adds its options to a parser."""

    name: str
    draw: Callable[..., Figure]
    file: str
    shows: str
    allowed: Callable[[ResultFiles], bool]
    add_options: Callable[[argparse.ArgumentParser], object] = lambda parser: None

    @as_command
    def main(self, arguments=None, program=None):
        """Carry out a command: arguments, the picture, the exit status."""
        parser = argparse.ArgumentParser(prog=program, description=self.shows)
        parser.add_argument("folder", help="folder of results, such as results/first")
        parser.add_argument("-o", "--output",
                            help=f"picture to write; default: FOLDER/{self.file}")
        add_dots(parser)
        self.add_options(parser)
        options = vars(parser.parse_args(arguments))
        folder, dpi, output = (options.pop(name) for name in ("folder", "dpi", "output"))
        try:
            print(self.write(folder, output, dpi, **options))
        except (ResultsError, OSError) as problem:
            sys.exit(f"{parser.prog}: {problem}")
        except _OF_DAMAGE as problem:
            sys.exit(f"{parser.prog}: the results in {folder} cannot be drawn ({problem}); if they "
                     "are damaged, run the deck again")

    def write(self, folder, output, dpi, **options):
        """Draw the picture of a folder into a file, by default in the folder; return its path."""
        output = pathlib.Path(output or pathlib.Path(folder) / self.file)
        save(self.draw(folder, **options), output, dpi)
        return output


def has_fits(files):
    """Return whether `ResultFiles` have the sweep of a fit over measured curves."""
    names = (line for line in files.texts.get("sweep.csv", "").split("\n")
             if not line.startswith("#"))
    return "verdict" in next(names, "").split(",")


def add_dots(parser):
    """Add the option for the number of dots of a picture."""
    parser.add_argument("--dpi", type=float, default=150, help="dots per inch; default: 150")


def save(figure, output, dpi):
    """Write a picture; a format or a number of dots that Matplotlib refuses is a ResultsError."""
    try:
        figure.savefig(output, dpi=dpi)
    except ValueError as problem:
        raise ResultsError(f"{output}: {problem}") from problem
