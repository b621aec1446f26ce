"""python3 -m bench EXPERIMENT --tool FIBER_BENCH --out FOLDER [--quick], or --redraw in place of --tool; see
scripts/bench.sh."""

import argparse
import pathlib

from . import accuracy, coherence, continuous, paper, peers, python, scaling, simulation

EXPERIMENTS = {"paper": paper, "peers": peers, "scaling": scaling, "coherence": coherence, "accuracy": accuracy,
               "continuous": continuous, "simulation": simulation, "python": python}


def main():
    parser = argparse.ArgumentParser(prog="bench")
    parser.add_argument("experiment", choices=EXPERIMENTS)
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--tool", help="the executable fiber_bench; of python, fiber_python_calls")
    source.add_argument("--redraw", action="store_true", help="figures and tables from the CSV in the folder")
    parser.add_argument("--out", required=True, help="folder for CSV and SVG")
    parser.add_argument("--quick", action="store_true", help="small scenes, minutes at most")
    arguments = parser.parse_args()
    experiment = EXPERIMENTS[arguments.experiment]
    if not arguments.redraw:
        experiment.run(arguments.tool, arguments.out, arguments.quick)
    elif not hasattr(experiment, "report"):
        parser.error(f"--redraw: the figures of {arguments.experiment} need more than its CSV; run it in a folder "
                     "that has its runs.jsonl")
    else:
        print_report(parser, experiment, pathlib.Path(arguments.out), arguments.quick)


def print_report(parser, experiment, folder, quick):
    try:
        print(experiment.report(folder, quick), end="")
    except FileNotFoundError as error:
        parser.error(f"--redraw: {error.filename} is missing; give the folder of a run by --out")


main()
