#!/usr/bin/env bash
# Formatting and catkin_lint over the whole tree, clang-tidy over sources and benchmarks; it reads the
# compile commands of build/, which scripts/test.sh makes.
#   scripts/lint.sh [--all]
#     --all   clang-tidy over all of them, which takes half an hour; without, over those that read a file
#             changed since the commit in .ci/linted, at which all were clean
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/lint.sh [--all]"
all=false
for argument in "$@"; do
  case "$argument" in
    --all) all=true ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "lint.sh: unknown option '$argument'; $usage" >&2; exit 2 ;;
  esac
done

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

# changed_units: those of `units` that read a changed file, by the dependencies the build wrote down (make
# does, ninja does not); all where there is no telling.
changed_units() {
  local base changed
  base=$(cat .ci/linted)
  if ! changed=$(git diff --name-only "$base" -- '*.cpp' '*.hpp' '*.inc' .clang-tidy 2>/dev/null) ||
    grep -qxF .clang-tidy <<<"$changed" ||
    [ -z "$(find "$build/CMakeFiles" -name '*.cpp.o.d' -print -quit)" ]; then
    printf '%s\n' "${units[@]}"
  elif [ -n "$changed" ]; then
    find "$build/CMakeFiles" -name '*.cpp.o.d' -print0 |
      xargs -0 grep -lFf <(sed "s|^|$root/|" <<<"$changed") |
      sed -e 's|.*\.dir/||' -e 's|\.o\.d$||' | sort -u |
      grep -xFf <(printf '%s\n' "${units[@]}") || true
  fi
}

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
if ! $all; then
  mapfile -t units < <(changed_units)
fi
echo "clang-tidy: ${#units[@]} files"
printf '%s\n' "${units[@]}" |
  xargs -r -P "$(nproc)" -n 1 sh -c 'clang-tidy -p "$0" --quiet "$1" 2>/dev/null || { echo "clang-tidy: $1" >&2; exit 255; }' "$lint"
