"""Claims about what is said of a run before it begins. Times are those measured for such decks."""

import re

import pytest
from support.scenes import lennard_jones, loading

CYCLE = {"loading": loading(8, -4, 0.2)}
PATH = {"equilibrium_path": {"h0_end": -4.0}}
UNIT = {"s": 1, "min": 60, "h": 3600}


def uniform(nodes, **keys):
    return {"numerics": {"grid": "uniform", "nodes": nodes, **keys}}


def announced(snapin, folder, text, *options):
    """Seconds that a run is said to take; 0 where it is not announced."""
    (folder / "d.nml").write_text(text)
    done = snapin(*options, "d.nml", cwd=folder, timeout=60)
    assert done.returncode == 0, done.stderr
    said = re.search(r"may take ([\w ]+) or so", done.stderr)
    if not said:
        return 0
    return sum(int(n) * UNIT[unit] for n, unit in re.findall(r"(\d+) (s|min|h)\b", said[1]))


@pytest.mark.parametrize("sigma, groups, low, high", [
    # On grids far coarser than the neck nobody has seen the end: 100 s and more.
    pytest.param(9e5, {**CYCLE, **uniform(1000)}, 220, 1e9, id="uniform 1000 nodes, strong"),
    pytest.param(1e4, {**CYCLE, **uniform(300)}, 100, 1e9, id="uniform 300 nodes, strong"),
    # Measured at 36 and 155 s, on an idle and on a busy machine.
    pytest.param(1.0, {**CYCLE, **uniform(1500, method="newton")}, 35, 160, id="Newton"),
])
def test_a_run_of_more_than_half_a_minute_is_announced(snapin, tmp_path, sigma, groups, low, high):
    assert low <= announced(snapin, tmp_path, lennard_jones(sigma, **groups), "--check") <= high


@pytest.mark.parametrize("sigma, groups", [
    pytest.param(9e5, PATH, id="path, 7 s"),
    pytest.param(1e4, CYCLE, id="cycle, 1.5 s"),
    pytest.param(1.0, {**CYCLE, **uniform(500, method="newton")}, id="Newton, 6 s"),
    pytest.param(10.0, {**CYCLE, **uniform(300)}, id="uniform, 13 s"),
    pytest.param(1.0, {**CYCLE, **uniform(1000)}, id="uniform, 9 s"),
])
def test_a_run_of_some_seconds_is_not_announced(snapin, tmp_path, sigma, groups):
    assert announced(snapin, tmp_path, lennard_jones(sigma, **groups), "--check") == 0
