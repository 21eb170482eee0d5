"""Claims about help(snapin): its examples work."""

import textwrap

import snapin
from conftest import ROOT


def test_the_examples_of_the_package_work(tmp_path, monkeypatch):
    (tmp_path / "inputs").mkdir()
    (tmp_path / "inputs/first.nml").write_text((ROOT / "inputs/first.nml").read_text())
    monkeypatch.chdir(tmp_path)
    blocks, block = [], []
    for line in snapin.__doc__.splitlines():
        if line.startswith("    "):
            block.append(line)
        elif block:
            blocks.append(textwrap.dedent("\n".join(block)))
            block = []
    first, more = blocks
    names = {}
    exec(first, names)  # noqa: S102 (an example of ours)
    assert 6.071e-5 < names["result"].summary["max_tension"] < 6.072e-5
    ran = 0
    for line in more.splitlines():
        # An example with dots has a curve of the reader.
        if "..." not in line:
            exec(line, names)  # noqa: S102
            ran += 1
    assert ran == 4
    assert (tmp_path / "results/first/curve.csv").is_file()
