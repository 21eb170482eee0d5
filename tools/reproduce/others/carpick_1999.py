"""Carpick, Ogletree and Salmeron (1999): the contact radius under a load, in closed form."""

from others import fits

DECKS = ()
TITLE = "Carpick, Ogletree and Salmeron 1999: contact radius in closed form"
CAPTION = """R. W. Carpick, D. F. Ogletree and M. Salmeron, J. Colloid Interface Sci. **211**, 395 (1999),
fitted Maugis-Dugdale theory: a = a0 ((α + √(1 − F/F0))/(1 + α))^(2/3), λ = −0.924 ln(1 − 1.02 α), with

    F0/πwR = −7/4 + ¼ (4.04 λ^1.4 − 1)/(4.04 λ^1.4 + 1)
    a0/(πwR²/K)^(1/3) = 1.54 + 0.279 (2.28 λ^1.3 − 1)/(2.28 λ^1.3 + 1)

**Against the theory** it was fitted to, pull-off is off by at most {maugis_pull:.2f} % (at λ =
{maugis_pull_at:.2f}; {maugis_pull_typical:.2f} % in the median over λ = 0.01 to 100), a0 by at most
{maugis_radius:.2f} % (at {maugis_radius_at:.2f}; {maugis_radius_typical:.2f} %). **Against Lennard-Jones
spheres**, solved, it is off by at most {solved_pull:.2f} % (at {solved_pull_at:.2f}) in pull-off and
{solved_radius:.2f} % (at {solved_radius_at:.2f}, for λ from {from:g} on) in a0: what the theory misses of the law is more than
what the formula misses of the theory. The program has it as `&classical theories = 'carpick'`."""

_SOURCE = ("coefficients 4.04, 1.4; 2.28, 1.3, 1.54, 0.279; 0.924, 1.02 as they are quoted; "
           "the print was not read")


def numbers(_):
    """Return what the caption quotes."""
    return fits.numbers("carpick")


def draw(_):
    """Return the picture."""
    return fits.draw("carpick", "Carpick et al.")


def rows(_):
    """Return the formula beside theory and solution."""
    return fits.rows("carpick", _SOURCE)
