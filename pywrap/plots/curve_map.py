#!/usr/bin/env python3
"""Fits of many curves over the places of the curves, from the results of a sweep.

    .venv/bin/python pywrap/plots/curve_map.py results/map
"""

from snapin.plots.curve_map import PICTURE

if __name__ == "__main__":
    PICTURE.main()
