"""Removes guards from the program, one at a time, and names the test that then fails.

    guards.py [NAME ...]

A guard is a statement of a module, identified by words in it, never by its text. It is removed from
a copy of src/ with its own build; `meson` and the tests are those of this checkout. Prints a table,
and ends with status 1 if no test in a guard's list fails without the guard.
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

NOT_PASSED = "equilibrium/test_iterations.py"
STARVED = "app/test_unconverged.py::test_what_does_not_converge_says_so_and_invents_nothing"
UNCONVERGED_ROW = ("app/test_unconverged.py"
                   "::test_a_row_that_is_no_equilibrium_is_neither_stable_nor_unstable")
BEYOND_ROUNDING = ("app/test_ranges.py"
                   "::test_sigma_out_of_any_range_is_solved_or_said_to_be_beyond_rounding")
NO_LENGTH = ("model/test_forces.py"
             "::test_a_power_has_no_length_that_others_could_be_too_long_or_short_for")
POWER_CUT = ("system/test_faults.py"
             "::test_a_power_failure_at_any_call_leaves_one_set_of_results_or_says_so")
LIMITED = ("resume/test_unwritable.py"
           "::test_a_journal_that_cannot_grow_stops_a_run_that_then_goes_on")
FAULTS = "system/test_faults.py"


class Guard(NamedTuple):
    """The name of the guard; the module, words of the statement, and its change; the tests that
    fail without it.

    A statement is `gone`; its condition is `never` or `always` true; a `swap` replaces a name with
    its owners by another expression; a `value` is assigned; `or` adds a condition.
    """

    what: str
    module: str
    words: str
    change: tuple
    tests: tuple
    traps: bool = False
    # If a second statement replaces the first: its words and its change.
    also: tuple = ()


GONE, NEVER, ALWAYS = ("gone",), ("never",), ("always",)
GUARDS = {
    "smallest_gap": Guard("gaps that the law is not asked for", "equilibrium", "least smallest_gap",
        ("swap", "smallest_gap", "-largest_unknown"),
        ("app/test_unconverged.py::test_what_came_before_the_fall_is_kept",), traps=True),
    "defined": Guard("what is outside the law's domain has no residual", "equilibrium",
        "if defined problem", NEVER, (NOT_PASSED,), also=("if error huge", NEVER)),
    "largest_step": Guard("a step keeps every gap within the law's closure limit", "equilibrium",
        "limit min minval", ("swap", "min", "max"), (NOT_PASSED,)),
    "largest_floor": Guard("rounding excuses residuals only up to 1e-3", "equilibrium",
        "residual_floor min largest_floor", GONE,
        ("app/test_ranges.py::test_no_residual_above_a_thousandth_is_put_down_to_rounding",)),
    "lost_in_rounding": Guard("adhesion beyond rounding is refused", "contact_scales",
        "coupling_over largest_floor", ("swap", "largest_floor", "huge(1.0_wp)"),
        (BEYOND_ROUNDING,)),
    "anderson_nan": Guard("Anderson's convergence is a comparison that NaN fails", "anderson",
        "converged holds", ("or", ".not. state%residual < huge(1.0_wp)"), (NOT_PASSED,)),
    "rejected_mixing": Guard("accelerated mixing returns from residuals that have grown",
        "anderson_mixing", "if iteration growth least", ALWAYS,
        ("equilibrium/test_anderson_mixing.py::"
         "test_rejected_steps_are_counted_and_the_iteration_restarts",)),
    "stable_by_products": Guard("products tell unstable states", "stability_by_products",
        "stable pivot", ("value", ".true."),
        ("equilibrium/test_anderson_mixing.py::"
         "test_stability_is_that_of_the_dense_eigenvalues",)),
    "hidden_folds": Guard("folds that a step passes over are looked for", "path_extrema",
        "if doubt held most_states", ("swap", "most_states", "0"),
        ("path/test_close_folds.py::test_folds_however_close_are_found",)),
    "converged_column": Guard("a row that is no equilibrium says so", "tables",
        "merge converged", ("swap", "converged", ".true."), (STARVED,)),
    "unconverged_stable": Guard("a row that is no equilibrium is not stable", "stability_records",
        "if converged", ALWAYS, (UNCONVERGED_ROW,)),
    "known_stability": Guard("an eigenvalue does not change what is known of stability",
        "stability_records", "if stable stable_unasked", ALWAYS,
        ("equilibrium/test_stability.py::test_the_group_leaves_the_path_as_it_is",)),
    "failed_case": Guard("a case of a sweep that fails is counted", "sweep_case",
        "if converged failed", GONE,
        ("report/test_sweep_columns.py", "report/test_results.py")),
    "memory": Guard("matrices larger than the memory are refused", "preflight",
        "if bytes available then", NEVER,
        ("app/test_preflight.py::test_what_does_not_fit_leaves_older_results_and_can_be_resumed",)),
    "under_resolved": Guard("under-resolved meshes are warned of", "quality_warnings",
        "call warn under-resolved", GONE, ("experiment/test_cycle_grids.py",)),
    "folder_lock": Guard("one run at a time in a folder", "folder_lock",
        "if locked_elsewhere return", ALWAYS,
        ("resume/test_resume_whose.py::test_a_second_run_is_refused_and_touches_nothing",)),
    "checksum": Guard("a damaged record of the journal does not count",
        "journal_frame", "if checksum words", GONE,
        ("resume/test_resume_sweep.py"
         "::test_a_complete_case_is_not_computed_again_and_a_damaged_record_is",)),
    "owner": Guard("a journal of another deck or program is not continued", "journal",
        "if other owner", NEVER,
        ("resume/test_resume_whose.py::test_another_deck_is_refused_and_told_apart",)),
    "files": Guard("results of another table or profile are not taken for those of this one",
        "data_table", "call note_file", GONE, ("resume/test_resume_files.py",)),
    "far_gaps": Guard("gaps where no force acts do not limit steps", "equilibrium",
        "closure harmless far_gap", ("swap", "harmless", "0.0_wp"),
        ("app/test_ranges.py::test_gaps_of_a_million_lengths_do_not_limit_steps",)),
    "no_length": Guard("a sum is not scanned in the units of a term that has none", "van_der_waals",
        "has_length false", GONE, (NO_LENGTH,)),
    "torn": Guard("what was torn is cut off the journal", "journal", "c_cut descriptor whole",
        ("swap", "whole", "self%room*word_bytes"),
        ("resume/test_resume_sweep.py::test_what_was_torn_is_cut_off",)),
    "journal_flush": Guard("a record of the journal that the system could not write stops the run",
        "journal", "call check_status trouble write", GONE, (LIMITED,)),
    "table_flush": Guard("a table that the system could not write is an error", "text_file",
        "call check_status cannot write status", GONE,
        ("report/test_results.py", "resume/test_unwritable.py")),
    "summary_first": Guard("no summary stands beside files that are not of its run", "publication",
        "call remove_file summary_name", GONE, (FAULTS,)),
    "others_files": Guard("a file that no run has written is not replaced", "publication",
        "else if is_of_run name", NEVER, ("report/test_others_files.py",)),
    "folder_name": Guard("results in a new folder are not complete before its name is on the disk",
        "publication", "call sync_above", GONE, (POWER_CUT,)),
    "table_sync": Guard("a table is on the disk before it gets its name", "text_file",
        "synced c_sync", ("value", "0"), (FAULTS,)),
    "regular": Guard("what is no file is not opened as one", "posix", "if S_ISREG found",
        NEVER, (FAULTS,)),
    "duplicate_key": Guard("a key given twice is a mistake", "deck", "what given twice", GONE,
        ("namelist/test_deck.py::test_bad_deck_is_refused_by_line_group_and_key",)),
    "magnitudes": Guard("units that would overflow are refused", "group_reading",
        "if decades largest", NEVER,
        ("app/test_ranges.py::test_units_that_would_overflow_together_are_refused",)),
    "order": Guard("numbers beyond 1e50 are refused", "deck_number", "parameter largest_order",
        ("value", "300"), ("namelist/test_deck.py", "app/test_ranges.py")),
}


def source_of(module, top=ROOT):
    return next(path for path in sorted((top / "src").rglob(f"{module}.*")) if path.suffix in
                (".f90", ".c"))


def statements(text, words):
    """The beginnings and ends of statements that contain all of these words; comments do not
    count."""
    wanted = [re.compile(rf"(?<![\w-]){re.escape(word)}(?![\w-])") for word in words.split()]
    found = []
    # A statement continues on the next line after &.
    for match in re.finditer(r"^(?:[^\n]*&[ \t]*\n)*[^\n]*$", text, re.MULTILINE):
        if not match[0].lstrip().startswith(("!", "/*")) and all(
                word.search(match[0]) for word in wanted):
            found.append(match.span())
    return found


def changed(text, words, change):
    """The text with every such statement changed; None if there is none."""
    spans = statements(text, words)
    for start, end in reversed(spans):
        text = text[:start] + _changed(text[start:end], *change) + text[end:]
    return text if spans else None


def _changed(statement, kind, old="", new=""):
    in_c = "S_IS" in statement
    if kind == "gone":
        return "continue"
    if kind == "swap":
        return re.sub(rf"(?:\w+%)*\b{old}\b", lambda _: new, statement)
    if kind == "value":
        return re.sub(r"=[^=]*$", f"= {old}", statement)
    if kind == "or":
        return f"{statement} &\n .or. {old}"
    start = re.search(r"\bif \(", statement).end()
    depth = end = 0
    for end, sign in enumerate(statement[start:], start):
        depth += (sign == "(") - (sign == ")")
        if depth < 0:
            break
    truth = {"never": "0" if in_c else ".false.", "always": ".true."}[kind]
    return statement[:start] + truth + statement[end:]


def first_failure(program, tests):
    """The name of the first test that fails, or None."""
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider",
         "-o", f"pythonpath=pywrap {program.parent}/pywrap tests tools/verify",
         *(f"tests/{test}" for test in tests)],
        cwd=ROOT, env={**os.environ, "SNAPIN": str(program)}, capture_output=True, text=True,
        check=False)
    if done.returncode == 0:
        return None
    found = re.search(r"^(?:FAILED|ERROR) (.*?)(?: - .*)?$", done.stdout, re.MULTILINE)
    if found is None:
        sys.exit(done.stdout[-2000:] + done.stderr[-2000:])
    return found.group(1).removeprefix("tests/")


def without(copy, guard):
    """The first test that fails without a guard, or None."""
    path = source_of(guard.module, copy)
    text = path.read_text()
    without_it = changed(text, guard.words, guard.change)
    if guard.also:
        without_it = changed(without_it, *guard.also)
    path.write_text(without_it)
    build = copy / ("traps" if guard.traps else "plain")
    try:
        done = subprocess.run([MESON, "compile", "-C", build], capture_output=True, text=True,
                              check=False)
        if done.returncode:
            sys.exit(f"{guard.what}: does not compile without it\n{done.stdout[-2000:]}")
        return first_failure(build / "snapin", guard.tests)
    finally:
        path.write_text(text)


def main():
    alone = []
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        shutil.copytree(ROOT, copy, dirs_exist_ok=True, ignore=shutil.ignore_patterns(
            ".*", "build", "build-*", "results", "__pycache__"))
        for build, options in (
                ("plain", ["-Dpython=enabled"]),
                ("traps", ["-Dpython=disabled", "--buildtype=debug", "-Dtraps=true"])):
            subprocess.run([MESON, "setup", copy / build, copy, *options], capture_output=True,
                           check=True)
        print("| guard removed | where | test that fails |\n|---|---|---|", flush=True)
        for name in sys.argv[1:] or GUARDS:
            guard = GUARDS[name]
            test = without(copy, guard)
            if test is None:
                alone.append(name)
            cell = f"`{test}`" if test else "none"
            print(f"| {guard.what} | `{guard.module}` | {cell} |", flush=True)
    for name in alone:
        print(f"no test fails without {name}")
    return 1 if alone else 0


if __name__ == "__main__":
    sys.exit(main())
