#!/usr/bin/env bash
# Tries what the tests do not: fresh seeds for all random tests, then the fuzzers (scripts/fuzz.sh, if
# it is there) and the soak of the running node (with ROS). Mistakes that the tests should see are a part of their own.
#   scripts/campaign.sh [--minutes N] [--jobs N] [--only tests|fuzz|soak|mutants] [--out DIR] [--no-build]
#     --minutes N   how long, without building; default: 60
#     --jobs N      how many processes at once; default: as many as there are cores
#     --only PART   all the time for one of the three; mutants: scripts/mutate.sh, for as long as that takes
#     --out DIR     where the report goes; default: campaign in the build's folder. A campaign adds to what
#                   the folder has from earlier ones
#     --no-build    with what has been built
#   scripts/campaign.sh --table [--out DIR]
#     --table       no campaign: writes the folder's table into docs/reliability.md
# The folder has: failures.txt, a line per seed that failed with the command that repeats it, and
# report.json, what was tried, how often and for how long. Ctrl-C ends a campaign early and leaves the
# report of what was done. The exit code is 1 if anything has failed.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/campaign.sh [--minutes N] [--jobs N] [--only tests|fuzz|soak|mutants] [--out DIR]\
 [--no-build] | --table [--out DIR]"
refuse() {
  echo "campaign.sh: $1; $usage" >&2
  exit 2
}
whole() {
  [[ $2 =~ ^[0-9]{1,6}$ && $2 -gt 0 ]] || refuse "$1 needs a whole number from 1, not '$2'"
}

minutes=60
jobs=$(nproc)
only=
out=$build/campaign
build_first=true
table=false
while [ $# -gt 0 ]; do
  case "$1" in
    --minutes | --jobs)
      whole "$1" "${2-}"
      if [ "$1" = --jobs ]; then jobs=$2; else minutes=$2; fi
      shift
      ;;
    --only)
      [[ ${2-} =~ ^(tests|fuzz|soak|mutants)$ ]] || refuse "--only needs tests, fuzz, soak or mutants, not '${2-}'"
      only=$2
      shift
      ;;
    --out)
      [ -n "${2-}" ] || refuse "--out needs a folder"
      out=$(realpath -m -- "$2")
      shift
      ;;
    --no-build) build_first=false ;;
    --table) table=true ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) refuse "unknown option '$1'" ;;
  esac
  shift
done

campaign=("$root/scripts/campaign.py" --out "$out")
if $table; then
  exec "${campaign[@]}" --table "$root/docs/reliability.md"
fi
if [ "$only" = mutants ]; then
  exec "$root/scripts/mutate.sh"
fi
if $build_first; then
  "$root/scripts/setup.sh"
  cmake_arguments=(-DCATKIN_ENABLE_TESTING=ON)
  build_package unit_tests soak
fi
[ -f "$build/unit_tests.txt" ] || refuse "no tests in $build: leave out --no-build"
if [ -f "$build/devel/setup.bash" ]; then
  use_devel_space
fi
exec "${campaign[@]}" --tests "$build/unit_tests.txt" --minutes "$minutes" --jobs "$jobs" \
  ${only:+--only "$only"}
