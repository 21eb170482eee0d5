"""The table of pull-offs under different laws at one range of the force."""

import re

import law_independence as tool
import pytest
from conftest import ROOT

# From another program: pull-off over pi w R by Tabor's parameter in which the length is the range.
REFERENCE = {
    1: {"Maugis-Dugdale": 1.58538, "9, 3": 1.67467, "10, 4": 1.66269, "12, 6": 1.65394,
        "6, 3": 1.67139, "Morse": 1.64610},
    2: {"Maugis-Dugdale": 1.52810, "9, 3": 1.58614, "10, 4": 1.57375, "12, 6": 1.56514,
        "6, 3": 1.58294, "Morse": 1.55778},
}
PAGE = ROOT / "docs" / "forces.md"


def page():
    """The table of the page: Tabor's parameter -> column -> value."""
    text = PAGE.read_text(encoding="utf-8")
    lines = re.search(r"<!-- laws -->\n(.*?)<!-- /laws -->", text, re.S)[1].splitlines()
    names, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")]
                       for line in lines if line.startswith("|"))
    return {float(row[0]): dict(zip(names[1:], map(float, row[1:]))) for row in rows}


@pytest.mark.parametrize("tabor", REFERENCE)
def test_pull_offs_are_those_that_another_program_found(tabor):
    for name, law in tool.LAWS.items():
        tension, maugis = tool.pull_offs(law, tabor, accuracy=1e-7)
        # Its last digit, which it rounded.
        assert tension == pytest.approx(REFERENCE[tabor][name], abs=1.1e-5), name
        assert maugis == pytest.approx(REFERENCE[tabor]["Maugis-Dugdale"], abs=5.1e-6)


def test_the_page_has_the_tool_s_table():
    shown = page()
    assert list(shown) == list(tool.RANGES)
    assert list(shown[1]) == ["Maugis-Dugdale", *tool.LAWS]
    for tabor, name in ((0.2, "9, 3"), (0.5, "Morse"), (5, "12, 6")):
        tension, maugis = tool.pull_offs(tool.LAWS[name], tabor, accuracy=1e-7)
        assert shown[tabor][name] == pytest.approx(tension, abs=6e-6)
        assert shown[tabor]["Maugis-Dugdale"] == pytest.approx(maugis, abs=6e-6)


def test_laws_of_one_range_pull_alike():
    """Within what the page says of them."""
    for tabor, row in page().items():
        laws = [value for name, value in row.items() if name != "Maugis-Dugdale"]
        assert max(laws) < 1.02 * min(laws), tabor
        assert row["Maugis-Dugdale"] < min(laws)
        assert max(laws) < 1.06 * row["Maugis-Dugdale"]
