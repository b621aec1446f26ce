#!/usr/bin/env bash
# Builds the libraries that Ubuntu 20.04 has too old or not at all (docs/platforms.md) from their release
# sources, and installs them in the folder `libraries` of this checkout, where CMake finds them. Quick when
# they are there.
#   scripts/bring_libraries.sh [--tarballs FOLDER] [--list FILE] [--prefix FOLDER] [--verbose]
#     --tarballs FOLDER  takes NAME-VERSION.tar.gz from there, on a machine that reaches no network
#     --list FILE        instead of scripts/libraries.txt: names, versions, checksums, addresses
#     --prefix FOLDER    installs there
#     --verbose          all that the tools write
# A tarball whose SHA-256 is not that of the list is refused.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/bring_libraries.sh [--tarballs FOLDER] [--list FILE] [--prefix FOLDER] [--verbose]"
tarballs=
list=$root/scripts/libraries.txt
prefix=$root/libraries
fail() {
  echo "bring_libraries.sh: $*" >&2
  exit 2
}
while [ $# -gt 0 ]; do
  case "$1" in
    --verbose) be_verbose ;;
    -h | --help) echo "$usage"; exit 0 ;;
    --tarballs | --list | --prefix)
      [ $# -ge 2 ] || fail "$1 needs a path; $usage"
      declare "${1#--}=$(realpath -m "$2")"
      shift
      ;;
    *) fail "unknown option '$1'; $usage" ;;
  esac
  shift
done
[ -r "$list" ] || fail "$list: cannot be read"
[ -z "$tarballs" ] || [ -d "$tarballs" ] || fail "$tarballs: no such folder"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# get NAME VERSION ADDRESS: the path of the tarball in `tarball`.
get() {
  if [ -n "$tarballs" ]; then
    tarball=$tarballs/$1-$2.tar.gz
    [ -f "$tarball" ] || fail "$tarball: no such file; it is what $3 has"
  else
    command -v curl >/dev/null || fail "curl is not installed, which fetches $3"
    tarball=$work/$1-$2.tar.gz
    run_step "fetching $1 $2" "$work/log" curl --fail --location --silent --show-error -o "$tarball" "$3" ||
      fail "$3: cannot be fetched; without a network give --tarballs FOLDER with $1-$2.tar.gz"
  fi
}

# install NAME VERSION CHECKSUM ADDRESS OPTION...
install() {
  local name=$1 version=$2 checksum=$3 address=$4 found tarball
  shift 4
  [ "$(cat "$prefix/versions/$name" 2>/dev/null)" != "$version $checksum" ] || return 0
  get "$name" "$version" "$address"
  found=$(sha256sum <"$tarball" | cut -d ' ' -f 1)
  [ "$found" = "$checksum" ] || fail "$tarball: its SHA-256 is $found, that of $name $version is $checksum"
  mkdir "$work/$name"
  tar -xzf "$tarball" -C "$work/$name" --strip-components 1
  # Static, so that nothing has to be found when the programs run.
  run_step "configuring $name $version" "$work/log" cmake -S "$work/$name" -B "$work/$name/build" \
    -DCMAKE_BUILD_TYPE=Release -DBUILD_SHARED_LIBS=OFF -DCMAKE_POSITION_INDEPENDENT_CODE=ON -DBUILD_TESTING=OFF \
    -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib "$@"
  run_step "building $name $version" "$work/log" \
    cmake --build "$work/$name/build" --parallel "$(nproc)" --target install
  mkdir -p "$prefix/versions"
  echo "$version $checksum" >"$prefix/versions/$name"
}

while read -r -a line; do
  [ "${#line[@]}" -eq 0 ] || [[ ${line[0]} == "#"* ]] || install "${line[@]}"
done <"$list"
