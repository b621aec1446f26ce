# Sourced by the other scripts: one place that knows where ROS and the build are.
# Sets `root` and `build`, defines build_package, and readies PATH and ROS's variables.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build

# ROS's Python modules belong to /usr/bin/python3; another python3 may stand first on PATH.
export PATH=/usr/bin:$PATH
if [ -f /opt/ros/noetic/setup.bash ]; then
  set +u
  # shellcheck disable=SC1091
  source /opt/ros/noetic/setup.bash
  set -u
fi

# quietly LOG COMMAND...: runs it, shows its output only if it fails.
quietly() {
  local log=$1
  shift
  if ! "$@" >"$log" 2>&1; then
    cat "$log" >&2
    return 1
  fi
}

# build_package [TARGET...]: configures (arguments in the array cmake_arguments) and builds.
build_package() {
  mkdir -p "$build"
  quietly "$build/configure.log" cmake -S "$root" -B "$build" "${cmake_arguments[@]}"
  local target
  for target in "${@:-all}"; do
    quietly "$build/make.log" cmake --build "$build" --parallel "$(nproc)" --target "$target"
  done
}

# use_devel_space: what `source build/devel/setup.bash` does, under set -u.
use_devel_space() {
  set +u
  # shellcheck disable=SC1091
  source "$build/devel/setup.bash"
  set -u
}
