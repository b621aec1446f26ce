#!/usr/bin/env bash
# Builds the core with AddressSanitizer and UndefinedBehaviorSanitizer and runs its tests, then with
# ThreadSanitizer and runs those about several threads: it slows tests tenfold, and where one thread
# works it has nothing to see.
#   scripts/sanitize.sh [--verbose]
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/sanitize.sh [--verbose]"
while [ $# -gt 0 ]; do
  case "$1" in
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

build+=/sanitize
# By the oldest compiler there is: so CI knows that it takes the sources.
cmake_arguments=("${core_arguments[@]}" "-DFIBER_PROXIMITY_SANITIZE=address,undefined"
  -DCMAKE_CXX_COMPILER=g++-11)
build_package all
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
run_tests --parallel "$(nproc)" --label-exclude "^all$"

build+=-threads
if ! dpkg-query -W libtbb12 >/dev/null 2>&1; then
  echo "sanitize.sh: ThreadSanitizer needs Debian 12's TBB: left out" >&2
  exit
fi
"$root/scripts/build_tbb.sh" "$build/tbb"
cmake_arguments=("${core_arguments[@]}" -DFIBER_PROXIMITY_SANITIZE=thread
  -DTBB_DIR="$build/tbb/install/lib/cmake/TBB")
build_package threaded_tests
# One after the other: the threads of one test are to run at the same time. No test goes on after a
# race, whose report is long enough.
TSAN_OPTIONS=halt_on_error=1 run_tests --label-regex threaded
