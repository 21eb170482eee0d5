"""Maps of many fits: what is in colour and what is grey, and the worst curves by name."""

import numpy as np
import pytest
from snapin.arguments import SnapinError
from snapin.plots.curve_map import draw_curve_map, draw_maps

NUMBERS = ("measurement.x", "measurement.y", "fitted_work_of_adhesion", "excess")
# A grid of 6 by 5 curves; a hill, a spike, and fits that describe nothing.
SHAPE, SPIKE, BAD, NONE = (5, 6), 8, 20, 21


def table():
    x, y = (1e-6 * of.ravel() for of in np.meshgrid(np.arange(6), np.arange(5)))
    kinds = [("measurement.file", "U9"), *((name, float) for name in NUMBERS),
             ("verdict", "U13"), ("warning", "U20"), ("failure", "U20")]
    rows = np.zeros(len(x), kinds)
    rows["measurement.file"] = [f"c{i}.csv" for i in range(len(x))]
    rows["measurement.x"], rows["measurement.y"] = x, y
    hill = np.exp(-((x - 4e-6) ** 2 + (y - 3e-6) ** 2) / 2e-12)
    rows["fitted_work_of_adhesion"] = 1e-3 * (1 + 0.02 * np.cos(7 * np.arange(len(x))) + hill)
    rows["verdict"] = "described"
    rows["fitted_work_of_adhesion"][SPIKE] = 1.0
    rows["verdict"][BAD], rows["excess"][BAD] = "not_described", 9.0
    rows["warning"][BAD] = "the residual"
    rows["verdict"][NONE], rows["failure"][NONE] = "refused", "no contact"
    rows["fitted_work_of_adhesion"][NONE] = rows["excess"][NONE] = np.nan
    return rows


def shown(rows, **options):
    """The values in colour of the first panel, in the order of the curves."""
    figure = draw_maps(rows, {"fitted_work_of_adhesion": "J/m^2"},
                       ["fitted_work_of_adhesion", "verdict"], **options)
    coloured = [of for of in figure.axes[0].collections if of.get_cmap().name == "viridis"]
    return figure, np.ma.filled(coloured[-1].get_array(), np.nan).ravel()


def test_outliers_and_fits_that_describe_nothing_are_not_in_colour():
    figure, values = shown(table())
    expected = 1e3 * table()["fitted_work_of_adhesion"]
    expected[[SPIKE, BAD, NONE]] = np.nan
    np.testing.assert_allclose(values, expected)
    assert any("mJ/m²" in axes.get_ylabel() for axes in figure.axes)
    assert any("grey: 3 of 30" in text.get_text() for text in figure.axes[0].texts)
    legend = {text.get_text() for text in figure.axes[1].get_legend().get_texts()}
    assert legend == {"described: 28", "not described: 1", "refused: 1"}


def test_the_order_of_the_curves_does_not_move_them():
    rows = np.random.default_rng(1).permutation(table())
    np.testing.assert_allclose(shown(rows)[1], shown(table())[1])


def test_places_that_are_no_grid_are_points():
    rows = table()[:-1]
    figure, values = shown(rows)
    assert len(values) <= len(rows)
    offsets = figure.axes[0].collections[-1].get_offsets()
    assert offsets[:, 0].max() == pytest.approx(5) and offsets[:, 1].max() == pytest.approx(4)


def test_without_places_the_number_of_columns_is_needed():
    rows = table()[[name for name in table().dtype.names if not name.startswith("measurement.")]]
    with pytest.raises(SnapinError, match="how many curves are in a row"):
        shown(rows)
    np.testing.assert_allclose(shown(rows, columns=6)[1], shown(table())[1])


def test_a_folder_is_drawn_and_its_worst_are_named(tmp_path, capsys):
    rows = table()
    names = rows.dtype.names
    lines = ["# title: ", "# measurement.x [m] a key", "# fitted_work_of_adhesion [J/m^2] it",
             ",".join(names)] + [",".join(map(str, row.tolist())) for row in rows]
    (tmp_path / "sweep.csv").write_text("\n".join(lines) + "\n")
    (tmp_path / "summary.nml").write_text("&summary\n  converged = .true.\n/\n&cost\n/\n")
    figure = draw_curve_map(tmp_path, worst=2)
    assert [axes.get_title() for axes in figure.axes[:2]] == ["work of adhesion", "verdict"]
    said = capsys.readouterr().out.splitlines()
    assert said == ["curve 22: measurement.file = c21.csv: refused; no contact",
                    "curve 21: measurement.file = c20.csv: not_described; the residual"]
    with pytest.raises(Exception, match="there is no column 'tabor'"):
        draw_curve_map(tmp_path, value=["tabor"])
