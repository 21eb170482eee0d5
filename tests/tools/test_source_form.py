"""Claims about the form of the sources: lines are short, and a module uses its own room of src/ and
those above it, none below."""

import ast
import re

import house
import pytest
from conftest import ROOT

COLUMNS = 100
KINDS = {".f90", ".in", ".c", ".py", ".build", ".sh"}

SOURCE = ROOT / "src"
# The order in which src/meson.build goes through the rooms is the order in which they may use each
# other.
ROOMS = re.findall(r"^subdir\('(\w+)'\)", (SOURCE / "meson.build").read_text(), re.MULTILINE)
MODULES = house.sources()


def test_every_module_is_in_a_room_that_meson_knows():
    assert {house.room_of(name) for name in MODULES} == set(ROOMS)
    for path in MODULES.values():
        # Meson makes what ends in .in, and builds the program itself.
        if path.suffix == ".f90" and path.stem != "snapin":
            # Laws and shapes are listed by the names of their modules.
            by_name = path.parent.name in ("laws", "shapes")
            listed = f"'{path.stem}'" if by_name else f"'{path.name}'"
            assert listed in (path.parent / "meson.build").read_text(), path


def test_no_import_runs_backwards():
    backwards = [
        f"{name} uses {other} of {house.room_of(other)}"
        for name, used in house.uses().items()
        for other in used
        if ROOMS.index(house.room_of(other)) > ROOMS.index(house.room_of(name))
    ]
    assert not backwards


def test_a_module_is_named_like_its_file():
    for name, path in MODULES.items():
        declared = re.search(r"^(?:module|program) (\w+)", path.read_text(), re.MULTILINE)
        assert declared[1] == name


def test_a_number_in_a_formula_has_a_name():
    """Except for coefficients (`house.is_plain`)."""
    _, unnamed = house.constants()
    assert not [f"{path.name}:{line}: {text}" for path, line, text in unnamed]


def test_every_name_of_a_type_has_one_meaning():
    """`app/mpi/` and `app/alone/` have the same module, of which a build takes one."""
    definition = re.compile(r"^ *type(?:, *[\w, ()]+)? *(?:::)? +(\w+_t) *$", re.MULTILINE)
    places = {}
    for path in sorted(SOURCE.rglob("*.f90*")):
        if path.parent.name == "alone":
            continue
        for name in definition.findall(path.read_text()):
            places.setdefault(name, []).append(path.name)
    assert len(places) > 100
    assert not {name: found for name, found in places.items() if len(found) > 1}


@pytest.mark.parametrize("folder", ["src", "pywrap", "tests"])
def test_no_line_is_longer_than_a_hundred_columns(folder):
    long = [
        f"{path.relative_to(ROOT)}:{number}"
        for path in sorted((ROOT / folder).rglob("*"))
        if path.is_file() and path.suffix in KINDS
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if len(line) > COLUMNS
    ]
    assert not long


def test_python_3_9_reads_every_file_of_python():
    """The package could not be imported there: a field had the type `array | None`."""
    newer = []
    for path in sorted(path for room in ("pywrap", "tests", "tools")
                       for path in (ROOT / room).rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"), feature_version=(3, 9))
        for node in ast.walk(tree):
            annotations = [getattr(node, name, None) for name in ("annotation", "returns")]
            if any(isinstance(part, ast.BinOp) and isinstance(part.op, ast.BitOr)
                   for found in annotations if found for part in ast.walk(found)):
                newer.append(f"{path.name}, line {node.lineno}: a type with |")
            if (isinstance(node, ast.Call) and getattr(node.func, "id", "") == "zip"
                    and any(word.arg == "strict" for word in node.keywords)):
                newer.append(f"{path.name}, line {node.lineno}: zip(strict=)")
    assert newer == []
