"""The plotting scripts: a picture from every kind of results, a clear message without them."""

import contextlib
import re
import shutil
import subprocess
import sys

import numpy as np
import pytest
import snapin
from conftest import ROOT
from support.pictures import BODIES, CYCLE, FORCE, PATH, SWEEP, size_of
from support.processes import HANG

pytest.importorskip("matplotlib")
from snapin.plots.device_curve import draw_device_curve  # noqa: E402 (needs matplotlib)
from snapin.plots.drawing import scale, smooth  # noqa: E402 (needs matplotlib)
from snapin.plots.fit import _numbers_of as numbers_of  # noqa: E402 (needs matplotlib)
from snapin.plots.force_curve import Curve, draw_force_curve  # noqa: E402 (needs matplotlib)
from snapin.plots.force_law import OTHERS  # noqa: E402 (needs matplotlib)
from snapin.plots.map import draw_map  # noqa: E402 (needs matplotlib)
from snapin.plots.profiles import draw_profiles  # noqa: E402 (needs matplotlib)

SCRIPTS = ROOT / "pywrap" / "plots"
DECKS = {
    "cycle": "&scene title = 'Cycle' /\n" + BODIES + FORCE + CYCLE
    + "&profiles h0 = 2e-9, 0e-9 /\n&classical /\n",
    "path": BODIES + FORCE + "&equilibrium_path h0_end = -1e-9 /\n&profiles h0 = 1.6e-9 /\n",
    "repulsion": BODIES + "&force law = 'exponential', p0 = 1e7, decay_length = 1e-9 /\n"
    "&loading h0_start = 4e-9, h0_end = 0e-9, h0_step = 1e-9 /\n&profiles h0 = 1e-9 /\n",
    "rigid": "&bodies radius = 1e-2, rigid = .true. /\n" + FORCE
    + "&loading h0_start = 4e-9, h0_end = 1e-9, h0_step = 1e-9 /\n&profiles h0 = 1e-9 /\n",
    "sweep": SWEEP,
    "map": BODIES + FORCE + PATH + "&sweep key = 'force.hamaker', "
    "'bodies.radius', from = 1e-21, 1e-3, to = 1e-20, 1e-1, count = 3, 9, scale = 'log' /\n",
    "three": BODIES + FORCE + PATH + "&sweep key = 'force.hamaker', "
    "'bodies.radius', 'bodies.stiffness', from = 1e-21, 1e-3, 1e9, to = 1e-20, 1e-1, 1e10, "
    "count = 3, 8, 2, scale = 'log' /\n",
    "words": BODIES + FORCE + PATH + "&sweep key = 'numerics.method', "
    "'force.hamaker', words = 'newton', 'anderson', values = 1e-21, 1e-20 /\n",
    "regime": BODIES + FORCE + "&equilibrium_path h0_end = -1e-9 /\n&regime /\n",
    "theories": BODIES + FORCE + "&classical h0_start = 1e-9, h0_end = -1e-9 /\n",
}


@pytest.fixture(scope="module")
def results(snapin, tmp_path_factory):
    folder = tmp_path_factory.mktemp("plots")
    for name, text in DECKS.items():
        (folder / f"{name}.nml").write_text(text)
    done = snapin("--quiet", "--out", folder, *(folder / f"{name}.nml" for name in DECKS))
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture
def plot(called):
    return lambda name, *args: called(SCRIPTS / name, *args)


@pytest.mark.slow
def test_a_script_is_a_command(results, tmp_path):
    command = [sys.executable, SCRIPTS / "profiles.py", results / "cycle", "-o", "here.png"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=HANG,
                          check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "here.png\n", "")
    assert size_of(tmp_path / "here.png")[0] == 1350


@pytest.mark.parametrize("script", ["force_curve", "profiles"])
@pytest.mark.parametrize("deck", ["cycle", "path", "repulsion", "rigid"])
def test_a_picture_appears_in_the_folder(plot, results, script, deck):
    done = plot(f"{script}.py", results / deck)
    picture = results / deck / f"{script}.png"
    assert (done.returncode, done.stdout) == (0, f"{picture}\n"), done.stderr
    assert done.stderr == ""
    width, height = size_of(picture)
    assert width == 1350 and 600 <= height <= 750
    assert 2e4 < picture.stat().st_size < 3e5


def test_the_map_of_theories_shows_the_scene(plot, results):
    done = plot("regime.py", results / "regime")
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert size_of(results / "regime" / "regime.png") == (930, 690)


@pytest.mark.parametrize("args", [
    ("map",), ("sweep",), ("map", "--value", "jump_in_h0"),
    ("map", "--value", "max_tension", "--per", "jkr_pull_off", "--over", "tabor"),
    ("map", "--over", "bodies.radius", "force.hamaker"), ("map", "--over", "bodies.radius"),
    ("three", "--where", "bodies.stiffness=3e9"), ("three", "--over", "force.hamaker"), ("words",),
])
def test_sweeps_are_drawn_as_maps_and_curves(plot, results, tmp_path, args):
    done = plot("map.py", results / args[0], *args[1:], "-o", "map.png")
    assert (done.returncode, done.stderr) == (0, ""), done.stderr
    assert size_of(tmp_path / "map.png") == (960, 690)


def test_nothing_is_drawn_where_a_column_has_no_value(tmp_path):
    """Colours end at cases that have no value, and do not span them."""
    rows = [f"{i},{j},1,{'nan' if 3 <= i <= 6 else i + j},\n" for i in range(10) for j in range(10)]
    (tmp_path / "sweep.csv").write_text(
        "# title: \na.x,a.y,converged,max_tension,failure\n" + "".join(rows))
    (tmp_path / "summary.nml").write_text("&summary\n  converged = .true.\n/\n&cost\n/\n")
    (axes, _) = draw_map(tmp_path).axes
    corners = axes.collections[0].get_paths()
    spans = [path.vertices[:, 0] for path in corners]
    assert spans and all(max(x) <= 2 or min(x) >= 7 for x in spans)


def test_the_panels_of_springs_share_the_loads_of_all(tmp_path):
    """The loads of the last spring were shown in all panels; a dead load, which never lands after
    its jump, had no picture."""
    with pytest.warns(snapin.SnapinWarning, match="no stable state is known that catches"):
        snapin.run(BODIES + FORCE + "&equilibrium_path h0_end = -1e-9 /\n"
                   "&device stiffness = 1e5, 0 /", out=tmp_path)
    figure = draw_device_curve(tmp_path)
    figure.savefig(tmp_path / "here.png")
    for axes in figure.axes:
        low, high = axes.get_ylim()
        assert low < -60.7 and high > 0
    # The label in the second panel touched the curve of the first.
    assert [axes.get_ylabel() for axes in figure.axes] == ["load [\N{MICRO SIGN}N]", ""]


def test_a_title_is_drawn_as_it_is_written_and_inside_the_picture(tmp_path):
    """Text between dollars became a formula, or a message, and long titles were cut off."""
    title = "What $\\nothing$ and _all_ cost: " + 12 * "a long title "
    snapin.run(f"&scene title = '{title}' /\n" + DECKS["path"], out=tmp_path)
    figure = draw_force_curve(tmp_path)
    figure.draw_without_rendering()
    (shown,) = figure.texts
    # The summary has no text that begins as a group of a namelist.
    assert shown.get_text().split() == title.replace("$", "$ ", 1).split()
    box, edge = shown.get_window_extent(), figure.bbox
    assert box.x0 > edge.x0 and box.x1 < edge.x1 and box.y1 <= edge.y1


def test_a_step_to_zero_is_zero_in_the_colour_bar(tmp_path):
    """It was -8.272e-16 nm."""
    snapin.run(BODIES + FORCE + "&loading h0_start = 7e-9, h0_end = -2e-9, h0_step = 0.2e-9 /\n"
               "&profiles h0 = 1e-9, 0 /", out=tmp_path)
    labels = [tick.get_text() for tick in draw_profiles(tmp_path).axes[-1].get_yticklabels()]
    assert labels == ["0", "1"]


def test_the_picture_can_be_elsewhere_and_larger(plot, results, tmp_path):
    done = plot("profiles.py", results / "cycle", "-o", "here.png", "--dpi", 300, "--branch",
                "unloading_2")
    assert done.returncode == 0, done.stderr
    assert size_of(tmp_path / "here.png")[0] == 2700


@pytest.mark.parametrize(("args", "phrase"), [
    (("force_curve.py", "nowhere"), "no such folder"),
    (("force_curve.py", "theories"), "no curve.csv in .*neither &loading nor"),
    (("force_curve.py", "sweep"), "no curve.csv in .*&sweep"),
    (("regime.py", "theories"), "deck needs &regime"),
    (("map.py", "theories"), "no sweep.csv in .*&sweep"),
    (("map.py", "sweep", "--value", "speed"), "no column 'speed'; it has force.hamaker"),
    (("map.py", "sweep", "--value", "failure"), "failure has words and cannot be drawn"),
    (("map.py", "three"), "bodies.stiffness was swept too: .*--where bodies.stiffness=VALUE"),
    (("map.py", "map", "--where", "bodies.size=1"), "is not KEY=VALUE; keys are force.hamaker"),
    (("map.py", "words", "--where", "numerics.method=mixing"), "has anderson, newton"),
    (("map.py", "map", "--over", "jkr_pull_off", "dmt_pull_off"), "lie on one line"),
    (("profiles.py", "theories"), "no profiles.csv in .*no &profiles group"),
    (("profiles.py", "cycle", "--branch", "path"), "loading, unloading_1, unloading_2"),
    (("force_curve.py", "cycle", "-o", "no/such/folder.png"), "no/such"),
    (("force_curve.py", "cycle", "-o", "here.xyz"), "here.xyz: Format 'xyz' is not supported"),
    (("map.py", "map", "--dpi", "0"), "dpi must be positive"),
    (("map.py", "map", "--per", "big_lambda"),
     "no case has the column 'max_tension' and the column 'big_lambda'"),
])
def test_what_is_missing_is_said_in_one_line(plot, results, args, phrase):
    done = plot(args[0], results / args[1], *args[2:])
    assert done.returncode == 1
    assert re.fullmatch(rf"{args[0]}: .*{phrase}.*\n", done.stderr), done.stderr


def test_a_curve_is_smoothed_through_its_points():
    angle = np.linspace(0, np.pi, 9)
    circle = np.column_stack([np.cos(angle), 2 * np.sin(angle)])
    curve = smooth(circle)
    assert len(curve) > 50
    for point in circle:
        assert abs(curve - point).max(axis=1).min() < 1e-15
    assert abs(np.hypot(curve[:, 0], curve[:, 1] / 2) - 1).max() < 5e-3


def test_a_corner_stays_a_corner():
    zigzag = np.array([[0, 0], [1, 1], [2, 0], [3, 1.0]])
    np.testing.assert_array_equal(smooth(zigzag), zigzag)


@pytest.mark.parametrize(
    ("largest", "factor", "unit"),
    [(6e-5, 1e-6, "µN"), (8e-10, 1e-9, "nN"), (3e-10, 1e-12, "pN"), (0, 1, "N"), (2, 1, "N")],
)
def test_units_keep_numbers_short(largest, factor, unit):
    assert scale([-largest, np.nan], "N") == (factor, unit)


def test_files_without_a_summary_are_not_drawn(plot, results, tmp_path):
    """A run that is stopped while it replaces results leaves tables of which nothing is known."""
    shutil.copytree(results / "cycle", tmp_path / "cycle")
    (tmp_path / "cycle/summary.nml").unlink()
    done = plot("force_curve.py", tmp_path / "cycle")
    assert done.returncode != 0
    assert "no summary.nml in" in done.stderr


@pytest.mark.slow
def test_a_law_is_drawn_beside_its_curve(plot, tmp_path):
    """A table's file is looked for beside the deck, wherever the command is given."""
    for name in ("tabulated", "van_der_waals"):
        deck = ROOT / "inputs" / "examples" / f"{name}.nml"
        done = plot("law_and_curve.py", deck, "-o", "here.png")
        assert (done.returncode, done.stdout) == (0, "here.png\n"), done.stderr
        assert size_of(tmp_path / "here.png") == (1350, 585)
    done = plot("law_and_curve.py", "nowhere.nml")
    assert done.returncode == 1 and "nowhere.nml" in done.stderr


def test_a_curve_does_not_swing_between_uneven_steps():
    # A load near its maximum and, after a much longer step, at a fold.
    h0 = np.array([60.0, 30.0, 10.0, 1.5, 1.25, 1.0, 0.84])
    load = np.array([0.0, 0.1, 4.2, 57.7, 59.0, 58.2, 45.4])
    curve = smooth(np.column_stack([h0, load]))
    assert len(curve) > len(h0)
    assert (np.diff(curve[:, 0]) <= 0).all()


def test_a_curve_ends_at_its_fold_where_the_load_is_level_before(tmp_path):
    """The load of a barrier has its maximum just before the fold; the displacement at the fold,
    extrapolated in the load, was 9.5 nm instead of -0.16 nm."""
    results = snapin.run((ROOT / "inputs/examples/hydration.nml").read_text(), out=tmp_path)
    path = results.curve[results.curve["branch"] == "path"]
    span = np.ptp(path["displacement"])
    drawn = {branch.name: branch.jumps for branch in Curve(tmp_path).branches}
    for name in ("loading", "unloading_1"):
        ((start, _),) = drawn[name]
        fold = np.argmin(abs(path["load"] / start["load"] - 1) + abs(path["h0"] / start["h0"] - 1))
        assert abs(start["displacement"][0] - path["displacement"][fold]) < 0.01 * span


def test_a_drive_has_its_own_branches_and_units(tmp_path):
    """Its ways were all "unloading 0", and displacements of picometres in micrometres."""
    snapin.run("&bodies radius = 1e-5, stiffness = 7e10 /\n"
               "&force law = 'lennard_jones', z0 = 0.3e-9, surface_energy = 5e-3 /\n"
               "&drive velocity = 2e-5, z_start = 1e-6, z_turn = -5e-9, stiffness = 10 /\n"
               "&numerics accuracy = 1e-3 /", out=tmp_path)
    figure = draw_force_curve(tmp_path)
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["approach", "retract"]
    assert [axes.get_xlabel()[-5:] for axes in figure.axes] == [" [pm]", " [µm]"]


def test_the_forces_of_every_deck_are_drawn(plot, snapin, tmp_path):
    """A group that the picture of forces did not know was taken for a force: a deck with layers, a
    fluid or a drive had no picture."""
    groups = set(re.findall(r"^&(\w+)", snapin("--keys").stdout, re.MULTILINE))
    laws = {law.stem for law in (ROOT / "src/model/laws").glob("*.f90")}
    assert groups - OTHERS == laws - {"lennard_jones", "exponential"} | {"force"}
    decks = [ROOT / f"inputs/examples/{name}.nml" for name in ("drainage", "morse")]
    done = plot("force_law.py", *decks, "--out", "here")
    # The picture of the second deck replaced that of the first.
    pictures = [f"here/{deck.stem}/force_law.png" for deck in decks]
    assert (done.returncode, done.stdout.split()) == (0, pictures), done.stderr
    assert all((tmp_path / picture).exists() for picture in pictures)


@pytest.mark.parametrize("deck", [b"&bodies radius = 1\n", b"\xf7\n"], ids=["open", "bytes"])
def test_a_deck_that_cannot_be_read_has_no_picture_of_forces(plot, tmp_path, deck):
    (tmp_path / "d.nml").write_bytes(deck)
    done = plot("force_law.py", "d.nml")
    assert done.returncode == 1
    assert re.fullmatch(r"force_law.py: d.nml: .*\n", done.stderr), done.stderr


def test_largest_tensions_at_an_end_are_no_pull_offs_in_pictures(tmp_path):
    """They were part of the colours, of the curves and of quotients with JKR theory."""
    head = "# title:\na.x,a.y,converged,jkr_pull_off,max_tension,max_tension_at_end,failure\n"
    (tmp_path / "summary.nml").write_text("&summary\n  converged = .true.\n/\n&cost\n/\n")

    def table(rows):
        (tmp_path / "sweep.csv").write_text(head + "".join(rows))

    table(f"{i},{j},1,2,{i + j + 1},{int(i > 5)},\n" for i in range(10) for j in range(10))
    for per in (None, "jkr_pull_off"):
        figure = draw_map(tmp_path, per=per)
        axes = figure.axes[0]
        assert all(path.vertices[:, 0].max() <= 5 for path in axes.collections[0].get_paths())
        (circles,) = [line for line in axes.lines if "no pull-off" in str(line.get_label())]
        assert set(circles.get_xdata()) == {6, 7, 8, 9}
        assert "no pull-off" in figure.legends[0].get_texts()[0].get_text()
    table(f"{i},0,1,2,{i + 1},{int(i > 5)},\n" for i in range(10))
    axes = draw_map(tmp_path, over=["a.x"]).axes[0]
    assert max(axes.lines[0].get_xdata()) == 5
    # Other values of these cases are good.
    axes = draw_map(tmp_path, value="jkr_pull_off", over=["a.x"]).axes[0]
    assert max(axes.lines[0].get_xdata()) == 9
    table(f"{i},0,1,2,{i + 1},1,\n" for i in range(10))
    with pytest.raises(snapin.results.ResultsError, match="no pull-offs"):
        draw_map(tmp_path, over=["a.x"])


def test_a_fitted_number_is_in_the_picture_once_in_the_words_of_the_field():
    fit = {"parameters": ["bodies.young(2)", "measurement.contact_point"], "units": ["Pa", "m"],
           "estimate": [8.19e8, 3.2e-6], "standard_error": [1.6e7, 1e-10],
           "young_of_sample": [8.19e8], "young_of_sample_error": [1.6e7]}
    names = [line.split(" 0.")[0].split(" 3.")[0] for line in numbers_of(fit)]
    assert names == ["contact point", "Young's modulus of the sample"]


def test_a_map_may_have_values_over_many_decades_or_no_two_neighbours(tmp_path):
    """Over eighteen decades there were no contours, and the colour bar failed."""
    (tmp_path / "summary.nml").write_text("&summary\n  converged = .true.\n/\n&cost\n/\n")
    head = "# title:\na.x,a.y,converged,max_tension,failure\n"
    rows = [(10.0**i, 10.0**j, 1, 10.0**(i + j)) for i in range(10) for j in range(10)]
    lone = [(i, j, int(i == j == 9), i + j) for i in range(10) for j in range(10)]
    for cases, lines in ((rows, 4), (lone, 0)):
        (tmp_path / "sweep.csv").write_text(
            head + "".join(",".join(map(str, case)) + ",\n" for case in cases))
        figure = draw_map(tmp_path)
        figure.savefig(tmp_path / "map.png")
        drawn = [of for of in figure.axes[0].collections if type(of).__name__ == "TriContourSet"]
        assert len([path for of in drawn for path in of.get_paths() if len(path)]) >= lines


def test_a_map_ends_where_its_logarithmic_axis_begins_and_has_no_comb_there(tmp_path):
    """Where the next case was negative, the whole cell was left out: the lower edge was a comb."""
    (tmp_path / "summary.nml").write_text("&summary\n  converged = .true.\n/\n&cost\n/\n")

    def down(i, j):
        """Falls through zero along each line of the sweep, at another place in each."""
        return 30 * (20 - j) ** 2 / 20 + 0.01 - 0.37 * i - (j > 18)

    rows = [f"{i},{j},1,{i + 1},{down(i, j)},{i + j + 1},\n" for i in range(20) for j in range(21)]
    (tmp_path / "sweep.csv").write_text(
        "# title:\na.x,a.y,converged,across,down,max_tension,failure\n" + "".join(rows))
    axes = draw_map(tmp_path, over=["across", "down"]).axes[0]
    (mesh,) = [of for of in axes.collections if hasattr(of, "_triangulation")]
    places = mesh._triangulation
    corners = places.y[places.triangles]
    begin = corners.min()
    # Each line of cases, and each cell between two of them, comes down to the begin of the axis.
    for left in np.arange(1, 20):
        inside = (places.x[places.triangles] >= left).all(axis=1) & (
            places.x[places.triangles] <= left + 1).all(axis=1)
        assert corners[inside].min() == pytest.approx(begin), left
        for side in (left, left + 1):
            at = inside[:, None] & (places.x[places.triangles] == side)
            assert corners[at].min() == pytest.approx(begin), (left, side)
    assert begin == round(begin)


def test_a_curve_that_ends_before_its_pull_off_has_a_mark(tmp_path):
    for h0_end, marked in ((1.3e-9, True), (-2e-9, False)):
        deck = BODIES + FORCE + f"&loading h0_start = 7e-9, h0_end = {h0_end}, h0_step = 0.2e-9 /\n"
        with contextlib.ExitStack() as stack:
            if marked:
                stack.enter_context(pytest.warns(snapin.SnapinWarning, match="no pull-off"))
            snapin.run(deck, out=tmp_path / str(marked))
        figure = draw_force_curve(tmp_path / str(marked))
        texts = [text.get_text() for text in figure.legends[0].get_texts()]
        assert any("no pull-off" in text for text in texts) == marked


def test_theories_touch_at_the_equilibrium_separation(tmp_path):
    """Only those for the Lennard-Jones law did: others had its length added twice."""
    for name, groups in (("lennard_jones", FORCE), (
            "morse", "&morse work_of_adhesion = 8e-4, z0 = 2e-9, decay_length = 4e-10 /\n")):
        snapin.run(BODIES + groups + "&equilibrium_path h0_end = -2e-9 /\n&classical /\n",
                   out=tmp_path / name)
        curve = Curve(tmp_path / name)
        hertz = curve.theories["theory"] == "hertz"
        touching = np.argmax(curve.theories["h0"][hertz])
        assert curve.theories["load"][hertz][touching] < 1e-2*curve.theories["load"].max()
        step = abs(np.diff(curve.theories["h0"][hertz])).max()
        assert abs(curve.theories["h0"][hertz][touching] - curve.summary["rest_gap"]) <= step


def test_theories_of_layers_are_drawn(tmp_path):
    snapin.run((ROOT / "inputs/examples/layers.nml").read_text(), out=tmp_path)
    names = {text.get_text() for text in draw_force_curve(tmp_path).legends[0].get_texts()}
    assert {"Hertz, layered", "JKR, layered"} <= names
