#!/usr/bin/env python3
"""One force curve in a file of an instrument as a table on standard output; `snapin-convert` writes
all curves of a file into a folder.

    .venv/bin/python pywrap/scripts/afm_to_table.py CURVE [--number 0] > curve.csv
"""

import argparse
import sys

from snapin.command import as_command
from snapin.convert import ConvertError, load_curves, table_of


def main():
    parser = argparse.ArgumentParser(description=__doc__.split(";", maxsplit=1)[0])
    parser.add_argument("file", help="file of the instrument")
    parser.add_argument("--number", type=int, default=0, help="which curve of a map; default: 0")
    parser.add_argument("--spring-constant", type=float, help="[N/m], where the file has none")
    parser.add_argument("--sensitivity", type=float, help="[m/V], where the file has none")
    options = parser.parse_args()
    try:
        curves = load_curves(options.file, options.spring_constant, options.sensitivity)
        if not 0 <= options.number < len(curves):
            raise ConvertError(f"--number {options.number}: the file has {len(curves)} curves, "
                               "the first is 0")
        columns, metadata = curves[options.number]
        spring = options.spring_constant or metadata.get("spring constant")
        text, told = table_of(columns, options.file, spring, metadata.get("sensitivity"))
    except ConvertError as problem:
        sys.exit(f"{parser.prog}: {options.file}: {problem}")
    sys.stdout.write(text)
    print(f"{parser.prog}: {told}", file=sys.stderr)


if __name__ == "__main__":
    sys.exit(as_command(main)())
