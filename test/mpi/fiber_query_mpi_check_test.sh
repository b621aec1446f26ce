#!/usr/bin/env bash
# fiber_query_mpi check: any number of ranks and any format of file give the bytes of fiber_query check, and these are what
# the library's check of fibres means; what is wrong it says once, and leaves nothing.
#   fiber_query_mpi_check_test.sh FOLDER MPIEXEC [FLAG...]
#     see tool_test.sh
# shellcheck source=test/mpi/tool_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/tool_test.sh"

# check RANKS ARGUMENT...
check() {
  local ranks=$1
  shift
  "${mpiexec[@]}" "$ranks" "$tools/fiber_query_mpi" check "$@"
}

# ---- what is known beforehand: bars at ever larger heights, over a floor, below and above a ball
cat >world.yaml <<'EOF'
obstacles:
  - id: floor
    half_spaces: [{coef: [0.0, 0.0, 1.0, 0.0]}]
  - id: 'a "ball", round'
    pose: {position: [0.5, 0.0, 0.55]}
    primitives: [{type: sphere, dimensions: [0.2]}]
EOF
awk 'BEGIN {
  print "frame,fiber,x,y,z,radius"
  for (i = 0; i < 50; ++i) {
    z = i / 50 - 0.105
    for (x = 0; x <= 1; ++x) printf "%d,bar,%d,0,%.3f,0.01\n", 1000 - i, x, z
  }
}' >bars.csv
awk 'BEGIN {
  for (i = 0; i < 50; ++i) {
    z = i / 50 - 0.105
    ball = z - 0.55; if (ball < 0) ball = -ball
    print 1000 - i "," (z <= 0.02 ? "0,object,floor" : ball <= 0.22 ? "0,object,\"a \"\"ball\"\", round\"" : "1,,")
  }
}' >expected.csv
check 3 bars.csv --environment world.yaml --margin 0.01 --out found.csv
head -n 1 found.csv | grep -q '^frame,free,with,object,fiber_a,segment_a,s,' || fail "no such header"
tail -n +2 found.csv | sed -E 's/^([0-9]+,1,,),+$/\1/; s/^([0-9]+,0,object,(floor|"a ""ball"", round")),.*/\1/' | cmp expected.csv - ||
  fail "other candidates are free"
# Allowed pairs, candidates without an environment, and names that differ between candidates.
printf 'allowed:\n  - {object: floor, fiber: bar, segments: [0, 0]}\n' | cat world.yaml - >allowed.yaml
check 2 bars.csv --environment allowed.yaml --margin 0.01 >found.csv
[ "$(grep -c '^[0-9]*,0,object,floor' found.csv)" -eq 0 ] || fail "what may touch counts"
# Names are those of each candidate: every second one is of another bar, whose number is that of the first.
awk -F, -v OFS=, '/^frame/ { print; next } $1 % 2 { $2 = "\"other, bar\"" } 1' bars.csv >turns.csv
check 3 turns.csv --environment allowed.yaml --margin 0.01 >found.csv
check 3 turns.csv --environment world.yaml --margin 0.01 >expected_turns.csv
cmp <(grep ',0,object,floor' found.csv) <(grep '^[0-9]*[13579],0,object,floor' expected_turns.csv) ||
  fail "other bars may touch the floor"
[ "$(grep -c ',0,object,floor,"other, bar",0,' found.csv)" -eq "$(grep -c ',0,object,floor' found.csv)" ] ||
  fail "bars have other names"
[ "$(grep -c ',0,object,floor' found.csv)" -gt 2 ] || fail "no bar touches the floor"
check 2 bars.csv --margin 0.01 >found.csv
[ "$(grep -c '^[0-9]*,1,,,*$' found.csv)" -eq 50 ] || fail "without environment not all are free"
# Fibres that there are: a bar across at height 0.5.
printf 'fiber,x,y,z,radius\n0,0.5,-1,0.5,0.01\n0,0.5,1,0.5,0.01\n' >there.csv
check 3 bars.csv --fibers there.csv --margin 0.001 --type closest >found.csv
[ "$(grep '^[0-9]*,0,fiber,,bar,0,' found.csv | cut -d, -f1 | tr '\n' ' ')" = "970 969 " ] || fail "other fibres are near"

# ---- tangles: any number of ranks, any format, any type
awk 'BEGIN {
  srand(5)
  print "frame,fiber,x,y,z,radius"
  for (frame = 0; frame < 70; ++frame) for (fiber = 0; fiber < 3; ++fiber) {
    x = rand(); y = rand(); z = rand()
    for (point = 0; point < 12; ++point) {
      printf "%d,%d,%.9f,%.9f,%.9f,0.01\n", frame, fiber, x, y, z
      x += 0.2 * rand() - 0.1; y += 0.2 * rand() - 0.1; z += 0.2 * rand() - 0.1
    }
  }
}' >tangles.csv
"${mpiexec[@]}" 2 "$tools/fiber_query_mpi" convert tangles.csv tangles.h5
cat >ball.yaml <<'EOF'
obstacles:
  - {id: ball, pose: {position: [0.5, 0.5, 0.5]}, primitives: [{type: sphere, dimensions: [0.1]}]}
EOF
for options in "--margin 0.01" "--margin 0.02 --type closest --environment ball.yaml" \
  "--margin 0.01 --type all --environment ball.yaml --fibers tangles.h5 --kernel exact" \
  "--type fiber_pairs --margin 0.05 --without-self --environment ball.yaml" "--environment ball.yaml --threads 2"; do
  # shellcheck disable=SC2086  # several options
  "$tools/fiber_query" check tangles.csv ${options/tangles.h5/tangles.csv} >expected.csv
  for free in 0 1; do
    grep -q "^[0-9]*,$free," expected.csv || fail "all or none are free: $options"
  done
  for ranks in 1 2 3; do
    for file in tangles.csv tangles.h5; do
      # shellcheck disable=SC2086
      check "$ranks" "$file" $options --out found.csv
      cmp expected.csv found.csv || fail "$ranks ranks find something else in $file: $options"
      [ ! -e found.csv.part ] || fail "a part is left"
      rm found.csv
    done
  done
  # shellcheck disable=SC2086
  check 3 tangles.h5 $options | cmp expected.csv - || fail "something else is written to stdout: $options"
done
# A candidate's contacts with itself are those that fiber_query finds; the first one is one of them.
"$tools/fiber_query" contacts tangles.csv --margin 0.01 >contacts.csv
check 2 tangles.h5 --margin 0.01 --type all >found.csv
awk -F, '$2 != "1"' found.csv | cut -d, -f1,5- | cmp contacts.csv - || fail "other contacts with itself"
check 2 tangles.csv --margin 0.01 >found.csv
awk -F, '$2 == "0"' found.csv | cut -d, -f1,5- >first.csv
! grep -qvxFf contacts.csv first.csv || fail "a first contact is none"
cmp <(cut -d, -f1 first.csv) <(tail -n +2 contacts.csv | cut -d, -f1 | uniq) || fail "not one for each that has contacts"
# More than a rank keeps until they are written, which two keep.
awk 'BEGIN {
  print "frame,fiber,x,y,z,radius"
  for (i = 0; i < 66000; ++i) for (x = 0; x <= 1; ++x) printf "%d,bar,%d,0,%.3f,0.01\n", i, x, (i % 97) / 97 - 0.1
}' >many.csv
"$tools/fiber_query" check many.csv --environment world.yaml >expected.csv
cmp <(tail -n +2 expected.csv | cut -d, -f1) <(seq 0 65999) || fail "candidates are not in order"
check 2 many.csv --environment world.yaml | cmp expected.csv - || fail "many candidates have other answers"
# One candidate, and none.
check 3 there.csv >found.csv
[ "$(tail -n +2 found.csv | tr -d ,)" = 1 ] || fail "a candidate without a number: $(cat found.csv)"
head -n 1 tangles.csv >none.csv
check 3 none.csv >found.csv
[ "$(wc -l <found.csv)" -eq 1 ] || fail "candidates where there are none"
rm found.csv

# ---- what is wrong
# expect_refused TEXT ARGUMENT...: three ranks refuse this, with exit code 2 and this text, once.
expect_refused() {
  local text=$1 code=0
  shift
  check 3 "$@" --out found.csv >out.txt 2>error.txt || code=$?
  [ "$code" -eq 2 ] || { cat error.txt; fail "$*: exit code $code"; }
  [ "$(grep -cF -e "$text" error.txt)" -eq 1 ] || { cat error.txt; fail "$*: not once: $text"; }
  [ -z "$(find . -name 'found*')" ] || fail "$*: something is left"
}

expect_refused "absent.h5: cannot be opened" absent.h5
expect_refused "absent.csv: cannot be opened" absent.csv
expect_refused "absent.yaml': there is no such file" bars.csv --environment absent.yaml
expect_refused "margin is -1" bars.csv --margin -1
expect_refused "--type" bars.csv --type limited
expect_refused "none.csv: has no fibres" bars.csv --fibers none.csv
sed '40s/,0,/,nan,/' bars.csv >bad.csv
expect_refused "bad.csv:40: " bad.csv
printf 'obstacles: 3\n' >bad.yaml
expect_refused "bad.yaml:1: obstacles" bars.csv --environment bad.yaml
printf 'obstacles:\n  - {id: a, half_spaces: [{coef: [0, 0, 1, 0]}]}\n  - {id: b, frame_id: hand, half_spaces: [{coef: [0, 0, 1, 0]}]}\n' >bad.yaml
expect_refused "obstacle 'b' is in frame 'hand'" bars.csv --environment bad.yaml
# A frame with a number that is none, a file of a frame that is no whole one, and one that is not there.
/usr/bin/python3 - tangles.frames/000031.h5 <<'EOF'
import math, struct, sys
with open(sys.argv[1], "rb") as file:
    data = file.read()
with open("tangles.csv") as rows:
    z = next(row for row in rows if row.startswith("31,")).split(",")[4]
place = data.find(struct.pack("<d", float(z)))
assert place > 0
with open("broken.h5", "wb") as file:
    file.write(data[:place] + struct.pack("<d", math.nan) + data[place + 8:])
EOF
cp tangles.frames/000031.h5 kept.h5
cp broken.h5 tangles.frames/000031.h5
expect_refused "tangles.h5: frames/000031: point 0 has the coordinate nan" tangles.h5
head -c 2000 kept.h5 >tangles.frames/000031.h5
expect_refused "tangles.h5: frames/000031: " tangles.h5
rm tangles.frames/000031.h5
expect_refused "tangles.h5: frames/000031: " tangles.h5
cp kept.h5 tangles.frames/000031.h5
code=0
check 2 bars.csv --out ./bars.csv 2>error.txt || code=$?
{ [ "$code" -eq 2 ] && grep -q "the file to write is the one to read itself" error.txt; } || fail "candidates are written over"
