#!/bin/sh
# tools/site.sh [--offline]: the site of all pages in build/site, to be opened at index.html without
# a server: search, the Python API, the sources, tutorial, notebook, gallery and calculator. Packages
# that are missing are installed from the index first; with --offline they must be there, and
# nothing uses a network. A dead link is an error.
set -u
top=$(dirname -- "$(dirname -- "$(readlink -f -- "$0")")")
. "$top/tools/setup.sh"
prepare
cd "$top" || exit
needed=tools/site/requirements.txt
stamp=$venv/site_complete
if ! cmp -s "$needed" "$stamp"; then
  [ "${1-}" != --offline ] || give_up "packages of the site are missing: run tools/site.sh once"
  logged 'installing MkDocs, FORD and the like' \
    "$venv/bin/python" -m pip install --disable-pip-version-check -r "$needed"
  cp "$needed" "$stamp"
fi
rm -rf build/pages build/site
export NO_MKDOCS_2_WARNING=1
logged 'executing the notebook' "$venv/bin/python" tools/site/notebook.py build/pages/docs
logged 'laying out the pages' "$venv/bin/python" tools/site/lay_out.py pages build/pages
logged 'making the pages of the sources' \
  "$venv/bin/ford" --quiet --output_dir "$top/build/pages/sources" tools/api.md
logged 'giving these pages a style' \
  "$venv/bin/python" tools/site/lay_out.py dress build/pages/sources
logged 'building the site' "$venv/bin/mkdocs" build --quiet --strict -f tools/site/mkdocs.yml
rm build/site/404.html  # its links need a server
logged 'checking links' "$venv/bin/python" tools/site/lay_out.py links build/site
say "the site: $top/build/site/index.html"
