"""Claims about the form of the sources."""

import pytest
from conftest import ROOT

COLUMNS = 100
KINDS = {".f90", ".in", ".c", ".py", ".build", ".sh"}


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
