"""python3 -m bench EXPERIMENT --tool FIBER_BENCH --out FOLDER [--quick]; see scripts/bench.sh."""

import argparse

from . import accuracy, coherence, continuous, paper, peers, python, scaling, simulation

EXPERIMENTS = {"paper": paper.run, "peers": peers.run, "scaling": scaling.run,
               "coherence": coherence.run, "accuracy": accuracy.run,
               "continuous": continuous.run, "simulation": simulation.run, "python": python.run}


def main():
    parser = argparse.ArgumentParser(prog="bench")
    parser.add_argument("experiment", choices=EXPERIMENTS)
    parser.add_argument("--tool", required=True, help="the executable fiber_bench; of python, fiber_python_calls")
    parser.add_argument("--out", required=True, help="folder for CSV and SVG")
    parser.add_argument("--quick", action="store_true", help="small scenes, minutes at most")
    arguments = parser.parse_args()
    EXPERIMENTS[arguments.experiment](arguments.tool, arguments.out, arguments.quick)


main()
