"""Claims about the examples that --keys prints: every group has one, and it works in a deck."""

import re
import shutil

import numpy as np
import pytest
from conftest import ROOT

# Groups that stand in every deck here, unless the group replaces one of them.
COMMON = ("bodies", "force", "equilibrium_path")
BESIDE = {
    "unloading": ("loading",), "fluid": ("drive",), "viscoelastic": ("drive",),
    "measurement": ("fit",), "fit": ("measurement",)}
# Laws with a group of their own stand in place of &force; most need attraction and repulsion.
LAWS = {path.stem for path in (ROOT / "src/model/laws").glob("*.f90")}
ALONE = {"morse", "tabulated"}


@pytest.fixture(scope="module")
def examples(snapin):
    text = snapin("--keys").stdout
    return dict(re.findall(r"^&(\w+)(?! \(skipped).*\n    .*\n    Example: (.*)$", text, re.M))


def test_every_group_has_an_example(snapin, examples):
    groups = re.findall(r"^&(\w+)(?! \(skipped)(?: \(required\))?$", snapin("--keys").stdout, re.M)
    assert len(groups) > 30 and [*examples] == groups
    for group, example in examples.items():
        assert re.fullmatch(rf"&{group}\b.* /", example)


def deck_for(group, examples):
    """A deck with the example of a group and what it needs, all of them examples."""
    groups = [name for name in COMMON
              if name != group and not (name == "force" and group in LAWS)
              and not (name == "equilibrium_path" and (
                  group == "drive" or "drive" in BESIDE.get(group, ())))]
    if group in LAWS - ALONE:
        groups += ["van_der_waals", "born"]
    return "\n".join(examples[name] for name in dict.fromkeys(
        [*groups, *BESIDE.get(group, ()), group])) + "\n"


def write_files(folder):
    """The files that examples name: a law of force, and a curve without noise to be fitted."""
    shutil.copy(ROOT / "inputs/examples/tabulated.txt", folder / "law.txt")
    z = np.linspace(-2e-8, 1e-7, 200)
    force = np.where(z < 0, -40*z, 0.0)
    both = np.concatenate([z[::-1], z]), np.concatenate([force[::-1], force])
    rng = np.random.default_rng(7)
    np.savetxt(folder / "curve.csv", np.column_stack([
        *both, np.repeat([0, 1], z.size)]) + [0, 1, 0]*rng.normal(0, 1e-9, (2*z.size, 1)),
        delimiter=",", header="z [m],force [N],segment", comments="")


@pytest.mark.slow
def test_every_example_works(snapin, examples, tmp_path):
    write_files(tmp_path)
    for group in examples:
        (tmp_path / f"{group}.nml").write_text(deck_for(group, examples))
    # A fit needs a curve of these bodies; whether there is one is not what is tested here.
    fits = {"fit", "measurement"}
    done = snapin("--check", *(f"{group}.nml" for group in examples), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    done = snapin("--quiet", "--out", "r", *(f"{group}.nml" for group in examples
                                            if group not in fits), cwd=tmp_path)
    assert done.returncode == 0, done.stderr
