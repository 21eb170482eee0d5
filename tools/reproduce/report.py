"""Puts pictures, captions and tables together: report.md."""

import pathlib

from published import COLUMNS


def write(folder, chapters, notes):
    """Write `folder`/report.md.

    `chapters` are dicts with name, title, caption, rows and problem (None if all went well);
    `notes` are paragraphs for the end: how to run, versions, time.
    """
    lines = ["# The figures and numbers of Attard and Parker (1992), computed again", ""]
    for chapter in chapters:
        lines += [f"## {chapter['title']}", ""]
        if chapter["problem"]:
            lines += [f"**Not drawn:** {chapter['problem']}", ""]
            continue
        lines += [f"![{chapter['title']}]({chapter['name']}.png)", "", chapter["caption"], ""]
        lines += table(chapter["rows"])
    lines += notes
    pathlib.Path(folder, "report.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


def table(rows):
    """Return rows as the lines of a Markdown table, with an empty line after it."""
    if not rows:
        return []
    lines = ["| " + " | ".join(COLUMNS) + " |", "|" + "---|" * len(COLUMNS)]
    lines += ["| " + " | ".join(cell.replace("|", "\\|") for cell in row.cells()) + " |"
              for row in rows]
    return [*lines, ""]
