#!/usr/bin/python3
"""Measures how long `fiber_query accuracy` takes, and whether what it recommends holds in other runs.

Usage: measure_recommendation.py [--runs 10] [--seconds 40] [--tools FOLDER] [--keep FOLDER]

Makes three recordings of 600 frames: cables of the demo as a noisy tracker has them (2 mm), a long and fine cable (3000
points), and many cables (150). For each, a first run recommends a setting for each question, and in each of the other runs
no other setting may be better: faster by more than a twentieth, and no less exact (error, contacts missed and invented).
Bounds must be kept by all answers. --keep leaves the recordings in a folder.
"""
import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np

FRAMES = 600
ROOT = pathlib.Path(__file__).resolve().parent.parent


def write(path, frames, radius):
    """Frames of fibres, (frames, fibres, points, 3) [m], as CSV."""
    with open(path, 'w', encoding='ascii') as file:
        file.write('frame,fiber,x,y,z,radius\n')
        for number, fibers in enumerate(frames):
            for fiber, points in enumerate(fibers):
                for x, y, z in points:
                    file.write(f'{number},{fiber},{x:.6f},{y:.6f},{z:.6f},{radius}\n')


def noisy(path, tool, random):
    """The demo, by a tracker that errs by 2 mm a coordinate."""
    exact = path.with_name('exact.csv')
    subprocess.run([tool('fiber_simulate'), str(ROOT / 'config' / 'sim' / 'demo.yaml'), '--seconds',
                    str((FRAMES - 1) / 60), '--out', str(exact)], check=True, stderr=subprocess.DEVNULL)
    header, *lines = exact.read_text(encoding='ascii').splitlines()
    rows = np.array([[float(value) for value in line.split(',')[2:5]] for line in lines])
    rows += random.normal(0.0, 0.002, rows.shape)
    with open(path, 'w', encoding='ascii') as file:
        file.write(header + '\n')
        for line, row in zip(lines, rows):
            frame, fiber, _, _, _, *rest = line.split(',')
            file.write(','.join([frame, fiber, *(f'{value:.6f}' for value in row), *rest]) + '\n')
    exact.unlink()


def long_and_fine(path, _, random):
    """Loops that lie on each other, and slowly move over each other."""
    along = np.linspace(0.0, 60.0 * np.pi, 3000)
    phases = random.uniform(0.0, 2.0 * np.pi, 3)
    frames = []
    for time_ in np.arange(FRAMES) / 60.0:
        radius = 0.3 + 0.05 * np.sin(0.37 * along + phases[0] + 0.8 * time_)
        height = 0.02 * np.sin(0.11 * along + phases[1] + 0.5 * time_) + 0.01 * np.sin(1.3 * along + phases[2])
        frames.append([np.stack([radius * np.cos(along), radius * np.sin(along), height], axis=1)])
    write(path, frames, 0.002)


def many(path, _, random):
    """Cables beside and across each other that sway."""
    count, points = 150, 24
    begins = random.uniform(-0.5, 0.5, (count, 1, 3)) * [1.0, 1.0, 0.1]
    turns = random.uniform(0.0, 2.0 * np.pi, (count, 1))
    ways = np.stack([np.cos(turns), np.sin(turns), 0.05 * np.ones_like(turns)], axis=2)
    places = np.linspace(0.0, 0.8, points)[None, :, None]
    phases = random.uniform(0.0, 2.0 * np.pi, (count, 1, 3))
    frames = [begins + places * ways + 0.03 * np.sin(4.0 * places + phases + 1.5 * time_)
              for time_ in np.arange(FRAMES) / 60.0]
    write(path, frames, 0.004)


def run(tool, path, seconds):
    begin = time.monotonic()
    ending = subprocess.run([tool('fiber_query'), 'accuracy', str(path), '--rate', '60', '--seconds', str(seconds),
                             '--format', 'json'], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    return json.loads(ending.stdout), time.monotonic() - begin


def bounds_kept(answers):
    """[%] The least of all settings that have bounds."""
    return min(each['bounds_kept_percent'] for each in answers['settings'] if each['bounds_kept_percent'] is not None)


def is_better(other, setting):
    """Whether somebody would take the other one."""
    errors = ('error_mm', 'missed_percent', 'invented_percent')
    return other['p50_ms'] < setting['p50_ms'] / 1.05 and all((other[key] or 0.0) <= (setting[key] or 0.0) for key in errors)


def better_ones(recommended, settings):
    """What is better than a recommendation of an earlier run."""
    for question, setting in recommended.items():
        mine = [each for each in settings if each['question'] == question]
        this = next((each for each in mine if each['setting'] == setting), None)
        for other in mine if this else []:
            if is_better(other, this):
                yield f'{question}: {other["setting"]}, {other["p50_ms"]:.3g} ms, beside {setting}, {this["p50_ms"]:.3g} ms'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--runs', type=int, default=10, help='after the first one')
    parser.add_argument('--seconds', type=float, default=40.0, help='as `fiber_query accuracy` has it')
    parser.add_argument('--tools', type=pathlib.Path, help='where fiber_query and fiber_simulate are; default: the PATH')
    parser.add_argument('--keep', type=pathlib.Path, help='folder to leave the recordings in')
    arguments = parser.parse_args()

    def tool(name):
        path = str(arguments.tools / name) if arguments.tools else shutil.which(name)
        if path is None:
            sys.exit(f'measure_recommendation.py: {name} is not on the PATH; say where with --tools')
        return path

    random = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as temporary:
        folder = arguments.keep or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        for make in (noisy, long_and_fine, many):
            path = folder / f'{make.__name__}.csv'
            print(f'{make.__name__}: making {FRAMES} frames', flush=True)
            make(path, tool, random)
            first, longest = run(tool, path, arguments.seconds)
            print(f'  {first["recommendation"]}', flush=True)
            recommended = {question: each['setting'] for question, each in first['recommendations'].items()}
            kept = bounds_kept(first)
            dominated = 0
            for number in range(arguments.runs):
                again, seconds = run(tool, path, arguments.seconds)
                longest = max(longest, seconds)
                kept = min(kept, bounds_kept(again))
                better = list(better_ones(recommended, again['settings']))
                dominated += len(better) > 0
                for each in better:
                    print(f'  run {number + 2}: {each}', flush=True)
            print(f'  {arguments.runs - dominated} of {arguments.runs} runs confirm it, at most {longest:.0f} s a run, '
                  f'bounds kept by {kept:g} % of answers', flush=True)


if __name__ == '__main__':
    main()
