#!/usr/bin/env bash
# fiber_query_mpi takes closed and joined fibres as fiber_query does, and files of HDF5 keep them.
#   joined_files_test.sh FOLDER MPIEXEC [FLAG...]
#     see tool_test.sh
# shellcheck source=test/mpi/tool_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/tool_test.sh"

# ask RANKS ARGUMENT...: fiber_query_mpi on so many ranks.
ask() {
  local ranks=$1
  shift
  "${mpiexec[@]}" "$ranks" "$tools/fiber_query_mpi" "$@"
}

# Three frames: two rings that are linked, a closed eight that is joined where it crosses, a trunk with branches at 5 to
# 175 degrees that touch the rings, with other radii, and a chain.
awk 'BEGIN {
  print "frame,fiber,x,y,z,radius,closed,joint"
  pi = atan2(0, -1)
  for (frame = 1; frame <= 3; ++frame) {
    for (i = 0; i < 40; ++i) {
      a = 2 * pi * i / 40
      printf "%d,ring,%.9f,%.9f,%.9f,0.02,1,\n", frame, cos(a), sin(a), 0.01 * frame
      printf "%d,link,%.9f,%.9f,%.9f,0.03,1,\n", frame, 1 + cos(a), 0.05 * frame * sin(a), sin(a)
    }
    for (i = 0; i < 30; ++i) {
      a = 2 * pi * i / 30
      s = i % 15 == 0 ? 0 : sin(a)
      printf "%d,eight,%.9f,%.9f,%.9f,0.02,1,%s\n", frame, 3 + s, s * cos(a), 0.1 * frame, i % 15 == 0 ? 77 : ""
    }
    for (i = 0; i < 36; ++i) printf "%d,trunk,%.9f,0,-1,0.04,0,%s\n", frame, 0.1 * i, i % 5 == 0 ? i : ""
    for (k = 0; k < 36; k += 5) {
      a = pi / 180 * (5 + 170 * k / 35)
      for (i = 0; i < 12; ++i)
        printf "%d,branch %d,%.9f,%.9f,%.9f,%.3f,0,%s\n", frame, k, 0.1 * k + 0.1 * i * cos(a), 0.02 * frame * i, \
          -1 + 0.1 * i * sin(a), 0.02 + 0.001 * k, i == 0 ? k : ""
    }
    for (i = 0; i < 20; ++i) printf "%d,chain,%.9f,0.3,%.9f,0.02,0,\n", frame, 0.2 * i, 0.2 * sin(i)
  }
}' >joined.csv

ask 3 convert joined.csv joined.h5
ask 2 convert joined.h5 again.h5
ask 4 convert again.h5 again.csv
for query in "contacts --margin 0.05" "contacts --margin 0.3 --neighbour-skip 3" \
  "contacts --margin 0.3 --neighbour-skip-length 0.45 --format json" "closest" "fiber_pairs --margin 0.5" "fiber_pairs" \
  "sweep --margin 0.02" "sweep --type first --neighbour-skip 2"; do
  # shellcheck disable=SC2086  # several options
  set -- $query
  command=$1
  shift
  "$tools/fiber_query" "$command" joined.csv "$@" >expected.txt
  [ "$(wc -l <expected.txt)" -gt 1 ] || fail "nothing is found: $query"
  "$tools/fiber_query" "$command" again.csv "$@" | cmp expected.txt - || fail "HDF5 has lost something: $query"
  for way in "1 joined.h5" "2 again.h5" "3 joined.csv" "7 joined.h5"; do
    read -r ranks file <<<"$way"
    ask "$ranks" "$command" "$file" "$@" --out found.txt
    cmp expected.txt found.txt || fail "$ranks ranks find something else in $file: $query"
    rm found.txt
  done
done

# As candidates: whole on the rank that checks them.
"$tools/fiber_query" check joined.csv --margin 0.02 --type all >expected.csv
for file in joined.csv joined.h5; do
  ask 3 check "$file" --margin 0.02 --type all --out found.csv
  cmp expected.csv found.csv || fail "candidates of $file are checked in another way"
  rm found.csv
done

# A run is gone on with.
rm again.frames/000002.h5
ask 2 convert joined.h5 again.h5 --resume
ask 2 convert again.h5 resumed.csv
cmp again.csv resumed.csv || fail "a run that is gone on with loses something"

# refused FILE TEXT: any number of ranks ends with one error that has the text.
refused() {
  for ranks in 1 3; do
    if ask "$ranks" contacts "$1" --out found.csv 2>error.txt; then fail "$1 is taken"; fi
    [ "$(grep -cF "$2" error.txt)" -eq 1 ] || fail "not said once of $1 what is wrong: $(cat error.txt)"
    [ ! -e found.csv ] || fail "there is an answer about $1"
  done
}
printf 'fiber,x,y,z,radius,closed,joint\n' | tee apart.csv short.csv >lonely.csv
printf 'a,%s\n' 0,0,0,0.01,0, 1,0,0,0.01,0,4 >>apart.csv
printf 'b,%s\n' 1,0.5,0,0.01,0,4 2,0,0,0.01,0, >>apart.csv
refused apart.csv "are 0.5 m apart; points that are joined must lie within 0.01 m"
printf 'a,%s\n' 0,0,0,0.01,1, 1,0,0,0.01,1, >>short.csv
refused short.csv "is closed and has 2 points, a closed fibre needs at least 3"
printf 'a,%s\n' 0,0,0,0.01,0, 1,0,0,0.01,0,4 1,1,0,0.01,0,9 >>lonely.csv
printf 'b,%s\n' 1,0,0,0.01,0,4 2,0,0,0.01,0, >>lonely.csv
ask 2 convert lonely.csv lonely.h5 2>error.txt
for file in lonely.csv lonely.h5; do
  ask 3 contacts "$file" --out found.csv 2>error.txt
  [ "$(grep -c "joint 9 is the number of one point alone" error.txt)" -eq 1 ] ||
    fail "a number that is used once is not told of once: $(cat error.txt)"
  [ "$(wc -l <found.csv)" -eq 1 ] || fail "what is joined is in contact"
  rm found.csv
done
