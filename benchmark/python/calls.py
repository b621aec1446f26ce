#!/usr/bin/python3
"""What calls from Python cost beside the same calls in C++, and whether they lose memory.

Usage: calls.py --tool FIBER_PYTHON_CALLS [--json] [--quick]

Prints a table, or JSON Lines with the same names. Both sides take turns; times are medians over the turns.
"""
import argparse
import json
import os
import resource
import statistics
import subprocess
import tempfile
import time

import numpy as np

import fiber_proximity as fp


def cables(count, points, rng, spread):
    """Straight cables side by side that wave a little: (count, points, 3)."""
    line = np.linspace([0, 0, 0], [1, 0, 0], points)
    places = rng.uniform(-spread, spread, (count, 1, 3)) * [0, 1, 1]
    return line + places + np.cumsum(rng.normal(0, 0.1 / points, (count, points, 3)), axis=1)


def median_seconds(call, repeats, calls):
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        for _ in range(calls):
            call()
        times.append((time.perf_counter() - begin) / calls)
    return statistics.median(times)


class Bench:

    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.folder = folder
        self.turns = 3 if arguments.quick else 11

    def in_cpp(self, what, path, margin, repeats):
        run = subprocess.run([self.arguments.tool, what, path, str(margin), str(repeats)], check=True,
                             capture_output=True, text=True)
        return float(run.stdout)

    def report(self, **row):
        if self.arguments.json:
            print(json.dumps(row), flush=True)
        else:
            print('  '.join(f'{name} {value:.4g}' if isinstance(value, float) else f'{name} {value}'
                            for name, value in row.items()), flush=True)

    def compare(self, what, path, margin, call, repeats, calls, **more):
        turns = np.array([(median_seconds(call, repeats, calls), self.in_cpp(what, path, margin, repeats))
                          for _ in range(self.turns)])
        # Ratios are taken in each turn, as the processor's clock changes between turns.
        python, cpp, overhead, throughput = np.median(
            np.column_stack([1e6 * turns, 1e6 * (turns[:, 0] - turns[:, 1]), turns[:, 1] / turns[:, 0]]), axis=0)
        self.report(call=what, python_us=python, cpp_us=cpp, overhead_us=overhead, throughput=throughput, **more)

    def small_calls(self, rng):
        """Two cables of ten points: what is left is the call itself."""
        fibers = fp.Fibers(cables(2, 10, rng, 0.02), radii=0.005)
        path = os.path.join(self.folder, 'small.csv')
        fp.write(path, fibers)
        engine, origin = fp.Engine(fibers), np.zeros(3)
        repeats, calls = (11, 100) if self.arguments.quick else (101, 100)
        for what, margin, call in (('contacts', 0.01, lambda: engine.contacts(0.01)), ('closest', np.inf, engine.closest),
                                   ('update', 0.0, engine.update), ('nearest', 0.0, lambda: engine.nearest(origin))):
            self.compare(what, path, margin, call, repeats, calls, segments=fibers.segment_count)

    def checks(self, rng):
        """1000 candidates of 10 cables of 100 points."""
        count = 100 if self.arguments.quick else 1000
        # Cables that touch nothing: each candidate is looked at to the end.
        grid = np.stack(np.meshgrid(range(5), range(2)), axis=-1).reshape(10, 1, 2) * 0.1
        candidates = np.stack([cables(10, 100, rng, 0.0) for _ in range(count)])
        candidates[..., 1:] += grid
        path = os.path.join(self.folder, 'candidates.csv')
        states = [fp.Fibers(candidate, radii=0.005) for candidate in candidates]
        fp.write_frames(path, states)
        free = fp.check(candidates, radii=0.005).free
        self.compare('check', path, 0.0, lambda: fp.check(candidates, radii=0.005), 5, 1, candidates=count,
                     free=int(free.sum()), of='arrays')
        self.compare('check', path, 0.0, lambda: fp.check(states), 5, 1, candidates=count, free=int(free.sum()),
                     of='Fibers')

    def large(self, rng):
        """A million segments, and as many contacts or more."""
        count = 100 if self.arguments.quick else 10_000
        fibers = fp.Fibers(cables(count, 101, rng, 0.02 * np.sqrt(count)), radii=0.005)
        path = os.path.join(self.folder, 'large.hair')
        fp.write(path, fibers)
        fibers = fp.read(path)  # of single precision, as the other side has them
        engine = fp.Engine(fibers)
        found = engine.contacts(0.01)
        self.compare('contacts', path, 0.01, lambda: engine.contacts(0.01), 3, 1, segments=fibers.segment_count,
                     contacts=len(found), megabytes=found.nbytes / 1e6)
        # This is the time of another copy of the answer.
        copy = median_seconds(found.copy, 3, 1)
        self.report(call='copy of the answer', python_us=1e6 * copy)
        points = fibers.points.copy()
        move, copy = (median_seconds(call, 5, 1) for call in (lambda: fibers.move(points), points.copy))
        self.report(call='move', python_us=1e6 * move, copy_of_points_us=1e6 * copy, points=len(points))

    def memory(self, rng):
        """A million calls, and how the memory of the process grows."""
        fibers = fp.Fibers(cables(2, 10, rng, 0.02), radii=0.005)
        engine = fp.Engine(fibers, threads=1)
        points = fibers.points.copy()

        def call():
            fibers.move(points)
            engine.update()
            engine.contacts(0.01)
            engine.closest()
            engine.nearest(points[0])

        for _ in range(10_000):
            call()
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        calls = 10_000 if self.arguments.quick else 200_000
        for _ in range(calls):
            call()
        grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
        self.report(call='memory', calls=5 * calls, grown_kilobytes=grown)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--tool', required=True, help='the program fiber_python_calls')
    parser.add_argument('--json', action='store_true', help='JSON Lines in place of a table')
    parser.add_argument('--quick', action='store_true', help='small scenes and few turns')
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(arguments, folder)
        bench.small_calls(np.random.default_rng(1))
        bench.checks(np.random.default_rng(2))
        bench.memory(np.random.default_rng(3))
        bench.large(np.random.default_rng(4))


if __name__ == '__main__':
    main()
