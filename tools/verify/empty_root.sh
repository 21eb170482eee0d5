#!/bin/sh
# tools/verify/empty_root.sh [FOLDER]: tries the wheel of FOLDER (dist/ by default) where there is
# nothing else: in a root with Debian's smallest system, Python and man, without compiler, OpenBLAS
# and gfortran's libraries. It installs the wheel, runs a deck, imports the package, draws, converts
# a file of an instrument and shows the manual page, and prints what it does.
#
# Needs root, debootstrap, and an interpreter of the root's version of Python for pip, which gathers
# the wheels of NumPy and others. ROOT is the folder of the root, which is kept for the next time if
# it is given; RELEASE is Debian's release, that of this machine by default.
set -eu
top=$(dirname -- "$(dirname -- "$(dirname -- "$(readlink -f -- "$0")")")")
wheels=$(readlink -f -- "${1:-$top/dist}")
release=${RELEASE:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
# shellcheck disable=SC2016 # apt-get fills it in
mirror=$(apt-get indextargets --format '$(SITE)' 'Identifier: Packages' | head -n 1)
if [ -n "${ROOT-}" ]; then root=$ROOT; else
  root=$(mktemp -d)
  trap 'umount "$root/proc" 2> /dev/null; rm -rf --one-file-system "$root"' EXIT
fi
# A root that the system's tools may read.
mkdir -p "$root" && chmod 755 "$root"

[ -x "$root/usr/bin/man" ] ||
  debootstrap --variant=minbase --include=python3,python3-venv,man-db "$release" "$root" "$mirror" \
    > "$root/debootstrap.log" 2>&1 ||
  { tail "$root/debootstrap.log"; exit 1; }
mountpoint -q "$root/proc" || mount -t proc proc "$root/proc"

inside() {
  chroot "$root" env -i HOME=/root LANG=C.UTF-8 PATH=/new/bin:/usr/bin:/usr/sbin "$@"
}

# Shows a command and runs it in a clean folder of the root.
shown() {
  printf '\n$ %s\n' "$1"
  inside sh -c "cd /try && $1"
}

version=$(inside python3 -c 'import sys; print("%d.%d" % sys.version_info[:2])')
tag=cp$(echo "$version" | tr -d .)
rm -rf "$root/wheels" "$root/try" "$root/new"
mkdir "$root/wheels" "$root/try"
cp "$wheels"/snapin-*-"$tag"-"$tag"-*.whl "$root/wheels/"
# What the wheel and its extras depend on.
python3 -m pip download --quiet --disable-pip-version-check --only-binary=:all: \
  --python-version "$version" --dest "$root/wheels" --find-links "$root/wheels" \
  --platform=manylinux_2_17_x86_64 --platform=manylinux2014_x86_64 \
  --platform=manylinux_2_27_x86_64 --platform=manylinux_2_28_x86_64 \
  --platform=manylinux_2_34_x86_64 --platform=manylinux_2_35_x86_64 \
  --platform=manylinux_2_36_x86_64 "$(echo "$root"/wheels/snapin-*.whl)[plots,instruments]"
cp "$top/inputs/first.nml" "$root/try/"
# A file of an instrument, from the sources of the package that reads them.
sources=$(mktemp -d)
python3 -m pip download --quiet --disable-pip-version-check --no-deps --no-binary afmformats \
  --dest "$sources" afmformats==0.18.7 > "$sources/log" 2>&1 || :
tar -xf "$sources"/afmformats-*.tar.gz -C "$sources" --wildcards '*/fmt-jpk-fd_*.jpk-force' &&
  cp "$(find "$sources" -name '*.jpk-force' | sort | head -n 1)" "$root/try/curve.jpk-force"
rm -rf "$sources"

printf 'Debian %s, Python %s, C library %s\n' "$release" "$version" \
  "$(inside ldd --version | sed -n '1s/.* //p')"
shown 'command -v cc gcc gfortran ld; ls /usr/lib/*/ | grep -E "openblas|gfortran|lapack"; true'
shown 'python3 -m venv /new'
shown "pip install --no-index --find-links=/wheels 'snapin[plots,instruments]' | tail -n 1"
shown 'snapin first.nml'
shown "python -c 'import snapin; print(snapin.__version__)
print(snapin.run(\"first.nml\").summary[\"max_tension\"])
print(snapin.pull_off(\"jkr\", radius=1e-6, stiffness=1e9, surface_energy=0.05))'"
shown 'snapin-plot results/first'
shown 'snapin-convert curve.jpk-force -o tables'
shown 'man snapin | head -n 12'
shown 'snapin --version'
