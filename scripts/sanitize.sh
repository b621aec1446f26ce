#!/usr/bin/env bash
# Builds the core with AddressSanitizer and UndefinedBehaviorSanitizer and runs its tests, then with
# ThreadSanitizer and runs those about several threads: it slows tests tenfold, and where one thread
# works it has nothing to see.
#   scripts/sanitize.sh [--changed] [--verbose]
#     --changed   only tests that read what has changed since the commit in .ci/sanitized, at which all were
#                 clean. .ci/run does it
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/sanitize.sh [--changed] [--verbose]"
changed=all
while [ $# -gt 0 ]; do
  case "$1" in
    --changed) changed=$(changed_since .ci/sanitized cmake/compiler.cmake) ;;
    --verbose) be_verbose ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "sanitize.sh: unknown option '$1'; $usage" >&2; exit 2 ;;
  esac
  shift
done

"$root/scripts/setup.sh" --sanitize
# Without benchmarks: what they measure (time, memory of malloc) is not theirs under a sanitizer.
# With line tables alone, which reports read, the compiler takes a third less time.
# Without MPI, whose own libraries the sanitizers report.
core_arguments=(-DFIBER_PROXIMITY_BUILD_ROS=OFF -DFIBER_PROXIMITY_BUILD_BENCHMARKS=OFF
  -DFIBER_PROXIMITY_BUILD_MPI=OFF
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1\ -g1)

# test_reached CTEST_ARGUMENT...: builds and runs those of these tests that read what has changed.
test_reached() {
  local tests programs python=()
  configure_package
  tests=$(cd "$build" && ctest --show-only "$@" | sed -n 's/^ *Test *#[0-9]*: //p')
  # Tests in Python are about the module; of the others, each is a program of its name.
  ! grep -q '^python_' <<<"$tests" || python=(fiber_proximity_python)
  mapfile -t programs < <(grep -v '^python_' <<<"$tests")
  mapfile -t programs < <("$root/scripts/reached_tests.py" "$build" "${programs[@]}" "${python[@]}" <<<"$changed")
  if [ ${#programs[@]} -eq 0 ]; then
    echo "$(basename "$build"): no test reads what has changed"
    return
  fi
  build_targets "${programs[@]}"
  run_tests "$@" --tests-regex "^($(IFS='|'; sed 's/fiber_proximity_python/python_.*/' <<<"${programs[*]}"))\$"
}

build+=/sanitize
# By the oldest compiler there is: so CI knows that it takes the sources.
cmake_arguments=("${core_arguments[@]}" "-DFIBER_PROXIMITY_SANITIZE=address,undefined"
  -DCMAKE_CXX_COMPILER=g++-11)
# Minutes of physics, of sizes and of exact arithmetic, more than half of the time. Other tests are
# about the same code, with smaller scenes.
long_tests=(
  'Scenes/ShippedReversal.*' 'Scenes/ShippedScene.*/pile' 'AtSpeeds/Obstacle.ThinPlates*/1'
  'AtSpeeds/Obstacle.ThinPlates*/2' 'ExtremeScenesTest.AMillionFibers*' 'NaturalCurvature.AClamp*' 'Capstan.*'
  'Springs/*' 'Spring.*' 'Instability.*' 'Conservation.*' 'Tunnelling.*' 'Loads.APile*'
  'MostIterations/PulledKnot.*' 'Robustness.StiffAndFolded*' 'Regression.AStiffCable*' 'Hair.*'
  'Ropes/CapstanOf.*' 'Resting.*' 'ThinRods.*' 'Scenes/Residual.*' 'MovingObstacles.AGripperThat*'
  'Robustness.AFastGripper*' 'Impact.OfARodOnATable*' 'Scene.HasThePapersCounts' 'LargeScene.IsTheSame*'
  'LargeScene.StaysAsDense*' 'SelfContact.LongCables*' 'Skins/RunTreeLimits.*/with_a_skin'
  'Engines/DeadlineTest.*/brute_force' 'AutomaticSkinTest.ASkinIsGivenUp*' 'AutomaticSkinTest.FramesThatFollow*'
  'AutomaticSkinTest.WhatDoesNotFollow*' 'Families/HardPairs.ContactsAreDecidedExactlyWithin*'
  'All/MotionFamilies.*/crossing__but_for_a_rounding' 'ShrinkingSearchTest.FindsWhatBruteForce*'
  'FiberQuery.EveryEngine*' 'FiberQuery.AgreesWithBruteForce*' 'FiberQuery.PrintsTheLibrarysNumbers*'
  'RunTree*.AnswersTheSameWithEveryInstructionSet'
)
GTEST_FILTER="-$(IFS=:; echo "${long_tests[*]}")"
export GTEST_FILTER
test_reached --parallel "$(nproc)" --label-exclude "^all$"

build+=-threads
if ! dpkg-query -W libtbb12 >/dev/null 2>&1; then
  echo "sanitize.sh: ThreadSanitizer needs Debian 12's TBB: left out" >&2
  exit
fi
"$root/scripts/build_tbb.sh" "$build/tbb"
cmake_arguments=("${core_arguments[@]}" -DFIBER_PROXIMITY_SANITIZE=thread
  -DTBB_DIR="$build/tbb/install/lib/cmake/TBB")
# One after the other: the threads of one test are to run at the same time. No test goes on after a
# race, whose report is long enough.
TSAN_OPTIONS=halt_on_error=1 test_reached --label-regex threaded
