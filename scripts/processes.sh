# Sourced, after environment.sh, by scripts that start rviz and others and end them again: a folder
# `scratch`, the list `processes` of what to end, and functions to start, to wait and to take pictures.

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
  end_progress
  echo "$(basename "$0"): $1" >&2
  [ ! -f "$scratch/$2.log" ] || tail -n 30 "$scratch/$2.log" >&2
  exit 1
}

# wait_for TEXT LOG PROCESS COMMAND...: until it succeeds, for a minute while the process lives.
wait_for() {
  local what=$1 log=$2 process=$3 attempt start=$SECONDS
  shift 3
  for ((attempt = 0; attempt < 300; ++attempt)); do
    if "$@"; then
      end_progress
      return
    fi
    kill -0 "$process" 2>/dev/null || fail "ended before $what" "$log"
    say_progress starting "" $((SECONDS - start))
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

# A ROS master of its own, beside any other that runs: sets `port`.
choose_master() {
  export ROS_IP=127.0.0.1 ROS_LOG_DIR=$scratch/ros
  unset ROS_HOSTNAME
  port=$(/usr/bin/python3 -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI=http://127.0.0.1:$port
}

start_master() {
  choose_master
  roscore -p "$port" >"$scratch/roscore.log" 2>&1 &
  processes+=($!)
  wait_for "the ROS master was up" roscore $! master_is_up
}

# start_launch_file FILE [ARGUMENT...]: with its master; sets `launch`.
start_launch_file() {
  choose_master
  roslaunch -p "$port" "$@" >"$scratch/roslaunch.log" 2>&1 &
  launch=$!
  processes+=("$launch")
  wait_for "the ROS master was up" roslaunch "$launch" master_is_up
}
