"""The command snapin-plot, and the types that the package declares."""

import importlib
import inspect
import subprocess
import typing

import pytest
import snapin
from conftest import ROOT

DECK = """&bodies radius = 1.5e-2, stiffness = 1.0e10 /
&force law = 'lennard_jones', hamaker = 1.0e-20, z0 = 0.5e-9 /
&equilibrium_path h0_end = -1e-9 /
"""
CASES = {
    "path": ("&profiles h0 = 1.6e-9 /\n&regime /\n&device stiffness = 1e5 /\n",
             {"force_curve", "force_law", "profiles", "regime", "device_curve"}),
    "sweep": ("&sweep key = 'force.hamaker', values = 1e-21, 1e-20 /\n", {"map"}),
    "costs": ("&sweep key = 'numerics.accuracy', values = 1e-2, 1e-3 /\n", {"accuracy"}),
}


@pytest.fixture
def command():
    pytest.importorskip("matplotlib")
    return importlib.import_module("snapin.plots.command").main


@pytest.mark.parametrize("case", CASES)
def test_every_picture_is_drawn_that_the_folder_has_the_files_for(command, tmp_path, capsys, case):
    groups, pictures = CASES[case]
    snapin.run(DECK + groups, out=tmp_path)
    assert command([str(tmp_path)]) == 0
    drawn = capsys.readouterr().out.split()
    assert {tmp_path / f"{name}.png" for name in pictures} == set(tmp_path.glob("*.png"))
    assert sorted(drawn) == sorted(map(str, tmp_path.glob("*.png")))


def test_one_kind_is_drawn_with_its_options(command, tmp_path, capsys):
    snapin.run(DECK + "&profiles h0 = 1.6e-9 /\n", out=tmp_path)
    picture = tmp_path / "here.png"
    assert command(["profiles", str(tmp_path), "--branch", "path", "-o", str(picture)]) == 0
    assert capsys.readouterr().out == f"{picture}\n"
    assert [picture] == list(tmp_path.glob("*.png"))


@pytest.mark.parametrize("kind", ["", "map"])
def test_what_cannot_be_drawn_is_said_in_one_line(command, tmp_path, capsys, kind):
    try:
        status = command([*kind.split(), str(tmp_path / "nowhere")])
    except SystemExit as end:
        message = str(end.code)
    else:
        assert status == 1
        message = capsys.readouterr().err
    assert message.startswith(f"snapin-plot{' ' * bool(kind)}{kind}: ")
    assert "no such folder" in message and message.strip().count("\n") == 0


@pytest.mark.filterwarnings("ignore:fit:snapin.SnapinWarning")
def test_a_fit_is_drawn(command, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT / "inputs/examples")
    snapin.run(ROOT / "inputs/examples/fit.nml", out=tmp_path)
    assert command(["fit", str(tmp_path)]) == 0
    assert (tmp_path / "fit.png").stat().st_size > 0


def test_the_version_is_that_of_the_program(snapin_path):
    said = subprocess.run(
        [snapin_path, "--version"], capture_output=True, text=True, check=True).stdout
    assert said.split()[1] == snapin.__version__


def test_every_public_argument_has_a_type():
    """mypy checks the types themselves (pyproject.toml)."""
    for name in snapin.__all__:
        thing = getattr(snapin, name)
        if not inspect.isfunction(thing):
            continue
        hints = typing.get_type_hints(thing)
        assert set(hints) == {*inspect.signature(thing).parameters, "return"}, name
    assert (ROOT / "pywrap/snapin/py.typed").exists()
