#!/usr/bin/env bash
# fiber_query_mpi writes the bytes of fiber_query; what is wrong it says once, and leaves no half output.
#   fiber_query_mpi_test.sh FOLDER MPIEXEC [FLAG...]
#     see tool_test.sh
# shellcheck source=test/mpi/tool_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/tool_test.sh"

"$tools/fiber_scene" soup --scale 0.01 --out soup.csv
"$tools/fiber_scene" tress_b --scale 0.005 --frames 3 --out tress.csv
for options in "soup.csv --margin 0.002" "tress.csv --margin 0.0005" \
  "tress.csv --margin 0.001 --neighbour-skip-length 0.004 --radius 0.0001"; do
  # shellcheck disable=SC2086  # several options
  "$tools/fiber_query" contacts $options >expected.csv
  [ "$(wc -l <expected.csv)" -gt 10 ] || fail "hardly any contacts of $options"
  for ranks in 1 4; do
    # shellcheck disable=SC2086
    "${mpiexec[@]}" "$ranks" "$tools/fiber_query_mpi" contacts $options --out found.csv
    cmp expected.csv found.csv || fail "$ranks ranks find something else of $options"
    [ ! -e found.csv.part ] || fail "a part is left"
    rm found.csv
  done
  # shellcheck disable=SC2086
  "${mpiexec[@]}" 2 "$tools/fiber_query_mpi" contacts $options | cmp expected.csv - ||
    fail "2 ranks write something else of $options"
done

# ask RANKS ARGUMENT...: fiber_query_mpi on so many ranks.
ask() {
  local ranks=$1
  shift
  "${mpiexec[@]}" "$ranks" "$tools/fiber_query_mpi" "$@"
}

# Each type of query and each format.
printf 'fiber,x,y,z\n0,0,0,0\n0,1,0,0\n1,0,5,0\n1,1,5,0\n' >far.csv
for options in "closest soup.csv" "closest tress.csv --neighbour-skip 3" "closest tress.csv --kernel exact --format json" \
  "closest far.csv --margin 1 --format json" "fiber_pairs soup.csv --margin 0.004" \
  "fiber_pairs tress.csv --margin 0.0008 --format json" "contacts tress.csv --margin 0.0005 --format json" \
  "closest far.csv --margin 1"; do
  # shellcheck disable=SC2086  # several options
  "$tools/fiber_query" $options >expected.txt
  for ranks in 2 3; do
    # shellcheck disable=SC2086
    ask "$ranks" $options --out found.txt
    cmp expected.txt found.txt || fail "$ranks ranks find something else: $options"
    rm found.txt
  done
done
ask 3 closest tress.csv --format json | cmp <("$tools/fiber_query" closest tress.csv --format json) - ||
  fail "something else is written to stdout"
"$tools/fiber_query" closest soup.csv >expected.csv
[ "$(wc -l <expected.csv)" -eq 2 ] || fail "no closest pair"
"$tools/fiber_query" contacts soup.csv --margin 0.002 >expected.csv
for ranks in 1 2 3; do
  ask "$ranks" first soup.csv --margin 0.002 >found.csv
  [ "$(wc -l <found.csv)" -eq 2 ] || fail "not one pair"
  grep -qxFf <(tail -n 1 found.csv) expected.csv || fail "the pair that $ranks ranks find is none"
  ask "$ranks" first far.csv --margin 1 >found.csv
  [ "$(wc -l <found.csv)" -eq 1 ] || fail "a pair where there is none"
done
rm found.csv
# Contacts between frames; of frames of different fibres those of the earlier one.
{
  cat tress.csv
  tail -n +2 tress.csv | grep '^2,' | grep -v '^2,0,' | sed 's/^2,/3,/'
} >frames.csv
for options in "--margin 0.0003" "--margin 0.0003 --new-only --neighbour-skip 2" "--type first" "--type first --new-only"; do
  # shellcheck disable=SC2086  # several options
  "$tools/fiber_query" sweep frames.csv $options >expected.csv 2>error.txt
  grep -q "frames 2 and 3 have different fibres" error.txt || fail "all frames have the same fibres"
  [ "$(wc -l <expected.csv)" -gt 1 ] || fail "no contact between frames: $options"
  for ranks in 2 3; do
    # shellcheck disable=SC2086
    ask "$ranks" sweep frames.csv $options --out found.csv 2>error.txt
    cmp expected.csv found.csv || fail "$ranks ranks find something else between frames: $options"
    [ "$(grep -c "frames 2 and 3 have different fibres" error.txt)" -eq 1 ] || fail "the frames that differ are not told of once"
    rm found.csv
  done
done
if ask 2 sweep soup.csv 2>error.txt; then fail "one frame makes a motion"; fi
grep -q "a motion needs at least two" error.txt || fail "not said what is missing: $(cat error.txt)"

# Fibres by their names, whatever ranks have them: with quotes, in another order in each frame, gone and new ones, one of
# other points. A file of HDF5 keeps them.
awk 'BEGIN {
  srand(3)
  print "x,y,z,frame,fiber,radius"
  split("rope|a, \"long\" one|7|#9|wire|0", names, "|")
  for (frame = 0; frame < 6; ++frame) for (k = 0; k < 6; ++k) {
    fiber = frame == 1 ? 6 - k : frame == 2 ? (k * 5 + 2) % 6 + 1 : k + 1
    name = names[fiber]
    if (frame == 3 && fiber == 2 || frame == 4 && fiber == 5) continue
    if (frame == 4 && fiber == 1) name = "new"
    gsub(/"/, "\"\"", name)
    for (point = 0; point < 5 + (frame == 5 && fiber == 3); ++point)
      printf "%.6f,%.6f,%.6f,%d,\"%s\",0.02\n", 0.1 * point + 0.1 * rand(), 0.3 * rand(), 0.3 * rand(), 10 - frame, name
  }
}' >named.csv
ask 2 convert named.csv named.h5
ask 3 convert named.h5 again.csv
for query in "contacts --margin 0.02" "contacts --margin 0.02 --format json" "fiber_pairs" "sweep" "sweep --type first --new-only"; do
  # shellcheck disable=SC2086  # several options
  set -- $query
  command=$1
  shift
  "$tools/fiber_query" "$command" named.csv "$@" >expected.txt 2>told.txt
  grep -q 'a, .*long' expected.txt || fail "names are not those of the file: $query"
  "$tools/fiber_query" "$command" again.csv "$@" 2>error.txt | cmp expected.txt - || fail "HDF5 has lost something: $query"
  for ranks in 2 3; do
    for file in named.csv named.h5; do
      ask "$ranks" "$command" "$file" "$@" --out found.txt 2>error.txt
      cmp expected.txt found.txt || fail "$ranks ranks name something else in $file: $query"
      sed 's/^fiber_query_mpi/fiber_query/' error.txt | cmp told.txt - || fail "$ranks ranks tell something else of $file: $query"
      rm found.txt
    done
  done
done
[ "$(wc -l <told.txt)" -eq 3 ] || fail "not told where fibres differ: $(cat told.txt)"
grep -qF "frames 7 and 6 have different fibres (gone: 'rope', 'wire'; new: 'new', 'a, \"long\" one')" told.txt ||
  fail "not told who comes and goes: $(cat told.txt)"
# Columns that are not read are told of once.
sed '1s/radius/thickness/' named.csv >more.csv
ask 3 contacts more.csv --out found.csv 2>error.txt
[ "$(cat error.txt)" = "fiber_query_mpi: more.csv: column 'thickness' is not read" ] || fail "told: $(cat error.txt)"
rm found.csv

# A deadline that nothing can keep is told once for each frame; what is found by then is right.
ask 2 contacts tress.csv --margin 0.0005 --deadline 1e-9 >found.csv 2>error.txt
[ "$(grep -c '^fiber_query_mpi: the deadline has passed in frame [0-2]: pairs may be missing$' error.txt)" -eq 3 ] ||
  fail "the deadline is not told of: $(cat error.txt)"
"$tools/fiber_query" contacts tress.csv --margin 0.0005 >expected.csv
! grep -qvxFf expected.csv found.csv || fail "by the deadline something else is found"
rm found.csv

# expect_refused TEXT ARGUMENT...: three ranks refuse this, with exit code 2 and this text, once.
expect_refused() {
  local text=$1 code=0
  shift
  "${mpiexec[@]}" 3 "$tools/fiber_query_mpi" "$@" >out.txt 2>error.txt || code=$?
  [ "$code" -eq 2 ] || fail "$*: exit code $code"
  [ "$(grep -cF "$text" error.txt)" -eq 1 ] || { cat error.txt; fail "$*: not once: $text"; }
  [ ! -e found.csv ] && [ ! -e found.csv.part ] || fail "$*: something is left"
}

printf 'fiber,x,y,z\n0,0,0,0\n0,1,nothing,0\n' >bad.csv
expect_refused "none.csv: cannot be opened" contacts none.csv --out found.csv
expect_refused "bad.csv:3:" contacts bad.csv --out found.csv
expect_refused "margin is -1" contacts soup.csv --margin -1 --out found.csv
expect_refused "unknown subcommand 'nearest', known are: contacts, closest, first, fiber_pairs" nearest soup.csv
expect_refused "deadline is -1" first soup.csv --deadline -1 --out found.csv
expect_refused "tolerance is -1" closest soup.csv --tolerance -1 --out found.csv
# All that an answer depends on tells its run from others.
ask 2 closest tress.csv --out found.h5
for options in "fiber_pairs" "closest --margin 1" "closest --radius 0.1" "closest --deadline 9" "closest --tolerance 1e-9" \
  "closest --relative-tolerance 1e-9" "closest --kernel exact" "closest --neighbour-skip 1" \
  "closest --neighbour-skip-length 0"; do
  # shellcheck disable=SC2086  # several options
  expect_refused "is of another run" $options tress.csv --out found.h5 --resume
done
ask 3 closest tress.csv --out found.h5 --resume
rm -r found.h5 found.frames
expect_refused "nowhere/found.csv.part: cannot be opened for writing" contacts soup.csv --out nowhere/found.csv
ln -s /dev/full found.csv.part
expect_refused "cannot be written" contacts soup.csv --margin 0.01 --out found.csv
