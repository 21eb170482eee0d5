"""Carpick, Ogletree and Salmeron (1999): the contact radius under a load, in closed form."""

from others import fits

numbers, draw, rows = fits.chapter(
    "carpick", "Carpick et al.", "coefficients 4.04, 1.4; 2.28, 1.3, 1.54, 0.279; 0.924, 1.02 as "
    "they are quoted; the print was not read")
