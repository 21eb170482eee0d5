"""The command snapin-plot: the pictures that a folder of results has the files for, or one kind of
picture with its options.

    snapin-plot results/first
    snapin-plot map results/map --value max_tension
"""

import argparse
import importlib
import pathlib
import sys
from collections.abc import Sequence
from typing import Optional

from ..command import as_command

# Kind -> module. All but forces, whose picture needs a deck alone, have a PICTURE.
_MODULES = {"curve": "force_curve", "forces": "force_law", "profiles": "profiles", "map": "map",
            "curves": "curve_map", "accuracy": "accuracy", "fit": "fit", "regime": "regime",
            "device": "device_curve"}
_HELP = f"""usage: snapin-plot [--dpi DPI] FOLDER [FOLDER ...]
       snapin-plot KIND [OPTIONS] FOLDER

Draws results into their folders, FOLDER/*.png: all pictures for which a folder has the files, or
one kind, of {', '.join(_MODULES)}.
snapin-plot KIND --help has the options of a kind.
"""


@as_command
def main(arguments: Optional[Sequence[str]] = None) -> int:
    """Carry out the command; return its exit status."""
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    if not arguments or arguments[0] in ("-h", "--help"):
        print(_HELP, end="")
        return 0 if arguments else 2
    try:
        if arguments[0] in _MODULES:
            _of_kind(arguments[0], arguments[1:])
            return 0
        return _all_kinds(arguments)
    except ImportError as missing:
        if missing.name not in ("matplotlib", "f90nml"):
            raise
        print(f"snapin-plot: {missing.name} is missing: pip install 'snapin[plots]'",
              file=sys.stderr)
        return 1


def _module(kind):
    return importlib.import_module(f".{_MODULES[kind]}", __package__)


def _of_kind(kind, arguments):
    module, program = _module(kind), f"snapin-plot {kind}"
    if kind == "forces":
        module.main(arguments, program)
    else:
        module.PICTURE.main(arguments, program)


def _all_kinds(arguments):
    """Draw what each folder has the files for; return the exit status."""
    from .drawing import add_dots

    parser = argparse.ArgumentParser(prog="snapin-plot", usage=_HELP.removeprefix("usage: "))
    parser.add_argument("folder", nargs="+", type=pathlib.Path)
    add_dots(parser)
    options = parser.parse_args(arguments)
    return max([_draw(folder, options.dpi) for folder in options.folder])


def _draw(folder, dpi):
    """Draw all pictures of a folder; return 1 if there are none, or one could not be drawn."""
    from ..results import ResultFiles, ResultsError

    try:
        files = ResultFiles(folder)
    except ResultsError as problem:
        print(f"snapin-plot: {problem}", file=sys.stderr)
        return 1
    status, drawn = 0, 0
    for kind, write in _pictures(folder, files, dpi):
        try:
            print(write())
            drawn += 1
        except (ResultsError, OSError) as problem:
            print(f"snapin-plot {kind}: {problem}", file=sys.stderr)
            status = 1
    if not drawn and not status:
        print(f"snapin-plot: no table in {folder} has a picture", file=sys.stderr)
    return status if drawn else 1


def _pictures(folder, files, dpi):
    """Yield the name of each kind of picture that the files allow, and a call that draws it."""
    for kind in _MODULES:
        module = _module(kind)
        if kind == "forces":
            # The cases of a sweep may have different forces.
            if "curve.csv" in files.texts:
                yield kind, lambda write=module.write_forces: write(folder, folder, dpi)
        elif module.PICTURE.allowed(files):
            yield kind, lambda write=module.PICTURE.write: write(folder, None, dpi)
