#!/usr/bin/env bash
# Runs an experiment with fiber_bench and draws its figures.
#   scripts/bench.sh paper|peers|scaling|coherence|accuracy|continuous|simulation|python [--quick] [--redraw] [--out DIR] [--verbose]
#     paper      Fig. 4 to 7 of Sobottka and Weber (2005) on this machine
#     peers      run_tree beside other engines and Embree, CGAL, FCL and Bullet, on every scene
#     scaling    how a cycle grows from 10⁴ to 4.7 million segments, with one thread and two
#     coherence  what a skin is worth where points move a little in every frame
#     accuracy   time against error: kernels and other libraries on hard pairs, queries on scenes
#     continuous whether moving capsules touch, and when: right or wrong, and how fast
#     simulation whether rods move as theory says, time against error, beside Bullet and MuJoCo, too,
#                what each effect costs
#     python     what calls from Python cost beside C++; the same questions asked of numpy, scipy's k-d tree and
#                Bullet in Python
#     --quick    small scenes: minutes at most
#     --redraw   measure nothing: figures and tables from the CSV in DIR (not of continuous and simulation)
#     --verbose  all that installing and building write
#     --out DIR  where CSV and SVG go (default: bench/EXPERIMENT in the build's folder, -quick with --quick);
#                a run that was stopped goes on from what is there
set -euo pipefail
# shellcheck source=scripts/environment.sh
source "$(dirname "${BASH_SOURCE[0]}")/environment.sh"

usage="usage: scripts/bench.sh paper|peers|scaling|coherence|accuracy|continuous|simulation|python [--quick] [--redraw] [--out DIR] [--verbose]"
experiment=
quick=()
redraw=
out=
while [ $# -gt 0 ]; do
  case "$1" in
    --quick) quick=(--quick) ;;
    --redraw) redraw=1 ;;
    --out)
      [ $# -ge 2 ] || { echo "bench.sh: --out needs a folder; $usage" >&2; exit 2; }
      out=$2
      shift
      ;;
    --verbose) be_verbose ;;
    -h | --help) echo "$usage"; exit 0 ;;
    paper | peers | scaling | coherence | accuracy | continuous | simulation | python) experiment=$1 ;;
    *) echo "bench.sh: unknown argument '$1'; $usage" >&2; exit 2 ;;
  esac
  shift
done
[ -n "$experiment" ] || { echo "bench.sh: which experiment? $usage" >&2; exit 2; }

"$root/scripts/setup.sh" --bench
cmake_arguments=(-DFIBER_PROXIMITY_BUILD_BENCHMARKS=ON)
tool=fiber_bench
targets=(fiber_bench)
if [ "$experiment" = python ]; then
  tool=fiber_python_calls
  targets=(fiber_python_calls fiber_proximity_python)
fi
out=${out:-$build/bench/$experiment${quick:+-quick}}
source=(--redraw)
if [ -z "$redraw" ]; then
  build_package "${targets[@]}"
  source=(--tool "$build/devel/lib/fiber_proximity/$tool")
fi
PYTHONPATH=$root/benchmark:$build/devel/lib/python3/dist-packages${PYTHONPATH:+:$PYTHONPATH} \
  /usr/bin/python3 -B -m bench "$experiment" \
  "${source[@]}" --out "$out" "${quick[@]}"
echo "figures, CSV and tables are in $out"
