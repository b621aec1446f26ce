#!/usr/bin/env bash
# Makes the small mistakes that test/mutants lists, one at a time and in a copy of this checkout, and tells which of
# them the tests see. A mistake that no test sees shows what is untested.
#   scripts/mutate.sh [--room ROOM]... [--only NAME]... [--folder DIR] [--list]
#     --room ROOM   the mistakes of test/mutants/ROOM.yaml only
#     --only NAME   this mistake only
#     --folder DIR  for the copy (DIR/source), its build (DIR/build) and the report (DIR/report.json); default:
#                   mutation in the build's folder. A run adds to the report that is there
#     --list        only the names, and which of them no longer apply
#   scripts/mutate.sh --table [--folder DIR]
#     --table       no mistakes: writes the report as a table into docs/reliability.md
# The first run builds the tests concerned, and runs them without a mistake. Ctrl-C ends a run early and leaves the
# report of what was done. The exit code is 1 if a mistake was not seen that is not told to be invisible.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

folder=$build/mutation
changes_nothing=false
arguments=()
while [ $# -gt 0 ]; do
  case "$1" in
    --folder)
      [ -n "${2-}" ] || { echo "mutate.sh: --folder needs a folder" >&2; exit 2; }
      folder=$(realpath -m -- "$2")
      shift
      ;;
    -h | --help) sed -n '2,/^set/{/^#/s/^# \?//p}' "$0"; exit 0 ;;
    --list | --table) changes_nothing=true; arguments+=("$1") ;;
    *) arguments+=("$1") ;;
  esac
  shift
done

mutate=("$root/scripts/mutate.py" --folder "$folder" "${arguments[@]}")
if $changes_nothing; then
  exec "${mutate[@]}"
fi
"${mutate[@]}" --copy
"$root/scripts/setup.sh"
root=$folder/source
build=$folder/build
# What a mistake leaves unused is no reason not to compile it.
cmake_arguments=(-DCATKIN_ENABLE_TESTING=ON -DFIBER_PROXIMITY_WERROR=OFF)
configure_package
if [ -f "$build/devel/setup.bash" ]; then
  use_devel_space
fi
exec nice -n 10 "${mutate[@]}"
