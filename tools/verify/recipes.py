#!/usr/bin/env python3
"""Builds the recipes of packaging/ from a source distribution and tries what they install.

    python -m build --sdist && python tools/verify/recipes.py [conda] [spack]

conda: rattler-build (pip install py-rattler-build) renders, solves, builds and tests the recipe.
Where no channel of conda can be reached, the packages that it needs stand in a channel made here:
Python, NumPy, Meson and the like are those of this interpreter and of pip, and the compilers and
OpenBLAS are the system's, so that their packages are empty.

spack: the phases of Spack's Meson packages, with the arguments that the package gives; Spack itself
does not run. Directives are noted, and the defaults of the variants are taken.
"""

import argparse
import contextlib
import hashlib
import json
import os
import runpy
import shutil
import subprocess
import sys
import tarfile
import tempfile
import types
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PYTHON = "%d.%d" % sys.version_info[:2]
# Packages of pip by their names in conda.
OF_PIP = ("pip", "meson-python", "pyproject-metadata", "packaging", "meson", "ninja", "numpy")
OF_THE_SYSTEM = ("gcc_linux-64", "gfortran_linux-64", "sysroot_linux-64", "pkg-config", "openblas")
NEEDS = {"meson-python": ["meson", "ninja", "packaging", "pyproject-metadata"]}


def run(*command, **options):
    print("$", *command, flush=True)
    subprocess.run([str(word) for word in command], check=True, **options)


def copy_of_python(folder):
    """An interpreter finds its library beside itself, so that a copy is one that can be moved."""
    base, name = Path(sys.base_prefix), f"python{PYTHON}"
    (folder / "bin").mkdir(parents=True)
    shutil.copy2(base / "bin" / name, folder / "bin" / name)
    for link in ("python", "python3"):
        (folder / "bin" / link).symlink_to(name)
    shutil.copytree(base / "include" / name, folder / "include" / name)
    shutil.copytree(base / "lib" / name, folder / "lib" / name, ignore=shutil.ignore_patterns(
        "site-packages", "test", "tests", "idlelib", "__pycache__", "config-*"))


def channel_of_stand_ins(folder):
    import rattler_build  # noqa: PLC0415 - spack does without

    (folder / "noarch").mkdir(parents=True)
    (folder / "noarch/repodata.json").write_text('{"packages": {}, "packages.conda": {}}')
    entries = {}
    for name in ("python", *OF_PIP, *OF_THE_SYSTEM):
        with tempfile.TemporaryDirectory() as files:
            files, version = Path(files), "1"
            if name == "python":
                copy_of_python(files)
                version = "%d.%d.%d" % sys.version_info[:3]
            elif name in OF_PIP:
                run(sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--ignore-installed",
                    "--no-compile", "--disable-pip-version-check", "--prefix", files, name)
                (about,) = files.glob("lib/python*/site-packages/*.dist-info")
                version = about.name.removesuffix(".dist-info").rpartition("-")[2]
            else:
                (files / "share").mkdir()
                (files / "share" / name).write_text("of the system\n")
            depends = NEEDS.get(name, []) + (["python"] if name in OF_PIP else [])
            made = Path(rattler_build.assemble_package(
                name, version, "linux-64", "0", folder / "linux-64", files_dir=files,
                depends=depends, compression_level=1).path)
        content = made.read_bytes()
        entries[made.name] = {
            "name": name, "version": version, "build": "0", "build_number": 0, "depends": depends,
            "subdir": "linux-64", "size": len(content),
            "sha256": hashlib.sha256(content).hexdigest(),
            "md5": hashlib.md5(content).hexdigest()}
    (folder / "linux-64/repodata.json").write_text(json.dumps(
        {"info": {"subdir": "linux-64"}, "packages": {}, "packages.conda": entries}))


def conda(scratch, tarball):
    import rattler_build  # noqa: PLC0415 - spack does without

    recipe = scratch / "recipe/recipe.yaml"
    recipe.parent.mkdir()
    text = (TOP / "packaging/conda/recipe.yaml").read_text(encoding="utf-8")
    place = "../../dist/snapin-${{ version }}.tar.gz"
    assert place in text
    recipe.write_text(text.replace(place, str(tarball)), encoding="utf-8")
    channel_of_stand_ins(scratch / "channel")
    variants = rattler_build.VariantConfig({
        "python": [PYTHON], "c_compiler": ["gcc"], "fortran_compiler": ["gfortran"],
        "c_stdlib": ["sysroot"]})
    (variant,) = rattler_build.Stage0Recipe.from_file(recipe).render(variants)
    result = variant.run_build(
        rattler_build.ToolConfiguration(test_strategy="native"), scratch / "output",
        [(scratch / "channel").as_uri()])
    for package in result.packages:
        print(f"{Path(package).name}: {Path(package).stat().st_size/1e6:.1f} MB")


class Spec:
    """The specification of Spack's package with the defaults of its variants."""

    def __init__(self, variants):
        self.variants = variants

    def satisfies(self, constraint):
        return self.variants[constraint[1:]] == (constraint[0] == "+")

    def __getitem__(self, _):
        return types.SimpleNamespace(name="openblas")


def package_of_spack():
    """The class of packaging/spack, on stand-ins of Spack's modules, and its directives."""
    noted = []

    def directive(name):
        return lambda *words, **options: noted.append((name, words, options))

    spack = types.ModuleType("spack.package")
    for name in ("version", "license", "variant", "depends_on", "extends"):
        setattr(spack, name, directive(name))
    spack.when = lambda _: contextlib.nullcontext()
    meson = types.ModuleType("spack_repo.builtin.build_systems.meson")
    meson.MesonPackage = type("MesonPackage", (), {})
    sys.modules |= {name: types.ModuleType(name) for name in (
        "spack", "spack_repo", "spack_repo.builtin", "spack_repo.builtin.build_systems")}
    sys.modules |= {spack.__name__: spack, meson.__name__: meson}
    package = runpy.run_path(str(TOP / "packaging/spack/package.py"))["Snapin"]()
    package.spec = Spec({words[0]: options["default"] for name, words, options in noted
                         if name == "variant"})
    return package, noted


def spack(scratch, tarball):
    package, _ = package_of_spack()
    with tarfile.open(tarball) as archive:
        archive.extractall(scratch / "source")
    (source,) = (scratch / "source").iterdir()
    build, prefix = scratch / "spack-build", scratch / "prefix"
    # Those of spack_repo.builtin.build_systems.meson, with the defaults of its variants.
    arguments = [f"-Dprefix={prefix}", f"-Dlibdir={prefix}/lib", "-Dbuildtype=release",
                 "-Dstrip=false", "-Ddefault_library=shared", "-Dwrap_mode=nodownload"]
    run("meson", "setup", source, build, *arguments, *package.meson_args())
    run("ninja", "-C", build, "-v", stdout=subprocess.DEVNULL)
    run("ninja", "-C", build, "install", stdout=subprocess.DEVNULL)
    run(prefix / "bin/snapin", source / "inputs/first.nml", cwd=scratch)
    run(sys.executable, "-c", "import snapin; print(snapin.__version__, snapin.__file__)",
        cwd=scratch, env=os.environ | {"PYTHONPATH": f"{prefix}/lib/python{PYTHON}/site-packages"})
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "snapin"], check=True, text=True,
                           capture_output=True,
                           env=os.environ | {"PKG_CONFIG_PATH": f"{prefix}/lib/pkgconfig"}).stdout
    run("gfortran", source / "examples/one_state.f90", *flags.split(), "-o", scratch / "one_state")
    run(scratch / "one_state")


def main():
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("recipe", nargs="*", help="conda, spack; both by default")
    parser.add_argument("--from", dest="tarball", type=Path, metavar="FILE",
                        help="the source distribution; the one of dist/ by default")
    given = parser.parse_args()
    tarball = (given.tarball or next((TOP / "dist").glob("snapin-*.tar.gz"))).resolve()
    for recipe in given.recipe or ["conda", "spack"]:
        with tempfile.TemporaryDirectory(prefix=f"snapin-{recipe}-") as scratch:
            {"conda": conda, "spack": spack}[recipe](Path(scratch), tarball)


if __name__ == "__main__":
    main()
