#!/usr/bin/env bash
# Sets up, builds and runs the tests; quiet unless something fails.
#   scripts/test.sh [-L all] [--werror] [--verbose] [-R REGEX]
#     -L all      also benchmarks and their tests, those of packages, and every engine of the paper in all tests of
#                 engines: another half of the time, for what changes seldom break. .ci/run does it
#     --werror    warnings are errors
#     --verbose   show every test's output, and all that installing and building write
#     -R REGEX    only the tests whose names match
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/test.sh [-L all] [--werror] [--verbose] [-R REGEX]"
all=false
cmake_arguments=(-DCATKIN_ENABLE_TESTING=ON)
ctest_arguments=(--parallel "$((2 * $(nproc)))") # those of the graph wait half of their time
while [ $# -gt 0 ]; do
  case "$1" in
    --werror) cmake_arguments+=(-DFIBER_PROXIMITY_WERROR=ON) ;;
    --verbose)
      ctest_arguments+=(--verbose)
      be_verbose
      ;;
    -L)
      [ "${2-}" = all ] || { echo "test.sh: -L takes 'all', not '${2-}'; $usage" >&2; exit 2; }
      all=true
      shift
      ;;
    -R)
      [ $# -ge 2 ] || { echo "test.sh: -R needs a regular expression; $usage" >&2; exit 2; }
      ctest_arguments+=(-R "$2")
      shift
      ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "test.sh: unknown option '$1'; $usage" >&2; exit 2 ;;
  esac
  shift
done

# For the GPU engine one kind of code is enough, which any GPU can compile further.
cmake_arguments+=(-DCMAKE_CUDA_ARCHITECTURES=75)
if $all; then
  cmake_arguments+=(-DFIBER_PROXIMITY_BUILD_BENCHMARKS=ON)
  export FIBER_PROXIMITY_TEST_ENGINES=all
else
  cmake_arguments+=(-DFIBER_PROXIMITY_BUILD_BENCHMARKS=OFF)
  ctest_arguments+=(--label-exclude '^all$')
fi

"$root/scripts/setup.sh"
build_package all tests
use_devel_space
run_tests "${ctest_arguments[@]}"
