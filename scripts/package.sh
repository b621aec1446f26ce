#!/usr/bin/env bash
# Makes Debian packages of this tree: what a robot needs to run it, in seconds instead of a build.
#   scripts/package.sh [--out DIR] [--verbose]
#     --out DIR   where they go (default: build-package/packages)
#     --verbose   all that installing and building write
# Three of them, for the release and the processor they are made on:
#   libfiber-proximity      the libraries: nothing of ROS but what messages need
#   ros-fiber-proximity     nodes, nodelets, messages, launch files, the display of rviz, command line tools
#   libfiber-proximity-dev  headers, and what find_package and catkin read
# Install them with: apt install DIR/*.deb
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/package.sh [--out DIR] [--verbose]"
build=$root/build-package
out=$build/packages
while [ $# -gt 0 ]; do
  case "$1" in
    --out)
      [ -n "${2-}" ] || { echo "package.sh: --out needs a folder; $usage" >&2; exit 2; }
      out=$(realpath -m -- "$2")
      shift
      ;;
    --verbose) be_verbose ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "package.sh: unknown argument '$1'; $usage" >&2; exit 2 ;;
  esac
  shift
done

"$root/scripts/setup.sh"
# A package of the system leaves out what is for a catkin workspace: setup.sh and the like.
cmake_arguments=(-DCMAKE_INSTALL_PREFIX=/usr -DCATKIN_BUILD_BINARY_PACKAGE=ON -DCATKIN_ENABLE_TESTING=OFF
  -DFIBER_PROXIMITY_BUILD_BENCHMARKS=OFF)
build_package

work=$build/debian-packages
rm -rf "$work"
mkdir -p "$work/all" "$work/debian" "$out"
DESTDIR=$work/all run_step installing "$build/install.log" cmake --install "$build" --strip

version=$(sed -n 's,.*<version>\(.*\)</version>.*,\1,p' "$root/package.xml")
maintainer=$(sed -n 's,.*<maintainer email="\(.*\)">\(.*\)</maintainer>.*,\2 <\1>,p' "$root/package.xml")
architecture=$(dpkg --print-architecture)
packages=(libfiber-proximity ros-fiber-proximity libfiber-proximity-dev)

# move PACKAGE: what find's expression on standard input names goes there.
move() {
  local file
  while read -r file; do
    mkdir -p "$work/$1/$(dirname "$file")"
    mv "$work/all/$file" "$work/$1/$file"
  done
}

cd "$work/all"
find usr/include usr -type f \( -path 'usr/include/*' -o -name '*.cmake' -o -name '*.pc' -o -name '*.a' \) | sort -u |
  move libfiber-proximity-dev
find usr -name 'libfiber_proximity*.so*' ! -name '*_ros.so*' ! -name '*_nodelets.so*' ! -name '*_rviz.so*' |
  move libfiber-proximity
find usr -type f | move ros-fiber-proximity
cd "$root"

# libraries_of PACKAGE: the packages that its programs and libraries link, but for this tree's own.
libraries_of() {
  local files
  mapfile -t files < <(find "$work/$1" -type f -exec sh -c 'head -c 4 "$1" | grep -q ELF' - {} \; -print)
  [ "${#files[@]}" -gt 0 ] || return 0
  (cd "$work" && dpkg-shlibdeps -O --ignore-missing-info -l"$work/libfiber-proximity/usr/lib" \
    -l"$work/ros-fiber-proximity/usr/lib" "${files[@]}" 2>"$work/$1.shlibdeps.log" |
    sed -n 's/^shlibs:Depends=//p')
}
printf 'Source: fiber-proximity\n\nPackage: libfiber-proximity\nArchitecture: any\n' >"$work/debian/control"

depends_of() {
  case "$1" in
    libfiber-proximity) libraries_of "$1" ;;
    ros-fiber-proximity)
      # What launch files and scripts start, beside what programs link.
      printf '%s, ' "libfiber-proximity (= $version)" "$(libraries_of "$1")" rosbash python3-roslaunch \
        python3-rospy python3-numpy ros-robot-state-publisher libnodeletlib-tools rviz
      printf 'python3-%s-msgs, ' std geometry sensor shape nav visualization diagnostic tf2
      echo python3-std-srvs
      ;;
    libfiber-proximity-dev)
      echo "libfiber-proximity (= $version), ros-fiber-proximity (= $version), libeigen3-dev"
      ;;
  esac
}
describe() {
  case "$1" in
    libfiber-proximity) echo "proximity of cables, ropes, hair and fibres: libraries" ;;
    ros-fiber-proximity) echo "proximity of cables, ropes, hair and fibres: ROS nodes and tools" ;;
    libfiber-proximity-dev) echo "proximity of cables, ropes, hair and fibres: headers" ;;
  esac
}

for package in "${packages[@]}"; do
  mkdir -p "$work/$package/DEBIAN" "$work/$package/usr/share/doc/$package"
  cp "$root/LICENSE" "$work/$package/usr/share/doc/$package/copyright"
  depends=$(depends_of "$package")
  cat >"$work/$package/DEBIAN/control" <<CONTROL
Package: $package
Version: $version
Architecture: $architecture
Maintainer: $maintainer
Section: science
Priority: optional
Depends: $depends
Description: $(describe "$package")
 Contacts, distances and markers from tracked point chains, over chain-aligned
 bounding volume hierarchies that are refitted with every message.
CONTROL
  dpkg-deb --root-owner-group --build "$work/$package" "$out" >/dev/null
done
ls -sh "$out"
