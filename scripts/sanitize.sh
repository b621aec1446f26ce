#!/usr/bin/env bash
# Builds the core with AddressSanitizer and UndefinedBehaviorSanitizer and runs its tests.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

"$root/scripts/setup.sh"
build=$root/build-sanitize
cmake_arguments=(-DFIBER_PROXIMITY_BUILD_ROS=OFF -DCMAKE_BUILD_TYPE=RelWithDebInfo
  -DFIBER_PROXIMITY_SANITIZE=address,undefined -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1\ -g)
echo "building in $build ..."
build_package all
cd "$build"
ctest --output-on-failure
