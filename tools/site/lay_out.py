"""Lay out the pages of the site for MkDocs, and find dead links in what it builds.

    lay_out.py pages FOLDER   copies pages and what they link to, as in the repository
    lay_out.py dress FOLDER   gives the pages of FORD their style
    lay_out.py links FOLDER   checks every link of a built site

Links to sources of Fortran lead to the pages that FORD makes of them, in FOLDER/sources; these get
a style of their own, since that of FORD comes from a network. A link to the notebook leads to its
page.
"""

import ast
import os
import pathlib
import re
import shutil
import sys
import urllib.parse
from html.parser import HTMLParser

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
_LINK = re.compile(r"(\]\()([^)\s]+)(\))")
_CODE = re.compile(r"(^```.*?^```)", re.S | re.M)
# Browsers break a line in 1e-6, after the hyphen; what is code or the target of a link stays.
_SMALL = re.compile(r"`[^`\n]*`|\]\([^)]*\)|^    .*$|\b(\d[\d.]*e-\d+)\b", re.M)

# Names so long that a table would be wider than a screen may break after an underscore.
_LONG_NAME = re.compile(r"`(\w{24,})`")


def page_names():
    """Return the pages of the repository, as paths below its top."""
    pages = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")]
    return [page.relative_to(ROOT) for page in pages + sorted((ROOT / "docs").rglob("*.md"))]


def source_page(name):
    """Return the page of FORD for a file of Fortran, whose module has the name of the file."""
    return f"sources/module/{pathlib.PurePosixPath(name).stem}.html"


def laid_out(text, page):
    """Return the text of a page for MkDocs, and the files below the top that it links to."""
    wanted = set()

    def link(match):
        path, hash_, anchor = match[2].partition("#")
        if not path or re.match(r"\w+:", path):
            return match[0]
        name = os.path.normpath(page.parent / path)
        if name.startswith("src/") and name.endswith(".f90"):
            path = os.path.relpath(source_page(name), page.parent)
        elif name.endswith(".ipynb"):
            path = f"{path.removesuffix('.ipynb')}.md"
        elif not name.endswith(".md"):
            wanted.add(name)
        return f"{match[1]}{path}{hash_}{anchor}{match[3]}"

    parts = _CODE.split(text)
    for number in range(0, len(parts), 2):
        # A comment above a table would be part of its paragraph.
        parts[number] = _LINK.sub(link, re.sub(r"^<!--.*?-->$", "", parts[number], flags=re.M))
        parts[number] = _SMALL.sub(lambda found: f"<nobr>{found[1]}</nobr>" if found[1]
                                   else found[0], parts[number])
        parts[number] = _LONG_NAME.sub(
            lambda found: f"<code>{found[1].replace('_', '_<wbr>')}</code>", parts[number])
    return "".join(parts), wanted


def public_names():
    """Return the names of the Python package, from its __all__."""
    tree = ast.parse((ROOT / "pywrap/snapin/__init__.py").read_text(encoding="utf-8"))
    (names,) = [ast.literal_eval(node.value) for node in tree.body if isinstance(node, ast.Assign)
                and [target.id for target in node.targets] == ["__all__"]]
    return names


def classes():
    """Return (module, syntax) of each class of the Python package by its name."""
    return {node.name: (path.stem, node)
            for path in sorted((ROOT / "pywrap/snapin").glob("*.py"))
            for node in ast.parse(path.read_text(encoding="utf-8")).body
            if isinstance(node, ast.ClassDef)}


def fields_of(node):
    """Return the fields of a named tuple in their order; they have no docstrings."""
    if [base.id for base in node.bases] != ["NamedTuple"]:
        return []
    return [item.target.id for item in node.body if isinstance(item, ast.AnnAssign)]


def returned_classes(names):
    """Return the names of classes that public functions return, or that are in their fields, and
    that are not public themselves."""
    known, found = classes(), []
    trees = [ast.parse(path.read_text(encoding="utf-8"))
             for path in sorted((ROOT / "pywrap/snapin").glob("*.py"))]
    waiting = [node.returns for tree in trees for node in tree.body
               if isinstance(node, ast.FunctionDef) and node.name in names and node.returns]
    while waiting:
        for name in [node.id for node in ast.walk(waiting.pop(0)) if isinstance(node, ast.Name)]:
            if name in known and name not in found:
                found.append(name)
                body = known[name][1].body
                waiting += [item.annotation for item in body if isinstance(item, ast.AnnAssign)]
                waiting += [item.returns for item in body
                            if isinstance(item, ast.FunctionDef) and item.returns]
    return sorted(name for name in found if name not in names)


def api_page():
    """Return the page of the Python API: a heading for each public name, its docstring and its
    fields below, then the same for what the functions return."""
    names, known = public_names(), classes()
    lines = ["# Python API", "", "Every public name of `import snapin`, with its docstring, and "
             "then the types of results. [python.md](python.md) introduces them by examples.", ""]
    for name in [*names, *returned_classes(names)]:
        place = name if name in names else f"{known[name][0]}.{name}"
        lines += [f"::: snapin.{place}", ""]
        fields = fields_of(known[name][1]) if name in known else []
        if fields and "Attributes:" not in ast.get_docstring(known[name][1]):
            lines += [f"Fields: {', '.join(f'`{field}`' for field in fields)}.", ""]
    return "\n".join(lines)


def works(bibliography):
    """Return the fields of each work of a file of BibTeX by its key; LaTeX's accents as letters."""
    letters = {r"{\'e}": "é", r"{\c{c}}": "ç", r'{\"u}': "ü", r'{\"o}': "ö", "---": "—",
               "--": "–"}
    for latex, letter in letters.items():
        bibliography = bibliography.replace(latex, letter)
    found = {}
    for key, entry in re.findall(r"^@\w+{(\w+),\n(.*?)(?=^@|\Z)", bibliography, re.M | re.S):
        fields = re.findall(r"(\w+) = {((?:[^{}]|{[^{}]*})*)}", entry)
        found[key] = {name: re.sub(r"[{}]", "", " ".join(value.split())) for name, value in fields}
    return found


def paper_page(text, bibliography):
    """Return the paper, which is written for Pandoc, as a page with its title, citations and
    references."""
    known = works(bibliography)

    def names(work):
        authors = [author.partition(",")[0] for author in work["author"].split(" and ")]
        return authors[0] + (" et al." if len(authors) > 2 else f" and {authors[1]}"
                             if len(authors) > 1 else "")

    def in_brackets(match):
        keys = re.findall(r"@(\w+)", match[1])
        return f"({'; '.join('{}, {}'.format(names(known[k]), known[k]['year']) for k in keys)})"

    _, head, body = text.split("---\n", 2)
    body = re.sub(r"\[(@[^\]]*)\]", in_brackets, body)
    body = re.sub(r"@(\w+)", lambda m: f"{names(known[m[1]])} ({known[m[1]]['year']})", body)
    body = re.sub(r"\$([^$]*)\$", lambda m: m[1].replace(r"\sigma", "σ"), body)
    body = re.sub(r"^# ", "## ", body, flags=re.M)
    title = re.search(r"^title: '(.*)'$", head, re.M)[1]
    lines = []
    for work in sorted(known.values(), key=lambda work: work["author"]):
        authors = work["author"].replace(" and ", "; ").rstrip(".")
        place = ", ".join(filter(None, (work.get("volume"), work.get("pages"))))
        lines.append(f"- {authors}. {work['title']}. *{work['journal']}* {place} ({work['year']}).")
    return f"# {title}\n{body.rstrip()}\n\n" + "\n".join(lines) + "\n"


def with_way_back(text):
    """Return the page of the calculator, which knows no site, with a link to its first page."""
    begin, header, rest = text.partition("<header>\n")
    assert header
    return f'{begin}{header}<p><a href="../index.html">snapin: all pages</a></p>\n{rest}'


def lay_out(folder):
    """Copy pages and linked files into a folder."""
    wanted = set()
    for page in page_names():
        text = (ROOT / page).read_text(encoding="utf-8")
        if page.as_posix() == "docs/paper.md":
            text = paper_page(text, (ROOT / "docs/paper.bib").read_text(encoding="utf-8"))
        text, links = laid_out(text, page)
        wanted |= links
        (folder / page).parent.mkdir(parents=True, exist_ok=True)
        if page.name == "README.md":
            # The only page of its part: an empty list beside it would take a fifth of the width.
            text = f"---\nhide: [navigation]\n---\n\n{text}"
        (folder / page).write_text(text, encoding="utf-8")
    for name in sorted(wanted):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    calculator = folder / "docs/calculator.html"
    calculator.write_text(
        with_way_back(calculator.read_text(encoding="utf-8")), encoding="utf-8")
    (folder / "docs/python_api.md").write_text(api_page(), encoding="utf-8")
    for name in ("icon.svg", "site.css", "iframe-worker.js"):
        shutil.copy(ROOT / "tools/site" / name, folder / "docs" / name)


# What FORD's pages load from a network: the style and scripts of Bootstrap, and MathJax.
_FROM_NETWORK = re.compile(
    r"<(link|script)\b[^>]*(?:href|src)=[\"']https?://[^>]*>(?:\s*</script>)?")


_OF_BOOTSTRAP = re.compile(
    r"<script>(?:(?!</script>).)*bootstrap\.(?:(?!</script>).)*</script>", re.S)


def dress(folder):
    """Take what pages of FORD load from a network out of them, and give them a style."""
    shutil.copy(ROOT / "tools/site/sources.css", folder / "css/sources.css")
    (folder / "search.html").unlink(missing_ok=True)  # It is empty: the search of FORD is off.
    for page in folder.rglob("*.html"):
        style = os.path.relpath(folder / "css/sources.css", page.parent)
        text = _FROM_NETWORK.sub("", page.read_text(encoding="utf-8"))
        # Places of procedures that FORD names, and does not make.
        text = re.sub(r"#moduleprocedure-[^\"']*", "", text)
        text = _OF_BOOTSTRAP.sub("", text)
        # Asterisks of products and of E*; what FORD itself emphasises ends in dots.
        text = re.sub(r"<em>([^<]*[^<…])</em>", r"*\1*", text)
        home = os.path.relpath(folder.parent / "index.html", page.parent)
        text = re.sub(r"(<ul class=\"navbar-nav[^>]*>)", rf'\1<li><a href="{home}">Pages</a></li>',
                      text, count=1)
        text = text.replace("</head>", f'<link href="{style}" rel="stylesheet"></head>', 1)
        page.write_text(text, encoding="utf-8")


class _Page(HTMLParser):
    """The links of a page of HTML, and the names that links may lead to."""

    def __init__(self, text):
        super().__init__()
        self.links, self.names, self.loaded = [], set(), []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        for key, value in attrs:
            if key in ("id", "name") and value:
                self.names.add(value)
            elif key in ("href", "src") and value:
                self.links.append(value)
                if key == "src" or tag == "link":
                    self.loaded.append(value)


def dead_links(folder):
    """Return "page: link" for every link that leads to no file or to no place in its page, and for
    everything that a page would load from a network."""
    folder = folder.resolve()
    pages = {path: _Page(path.read_text(encoding="utf-8", errors="replace"))
             for path in sorted(folder.rglob("*.html"))}
    found = []
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                if link in page.loaded and parts.scheme != "data":
                    found.append(f"{path.relative_to(folder)}: {link}, from a network")
                continue
            name = urllib.parse.unquote(parts.path)
            target = (path.parent / name).resolve() if name else path
            place = urllib.parse.unquote(parts.fragment)
            if name.startswith("/") or not target.is_file() or (
                    place and target in pages and place not in pages[target].names):
                found.append(f"{path.relative_to(folder)}: {link}")
    return found


def main():
    makers = {"pages": lay_out, "dress": dress}
    if len(sys.argv) != 3 or sys.argv[1] not in (*makers, "links"):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[2])
    if sys.argv[1] in makers:
        makers[sys.argv[1]](folder)
        return
    dead = dead_links(folder)
    for line in dead:
        print(f"dead link in {line}", file=sys.stderr)
    sys.exit(bool(dead))


if __name__ == "__main__":
    main()
