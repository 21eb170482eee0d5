#!/usr/bin/env python3
"""Separation and pressure against r, one line for each h0, from a folder of results.

    .venv/bin/python pywrap/plots/profiles.py results/first
"""

from snapin.plots.profiles import PICTURE

if __name__ == "__main__":
    PICTURE.main()
