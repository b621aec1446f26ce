#!/usr/bin/env bash
# Starts a launch file of this package, which must take rviz_args, in a display of its own, without a
# graphics card, and saves what rviz shows soon after fibres are to be seen there.
#   scripts/screenshot.sh [--after SECONDS] LAUNCH_FILE PICTURE [NAME:=VALUE...]
#   scripts/screenshot.sh launch/hair.launch docs/hair.png
#     --after SECONDS   default: 2
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
# shellcheck source=scripts/processes.sh
source "$(dirname "${BASH_SOURCE[0]}")/processes.sh"

usage="usage: scripts/screenshot.sh [--after SECONDS] LAUNCH_FILE PICTURE [NAME:=VALUE...]"
refuse() {
  echo "screenshot.sh: $1; $usage" >&2
  exit 2
}
after=2  # rviz may show them before its window fills the screen
if [ "${1-}" = --after ]; then
  [[ ${2-} =~ ^[0-9]{1,4}$ ]] || refuse "--after needs a whole number, not '${2-}'"
  after=$2
  shift 2
fi
[ $# -ge 2 ] || refuse "needs a launch file and the name of a picture"
[ -f "$1" ] || refuse "no launch file $1"
launch_file=$(realpath -- "$1")
picture=$(realpath -m -- "$2")
[ -d "$(dirname "$picture")" ] || refuse "no folder $(dirname "$picture")"
shift 2

"$root/scripts/setup.sh"
echo "building in $build ..."
cmake_arguments=()
build_package
use_devel_space

start_virtual_display
start_launch_file "$launch_file" rviz_args:="--fullscreen --splash-screen ''" "$@"
wait_for "rviz showed fibres" roslaunch "$launch" picture_shows_fibers
sleep "$after"
take_picture || fail "no picture" import
mv "$scratch/picture.png" "$picture"
echo "saved $picture"
