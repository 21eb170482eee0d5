"""Claims about decks drawn at random from wide ranges."""

import pytest
from support.extremes import extreme_deck, try_deck

# Of the processor, with traps. The slowest deck, eigenvalues of 376 states on 1494 nodes at
# sigma = 1e8, takes a tenth of this.
SECONDS = 1000
# Decks of which one takes as long as fifty others: thousands of factorisations, 1500 nodes.
SLOWEST = (8, 28)


@pytest.mark.slow
@pytest.mark.parametrize("numbers", [
    *([number for number in range(first, first + 10) if number not in SLOWEST]
      for first in range(0, 40, 10)),
    *(pytest.param([number], marks=pytest.mark.long) for number in SLOWEST)],
    ids=lambda numbers: f"from {numbers[0]}")
def test_no_extreme_deck_crashes_hangs_or_hides_a_residual(snapin_path, tmp_path, numbers):
    """Exit status 0, 1 or 2; no infinity, NaN or asterisk in a table; residuals as asked for."""
    for number in numbers:
        result, _ = try_deck(number, tmp_path, SECONDS)
        assert not isinstance(result, str), f"{result}\n{extreme_deck(number)}"
