"""What could not be read, and what is not computed yet."""

DECKS = ()
TITLE = "What could not be read, and what is missing"
CAPTION = """None of the papers of this page was at hand but Attard and Parker (1992); of Greenwood (1997) and of
Hayes et al. (1972) the abstract was. So no number here is called printed. Where
a formula is quoted, its coefficients are in the rows, and a reader with the print can check them. These tables and
fits would be set beside the converged numbers, which stand in the rows called *not read*:

- Greenwood (1997), Feng (2000): pull-off, its h0 and the jumps over Tabor's parameter.
- Muller, Yushchenko and Derjaguin (1980): pull-off over their parameter.
- Maugis (1992): his table of λ, load and radius.
- Johnson and Greenwood (1997): the limits of their map.
- Wu (2010): the coefficients of the jump distance.
- Ciavarella, Greenwood and Barber (2017): the loss over Tabor's parameter.
- Zheng and Yu (2007), Grierson et al. (2013): tables of pull-off for powers.
- Hayes et al. (1972): the table of κ.

Not computed: bodies whose response depends on time (Attard 2000 and 2001, Afferrante and Violano 2021), which the
program does not have; rough surfaces, large strains, and forces beyond Derjaguin's approximation."""


def rows(_):
    """There are none."""
    return []
