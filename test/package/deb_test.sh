#!/usr/bin/env bash
# Makes Debian packages of a build and unpacks them into an empty folder: each file is in one of them, each
# has the files that its name promises, and the tools and the node run from there.
#   deb_test.sh BUILD SOURCE
set -euo pipefail
build=$1
source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "deb_test: $*" >&2
  exit 1
}

"$source/scripts/package.sh" --build "$build" --out "$work/packages"
version=$(sed -n 's/.*<version>\(.*\)<.*/\1/p' "$source/package.xml")
names=(libfiber-proximity libfiber-proximity-dev ros-fiber-proximity)
has_cluster=false
has_gpu=false
[ ! -e "$build/devel/lib/libfiber_proximity_mpi.so" ] || has_cluster=true
[ -z "$(find "$build/devel/lib" -name 'libfiber_proximity_cuda_device.so.*')" ] || has_gpu=true
! $has_cluster || names+=(libfiber-proximity-mpi libfiber-proximity-mpi-dev)
! $has_gpu || names+=(libfiber-proximity-cuda)
[ "$(find "$work/packages" -name '*.deb' | wc -l)" -eq "${#names[@]}" ] || fail "other packages: $(ls "$work/packages")"
for name in "${names[@]}"; do
  package=$(echo "$work"/packages/"${name}"_*.deb)
  [ "$(dpkg-deb -f "$package" Version)" = "$version-1" ] || fail "$name has another version than package.xml"
  dpkg-deb -f "$package" Depends >"$work/$name.depends"
  dpkg-deb -c "$package" | awk '!/^d/ { print $6 }' | sort >"$work/$name.files"
  dpkg-deb -x "$package" "$work/root"
done
[ -z "$(sort "$work"/*.files | uniq -d)" ] || fail "in two packages: $(sort "$work"/*.files | uniq -d)"

expect() {
  grep -q "$2" "$work/$1" || fail "$1 lacks $2"
}
expect libfiber-proximity.files '/usr/lib/libfiber_proximity.so.[0-9.]*$'
expect libfiber-proximity.files '/usr/bin/fiber_query$'
expect libfiber-proximity.depends libtbb
expect libfiber-proximity-dev.files '/query/engine.hpp$'
expect libfiber-proximity-dev.files '/usr/lib/libfiber_proximity.so$'
expect libfiber-proximity-dev.files '/fiber_proximity-core.cmake$'
expect libfiber-proximity-dev.depends '^libfiber-proximity (= '
# catkin's configuration looks for the library of ROS and for the packages whose messages it knows.
expect libfiber-proximity-dev.depends ' ros-fiber-proximity (= '
expect libfiber-proximity-dev.depends ' libroscpp-dev'
expect libfiber-proximity-dev.depends ' libsensor-msgs-dev'
expect ros-fiber-proximity.files '/lib/fiber_proximity/proximity_node$'
expect ros-fiber-proximity.files '/share/fiber_proximity/launch/demo.launch$'
expect ros-fiber-proximity.files '/dist-packages/fiber_proximity/msg/_Contact.py$'
expect ros-fiber-proximity.files '/share/fiber_proximity/msg/Contact.msg$'
expect ros-fiber-proximity.depends 'libfiber-proximity (= '
expect ros-fiber-proximity.depends libroscpp
expect ros-fiber-proximity.depends rviz
if grep -qE 'libros|rviz|librviz' "$work/libfiber-proximity.depends"; then
  fail "the library needs ROS: $(cat "$work/libfiber-proximity.depends")"
fi
# What is for clusters is apart, and nobody else needs MPI.
if $has_cluster; then
  expect libfiber-proximity-mpi.files '/usr/lib/libfiber_proximity_mpi.so.[0-9.]*$'
  expect libfiber-proximity-mpi.files '/usr/bin/fiber_query_mpi$'
  expect libfiber-proximity-mpi.files '/usr/bin/fiber_scene_mpi$'
  expect libfiber-proximity-mpi.depends '^libfiber-proximity (= '
  expect libfiber-proximity-mpi.depends libopenmpi
  expect libfiber-proximity-mpi.depends libhdf5-openmpi
  expect libfiber-proximity-mpi.depends libtrilinos-zoltan
  expect libfiber-proximity-mpi.depends openmpi-bin
  expect libfiber-proximity-mpi-dev.files '/mpi/distributed_engine.hpp$'
  expect libfiber-proximity-mpi-dev.files '/usr/lib/libfiber_proximity_mpi.so$'
  expect libfiber-proximity-mpi-dev.files '/fiber_proximity-mpi.cmake$'
  expect libfiber-proximity-mpi-dev.depends '^libfiber-proximity-mpi (= '
  expect libfiber-proximity-mpi-dev.depends ' libopenmpi-dev'
fi
for name in libfiber-proximity libfiber-proximity-dev ros-fiber-proximity; do
  ! grep -qE 'openmpi|mpich' "$work/$name.depends" || fail "$name needs MPI: $(cat "$work/$name.depends")"
  ! grep -q '[-_/]mpi' "$work/$name.files" || fail "$name has what is for clusters: $(grep '[-_/]mpi' "$work/$name.files")"
done

# What is for GPUs is apart, and nothing that is not needs CUDA's libraries.
if $has_gpu; then
  expect libfiber-proximity-cuda.files '^./usr/lib/libfiber_proximity_cuda_device.so.[0-9.]*$'
  expect libfiber-proximity-cuda.depends '^libfiber-proximity (= '
fi
! grep -q 'cuda_device' "$work/libfiber-proximity.files" || fail "libfiber-proximity has what is for GPUs"

# From there alone: what is loaded is what was unpacked.
unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH PYTHONPATH
export LD_LIBRARY_PATH=$work/root/usr/lib
printf 'fiber,x,y,z\na,0,0,0\na,1,0,0\nb,0,1,0\nb,1,1,0\n' >"$work/two.csv"
"$work/root/usr/bin/fiber_query" contacts "$work/two.csv" --radius 0.1 --margin 1 >"$work/contacts.csv"
[ "$(wc -l <"$work/contacts.csv")" -eq 2 ] || fail "fiber_query finds not one contact: $(cat "$work/contacts.csv")"
if $has_gpu && ! [ -e /dev/nvidia0 ]; then
  engine=("$work/root/usr/bin/fiber_query" contacts "$work/two.csv" --radius 0.1 --margin 1 --engine cuda_tree)
  ! "${engine[@]}" >"$work/gpu.csv" 2>"$work/gpu.error" || fail "cuda_tree answers without a GPU"
  grep -q 'needs an NVIDIA GPU' "$work/gpu.error" || fail "the module is not loaded: $(cat "$work/gpu.error")"
  rm "$work"/root/usr/lib/libfiber_proximity_cuda_device.so.*
  ! "${engine[@]}" >"$work/gpu.csv" 2>"$work/gpu.error" || fail "cuda_tree answers without its module"
  grep -q 'package libfiber-proximity-cuda' "$work/gpu.error" || fail "no package is named: $(cat "$work/gpu.error")"
fi
linked=$(ldd "$work/root/usr/lib/fiber_proximity/proximity_node")
[[ $linked == *"$work/root/usr/lib/libfiber_proximity_ros.so"* ]] || fail "the node loads another library: $linked"
[[ $linked != *"not found"* ]] || fail "the node lacks a library: $linked"
