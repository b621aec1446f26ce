#!/usr/bin/env bash
# Sets up, builds and runs all tests; quiet unless something fails.
#   scripts/test.sh [--werror] [--verbose] [-R REGEX]
#     --werror    warnings are errors
#     --verbose   show every test's output, and all that installing and building write
#     -R REGEX    only the tests whose names match
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/test.sh [--werror] [--verbose] [-R REGEX]"
cmake_arguments=(-DCATKIN_ENABLE_TESTING=ON)
ctest_arguments=(--parallel "$((2 * $(nproc)))") # those of the graph wait half of their time
while [ $# -gt 0 ]; do
  case "$1" in
    --werror) cmake_arguments+=(-DFIBER_PROXIMITY_WERROR=ON) ;;
    --verbose)
      ctest_arguments+=(--verbose)
      be_verbose
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

"$root/scripts/setup.sh"
build_package all tests
use_devel_space
run_tests "${ctest_arguments[@]}"
