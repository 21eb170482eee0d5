"""Claims about the rows of the equilibrium path: straight lines through them show the curve."""

import numpy as np
import pytest
from support.scenes import lennard_jones, path_of

COLUMNS = ("h0", "load", "contact_radius", "displacement")
SIGMAS = [1e-4, 0.0087, 0.3, 0.87, 8.7, 100.0, 1e4]
# Half a per cent of the range of each column.
ALLOWED = 0.005


# A punch touches at its rim before its axis does.
PUNCH = {"shape": {"kind": "rounded_punch", "flat_radius": 4.0}}


def scene(sigma, **groups):
    """A path that ends as far in contact as its jumps are from it."""
    end = -1.5 - 0.8 * sigma ** (2 / 3)
    return lennard_jones(sigma, equilibrium_path={"h0_end": end},
                         numerics={"accuracy": 1e-6}, **groups)


def distances(points, line):
    """The distance of each point (columns) from a line through given places (columns)."""
    begin, way = line[:, :-1], np.diff(line)
    from_begin = points[:, :, None] - begin[:, None, :]
    along = (from_begin * way[:, None, :]).sum(axis=0) / (way**2).sum(axis=0)
    nearest = from_begin - np.clip(along, 0, 1) * way[:, None, :]
    return np.sqrt((nearest**2).sum(axis=0)).min(axis=1)


def states_at(run, sigma, wanted, **groups):
    """The states of the path at given h0, each solved at that h0 by itself."""
    curve = run(scene(sigma, profiles={"h0": [float(h0) for h0 in wanted]}, **groups)).curve
    mine = np.isclose(curve["h0"][:, None], wanted, rtol=1e-12, atol=1e-12).any(axis=1)
    assert mine.sum() >= len(wanted)
    return {name: curve[name][mine] for name in COLUMNS}


@pytest.mark.parametrize(("sigma", "shape"), [
    *((sigma, {}) for sigma in SIGMAS), (3.0, PUNCH), (30.0, PUNCH)])
def test_lines_between_rows_are_the_curve_to_half_a_per_cent(run, sigma, shape):
    result = run(scene(sigma, **shape))
    curve, low = result.curve, result.curve["h0"].min()
    near, far = min(8.0, 0.5 * curve["h0"][0]), curve["h0"][0]
    wanted = [*np.linspace(low, near, 41)[1:], *np.geomspace(near, far, 9)[1:-1]]
    folds = result.summary.get("folds_h0", [])
    if folds:
        # Between the jumps, and as near to each of them as a picture shows.
        reach = max(folds) - min(folds)
        wanted += [*np.linspace(min(folds), max(folds), 22)[1:-1]]
        wanted += [fold + part * reach for fold in folds for part in (-0.01, -0.001, 0.001, 0.01)]
    found = states_at(run, sigma, wanted, **shape)
    for other in COLUMNS[1:]:
        pair = [curve["h0"], curve[other]]
        scale = [[np.ptp(column)] for column in pair]
        away = distances([found["h0"], found[other]] / np.array(scale), pair / np.array(scale))
        assert away.max() < ALLOWED, (other, found["h0"][away.argmax()])


@pytest.mark.parametrize("sigma", SIGMAS)
def test_before_the_jump_the_load_can_be_read_between_rows(run, sigma):
    """Relative to itself: far apart it is a small part of the range, and yet looked at."""
    curve = run(scene(sigma)).curve
    rising = np.flatnonzero(np.diff(curve["h0"]) > 0)
    before = slice(None, rising[0] + 1 if rising.size else None)
    h0, load = curve["h0"][before][::-1], curve["load"][before][::-1]
    nearest = max(1.1 * h0[0], 3.0)
    found = states_at(run, sigma, np.geomspace(nearest, 0.9 * h0[-1], 30))
    outside = (found["load"] < 0) & (found["contact_radius"] == 0) & (found["h0"] >= nearest)
    # The unstable branches of large sigma pass these h0 too, with other loads.
    outside &= found["h0"] + found["displacement"] > 2.5
    read = np.interp(found["h0"][outside], h0, load)
    np.testing.assert_allclose(read, found["load"][outside], rtol=0.015)


@pytest.mark.parametrize("sigma", SIGMAS)
def test_every_row_is_an_equilibrium_and_there_are_not_too_many(run, sigma):
    result = run(scene(sigma))
    curve = result.curve
    assert len(curve) == result.cost["states"]
    assert 30 < len(curve) < 300
    # 1e-10 at this accuracy, or what rounding leaves where thousands of lengths cancel: three units
    # in the last place of parts that add up to three times h0.
    assert curve["residual"].max() <= max(1e-10, 2e-12 * abs(curve["h0"]).max())
    assert set(curve["stable"]) <= {0, 1}
    # No row doubles another, and none is out of order: the gap on the axis only falls.
    before_contact = curve["h_centre"] > 1.3
    assert (np.diff(curve["h_centre"][before_contact]) < 0).all()
    in_contact = curve["contact_radius"] > 1
    assert before_contact.sum() > 10 and in_contact.sum() > 10
    assert (np.diff(curve["contact_radius"][in_contact]) > 0).all()


def test_rows_go_one_way_where_meshes_change_from_step_to_step(run):
    """The maximum of h0 at the jump lies where bands of radii are narrower than steps."""
    bent = path_of(
        14352191095.1, 0.5e-9, 1e-3, radius=5e-6, dugdale={"stress": 1e7, "range": 7.051402e-10},
        structural={"amplitude": 2727574.58541, "period": 1.084323267e-9, "decay_length": 1e-9})
    curve = run(bent).curve
    centre, stable = curve["h_centre"], curve["stable"]
    # The gap on the axis is a coordinate of the path, and between its two folds nothing is stable.
    assert (np.diff(centre) < 0).all()
    assert np.count_nonzero(np.diff(stable)) == 2
