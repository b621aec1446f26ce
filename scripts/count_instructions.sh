#!/usr/bin/env bash
# Counts what a scene's steps execute, by the source files it is in: what effects cost that the scene does not name.
#   scripts/count_instructions.sh SCENE [SECONDS]
# Builds fiber_simulate with line tables, runs it on one thread under callgrind, fifty times slower than without, for so
# long [s of the scene, by default 1], and prints a table in Markdown. Counts are the same on every run.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/count_instructions.sh SCENE [SECONDS]"
case "${1-}" in
  -h | --help) echo "$usage"; exit 0 ;;
  "") echo "count_instructions.sh: which scene? $usage" >&2; exit 2 ;;
esac
scene=$(realpath -e -- "$1")
seconds=${2:-1}
command -v valgrind >/dev/null || { echo "count_instructions.sh: install valgrind" >&2; exit 1; }

build+=/instructions
cmake_arguments=(-DFIBER_PROXIMITY_BUILD_ROS=OFF -DFIBER_PROXIMITY_BUILD_BENCHMARKS=OFF
  -DFIBER_PROXIMITY_BUILD_MPI=OFF -DFIBER_PROXIMITY_BUILD_CUDA=OFF -DCMAKE_CXX_FLAGS=-g1)
build_package fiber_simulate
run_step "counting" "$build/callgrind.log" valgrind --tool=callgrind --callgrind-out-file="$build/callgrind.out" \
  "$build/fiber_simulate" "$scene" --seconds "$seconds" --threads 1 --out "$build/frames.csv"
exec "$root/scripts/count_instructions.py" "$build/callgrind.out"
