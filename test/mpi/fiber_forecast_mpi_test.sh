#!/usr/bin/env bash
# fiber_forecast_mpi counts the halos that as many ranks have, and forecasts those of a scene ten times as large.
#   fiber_forecast_mpi_test.sh FOLDER MPIEXEC [FLAG...]
#     see tool_test.sh
# shellcheck source=test/mpi/tool_test.sh
source "$(dirname "${BASH_SOURCE[0]}")/tool_test.sh"

# halo TOOL ARGUMENT...: the figure of this name.
halo() { "$@" | sed 's/.*"halo":\([0-9.e-]*\),.*/\1/'; }

for scene in soup locks; do
  for ranks in 2 3; do
    options=(--scene "$scene" --segments 30000 --margin 0.001)
    expected=$(halo "${mpiexec[@]}" "$ranks" "$tools/fiber_bench_mpi" "${options[@]}" --frames 1)
    [ "$(halo "$tools/fiber_forecast_mpi" "${options[@]}" --parts "$ranks")" = "$expected" ] ||
      fail "$ranks ranks have a halo of $expected in $scene, the forecast counts otherwise"
  done
done

options=(--segments 600000 --parts 8 --margin 0.001)
counted=$(halo "$tools/fiber_forecast_mpi" "${options[@]}")
forecast=$(halo "$tools/fiber_forecast_mpi" "${options[@]}" --sample 60000)
awk -v a="$counted" -v b="$forecast" 'BEGIN { exit !(a > 0.01 && b > 0.85 * a && b < 1.15 * a) }' ||
  fail "a halo of $counted is forecast as $forecast"

code=0
"$tools/fiber_forecast_mpi" --scene locks --segments 10000000 --sample 8000 2>error.txt || code=$?
[ "$code" -eq 2 ] || fail "a sample that is too small: exit code $code"
grep -q "^fiber_forecast_mpi: --sample must be at least 3686400" error.txt || fail "$(cat error.txt)"
