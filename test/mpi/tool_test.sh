# The beginning of tests of the tools over ranks; sourced, with their arguments: FOLDER MPIEXEC [FLAG...]
#     FOLDER  of the tools
#     FLAG    of MPIEXEC, the last one before the number of ranks
# shellcheck shell=bash
set -euo pipefail
# shellcheck disable=SC2034  # for those who source this
tools=$1
shift
# shellcheck disable=SC2034
mpiexec=("$@")
test_name=$(basename "$0" .sh)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

fail() {
  echo "$test_name: $*" >&2
  exit 1
}
