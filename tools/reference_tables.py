#!/usr/bin/env python3
"""Bring the tables of docs/decks.md and docs/results.md up to date.

The program prints them: `snapin --keys` every group and key of a deck, `snapin --results` every
file, column and entry of results. A page has the tables between two marks,
`<!-- --keys -->` and `<!-- /--keys -->`.
"""

import os
import re
import subprocess
from typing import NamedTuple

import pages

PROGRAM = os.environ.get("SNAPIN", pages.ROOT / "build" / "snapin")

# Page, and the option that prints its tables.
PAGES = {"docs/decks.md": "--keys", "docs/results.md": "--results"}


class Section(NamedTuple):
    """A group of a deck, a file of results or a group of the summary."""

    name: str
    note: str
    meaning: str
    # A group in a deck that works, or ''.
    example: str
    # For each item: the line that begins with its name, and its meaning.
    items: list


def sections_of(output):
    sections = []
    for block in output.strip("\n").split("\n\n"):
        title, meaning, *lines = block.split("\n")
        name, _, note = title.partition(" ")
        items, example = [], ""
        for line in lines:
            if line.startswith("    Example: "):
                example = line.partition(": ")[2]
            elif line.startswith(" " * 26):
                items[-1][1] = line.strip()
            else:
                items.append([line.strip(), ""])
        sections.append(Section(name, note.strip("()"), meaning.strip(), example, items))
    return sections


def keys_as_markdown(sections):
    """Return every group and key of a deck, without those that the program itself writes."""
    text = ""
    for group in sections:
        if group.note == "skipped":
            continue
        required = "Required. " if group.note == "required" else ""
        text += f"### `{group.name}`\n\n{required}{_cell(group.meaning)}\n\n"
        text += f"    {group.example}\n\n" if group.example else ""
        rows = [(f"`{key}`", value.strip(), meaning)
                for line, meaning in group.items
                for key, _, value in [line.partition(" ")]]
        text += _table(["key", "value", "meaning"], rows)
    return text


def results_as_markdown(sections):
    text = ""
    for section in sections:
        of_summary = section.name.startswith("&")
        level = "####" if of_summary else "###"
        when = f" Written {_cell(section.note)}." if section.note else ""
        text += f"{level} `{section.name}`\n\n{_cell(section.meaning)}{when}\n\n"
        rows = []
        for line, meaning in section.items:
            name, unit, note = re.fullmatch(r"(\w+)(?: \[(.*?)\])?(?:; (.*))?", line).groups("")
            rows.append((f"`{name}`", unit, note, meaning))
        text += _table(["entry" if of_summary else "column", "unit", "note", "meaning"], rows)
    return text


def page_with(page, output):
    """Return the text of a page with the tables of the program's output."""
    option = PAGES[page]
    make = {"--keys": keys_as_markdown, "--results": results_as_markdown}[option]
    lines = make(sections_of(output)).splitlines()
    return pages.replaced((pages.ROOT / page).read_text(encoding="utf-8"), option, lines)


def _table(head, rows):
    """Return a Markdown table without empty columns; nothing without rows."""
    kept = [i for i in range(len(head)) if any(row[i] for row in rows)]
    columns, *cells = ([line[i] for i in kept] for line in (head, *rows))
    return "\n".join([*pages.table(columns, cells, _cell), "", ""]) if kept else ""


def _cell(text):
    """Return text that Markdown does not change; names of groups are code."""
    if text.startswith("`"):
        return text
    return re.sub(r"(?<!\w)&[a-z_]+", r"`\g<0>`", re.sub(r"([|*])", r"\\\1", text))


def main():
    for page, option in PAGES.items():
        output = subprocess.run(
            [PROGRAM, option], check=True, capture_output=True, text=True).stdout
        (pages.ROOT / page).write_text(page_with(page, output), encoding="utf-8")


if __name__ == "__main__":
    main()
