# Sourced by the other scripts: one place that knows where ROS and the build are.
# Sets `root` and `build`, defines build_package and what progress.sh does, and readies PATH and ROS's
# variables.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# Beside the checkout: rosrun leaves out a folder `build` within a package, and finds programs in any other folder there
# twice. Nor may the path begin as the checkout's does: rosrun takes it for a part of it then.
build=${FIBER_PROXIMITY_BUILD:-$(dirname "$root")/build-$(basename "$root")}

# ROS's Python modules belong to /usr/bin/python3; another python3 may stand first on PATH.
export PATH=/usr/bin:$PATH
# Where NVIDIA's packages put CUDA's compiler, which CMake looks for on PATH.
command -v nvcc >/dev/null || [ ! -x /usr/local/cuda/bin/nvcc ] || PATH+=:/usr/local/cuda/bin
if [ -f /opt/ros/noetic/setup.bash ]; then
  set +u
  # shellcheck disable=SC1091
  source /opt/ros/noetic/setup.bash
  set -u
fi

# shellcheck source=scripts/progress.sh
source "$root/scripts/progress.sh"

make_build_folder() {
  mkdir -p "$build" && return
  echo "$(basename "$0"): FIBER_PROXIMITY_BUILD names another folder to build in" >&2
  return 1
}

# configure_package: with the arguments in the array cmake_arguments.
# A new build is one of Ninja, which starts in no time where make asks hundreds of catkin's targets, and what
# ccache has compiled before it does not compile again.
configure_package() {
  local tools=()
  if [ ! -f "$build/CMakeCache.txt" ]; then
    ! command -v ninja >/dev/null || tools+=(-G Ninja)
    ! command -v ccache >/dev/null || tools+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  # What another checkout has compiled counts, and so do precompiled headers.
  export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=true CCACHE_SLOPPINESS=pch_defines,time_macros
  make_build_folder
  run_step "configuring $(basename "$build")" "$build/configure.log" \
    cmake -S "$root" -B "$build" "${tools[@]}" "${cmake_arguments[@]}"
}

# build_targets TARGET...: of what has been configured.
build_targets() {
  local what=$*
  [ $# -le 3 ] || what="$# targets"
  run_step "building $what" "$build/make.log" \
    cmake --build "$build" --parallel "$(nproc)" --target "$@"
}

# build_package [TARGET...]: configures and builds.
build_package() {
  configure_package
  build_targets "${@:-all}"
}

# run_tests [ARGUMENT...]: ctest with these, in the build; of what passes only how many.
run_tests() {
  cd "$build"
  run_step "testing $(basename "$build")" ctest.log ctest --output-on-failure "$@"
  cd - >/dev/null
  $verbose || sed -n "/tests passed/,\$p" "$build/ctest.log"
}

# changed_since MARK [FILE...]: the sources that have changed since the commit that the file MARK names; `all` where
# there is no telling, or where one of these files has changed.
changed_since() {
  local mark=$1 base changed
  shift
  base=$(cat "$root/$mark")
  # Work may be taken up again as one commit, without those it was made of: that one is meant then.
  git -C "$root" cat-file -e "$base^{commit}" 2>/dev/null || base=$(git -C "$root" log -1 --format=%H -- "$mark")
  if { [ $# -eq 0 ] || git -C "$root" diff --quiet "$base" -- "$@" 2>/dev/null; } &&
    changed=$("$root/scripts/changed_sources.py" "$base"); then
    echo "$changed"
  else
    echo all
  fi
}

# use_devel_space: what `source devel/setup.bash` in the build does, under set -u.
use_devel_space() {
  set +u
  # shellcheck disable=SC1091
  source "$build/devel/setup.bash"
  set -u
}
