"""Puts pictures, captions and tables together: report.md and others.md."""

import draws
import published
from runs import path_name

_PAPER = """# The figures and numbers of Attard and Parker (1992), computed again

P. Attard and J. L. Parker, *Deformation and adhesion of elastic bodies in
contact*, Phys. Rev. A **46**, 7959 (1992): every figure drawn again from runs of snapin, and
every number of the text beside the one computed.

In the tables, **published** is what the paper prints. **Computed** is found with the paper's own
grid and stopping rule, where there is such a run: nodes 10–100 nm apart, mixing of at most 0.2,
stopped when the central displacement changes by less than 1e-4 nm. **Converged** is what the
equations give, with the error estimated in each run's summary. The same rows, all together, are
in [{table}]({table}).

What the paper's rule gives depends on rounding: the last digit decides where an iteration stops, so
that another processor or library gives other numbers. Decks on that rule are therefore run
{count} times (`history_c_paper`: {fewer}) with the Hamaker constant changed in its twelfth digit, and
numbers that differ are given as ranges: from the least to the largest of these runs.
"""

_OTHERS = """# What others have published, beside the converged answer

Formulas, theories and tables that are used in place of a solved contact, each against the solution
of the same equations by snapin, whose errors are below 1e-6 unless a row says otherwise. The rows,
all together, are in [{table}]({table}); [formulas](../formulas.md) says which formula may be used
where.

A row says what its published number is: **printed**, read in a print that was at hand; **formula**,
computed from a formula whose coefficients and where they are from stand in the row's source;
**theory**, exact in a limit; **not read**, where the print was not at hand and nothing is
published here on its behalf. Errors say by how much what was published is too large.

Spheres are parabolas of radius R. w is the work of adhesion, E\\* the composite modulus, z0 the
separation at rest of the Lennard-Jones law, μ = (R w²/(E\\*² z0³))^(1/3) Tabor's parameter and
λ = 1.157 μ Maugis', with the largest tension of that law. The converged radius of the contact is
where the tension is largest.
"""

_RUNNING = """./reproduce            # all of it, both reports
./reproduce {example}  # some of it
./reproduce --publish  # and copy it to docs/reproduction/"""


def of_paper(csv_name):
    """Return the beginning of the report on the source paper; `csv_name` is its table."""
    return _PAPER.format(table=csv_name, count=draws.COUNT,
                         fewer=len(draws.names("history_c_paper")))


def of_others(csv_name):
    """Return the beginning of the report on what others published."""
    return _OTHERS.format(table=csv_name)


def write(path, csv_name, chapters, runs, version, introduction):
    """Write a report to `path`, beside the file `csv_name` with its rows.

    `chapters` are dicts with name, title, picture, caption, rows and problem (None if all went
    well); `introduction` is a function of `csv_name`.
    """
    lines = [introduction(csv_name)]
    for chapter in chapters:
        lines.append(f"- [{chapter['title']}](#{_anchor(chapter['title'])})")
    lines.append("")
    for chapter in chapters:
        lines += _chapter(chapter)
    lines += _ending(chapters, runs, version)
    published.write_whole(path, "\n".join(lines) + "\n")


def _chapter(chapter):
    lines = [f"## {chapter['title']}", ""]
    if chapter["problem"]:
        return [*lines, f"**Failed:** {chapter['problem']}", ""]
    if chapter["picture"]:
        lines += [f"![{chapter['title']}]({chapter['name']}.png)", ""]
    return [*lines, chapter["caption"], "", *table(chapter["rows"])]


def table(rows):
    """Return rows as the lines of a Markdown table, with an empty line after it."""
    if not rows:
        return []
    columns = rows[0].COLUMNS
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    lines += ["| " + " | ".join(_cell(cell) for cell in row.cells()) + " |" for row in rows]
    return [*lines, ""]


def _cell(text):
    """Return text that Markdown leaves alone in a table."""
    for sign in "\\|*_<":
        text = text.replace(sign, "\\" + sign)
    return text


def _anchor(title):
    """Return the anchor that Markdown viewers make of a heading."""
    kept = (c for c in title.lower() if c.isalnum() or c in " -_")
    return "".join(kept).replace(" ", "-")


def _ending(chapters, runs, version):
    """Return how this was run: commands, versions, and the time of each deck."""
    decks = list(dict.fromkeys(deck for chapter in chapters for deck in chapter["decks"]))
    seconds = sum(runs.record(deck).get("seconds", 0) for deck in runs.with_draws(decks))
    lines = ["## How to run it", "", *(f"    {line}" for line in _RUNNING.format(
        example=" ".join(chapter["name"] for chapter in chapters[:2])).split("\n")), "",
        "Decks that have not changed are not run again.", "", "    " + version.replace(
            "\n", "\n    "), ""]
    if not decks:
        return lines
    lines += [
        f"{len(decks)} decks, {seconds:.0f} s of one core together:", "",
        "| deck | runs | seconds, the first | exit status |", "|---|---|---|---|"]
    for deck in decks:
        record, count = runs.record(deck), len(runs.with_draws([deck]))
        lines.append(f"| `{path_name(deck)}` | {count} | {record.get('seconds', '')} | "
                     f"{record.get('status', 'not run')} |")
    lines += ["", "Exit status 1 is what decks named `_paper` may end with: they stop on the "
              "paper's rule, and snapin does not call that converged."]
    return lines
