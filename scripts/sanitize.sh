#!/usr/bin/env bash
# Builds the core with AddressSanitizer and UndefinedBehaviorSanitizer and runs its tests, then with
# ThreadSanitizer and runs those about several threads: it slows tests tenfold, and where one thread
# works it has nothing to see.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

"$root/scripts/setup.sh"
# Without benchmarks: what they measure (time, memory of malloc) is not theirs under a sanitizer.
# With line tables alone, which reports read, the compiler takes a third less time.
core_arguments=(-DFIBER_PROXIMITY_BUILD_ROS=OFF -DFIBER_PROXIMITY_BUILD_BENCHMARKS=OFF
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1\ -g1)

build=$root/build-sanitize
cmake_arguments=("${core_arguments[@]}" "-DFIBER_PROXIMITY_SANITIZE=address,undefined")
echo "building in $build ..."
build_package all
(cd "$build" && ctest --output-on-failure --parallel "$(nproc)")

build=$root/build-sanitize-threads
if ! dpkg-query -W libtbb12 >/dev/null 2>&1; then
  echo "sanitize.sh: ThreadSanitizer needs Debian 12's TBB: left out" >&2
  exit
fi
echo "building in $build ..."
"$root/scripts/build_tbb.sh" "$build/tbb"
cmake_arguments=("${core_arguments[@]}" -DFIBER_PROXIMITY_SANITIZE=thread
  -DTBB_DIR="$build/tbb/install/lib/cmake/TBB")
build_package threaded_tests
cd "$build"
# One after the other: the threads of one test are to run at the same time. No test goes on after a
# race, whose report is long enough.
TSAN_OPTIONS=halt_on_error=1 ctest --output-on-failure --label-regex threaded
