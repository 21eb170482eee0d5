"""Commands that renew a table of a page say below it when they measured its figures."""

import datetime

import pages
import pytest


def test_a_renewed_table_has_the_day_and_the_command_once(tmp_path, snapin):
    page = tmp_path / "page.md"
    page.write_text("# Title\n\n<!-- one -->\nold\n<!-- /one -->\n\nText.\n")
    version = snapin("--version").stdout.split()[1]
    for value in 1, 2:
        pages.insert(page, "one", pages.table(["a", "b"], [[value, "x"]]), "tools/one.py")
        assert page.read_text() == (
            f"# Title\n\n<!-- one -->\n| a | b |\n|---|---|\n| {value} | x |\n\n"
            f"Measured on {datetime.date.today()} with snapin {version}, by `tools/one.py`.\n"
            "<!-- /one -->\n\nText.\n")


def test_a_page_without_the_marks_of_a_table_is_refused(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# Title\n")
    with pytest.raises(ValueError, match="no marks for one"):
        pages.insert(page, "one", ["new"])
    assert page.read_text() == "# Title\n"
