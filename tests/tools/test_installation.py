"""What pip and Meson install works where nothing of the checkout is in reach."""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

import pytest
import snapin
from installed_pages import names_of

TOP = Path(__file__).resolve().parents[2]
MESON = [sys.executable, "-m", "mesonbuild.mesonmain"]
DECK = """&bodies radius = 1e-6, stiffness = 1e10 /
&force law = 'lennard_jones', hamaker = 1e-19, z0 = 3e-10 /
&equilibrium_path h0_end = -1e-9 /
"""
PAGES = ("share/man/man1/snapin.1", "share/zsh/site-functions/_snapin",
         "share/bash-completion/completions/snapin.bash", "share/licenses/snapin/LICENSE",
         "share/licenses/snapin/LICENSE.minpack")
SWEEP = "&sweep key = 'force.hamaker', values = 1e-20, 1e-19 /\n"


# A shell in a terminal of its own completes "$2"; shows all until "$3" comes.
TYPED_IN_ZSH = """
zmodload zsh/zpty
zpty z zsh -f -i
zpty -w z "fpath=($1 \\$fpath); autoload -Uz compinit; compinit -u -D; PS1='ready> '"
zpty -r z shown '*ready> *ready> *'
zpty -w -n z "$2"$'\\t\\t'
zpty -r z shown "*$3*" && print -r -- "$shown"
"""


def run(*command, cwd=None, **variables):
    """Without what the suite's own environment leads Python to."""
    clean = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, cwd=cwd,
                          env=clean | variables, check=False)
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
    return done.stdout


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    """The tracked files, as someone has them who clones the project; of a source distribution, all
    files but those of builds."""
    copy = tmp_path_factory.mktemp("clone") / "snapin"
    if not (TOP / ".git").exists():
        shutil.copytree(TOP, copy, ignore=shutil.ignore_patterns(
            ".venv", "build*", "results", "reproduction", "__pycache__"))
        return copy
    tracked = run("git", "ls-files", "-z", cwd=TOP).split("\0")
    for name in filter(None, tracked):
        if (TOP / name).is_file():
            (copy / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(TOP / name, copy / name)
    return copy


@pytest.mark.long
def test_pip_installs_package_and_command(checkout, tmp_path):
    venv.create(tmp_path / "new", with_pip=True)
    binaries = tmp_path / "new/bin"
    run(binaries / "python", "-m", "pip", "install", "--disable-pip-version-check",
        f"{checkout}[plots]")
    (tmp_path / "deck.nml").write_text(DECK)
    code = "import snapin; print(repr(snapin.run(open('deck.nml').read()).summary['max_tension']))"
    from_python = float(run(binaries / "python", "-c", code, cwd=tmp_path))
    run(binaries / "snapin", "deck.nml", cwd=tmp_path)
    code = "import snapin; print(repr(snapin.read_results('results/deck').summary['max_tension']))"
    from_program = float(run(binaries / "python", "-c", code, cwd=tmp_path))
    assert from_python == pytest.approx(from_program, rel=1e-9)
    assert from_program > 0
    (tmp_path / "map.nml").write_text(DECK + SWEEP)
    said = subprocess.run([binaries / "snapin", "map.nml"], cwd=tmp_path, capture_output=True,
                          text=True, check=True).stderr
    run(*said.splitlines()[-1].partition("to draw it: ")[2].split(), cwd=tmp_path)
    assert (tmp_path / "results/map/map.png").stat().st_size > 0
    for name in PAGES:
        assert (tmp_path / "new" / name).stat().st_size > 0
    scripts = sorted((tmp_path / "new/share/snapin").rglob("*.py"))
    assert {"force_curve", "fit", "force_law", "law_and_curve", "map"} <= {
        script.stem for script in scripts}
    for script in [script for script in scripts if script.stem != "drawing"]:
        assert "usage: " in run(binaries / "python", script, "--help", cwd=tmp_path), script
    assert "usage: " in run(binaries / "snapin-convert", "--help")
    about = run(binaries / "python", "-m", "pip", "show", "snapin")
    version = run(binaries / "snapin", "--version").split()[1]
    assert f"Version: {version}\n" in about


@pytest.fixture(scope="module")
def root(checkout, tmp_path_factory):
    """A root in whose /usr Meson has installed the project."""
    folder = tmp_path_factory.mktemp("meson")
    build, root = folder / "build", folder / "root"
    run(*MESON, "setup", build, checkout, "--prefix=/usr", "-Dpython=disabled")
    run(*MESON, "compile", "-C", build)
    run(*MESON, "install", "-C", build, DESTDIR=str(root))
    return root


@pytest.mark.slow
def test_a_program_of_others_solves_a_state_with_the_installed_library(snapin_path, tmp_path):
    build, root = snapin_path.parent, tmp_path / "root"
    about = build / "meson-info/intro-compilers.json"
    if not (shutil.which("pkg-config") and about.is_file()):
        pytest.skip("needs pkg-config, and the program in its build folder")
    run(*MESON, "install", "-C", build, "--no-rebuild", "--quiet", "--destdir", root)
    (found,) = root.rglob("snapin.pc")
    flags = run("pkg-config", "--cflags", "--libs", "snapin", PKG_CONFIG_PATH=str(found.parent),
                PKG_CONFIG_SYSROOT_DIR=str(root)).split()
    compiler = json.loads(about.read_text())["host"]["fortran"]["exelist"]
    example = (TOP / "examples/one_state.f90").read_text(encoding="utf-8")

    def made(change="", into=""):
        assert change in example
        (tmp_path / "program.f90").write_text(example.replace(change, into), encoding="utf-8")
        run(*compiler, tmp_path / "program.f90", *flags, "-o", tmp_path / "program")
        return tmp_path / "program"

    numbers = [float(number) for number in re.findall(r"-?\d\.\d+E[-+]\d+", run(made()))]
    deck = "".join(re.findall(r"'(&[^']*)'", example))
    expected = snapin.run(deck)
    rows = expected.profiles
    row = expected.curve["h0"] == rows["h0"][0]
    assert numbers[:3] == pytest.approx(
        [expected.curve["load"][row][0], rows["separation"][0],
         expected.summary["profiles_error"][0]], rel=1e-5)
    assert len(numbers) == 3 + 2 * len(rows["r"]) > 40
    assert numbers[3::2] == pytest.approx(rows["r"], rel=1e-5)
    assert numbers[4::2] == pytest.approx(rows["pressure"], rel=1e-5)
    # What it cannot hand over it refuses, and what it doubts it says.
    for more, reason in (
            ("/ &stability", "the results of &stability are files"),
            ("/ &sweep key = \"force.z0\", values = 4e-10, 5e-10", "not together with &sweep"),
            ("/ &profile h0 = 2e-9", "&profile"), (", h0_stop = 1", "h0_stop")):
        refused = subprocess.run([made("h0_end = 0", "h0_end = 0 " + more)], capture_output=True,
                                 text=True, check=False)
        assert refused.returncode != 0 and reason in refused.stderr
    refused = subprocess.run([made(" &profiles h0 = 2e-9 /", "")], capture_output=True, text=True,
                             check=False)
    assert refused.returncode != 0 and "&profiles is missing" in refused.stderr
    softer = made("stiffness = 1e10", "stiffness = 1e3")
    assert "\nbeyond the model: " in run(softer)


@pytest.mark.long
def test_meson_installs_pages_and_completions_beside_the_program(root):
    program = root / "usr/bin/snapin"
    for name in PAGES:
        assert (root / "usr" / name).stat().st_size > 0
    options = {word.strip("[]") for word in run(program, "--help").splitlines()[0].split()
               if "--" in word}
    assert offered(root, "--") == options
    assert offered(root, "--re") == {"--resume", "--results"}
    keys = set(re.findall(r"^  (\w+) ", run(program, "--keys", "sweep"), re.MULTILINE))
    assert offered(root, "sweep", after="--keys") == {"sweep"} | {f"sweep.{key}" for key in keys}
    assert {"bodies", "bodies.radius"} <= offered(root, "b", after="--keys")
    zsh = (root / "usr/share/zsh/site-functions/_snapin").read_text()
    assert " double_layer.salt " in zsh
    if shutil.which("zsh"):
        shown = run("timeout", 100, "zsh", "-f", "-c", TYPED_IN_ZSH, "zsh",
                    root / "usr/share/zsh/site-functions", "snapin --re", "--resume ")
        assert "--results " in shown and "--version" not in shown
    page = (root / "usr/share/man/man1/snapin.1").read_text()
    for group in ("&bodies", "&sweep", "&double_layer"):
        assert group in page


def offered(root, word, *, after="snapin"):
    """What bash's completion offers for a word after another."""
    script = root / "usr/share/bash-completion/completions/snapin.bash"
    # compopt works only while a line is completed.
    code = ('compopt() { :; }; . "$1"; COMP_WORDS=(snapin "$3" "$2"); COMP_CWORD=2; _snapin; '
            'printf "%s\\n" "${COMPREPLY[@]}"')
    return set(run("bash", "-c", code, "bash", script, word, after).split())


def test_completions_offer_groups_and_keys_by_their_names(snapin):
    """Groups that a deck's reader skips were offered without their last letter."""
    names = list(names_of(snapin("--keys").stdout))
    assert {"scene", "scene.title", "sweep.key"} <= set(names)
    done = snapin("--keys", *names)
    assert done.returncode == 0, done.stderr


@pytest.mark.long
def test_pages_of_all_public_procedures_are_made_without_warnings():
    done = subprocess.run([TOP / "tools/api.sh"], capture_output=True, text=True, check=False)
    assert done.returncode == 0
    assert "arning" not in done.stdout + done.stderr
    made = {page.stem for page in (TOP / "build/api/module").glob("*.html")}
    assert made >= {source.stem for source in (TOP / "src").glob("*/*.f90")} - {"snapin"}


def test_a_user_who_did_not_build_the_checkout_runs_its_program():
    """He was told that it is not built, where its Python is one of the builder alone."""
    if os.geteuid() != 0 or not shutil.which("setpriv"):
        pytest.skip("only root has another user")
    with tempfile.TemporaryDirectory() as top:
        top = Path(top)
        top.chmod(0o755)
        for name in ("build", "tools", ".venv/bin"):
            (top / name).mkdir(parents=True)
        for name in ("run", "test", "tools/setup.sh"):
            shutil.copy2(TOP / name, top / name)
        (top / ".venv/bin/python").symlink_to("/of/another/user/python")
        (top / "build/snapin").write_text("#!/bin/sh\necho ran $*\n")
        (top / "build/snapin").chmod(0o755)
        as_other = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"]
        ran = subprocess.run([*as_other, top / "run", "d.nml"], cwd="/", capture_output=True,
                             text=True, check=False)
        assert (ran.returncode, ran.stdout, ran.stderr) == (0, "ran d.nml\n", "")
        refused = subprocess.run([*as_other, top / "test"], cwd="/", capture_output=True,
                                 text=True, check=False)
        assert refused.returncode == 2
        assert "this user may not run the Python of this checkout, only ./run" in refused.stderr
        (top / "build/snapin").unlink()
        missing = subprocess.run([*as_other, top / "run"], cwd="/", capture_output=True, text=True,
                                 check=False)
        assert missing.returncode == 2 and "is not built" in missing.stderr
