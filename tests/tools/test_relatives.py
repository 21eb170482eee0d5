"""Samples of the relatives of tools/verify/relatives.py, and what its verdicts mean."""

import pytest
from relatives import FAMILY_OF, examine, table
from support.relatives import Job, Judged, is_told, numbers_verdict


# Cheap ones: a grid near the cusp, ends, closed forms, the local criterion, springs, a step.
@pytest.mark.parametrize("kind, number", [
    ("small_jump", 2), ("ends", 1), ("regime", 0), ("criterion_28", 2), ("creep", 0),
    ("step", 2), ("outer", 2), ("spring", 1), ("punch", 3), ("noisy_table", 1)])
def test_no_relative_is_wrong_in_silence(tmp_path, snapin_path, kind, number):
    judged = examine(Job(kind, number, 1, tmp_path))
    assert judged.silent == []
    assert judged.verdict in ("within", "told") and (judged.within or judged.told)


def test_a_number_outside_its_error_is_silent_without_a_warning(tmp_path):
    job = Job("ends", 0, 1, tmp_path)
    off = [("max_tension", 1e-3, 1e-4), ("end_load", 1e-6, 1e-4)]
    for told, verdict in ((False, "silent"), (True, "told")):
        judged = numbers_verdict(job, "", told, off)
        assert judged.verdict == verdict and judged.within == 1
    # A missing jump is as wrong as a number, and an error that is no number never holds.
    assert numbers_verdict(job, "", False, [], ["jump_in_h0 missing"]).verdict == "silent"
    assert numbers_verdict(job, "", False, [("end_load", float("nan"), 1.0)]).verdict == "silent"
    assert Judged.lost(job, "", False, "crash").verdict == "silent"
    assert Judged.lost(job, "", False, "more than 15 s").verdict == "undecided"


def test_a_warning_about_the_model_tells_nothing_of_numbers():
    assert not is_told(["beyond the model: the largest pressure is 0.3 of the stiffness"])
    assert is_told(["the error is estimated as 0.1, above the accuracy of 1e-6 asked for"])
    assert is_told([], status=1)


def test_the_table_counts_kinds_and_numbers(tmp_path):
    ones = [numbers_verdict(Job("ends", i, 1, tmp_path), "", False, [("end_load", error, 1.0)])
            for i, error in enumerate((0.5, 2.0))]
    head, row, total = table(ones)
    assert head.split()[:4] == ["kind", "relatives", "within", "told"]
    assert row.split() == ["ends", "2", "1", "0", "1", "0", "2", "1", "0", "1"]
    assert total.split()[1:] == row.split()[1:]


def test_every_kind_has_a_family():
    assert len(FAMILY_OF) == 17
