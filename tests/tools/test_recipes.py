"""Versions, options and places in the files for packagers are those of the project."""

import base64
import csv
import hashlib
import re
import subprocess
import zipfile

import pytest
from conftest import ROOT
from recipes import package_of_spack
from wheel_licences import complete

VERSION = re.search(r"version: '([\d.]+)'", (ROOT / "meson.build").read_text(encoding="utf-8"))[1]
OPTIONS = set(re.findall(r"^option\('(\w+)'", (ROOT / "meson.options").read_text(encoding="utf-8"),
                         re.MULTILINE))


@pytest.mark.parametrize(("name", "pattern"), [
    ("CITATION.cff", r"^version: (.*)$"),
    ("CHANGELOG.md", r"\A# Changes\n\n## (.*)$"),
    ("packaging/conda/recipe.yaml", r"^  version: ([\d.]+)$"),
    ("packaging/spack/package.py", r'^    version\("(.*)"\)$'),
])
def test_the_version_is_that_of_the_build(name, pattern):
    said = re.findall(pattern, (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE)
    assert said == [VERSION]


def test_recipes_give_the_build_options_that_it_has():
    package, _ = package_of_spack()
    given = {argument.removeprefix("-D").partition("=")[0] for argument in package.meson_args()}
    assert given == {"python", "mpi", "blas", "processor", "carried"} <= OPTIONS
    recipe = (ROOT / "packaging/conda/recipe.yaml").read_text(encoding="utf-8")
    assert set(re.findall(r"-Csetup-args=-D(\w+)=", recipe)) == {"processor", "carried"}


def test_recipes_install_the_licences_of_all_parts():
    recipe = (ROOT / "packaging/conda/recipe.yaml").read_text(encoding="utf-8")
    named = re.findall(r"^    - (\S*LICENSE)$", recipe, re.MULTILINE)
    assert [(ROOT / name).is_file() for name in named] == [True, True]


@pytest.fixture
def wheel(tmp_path):
    def made(*libraries):
        path = tmp_path / "a-1-py3-none-any.whl"
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("a/__init__.py", "")
            archive.writestr("a-1.dist-info/METADATA",
                             "Name: a\nLicense-Expression: MIT\nLicense-File: LICENSE\n\nLong text")
            archive.writestr("a-1.dist-info/RECORD", "out of date")
            for library in libraries:
                archive.writestr(f"a.libs/{library}", "code")
        return path
    return made


def library_of_the_system():
    """The name of gfortran's library as auditwheel puts it into a wheel."""
    try:
        said = subprocess.run(["dpkg-query", "--search", "*/libgfortran.so.5.*"], check=False,
                              capture_output=True, text=True).stdout
    except FileNotFoundError:
        said = ""
    found = re.search(r"/libgfortran(\.so\.5\.\d\.\d)$", said, re.MULTILINE)
    return f"libgfortran-0123abcd{found[1]}" if found else pytest.skip("not Debian's gfortran")


def test_a_wheel_has_the_licences_of_the_libraries_inside(wheel):
    path = wheel(library_of_the_system())
    complete(path)
    with zipfile.ZipFile(path) as archive:
        about = archive.read("a-1.dist-info/METADATA").decode()
        named = re.findall(r"^License-File: (.*)$", about, re.MULTILINE)
        texts = {name: archive.read(f"a-1.dist-info/licenses/{name}").decode()
                 for name in named if name != "LICENSE"}
        rows = list(csv.reader(archive.read("a-1.dist-info/RECORD").decode().splitlines()))
        names = archive.namelist()
        for name, digest, size in rows[:-1]:
            content = archive.read(name)
            coded = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode()
            assert (digest, int(size)) == (f"sha256={coded.rstrip('=')}", len(content))
    assert sorted(name for name, *_ in rows) == sorted(names)
    assert ("License-Expression: MIT AND (GPL-3.0-or-later WITH GCC-exception-3.1)\n") in about
    assert about.endswith("\n\nLong text") and "LICENSE" in named
    assert "GCC RUNTIME LIBRARY EXCEPTION" in texts["libraries/libgfortran.txt"]
    assert "GNU GENERAL PUBLIC LICENSE" in texts["libraries/GPL-3.txt"]
    with pytest.raises(SystemExit, match="has the licences of its libraries already"):
        complete(path)


def test_a_library_without_a_known_licence_makes_no_wheel(wheel):
    with pytest.raises(SystemExit, match="licence of libmine-01234567.so.1"):
        complete(wheel("libmine-01234567.so.1"))
