#!/usr/bin/env bash
# Outputs of the tools over ranks: links are followed, pipes and devices are written to as they stand, and none becomes
# a file; HDF5 refuses what is none. A name that means another format is refused.
#   outputs_test.sh FOLDER MPIEXEC [FLAG...]
#     see tool_test.sh
# shellcheck source=test/mpi/tool_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/tool_test.sh"

# run RANKS TOOL ARGUMENT...
run() {
  local ranks=$1 tool=$2
  shift 2
  "${mpiexec[@]}" "$ranks" "$tools/$tool" "$@"
}

# expect_refused TEXT TOOL ARGUMENT...: two ranks refuse this, with exit code 2 and this text, once.
expect_refused() {
  local text=$1 code=0
  shift
  run 2 "$@" >out.txt 2>error.txt || code=$?
  [ "$code" -eq 2 ] || { cat error.txt; fail "$*: exit code $code"; }
  [ "$(grep -cF -e "$text" error.txt)" -eq 1 ] || { cat error.txt; fail "$*: not once: $text"; }
}

printf 'frame,fiber,x,y,z,radius\n' >bars.csv
for frame in 0 1; do
  printf '%d,a,0,0,0,.1\n%d,a,1,0,0,.1\n%d,b,0,0,.15,.1\n%d,b,1,0,.15,.1\n' $frame $frame $frame $frame >>bars.csv
done
grep -v '^1' bars.csv | cut -d, -f2- >one.csv
mkdir elsewhere
"$tools/fiber_query" contacts bars.csv >expected.csv

# ---- each tool that writes text: the bytes are those of stdout, whatever they go to
tools_of_text=("contacts bars.csv" "fiber_pairs bars.csv --format json" "sweep bars.csv" "check bars.csv")
for command in "${tools_of_text[@]}"; do
  # shellcheck disable=SC2086  # a command with its arguments
  run 3 fiber_query_mpi $command >expected.txt
  [ -s expected.txt ] || fail "nothing is written: $command"

  echo old >elsewhere/target
  ln -s elsewhere/target link
  ln -s link link_to_link
  ln -s nothing dangling
  mkfifo pipe
  for out in link link_to_link dangling; do
    # shellcheck disable=SC2086
    run 3 fiber_query_mpi $command --out $out
    [ -L $out ] || fail "a link became a file: $command"
    cmp expected.txt $out || fail "what $out leads to has something else: $command"
    [ -z "$(find . -name '*.part*')" ] || fail "a part is left: $command"
    echo old >elsewhere/target
  done
  [ -f nothing ] || fail "what the link leads to was not made"
  cat pipe >read.txt &
  reader=$!
  # shellcheck disable=SC2086
  run 3 fiber_query_mpi $command --out pipe
  wait $reader
  cmp expected.txt read.txt || fail "the pipe has something else: $command"
  [ -p pipe ] || fail "a pipe became a file: $command"
  rm link link_to_link dangling nothing pipe
done

# ---- convert, to text and back
run 2 fiber_query_mpi convert bars.csv bars.h5
run 2 fiber_query_mpi convert bars.h5 expected_fibers.csv
run 2 fiber_query_mpi convert one.csv expected.hair
for end in csv hair; do
  source=$([ $end = csv ] && echo bars.h5 || echo one.csv)
  expected=$([ $end = csv ] && echo expected_fibers.csv || echo expected.hair)
  ln -s elsewhere/converted link.$end
  mkfifo pipe.$end
  run 2 fiber_query_mpi convert "$source" link.$end
  [ -L link.$end ] && cmp $expected elsewhere/converted || fail "a link to .$end"
  cat pipe.$end >read.txt &
  reader=$!
  run 2 fiber_query_mpi convert "$source" pipe.$end
  wait $reader
  [ -p pipe.$end ] && cmp $expected read.txt || fail "a pipe of .$end"
done

# ---- HDF5 follows links, also to a recording with its folder, and refuses what is no file
run 2 fiber_scene_mpi soup --segments 1000 --out expected.h5
ln -s elsewhere/scene.h5 scene.h5
run 3 fiber_scene_mpi soup --segments 1000 --out scene.h5
[ -L scene.h5 ] && cmp expected.h5 elsewhere/scene.h5 || fail "a link to HDF5"
ln -s elsewhere/frames.h5 frames.h5
run 2 fiber_query_mpi contacts bars.csv --out frames.h5
[ -L frames.h5 ] && [ -f elsewhere/frames.h5 ] && [ -f elsewhere/frames.frames/000001.h5 ] || fail "a link to a recording"
ln -s elsewhere/moving.h5 moving.h5
run 2 fiber_query_mpi convert bars.csv moving.h5
run 2 fiber_query_mpi contacts moving.h5 | cmp expected.csv - || fail "a recording is not read through a link"
mkfifo pipe.h5
for command in "fiber_scene_mpi soup --segments 1000 --out pipe.h5" "fiber_query_mpi convert bars.csv pipe.h5" \
  "fiber_query_mpi contacts bars.csv --out pipe.h5"; do
  # shellcheck disable=SC2086
  expect_refused "pipe.h5: is a device or a pipe: HDF5 can be written to a file only" $command
  [ -p pipe.h5 ] || fail "a pipe became a file: $command"
done
expect_refused "elsewhere: cannot be written: is a folder" fiber_query_mpi contacts bars.csv --out elsewhere
ln -s circle_a circle_b
ln -s circle_b circle_a
expect_refused "circle_a: cannot be written: too many links" fiber_query_mpi contacts bars.csv --out circle_a
mkfifo pipe
expect_refused "--resume: what went to 'pipe', which is no file," fiber_query_mpi check bars.csv --out pipe --resume

# ---- convert, to formats of other programs and back; what they have no place for is told
run 2 fiber_query_mpi convert one.csv one.h5
for end in npz tck trk vtp; do
  run 2 fiber_query_mpi convert one.h5 other.$end 2>told.txt
  grep -q "other.$end: the format has no names" told.txt || fail "names are lost without a word: $end"
  run 2 fiber_query_mpi convert other.$end back.csv
  radius=$([ $end = tck ] && echo 0 || echo 0.1)
  printf 'fiber,x,y,z,radius\n0,0,0,0,%s\n0,1,0,0,%s\n1,0,0,0.15,%s\n1,1,0,0.15,%s\n' \
    "$radius" "$radius" "$radius" "$radius" >expected_back.csv
  cmp back.csv expected_back.csv || fail "others come back from .$end"
done
grep -q "other.tck: the format has no radii" <(run 1 fiber_query_mpi convert one.h5 other.tck 2>&1) ||
  fail "radii are lost without a word"

# ---- names of other formats
for end in npy vtu trx; do
  expect_refused "--out: 'found.$end' is a name of" fiber_query_mpi contacts bars.csv --out found.$end
  expect_refused "OUT: 'found.$end' must end in .h5, .csv, .hair" fiber_query_mpi convert bars.csv found.$end
  expect_refused "found.$end: is " fiber_query_mpi contacts found.$end
done
for command in "contacts bars.csv --format json --out found.csv" "contacts bars.csv --format csv --out found.json" \
  "contacts bars.csv --format json --out found.h5" "contacts bars.csv --format hdf5 --out found.csv" \
  "sweep bars.csv --out found.h5" "check bars.csv --out found.json"; do
  # shellcheck disable=SC2086
  expect_refused "is a name of" fiber_query_mpi $command
done
[ -z "$(find . -name 'found*')" ] || fail "something is left of what was refused"
run 2 fiber_query_mpi contacts bars.csv --out named.json
"$tools/fiber_query" contacts bars.csv --format json | cmp - named.json || fail "a name that ends in .json has something else"

# ---- devices, in this folder
if [ "$(id -u)" -ne 0 ] || ! mknod null c 1 3 2>/dev/null || ! mknod full c 1 7; then
  echo "$test_name: devices are left out, only root makes them"
  exit 0
fi
mknod null.h5 c 1 3
mknod null.csv c 1 3
mknod null.hair c 1 3
ln -s null link_to_null
for command in "${tools_of_text[@]}"; do
  for out in null link_to_null; do
    # shellcheck disable=SC2086
    run 2 fiber_query_mpi $command --out $out
    [ -c $out ] || fail "a device became a file: $command"
  done
  # shellcheck disable=SC2086
  expect_refused "full: cannot be written: No space left" fiber_query_mpi $command --out full
  [ -c full ] || fail "a full device became a file: $command"
done
run 2 fiber_query_mpi convert bars.csv null.csv
run 2 fiber_query_mpi convert one.csv null.hair
for command in "fiber_scene_mpi soup --segments 1000 --out null.h5" "fiber_query_mpi convert bars.csv null.h5" \
  "fiber_query_mpi contacts one.csv --out null.h5"; do
  # shellcheck disable=SC2086
  expect_refused "null.h5: is a device or a pipe" $command
done
for device in null null.h5 null.csv null.hair; do
  [ -c $device ] || fail "$device became a file"
done
[ -z "$(find . -name '*.part*')" ] || fail "a part is left"
