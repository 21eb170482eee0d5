"""Claims about the documents: tables and figures are the program's, links lead somewhere."""

import re

import f90nml
import pytest
import reference_tables
from conftest import ROOT

PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
PAGES += sorted((ROOT / "docs").rglob("*.md"))
README = (ROOT / "README.md").read_text(encoding="utf-8")
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
SOURCES = sorted([*(ROOT / "src").rglob("*.[fc]*"), *(ROOT / "pywrap").rglob("*.f90")])
SOURCES.append(ROOT / "meson.build")


@pytest.mark.parametrize("page, option", reference_tables.PAGES.items())
def test_tables_are_what_the_program_prints(snapin, page, option):
    shown = (ROOT / page).read_text(encoding="utf-8")
    assert shown == reference_tables.page_with(page, snapin(option).stdout), (
        "bring it up to date with: tools/reference_tables.py")


def without_code(text):
    """Text without code blocks, which may hold what looks like a link or a heading."""
    return re.sub(r"^```.*?^```|^    .*?$", "", text, flags=re.S | re.M)


def anchors_of(page):
    """The names that GitHub gives to the headings of a page."""
    headings = re.findall(r"^#+ (.*)$", without_code(page.read_text(encoding="utf-8")), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_every_link_leads_to_a_file_and_a_heading(page):
    for link in re.findall(r"\]\(([^)\s]+)\)", without_code(page.read_text(encoding="utf-8"))):
        if re.match(r"\w+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = page.parent / path if path else page
        assert target.exists(), link
        assert not anchor or anchor in anchors_of(target), link


def test_every_picture_is_whole():
    """One was an empty file: its program had been interrupted."""
    pictures = sorted((ROOT / "docs").rglob("*.png"))
    assert len(pictures) > 20
    # A PNG file has a signature and ends with a chunk IEND.
    for picture in pictures:
        data = picture.read_bytes()
        assert data.startswith(b"\x89PNG") and b"IEND" in data[-12:], picture


def test_every_page_can_be_reached_from_the_readme():
    reached, new = set(), {ROOT / "README.md"}
    while new:
        page = new.pop()
        reached.add(page)
        for link in re.findall(r"\]\(([^)#\s]+\.md)", page.read_text(encoding="utf-8")):
            target = (page.parent / link).resolve()
            if target.exists() and target not in reached:
                new.add(target)
    assert [page for page in PAGES if page not in reached] == []


def test_the_deck_in_the_readme_is_the_file_that_it_names():
    shown = re.search(r"```fortran\n(&scene.*?)```", README, re.S)[1]
    assert shown in (ROOT / "inputs/first.nml").read_text(encoding="utf-8")


def test_the_summary_in_the_readme_is_what_its_deck_gives(snapin, tmp_path):
    snapin("--quiet", "--out", tmp_path, ROOT / "inputs/first.nml")
    summary = (tmp_path / "first" / "summary.nml").read_text()
    shown = re.findall(r"^  (\w+) = ([^ !]+)", README.split("&summary\n")[1].split("\n/")[0], re.M)
    assert len(shown) > 10
    for key, value in shown:
        found = re.search(rf"^  {key} = (.*)$", summary, re.M)[1]
        if value.startswith("."):
            assert found == value, key
        else:
            # The page has rounded to its last digit.
            mantissa, _, exponent = value.partition("E")
            digits = len(mantissa.partition(".")[2])
            assert abs(float(found) - float(value)) <= 10.0 ** (int(exponent or 0) - digits), key


def test_the_table_of_accuracy_is_what_its_deck_gives(snapin, tmp_path):
    text = (ROOT / "docs/methods.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (1e-\d+) \| [\d.]+ \| (\d+) \| (\S+) \| (\S+) \| (\S+) \|$", text, re.M)
    assert len(rows) == 3
    first = (ROOT / "inputs/first.nml").read_text(encoding="utf-8")
    for accuracy, nodes, tension, jump, estimate in rows:
        deck = tmp_path / f"{accuracy}.nml"
        deck.write_text(first + f"&equilibrium_path /\n&numerics accuracy = {accuracy} /\n")
        snapin("--quiet", "--out", tmp_path, deck)
        groups = f90nml.read(tmp_path / accuracy / "summary.nml")
        summary = groups["summary"]
        assert groups["cost"]["nodes"] == int(nodes)
        assert abs(summary["max_tension"] * 1e6 - float(tension)) <= 1e-8
        assert abs(summary["jump_in_h0"] * 1e9 - float(jump)) <= 1e-8
        assert float(estimate) / 2 < summary["error_estimate"] < 2 * float(estimate)


def test_every_message_that_is_explained_is_one_of_the_program():
    text = (ROOT / "docs/limits.md").read_text(encoding="utf-8").split("## Warnings")[1]
    # Strings that go on in another line or around a number.
    source = re.sub(r"' *// *(&\s*)?'", "", "\n".join(path.read_text() for path in SOURCES))
    messages = [message for row in re.findall(r"^\| ([^|]*) \|", text, re.M)
                for message in re.findall(r"`([^`]*)`", row)]
    assert len(messages) > 15
    assert [message for message in messages if message not in source] == []


def test_the_tour_of_the_code_names_every_room_and_no_module_or_procedure_that_is_gone():
    begun = CONTRIBUTING.split("## Where a change goes")[0]
    more = (ROOT / "docs/records/tour.md").read_text(encoding="utf-8").split("`pywrap/` holds")[0]
    tour = begun + more
    rooms = {path.name for path in (ROOT / "src").iterdir() if any(path.glob("*.f90"))}
    assert sorted(room for room in rooms if f"| `{room}/` |" not in tour) == []
    known = {path.stem for path in (ROOT / "src").rglob("*.f90")} | rooms
    known |= {path.stem for path in (ROOT / "pywrap").rglob("*.*")}
    known |= {name for path in SOURCES for name in re.findall(
        r"^ *(?:[\w()]+ )*(?:subroutine|function) (\w+)", path.read_text(encoding="utf-8"), re.M)}
    named = set(re.findall(r"`([a-z]+(?:_[a-z0-9]+)+)`", tour))
    assert sorted(named - known) == []


def test_recipes_that_give_a_name_and_its_module_are_right():
    files = {path.stem: path.read_text(encoding="utf-8") for path in SOURCES}
    text = CONTRIBUTING + (ROOT / "docs/records/recipes.md").read_text(encoding="utf-8")
    pairs = [(name, module) for name, module in re.findall(
        r"`([\w%]+)`(?: there)?\s+(?:\(|of\s+)`(\w+)`", text) if module in files]
    assert len(pairs) > 15
    assert [pair for pair in pairs if not re.search(rf"\b{pair[0]}\b", files[pair[1]])] == []


def test_every_note_on_the_compiler_that_code_cites_is_in_the_list_and_none_is_idle():
    """Code says `compiler note 2` or `compiler notes 1 and 4` for an item of the list."""
    notes = (ROOT / "docs/records/compiler_notes.md").read_text(encoding="utf-8")
    listed = {int(number) for number in re.findall(r"^(\d+)\. ", notes, re.M)}
    text = "\n".join(path.read_text(encoding="utf-8") for path in SOURCES)
    cited = re.findall(r"compiler notes? (\d+)(?:\s+(?:!\s*)?and\s+(?:!\s*)?(\d+))?", text)
    assert {int(number) for pair in cited for number in pair if number} == listed


def test_every_module_says_what_it_is_for():
    for path in (ROOT / "src").rglob("*.f90"):
        assert path.read_text(encoding="utf-8").startswith("!> "), path


def test_the_paper_cites_its_whole_bibliography_and_has_the_sections_of_its_journal():
    paper = (ROOT / "docs/paper.md").read_text(encoding="utf-8")
    cited = set(re.findall(r"@(\w+)", paper))
    assert cited == set(re.findall(r"^@\w+{(\w+),$", (ROOT / "docs/paper.bib").read_text(), re.M))
    assert re.findall(r"^# (.*)$", paper, re.M) == [
        "Summary", "Statement of need", "State of the field", "Software design",
        "Research impact statement", "AI usage disclosure", "Acknowledgements", "References"]
    assert 750 <= len(paper.split()) <= 1750
