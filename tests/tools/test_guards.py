"""Claims about the list of guards: each statement that it takes out is there, and so are its tests.

That a test fails without the statement takes a build for each: `tools/verify/verify.sh guards`.
"""

import guards
import pytest
from conftest import ROOT


@pytest.mark.parametrize("name", guards.GUARDS)
def test_a_guard_and_its_tests_are_where_the_list_says(name):
    guard = guards.GUARDS[name]
    text = guards.source_of(guard.module).read_text(encoding="utf-8")
    for words, change in ((guard.words, guard.change), guard.also or (guard.words, guard.change)):
        assert len(guards.statements(text, words)) == 1, words
        assert guards.changed(text, words, change) != text
    for test in guard.tests:
        file, _, function = test.partition("::")
        assert f"def {function}" in (ROOT / "tests" / file).read_text(encoding="utf-8"), test
