"""Claims about sweeps on many processes. `tools/verify/verify.sh mpi` makes the builds; without
them these tests are skipped."""

import os
import random
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import ROOT
from support.scenes import deck

MPI = {"openmpi": ("mpirun.openmpi", "--oversubscribe", "--bind-to", "none"),
       "mpich": ("mpirun.mpich",)}
SCENE = {"bodies": {"radius": 1e-6, "stiffness": 1e10},
         "force": {"law": "lennard_jones", "hamaker": 1e-19, "z0": 3e-10},
         "equilibrium_path": {"h0_end": -1e-9}}
SWEEP = {"key": ["bodies.stiffness", "force.hamaker"], "from": [1e8, 1e-20], "to": [1e11, 1e-19],
         "count": [30, 20], "scale": "log"}
# In half of its cases the loading would go the wrong way.
FAILING = {"key": ["loading.h0_start", "loading.h0_end"], "from": [2e-9, 1e-9],
           "to": [5e-9, 4e-9], "count": [6, 6]}
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")


class Ranks:
    """A build with MPI in a folder with decks."""

    def __init__(self, kind, folder):
        self.start, self.folder = MPI[kind], folder
        self.program = ROOT / f"build-{kind}/snapin"
        for name, sweep in (("map", SWEEP), ("failing", FAILING)):
            scene = dict(SCENE, sweep=sweep)
            if sweep is FAILING:
                scene["loading"] = {"h0_start": 2e-9, "h0_end": 1e-9, "h0_step": 1e-9}
            (folder / f"{name}.nml").write_text(deck(**scene))
        (folder / "alone.nml").write_text(deck(**SCENE))
        (folder / "wrong.nml").write_text("&bodies radius = -1 /\n")

    def command(self, count, *arguments):
        """On so many processes that compute, and one that hands out; 0: without mpirun."""
        start = [*self.start, "-n", str(count + 1)] if count else []
        return [*start, str(self.program), "--quiet", *arguments]

    def run(self, count, *arguments, threads=1, **options):
        return self.start_up(self.command(count, *arguments), threads, **options)

    def start_up(self, command, threads=1, **options):
        return subprocess.run(command, cwd=self.folder, text=True,
                              env=dict(ENVIRONMENT, OMP_NUM_THREADS=str(threads)), timeout=300,
                              capture_output=True, check=False, **options)

    def results(self, out, name="map"):
        """The results without times."""
        return {path.name: [line for line in path.read_bytes().splitlines()
                            if b"_seconds" not in line and b"threads" not in line]
                for path in sorted((self.folder / out / name).iterdir())}

    def kill_one(self, count, delay, victim, *arguments):
        """Kills process number `victim` after a delay [s]; what mpirun said and its status."""
        with subprocess.Popen(self.command(count, *arguments), cwd=self.folder, env=ENVIRONMENT,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as run:
            time.sleep(delay)
            for pid in processes(self.program, victim, self.folder):
                os.kill(pid, signal.SIGKILL)
            said, _ = run.communicate(timeout=60)
        return run.returncode, said


def processes(program, rank, folder):
    """The processes of a program in a folder that mpirun has given this rank."""
    for entry in Path("/proc").iterdir():
        try:
            environment = (entry / "environ").read_bytes().split(b"\0")
            if os.readlink(entry / "exe") == str(program) and \
                    os.readlink(entry / "cwd") == str(folder) and \
                    {b"OMPI_COMM_WORLD_RANK=%d" % rank, b"PMI_RANK=%d" % rank} & {*environment}:
                yield int(entry.name)
        except OSError:
            continue


@pytest.fixture(scope="module", params=MPI)
def ranks(request, tmp_path_factory):
    kind = request.param
    if not (ROOT / f"build-{kind}/snapin").exists() or not shutil.which(MPI[kind][0]):
        pytest.skip(f"no build with {kind}: tools/verify/verify.sh mpi")
    ranks = Ranks(kind, tmp_path_factory.mktemp(kind))
    assert ranks.run(0, "--out", "whole", "map.nml").returncode == 0
    return ranks


@pytest.mark.parametrize("count, threads", [(1, 1), (2, 1), (4, 2)])
def test_any_number_of_processes_leaves_the_same_bytes(ranks, count, threads):
    done = ranks.run(count, "--out", f"on{count}", "map.nml", threads=threads)
    assert done.returncode == 0, done.stderr
    assert ranks.results(f"on{count}") == ranks.results("whole")


def test_a_million_empty_cases_are_handed_out_in_few_messages(ranks):
    """In seconds, of which nothing can be claimed."""
    program = str(ranks.program.with_name("dispatcher"))
    done = ranks.start_up([*ranks.start, "-n", "3", program, "1000000", "0"])
    workers, cases, _, _, messages = done.stdout.split()
    assert (workers, cases) == ("2", "1000000")
    assert int(messages) < 150


def test_several_decks_one_after_the_other(ranks):
    names = "failing", "alone", "map"
    files = [f"{name}.nml" for name in names]
    assert ranks.run(0, "--out", "one", *files).returncode == 1
    done = ranks.run(2, "--out", "many", *files)
    assert done.returncode != 0
    for name in names:
        assert ranks.results("many", name) == ranks.results("one", name)


def test_a_wrong_deck_is_said_once_and_ends_all(ranks):
    done = ranks.run(2, "wrong.nml", "map.nml")
    assert done.returncode == 2
    assert done.stderr.count("wrong.nml:1") == 1
    assert not (ranks.folder / "results").exists()


def test_standard_input_is_refused(ranks):
    done = ranks.run(2, "-", stdin=subprocess.DEVNULL)
    assert done.returncode == 2
    assert done.stderr.count("cannot read one standard input") == 1


def test_the_mpirun_of_another_mpi_is_refused(ranks):
    others = [start for start in MPI.values() if start != ranks.start and shutil.which(start[0])]
    if not others:
        pytest.skip("there is no other MPI")
    done = subprocess.run([*others[0], "-n", "2", str(ranks.program), "map.nml"], cwd=ranks.folder,
                          env=ENVIRONMENT, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 2
    assert "another MPI" in done.stderr
    assert not (ranks.folder / "results").exists()


def killed_and_resumed(ranks, rng, out):
    """One killed run and its resumption; whether it was killed in time."""
    shutil.rmtree(ranks.folder / out, ignore_errors=True)
    count = rng.randint(1, 3)
    status, said = ranks.kill_one(count, rng.uniform(0.4, 1.2), rng.randint(0, count),
                                  "--out", out, "map.nml")
    in_time = not (ranks.folder / out / "map/summary.nml").exists()
    if in_time:
        assert status != 0
        assert "signal 9" in said or "EXIT CODE: 9" in said
    done = ranks.run(rng.randint(0, 3), "--out", out, "--resume", "map.nml")
    assert done.returncode == 0, done.stderr
    assert ranks.results(out) == ranks.results("whole")
    return in_time


def test_a_process_that_dies_ends_the_run_which_others_finish(ranks):
    rng = random.Random(4)
    assert any(killed_and_resumed(ranks, rng, "killed") for _ in range(3))


@pytest.mark.long
def test_twenty_killed_runs_are_finished(ranks):
    rng = random.Random(5)
    assert sum(killed_and_resumed(ranks, rng, "twenty") for _ in range(20)) >= 10
