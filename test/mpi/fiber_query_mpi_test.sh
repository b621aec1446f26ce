#!/usr/bin/env bash
# fiber_query_mpi writes the bytes of fiber_query; what is wrong it says once, and leaves no half output.
#   fiber_query_mpi_test.sh FOLDER MPIEXEC [FLAG...]
#     FOLDER  of the tools
#     FLAG    of MPIEXEC, the last one before the number of ranks
set -euo pipefail
tools=$1
shift
mpiexec=("$@")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
  echo "fiber_query_mpi_test: $*" >&2
  exit 1
}

"$tools/fiber_scene" soup --scale 0.01 --out soup.csv
"$tools/fiber_scene" tress_b --scale 0.005 --frames 3 --out tress.csv
for options in "soup.csv --margin 0.002" "tress.csv --margin 0.0005" \
  "tress.csv --margin 0.001 --neighbour-skip-length 0.004 --radius 0.0001"; do
  # shellcheck disable=SC2086  # several options
  "$tools/fiber_query" contacts $options >expected.csv
  [ "$(wc -l <expected.csv)" -gt 10 ] || fail "hardly any contacts of $options"
  for ranks in 1 2 4; do
    # shellcheck disable=SC2086
    "${mpiexec[@]}" "$ranks" "$tools/fiber_query_mpi" contacts $options --out found.csv
    cmp expected.csv found.csv || fail "$ranks ranks find something else of $options"
    [ ! -e found.csv.part ] || fail "a part is left"
    rm found.csv
    # shellcheck disable=SC2086
    "${mpiexec[@]}" "$ranks" "$tools/fiber_query_mpi" contacts $options | cmp expected.csv - ||
      fail "$ranks ranks write something else of $options"
  done
done

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
expect_refused "unknown subcommand 'first'" first soup.csv
expect_refused "nowhere/found.csv.part: cannot be opened for writing" contacts soup.csv --out nowhere/found.csv
ln -s /dev/full found.csv.part
expect_refused "cannot be written" contacts soup.csv --margin 0.01 --out found.csv
