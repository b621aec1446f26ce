#!/usr/bin/env bash
# fiber_scene_mpi writes the same file from any number of ranks; what is wrong it says once, and leaves nothing.
#   fiber_scene_mpi_test.sh FOLDER MPIEXEC [FLAG...]
#     see tool_test.sh
# shellcheck source=test/mpi/tool_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/tool_test.sh"

# scene RANKS ARGUMENT...: runs the tool.
scene() {
  local ranks=$1
  shift
  "${mpiexec[@]}" "$ranks" "$tools/fiber_scene_mpi" "$@"
}

for options in "soup --segments 1e4" "soup --segments 150 --seed 2" "tress_b --segments 11999" \
  "locks --segments 3e4 --frame 30"; do
  # shellcheck disable=SC2086  # several options
  scene 1 $options --out expected.h5
  [ -s expected.h5 ] || fail "nothing is written of $options"
  for ranks in 2 3 7; do
    # shellcheck disable=SC2086
    scene "$ranks" $options --out found.h5
    cmp expected.h5 found.h5 || fail "$ranks ranks write something else of $options"
    rm found.h5
  done
done

# The contacts of what is made so are those that one process finds.
for options in "soup --segments 2e4" "locks --segments 3e4"; do
  # shellcheck disable=SC2086
  scene 3 $options --out scene.h5
  "${mpiexec[@]}" 2 "$tools/fiber_query_mpi" convert scene.h5 scene.csv
  "$tools/fiber_query" contacts scene.csv --margin 0.001 >expected.csv
  [ "$(wc -l <expected.csv)" -gt 10 ] || fail "hardly any contacts of $options"
  for ranks in 1 2 4; do
    "${mpiexec[@]}" "$ranks" "$tools/fiber_query_mpi" contacts scene.h5 --margin 0.001 --out contacts.csv
    cmp expected.csv contacts.csv || fail "$ranks ranks find something else of $options"
  done
done

# expect_refused TEXT ARGUMENT...: three ranks refuse this, with exit code 2 and this text, once.
expect_refused() {
  local text=$1 code=0
  shift
  scene 3 "$@" >out.txt 2>error.txt || code=$?
  [ "$code" -eq 2 ] || fail "$*: exit code $code"
  [ "$(grep -cF -e "$text" error.txt)" -eq 1 ] || { cat error.txt; fail "$*: not once: $text"; }
  [ -z "$(find . -name 'found*')" ] || fail "$*: something is left"
}

expect_refused "unknown scene 'cloth', known are: soup, tress_b, locks" cloth --segments 9 --out found.h5
for segments in 0 -1 1.5 many nan inf 1e16; do
  expect_refused "--segments: '$segments' must be a whole number from 1 to 1e15" \
    soup --segments "$segments" --out found.h5
done
expect_refused "--segments is required" soup --out found.h5
expect_refused "--out is required" soup --segments 9
expect_refused "--seed: '-1'" soup --segments 9 --seed -1 --out found.h5
expect_refused "--out: 'found.csv' must end in .h5" soup --segments 9 --out found.csv
expect_refused "nowhere/found.h5.part: cannot be opened for writing" soup --segments 9 --out nowhere/found.h5
expect_refused "fibres in one part, there may be at most" soup --segments 1e15 --out found.h5
