#!/usr/bin/env bash
# Formatting and catkin_lint over the whole tree, clang-tidy over sources and benchmarks; it reads the
# compile commands of build/, which scripts/test.sh makes.
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

"$root/scripts/setup.sh" --lint
cd "$root"
mapfile -t sources < <(git ls-files '*.cpp' '*.hpp')
# Without the tests: the analyser takes minutes for each typed suite.
mapfile -t units < <(git ls-files 'src/*.cpp' 'benchmark/*.cpp' |
  while read -r unit; do
    # Peers that are not installed are not built.
    if grep -qF "$root/$unit" "$build/compile_commands.json"; then
      echo "$unit"
    else
      echo "lint.sh: not in the build: $unit" >&2
    fi
  done)

echo "clang-format: ${#sources[@]} files"
clang-format --dry-run --Werror "${sources[@]}"
echo "catkin_lint"
ROS_PACKAGE_PATH=$root:/usr/share catkin_lint --quiet --strict "$root" 2>&1 |
  { grep -v "rosdep database\|unknown dependencies" || true; }
# clang cannot read what gcc has precompiled: it parses every header itself.
lint=$build/lint
mkdir -p "$lint"
sed -E 's/-Winvalid-pch//; s/-include [^ ]*cmake_pch\.hxx//' "$build/compile_commands.json" \
  >"$lint/compile_commands.json"
echo "clang-tidy: ${#units[@]} files"
printf '%s\n' "${units[@]}" |
  xargs -P "$(nproc)" -n 1 sh -c 'clang-tidy -p "$0" --quiet "$1" 2>/dev/null || { echo "clang-tidy: $1" >&2; exit 255; }' "$lint"
