#!/usr/bin/env python3
"""Load against the position of the base, behind each spring, from a deck with &device.

    .venv/bin/python pywrap/plots/device_curve.py results/device
"""

from snapin.plots.device_curve import PICTURE

if __name__ == "__main__":
    PICTURE.main()
