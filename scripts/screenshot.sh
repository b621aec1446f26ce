#!/usr/bin/env bash
# Starts a launch file of this package, which must take rviz_args, in a display of its own, without a
# graphics card, and saves what rviz shows soon after fibres are to be seen there.
#   scripts/screenshot.sh [--after SECONDS] [--panels] [--verbose] LAUNCH_FILE PICTURE [NAME:=VALUE...]
#   scripts/screenshot.sh launch/hair.launch docs/hair.png
#   scripts/screenshot.sh launch/tracker_example.launch docs/tracker.png
#     --after SECONDS   default: 2
#     --panels          with rviz's panels, not the scene alone
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
# shellcheck source=scripts/processes.sh
source "$(dirname "${BASH_SOURCE[0]}")/processes.sh"

usage="usage: scripts/screenshot.sh [--after SECONDS] [--panels] [--verbose] LAUNCH_FILE PICTURE [NAME:=VALUE...]"
refuse() {
  echo "screenshot.sh: $1; $usage" >&2
  exit 2
}
rviz_args=--fullscreen
after=2  # rviz may show them before its window fills the screen
while [[ ${1-} == --* ]]; do
  case "$1" in
    --after)
      [[ ${2-} =~ ^[0-9]{1,4}$ ]] || refuse "--after needs a whole number, not '${2-}'"
      after=$2
      shift
      ;;
    --panels) rviz_args= ;;
    --verbose) be_verbose ;;
    *) refuse "unknown option '$1'" ;;
  esac
  shift
done
[ $# -ge 2 ] || refuse "needs a launch file and the name of a picture"
[ -f "$1" ] || refuse "no launch file $1"
launch_file=$(realpath -- "$1")
picture=$(realpath -m -- "$2")
[ -d "$(dirname "$picture")" ] || refuse "no folder $(dirname "$picture")"
shift 2

"$root/scripts/setup.sh"
cmake_arguments=()
build_package fiber_proximity_demo
use_devel_space

start_virtual_display
start_launch_file "$launch_file" rviz_args:="$rviz_args --splash-screen ''" "$@"
wait_for "rviz showed fibres" roslaunch "$launch" picture_shows_fibers
sleep "$after"
picture_shows_fibers || fail "no picture with fibres $after s later" import
mv "$scratch/picture.png" "$picture"
echo "saved $picture"
