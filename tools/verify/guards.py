"""Takes guards out of the program, one at a time, and names the test that then fails.

    guards.py [NAME ...]

works on a copy of src/ with a build of its own; `meson` and the tests are this checkout's. Prints a
table, and ends with status 1 where a guard can go without any test of its list failing.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
from typing import NamedTuple

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MESON = ROOT / ".venv" / "bin" / "meson"


ANY_SIGMA = (
    "experiment/test_hard_cases.py"
    "::test_cycle_at_any_sigma_is_solved_and_agrees_with_the_path"
)
NOT_PASSED = "equilibrium/test_iterations.py"
STARVED = "app/test_unconverged.py::test_what_does_not_converge_says_so_and_invents_nothing"


class Guard(NamedTuple):
    """A line of src/ and what takes its place, and the tests that know it."""

    what: str
    file: str
    old: str
    new: str
    tests: tuple
    traps: bool = False
    # Where a second line would do for the first: what else goes.
    also: tuple = ()


GUARDS = {
    "smallest_gap": Guard(
        "gaps that the law is not asked for",
        "equilibrium/equilibrium.f90",
        "least = max(problem%law%smallest_gap, -largest_unknown)",
        "least = -largest_unknown",
        ("app/test_unconverged.py::test_what_came_before_the_fall_is_kept",),
        traps=True,
    ),
    "defined": Guard(
        "what is outside the law's domain has no residual",
        "equilibrium/equilibrium.f90",
        "if (.not. defined(problem, state)) then",
        "if (.false.) then",
        (NOT_PASSED,),
        also=("if (.not. error <= huge(error)) then", "if (.false.) then"),
    ),
    "largest_step": Guard(
        "a step keeps every gap within the law's closure limit",
        "equilibrium/equilibrium.f90",
        "limit = min(1.0_wp, minval(",
        "limit = max(1.0_wp, minval(",
        (ANY_SIGMA,),
    ),
    "largest_floor": Guard(
        "rounding excuses residuals only up to 1e-3",
        "equilibrium/equilibrium.f90",
        "residual_floor = min(residual_floor, largest_floor)",
        "",
        ("app/test_ranges.py::test_no_residual_above_a_thousandth_is_put_down_to_rounding",),
    ),
    "lost_in_rounding": Guard(
        "adhesion beyond rounding is refused",
        "mesh/contact_scales.f90",
        "coupling_over(problem, c)) > largest_floor",
        "coupling_over(problem, c)) > huge(1.0_wp)",
        (
            "app/test_ranges.py"
            "::test_sigma_out_of_any_range_is_solved_or_said_to_be_beyond_rounding",
        ),
    ),
    "anderson_nan": Guard(
        "Anderson's convergence is a comparison that NaN fails",
        "equilibrium/anderson.f90",
        "converged = holds(equations%problem, options%tolerance, state)\n      if (converged",
        "converged = holds(equations%problem, options%tolerance, state) &\n"
        "        .or. .not. state%residual < huge(1.0_wp)\n      if (converged",
        (NOT_PASSED,),
    ),
    "hidden_folds": Guard(
        "folds that a step passes over are looked for",
        "path/path_search.f90",
        "if (doubt .and. near%held < most_states) then",
        "if (doubt .and. near%held < 0) then",
        ("path/test_close_folds.py::test_folds_however_close_are_found",),
    ),
    "converged_column": Guard(
        "a row that is no equilibrium says so",
        "report/curve_rows.f90",
        "merge(1, 0, record%converged)",
        "1",
        (STARVED,),
    ),
    "unconverged_stable": Guard(
        "a row that is no equilibrium is not stable",
        "report/stability_records.f90",
        "if (record%converged) then",
        "if (.true.) then",
        (
            "app/test_unconverged.py"
            "::test_a_row_that_is_no_equilibrium_is_neither_stable_nor_unstable",
        ),
    ),
    "known_stability": Guard(
        "an eigenvalue does not change what is known of stability",
        "report/stability_records.f90",
        "else if (record%stable == stable_unasked) then",
        "else if (.true.) then",
        ("equilibrium/test_stability.py::test_the_group_leaves_the_path_as_it_is",),
    ),
    "failed_case": Guard(
        "a case of a sweep that fails is counted",
        "app/sweeps.f90",
        "if (.not. case%converged) self%failed = self%failed + 1",
        "self%failed = 0",
        ("report/test_sweep_columns.py", "report/test_results.py"),
    ),
    "memory": Guard(
        "matrices larger than the memory are refused",
        "app/preflight.f90",
        "if (bytes > available) then",
        "if (.false.) then",
        (
            "app/test_preflight.py"
            "::test_what_does_not_fit_leaves_older_results_and_can_be_resumed",
        ),
    ),
    "under_resolved": Guard(
        "under-resolved meshes are warned of",
        "report/quality_warnings.f90",
        "call summary%warn('under-resolved: nodes are '",
        "if (.false.) call summary%warn('under-resolved: nodes are '",
        ("experiment/test_cycle_grids.py",),
    ),
    "folder_lock": Guard(
        "one run at a time in a folder",
        "system/folder_lock.f90",
        "if (sort /= locked_elsewhere) return",
        "return",
        ("resume/test_resume_whose.py::test_a_second_run_is_refused_and_touches_nothing",),
    ),
    "checksum": Guard(
        "a damaged record of the journal does not count",
        "resume/journal.f90",
        "if (checksum(words) /= head(2)) return",
        "",
        ("resume/test_resume_sweep.py::test_a_damaged_record_is_computed_again",),
    ),
    "owner": Guard(
        "a journal of another deck or program is not continued",
        "resume/journal.f90",
        "if (other /= owner) then",
        "if (.false.) then",
        ("resume/test_resume_whose.py::test_another_deck_is_refused_and_told_apart",),
    ),
    "files": Guard(
        "results of another table or profile are not taken for those of this one",
        "namelist/data_table.f90",
        "call deck%note_file(group, key, checksum(columns%source%text))",
        "",
        ("resume/test_resume_files.py",),
    ),
    "far_gaps": Guard(
        "a path is not lost for gaps where no force acts",
        "equilibrium/equilibrium.f90",
        "max(problem%law%closure(gap), harmless*(gap - far_gap))",
        "problem%law%closure(gap)",
        ("path/test_barrier.py::test_the_path_does_not_depend_on_gaps_where_no_force_acts",),
    ),
    "no_length": Guard(
        "a sum is not scanned in the units of a term that has none",
        "model/laws/van_der_waals.f90",
        "this%has_length = .false.",
        "",
        (
            "model/test_forces.py"
            "::test_a_power_has_no_length_that_others_could_be_too_long_or_short_for",
        ),
    ),
    "torn": Guard(
        "what was torn is cut off the journal",
        "resume/journal.f90",
        "status = c_cut(self%descriptor, whole, first)",
        "status = c_cut(self%descriptor, self%room*word, first)",
        ("resume/test_resume_sweep.py::test_what_was_torn_is_cut_off",),
    ),
    "journal_flush": Guard(
        "a record of the journal that the system could not write stops the run",
        "resume/journal.f90",
        "call system_failure('cannot write ' // self%path, status, self%trouble)",
        "if (status < 0) return",
        (
            "resume/test_unwritable.py"
            "::test_a_limit_on_the_size_of_files_stops_a_run_that_then_goes_on",
        ),
    ),
    "table_flush": Guard(
        "a table that the system could not write is an error",
        "system/text_file.f90",
        "call system_failure('cannot write ' // self%path, status, error)",
        "",
        ("report/test_results.py", "resume/test_unwritable.py"),
    ),
    "intent_last": Guard(
        "a folder says that its files may not belong together until they are cleaned up",
        "system/publication.f90",
        "call folder%rename_file(intent_name // partial, intent_name, error)",
        "continue",
        ("system/test_faults.py",),
    ),
    "folder_name": Guard(
        "results in a new folder are not complete before its name is on the disk",
        "system/publication.f90",
        "call folder%sync_above(error)",
        "continue",
        (
            "system/test_faults.py"
            "::test_a_power_failure_at_any_call_leaves_one_set_of_results_or_says_so",
        ),
    ),
    "table_sync": Guard(
        "a table is on the disk before it gets its name",
        "system/text_file.f90",
        "synced = c_sync(self%descriptor)",
        "synced = 0",
        ("system/test_faults.py",),
    ),
    "regular": Guard(
        "what is no file is not opened as one",
        "system/posix.c",
        "else if (!S_ISREG(file.st_mode))",
        "else if (0)",
        ("system/test_faults.py",),
    ),
    "duplicate_key": Guard(
        "a key given twice is a mistake",
        "namelist/deck.f90",
        "what = 'given twice; the first is on line ' // trim(line)",
        "",
        ("namelist/test_deck.py::test_bad_deck_is_refused_by_line_group_and_key",),
    ),
    "magnitudes": Guard(
        "units that would overflow are refused",
        "model/law_reading.f90",
        "if (.not. abs(decades) <= most_decades)",
        "if (.false.)",
        ("app/test_ranges.py::test_units_that_would_overflow_together_are_refused",),
    ),
    "order": Guard(
        "numbers beyond 1e50 are refused",
        "namelist/deck_number.f90",
        "largest_order = 50",
        "largest_order = 300",
        ("namelist/test_deck.py", "app/test_ranges.py"),
    ),
}


def compiled(copy, build):
    """The program of a copy of the sources."""
    done = subprocess.run(
        [MESON, "compile", "-C", copy / build], capture_output=True, text=True, check=False
    )
    if done.returncode:
        sys.exit(done.stdout[-2000:])
    return copy / build / "snapin"


def first_failure(program, tests):
    """The name of the first test that fails, or None."""
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider"]
        + ["-o", f"pythonpath=pywrap {program.parent}/pywrap tests"]
        + [f"tests/{test}" for test in tests],
        cwd=ROOT,
        env={**os.environ, "SNAPIN": str(program)},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == 0:
        return None
    found = re.search(r"^(?:FAILED|ERROR) (.*?)(?: - .*)?$", done.stdout, re.MULTILINE)
    if found is None:
        sys.exit(done.stdout[-2000:] + done.stderr[-2000:])
    return found.group(1).removeprefix("tests/")


def without(copy, guard):
    """The first test that fails without a guard, or None."""
    path = copy / "src" / guard.file
    text = path.read_text()
    changed = text
    for old, new in filter(None, ((guard.old, guard.new), guard.also)):
        if text.count(old) != 1:
            sys.exit(f"{guard.file} no longer has, once: {old}")
        changed = changed.replace(old, new)
    path.write_text(changed)
    try:
        program = compiled(copy, "traps" if guard.traps else "plain")
        return first_failure(program, guard.tests)
    finally:
        path.write_text(text)


def main():
    names = sys.argv[1:] or list(GUARDS)
    alone = []
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for name in ("src", "pywrap", "tools"):
            shutil.copytree(ROOT / name, copy / name)
        for name in ("meson.build", "meson.options"):
            shutil.copy(ROOT / name, copy)
        for build, options in (
            ("plain", ["-Dpython=enabled"]),
            ("traps", ["-Dpython=disabled", "--buildtype=debug", "-Dtraps=true"]),
        ):
            subprocess.run(
                [MESON, "setup", copy / build, copy, *options],
                capture_output=True,
                check=True,
            )
        print("| guard removed | where | test that fails |")
        print("|---|---|---|", flush=True)
        for name in names:
            guard = GUARDS[name]
            test = without(copy, guard)
            if test is None:
                alone.append(name)
            cell = f"`{test}`" if test else "none"
            print(f"| {guard.what} | `{guard.file}` | {cell} |", flush=True)
    for name in alone:
        print(f"no test fails without {name}")
    return 1 if alone else 0


if __name__ == "__main__":
    sys.exit(main())
