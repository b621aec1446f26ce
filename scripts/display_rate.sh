#!/usr/bin/env bash
# How fast rviz draws a scene, as our display and as a marker, without a graphics card.
#   scripts/display_rate.sh [SCENE [SCALE [FRAMES [TURNS]]]]   default: tress_b 1 5 3, a million
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
# shellcheck source=scripts/processes.sh
source "$(dirname "${BASH_SOURCE[0]}")/processes.sh"

"$root/scripts/setup.sh"
cmake_arguments=()
build_package display_rate
use_devel_space

start_virtual_display
start_master
"$build/devel/lib/fiber_proximity/display_rate" "${1:-tress_b}" "${2:-1}" "${3:-5}" "${4:-3}" \
  2>"$scratch/display_rate.log" || fail "no result" display_rate
