#!/bin/sh
# tools/verify/kinds.sh [PYTEST ARGUMENTS]: runs the tests once for each kind of linear algebra that
# this machine can run, OpenBLAS's kernels for other processors (OPENBLAS_CORETYPE) and the
# reference LAPACK, and for each other compiler, which has the name of its Debian package. The
# results are then compared with those of the usual build (levels.py). Without arguments the quick
# tests are run: on other linear algebra those of rooms that compute, on other compilers all but
# those of tools and of the contact law, which are not compiled by them. Missing packages are
# installed. Kinds that are not available are skipped with a message. Ends with status 1 if a test
# fails. KINDS is the list of kinds.
set -u
here=$(dirname -- "$(readlink -f -- "$0")")
top=$(dirname -- "$(dirname -- "$here")")
. "$top/tools/setup.sh"
prepare
cd "$top" || exit
PATH=$venv/bin:$PATH
export PATH
rooms='tests/equilibrium tests/experiment tests/fit tests/mesh tests/model tests/path tests/rates
tests/theory'

# flags NAME...: whether the processor has all of these features.
flags() {
  for flag in "$@"; do
    grep -qw "$flag" /proc/cpuinfo 2> /dev/null || return
  done
}

# core KERNEL: the kernel that OpenBLAS takes when it is asked for this one, or for none.
core() {
  OPENBLAS_CORETYPE=$1 OPENBLAS_VERBOSE=2 "$build/snapin" --version 2>&1 |
    sed -n 's/^.*Core: *//p'
}

# has_kernel KERNEL: whether the processor has the required features, this OpenBLAS has the kernel,
# and would not take it anyway.
has_kernel() {
  case $1 in
    Prescott) flags pni ;;
    Haswell | Zen) flags avx2 fma ;;
    SkylakeX) flags avx512f avx512dq avx512bw avx512vl ;;
  esac || { reason='this processor cannot run it'; return 1; }
  [ "$(core "$1")" = "$1" ] || { reason='this build has no such kernel'; return 1; }
  [ "$(core '')" != "$1" ] || { reason='the usual tests run on it'; return 1; }
}

# Debian installs the reference libraries beside OpenBLAS's, which have the same names.
reference_libraries() {
  for folder in /usr/lib/*/lapack /usr/lib/*/blas; do
    [ -d "$folder" ] && printf '%s:' "$folder"
  done
}

has_reference() { [ -n "$(reference_libraries)" ] || provides liblapack-dev libblas-dev; }

# The C compiler of the same version as a Fortran compiler.
c_compiler() {
  case $1 in
    flang-*) echo "clang-${1#*-}" ;;
    *) echo "gcc-${1#*-}" ;;
  esac
}

has_compiler() {
  case $1 in flang-*) openmp=libomp-${1#*-}-dev ;; *) openmp= ;; esac
  # shellcheck disable=SC2086 # without OpenMP, no word
  provides "$1" "$(c_compiler "$1")" $openmp
}

kernel() {
  export OPENBLAS_CORETYPE="$1"
  shift
  tests -p no:cacheprovider "$@"
}

reference() {
  shift
  builds build-lapack -Dblas=lapack -Dpython=enabled || return
  LD_LIBRARY_PATH=$(reference_libraries)${LD_LIBRARY_PATH-}
  export LD_LIBRARY_PATH
  if ldd build-lapack/snapin | grep -q openblas; then
    say 'build-lapack runs on OpenBLAS after all'
    return 1
  fi
  tests_of build-lapack -p no:cacheprovider "$@"
}

# The results of all decks are compared too.
compiler() {
  name=$1
  shift
  FC=$name
  CC=$(c_compiler "$name")
  export FC CC
  builds "build-$name" -Dpython=enabled || return
  # LLVM's OpenMP leaves an empty file if a process is killed during its start, and a later process
  # with the same number crashes because of the file (SIGBUS).
  rm -f /*/__KMP_REGISTERED_LIB_* /*/*/__KMP_REGISTERED_LIB_*
  tests_of "build-$name" -p no:cacheprovider "$@"
  tested=$?
  "$venv/bin/python" "$here/levels.py" --builds "$build/snapin" "$name=build-$name/snapin" \
    > "build-$name/levels.log" 2>&1 || { cat "build-$name/levels.log"; return 1; }
  tail -n 4 "build-$name/levels.log"
  return $tested
}

failed=
for kind in ${KINDS:-Prescott Haswell SkylakeX Zen reference flang-22 gfortran-11}; do
  reason=
  case $kind in
    reference) sort=reference title='the reference LAPACK' ;;
    flang-* | gfortran-*) sort=compiler title="a build by $kind" ;;
    *) sort=kernel title="OpenBLAS's $kind kernels" ;;
  esac
  if "has_$sort" "$kind"; then
    say "tests on $title"
    (
      # shellcheck disable=SC2086 # a list of words is meant
      [ $# -gt 0 ] || case $sort in
        compiler) set -- --ignore=tests/tools --ignore=tests/contact_law ;;
        *) set -- $rooms ;;
      esac
      "$sort" "$kind" "$@"
    ) || failed="$failed $kind"
  else
    say "skipped: $title: $reason"
  fi
done
[ -z "$failed" ] || { say "failed:$failed"; exit 1; }
