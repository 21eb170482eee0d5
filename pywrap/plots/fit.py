#!/usr/bin/env python3
"""A measured force curve with the fitted model, and the residuals.

    .venv/bin/python pywrap/plots/fit.py results/fit
"""

from snapin.plots.fit import PICTURE

if __name__ == "__main__":
    PICTURE.main()
