#!/usr/bin/env python3
"""The forces of a deck: pressure and energy against separation, with extrema.

    .venv/bin/python pywrap/plots/force_law.py inputs/examples/hydration.nml
"""

import sys

from snapin.command import as_command
from snapin.plots.force_law import main

if __name__ == "__main__":
    sys.exit(as_command(main)())
