#!/usr/bin/env bash
# Programs see of the core what is marked with FIBER_PROXIMITY_EXPORT, and nothing else: so many functions, of which some
# are for the package's own libraries and tests.
#   exports_test.sh LIBRARY
set -euo pipefail
library=$1
max_count=296
exported=$(nm -DC --defined-only "$library" | sed -n 's/^[0-9a-f]* T \(fiber::.*\)/\1/p' | sort)
count=$(wc -l <<<"$exported")
if [ "$count" -gt "$max_count" ]; then
  printf '%s\n' "$exported" "exports_test: $library exports $count functions, not $max_count at most: mark only what others call" >&2
  exit 1
fi
grep -q '^fiber::make_engine(' <<<"$exported" || { echo "exports_test: $library exports no make_engine()" >&2; exit 1; }
for hidden in CandidateCache LineReader ContactBatch; do
  if grep "^fiber::$hidden::" <<<"$exported"; then
    echo "exports_test: $library exports $hidden, which nobody else needs" >&2
    exit 1
  fi
done
