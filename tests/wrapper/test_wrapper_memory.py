"""Claims about memory: nothing leaks, in calls that succeed and in calls that fail, and what does
not fit is refused with the size that it needs."""

import contextlib
import re
import resource
import shutil
import warnings

import numpy as np
import pytest
import snapin
from support.processes import answer
from support.wrapper_registry import LAW, REGISTRY, UNIT, law_of
from support.wrapper_values import REFUSED, cases

CALLS = 50
# What a process may grow by over so many calls [bytes]: pages of the allocator here and there. A
# leak of 656 bytes a call shows.
GROWTH = 32 * 1024


def resident():
    with open("/proc/self/statm", encoding="ascii") as table:
        return int(table.read().split()[1]) * resource.getpagesize()


def large(entry):
    """The entry's good arguments with long vectors, so that a leak of one cannot hide."""
    good = dict(entry.good)
    if entry.call in (snapin.force_law, snapin.slow_deformation, snapin.profile):
        for name in {"gap", "r"} & set(good):
            good[name] = np.linspace(4.0, 6.0, 5000)
    return good


def bad_calls(entry):
    """Arguments that are refused, one for each kind of refusal of the first few arguments."""
    for name, kind in list(entry.kinds.items())[:4]:
        for label, value, clean in cases(kind, entry.good[name], every=False):
            if clean is REFUSED and label not in ("huge", "enormous", "None", "generator"):
                yield {**entry.good, name: value}


def growth(call):
    """Memory [bytes] by which the process grows over CALLS calls, after some others."""
    for _ in range(CALLS // 3):
        call()
    before = resident()
    for _ in range(CALLS):
        call()
    return resident() - before


def grows(call):
    """Whether the process grows in each of three counts; what others hold meanwhile is no leak."""
    return all(growth(call) > GROWTH for _ in range(3))


@pytest.mark.parametrize("name", REGISTRY)
@pytest.mark.filterwarnings("ignore::snapin.SnapinWarning")
def test_calls_do_not_leak(name):
    entry = REGISTRY[name]
    arguments = large(entry)
    assert not grows(lambda: entry.call(**arguments))


@pytest.mark.parametrize("name", [name for name in REGISTRY if REGISTRY[name].kinds])
def test_calls_that_are_refused_do_not_leak(name):
    entry = REGISTRY[name]
    wrong = list(bad_calls(entry))
    step = iter(range(10**9))

    def call():
        with contextlib.suppress(ValueError, TypeError):
            entry.call(**wrong[next(step) % len(wrong)])

    assert not grows(call)


@pytest.mark.parametrize("call", [
    # Ends early, does not converge, is refused by the library.
    lambda: snapin.force_curve([4.0, 0.0], **UNIT, law=law_of(1.0, "attractive")),
    lambda: snapin.force_curve([-1.0, -2.0], radius=1.0, rigid=True, law=law_of(1.0)),
    lambda: snapin.force_curve([3.0, 2.0], **UNIT, law=law_of(0.1), nodes=1),
    lambda: snapin.equilibrium_path(-1.0, radius=1.0, rigid=True, law=law_of(1.0)),
    lambda: snapin.run({"bodies": {"radius": -1, "frog": "x"}, "dog": True}),
    lambda: snapin.run({**law_of(1.0), "bodies": UNIT}, out="/dev/null/folder"),
    lambda: snapin.contact_radius("dmt", "edge_ratio", [2.0], **UNIT, surface_energy=1.0),
    lambda: snapin.equilibrium(LAW, snapin.uniform_mesh(50, 5.0), 0.0, 9.0, most_iterations=2),
])
def test_calculations_that_fail_do_not_leak(call):
    def attempt():
        with warnings.catch_warnings(), contextlib.suppress(snapin.SnapinError, ValueError):
            warnings.simplefilter("ignore")
            call()

    assert not grows(attempt)


# --- What does not fit

LIMITED = """
import resource, warnings, snapin
mesh = snapin.uniform_mesh(20000, 10.0)
law = snapin.lennard_jones(hamaker=1.0, z0=1.0)
with open("/proc/self/statm") as table:
    size = int(table.read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (size + 10**9, size + 10**9))
bodies = {"radius": 1.0, "stiffness": 1.0}
for call in mesh.matrix, lambda: snapin.equilibrium(law, mesh, 3.0, 0.1):
    try:
        call()
    except MemoryError as problem:
        print(problem)
try:
    snapin.force_curve([4.0, 3.0], law=law, **bodies, grid="uniform", nodes=20000)
except MemoryError as problem:
    print(problem)
warnings.simplefilter("ignore")  # A law in its own lengths leaves the model's ground.
print(snapin.force_curve([4.0, 3.0], law=law, **bodies).converged)
"""


def test_what_does_not_fit_is_refused_with_the_memory_that_it_needs():
    """Fortran would end the process; three matrices of 20000 nodes and vectors are 9.62 GB."""
    lines = answer(LIMITED, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1").splitlines()
    assert [line.split(": ")[0] for line in lines[:2]] == ["mesh", "mesh"]
    assert all("9.62 GB of memory are needed" in line for line in lines[:2])
    # The program's own count, before anything is computed.
    assert re.fullmatch("not computed: .*20000 nodes need .* GB of memory.*", lines[2])
    assert lines[3] == "True"


def test_what_is_beyond_the_memory_that_is_free_is_refused(monkeypatch):
    """The system would promise it, and end the process when it is used."""
    monkeypatch.setattr("snapin.arguments._free_memory", lambda: 10**6)
    mesh = snapin.uniform_mesh(1000, 10.0)
    with pytest.raises(MemoryError, match="^mesh: 0.0248 GB of memory .* 0.001 GB are free$"):
        mesh.matrix()


@pytest.mark.parametrize("method", ["mixing", "anderson", "newton"])
def test_a_state_takes_no_more_memory_than_is_asked_for(method):
    script = f"""
import snapin
from snapin.numerics import bytes_for
law = snapin.lennard_jones(hamaker=1.0, z0=1.0)
def peak():
    # Not ru_maxrss, which begins with that of the process that started this one.
    with open("/proc/self/status") as table:
        return next(1024 * int(line.split()[1]) for line in table if line.startswith("VmHWM"))
def state(nodes):
    return snapin.equilibrium(law, snapin.uniform_mesh(nodes, 12.0), 2.0, 0.1, method={method!r})
state(80)
before = peak()
state(800)
print((peak() - before) / bytes_for(800))
"""
    share = float(answer(script, OMP_NUM_THREADS="1"))
    assert 0.2 < share < 1


# --- Reading results

LONG_TABLE = """
import os, pathlib, resource
import snapin
folder = pathlib.Path(os.environ["FOLDER"])
def peak():
    return 1024*resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
snapin.read_results(folder / "short")
before = peak()
table = snapin.read_results(folder / "long").curve
print(len(table), (peak() - before)/table.nbytes)
"""


@pytest.mark.alone
def test_reading_a_long_table_takes_a_few_times_its_memory(snapin, tmp_path):
    """Cells as text took ten times the numbers: 1.4 GB for a million rows."""
    (tmp_path / "d.nml").write_text(
        "&bodies radius = 1e-6, rigid = .true. /\n&force law = 'lennard_jones', hamaker = 1e-19, "
        "z0 = 3e-10 /\n&loading h0_start = 4e-9, h0_end = 1e-9, h0_step = 3e-11 /\n")
    assert snapin("--quiet", "--into", tmp_path / "short", tmp_path / "d.nml").returncode == 0
    shutil.copytree(tmp_path / "short", tmp_path / "long")
    lines = (tmp_path / "short/curve.csv").read_text().splitlines(keepends=True)
    rows = [line for line in lines if line.startswith("loading,")]
    with (tmp_path / "long/curve.csv").open("a") as table:
        table.writelines(rows * 1500)
    count, times = answer(LONG_TABLE, FOLDER=str(tmp_path)).split()
    assert int(count) == 1501 * len(rows) > 150_000
    # The file's bytes, its text, and the columns.
    assert float(times) < 6
