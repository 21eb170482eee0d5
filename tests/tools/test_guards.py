"""Claims about the list of guards: each line that it takes out is there, and so are its tests.

That a test fails without the line takes a build for each: `tools/verify/verify.sh guards`.
"""

import sys

import pytest
from conftest import ROOT

sys.path.append(str(ROOT / "tools" / "verify"))
import guards  # noqa: E402


@pytest.mark.parametrize("name", guards.GUARDS)
def test_a_guard_stands_once_where_the_list_says(name):
    guard = guards.GUARDS[name]
    text = (ROOT / "src" / guard.file).read_text(encoding="utf-8")
    for line in (guard.old, *guard.also[:1]):
        assert text.count(line) == 1, line


@pytest.mark.parametrize("name", guards.GUARDS)
def test_the_tests_of_a_guard_exist(name):
    for test in guards.GUARDS[name].tests:
        file, _, function = test.partition("::")
        text = (ROOT / "tests" / file).read_text(encoding="utf-8")
        assert f"def {function}" in text, test
