"""Pages with measured figures know which numerics these belong to."""


import pages
import pytest
from conftest import ROOT


@pytest.fixture
def source(tmp_path):
    """A folder of sources with one that computes and one that writes."""
    (tmp_path / "anderson.f90").write_text("x = 1\n")
    (tmp_path / "text_file.f90").write_text("y = 1\n")
    return tmp_path


def test_code_that_computes_changes_the_digest_and_comments_and_text_do_not(source):
    before = pages.digest(source)
    (source / "anderson.f90").write_text("!> What it is.\n\n  x = 1\n")
    (source / "text_file.f90").write_text("y = 2\n")
    assert pages.digest(source) == before
    (source / "anderson.f90").write_text("x = 2\n")
    changed = pages.digest(source)
    assert changed != before
    # A new file counts until it is known not to compute.
    (source / "new.f90").write_text("z = 1\n")
    assert pages.digest(source) not in (before, changed)


def test_a_page_is_marked_below_its_title_and_marked_again(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("# Title\n\nText.\n")
    assert pages.measured_at(page) is None
    pages.mark(page)
    assert page.read_text() == f"# Title\n\n<!-- measured at {pages.digest()} -->\n\nText.\n"
    page.write_text(page.read_text().replace(pages.digest(), "0123456789ab"))
    assert pages.measured_at(page) == "0123456789ab"
    pages.mark(page)
    assert pages.measured_at(page) == pages.digest()
    assert page.read_text().count("measured at") == 1


def test_pages_that_are_older_are_named(tmp_path):
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "anderson.f90").write_text("x = 1\n")
    for number, page in enumerate(pages.PAGES):
        (tmp_path / page).parent.mkdir(parents=True, exist_ok=True)
        now = pages.digest(tmp_path / "src")
        (tmp_path / page).write_text(
            "# T\n" if number == 0
            else f"# T\n<!-- measured at {now if number > 1 else 'abc'} -->\n"
        )
    first, second, *_ = pages.PAGES
    assert pages.old_pages(tmp_path) == [(first, None), (second, "abc")]


def test_every_file_that_is_said_not_to_compute_exists():
    """Otherwise one that was renamed would count, or another be left out by chance."""
    stems = {path.stem for path in (ROOT / "src").rglob("*.f90")}
    assert set(pages._NO_NUMBERS) <= stems


def test_every_page_exists_and_says_what_renews_it():
    for page, renewed_by in pages.PAGES.items():
        assert (ROOT / page).is_file() and renewed_by
