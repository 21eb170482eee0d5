"""Fits of many curves in memory: the records are those of single fits, whatever is among them."""

import numpy as np
import pytest
import snapin
from support.measured import (  # noqa: F401 (`branches` is a fixture)
    LENNARD_JONES, POINT, SPRING, STRENGTH, branches)

PARAMETERS = [STRENGTH, POINT]
PLACES = [(x, y) for y in (0.0, 2e-6) for x in (0.0, 1e-6)]


@pytest.fixture(scope="module")
def curves(branches):  # noqa: F811
    return [branches.measure(100, noise=1e-11, seed=i) for i in range(4)]


def fit_many(curves, **changed):
    return snapin.fit_many(curves, **{"spring_constant": SPRING, "deck": LENNARD_JONES,
                                      "parameters": PARAMETERS, **changed})


@pytest.fixture(scope="module")
def found(curves):
    return fit_many(curves, places=PLACES)


def test_each_record_is_that_of_the_curve_alone(found, curves):
    assert len(found) == len(found.records()) == 4 and found.described.all()
    for i in (0, 3):
        z, force, segment = curves[i]
        alone = snapin.fit(z, force, segment=segment, spring_constant=SPRING, deck=LENNARD_JONES,
                           parameters=PARAMETERS)
        record = found[i]
        for name in PARAMETERS:
            error = alone.standard_error[name]
            assert record[f"{name}_estimate"] == pytest.approx(
                alone.estimate[name], abs=0.02 * error)
            assert found.standard_error[name][i] == pytest.approx(error, rel=0.02)
            assert found.estimate[name][i] == record[f"{name}_estimate"]
            assert tuple(found.interval_95[name][i]) == pytest.approx(
                alone.interval_95[name], abs=0.05 * error)
        assert record["verdict"] == "described" and record["failure"] == ""


def test_what_is_no_curve_is_a_record_with_the_reason(found, curves):
    """Curves may come one by one, and the good ones have the same numbers."""
    mixed = [curves[0], ([1.0, 2.0], [1.0], [0, 1]), "curve", ([], [], []), *curves[1:]]
    some = fit_many(iter(mixed))
    assert list(some.table["verdict"][1:4]) == ["unreadable"] * 3
    assert "must be equal" in some[1]["failure"]
    assert "without samples" in some[3]["failure"]
    assert np.isnan(some.estimate[STRENGTH][1:4]).all()
    good = [0, 4, 5, 6]
    np.testing.assert_array_equal(some.estimate[STRENGTH][good], found.estimate[STRENGTH])
    assert set(some.worst(3)) == {1, 2, 3}


def test_keys_may_differ_from_curve_to_curve(found, curves):
    """Forces come from deflections: a sensitivity twice as large gives twice the strength."""
    volts = [(z, force / SPRING / 1e-8, segment) for z, force, segment in curves[:2]]
    some = fit_many(volts, sensitivity=1e-8, each={"measurement.sensitivity": [1e-8, 1.1e-8]},
                    spring_constant=[SPRING, SPRING])
    assert some.estimate[STRENGTH][0] == pytest.approx(found.estimate[STRENGTH][0], rel=1e-3)
    assert some.estimate[STRENGTH][1] > 1.05 * found.estimate[STRENGTH][1]


def test_places_on_a_grid_make_a_map_with_units(found):
    xarray = pytest.importorskip("xarray")
    data = found.to_xarray()
    assert isinstance(data, xarray.Dataset) and dict(data.sizes) == {"y": 2, "x": 2}
    name = f"{STRENGTH}_estimate"
    assert data[name].attrs["units"] == "J" and data.x.attrs["units"] == "m"
    assert float(data[name].sel(x=1e-6, y=0.0)) == found.estimate[STRENGTH][1]
    assert str(data["verdict"].sel(x=0.0, y=2e-6).item()) == "described"


def test_without_places_the_dimension_is_the_curve(curves):
    pytest.importorskip("xarray")
    data = fit_many(curves[:2]).to_xarray()
    assert dict(data.sizes) == {"curve": 2} and "x" not in data.coords


@pytest.mark.parametrize(("changed", "error", "told"), [
    ({"each": {"bodies.radius": [1e-6]}}, ValueError, "bodies.radius: 4 numbers"),
    ({"deck": {**LENNARD_JONES, "sweep": {"key": "force.z0"}}}, snapin.DeckError,
     "&sweep is made of the arguments of fit_many"),
    ({"parameters": ["force.strength", POINT]}, snapin.DeckError, "force.strength"),
])
def test_wrong_arguments_are_refused(curves, changed, error, told):
    with pytest.raises(error, match=told):
        fit_many(curves, **changed)


def test_no_curve_at_all_is_refused_with_the_reason():
    with pytest.raises(snapin.SnapinError, match="there is no curve; the first: z: one dimension"):
        fit_many([([[1.0]], [[1.0]])])


def test_an_interrupted_folder_goes_on(found, curves, tmp_path):
    one = fit_many(curves, out=tmp_path / "map")
    again = fit_many(curves, out=tmp_path / "map", resume=True)
    np.testing.assert_array_equal(one.estimate[STRENGTH], again.estimate[STRENGTH])
    assert (tmp_path / "map/sweep.csv").is_file()
