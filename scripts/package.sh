#!/usr/bin/env bash
# Makes Debian packages for the machine's own distribution, with dpkg's tools:
#   libfiber-proximity       the libraries that need no ROS, and the command-line tools
#   libfiber-proximity-dev   headers, and what find_package and pkg-config read: catkin's, so it needs the next, too
#   ros-fiber-proximity      nodes, messages, launch files and rviz's displays
# of a build with CUDA's compiler:
#   libfiber-proximity-cuda  what runs on GPUs, which the libraries load where it is installed
# and of a build with the library for clusters:
#   libfiber-proximity-mpi      this library, and its tools
#   libfiber-proximity-mpi-dev  headers, and what find_package reads of its component
#   scripts/package.sh [--build BUILD] [--out DIR] [--verbose]
#     --build BUILD  packages this build, which has ROS, as it is; without, builds first, where all scripts do
#     --out DIR      where to; without, packages in the build's folder
#     --verbose      all that building and packaging write
# Install them with `apt-get install ./DIR/*.deb`, which brings what they need.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/package.sh [--build BUILD] [--out DIR] [--verbose]"
out=
builds=true
while [ $# -gt 0 ]; do
  case "$1" in
    --build | --out)
      [ $# -ge 2 ] || { echo "package.sh: $1 needs a folder; $usage" >&2; exit 2; }
      if [ "$1" = --out ]; then
        out=$2
      else
        build=$2
        builds=false
      fi
      shift
      ;;
    --verbose) be_verbose ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "package.sh: unknown option '$1'; $usage" >&2; exit 2 ;;
  esac
  shift
done
out=${out:-$build/packages}

if $builds; then
  "$root/scripts/setup.sh"
fi
if [ -d /opt/ros ] || ! command -v dpkg-deb >/dev/null || ! command -v dpkg-shlibdeps >/dev/null; then
  echo "package.sh: makes packages for Debian with ROS from Debian's own packages (dpkg-dev)" >&2
  exit 1
fi
if $builds; then
  cmake_arguments+=(-UCMAKE_CUDA_ARCHITECTURES)  # code for all GPUs, where tests were content with one kind
  build_package all
fi
if [ ! -d "$build/catkin_generated" ]; then
  echo "package.sh: '$build' is no build with ROS" >&2
  exit 1
fi

version=$(sed -n 's/.*<version>\(.*\)<.*/\1/p' "$root/package.xml")-1
abi=${version%.*}  # major and minor, by which programs load the libraries
architecture=$(dpkg --print-architecture)
maintainer=$(sed -n 's/.*<maintainer email="\(.*\)">\(.*\)<.*/\2 <\1>/p' "$root/package.xml")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
whole=$work/whole
library=$work/libfiber-proximity
development=$work/libfiber-proximity-dev
gpu=$work/libfiber-proximity-cuda
cluster=$work/libfiber-proximity-mpi
cluster_development=$work/libfiber-proximity-mpi-dev
ros=$work/ros-fiber-proximity

install_whole() {
  cmake --install "$build" --prefix "$whole/usr" --strip
  # How to use a workspace; the system's own folders need no such thing.
  rm -f "$whole"/usr/{.catkin,.rosinstall,_setup_util.py,env.sh,{,local_}setup.{bash,sh,zsh}}
  # pkg-config is told where the files will be.
  sed -i 's#^prefix=.*#prefix=/usr#' "$whole"/usr/lib/pkgconfig/*.pc
  find "$whole" -name __pycache__ -prune -exec rm -rf {} +
}

# take PACKAGE PATH...: moves these from the whole to a package; each must be there.
take() {
  local to=$1 path
  shift
  for path in "$@"; do
    [ -e "$whole/usr/$path" ] || { echo "package.sh: '$path' is not in the build" >&2; return 1; }
    mkdir -p "$to/usr/$(dirname "$path")"
    mv "$whole/usr/$path" "$to/usr/$path"
  done
}

# take_tools PACKAGE TOOL...: moves these, and links them from where a shell finds them.
take_tools() {
  local to=$1 name
  shift
  take "$to" "${@/#/lib/fiber_proximity/}"
  mkdir -p "$to/usr/bin"
  for name in "$@"; do
    ln -s "../lib/fiber_proximity/$name" "$to/usr/bin/$name"
  done
}

has_gpu() { [ -e "$whole/usr/lib/libfiber_proximity_cuda_device.so.$abi" ] || [ -e "$gpu" ]; }
has_cluster() { [ -e "$whole/usr/lib/libfiber_proximity_mpi.so" ] || [ -e "$cluster" ]; }

sort_out() {
  cd "$whole/usr"
  if has_cluster; then
    take_tools "$cluster" fiber_{query,scene}_mpi
    [ ! -e lib/fiber_proximity/fiber_bench_mpi ] || take "$cluster" lib/fiber_proximity/fiber_{bench,forecast}_mpi
    # Programs are built by the link, and run by what it names.
    take "$cluster_development" lib/libfiber_proximity_mpi.so include/fiber_proximity/mpi \
      share/fiber_proximity/cmake/fiber_proximity-mpi*.cmake
    take "$cluster" lib/libfiber_proximity_mpi.so.*
  fi
  ! has_gpu || take "$gpu" "lib/libfiber_proximity_cuda_device.so.$abi"
  local libraries=(lib/libfiber_proximity{,_compare,_cuda,_environment,_paper,_scenes,_sim}.so)
  take "$development" "${libraries[@]}" include lib/pkgconfig share/fiber_proximity/cmake
  take "$library" "${libraries[@]/%/.$abi}"
  take_tools "$library" fiber_{query,scene,simulate}
  # What is left is of ROS: catkin's and rosbag's own names for it.
  take "$ros" ./*
  cd - >/dev/null
}

# dependencies PACKAGE: what its programs and libraries load, by the packages that bring it.
dependencies() {
  local files
  mapfile -t files < <(find "$1" -type f -exec sh -c 'head -c 4 "$1" | grep -q ELF' sh {} \; -print)
  mkdir -p "$work/debian"
  printf 'Source: fiber-proximity\n\nPackage: any\nArchitecture: any\n' >"$work/debian/control"
  # Our own libraries belong to no package yet: what needs them says so below.
  (cd "$work" && dpkg-shlibdeps -O --ignore-missing-info -l"$library/usr/lib" -l"$cluster/usr/lib" -l"$ros/usr/lib" \
    "${files[@]}") | sed 's/^shlibs:Depends=//'
}

# pack FOLDER DEPENDS SUMMARY [RECOMMENDS]
pack() {
  local folder=$1 package
  package=$(basename "$1")
  mkdir -p "$folder/DEBIAN" "$folder/usr/share/doc/$package"
  cp "$root/LICENSE" "$folder/usr/share/doc/$package/copyright"
  cat >"$folder/DEBIAN/control" <<EOF
Package: $package
Version: $version
Architecture: $architecture
Maintainer: $maintainer
Section: science
Priority: optional
Depends: $2${4:+
Recommends: $4}
Description: $3
 Contacts, distances and markers from tracked point chains, over chain-aligned
 bounding volume hierarchies.
EOF
  find "$folder" -type d -exec chmod 755 {} +
  dpkg-deb --root-owner-group --build "$folder" "$out/${package}_${version}_$architecture.deb"
}

# What nodes, launch files and tools ask for by name, which no library tells.
ros_needs=(
  libnodeletlib-tools python3-dynamic-reconfigure python3-numpy python3-rosbag python3-roslaunch
  python3-rospy rosbash ros-robot-state-publisher rviz
  python3-{std,geometry,sensor,shape,nav,visualization,diagnostic,rosgraph}-msgs python3-std-srvs
)
# What the exported targets find, and the headers include.
development_needs=(libeigen3-dev libtbb-dev libfcl-dev libassimp-dev libyaml-cpp-dev libhwy-dev)

# catkin_needs CONFIG: the packages with the other configurations that this one of catkin's asks for, with commas
# between them. Fails if it asks for none, or for one that no package here has.
catkin_needs() {
  local patterns
  mapfile -t patterns < <(sed -n 's/^set(depends "\(.*\)")$/\1/p' "$1" | tr ';' '\n' | sed 's#.*#*/&Config.cmake#')
  dpkg -S "${patterns[@]}" | sed 's/:.*//' | sort -u | paste -s -d , | sed 's/,/, /g'
}

comma_joined() {
  local list
  printf -v list ', %s' "$@"
  echo "${list:2}"
}

make_packages() {
  install_whole
  sort_out
  mkdir -p "$out"
  rm -f "$out"/*fiber-proximity*.deb
  local of_library of_ros of_catkin
  of_catkin=$(catkin_needs "$development/usr/share/fiber_proximity/cmake/fiber_proximityConfig.cmake") || return 1
  of_library=$(dependencies "$library") || return 1
  of_ros=$(dependencies "$ros") || return 1
  pack "$library" "$of_library" "proximity queries for cables, ropes, hair and other fibres"
  pack "$development" "libfiber-proximity (= $version), ros-fiber-proximity (= $version), $of_catkin, $(comma_joined \
    "${development_needs[@]}")" "proximity queries for fibres: headers"
  pack "$ros" "libfiber-proximity (= $version), $of_ros, $(comma_joined "${ros_needs[@]}")" \
    "proximity queries for fibres: ROS nodes" "python3-matplotlib, python3-scipy" # of the examples
  if has_gpu; then
    local of_gpu
    of_gpu=$(dependencies "$gpu") || return 1
    pack "$gpu" "libfiber-proximity (= $version), $of_gpu" "proximity queries for fibres on GPUs"
  fi
  has_cluster || return 0
  local of_cluster
  of_cluster=$(dependencies "$cluster") || return 1
  # mpirun starts the tools.
  pack "$cluster" "libfiber-proximity (= $version), $of_cluster, openmpi-bin" "proximity queries for fibres on a cluster"
  pack "$cluster_development" "libfiber-proximity-mpi (= $version), libfiber-proximity-dev (= $version), libopenmpi-dev" \
    "proximity queries for fibres on a cluster: headers"
}

run_step "packaging $version" "$work/package.log" make_packages
ls "$out"/*fiber-proximity*.deb
