"""Claims about sweeps that are killed and continued."""

import random
import struct

from support.interrupted import frames, rows, sealed, sweep, WORD  # noqa: F401


def test_a_sweep_goes_on_from_any_record(sweep):
    parts = frames(sweep.journal)
    assert len(parts) == 10
    for count in range(len(parts) + 1):
        sweep.check(b"".join(parts[:count]))


def test_cases_count_in_whatever_order_they_were_completed(sweep):
    first, *cases = frames(sweep.journal)
    random.Random(1).shuffle(cases)
    for count in (1, 4, 8):
        sweep.check(first + b"".join(cases[:count]))


def test_a_complete_case_is_not_computed_again_and_a_damaged_record_is(sweep):
    first, *cases = frames(sweep.journal)
    # The index, whether it converged, how many numbers, sigma, ...
    changed = bytearray(cases[4])
    changed[6 * WORD : 7 * WORD] = struct.pack("<d", 12345.0)
    assert sweep.resume(first + sealed(bytes(changed))).returncode == 0
    (index,) = struct.unpack_from("<q", changed, 3 * WORD)
    found = rows(sweep.files("cut")["sweep.csv"])
    assert [i + 1 for i, row in enumerate(found) if b",1.2345" in row] == [index]
    sweep.check(first + b"".join(cases[:4]) + bytes(changed))


def test_what_was_torn_is_cut_off(sweep):
    first, *cases = frames(sweep.journal)
    ended = sweep.stop(first + b"".join(cases[:7]) + bytes(100 * len(cases[0])))
    assert sorted(len(part) for part in frames(ended)) == sorted(map(len, frames(sweep.journal)))


def test_the_number_of_threads_may_change_between_the_parts_of_a_sweep(sweep):
    sweep.threads = 1
    try:
        assert sweep.resume(b"".join(frames(sweep.journal)[:4])).returncode == 0
        assert sweep.files("cut")["sweep.csv"] == sweep.whole["sweep.csv"]
    finally:
        sweep.threads = 2


def test_a_killed_sweep_goes_on_again_and_again(sweep):
    sweep.check_killed(6, 0.0, 0.15)
