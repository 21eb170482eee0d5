#!/bin/sh
# tools/verify/verify.sh [STAGE ...]: what ./test has no time for. docs/testing.md has the results.
#
#   long       every test, those that take minutes too
#   traps      the tests that go through the program, on a build that stops at the first invalid
#              operation, overflow, index out of bounds or use of an unset real number
#   memory     valgrind over tools/verify/decks: no leak, no use of memory that was not set
#   coverage   which lines of src/ the tests reach; those that they do not are listed
#
# Without a stage: all of them, about half an hour on two cores. Ends with status 1 where one fails.
set -u
here=$(dirname -- "$(readlink -f -- "$0")")
top=$(dirname -- "$(dirname -- "$here")")
. "$top/tools/setup.sh"
prepare
cd "$top" || exit
meson="$venv/bin/meson"
python="$venv/bin/python"

# builds FOLDER OPTION...: another build beside the usual one.
builds() {
  folder=$1
  shift
  [ -f "$folder/build.ninja" ] || "$meson" setup "$folder" "$@" > /dev/null || return
  "$meson" compile -C "$folder" > "$folder/compile.log" || { tail -n 25 "$folder/compile.log"; return 1; }
}

long() { "$python" -m pytest -q --long; }

traps() {
  builds build-traps --buildtype=debug -Dtraps=true -Dpython=disabled || return
  SNAPIN=$top/build-traps/snapin "$python" -m pytest -q --long \
    $(grep -l 'snapin' tests/test_*.py | grep -v 'wrapper\|bench')
}

# OpenBLAS reads a few lanes beyond its arguments with some of its kernels; those for Haswell do not.
memory() {
  has valgrind || { say 'valgrind is missing: apt-get install valgrind'; return 1; }
  builds build-memory --buildtype=debugoptimized -Dpython=disabled || return
  scratch=$(mktemp -d)
  errors=0
  for deck in "$here"/decks/*.nml; do
    name=$(basename "$deck" .nml)
    OMP_NUM_THREADS=1 OPENBLAS_CORETYPE=Haswell valgrind -q --error-exitcode=99 --leak-check=full \
      --show-leak-kinds=definite,indirect --errors-for-leak-kinds=definite,indirect \
      "$top/build-memory/snapin" --quiet --out "$scratch" "$deck" > "$scratch/$name.log" 2>&1
    status=$?
    if [ $status = 99 ]; then
      errors=1
      cat "$scratch/$name.log"
    fi
    printf 'memory: %s: %s\n' "$name" "$([ $status = 99 ] && echo errors || echo clean)"
  done
  rm -rf "$scratch"
  return $errors
}

# gcovr merges what gcov counts and writes the report.
coverage() {
  "$python" -c 'import gcovr' 2> /dev/null ||
    "$python" -m pip install --quiet --disable-pip-version-check gcovr==8.3 || return
  builds build-coverage --buildtype=debug -Db_coverage=true -Dpython=enabled || return
  find build-coverage -name '*.gcda' -delete
  SNAPIN=$top/build-coverage/snapin "$python" -m pytest -q --long \
    -o pythonpath='pywrap build-coverage/pywrap tests' || return
  "$python" -m gcovr -r "$top" --filter src/ --sort uncovered-percent --print-summary \
    --txt build-coverage/coverage.txt --csv build-coverage/coverage.csv build-coverage
  cat build-coverage/coverage.txt
}

failed=
for stage in ${*:-long traps memory coverage}; do
  case $stage in
    long | traps | memory | coverage) ;;
    *) give_up "no stage called $stage; there are long, traps, memory, coverage" ;;
  esac
  say "verifying: $stage"
  $stage || failed="$failed $stage"
done
[ -z "$failed" ] || { say "failed:$failed"; exit 1; }
say 'verified'
