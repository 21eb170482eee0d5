#!/bin/sh
# tools/api.sh: pages of every public procedure and type, from the comments of the sources, in
# build/api. FORD is installed if it is missing.
set -u
top=$(dirname -- "$(dirname -- "$(readlink -f -- "$0")")")
. "$top/tools/setup.sh"
prepare
[ -x "$venv/bin/ford" ] ||
  logged 'installing FORD' \
    "$venv/bin/python" -m pip install --disable-pip-version-check ford==7.0.13
cd "$top" && exec "$venv/bin/ford" --quiet tools/api.md
