"""`python -m snapin.plots` is the command `snapin-plot`."""

import sys

from .command import main

if __name__ == "__main__":
    sys.exit(main())
