# Sourced by the commands at the top of the checkout, with `top` set to that folder: `prepare`
# brings compilers, virtual environment and build up to date. If it fails, it ends the shell: with
# status 2 and one line about the missing part, or with status 1 and the end of the log. A check
# without changes costs some tens of milliseconds. Nothing is written to standard output.

: "${top:?}"
venv=$top/.venv
build=$top/build
log=$build/setup.log
requirements=$top/tools/requirements.txt

say() { printf 'snapin: %s\n' "$*" >&2; }

give_up() { say "$*"; exit 2; }

# logged WHAT COMMAND...: one line on the terminal, everything else in the log.
logged() {
  what=$1
  shift
  say "$what"
  [ -n "${log_begun-}" ] || : > "$log"
  log_begun=yes
  printf '\n== %s\n' "$what" >> "$log"
  "$@" >> "$log" 2>&1 && return
  tail -n 25 "$log" >&2
  say "$what failed; the whole log: $log"
  exit 1
}

has() { command -v "$1" > /dev/null 2>&1; }

# links SUFFIX SOURCE COMPILER [LIBRARY...]: whether the source can be linked.
links() {
  suffix=$1 source=$2 compiler=$3
  shift 3
  has "$compiler" && scratch=$(mktemp -d) || return
  printf '%b' "$source" > "$scratch/probe.$suffix"
  "$compiler" -o "$scratch/probe" "$scratch/probe.$suffix" "$@" > /dev/null 2>&1
  linked=$?
  rm -rf "$scratch"
  return $linked
}

# The libraries that meson.build looks for. Without a compiler the package data base is used.
has_lapack() {
  if has "${FC:-gfortran}"; then
    for libraries in -lopenblas '-llapack -lblas'; do
      # shellcheck disable=SC2086 # two words are meant
      links f90 'call dgetrf\ncall dgemv\nend\n' "${FC:-gfortran}" $libraries && return
    done
    return 1
  fi
  has dpkg && dpkg -s libopenblas-dev > /dev/null 2>&1
}

python_can() { python3 -c "$1" > /dev/null 2>&1; }

# The missing Debian packages, on one line. Compilers have the names of their packages, which only
# recommend libc6-dev.
missing_packages() {
  links c '#include <stdio.h>\nint main(void) { return 0; }\n' "${CC:-cc}" ||
    printf '%s libc6-dev ' "${CC:-gcc}"
  has "${FC:-gfortran}" || printf '%s ' "${FC:-gfortran}"
  has_lapack || printf 'libopenblas-dev '
  python_can 'import venv, ensurepip' || printf 'python3-venv '
  python_can 'import os, sysconfig as s
os.stat(os.path.join(s.get_path("include"), "Python.h"))' || printf 'python3-dev '
}

install_packages() {
  has python3 || give_up "python3 (3.9 or later) is missing"
  python_can 'import sys; assert sys.version_info >= (3, 9)' ||
    give_up "python3 is older than 3.9: $(python3 --version 2>&1)"
  packages=$(missing_packages)
  packages=${packages% }
  [ -n "$packages" ] || return 0
  has apt-get ||
    give_up "missing: $packages (Debian's names); install these with this system's tools"
  [ "$(id -u)" = 0 ] ||
    give_up "missing: $packages; install with: sudo apt-get install -y $packages"
  logged 'updating the package lists' apt-get update
  # shellcheck disable=SC2086 # a list of words is meant
  from_debian $packages
  packages=$(missing_packages)
  [ -z "$packages" ] ||
    give_up "still missing for $(command -v python3) and ${FC:-gfortran}: $packages"
}

from_debian() {
  export DEBIAN_FRONTEND=noninteractive
  logged "installing $*" \
    apt-get install -y --no-install-recommends -o DPkg::Lock::Timeout=300 "$@"
}

# provides PACKAGE...: installs packages if Debian offers them, otherwise sets `reason`. A failed
# installation ends the shell.
provides() {
  dpkg -s "$@" > /dev/null 2>&1 && return
  reason="missing: $*"
  { has apt-get && [ "$(id -u)" = 0 ]; } || return
  logged 'updating the package lists' apt-get update
  apt-cache show "$@" > /dev/null 2>&1 || { reason="not in the package lists: $*"; return 1; }
  from_debian "$@"
}

make_environment() {
  rm -rf "$venv"
  logged 'making the virtual environment' python3 -m venv "$venv"
  logged 'installing meson, numpy, pytest and the like' \
    "$venv/bin/python" -m pip install --disable-pip-version-check -r "$requirements"
}

configure() {
  # Meson cannot repair a folder that was configured elsewhere or incompletely; the log is kept.
  find "$build" -mindepth 1 -maxdepth 1 ! -name "${log##*/}" -exec rm -rf {} +
  logged 'configuring' env NINJA="$venv/bin/ninja" \
    "$venv/bin/meson" setup -Dpython=enabled "$build" "$top"
}

compile() {
  case $("$venv/bin/ninja" -C "$build" -n 2>&1) in
    *'no work to do'*) ;;
    *) logged 'compiling' "$venv/bin/ninja" -C "$build" ;;
  esac
}

# Makes `import snapin` find the package and its compiled part of this checkout in the virtual
# environment's Python. Paths are relative to the folder of this file.
let_python_find_snapin() {
  for site in "$venv"/lib/python3*/site-packages; do
    [ -f "$site/snapin.pth" ] ||
      printf '../../../../%s\n' pywrap build/pywrap > "$site/snapin.pth"
  done
}

# builds FOLDER [OPTION...]: another build beside the usual one, with the compilers FC and CC.
builds() {
  folder=$1
  shift
  [ -f "$folder/build.ninja" ] || said=$("$venv/bin/meson" setup "$folder" "$@" 2>&1) ||
    { printf '%s\n' "$said" | tail -n 25; return 1; }
  "$venv/bin/meson" compile -C "$folder" > "$folder/compile.log" ||
    { tail -n 25 "$folder/compile.log"; return 1; }
}

tests() { "$venv/bin/python" -m pytest -q -n auto --dist worksteal "$@"; }

# tests_of FOLDER [PYTEST ARGUMENTS]: the tests on another build, from the top of the checkout.
tests_of() {
  folder=$1
  shift
  SNAPIN=$top/$folder/snapin tests -o pythonpath="pywrap $folder/pywrap tests tools \
tools/verify tools/reproduce tools/law" "$@"
}

# The conditions of environment and build: their place, since both contain absolute paths, the
# Python version, whether the processor has AVX2, for which the build may be, and the required
# versions.
foundation() {
  printf '%s\n' "$top" "$(readlink -f "$venv/bin/python")"
  grep -m 1 -o -w avx2 /proc/cpuinfo 2> /dev/null || :
  cat "$requirements"
}

# Stamps are written last, so that an interrupted step is done again.
is_complete() { [ -f "$1/complete" ] && [ "$(cat "$1/complete")" = "$(foundation)" ]; }

bring_up_to_date() {
  if ! { mkdir -p "$build" 2> /dev/null && [ -w "$build" ]; }; then
    # The checkout of another user: it is used as it is. Its Python may be one of that user alone.
    if [ -x "$build/snapin" ]; then
      [ "$wanted" = program ] || [ -x "$venv/bin/python" ] && return
      give_up "this user may not run the Python of this checkout, only ./run: $venv/bin/python"
    fi
    give_up "this checkout is not built, and this user may not write to it: $top"
  fi
  # These variables would redirect the new environment's Python and pip.
  unset PYTHONHOME PYTHONPATH PIP_TARGET PIP_PREFIX PIP_USER
  if ! { [ -x "$venv/bin/python" ] && is_complete "$venv" && is_complete "$build"; }; then
    install_packages
    if ! { [ -x "$venv/bin/python" ] && is_complete "$venv"; }; then
      make_environment
      foundation > "$venv/complete"
    fi
    configure
    foundation > "$build/complete"
  fi
  let_python_find_snapin
  compile
}

# Characters that Python's virtual environments, Meson and Ninja do not allow in the path of a
# folder: separators of folders in lists, and special characters in their files.
refuse_path() {
  newline='
'
  case $top in
    *"$newline"*) character='a line end' ;;
    *:*) character='a colon' ;;
    *\\*) character='a backslash' ;;
    *=*) character='an equals sign' ;;
    *) return ;;
  esac
  say "the path of this checkout has $character in it, with which it cannot be built: $top"
  give_up "move or clone it to a folder whose path has no colon, backslash, equals sign or line end"
}

# prepare [program]: with `program` Python is not needed afterwards. One process at a time in a
# checkout; in a subshell, so that the lock and the environment end with the subshell.
prepare() {
  wanted=${1-python}
  refuse_path
  (
    if has flock && ! flock -n 9; then
      say 'waiting for another set-up of this checkout'
      flock 9
    fi
    bring_up_to_date
  ) 9< "$top/tools/setup.sh" || exit
}
