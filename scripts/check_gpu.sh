#!/usr/bin/env bash
# Builds what a check of the GPU engine needs, packs it with all that it loads, and runs it where a GPU is: tests of
# engines, the same answers as on the processor byte by byte, compute-sanitizer, times. Writes one report.
#   scripts/check_gpu.sh [--pack FOLDER | --run FOLDER] [--only tests|times|candidates] [--out DIR] [--verbose]
#     --pack FOLDER  build and pack only: the folder then runs on any 64-bit Linux with a GPU, where nothing is installed
#                    but the driver and, for the tests, compute-sanitizer, which NVIDIA's cuda-sanitizer packages bring
#     --run FOLDER   run what lies packed there
#     --only WHAT    of the two halves: tests, or times on the eight scenes of the paper and of batches of candidates;
#                    or candidates: tests and times of these alone
#     --out DIR      where report.md, times.jsonl, sizes.jsonl and candidates.jsonl go (default: gpu/report in the
#                    build's folder)
set -euo pipefail

usage="usage: scripts/check_gpu.sh [--pack FOLDER | --run FOLDER] [--only tests|times|candidates] [--out DIR] [--verbose]"
pack=
run=
out=
only=
verbose_wanted=false
while [ $# -gt 0 ]; do
  case "$1" in
    --pack | --run | --out | --only)
      [ $# -ge 2 ] || { echo "check_gpu.sh: $1 needs a value; $usage" >&2; exit 2; }
      declare "${1#--}=$2"
      shift
      ;;
    --verbose) verbose_wanted=true ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "check_gpu.sh: unknown argument '$1'; $usage" >&2; exit 2 ;;
  esac
  shift
done

case "$only" in
  '' | tests | times | candidates) ;;
  *) echo "check_gpu.sh: --only takes 'tests', 'times' or 'candidates', not '$only'; $usage" >&2; exit 2 ;;
esac

programs=(cuda_tree_test query_test hard_scenes_test accuracy_test contact_limit_test concurrent_queries_test
  fiber_graph_test motion_test self_contact_test fiber_bench)
[ "$only" != candidates ] || programs=(cuda_tree_test fiber_bench)

# Cables beside each other, 330 segments a copy, and fibres anywhere, 1000000: from how many on a GPU pays.
sizes="cables --copies 1
cables --copies 3
cables --copies 10
cables --copies 30
cables --copies 100
cables --copies 300
cables --copies 1000
soup --scale 0.001
soup --scale 0.01
soup --scale 0.03
soup --scale 0.1
soup --scale 0.3"

batches="10000
10000 --still 0
10000 --radius 0.01
1000
100
10
10000 --cables 1"

# built NAME WHAT...: finds a file of the build, which is none that was packed before.
built() { find "$build" -path "$build/packed" -prune -o -name "$1" -type f "${@:2}"; }

# pack_programs FOLDER: programs, the libraries they load and the loader, without symbols.
pack_programs() {
  mkdir -p "$1/lib"
  local program
  for program in "${programs[@]}"; do
    built "$program" -perm -u+x -exec cp {} "$1" \; -quit
    cp -Lu /lib/x86_64-linux-gnu/{libpthread.so.0,libdl.so.2,librt.so.1} "$1/lib"  # the driver asks for them
    ldd "$1/$program" | awk '$2 == "=>" { print $3 } $1 ~ /ld-linux/ { print $1 }' | xargs -I{} cp -Lu {} "$1/lib"
  done
  built 'libfiber_proximity_cuda_device.so.*' -exec cp {} "$1/lib" \; -quit # which the engine loads by itself
  strip "$1"/*_test "$1/fiber_bench" "$1"/lib/libfiber* 2>/dev/null || true
  cp "$0" "$1/check_gpu.sh"
}

# here PROGRAM ARGUMENT...: with the libraries packed beside it, and the driver's.
here() {
  local program=$1
  shift
  "$run/lib/ld-linux-x86-64.so.2" --library-path "$run/lib:/usr/local/nvidia/lib64:/usr/lib/x86_64-linux-gnu" \
    "$run/$program" "$@"
}

# step NAME COMMAND...: its last lines go into the report.
failed=0
step() {
  local name=$1 start seconds status=passed
  shift
  start=$(date +%s)
  "$@" >"$out/$name.log" 2>&1 || status="FAILED ($?)"
  ! grep -q 'Running 0 tests' "$out/$name.log" || status="FAILED: no test of this name"
  [ "$status" = passed ] || failed=1
  seconds=$(($(date +%s) - start))
  echo "check_gpu.sh: $name: $status, $seconds s"
  { echo "## $name: $status, $seconds s"; echo '```'; tail -n "${tail_lines:-6}" "$out/$name.log"; echo '```'; } >>"$out/report.md"
}

run_tests_there() {
  export FIBER_PROXIMITY_TEST_GPU=1
  step same_bytes env FIBER_PROXIMITY_TEST_SCENES=2000 bash -c "$(declare -f here); run='$run'; here cuda_tree_test"
  step engines here query_test --gtest_filter='*/cuda_tree'
  step limits here contact_limit_test --gtest_filter='*/cuda_tree'
  step accuracy here accuracy_test --gtest_filter='*/cuda_tree'
  step concurrent here concurrent_queries_test --gtest_filter='*/cuda_tree'
  step joined here fiber_graph_test --gtest_filter='*/cuda_tree'
  step motions here motion_test --gtest_filter='*/cuda_tree'
  step loops here self_contact_test --gtest_filter='*/cuda_tree'
  step hard_scenes here hard_scenes_test --gtest_filter='*/cuda_tree*'
  sanitize_there '*TakesAnyNumber*:*AskedAgain*:DeviceProximity.Refuses*:ContactsToHost.Locked*:Candidates.AreRefused*:SharedDevice.*'
}

# sanitize_there TESTS
sanitize_there() {
  local sanitizer tool
  sanitizer=$(command -v compute-sanitizer || ls /usr/local/cuda/bin/compute-sanitizer 2>/dev/null || true)
  if [ -z "$sanitizer" ]; then
    failed=1
    echo "check_gpu.sh: compute-sanitizer: FAILED: not found" >&2
    echo "## compute-sanitizer: FAILED: it is neither on PATH nor in /usr/local/cuda/bin" >>"$out/report.md"
    return
  fi
  for tool in memcheck racecheck; do
    step $tool "$sanitizer" --tool $tool --error-exitcode 9 "$run/lib/ld-linux-x86-64.so.2" \
      --library-path "$run/lib:/usr/local/nvidia/lib64:/usr/lib/x86_64-linux-gnu" "$run/cuda_tree_test" \
      --gtest_filter="$1"
  done
}

test_candidates_there() {
  export FIBER_PROXIMITY_TEST_GPU=1
  step candidates here cuda_tree_test --gtest_filter='Candidates.*'
}

# Batches as planners have them: from how many on a GPU pays; with nothing that stands still; with many contacts.
measure_candidates_there() {
  local batch name
  : >"$out/candidates.jsonl"
  while read -r -a batch; do
    name=$(IFS=_; echo "candidates_${batch[*]//--/}")
    step "$name" here fiber_bench device --json --candidates "${batch[@]}" --threads "$(nproc)" \
      --repeats 7 </dev/null
    cat "$out/$name.log" >>"$out/candidates.jsonl"
  done <<<"$batches"
}

measure_there() {
  local scene frames=${FIBER_PROXIMITY_GPU_FRAMES:-11}
  : >"$out/times.jsonl"
  for scene in soup tress_a tress_b cloth longish windy charming curly; do
    step "cycle_$scene" here fiber_bench cycle --json --scene "$scene" --engines run_tree,cuda_tree \
      --threads "$(nproc)" --repeats "$frames"
    step "device_$scene" here fiber_bench device --json --stages --scene "$scene" --threads "$(nproc)" \
      --repeats "$frames"
    cat "$out/cycle_$scene.log" "$out/device_$scene.log" >>"$out/times.jsonl"
  done
  : >"$out/sizes.jsonl"
  local size
  while read -r -a size; do
    step "size_${size[0]}_${size[2]}" here fiber_bench cycle --json --scene "${size[@]}" --engines run_tree,cuda_tree \
      --threads "$(nproc)" --repeats 31 </dev/null
    cat "$out/size_${size[0]}_${size[2]}.log" >>"$out/sizes.jsonl"
  done <<<"$sizes"
}

run_checks() {
  mkdir -p "$out"
  {
    echo "# cuda_tree on a GPU"
    echo "$(nvidia-smi --query-gpu=name,driver_version --format=csv,noheader 2>/dev/null || echo 'no nvidia-smi'), $(nproc) cores ($(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1)), $(date +%F)"
  } >"$out/report.md"
  case "$only" in '' | tests) run_tests_there ;; candidates) test_candidates_there ;; esac
  case "$only" in '' | times) measure_there ;; esac
  [ "$only" = tests ] || measure_candidates_there
  [ "$only" != candidates ] || sanitize_there 'Candidates.OfAnySize*:Candidates.AreRefused*'
  echo "All of it: $SECONDS s" >>"$out/report.md"
  echo "check_gpu.sh: the report is $out/report.md"
  return $failed
}

if [ -z "$run" ]; then
  # shellcheck source=scripts/environment.sh
  source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
  ! $verbose_wanted || be_verbose
  "$root/scripts/setup.sh" --cuda
  build+=/gpu
  out=${out:-$build/report}
  cmake_arguments=(-DFIBER_PROXIMITY_BUILD_ROS=OFF -DFIBER_PROXIMITY_BUILD_MPI=OFF -DFIBER_PROXIMITY_PEERS=OFF
    -DFIBER_PROXIMITY_BUILD_CUDA=ON)
  build_package "${programs[@]}"
  run=${pack:-$build/packed}
  pack_programs "$run"
  if [ -n "$pack" ]; then
    echo "check_gpu.sh: packed; where a GPU is: $pack/check_gpu.sh --run $pack --out DIR"
    exit
  fi
fi
run=$(cd "$run" && pwd)
out=${out:-$run/report}
mkdir -p "$out"
out=$(cd "$out" && pwd)
run_checks
