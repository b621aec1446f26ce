#!/usr/bin/env bash
# The batch file for Slurm does what docs/distributed.md says, with ranks here in place of a cluster.
#   batch_file_test.sh BATCH_FILE FOLDER MPIEXEC [FLAG...]
#     FOLDER  of the tools
#     FLAG    of MPIEXEC, the last one before the number of ranks
set -euo pipefail
batch=$1
tools=$2
shift 2
work=$(mktemp -d)
job=
OMPI_MCA_orte_tmpdir_base=$(mktemp -d) # as tool_test.sh has it
export OMPI_MCA_orte_tmpdir_base
trap '[ -z "$job" ] || kill "$job" 2>/dev/null || true; wait; rm -rf "$work" "$OMPI_MCA_orte_tmpdir_base"' EXIT
cd "$work"

fail() {
  echo "batch_file_test: $*" >&2
  exit 1
}

bash -n "$batch"

# Stand-ins for what a cluster has: an mpirun that needs no number of ranks, and scontrol.
mkdir bin
printf '#!/usr/bin/env bash\nready=%q\nstart=(%s)\n' "$work/ready" "$(printf '%q ' "$@")" >bin/mpirun
cat >>bin/mpirun <<'END'
echo "$@" >mpirun.txt
while [ "$1" != fiber_query_mpi ]; do shift; done
[ -z "${MPIRUN_WAITS:-}" ] || { touch "$ready"; until [ -e go_on ]; do [ -e "$ready" ] || exit 1; sleep 0.02; done; }
exec "${start[@]}" 2 "$@"
END
printf '#!/usr/bin/env bash\necho "$@" >scontrol.txt\n' >bin/scontrol
chmod +x bin/*
PATH=$work/bin:$PATH
export FIBER_TOOLS=$tools SLURM_JOB_ID=17 SLURM_CPUS_PER_TASK=2

"$tools/fiber_scene" tress_b --scale 0.005 --frames 3 --out tress.csv
"$@" 2 "$tools/fiber_query_mpi" convert tress.csv tress.h5
"$@" 2 "$tools/fiber_query_mpi" contacts tress.h5 --margin 0.0005 --out expected.h5

# It makes what was asked for, and started again it goes on.
bash "$batch" tress.h5 0.0005 found.h5
diff -r expected.frames found.frames || fail "other contacts"
grep -q -e '--map-by slot:PE=2 ' mpirun.txt || fail "cores are not those that Slurm gives: $(cat mpirun.txt)"
grep -q -e '--threads 2 ' mpirun.txt || fail "threads are not those that Slurm gives: $(cat mpirun.txt)"
first=$(stat -c '%i %y' found.frames/000000.h5)
rm found.h5 found.frames/000002.h5
bash "$batch" tress.h5 0.0005 found.h5
diff -r expected.frames found.frames || fail "other contacts after a restart"
[ "$first" = "$(stat -c '%i %y' found.frames/000000.h5)" ] || fail "a whole frame was made again"

# Errors have the tool's exit code.
code=0
bash "$batch" none.h5 0.0005 other.h5 2>error.txt || code=$?
[ "$code" -eq 2 ] || fail "exit code $code of a file that there is not"
code=0
bash "$batch" tress.h5 2>error.txt || code=$?
if [ "$code" -ne 2 ] || ! grep -q "^usage: " error.txt; then fail "no usage"; fi

# Before its time is over it asks to be started again, once it is not too often, and ends with its ranks.
for restarts in 0 20; do
  rm -rf ready go_on scontrol.txt found.h5 found.frames
  MPIRUN_WAITS=1 SLURM_RESTART_COUNT=$restarts bash "$batch" tress.h5 0.0005 found.h5 &
  job=$!
  until [ -e ready ]; do
    kill -0 "$job" || fail "the job has ended by itself"
    sleep 0.02
  done
  kill -USR1 "$job"
  if [ "$restarts" -eq 0 ]; then
    until [ -e scontrol.txt ]; do
      kill -0 "$job" || fail "the job has not asked to be started again"
      sleep 0.02
    done
    [ "$(cat scontrol.txt)" = "requeue 17" ] || fail "asked for: $(cat scontrol.txt)"
  fi
  touch go_on
  wait "$job" || fail "exit code $? after a signal"
  job=
  diff -r expected.frames found.frames || fail "other contacts after a signal"
done
[ ! -e scontrol.txt ] || fail "it asks to be started again for ever"
