"""Carpick, Ogletree and Salmeron (1999): the contact radius under a load, in closed form."""

from others import fits

numbers, draw, rows = fits.chapter(
    "carpick", "Carpick et al.", "equations (10), (12a), (12b) as the source of Woo has them "
    "(woodem/woo, pkg/dem/Hertz.cpp)")
