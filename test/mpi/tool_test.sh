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
# Open MPI's folder of a session is each test's own: of two that make one in /tmp at the same time one gives up.
OMPI_MCA_orte_tmpdir_base=$(mktemp -d)
export OMPI_MCA_orte_tmpdir_base
trap 'rm -rf "$work" "$OMPI_MCA_orte_tmpdir_base"' EXIT
cd "$work"

fail() {
  echo "$test_name: $*" >&2
  exit 1
}
