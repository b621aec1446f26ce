#!/usr/bin/env bash
# Builds without ROS are configured with their tests, and whatever else is said to builds with ROS.
#   configure_test.sh SOURCE
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake -S "$source" -B "$work/build" -DFIBER_PROXIMITY_BUILD_ROS=OFF -DCATKIN_ENABLE_TESTING=ON \
  -DPYTHON_EXECUTABLE=/usr/bin/python3 -DPython3_EXECUTABLE=/usr/bin/python3 >"$work/log.txt" 2>&1 ||
  { cat "$work/log.txt"; echo "configure_test: cmake refuses a build without ROS" >&2; exit 1; }
# Written last, once all targets are there.
[ -s "$work/build/unit_tests.txt" ] || { echo "configure_test: the build has no tests" >&2; exit 1; }
