#!/usr/bin/env bash
# Formats all C++ sources in place, as scripts/lint.sh wants them.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh --lint
mapfile -t sources < <(git ls-files --cached --others --exclude-standard '*.cpp' '*.hpp')
clang-format -i "${sources[@]}"
