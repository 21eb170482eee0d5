"""Versions, options and places in the files for packagers are those of the project."""

import re

import pytest
from conftest import ROOT
from recipes import package_of_spack

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
    assert given == {"python", "mpi", "blas", "processor"} <= OPTIONS
    recipe = (ROOT / "packaging/conda/recipe.yaml").read_text(encoding="utf-8")
    assert set(re.findall(r"-Csetup-args=-D(\w+)=", recipe)) == {"processor"}


def test_recipes_install_the_licences_of_all_parts():
    recipe = (ROOT / "packaging/conda/recipe.yaml").read_text(encoding="utf-8")
    named = re.findall(r"^    - (\S*LICENSE)$", recipe, re.MULTILINE)
    assert [(ROOT / name).is_file() for name in named] == [True, True]
