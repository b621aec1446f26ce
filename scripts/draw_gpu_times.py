#!/usr/bin/python3
"""Draws what scripts/check_gpu.sh has measured, and prints it as a table; then a table of the stages on the GPU.

    scripts/draw_gpu_times.py TIMES.jsonl FIGURE.svg
"""
import json
import sys

import matplotlib

matplotlib.use('Agg')
from matplotlib import pyplot  # noqa: E402 (after the choice of what draws)


def read(path):
    """By scene: milliseconds by what was measured, segments and contacts."""
    scenes = {}
    with open(path, encoding='utf-8') as file:
        for line in file:
            if not line.startswith('{'):
                continue
            row = json.loads(line)
            scene = scenes.setdefault(row['scene'], {})
            if 'stage' in row:
                scene.setdefault('stages', {})[row['stage']] = row['stage_ms']
            elif 'engine' in row:
                scene[row['engine']] = row['cycle_ms']
                scene['threads'] = max(row['threads'], scene.get('threads', 0))
            else:
                scene.update(segments=row['segments'], contacts=row['contacts'], device=row['device_ms'],
                             arrays=row['locked_ms'], unlocked=row['all_ms'], same=row['run_tree_ms'])
    return scenes


BARS = (
    ('run_tree', 'run_tree, {threads} threads', '#8a8a8a'),
    ('cuda_tree', 'cuda_tree, whole contacts on the host', '#8fb8de'),
    ('arrays', 'DeviceProximity, page-locked points over and arrays back', '#3d7ab8'),
    ('device', 'of that on the GPU', '#123f6d'),
)


def draw(scenes, path):
    matplotlib.rcParams.update({'svg.hashsalt': 'fiber_proximity', 'font.size': 9})
    figure, axes = pyplot.subplots(figsize=(8, 3.6), constrained_layout=True)
    width = 0.2
    threads = max(scene['threads'] for scene in scenes.values())
    for place, (key, label, colour) in enumerate(BARS):
        axes.bar([at + (place - 1.5) * width for at in range(len(scenes))],
                 [scene[key] for scene in scenes.values()], width, label=label.format(threads=threads),
                 color=colour)
    axes.axhline(1000 / 60, color='#c04040', linewidth=0.8, linestyle='--')
    axes.text(-0.75, 1000 / 60, '60 frames a second', color='#c04040', ha='left', va='bottom',
              fontsize=8)
    axes.set_yscale('log')
    axes.set_ylabel('a frame [ms]')
    axes.set_xticks(range(len(scenes)), [
        f"{name}\n{scene['segments'] / 1e6:.2g} M" for name, scene in scenes.items()])
    axes.set_xlabel('scene, segments')
    axes.legend(fontsize=8, frameon=False, ncols=2)
    for side in ('top', 'right'):
        axes.spines[side].set_visible(False)
    figure.savefig(path, metadata={'Date': None})


def table(scenes):
    print('| scene | segments | contacts | run_tree [ms] | cuda_tree [ms] | run_tree, without loops [ms] | arrays back [ms] | '
          'page-locked [ms] | on the GPU [ms] | without loops / GPU |')
    print('|-|-|-|-|-|-|-|-|-|-|')
    for name, scene in scenes.items():
        print(f"| {name} | {scene['segments']:,} | {scene['contacts']:,} | {scene['run_tree']:.1f} | "
              f"{scene['cuda_tree']:.1f} | {scene['same']:.1f} | {scene['unlocked']:.1f} | {scene['arrays']:.1f} | "
              f"{scene['device']:.2f} | {scene['same'] / scene['device']:.1f} |".replace(',', ' '))


def table_of_stages(scenes):
    names = list(next(iter(scenes.values()))['stages'])
    print(f"\n| scene | {' | '.join(f'{name} [ms]' for name in names)} |")
    print('|-' * (len(names) + 1) + '|')
    for name, scene in scenes.items():
        print(f"| {name} | {' | '.join(format(scene['stages'][stage], '.2f') for stage in names)} |")


def main():
    if len(sys.argv) != 3:
        sys.exit('usage: scripts/draw_gpu_times.py TIMES.jsonl FIGURE.svg')
    scenes = read(sys.argv[1])
    draw(scenes, sys.argv[2])
    table(scenes)
    if all('stages' in scene for scene in scenes.values()):
        table_of_stages(scenes)


if __name__ == '__main__':
    main()
