#!/usr/bin/env bash
# Formatting, doxygen and catkin_lint over the whole tree, clang-tidy over sources, benchmarks and tests; it reads
# the compile commands and the messages' headers in the build that scripts/test.sh makes.
#   scripts/lint.sh [--all] [--verbose]
#     --verbose   what the tools write as it comes
#     --all   clang-tidy over all of them, which takes half an hour; without, over those changed since the
#             commit in .ci/linted, at which all were clean, and over one that reads each changed header
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/lint.sh [--all] [--verbose]"
all=false
for argument in "$@"; do
  case "$argument" in
    --all) all=true ;;
    --verbose) be_verbose ;;
    -h | --help) echo "$usage"; exit 0 ;;
    *) echo "lint.sh: unknown option '$argument'; $usage" >&2; exit 2 ;;
  esac
done

"$root/scripts/setup.sh" --lint
cd "$root"
mapfile -t sources < <(git ls-files '*.cpp' '*.hpp')
# clang cannot read what gcc has precompiled: it parses every header itself, once for all sources that are
# compiled as one, which takes a third of the time. What is included there is no header to the analyser, nor
# is it suspicious.
lint=$build/lint
mkdir -p "$lint"
sed -E 's/-Winvalid-pch//; s/-include [^ ]*cmake_pch\.hxx//' "$build/compile_commands.json" \
  >"$lint/compile_commands.json"
changed=all
$all || changed=$(changed_since .ci/linted .clang-tidy)

echo "clang-format: ${#sources[@]} files"
clang-format --dry-run --Werror "${sources[@]}"
# Every comment that is wrong about its parameters is a warning.
run_step "doxygen" "$lint/doxygen.log" doxygen docs/Doxyfile
echo "catkin_lint"
ROS_PACKAGE_PATH=$root:/usr/share catkin_lint --quiet --strict "$root" 2>&1 |
  { grep -v "rosdep database\|unknown dependencies" || true; }
mapfile -t units < <(scripts/units_to_lint.py "$lint/compile_commands.json" src benchmark test validation <<<"$changed")
# The analyser does not go as deep as it could (mode=shallow): that takes a third of the time, and sanitizers and
# fuzzers run through the same code.
# tidy UNIT...: each numbered for the progress.
tidy() {
  printf '%s\n' "$@" | awk -v count=$# '{ print NR "/" count, $0 }' |
    xargs -P "$(nproc)" -n 2 sh -c '
      clang-tidy -p "$0" --quiet --checks=-bugprone-suspicious-include --extra-arg=-Xclang \
        --extra-arg=-analyzer-opt-analyze-headers --extra-arg=-Xclang --extra-arg=-analyzer-config \
        --extra-arg=-Xclang --extra-arg=mode=shallow "$2" 2>/dev/null || { echo "clang-tidy: $2" >&2; exit 255; }
      echo "[$1] $2"' "$lint"
}
if [ "${#units[@]}" -gt 0 ]; then
  run_step "clang-tidy, ${#units[@]} files" "$lint/tidy.log" tidy "${units[@]}"
fi
