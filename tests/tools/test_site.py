"""Claims about the site: every page is in it, dead links are found, gallery and notebook run."""

import re
import sys

import pytest
from conftest import ROOT

sys.path += [str(ROOT / "tools/site")]
import gallery  # noqa: E402
import lay_out  # noqa: E402

SETTINGS = (ROOT / "tools/site/mkdocs.yml").read_text(encoding="utf-8")
MADE = {"docs/notebook.md", "docs/python_api.md", "docs/calculator.html", "sources/index.html"}


def test_the_site_has_every_page_once():
    listed = re.findall(r"^ +- .*: (\S+\.(?:md|html))$", SETTINGS.split("\nnav:")[1], re.M)
    assert len(set(listed)) == len(listed)
    assert {*listed} - MADE == {page.as_posix() for page in lay_out.page_names()}


def test_every_page_is_laid_out_with_what_it_links_to(tmp_path):
    lay_out.lay_out(tmp_path)
    for name in ("README.md", "docs/decks.md", "docs/first.png", "inputs/examples/dlvo.nml"):
        assert (tmp_path / name).is_file(), name
    text = (tmp_path / "docs/equations.md").read_text()
    assert "(../sources/module/classical.html)" in text and ".f90)" not in text
    # A comment above a table would be part of its paragraph.
    assert "<!-- measured" not in (tmp_path / "docs/forces.md").read_text()
    api = (tmp_path / "docs/python_api.md").read_text()
    assert "::: snapin.run\n" in api and "::: snapin.read_results\n" in api


def test_the_page_of_the_python_api_has_the_types_of_results_and_their_fields():
    api = lay_out.api_page()
    assert "::: snapin.numerics.LawValues\n\nFields: `pressure`, `slope`, `energy`." in api
    # Returned by a method of what a function returns, and a field of it.
    assert "::: snapin.numerics.KernelMatrix\n" in api and "::: snapin.many_curves.Shared\n" in api
    assert len(re.findall("^::: ", api, re.M)) == len(set(re.findall("^::: .*", api, re.M)))


def test_small_numbers_stay_in_one_line_outside_of_code():
    text, _ = lay_out.laid_out(
        "1e-6, `2e-6`, [3e-6](4e-6.md#5e-6)\n\n    6e-6\n\n```\n7e-6\n```\n",
        lay_out.pathlib.PurePosixPath("a.md"))
    assert re.findall("<nobr>(.*?)</nobr>", text) == ["1e-6", "3e-6"]


def test_pages_of_sources_keep_asterisks_and_load_nothing(tmp_path):
    (tmp_path / "css").mkdir()
    (tmp_path / "search.html").touch()
    page = tmp_path / "index.html"
    page.write_text('<head><link href="https://example.org/a.css"></head><em>All files…</em>'
                    "<p>1/E<em> = 1/E1 + 1/E2. E</em> is</p>")
    lay_out.dress(tmp_path)
    text = page.read_text()
    assert "1/E* = 1/E1 + 1/E2. E* is" in text and "<em>All files…</em>" in text
    assert "https:" not in text and "css/sources.css" in text
    assert not (tmp_path / "search.html").exists()


def test_long_names_may_break_after_an_underscore():
    text, _ = lay_out.laid_out("| `test_a_long_name_of_a_claim` | `max_tension` |\n",
                               lay_out.pathlib.PurePosixPath("a.md"))
    assert "<code>test_<wbr>a_<wbr>long_" in text and "`max_tension`" in text


def test_the_paper_has_its_title_citations_and_references():
    text = lay_out.paper_page((ROOT / "docs/paper.md").read_text(encoding="utf-8"),
                              (ROOT / "docs/paper.bib").read_text(encoding="utf-8"))
    assert text.startswith("# snapin: ") and "@" not in text and "$" not in text
    assert "Attard and Parker (1992)" in text and "(Carpick et al., 1999)" in text
    references = text.split("## References")[1]
    assert references.count("\n- ") == 11 and not re.search(r"[{}\\]", references)


def test_the_calculator_leads_back_to_the_pages(tmp_path):
    lay_out.lay_out(tmp_path)
    assert 'href="../index.html"' in (tmp_path / "docs/calculator.html").read_text()


def test_dead_links_and_what_a_network_would_bring_are_found(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "a/b.html").write_text('<h1 id="top">B</h1><a href="../index.html">up</a>')
    (tmp_path / "index.html").write_text(
        '<a href="a/b.html#top">good</a><a href="a/b.html#no">no place</a><a href="c.html">no '
        'file</a><a href="https://example.org">elsewhere</a><a href="#here">no place</a>'
        '<script src="https://example.org/x.js"></script><img src="data:image/png;base64,AA==">')
    assert lay_out.dead_links(tmp_path) == [
        "index.html: a/b.html#no", "index.html: c.html", "index.html: #here",
        "index.html: https://example.org/x.js, from a network"]


def test_the_gallery_has_a_picture_of_every_script():
    found = gallery.entries()
    scripts = {path.name for path in (ROOT / "pywrap/plots").glob("*.py")}
    shown = {command[0].rpartition("/")[2] for _, _, command in found}
    # That of accuracy needs many runs, and that of many curves their files.
    named = {"accuracy.py", "curve_map.py"}
    assert scripts - named == shown
    text = gallery.PAGE.read_text()
    assert all(name in text for name in named)
    for picture, deck, _ in found:
        assert (ROOT / "docs" / picture).is_file() and (ROOT / deck).is_file()


def test_the_notebook_runs_and_gives_the_numbers_of_the_deck():
    pytest.importorskip("nbclient")
    import notebook
    text, pictures = notebook.page_of(notebook.executed())
    assert "pull-off force 60.717852 µN" in text
    assert len(re.findall(r"^ .*N/m: \d+\.\d+ fJ lost", text, re.M)) == 3
    assert len(pictures) == 2
    assert all(picture.startswith(b"\x89PNG") for picture in pictures.values())
