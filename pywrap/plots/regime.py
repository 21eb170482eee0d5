#!/usr/bin/env python3
"""The scene as a point on the map of theories of Johnson and Greenwood, from a deck with &regime.

    .venv/bin/python pywrap/plots/regime.py results/regime
"""

from snapin.plots.regime import PICTURE

if __name__ == "__main__":
    PICTURE.main()
