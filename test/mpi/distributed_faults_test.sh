#!/usr/bin/env bash
# Where something goes wrong, one rank says so once, all end, and nothing half-written has a name; a run that was
# interrupted goes on to the same files.
#   distributed_faults_test.sh FOLDER FAULTS MPIEXEC [FLAG...]
#     FOLDER   of the tools
#     FAULTS   the folder of libraries to load before others, each of which brings a fault
#     FLAG     of MPIEXEC, the last one before the number of ranks
set -euo pipefail
tools=$1
faults=$2
shift 2
mpiexec=("$@")
work=$(mktemp -d)
run=
# What runs in the background ends with its ranks, whatever has failed.
OMPI_MCA_orte_tmpdir_base=$(mktemp -d) # as tool_test.sh has it
export OMPI_MCA_orte_tmpdir_base
trap '[ -z "$run" ] || kill "$run" 2>/dev/null || true; wait; rm -rf "$work" "$OMPI_MCA_orte_tmpdir_base"' EXIT
cd "$work"

fail() {
  echo "distributed_faults_test: $*" >&2
  [ ! -s error.txt ] || cat error.txt >&2
  exit 1
}

query() {
  local ranks=$1
  shift
  "${mpiexec[@]}" "$ranks" "$tools/fiber_query_mpi" "$@"
}

# choose_fault NAME[=HOW]: the tool as `faulty` has it.
choose_fault() {
  faulty=(env "LD_PRELOAD=$faults/${1%%=*}.so" "FAULT=${1#*=}" "$tools/fiber_query_mpi")
}

parts() { find . -name '*.part' | sort; }

# expect_one_error TEXT COMMAND...: ends with exit code 2 and this, once, and nothing more from our side or HDF5's.
expect_one_error() {
  local text=$1 code=0 parts_before
  shift
  parts_before=$(parts)
  "$@" >out.txt 2>error.txt || code=$?
  [ "$code" -eq 2 ] || fail "$*: exit code $code"
  [ "$(grep -c '^fiber_query_mpi: ' error.txt)" -eq 1 ] || fail "$*: not one error"
  grep -q -e "$text" error.txt || fail "$*: not said: $text"
  ! grep -qE 'HDF5-DIAG|terminate called|Segmentation|MPI_ERR' error.txt || fail "$*: noise"
  [ ! -s out.txt ] || fail "$*: output"
  [ "$(parts)" = "$parts_before" ] || fail "$*: a part is left: $(parts)"
}

# kill_one_of COUNT NAME: of the ranks of $run, which are so many and have this argument; all end then, and say why.
kill_one_of() {
  local ranks=() process rank code=0
  # By what it is called, among the processes of this run alone.
  for process in /proc/[0-9]*; do
    if grep -qzx "$2" "$process/cmdline" 2>/dev/null &&
      grep -q '^Name:.*fiber_query_mpi' "$process/status" 2>/dev/null &&
      [ "$(readlink "$process/cwd")" = "$work" ]; then
      ranks+=("${process#/proc/}")
    fi
  done
  [ "${#ranks[@]}" -eq "$1" ] || fail "${#ranks[@]} ranks are running"
  kill -9 "${ranks[1]}"
  wait "$run" || code=$?
  run=
  [ "$code" -ne 0 ] || fail "the run whose rank was killed has succeeded"
  grep -qE 'rank [0-9]+' error.txt || fail "no rank is named"
  # Those that were not killed end, too; where nobody asks for what has ended, its entry stays.
  for rank in "${ranks[@]}"; do
    while grep -qs '^State:[[:space:]]*[^Z[:space:]]' "/proc/$rank/status"; do sleep 0.02; done
  done
}

"$tools/fiber_scene" tress_b --scale 0.005 --frames 60 --out tress.csv
query 2 convert tress.csv tress.h5

# ---- a rank is killed, while one waits with the fifth frame, which is not yet whole
query 2 contacts tress.h5 --margin 0.0005 --out whole.h5
[ "$(find whole.frames -name '*.h5' | wc -l)" -eq 60 ] || fail "not 60 frames"
choose_fault held_rename=killed.frames/000004.h5
"${mpiexec[@]}" 3 "${faulty[@]}" contacts tress.h5 --margin 0.0005 --out killed.h5 2>error.txt &
run=$!
until [ -e killed.frames/000004.h5.part ]; do
  kill -0 "$run" || fail "the run has ended by itself"
  sleep 0.02
done
kill_one_of 3 killed.h5
[ ! -e killed.h5 ] || fail "what is not whole has its name"
done_before=$(find killed.frames -name '*.h5' | wc -l)
[ "$done_before" -eq 4 ] || fail "$done_before frames are whole"
[ "$(parts)" = ./killed.frames/000004.h5.part ] || fail "not the one frame that is not whole is left: $(parts)"
first=$(stat -c '%i %y' killed.frames/000000.h5)

expect_one_error "killed.frames/000000.h5: cannot be gone on with: is of another run" \
  query 3 contacts tress.h5 --margin 0.0004 --out killed.h5 --resume
cp -p killed.frames/000001.h5 kept.h5
truncate -s 1000 killed.frames/000001.h5
expect_one_error "killed.frames/000001.h5: cannot be gone on with: is no whole HDF5 file" \
  query 3 contacts tress.h5 --margin 0.0005 --out killed.h5 --resume
mv kept.h5 killed.frames/000001.h5
query 2 contacts tress.h5 --margin 0.0005 --out killed.h5 --resume
[ "$first" = "$(stat -c '%i %y' killed.frames/000000.h5)" ] || fail "a whole frame was made again"
[ -z "$(find . -name '*.part')" ] || fail "a part is left"
diff -r whole.frames killed.frames || fail "the resumed run has made something else"
query 1 contacts tress.h5 --margin 0.0005 --out killed.h5 --resume # nothing is left to do
[ "$(wc -c <killed.h5)" -eq "$(wc -c <whole.h5)" ] || fail "other links"
touch tress.h5
expect_one_error "is of another run" query 2 contacts tress.h5 --margin 0.0005 --out killed.h5 --resume

# ---- a rank is killed that checks candidates: what has been noted by then is not checked again
awk 'BEGIN {
  print "frame,fiber,x,y,z,radius"
  for (i = 0; i < 20000; ++i) for (x = 0; x <= 1; ++x) printf "%d,0,%d,0,%.3f,0.01\n", i, x, (i % 97) / 97 - 0.1
}' >many.csv
printf 'obstacles:\n  - {id: floor, half_spaces: [{coef: [0, 0, 1, 0]}]}\n' >world.yaml
checks=(check many.csv --environment world.yaml --margin 0.01 --out checks.csv)
query 2 "${checks[@]}"
mv checks.csv expected.csv
choose_fault held_rename=checks.csv
"${mpiexec[@]}" 2 "${faulty[@]}" "${checks[@]}" 2>error.txt &
run=$!
until grep -qs '^20000 ' checks.csv.part.run; do
  kill -0 "$run" || fail "the run has ended by itself"
  sleep 0.02
done
kill_one_of 2 checks.csv
[ ! -e checks.csv ] || fail "what is not whole has its name"
cmp expected.csv checks.csv.part || fail "other checks have been noted"
# As if it had been killed earlier, after the first 16384; one of these rows is another, to be known again.
sed -i "1s/.*/16384 $(head -n 16385 expected.csv | wc -c)/" checks.csv.part.run
sed -i -e '3s/^1,/9,/' -e '19000,$d' checks.csv.part
cp checks.csv.part earlier.part
cp checks.csv.part.run earlier.run
expect_one_error "checks.csv.part: cannot be gone on with: is of another run" \
  query 3 "${checks[@]}" --kernel exact --resume
query 3 "${checks[@]}" --resume
sed '3s/^1,/9,/' expected.csv | cmp - checks.csv || fail "it has not gone on where it was"
[ "$(echo checks*)" = checks.csv ] || fail "more is left than the checks: $(echo checks*)"
mv earlier.part checks.csv.part
mv earlier.run checks.csv.part.run
query 2 "${checks[@]}"
cmp expected.csv checks.csv || fail "it has gone on without being told to"
[ "$(echo checks*)" = checks.csv ] || fail "more is left than the checks: $(echo checks*)"
echo 9 >checks.csv.part.run
touch checks.csv.part
expect_one_error "checks.csv.part.run: cannot be gone on with" query 2 "${checks[@]}" --resume
rm checks.csv*
query 2 "${checks[@]}" --resume # there is nothing to go on with
cmp expected.csv checks.csv || fail "without anything to go on with it checks something else"
expect_one_error "--resume: what went to stdout" query 2 check many.csv --resume

# ---- a file that may not be as large as it must be, as on a full disk; ranks use no shared memory, which are files
limited=("${mpiexec[@]/self,vader,tcp/self,tcp}")
for out in full.h5 full.csv; do
  # shellcheck disable=SC2016  # expanded there
  expect_one_error "full.*File too large" "${limited[@]}" 3 bash -c 'ulimit -f 300; exec "$@"' bash \
    "$tools/fiber_query_mpi" contacts tress.h5 --margin 0.001 --out "$out"
  [ -z "$(find . -path './full.frames/*' -o -name "$out")" ] || fail "something is left of $out"
done
# on_small_disk OUT: a run that writes to a disk of 300 KB; what there is then is in left.txt.
mkdir small
on_small_disk() {
  # shellcheck disable=SC2016  # expanded there
  unshare --mount bash -c 'mount -t tmpfs -o size=300k tmpfs small
    "$@"
    code=$?
    find small -type f | sort >left.txt
    exit "$code"' bash "${mpiexec[@]}" 3 "$tools/fiber_query_mpi" contacts tress.h5 --margin 0.0005 --out "small/$1"
}
if unshare --mount true 2>/dev/null; then
  expect_one_error "small/found.frames/000001.h5.part: .*No space left on device" on_small_disk found.h5
  [ "$(cat left.txt)" = small/found.frames/000000.h5 ] || fail "not the one frame that is whole is left"
  expect_one_error "small/found.csv.part: .*No space left on device" on_small_disk found.csv
  [ ! -s left.txt ] || fail "something is left"
fi

# ---- files that are not what they should be
head -c 3000 tress.frames/000002.h5 >short.h5
expect_one_error "short.h5: is no whole HDF5 file" query 3 contacts short.h5 --out found.h5
printf 'fiber,x,y,z\n0,0,0,0\n' >text.h5
expect_one_error "text.h5: is no whole HDF5 file" query 3 contacts text.h5 --out found.h5
expect_one_error "none.h5: cannot be opened" query 3 convert none.h5 found.csv
expect_one_error "whole.h5: is no file of fibres" query 3 contacts whole.h5 --out found.h5
mv tress.frames/000001.h5 away.h5
expect_one_error "tress.h5: frames/000001: " query 3 convert tress.h5 found.csv
mv away.h5 tress.frames/000001.h5
[ -z "$(find . -name 'found*')" ] || fail "something is left"

head -n 30 tress.csv | cut -d, -f2- >short.csv

# ---- options that do not go together
expect_one_error "--resume: only files of HDF5" query 3 contacts tress.h5 --out found.csv --resume
expect_one_error "--resume: only files of HDF5" query 3 convert tress.csv found.csv --resume
expect_one_error "--format hdf5 needs a file" query 3 contacts tress.h5 --format hdf5
expect_one_error "OUT: 'found.xyz' must end in" query 3 convert tress.csv found.xyz
expect_one_error "the file to write is the one to read itself" query 3 convert tress.csv ./tress.csv
expect_one_error "nowhere/found.h5.part: cannot be opened" query 3 contacts short.csv --out nowhere/found.h5

# ---- MPI without thread support
choose_fault no_threads
expect_one_error "MPI was started without thread support" \
  "${mpiexec[@]}" 3 "${faulty[@]}" contacts tress.h5 --margin 0.0005 --out found.h5
[ -z "$(find . -name 'found*')" ] || fail "something is left"

# ---- Zoltan fails on one rank
choose_fault failing_zoltan
expect_one_error "rank 1: Zoltan cannot split the fibres: error -1" \
  "${mpiexec[@]}" 3 "${faulty[@]}" contacts tress.h5 --margin 0.0005 --out found.csv
[ -z "$(find . -name 'found*')" ] || fail "something is left"
choose_fault failing_zoltan=early
code=0
"${mpiexec[@]}" 3 "${faulty[@]}" contacts tress.h5 --margin 0.0005 --out found.csv \
  >out.txt 2>error.txt || code=$?
[ "$code" -eq 2 ] || fail "others wait in Zoltan: exit code $code"
grep -q "^rank 1: Zoltan cannot split the fibres: not enough memory; others wait for it there: all end" error.txt ||
  fail "not said which rank ends all"
if [ -e found.csv ] || [ -s out.txt ]; then fail "something is written"; fi

# ---- more ranks than segments
printf 'fiber,x,y,z,radius\n0,0,0,0,0.1\n0,1,0,0,0.1\n1,0,0.1,0,0.1\n1,1,0.1,0,0.1\n1,1,1,0,0.1\n' >few.csv
"$tools/fiber_query" contacts few.csv --margin 1 >expected.csv
[ "$(wc -l <expected.csv)" -gt 1 ] || fail "no contacts"
query 7 convert few.csv few.h5
for file in few.csv few.h5; do
  query 7 contacts "$file" --margin 1 --out found.csv
  cmp expected.csv found.csv || fail "seven ranks find something else in $file"
done
query 7 convert few.h5 back.csv
cmp few.csv back.csv || fail "something else has come back"
