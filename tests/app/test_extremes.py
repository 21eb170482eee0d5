"""Claims about decks drawn at random from wide ranges."""

import pytest
from support.extremes import Broken, check_run, extreme_deck, run_deck

# Of the processor, with traps. The slowest deck, eigenvalues of 376 states on 1494 nodes at
# sigma = 1e8, takes a tenth of this.
SECONDS = 1000
# Decks of which one takes as long as fifty others: thousands of factorisations, 1500 nodes.
SLOWEST = (8, 28)


@pytest.mark.parametrize("tens", range(8))
def test_no_extreme_deck_crashes_hangs_or_hides_a_residual(snapin_path, tmp_path, tens):
    """Exit status 0, 1 or 2; no infinity, NaN or asterisk in a table; residuals as asked for."""
    for number in range(10 * tens, 10 * tens + 10):
        if number not in SLOWEST:
            check_extreme(snapin_path, tmp_path, number)


@pytest.mark.long
@pytest.mark.parametrize("number", SLOWEST)
def test_no_slow_extreme_deck_crashes_hangs_or_hides_a_residual(snapin_path, tmp_path, number):
    check_extreme(snapin_path, tmp_path, number)


def check_extreme(snapin_path, folder, number):
    """The claims of tests/support/extremes.py about a deck."""
    name = f"deck{number}"
    try:
        status, stderr, _ = run_deck(snapin_path, extreme_deck(number), folder, name, SECONDS)
        check_run(status, stderr, folder / "results" / name)
    except Broken as broken:
        pytest.fail(f"{name}: {broken}\n{extreme_deck(number)}")
