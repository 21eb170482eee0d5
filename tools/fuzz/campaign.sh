#!/bin/sh
# The deck reader under attack: tools/fuzz/campaign.sh SECONDS [FOLDER]
#
# AFL++ makes decks that reach an increasing part of the reader (src/namelist, src/scene), from
# bytes to scene, and one_deck.f90 checks the promises for each deck. Two builds share one core
# ($CORE, default 0) and their findings: one traps invalid operations, overflows, bad indices and
# undefined reals, the other has the address and undefined-behaviour sanitizers. Then f90nml reads
# the accepted decks too, and the reached lines are counted.
#
# Needs gfortran, AFL++ (apt-get install afl++) and the project's .venv. All files are in FOLDER
# (build-fuzz); a second call continues the campaign. Findings are in FOLDER/found/*/crashes and
# hangs; to read one again: FOLDER/traps/driver FILE.
set -eu

seconds=$1
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mkdir -p "${2:-$root/build-fuzz}" && cd "${2:-$root/build-fuzz}" && pwd)
here=$root/tools/fuzz
afl=${AFL_PATH:-/usr/lib/afl}/afl-compiler-rt.o
meson=$root/.venv/bin/meson
python=$root/.venv/bin/python
# Shared memory avoids a few thousand files a second on the disk.
work=$(mktemp -d /dev/shm/snapin_fuzz.XXXXXX)
trap 'rm -rf "$work"' EXIT

# build NAME FLAGS MESON_OPTION DEFINITION: FOLDER/NAME/driver
build() {
  name=$1 flags=$2 option=$3 definition=$4
  cd "$root"
  gcc -O2 -c "$here/trace.c" -o "$folder/trace.o"
  # Meson tests whether the flags link, which needs the objects.
  [ -d "$folder/$name" ] || FFLAGS="$flags" LDFLAGS="$flags -no-pie $folder/trace.o $afl" \
    "$meson" setup "$folder/$name" -Dpython=disabled -Dbuildtype=debug -Doptimization=1 "$option"
  "$meson" compile -C "$folder/$name" snapin:static_library
  gfortran -g -O1 $flags -fcheck=all -J"$folder/$name" -I"$folder/$name/libsnapin.a.p" \
    -c "$here/one_deck.f90" -o "$folder/$name/one_deck.o"
  gcc -O1 $definition -c "$here/driver.c" -o "$folder/$name/driver.o"
  gfortran -no-pie $flags "$folder/$name/driver.o" "$folder/$name/one_deck.o" \
    "$folder/trace.o" "$folder/$name/libsnapin.a" "$afl" -lgomp -lm -o "$folder/$name/driver"
}

edges=-fsanitize-coverage=trace-pc
build traps $edges -Dtraps=true -DTRAPS
build sanitizers "$edges -fsanitize=address,undefined -fno-sanitize-recover=all" -Dtraps=false ''
[ -d "$folder/lines" ] || FFLAGS=--coverage LDFLAGS=--coverage \
  "$meson" setup "$folder/lines" "$root" -Dpython=disabled -Dbuildtype=debug
"$meson" compile -C "$folder/lines"
"$python" "$here/seeds.py" "$folder/lines/snapin" "$folder"

export AFL_NO_UI=1 AFL_SKIP_CPUFREQ=1 AFL_NO_AFFINITY=1 AFL_IGNORE_SEED_PROBLEMS=1
export AFL_I_DONT_CARE_ABOUT_MISSING_CRASHES=1 AFL_TMPDIR="$work"
export ASAN_OPTIONS=abort_on_error=1:detect_leaks=0:symbolize=0
export UBSAN_OPTIONS=abort_on_error=1:symbolize=0
# Without this option freed blocks count as leaks (driver.c).
export GLIBC_TUNABLES=glibc.malloc.tcache_count=0

# attack NAME ROLE: one fuzzer
attack() {
  [ -d "$folder/found/$1" ] && seeds=- || seeds=$folder/seeds
  cd "$work"
  taskset -c "${CORE:-0}" afl-fuzz -i "$seeds" -o "$folder/found" $2 "$1" -V "$seconds" \
    -t 1000 -m none -x "$folder/words.dict" -f "$work/$1.nml" \
    -- "$folder/$1/driver" "$work/$1.nml" > "$folder/$1.log" 2>&1
}

attack traps -M &
attack sanitizers -S &
wait

# Comparison of the accepted decks with f90nml.
mkdir "$work/decks"
count=0
for deck in "$folder"/found/*/queue/id:*; do
  count=$((count + 1))
  cp "$deck" "$work/decks/$count.nml"
done
find "$work/decks" -name '*.nml' -print0 | xargs -0 "$folder/traps/driver"
"$python" "$here/compare.py" "$work/decks" > "$folder/compare.txt"

# The lines and branches of the program itself that the found decks reach.
find "$folder/lines" -name '*.gcda' -delete
find "$folder/found" -path '*/queue/id:*' -print0 |
  xargs -0 -n 500 "$folder/lines/snapin" --check > "$folder/check.log" 2>&1 || true
cd "$folder/lines"
gcov libsnapin.a.p/src_namelist_*.gcda libsnapin.a.p/src_scene_*.gcda \
  2> /dev/null > "$folder/coverage.txt"
for name in traps sanitizers; do
  echo "$name:"
  grep -E 'run_time|execs_done|corpus_count|edges_found|saved_crashes|saved_hangs' \
    "$folder/found/$name/fuzzer_stats"
done
tail -n 1 "$folder/compare.txt"
grep -A1 -E "File '.*src/(namelist|scene)/" "$folder/coverage.txt"
