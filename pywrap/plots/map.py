#!/usr/bin/env python3
"""A result of a sweep: over two keys as colours with contours, over one key as curves.

    .venv/bin/python pywrap/plots/map.py results/map
"""

from snapin.plots.map import PICTURE

if __name__ == "__main__":
    PICTURE.main()
