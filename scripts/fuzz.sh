#!/usr/bin/env bash
# Feeds what reads files and messages with what nobody foresaw: libFuzzer on the inputs kept in
# test/fuzz/corpus. A crash, a report of a sanitizer, too much memory, a hang or an unreadable error is a
# finding: exit 1, and the input stays in fuzz/findings of the build. Without ROS there are fewer targets.
#   scripts/fuzz.sh [--runs N | --seconds N] [--seed S] [--target T]... [--jobs N]
#     --runs N      inputs per target (default 20000, fewer of slow ones): the same inputs each time,
#                   however busy the machine
#     --seconds N   time per target instead
#     --seed S      of the random changes (default 1)
#     --target T    one of those in test/fuzz/corpus (default: all)
#     --jobs N      targets at the same time (default: as many as there are cores)
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/fuzz.sh [--runs N | --seconds N] [--seed S] [--target T]... [--jobs N]"
refuse() { echo "fuzz.sh: $1; $usage" >&2; exit 2; }
limit=
# Inputs per target: those of meshes are read in a process of their own each.
declare -A runs=([meshes]=100)
seed=1
jobs=$(nproc)
targets=()
while [ $# -gt 0 ]; do
  case "$1" in
    -h | --help) echo "$usage"; exit 0 ;;
    --runs | --seconds | --seed | --jobs)
      [[ "${2:-}" =~ ^[0-9]{1,10}$ ]] && [ "$2" -gt 0 ] || refuse "$1 needs a whole number from 1"
      ;;&
    --runs) limit=-runs=$2 ;;
    --seconds) limit=-max_total_time=$2 ;;
    --seed) seed=$2 ;;
    --jobs) jobs=$2 ;;
    --target)
      [ -d "$root/test/fuzz/corpus/${2:-.}" ] && [ -n "${2:-}" ] ||
        refuse "--target is one of: $(ls "$root/test/fuzz/corpus" | paste -sd' ')"
      targets+=("$2")
      ;;
    *) refuse "unknown argument '$1'" ;;
  esac
  shift 2
done
if [ ${#targets[@]} -eq 0 ]; then
  mapfile -t targets < <(ls "$root/test/fuzz/corpus")
fi

"$root/scripts/setup.sh" --fuzz
build+=/fuzz
make_build_folder
mkdir -p "$build/findings"
run_step "configuring fuzz" "$build/configure.log" \
  cmake -S "$root/test/fuzz" -B "$build" -DCMAKE_CXX_COMPILER=clang++-13
run_step "building fuzzers" "$build/make.log" cmake --build "$build" --parallel "$(nproc)"

# run TARGET LIMIT NUMBER: one line with the number; the log of a finding names the input that made it.
run() {
  local target=$1 limit=$2 log=$build/$1.log learned=$build/corpus/${2%%=*}/$1 dictionary=()
  if [ ! -x "$build/fuzz_$target" ]; then
    echo "[$3] fuzz $target: left out, it needs ROS"
    return
  fi
  if [ -f "$root/test/fuzz/dictionaries/$target" ]; then
    dictionary=(-dict="$root/test/fuzz/dictionaries/$target")
  fi
  # What a campaign learns is no part of the repository; a fixed number of runs begins without it.
  if [[ $limit = -runs=* ]]; then rm -rf "$learned"; fi
  mkdir -p "$learned"
  # An input that takes longer than the timeout hangs on any machine, also a busy one: most take less
  # than a thousandth of a second.
  if "$build/fuzz_$target" "$limit" -seed="$seed" -max_len=16384 -timeout=60 -rss_limit_mb=2048 \
    -malloc_limit_mb=256 -print_final_stats=1 -artifact_prefix="$build/findings/$target-" \
    "${dictionary[@]}" "$learned" "$root/test/fuzz/corpus/$target" \
    >"$log" 2>&1; then
    echo "[$3] fuzz $target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs, no finding"
  else
    tail -n 60 "$log" | grep -E "^(finding|SUMMARY|==.*ERROR)|runtime error|Test unit written" >&2 ||
      tail -n 5 "$log" >&2
    echo "[$3] fuzz $target: FINDING, see $log and $build/findings" >&2
    return 1
  fi
}
export -f run
export build root seed
run_all() {
  local target number=0
  for target in "${targets[@]}"; do
    echo "$target" "${limit:--runs=${runs[$target]:-20000}}" "$((++number))/${#targets[@]}"
  done | xargs -P "$jobs" -n 3 bash -c 'run "$0" "$1" "$2" || exit 1'
}
run_step "fuzzing" "$build/fuzz.log" run_all ||
  { echo "fuzz.sh: there are findings in $build/findings" >&2; exit 1; }
$verbose || sed 's|^\[[0-9/]*\] ||' "$build/fuzz.log"
