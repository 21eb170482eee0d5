#!/usr/bin/env python3
"""A deck's force law beside the force curve; the deck is run.

    .venv/bin/python pywrap/plots/law_and_curve.py inputs/examples/hydration.nml
"""

import sys

from snapin.command import as_command
from snapin.plots.law_and_curve import main

if __name__ == "__main__":
    sys.exit(as_command(main)())
