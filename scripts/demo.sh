#!/usr/bin/env bash
# Sets up, builds and shows the demo: swaying cables, their contacts, in rviz.
#   scripts/demo.sh [--headless] [--seconds N] [--screenshot FILE]
#     --headless         no window: prints contacts as they come; so it does without a display
#     --seconds N        ends after N seconds; default: with Ctrl-C
#     --screenshot FILE  headless: saves what rviz shows, at the end of the N seconds (default: as
#                        soon as it shows something), and exits 0 only if there was a contact
# It has a ROS master of its own, beside any other that runs.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/demo.sh [--headless] [--seconds N] [--screenshot FILE]"
refuse() {
  echo "demo.sh: $1; $usage" >&2
  exit 2
}

headless=false
seconds=
screenshot=
while [ $# -gt 0 ]; do
  case "$1" in
    --headless) headless=true ;;
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
if ! $headless && [ -z "${DISPLAY-}" ]; then
  echo "demo.sh: there is no display (DISPLAY is not set): printing contacts instead"
  headless=true
fi

"$root/scripts/setup.sh"
echo "building in $build ..."
cmake_arguments=()
build_package
use_devel_space

scratch=$(mktemp -d)
processes=()  # in the order of their start
# shellcheck disable=SC2317  # called by the trap
clean_up() {
  trap '' INT TERM
  local i
  for ((i = ${#processes[@]} - 1; i >= 0; --i)); do
    kill -TERM "${processes[i]}" 2>/dev/null || true
    wait "${processes[i]}" 2>/dev/null || true
  done
  rm -rf "$scratch"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM

fail() {
  echo "demo.sh: $1" >&2
  [ ! -f "$scratch/$2.log" ] || tail -n 30 "$scratch/$2.log" >&2
  exit 1
}

# wait_for TEXT LOG PROCESS COMMAND...: until it succeeds, for a minute while the process lives.
wait_for() {
  local what=$1 log=$2 process=$3 attempt
  shift 3
  for ((attempt = 0; attempt < 300; ++attempt)); do
    if "$@"; then
      return
    fi
    kill -0 "$process" 2>/dev/null || fail "ended before $what" "$log"
    sleep 0.2
  done
  fail "waited a minute in vain until $what" "$log"
}

start_virtual_display() {
  Xvfb -displayfd 6 -screen 0 1280x800x24 -nolisten tcp 6>"$scratch/display" \
    >"$scratch/xvfb.log" 2>&1 &
  processes+=($!)
  wait_for "the virtual display was there" xvfb $! test -s "$scratch/display"
  DISPLAY=:$(cat "$scratch/display")
  export DISPLAY LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1
}

take_picture() {
  import -window root "$scratch/picture.png" 2>>"$scratch/import.log"
}

master_is_up() {
  rosparam get /run_id >/dev/null 2>&1
}

# An empty scene has a few dozen colours, shaded tubes have hundreds.
picture_shows_fibers() {
  take_picture && [ "$(identify -format %k "$scratch/picture.png")" -gt 400 ]
}

export ROS_IP=127.0.0.1 ROS_LOG_DIR=$scratch/ros
unset ROS_HOSTNAME
port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
export ROS_MASTER_URI=http://127.0.0.1:$port

launch_arguments=(rviz:=true)
if [ -n "$screenshot" ]; then
  start_virtual_display
  launch_arguments+=(rviz_args:=--fullscreen)
elif $headless; then
  launch_arguments=(rviz:=false)
fi
roslaunch -p "$port" "$root/launch/demo.launch" "${launch_arguments[@]}" \
  >"$scratch/roslaunch.log" 2>&1 &
launch=$!
processes+=("$launch")
wait_for "the ROS master was up" roslaunch "$launch" master_is_up
"$root/scripts/print_contacts.py" &
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
wait "$printer" || fail "no contacts arrived" roslaunch
if [ -n "$screenshot" ]; then
  mv "$scratch/picture.png" "$screenshot"
  echo "saved $screenshot"
fi
