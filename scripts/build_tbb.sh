#!/usr/bin/env bash
# Builds the TBB installed here again, from Debian's source of the same version, with
# ThreadSanitizer. It knows only the synchronisation it sees compiled: of the packaged library it
# sees none, and takes each hand-over of work from thread to thread for a race.
#   scripts/build_tbb.sh FOLDER     installs in FOLDER/install; quick when it is there already
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

if [ $# -ne 1 ]; then
  echo "usage: scripts/build_tbb.sh FOLDER" >&2
  exit 2
fi
mkdir -p "$1"
cd "$1"
version=$(dpkg-query -W -f '${source:Package}=${source:Version}' libtbb12)
if [ "$(cat version 2>/dev/null)" = "$version" ]; then
  exit
fi
rm -rf version apt source build install

# Asks the machine's own mirrors for sources, which few machines are set up to do, in lists apart
# from the machine's.
mkdir -p apt/parts apt/lists/partial apt/cache source
for list in /etc/apt/sources.list /etc/apt/sources.list.d/*.{list,sources}; do
  [ ! -e "$list" ] || sed -e 's/^deb /deb-src /' -e 's/^Types:.*/Types: deb-src/' "$list" \
    >"apt/parts/$(basename "$list")"
done
apt_options=(-o Dir::Etc::sourcelist=/dev/null -o Dir::Etc::sourceparts="$PWD/apt/parts"
  -o Dir::State::lists="$PWD/apt/lists" -o Dir::Cache="$PWD/apt/cache")
run_step "asking for the source of TBB" update.log apt-get "${apt_options[@]}" update
(cd source && run_step "fetching the source of TBB" ../source.log apt-get "${apt_options[@]}" source "$version")

cmake_arguments=(-DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO=-O1\ -g1
  -DTBB_SANITIZE=thread -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF
  -DCMAKE_INSTALL_PREFIX="$PWD/install" -DCMAKE_INSTALL_LIBDIR=lib)
run_step "configuring TBB" configure.log cmake -S source/*/ -B build "${cmake_arguments[@]}"
run_step "building TBB" make.log make -C build -j"$(nproc)" install
echo "$version" >version
