"""The claim that no argument, however wrong, crashes, hangs or is silently taken for another.

Every public callable of the package is called with values of support/wrapper_values.py for every
argument, with all of them for one argument of each kind and with one of each sort for the others,
in a process of its own (support/wrapper_child.py). Allowed are the result of a
clean copy, to the bit, and an exception that begins with the argument's name or, where that is a
key of a deck, is the program's message about that key. What decks are is in test_run.py.
"""

import importlib
import inspect
import json
import pkgutil

import pytest
import snapin
from support.processes import python
from support.wrapper_registry import GATHERED, LEFT_OUT, REGISTRY

# Modules of checks, which the callables of the others go through, of commands, and of what has
# decks and files for arguments.
CHECKS = {"snapin.arguments", "snapin.command", "snapin.convert", "snapin.curve_fit",
          "snapin.deck", "snapin.many_curves", "snapin.result_text",
          "snapin.results"}


def public_callables():
    """Name and callable: the package's functions, and the methods of its classes."""
    for name in snapin.__all__:
        if inspect.isfunction(getattr(snapin, name)):
            yield name, getattr(snapin, name)
    for module in pkgutil.iter_modules(snapin.__path__, "snapin."):
        if module.name.startswith("snapin._"):
            continue
        for name, thing in vars(importlib.import_module(module.name)).items():
            if name.startswith("_") or getattr(thing, "__module__", "") != module.name:
                continue
            if inspect.isfunction(thing) and module.name not in CHECKS:
                yield name, thing
            if inspect.isclass(thing) and module.name not in CHECKS:
                yield from methods(name, thing)


def methods(name, kind):
    """The public methods of a class, and the class itself if it checks what it is made of."""
    if hasattr(kind, "__post_init__"):
        yield name, kind
    for key, thing in vars(kind).items():
        if inspect.isfunction(thing) and not key.startswith("_"):
            yield f"{name}.{key}", thing


def entries_of(name):
    """The entries of a callable: NAME, or NAME and what is special about the call."""
    return [key for key in REGISTRY if key == name or key.startswith((f"{name} ", f"{name},"))]


# A plain helper that takes nothing from users, and what takes or makes decks and folders.
HELPERS = {"bytes_for", "fit", "fit_many", "run", "deck_text", "lennard_jones", "exponential",
           "read_results"}


@pytest.mark.parametrize(
    ("name", "call"), [(n, c) for n, c in public_callables() if n not in HELPERS])
def test_every_argument_of_every_public_callable_is_in_the_registry(name, call):
    entries = entries_of(name)
    assert entries, f"{name} has no entry in tests/support/wrapper_registry.py"
    wanted = {
        key
        for key, parameter in inspect.signature(call).parameters.items()
        if parameter.kind is not parameter.VAR_KEYWORD and key != "self"
    }
    for key in entries:
        given = set(REGISTRY[key].kinds)
        assert given - GATHERED == (wanted - GATHERED) - LEFT_OUT.get(key, set())
    assert wanted <= set().union(*(REGISTRY[key].kinds for key in entries))


def test_every_entry_of_the_registry_is_of_a_public_callable():
    known = [key for name, _ in public_callables() for key in entries_of(name)]
    assert set(known) == set(REGISTRY)


def groups():
    """The entries with arguments, in as many processes as pay: a start takes as long as hundreds of
    cases. Those that compute have one of their own."""
    names = [name for name in REGISTRY if REGISTRY[name].kinds]
    heavy = [name for name in names if name.startswith(("force_curve", "equilibrium", "approx"))]
    light = [name for name in names if name not in heavy]
    return [[name] for name in heavy] + [light[first::3] for first in range(3)]


@pytest.mark.parametrize("names", groups(), ids=lambda names: f"{names[0]} and {len(names) - 1}")
def test_wrong_arguments_are_refused_by_name_and_odd_ones_make_no_difference(names):
    result = python("-m", "support.wrapper_child", *names, OMP_NUM_THREADS="1")
    lines = [json.loads(line) for line in result.stdout.splitlines()]
    cases = [line["case"] for line in lines if "case" in line]
    faults = [line["fault"] for line in lines if "fault" in line]
    assert result.returncode == 0, f"{cases[-1:]} ended with {result.returncode}: {result.stderr}"
    assert len(cases) == len(faults)
    for name in names:
        for argument in REGISTRY[name].kinds:
            assert sum(case.startswith(f"{name}, {argument}: ") for case in cases) > 3
    assert not [f"{case}: {fault}" for case, fault in zip(cases, faults) if fault]
