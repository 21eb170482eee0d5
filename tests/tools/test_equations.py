"""Claims about the index of the paper's equations: it is complete, and what the tool makes."""

import re

import equations
import pytest
from conftest import ROOT

INDEX = equations.index()


@pytest.mark.slow
def test_the_page_is_what_the_tool_makes():
    assert (ROOT / "docs" / "equations.md").read_text(encoding="utf-8") == equations.page()


@pytest.mark.parametrize("number", equations.EQUATIONS)
def test_each_equation_has_a_place_or_a_reason(number):
    """Either, never both: a reason beside a place would be stale."""
    assert bool(INDEX[number]["source"]) != (number in equations.REASONS)
    assert equations.NAMES[number]


@pytest.mark.parametrize(("number", "path", "name"), [
    (15, "src/mesh/elastic_kernel.f90", None), (17, "src/equilibrium/equilibrium.f90", "residual"),
    (16, "src/equilibrium/equilibrium.f90", "residual"),
    (20, "src/equilibrium/equilibrium.f90", "residual"), (14, "src/equilibrium/mixing.f90", None),
    (10, "src/theory/classical.f90", "jkr_load"),
    (29, "src/equilibrium/local_criteria.f90", "axis_criterion")])
def test_places_that_a_reader_of_the_paper_looks_for(number, path, name):
    assert path in INDEX[number]["source"]
    assert name is None or name in INDEX[number]["source"][path]


@pytest.mark.parametrize("number", [n for n in equations.EQUATIONS if n not in equations.REASONS])
def test_each_equation_that_is_computed_is_tested(number):
    """What this file says of equations counts for none of them."""
    assert set(INDEX[number]["test"]) - {"tests/tools/test_equations.py"}


def test_named_procedures_exist():
    for places in INDEX.values():
        for path, names in places["source"].items():
            text = (ROOT / path).read_text(encoding="utf-8")
            for name in names:
                assert re.search(rf"(subroutine|function) {name}\b", text)


@pytest.mark.parametrize(("text", "found"), [
    ("!> as in (39) of the paper", {39}), ("equations (35a) and (36b)", {35, 36}),
    ("key(2), \"(2)\", x(3) and (28)^2", set()), ("(42) is none", set())])
def test_numbers_of_equations_are_told_from_other_brackets(text, found):
    assert equations.numbers(text) == found
