#!/usr/bin/python3
"""Draws what `fiber_query_mpi regions` tells: which rank owns which fibres, and the halo of one rank, from above.

Usage: draw_regions.py FIBERS.csv REGIONS.csv [--rank R] [--out PICTURE.png]

FIBERS.csv is the file that the ranks were asked about, with one frame; z is left out. The picture for
docs/distributed.md is made by the commands that stand there.
"""
import argparse
import csv
import io
import sys

import matplotlib

matplotlib.use('Agg')
import matplotlib.pyplot as pyplot  # noqa: E402  (the backend is chosen first)
from matplotlib.collections import LineCollection  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from PIL import Image  # noqa: E402

# Told apart by people who see fewer colours, too (Okabe and Ito).
COLOURS = ['#0072b2', '#e69f00', '#009e73', '#cc79a7', '#56b4e9', '#d55e00', '#f0e442', '#555555']
OTHERS = '#d8d8d8'


def read_segments(path):
    """The two ends of each segment, by (fibre, index), in mm."""
    segments = {}
    name = last = None
    count = 0
    with open(path, newline='', encoding='utf-8') as file:
        for row in csv.DictReader(file):
            point = (1e3 * float(row['x']), 1e3 * float(row['y']))
            if row['fiber'] == name:
                segments[(name, count)] = (last, point)
                count += 1
            else:
                name, count = row['fiber'], 0
            last = point
    return segments


def read_regions(path):
    """Of each segment the owner, and the set of ranks that have it in their halo."""
    with open(path, newline='', encoding='utf-8') as file:
        return {(row['fiber'], int(row['segment'])):
                (int(row['owner']), {int(rank) for rank in row['in_halo_of'].split(';') if rank})
                for row in csv.DictReader(file)}


def draw(axes, lines, colour, width, order):
    axes.add_collection(LineCollection(lines, colors=colour, linewidths=width, zorder=order, capstyle='butt'))


def colour_of(rank):
    return COLOURS[rank % len(COLOURS)]


def label_rank(axes, rank, lines):
    x = [0.5 * (a[0] + b[0]) for a, b in lines]
    y = [0.5 * (a[1] + b[1]) for a, b in lines]
    axes.text(sum(x) / len(x), sum(y) / len(y), f'rank {rank}', ha='center', va='center', fontsize=12, zorder=9,
              color=colour_of(rank), fontweight='bold',
              bbox={'facecolor': 'white', 'edgecolor': colour_of(rank), 'boxstyle': 'round,pad=0.3'})


def draw_owners(axes, segments, regions, ranks):
    axes.set_title('Each rank owns a region')
    for rank in range(ranks):
        lines = [segments[key] for key, (owner, _) in regions.items() if owner == rank]
        draw(axes, lines, colour_of(rank), 1.2, 1)
        if lines:
            label_rank(axes, rank, lines)


def draw_halo(axes, segments, regions, ranks, rank):
    """@return what the legend explains"""
    axes.set_title(f'Rank {rank} holds its own and its halo')
    own = [segments[key] for key, (owner, _) in regions.items() if owner == rank]
    draw(axes, [segments[key] for key, (owner, _) in regions.items() if owner != rank], OTHERS, 0.8, 1)
    draw(axes, own, colour_of(rank), 1.2, 2)
    handles = [Line2D([], [], color=colour_of(rank), linewidth=1.5, label=f'{len(own):,} segments of its own')]
    for other in range(ranks):
        halo = [segments[key] for key, (owner, halo_of) in regions.items() if owner == other and rank in halo_of]
        if halo:
            draw(axes, halo, colour_of(other), 4.0, 3)
            handles.append(Line2D([], [], color=colour_of(other), linewidth=4.0,
                                  label=f'halo: {len(halo):,} that rank {other} sends'))
    label_rank(axes, rank, own)
    return handles + [Line2D([], [], color=OTHERS, linewidth=1.5, label='what it does not hold')]


def save(figure, path):
    """With as few colours as lines have: a quarter of the size."""
    picture = io.BytesIO()
    figure.savefig(picture, dpi=100)
    Image.open(picture).convert('RGB').quantize(64, dither=Image.Dither.NONE).save(path, optimize=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split('\n', maxsplit=1)[0])
    parser.add_argument('fibers', metavar='FIBERS.csv')
    parser.add_argument('regions', metavar='REGIONS.csv')
    parser.add_argument('--rank', type=int, default=0, help='whose halo is drawn')
    parser.add_argument('--out', default='regions.png')
    arguments = parser.parse_args()
    segments = read_segments(arguments.fibers)
    regions = read_regions(arguments.regions)
    if segments.keys() != regions.keys():
        sys.exit(f'draw_regions.py: {arguments.regions} tells of other segments than {arguments.fibers} has')
    ranks = 1 + max(owner for owner, _ in regions.values())
    if not 0 <= arguments.rank < ranks:
        sys.exit(f'draw_regions.py: --rank is {arguments.rank}, it must be from 0 to {ranks - 1}')
    figure, both = pyplot.subplots(1, 2, figsize=(10, 5.6), sharex=True, sharey=True)
    draw_owners(both[0], segments, regions, ranks)
    handles = draw_halo(both[1], segments, regions, ranks, arguments.rank)
    for axes in both:
        axes.set_aspect('equal')
        axes.autoscale()
        axes.margins(0.01)
        axes.axis('off')
    figure.subplots_adjust(left=0.01, right=0.99, top=0.94, bottom=0.1, wspace=0.03)
    figure.legend(handles=handles, loc='lower center', ncol=3, frameon=False, fontsize=10)
    save(figure, arguments.out)


if __name__ == '__main__':
    main()
