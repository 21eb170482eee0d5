#!/usr/bin/env python3
"""What accuracy costs: errors against time, of a sweep whose costs were measured.

    .venv/bin/python pywrap/plots/accuracy.py results/accuracy
"""

from snapin.plots.accuracy import PICTURE

if __name__ == "__main__":
    PICTURE.main()
