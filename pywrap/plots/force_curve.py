#!/usr/bin/env python3
"""Load against displacement and against h0, from a folder of results.

    .venv/bin/python pywrap/plots/force_curve.py results/first
"""

from snapin.plots.force_curve import PICTURE

if __name__ == "__main__":
    PICTURE.main()
