#!/usr/bin/env bash
# Sets up, builds and shows the demo: simulated cables, their contacts, in rviz.
#   scripts/demo.sh [--cell | --scene NAME] [--continuous] [--headless] [--seconds N] [--screenshot FILE] [--verbose]
#   scripts/demo.sh --scenes
#     --cell             instead an arm that moves a cable about a table, and its distances to both
#     --scene NAME       instead a scene of config/sim, e.g. plug_in, as fast as life
#     --scenes           lists them
#     --continuous       finds contacts that come and go between two messages, too
#     --headless         no window: prints contacts as they come; so it does without a display
#     --seconds N        ends after N seconds; default: with Ctrl-C
#     --screenshot FILE  headless: saves what rviz shows, at the end of the N seconds (default: as
#                        soon as it shows something), and exits 0 only if there was a contact; with --scene
#                        there need be none
#     --verbose          all that installing and building write
# It has a ROS master of its own, beside any other that runs.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"
# shellcheck source=scripts/processes.sh
source "$(dirname "${BASH_SOURCE[0]}")/processes.sh"

usage="usage: scripts/demo.sh [--cell | --scene NAME | --scenes] [--continuous] [--headless] [--seconds N] [--screenshot FILE] [--verbose]"
refuse() {
  echo "demo.sh: $1; $usage" >&2
  exit 2
}

# The names of the scenes, and what their files say of them.
list_scenes() {
  local file
  for file in "$root"/config/sim/*.yaml; do
    printf '%-14s %s\n' "$(basename "$file" .yaml)" "$(sed -n '/^#/!q; s/^# //p' "$file" | tr '\n' ' ')"
  done
}

# take_scene NAME: sets what is launched.
take_scene() {
  local names
  names=$(list_scenes | cut -d ' ' -f 1)
  grep -qx -- "${1:-no name}" <<<"$names" ||
    refuse "--scene needs one of $(tr '\n' ' ' <<<"$names")"
  scene=$1
  launch_file=cable_sim.launch
  launch_arguments+=(scene:="$root/config/sim/$scene.yaml")
  case "$scene" in
    # What is seen of these are contacts with posts and sockets.
    bend_wire | capstan | close_cable | drum | gripper | harness | plug_in | rubber_band)
      launch_arguments+=(environment_contacts:=true)
      contacts=/proximity/environment_contacts
      ;;
    # Those with a robot have launch files of their own.
    hose | arm_harness)
      launch_file=$scene.launch
      launch_arguments=()
      contacts=/proximity/environment_contacts
      ;;
  esac
}

launch_file=demo.launch
launch_arguments=()
scene=
contacts=/proximity/contacts
continuous=false
headless=false
seconds=
screenshot=
while [ $# -gt 0 ]; do
  case "$1" in
    --cell)
      launch_file=cell.launch
      contacts=/proximity/environment_contacts
      ;;
    --scene)
      take_scene "${2-}"
      shift
      ;;
    --scenes) list_scenes; exit 0 ;;
    --continuous) continuous=true ;;
    --headless) headless=true ;;
    --verbose) be_verbose ;;
    --seconds)
      [[ ${2-} =~ ^[0-9]{1,6}$ && $2 -gt 0 ]] ||
        refuse "--seconds needs a whole number from 1, not '${2-}'"
      seconds=$2
      shift
      ;;
    --screenshot)
      [ -n "${2-}" ] || refuse "--screenshot needs a file name"
      screenshot=$(realpath -m -- "$2")
      [ -d "$(dirname "$screenshot")" ] || refuse "no folder $(dirname "$screenshot")"
      headless=true
      shift
      ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) refuse "unknown option '$1'" ;;
  esac
  shift
done
[ -z "$scene" ] || ! $continuous || refuse "--continuous is not for --scene"
if ! $headless && [ -z "${DISPLAY-}" ]; then
  echo "demo.sh: there is no display (DISPLAY is not set): printing contacts instead"
  headless=true
fi

"$root/scripts/setup.sh"
cmake_arguments=()
build_package fiber_proximity_demo
use_devel_space

if [ -n "$screenshot" ]; then
  start_virtual_display
  launch_arguments+=(rviz:=true rviz_args:=--fullscreen)
elif $headless; then
  launch_arguments+=(rviz:=false)
else
  launch_arguments+=(rviz:=true)
fi
if $continuous; then
  launch_arguments+=(continuous:=true)
fi
start_launch_file "$root/launch/$launch_file" "${launch_arguments[@]}"
"$root/scripts/print_contacts.py" "$contacts" &
printer=$!
processes+=("$printer")

start=$SECONDS
if [ -n "$screenshot" ]; then
  wait_for "rviz showed the fibres" roslaunch "$launch" picture_shows_fibers
fi
until [ -n "$seconds$screenshot" ] && [ $((SECONDS - start)) -ge "${seconds:-0}" ]; do
  if ! kill -0 "$launch" 2>/dev/null; then
    $headless && fail "the demo ended by itself" roslaunch
    exit 0  # rviz was closed
  fi
  sleep 0.2
done
if [ -n "$screenshot" ]; then
  take_picture || fail "no picture" import
fi

kill -TERM "$printer" 2>/dev/null || true
wait "$printer" || [ -n "$scene" ] || fail "no contacts arrived" roslaunch
if [ -n "$screenshot" ]; then
  mv "$scratch/picture.png" "$screenshot"
  echo "saved $screenshot"
fi
