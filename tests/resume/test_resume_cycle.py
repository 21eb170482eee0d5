"""Claims about cycles, paths and drives in time that are killed and continued."""

import random
import struct
import time

import f90nml
import pytest
from support.interrupted import Bench, frames, sealed, short, SHORT, WORD  # noqa: F401
from support.scenes import deck, exponential, lennard_jones, loading

UNIFORM = {"grid": "uniform", "nodes": 120, "r_max": 12.0}
CREEP = {"compliance": [2.0, 1.0], "retardation_time": [1.0, 0.1]}


def driven(sigma=0.1, drive=(), **groups):
    drive = {"velocity": 8.0, "z_start": 15.0, "z_turn": -1.0, "dwell": 0.3, **dict(drive)}
    return lennard_jones(sigma, drive=drive, numerics={"accuracy": 1e-2}, **groups)


CYCLES = {
    "first": SHORT,
    "two turning points, strong adhesion": lennard_jones(
        8.7, loading=loading(14, -4, 1), unloading={"from_": [2.0, -4.0]},
        profiles={"h0": [2.0, -2.0]}),
    "the paper's grid and rule": lennard_jones(
        0.87, loading=loading(5, -1, 0.5), unloading={}, profiles={"h0": [1.0]},
        numerics={**UNIFORM, "method": "mixing", "convergence": "displacement_change",
                  "displacement_tolerance": 1e-4},
    ),
    "uniform grid": lennard_jones(
        0.87, loading=loading(5, -1, 0.5), unloading={}, numerics=UNIFORM),
    "newton": lennard_jones(
        0.87, loading=loading(5, -1, 0.5), unloading={}, numerics={"method": "newton"}),
    "repulsion": exponential(
        100, loading=loading(6, -6, 0.5), unloading={}, profiles={"h0": [0.0]}),
    "stability beside path and cycle": lennard_jones(
        0.87, loading=loading(4, -1, 0.5), unloading={}, equilibrium_path={}, stability={},
        profiles={"h0": [1.0]}),
    "no state at the end": lennard_jones(0.87, part="attractive", loading=loading(6, -1, 0.25)),
    "bodies that remember": driven(viscoelastic=CREEP,
                                   sensitivity={"parameters": "drive.velocity"}),
    "behind a spring": driven(viscoelastic=CREEP, drive={"stiffness": 0.5, "z_start": 40.0}),
    "a fluid": driven(viscoelastic=CREEP, fluid={"viscosity": 0.01}),
    "a fluid alone": driven(fluid={"viscosity": 0.01}),
    "layers": driven(1.0, layer={"young": 4.0, "poisson": 0.3, "thickness": 3.0, "base": "rigid"},
                     fluid={"viscosity": 0.01}),
}
FAILS = ("the paper's grid and rule", "no state at the end")


@pytest.fixture(scope="module", params=CYCLES)
def cycle(request, snapin, snapin_path, tmp_path_factory):
    folder = tmp_path_factory.mktemp("cycle")
    return Bench(snapin, snapin_path, folder, CYCLES[request.param],
                 status=int(request.param in FAILS))


def test_a_cycle_goes_on_from_anywhere(cycle):
    parts = frames(cycle.journal)
    assert len(parts) > 4
    rng = random.Random(3)
    for count in rng.sample(range(1, len(parts)), 4) + [len(parts)]:
        cycle.check(b"".join(parts[:count]))
    # In the middle of a record, or of the heading.
    for size in [len(parts[0]) // 2] + rng.sample(range(len(cycle.journal)), 2):
        cycle.check(cycle.journal[:size])


@pytest.mark.long
def test_a_cycle_goes_on_from_any_record(cycle):
    parts = frames(cycle.journal)
    for count in range(len(parts) + 1):
        cycle.check(b"".join(parts[:count]))


def test_a_killed_cycle_goes_on_again_and_again(cycle):
    cycle.check_killed(4, 0.02, 0.15)


def test_a_cycle_adds_only_what_its_journal_lacks(cycle):
    parts = frames(cycle.journal)
    begun = b"".join(parts[: 2 * len(parts) // 3])
    ended = cycle.stop(begun + parts[-1][:-WORD])
    assert ended.startswith(begun)
    # The same records but for the times they were made at.
    assert [len(part) for part in frames(ended)] == [len(part) for part in parts]


def test_another_number_of_threads_is_refused_in_a_cycle(snapin, snapin_path, tmp_path):
    bench = Bench(snapin, snapin_path, tmp_path, lennard_jones(0.2, loading=loading(6, 5, 0.5)))
    bench.threads = 2
    done = bench.resume(bench.journal)
    assert done.returncode == 1
    assert "set OMP_NUM_THREADS=1" in done.stderr
    assert (tmp_path / "cut/deck/unfinished/journal").read_bytes() == bench.journal


def test_times_of_a_run_that_was_interrupted_are_those_of_all_its_parts(short):
    parts = frames(short.journal)
    late = bytearray(parts[-1])
    late[2 * WORD : 3 * WORD] = struct.pack("<d", 1000.0)
    began = time.monotonic()
    assert short.resume(b"".join(parts[:-1]) + sealed(bytes(late))).returncode == 0
    taken = time.monotonic() - began
    cost = f90nml.read(short.folder / "cut/deck/summary.nml")["cost"]
    assert 1000 < cost["wall_seconds"] <= 1000 + taken
    assert short.resume(b"".join(parts[:-1])).returncode == 0
    cost = f90nml.read(short.folder / "cut/deck/summary.nml")["cost"]
    assert cost["wall_seconds"] >= cost["kernel_seconds"] + cost["solve_seconds"]
    assert cost["solve_seconds"] > 0


def test_a_branch_knows_nothing_of_one_that_ended_beside_its_turn(snapin, snapin_path, tmp_path):
    """Rows up to both turning points are foretold: the second unloading begins without a past, on
    the part of the path that the first one ended on, which a resumed run has not seen."""
    scene = deck(
        bodies={"radius": 4.3047e-3, "stiffness": 6.7608e11},
        force={"law": "lennard_jones", "surface_energy": 1.28415e-2, "z0": 5e-10},
        loading=loading(4e-9, -6.4213730986e-10, 4.6421373099e-11),
        unloading={"from_": [2.3124055064e-9, 2.4052482526e-9], "h0_end": 2.4516696257e-9,
                   "h0_step": 2.3210686549e-12},
        numerics={"accuracy": 1e-2},
    )
    bench = Bench(snapin, snapin_path, tmp_path, scene)
    steps = frames(bench.journal)
    bench.check(b"".join(steps[: len(steps) - 5]))
