#!/usr/bin/env bash
# Installs what building, testing and the demo need, and is quick when nothing is missing.
#   scripts/setup.sh [--lint] [--bench] [--fuzz] [--sanitize] [--mpi] [--cuda] [--tarballs FOLDER] [--verbose]
#     --lint    also what scripts/lint.sh needs
#     --bench   also the libraries fiber_bench compares with (benchmark/README.md), on Debian, and
#               what draws its plots
#     --fuzz    also what scripts/fuzz.sh needs, on Debian: clang 13, the oldest there is, so that the
#               sources are known to build with it
#     --sanitize  also what scripts/sanitize.sh needs, on Debian: g++ 11, for the same reason
#     --mpi     also what the library for clusters needs, on Debian: Open MPI, Zoltan, parallel
#               HDF5
#     --cuda    look for CUDA's compiler, which the engine of GPUs is built with, and say where to get it
#     --verbose all that installing writes
# Debian 12: ROS 1 from Debian's own packages, with apt, as root or through sudo; Ubuntu 22.04 (never tried) alike.
# Ubuntu with ROS Noetic: through rosdep.
set -euo pipefail
cd "$(dirname "$0")/.."
# shellcheck source=scripts/progress.sh
source scripts/progress.sh

usage="usage: scripts/setup.sh [--lint] [--bench] [--fuzz] [--sanitize] [--mpi] [--cuda] [--tarballs FOLDER] [--verbose]"
lint=false
bench=false
fuzz=false
sanitize=false
mpi=false
cuda=false
bring=()
while [ $# -gt 0 ]; do
  case "$1" in
    --lint) lint=true ;;
    --bench) bench=true ;;
    --fuzz) fuzz=true ;;
    --sanitize) sanitize=true ;;
    --mpi) mpi=true ;;
    --cuda) cuda=true ;;
    --tarballs)
      [ $# -ge 2 ] || { echo "setup.sh: --tarballs needs a folder; $usage" >&2; exit 2; }
      bring=(--tarballs "$2")
      shift
      ;;
    --verbose) be_verbose ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "setup.sh: unknown option '$1'; $usage" >&2; exit 2 ;;
  esac
  shift
done

if $cuda; then
  get="install NVIDIA's cuda-toolkit, 11.4 or newer, or Debian's nvidia-cuda-toolkit (non-free)"
  nvcc=$(command -v nvcc || ls /usr/local/cuda/bin/nvcc 2>/dev/null || true)
  if [ -z "$nvcc" ]; then
    echo "setup.sh: CUDA's compiler nvcc is neither on PATH nor in /usr/local/cuda/bin: $get" >&2
    exit 1
  fi
  version=$("$nvcc" --version | sed -n 's/.*release \([0-9.]*\).*/\1/p')
  if [ "$(printf '%s\n' 11.4 "$version" | sort -V | head -1)" != 11.4 ]; then
    echo "setup.sh: CUDA's compiler $nvcc is of ${version:-an unknown version}: $get" >&2
    exit 1
  fi
fi

# Message definitions (ros-*) and Python modules come beside the headers: Debian only recommends them.
packages=(
  build-essential cmake ninja-build ccache catkin ros-message-generation libroscpp-dev rosbash
  libnodelet-dev libnodeletlib-dev libnodeletlib-tools pluginlib-dev
  libtf2-ros-dev libtf2-geometry-msgs-dev tf2-tools
  libdynamic-reconfigure-config-init-mutex-dev python3-dynamic-reconfigure libdiagnostic-updater-dev
  libinteractive-markers-dev
  libnav-msgs-dev libsensor-msgs-dev libvisualization-msgs-dev libros-rosgraph-msgs-dev libstd-srvs-dev
  libshape-msgs-dev liburdf-dev libroslib-dev ros-robot-state-publisher python3-{numpy,yaml}
  python3-{matplotlib,scipy}
  ros-{std,geometry,sensor,shape,nav,visualization,diagnostic,tf2}-msgs ros-{rosgraph-msgs,std-srvs}
  python3-{std,geometry,sensor,shape,nav,visualization,diagnostic,tf2,rosgraph}-msgs python3-std-srvs
  librostest-dev python3-rostest python3-roslaunch python3-rostopic python3-rosservice
  python3-rosnode python3-rosparam python3-rosmsg python3-rosbag
  rviz librviz-dev qtbase5-dev xvfb xauth imagemagick x11-utils xdotool libgl1-mesa-dri
  libeigen3-dev libtbb-dev libhwy-dev libfcl-dev libassimp-dev libtinyxml2-dev zlib1g-dev
  pybind11-dev python3-dev python3-pip python3-setuptools python3-venv python3-wheel
  libcli11-dev nlohmann-json3-dev libyaml-cpp-dev libboost-dev libgmp-dev libgtest-dev
)
if $lint; then
  packages+=(catkin-lint clang-format clang-tidy doxygen)
fi
if $bench; then
  packages+=(libembree-dev libcgal-dev libbullet-dev libmujoco-dev)
  packages+=(python3-tqdm python3-dartpy)
fi
if $fuzz; then
  packages+=(clang-13 libclang-common-13-dev)
fi

if $sanitize; then
  packages+=(g++-11)
fi
if $mpi; then
  packages+=(libopenmpi-dev openmpi-bin libtrilinos-zoltan-dev libhdf5-openmpi-dev)
fi

missing_packages() {
  # dpkg-query reports packages it never heard of on stderr and leaves them out.
  comm -23 <(printf '%s\n' "${packages[@]}" | sort -u) \
    <(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null |
      sed -n 's/^installed //p' | sort -u)
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    echo "setup.sh: need root or sudo to run: $*" >&2
    exit 1
  fi
}

# Before progress is shown, which would cover the question.
ask_for_password() {
  [ "$(id -u)" -eq 0 ] || ! command -v sudo >/dev/null || sudo -v
}

install_with_apt() {
  mapfile -t missing < <(missing_packages)
  if [ "${#missing[@]}" -eq 0 ]; then
    return
  fi
  echo "setup.sh: installing ${#missing[@]} package(s): ${missing[*]}"
  ask_for_password
  log=$(mktemp)
  if ! run_step "asking for packages" "$log" as_root apt-get update ||
    ! run_step "installing packages" "$log" as_root env DEBIAN_FRONTEND=noninteractive LC_ALL=C \
      apt-get install -y --no-install-recommends "${missing[@]}"; then
    echo "setup.sh: apt-get failed" >&2
    exit 1
  fi
  rm -f "$log"
}

install_with_rosdep() {
  # shellcheck disable=SC1091
  source /opt/ros/noetic/setup.bash
  local keys=(--from-paths . --ignore-src)
  rosdep check "${keys[@]}" >/dev/null 2>&1 && return
  log=$(mktemp)
  run_step "asking for packages" "$log" rosdep update
  ask_for_password
  run_step "installing packages" "$log" rosdep install "${keys[@]}" -y
  rm -f "$log"
}

if [ -f /opt/ros/noetic/setup.bash ]; then
  install_with_rosdep
  # Ubuntu 20.04 has three too old or not at all, for which package.xml does not ask rosdep.
  scripts/bring_libraries.sh "${bring[@]}"
elif command -v dpkg-query >/dev/null && command -v apt-get >/dev/null; then
  install_with_apt
  # Ubuntu 22.04 has ROS 1 in its own packages as Debian does, and Highway 0.16.
  if [ "${#bring[@]}" -gt 0 ] || dpkg --compare-versions "$(dpkg-query -W -f '${Version}' libhwy-dev)" lt 1.0.3; then
    scripts/bring_libraries.sh "${bring[@]}"
  fi
else
  echo "setup.sh: neither /opt/ros/noetic nor apt-get here; supported are Debian 12 and Ubuntu with ROS Noetic" >&2
  exit 1
fi
