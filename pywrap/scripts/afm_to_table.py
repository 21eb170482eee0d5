#!/usr/bin/env python3
"""A force curve in a file of an instrument (JPK, Asylum, Bruker, NT-MDT and others) as a table of
text for &measurement: position of the base, force, and segment.

    .venv/bin/python pywrap/scripts/afm_to_table.py CURVE [--number 0] > curve.csv

It reads the file with afmformats, which only this script needs: pip install afmformats. The head of
the table has the spring constant of the file.
"""

import argparse
import os
import sys

HEIGHTS = ("height (measured)", "height (piezo)")


def table_of(curve):
    """Return the lines of the table of a curve: columns "height (measured)" or "height (piezo)",
    "force" and "segment" of afmformats, all SI."""
    height = next((name for name in HEIGHTS if name in curve.columns), None)
    if height is None or "force" not in curve.columns:
        raise ValueError(f"a curve needs force, and {' or '.join(HEIGHTS)}; this one has "
                         + ", ".join(curve.columns))
    yield f"# from {curve.path.name}; {height} is the position of the base"
    yield f"# spring_constant = {curve.metadata.get('spring constant', 'unknown')}"
    yield "z,force,segment"
    for z, force, segment in zip(curve[height], curve["force"], curve["segment"]):
        if int(segment) in (0, 1):
            yield f"{float(z):.9e},{float(force):.9e},{int(segment)}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split(":")[0])
    parser.add_argument("file", help="file of the instrument")
    parser.add_argument("--number", type=int, default=0, help="which curve of a map; default: 0")
    options = parser.parse_args()
    try:
        import afmformats
    except ImportError:
        sys.exit(f"{parser.prog}: missing: {sys.executable} -m pip install afmformats")
    try:
        os.stat(options.file)
        curves = afmformats.load_data(options.file)
        if not 0 <= options.number < len(curves):
            raise ValueError(f"--number {options.number}: the file has {len(curves)} curves, "
                             "the first is 0")
        table = "\n".join(table_of(curves[options.number]))
    except KeyboardInterrupt:
        raise
    except BaseException as problem:  # errors of afmformats are of any kind, some of no other class
        sys.exit(f"{parser.prog}: {options.file}: {problem}")
    print(table)


if __name__ == "__main__":
    main()
