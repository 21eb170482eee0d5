#!/bin/sh
# tools/verify/windows.sh [PYTEST ARGUMENTS]: builds the program for Windows with MinGW-w64 and runs
# quick tests of it under Wine; by default those of the command line, decks and results that need no
# signals, limits or locks of other systems. The linear algebra is the reference BLAS and LAPACK,
# compiled from Debian's source package. Missing packages are installed. The Python package is not
# built for Windows: the tests' own Python is that of this machine.
set -u
here=$(dirname -- "$(readlink -f -- "$0")")
top=$(dirname -- "$(dirname -- "$here")")
. "$top/tools/setup.sh"
prepare
PATH=$venv/bin:$PATH
cd "$top" || exit
folder=$top/build-windows
libraries=$folder-lapack
target=x86_64-w64-mingw32
wine=/usr/lib/wine/wine64
export WINEDEBUG=-all WINEPREFIX="$folder-wine"

provides gfortran-mingw-w64-x86-64 gcc-mingw-w64-x86-64 wine64 || give_up "$reason"

# The source of LAPACK, from the lists of the machine's release with sources beside them.
lapack_source() {
  [ -d "$libraries/source" ] && return
  mkdir -p "$libraries/lists" "$libraries/parts" &&
    find /etc/apt/sources.list.d '(' -name debian.sources -o -name ubuntu.sources ')' \
      -exec sed 's/^Types: deb$/Types: deb-src/' {} + > "$libraries/parts/source.sources" &&
    cd "$libraries" || return
  for step in update 'source --download-only lapack'; do
    # shellcheck disable=SC2086 # words are meant
    apt-get -q -o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$libraries/parts" \
      -o Dir::State::lists="$libraries/lists" $step > source.log 2>&1 ||
      { tail source.log; return 1; }
  done
  mkdir unpacked && tar -xf lapack_*.orig.tar.* -C unpacked --strip-components=1 &&
    mv unpacked source
}

# object NAME: compiles a procedure; says whether there is one of this name.
object() {
  for place in BLAS/SRC SRC INSTALL; do
    for file in "$libraries/source/$place/$1".[fF]*; do
      [ -e "$file" ] || continue
      "$target-gfortran-posix" -O2 -w -c -J "$libraries" "$file" -o "$libraries/$1.o"
      return
    done
  done
}

# Those procedures that the program calls, and what they call.
lapack() {
  [ -e "$libraries/liblapack.a" ] && return
  cd "$libraries" || return
  object la_constants && object la_xisnan || return
  wanted="idamax dgemv dgemm dgetrf sgetrf dgetrs sgetrs dgtsv dgeev dgesvd ilaver"
  seen=
  while [ -n "$wanted" ]; do
    more=
    for name in $wanted; do
      case " $seen " in *" $name "*) continue ;; esac
      seen="$seen $name"
      [ -e "$name.o" ] || object "$name" || return
      [ -e "$name.o" ] &&
        more="$more $("$target-nm" "$name.o" | sed -n 's/^ *U \([a-z0-9]*\)_$/\1/p' | tr '\n' ' ')"
    done
    wanted=$(echo "$more" | tr ' ' '\n' | sort -u | tr '\n' ' ')
    [ -n "$(echo "$wanted" | tr -d ' ')" ] || break
  done
  "$target-ar" rcs liblapack.a ./*.o && "$target-ar" rcs libblas.a la_constants.o
}

(lapack_source) || give_up 'no source of LAPACK'
(lapack) || give_up 'LAPACK cannot be compiled for Windows'
cat > "$libraries/windows.ini" <<END
[binaries]
c = '$target-gcc-posix'
fortran = '$target-gfortran-posix'
ar = '$target-gcc-ar-posix'
strip = '$target-strip'
exe_wrapper = '$wine'
[built-in options]
c_link_args = ['-static', '-L$libraries']
fortran_link_args = ['-static', '-L$libraries']
[host_machine]
system = 'windows'
cpu_family = 'x86_64'
cpu = 'x86_64'
endian = 'little'
END
builds "$folder" --cross-file "$libraries/windows.ini" -Dpython=disabled -Dblas=lapack \
  -Dprocessor=any || exit
# Tests call the program by one path.
printf '#!/bin/sh\nexec %s %s "$@"\n' "$wine" "$folder/snapin.exe" > "$folder/snapin"
chmod +x "$folder/snapin"
"$folder/snapin" --version || exit
[ $# -gt 0 ] || set -- tests/namelist/test_deck.py tests/app/test_examples.py \
  tests/app/test_price.py
SNAPIN=$folder/snapin "$venv/bin/python" -m pytest -q -n auto "$@"
