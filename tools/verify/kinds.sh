#!/bin/sh
# tools/verify/kinds.sh [PYTEST ARGUMENTS]: the tests once for each kind of linear algebra that this
# machine can run: OpenBLAS's kernels for other processors (OPENBLAS_CORETYPE), and the reference
# LAPACK. Without arguments the quick ones, -m 'not slow and not long'. Kinds that cannot be had are
# skipped, which is said. Ends with status 1 where a test fails. KINDS is the list of kinds.
set -u
here=$(dirname -- "$(readlink -f -- "$0")")
top=$(dirname -- "$(dirname -- "$here")")
. "$top/tools/setup.sh"
prepare
cd "$top" || exit
PATH=$venv/bin:$PATH
export PATH
[ $# -gt 0 ] || set -- -m 'not slow and not long'

# flags NAME...: whether the processor has all of these features.
flags() {
  for flag in "$@"; do
    grep -qw "$flag" /proc/cpuinfo 2> /dev/null || return
  done
}

# can KERNEL: whether the processor has what it needs, and this OpenBLAS has the kernel.
can() {
  case $1 in
    Prescott) flags pni ;;
    Haswell | Zen) flags avx2 fma ;;
    SkylakeX) flags avx512f avx512dq avx512bw avx512vl ;;
  esac || { reason='this processor cannot run it'; return 1; }
  OPENBLAS_CORETYPE=$1 OPENBLAS_VERBOSE=2 "$build/snapin" --version 2>&1 |
    grep -qix "core: $1" || { reason='this build has no such kernel'; return 1; }
}

tests() { "$venv/bin/python" -m pytest -q -n auto --dist worksteal -p no:cacheprovider "$@"; }

# Debian keeps the reference libraries beside OpenBLAS's, which answers to their names.
reference_libraries() {
  for folder in /usr/lib/*/lapack /usr/lib/*/blas; do
    [ -d "$folder" ] && printf '%s:' "$folder"
  done
}

has_reference() {
  [ -n "$(reference_libraries)" ] && return
  reason='liblapack-dev and libblas-dev are missing'
  { has apt-get && [ "$(id -u)" = 0 ]; } || return
  say 'installing liblapack-dev libblas-dev'
  { apt-get update && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
    liblapack-dev libblas-dev; } > /dev/null 2>&1
  [ -n "$(reference_libraries)" ]
}

reference() {
  folder=$top/build-lapack
  [ -f "$folder/build.ninja" ] ||
    meson setup -Dblas=lapack -Dpython=enabled "$folder" > /dev/null || return
  meson compile -C "$folder" > "$folder/compile.log" ||
    { tail -n 25 "$folder/compile.log"; return 1; }
  LD_LIBRARY_PATH=$(reference_libraries)${LD_LIBRARY_PATH-}
  export LD_LIBRARY_PATH
  if ldd "$folder/snapin" | grep -q openblas; then
    say 'build-lapack runs on OpenBLAS after all'
    return 1
  fi
  SNAPIN=$folder/snapin tests -o pythonpath="pywrap build-lapack/pywrap tests" "$@"
}

failed=
for kind in ${KINDS:-Prescott Haswell SkylakeX Zen reference}; do
  reason=
  if [ "$kind" = reference ]; then
    if has_reference; then
      say 'tests on the reference LAPACK'
      (reference "$@") || failed="$failed $kind"
    else
      say "skipped: reference LAPACK: $reason"
    fi
  elif can "$kind"; then
    say "tests on OpenBLAS's $kind kernels"
    OPENBLAS_CORETYPE=$kind tests "$@" || failed="$failed $kind"
  else
    say "skipped: OpenBLAS's $kind kernels: $reason"
  fi
done
[ -z "$failed" ] || { say "failed:$failed"; exit 1; }
