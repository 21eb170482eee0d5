"""Claims about calls at once, forks and interruptions: results are those of one call after another,
to the bit."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import snapin
from support.processes import HANG, answer
from support.wrapper_child import same
from support.wrapper_registry import REGISTRY, UNIT, law_of

# Needs the OpenMP run-time for its matrix, and prints a number that depends on every entry.
WORK = """
import os, numpy as np, snapin
def work():
    mesh = snapin.panel_mesh(np.linspace(0.0, 5.0, 41), 12)
    state = snapin.equilibrium(snapin.lennard_jones(hamaker=1.0, z0=1.0), mesh, 3.0, 0.2)
    return mesh.matrix().nodes.tobytes(), state.load
"""


def jobs():
    """Calls of every family: all of the registry, and force curves and paths of several sigma."""
    for entry in REGISTRY.values():
        yield lambda entry=entry: entry.call(**entry.good)
    for sigma in 0.1, 0.3, 0.87, 2.0, 3.0:
        law = law_of(sigma)
        yield lambda law=law: snapin.force_curve(
            [4.0, 2.0, 0.0, 4.0, 8.0], **UNIT, law=law, accuracy=1e-2)
        yield lambda law=law: snapin.equilibrium_path(0.0, **UNIT, law=law, accuracy=1e-2)


@pytest.mark.parametrize(("threads", "rounds"), [(2, 2), (8, 1)])
@pytest.mark.filterwarnings("ignore::snapin.SnapinWarning")
def test_threads_that_call_at_once_get_what_one_gets_alone(threads, rounds):
    """Each starts elsewhere in the list, so that different calls meet."""
    calls = list(jobs())
    alone = [call() for call in calls]
    together = {}
    gate = threading.Barrier(threads)

    def go(first):
        gate.wait()
        for step in range(rounds * len(calls)):
            at = (first * len(calls) // threads + step) % len(calls)
            together[first, step] = at, calls[at]()

    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        workers = [threading.Thread(target=go, args=(first,)) for first in range(threads)]
        for worker in workers:
            worker.start()
        for worker in workers:
            worker.join()
    finally:
        sys.setswitchinterval(interval)
    assert len(together) == threads * rounds * len(calls)
    assert all(same(result, alone[at]) for at, result in together.values())


def test_a_thread_with_a_small_stack_computes_large_arrays():
    assert "done" in answer(
        """
import threading, numpy as np, snapin
threading.stack_size(256 * 1024)
def go():
    gap = np.linspace(1.0, 2.0, 2 * 10**5)
    snapin.force_law(snapin.lennard_jones(hamaker=1.0, z0=1.0), gap)
    bodies = {"radius": 1.0, "stiffness": 1.0}
    snapin.contact_curve("maugis", gap, **bodies, surface_energy=1.0, strength=1.0)
    law = snapin.lennard_jones(hamaker=1.0, z0=1.0)
    snapin.slow_deformation(gap[::4], radius=1.0, stiffness=1.0, law=law)
    snapin.force_curve([4.0, 3.0, 2.0], radius=1.0, stiffness=1.0, law=law)
    print("done")
worker = threading.Thread(target=go)
worker.start()
worker.join()
"""
    )


@pytest.mark.parametrize("threads", ["1", "4"])
def test_a_process_that_is_forked_after_a_calculation_computes_the_same(threads):
    """Without care it would wait for threads that the fork has not copied."""
    script = """
before = work()
child = os.fork()
if child == 0:
    signal.alarm(600)
    os._exit(0 if work() == before else 1)
print(os.waitpid(child, 0)[1])
"""
    assert answer("import signal" + WORK + script, OMP_NUM_THREADS=threads).split() == ["0"]


def test_a_pool_of_processes_computes_the_same():
    script = """
import multiprocessing
def one(_):
    return work()
before = work()
with multiprocessing.get_context("fork").Pool(3) as pool:
    print(pool.map_async(one, range(6)).get(timeout=600) == [before] * 6)
"""
    assert answer(WORK + script, OMP_NUM_THREADS="4").split() == ["True"]


@pytest.mark.alone
def test_ctrl_c_is_answered_when_the_call_ends_and_spoils_nothing():
    """The library cannot be stopped half way; Python raises as soon as it has control again."""
    script = """
import os, signal, threading, time
law = snapin.lennard_jones(hamaker=1.0, z0=1.0)
def curve():
    return snapin.force_curve(np.linspace(8, -2, 400), radius=1.0, stiffness=1.0, law=law).load
before = curve()
began = time.monotonic()
curve()
once = time.monotonic() - began
signal.setitimer(signal.ITIMER_REAL, once / 4)
signal.signal(signal.SIGALRM, signal.default_int_handler)
done = 0
try:
    while done < 1000:
        curve()
        done += 1
except KeyboardInterrupt:
    print("interrupted")
print((curve() == before).all())
"""
    assert answer(WORK + script).split() == ["interrupted", "True"]


@pytest.mark.skipif(shutil.which("nm") is None, reason="needs nm of binutils")
def test_the_numerics_keep_nothing_between_calls(snapin_path):
    """No variable outlives a call in the modules that compute; what gfortran makes is constant
    but for one thing.

    Its `slen`, lengths of intermediate strings, do outlive one, in modules that write text: calls
    at once would share them, and so the wrapper keeps Python's global lock.
    """
    archive = pathlib.Path(snapin_path).with_name("libsnapin.a")
    if not archive.is_file():
        pytest.skip(f"no {archive}")
    table = subprocess.run(["nm", str(archive)], capture_output=True, text=True, check=True).stdout
    rows = [line.split() for line in table.splitlines()]
    variables = {row[2] for row in rows if len(row) == 3 and row[1] in "bBdDsS"}
    # Tables of types and of `select case`, and the names of files, which are a parameter; on a
    # build that counts lines, the counts. flang calls initial values of types _QQ.
    constant = re.compile(r"___?(def_init|vtab)_|^__(def_init|vtab)_|^jumptable|^A\.|^__gcov|^_QQ")
    kept = {name for name in variables if not constant.search(name)}
    assert {name for name in kept if not name.startswith("slen.")} == set()


LONG = """
import os, signal, snapin, sys, threading, time
# Shells let their background jobs ignore interrupts.
signal.signal(signal.SIGINT, signal.default_int_handler)
# Fifteen hundred nodes by Newton's method: minutes.
deck = snapin.deck_text({
    "bodies": {"radius": 1.0, "stiffness": 1.0},
    "force": {"law": "lennard_jones", "hamaker": 50.0, "z0": 1.0},
    "loading": {"h0_start": 8.0, "h0_end": -4.0, "h0_step": 0.01},
    "numerics": {"grid": "uniform", "nodes": 1500, "method": "newton"},
})
"""


def test_an_interrupt_ends_a_run_within_a_second_and_python_goes_on():
    script = LONG + """
threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    snapin.run(deck)
except KeyboardInterrupt:
    began = time.monotonic()
    print("interrupted", snapin.run("&bodies radius = 1, rigid = T / &force law = 'lennard_jones', "
          "hamaker = 1e-20, z0 = 1e-9 / &classical h0_start = 1e-9, h0_end = 0 /").converged)
"""
    began = time.monotonic()
    assert answer(script).split() == ["interrupted", "True"]
    # Half a second until the interrupt, one for it, and the rest is Python's start.
    assert time.monotonic() - began < HANG / 4


def test_a_run_ends_with_the_interpreter_that_began_it(tmp_path):
    script = LONG + "print('ready', flush=True)\nsnapin.run(deck)\n"
    environment = dict(os.environ, TMPDIR=str(tmp_path))
    python = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True,
                              env={**environment, "PYTHONPATH": os.pathsep.join(sys.path)})
    assert python.stdout.readline() == "ready\n"
    children = pathlib.Path(f"/proc/{python.pid}/task/{python.pid}/children")
    for _ in range(200):
        if children.read_text().split():
            break
        time.sleep(0.02)
    (child,) = children.read_text().split()
    python.kill()
    python.wait()
    for _ in range(200):
        if not pathlib.Path(f"/proc/{child}").exists():
            break
        time.sleep(0.02)
    state = pathlib.Path(f"/proc/{child}/stat")
    assert not state.exists() or state.read_text().split()[2] == "Z"
    assert list(tmp_path.iterdir()) == []


def test_other_threads_go_on_while_a_deck_runs():
    counted = 0
    stop = threading.Event()

    def count():
        nonlocal counted
        while not stop.is_set():
            counted += 1
            time.sleep(1e-3)

    other = threading.Thread(target=count)
    other.start()
    try:
        before = counted
        snapin.force_curve(np.linspace(6.0, -2.0, 101), **UNIT, law=law_of(0.3), grid="uniform",
                           nodes=300)
        assert counted > before + 5
    finally:
        stop.set()
        other.join()
