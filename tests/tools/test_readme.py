"""README.md against the program: its table of keys is what `snapin --keys` says.

Run as a script (`.venv/bin/python tests/tools/test_readme.py`), it brings the table up to date.
"""

import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
README = ROOT / "README.md"
TABLE = re.compile(r"(?<=<!-- keys -->\n).*?(?=<!-- /keys -->)", re.S)
# Written by the program, not by users.
RESULTS = {"summary", "cost"}


def table(keys):
    """Return the output of `snapin --keys` as a Markdown table."""
    rows = ["| key | value | meaning |", "|---|---|---|"]
    group = None
    lines = iter(keys.splitlines())
    for line in lines:
        if line.startswith("&"):
            group, _, note = line[1:].partition(" ")
            note = " " + note if note else ""
            if group not in RESULTS:
                rows.append(f"| **`&{group}`**{note} | | {cell(next(lines))} |")
        elif re.match(r"  \w", line) and group not in RESULTS:
            key, value = line.split(maxsplit=1)
            rows.append(f"| `{key}` | {cell(value)} | {cell(next(lines))} |")
    return "\n".join(rows) + "\n"


def cell(text):
    """Return text that Markdown leaves as it is."""
    return re.sub(r"([|*])", r"\\\1", text.strip())


def test_the_table_of_keys_is_what_the_program_says(snapin):
    assert TABLE.search(README.read_text(encoding="utf-8"))[0] == table(snapin("--keys").stdout), (
        "bring it up to date with: .venv/bin/python tests/tools/test_readme.py"
    )


def test_every_file_it_points_to_exists():
    text = README.read_text(encoding="utf-8") + (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    for link in re.findall(r"\]\(([^)#:]+)\)", text):
        assert (ROOT / link).exists(), link


def test_the_tour_of_the_code_names_every_room_and_no_module_that_is_gone():
    tour = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8").split("## How to add")[0]
    rooms = {path.name for path in (ROOT / "src").iterdir() if any(path.glob("*.f90"))}
    assert sorted(room for room in rooms if f"| `{room}/` |" not in tour) == []
    known = {path.stem for path in (ROOT / "src").rglob("*.f90")} | rooms
    known |= {path.stem for path in (ROOT / "pywrap").rglob("*.*")}
    named = set(re.findall(r"`([a-z]+(?:_[a-z0-9]+)+)`", tour.split("`pywrap/` holds")[0]))
    assert sorted(named - known) == []


def test_every_module_says_what_it_is_for():
    for path in (ROOT / "src").rglob("*.f90"):
        assert path.read_text(encoding="utf-8").startswith("!> "), path


if __name__ == "__main__":
    program = os.environ.get("SNAPIN", ROOT / "build" / "snapin")
    output = subprocess.run([program, "--keys"], check=True, capture_output=True, text=True).stdout
    readme = README.read_text(encoding="utf-8")
    README.write_text(TABLE.sub(lambda _: table(output), readme), encoding="utf-8")
