#!/bin/sh
# tools/verify/verify.sh [STAGE ...]: checks that take too long for ./test. docs/testing.md and
# docs/records/verification.md have the results.
#
# A stage is the function below with its name. Without a stage: all stages, about two hours on two
# cores. Ends with status 1 if one fails. EXTREMES (200) is the number of random decks, FIRST (5000)
# the first of them, FUZZ (240) the seconds of the search, SEED (1) that of the judge's decks, of
# the relatives and of the changes of the sources, MUTATIONS (15) their number. ROOMS (all), such as
# 'path rates', are the rooms of tests/ that traps and sanitize run, and DECKS (all) their decks,
# files or patterns.
set -u
here=$(dirname -- "$(readlink -f -- "$0")")
top=$(dirname -- "$(dirname -- "$here")")
. "$top/tools/setup.sh"
prepare
cd "$top" || exit
python="$venv/bin/python"
# Ninja may be installed alone.
PATH=$venv/bin:$PATH
export PATH

# Every test, also those that take minutes.
long() { tests --long; }

build_traps() { builds build-traps --buildtype=debug -Dtraps=true -Dpython=disabled; }

# The quick tests that run the program, and the decks, on a build that stops at the first invalid
# operation, overflow, index out of bounds or use of an unset real number.
traps() {
  build_traps && checked build-traps
}

# The same on a build with AddressSanitizer and UndefinedBehaviorSanitizer, which finds accesses
# beyond arrays and to memory that was freed, in Fortran and C alike, leaks, and overflowing
# integers. Not the tests that limit or measure the memory of a process, replace the system's calls,
# or interrupt a run after some time: a sanitizer needs these for itself.
sanitize() {
  builds build-sanitize --buildtype=debug -Db_sanitize=address,undefined -Db_lundef=false \
    -Dpython=disabled || return
  ASAN_OPTIONS=detect_leaks=1
  UBSAN_OPTIONS=suppressions=$here/overflows.txt:halt_on_error=1:print_stacktrace=1
  export ASAN_OPTIONS UBSAN_OPTIONS
  checked build-sanitize --ignore=tests/system --ignore=tests/resume \
    -k 'not does_not_fit and not thousand_decks and not interrupted_map'
}

# checked FOLDER [PYTEST ARGUMENTS]: tests and decks on this build. Tests that measure memory or time
# measure those of the usual build; those of the wrapper compare it with the program of its build.
checked() {
  checked_build=$top/$1/snapin
  "$venv/bin/ninja" -C "$1" ring_image layer_waves base_values > /dev/null || return
  shift
  for room in ${ROOMS-}; do set -- "$@" "tests/$room"; done
  SNAPIN=$checked_build tests --program -m 'not alone' --ignore=tests/wrapper "$@"
  tested=$?
  scratch=$(mktemp -d)
  # shellcheck disable=SC2086 # a list of files is meant
  OMP_NUM_THREADS=1 "$python" "$here/run_decks.py" "$checked_build" "$scratch" ${DECKS-} ||
    tested=1
  rm -rf "$scratch"
  return $tested
}

# valgrind over tools/verify/decks: no leak, no use of memory that was not set.
# Some kernels of OpenBLAS read a few lanes beyond their arguments; those for Haswell do not.
memory() {
  has valgrind || { say 'valgrind is missing: apt-get install valgrind'; return 1; }
  builds build-memory --buildtype=debugoptimized -Dpython=disabled || return
  scratch=$(mktemp -d)
  errors=0
  for deck in "$here"/decks/*.nml; do
    name=$(basename "$deck" .nml) outcome=clean
    OMP_NUM_THREADS=1 OPENBLAS_CORETYPE=Haswell valgrind -q --error-exitcode=99 --leak-check=full \
      --show-leak-kinds=definite,indirect --errors-for-leak-kinds=definite,indirect \
      "$top/build-memory/snapin" --quiet --out "$scratch" "$deck" > "$scratch/$name.log" 2>&1
    [ $? != 99 ] || { errors=1 outcome=errors; cat "$scratch/$name.log"; }
    printf 'memory: %s: %s\n' "$name" "$outcome"
  done
  rm -rf "$scratch"
  return $errors
}

# Lines of src/ that all tests but those of minutes reach, with a list of the other lines.
# gcovr merges the counts of gcov and writes the report. gcov takes counts of more than 2^32 for
# errors, and `end module` for a line, since the compiler puts copies of types there.
coverage() {
  "$python" -c 'import gcovr' 2> /dev/null ||
    "$python" -m pip install --quiet --disable-pip-version-check gcovr==8.3 || return
  builds build-coverage --buildtype=debug -Db_coverage=true -Dpython=enabled || return
  find build-coverage -name '*.gcda' -delete
  tests_of build-coverage --slow
  tested=$?
  "$python" -m gcovr -r "$top" --filter src/ --sort uncovered-percent --print-summary \
    --gcov-ignore-parse-errors=all --exclude-lines-by-pattern '\s*end module.*' \
    --txt build-coverage/coverage.txt --csv build-coverage/coverage.csv build-coverage \
    2> build-coverage/gcovr.log || return
  cat build-coverage/coverage.txt
  return $tested
}

# Differences of results between builds at -O0, -O2, -O3 and -march=native, on 1, 2 and 4 threads,
# and on OpenBLAS's kernels for other processors; then the tests on other linear algebra and
# compilers.
levels() {
  builds build-O0 -Dpython=disabled -Doptimization=0 -Ddebug=false &&
    builds build-O2 -Dpython=disabled -Doptimization=2 -Ddebug=false &&
    builds build-native -Dpython=disabled -Dprocessor=native || return
  "$python" "$here/levels.py" "$build/snapin" O0=build-O0/snapin O2=build-O2/snapin \
    native=build-native/snapin
  different=$?
  "$here/kinds.sh" && return $different
}

# Random decks with extreme values, on the build of `traps`.
extremes() {
  build_traps || return
  scratch=$(mktemp -d)
  SNAPIN=$top/build-traps/snapin PYTHONPATH=tests "$python" -m support.extremes \
    --first "${FIRST:-5000}" --count "${EXTREMES:-200}" --seconds 300 --out "$scratch"
  status=$?
  if [ $status = 0 ]; then rm -rf "$scratch"; else say "the decks are in $scratch"; fi
  return $status
}

# Every reported number, cycles, folds and the energy lost against an independent solution of the
# Lennard-Jones problem.
judge() { "$python" "$here/judge.py" --seed "${SEED:-1}"; }

# Random relatives of decks whose numbers were once wrong, each judged by another solution.
relatives() { "$python" "$here/relatives.py" --seed "${SEED:-1}"; }
# The quick tests on a build in plain C11 and POSIX.1-2008, without locks of folders and without the
# program's own path; the tests of these two cannot pass there.
posix() {
  builds build-posix -Dsystem=posix -Dpython=disabled || return
  SNAPIN=$top/build-posix/snapin tests -p no:cacheprovider \
    tests/app/test_command_line.py tests/namelist tests/resume \
    -k 'not a_second_run_is_refused and not the_command_that_draws_a_sweep'
}

# Every system call on results fails, kills the run, or is the last before a power cut.
faults() { OMP_NUM_THREADS=1 PYTHONPATH=tests "$python" -m support.faults; }

# Single places of the sources are changed at random, and a test must fail.
mutations() { "$python" "$here/mutations.py" --seed "${SEED:-1}" --count "${MUTATIONS:-15}"; }

# Builds with OpenMPI and with MPICH, which are installed if Debian offers them, and the tests of
# sweeps on many processes on each.
mpi() {
  provides libopenmpi-dev openmpi-bin mpich libmpich-dev || { say "$reason"; return 1; }
  for kind in openmpi mpich; do
    FC=mpifort.$kind CC=cc builds build-$kind -Dmpi=enabled -Dpython=disabled || return
  done
  "$python" -m pytest -q --long tests/app/test_ranks.py
}

# A coverage-guided search for decks that the reader misreads.
fuzz() {
  has afl-fuzz || { say 'AFL++ is missing: apt-get install afl++'; return 1; }
  "$top/tools/fuzz/campaign.sh" "${FUZZ:-240}" "$top/build-fuzz" || return
  found=$(find "$top"/build-fuzz/found/*/crashes "$top"/build-fuzz/found/*/hangs -name 'id:*')
  [ -z "$found" ] || { printf '%s\n' "$found"; return 1; }
}

failed=
stages='long traps sanitize memory coverage levels posix extremes faults judge'
stages="$stages relatives mutations mpi fuzz"
for stage in ${*:-$stages}; do
  case " $stages " in
    *" $stage "*) ;;
    *) give_up "no stage called $stage; there are: $stages" ;;
  esac
  say "verifying: $stage"
  $stage || failed="$failed $stage"
done
[ -z "$failed" ] || { say "failed:$failed"; exit 1; }
say 'verified'
