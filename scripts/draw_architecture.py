#!/usr/bin/python3
"""Draws the folders of src and what includes what, as docs/architecture.svg.

Usage: draw_architecture.py [--check]

Boxes are folders, coloured by the library that their sources are in, as the CMake files tell. An arrow goes from a
folder to one that it includes; arrows that others imply are left out. A folder stands above all that it includes.
--check draws nothing, and fails if the picture is not what would be drawn.
"""
import collections
import html
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURE = ROOT / 'docs' / 'architecture.svg'
INCLUDE = re.compile(r'^\s*#\s*include\s*"(?:src|fiber_proximity)/([^"]+)/[^/"]+\.hpp"', re.MULTILINE)
COLOURS = {
    'fiber_proximity': '#cfe3f5', 'fiber_proximity_paper': '#e6d9f2', 'fiber_proximity_environment': '#d8efd3',
    'fiber_proximity_compare': '#f3e9c6', 'fiber_proximity_sim': '#fbdcc4', 'fiber_proximity_ros': '#f6cfd4',
    'fiber_proximity_scenes': '#e3e6c8', 'fiber_proximity_rviz': '#d3efec', 'fiber_proximity_python': '#fff3a8', 'fiber_proximity_mpi': '#d9d2c5', 'fiber_proximity_cuda': '#cdeab0', 'programs': '#e4e4e4'}
BOX = (150, 30)  # [px] width and height
GAP = (22, 46)  # [px] between boxes, between rows
SHIFT = 32  # [px] of every other row to the side: fewer arrows go behind boxes


def box_of(folder):
    """The box for a folder of src or of include/fiber_proximity: folders that need each other are one."""
    parts = folder.split('/')
    if folder == 'ros':
        return 'ros/support'  # where the sources of its headers are
    if parts[0] == 'ros' or parts[1:] == ['scene']:
        return '/'.join(parts[:2])
    return parts[0]


def read_includes():
    """For each box: the boxes that it includes."""
    included = collections.defaultdict(set)
    for root in (ROOT / 'src', ROOT / 'include' / 'fiber_proximity'):
        for path in root.glob('*/**/*.?pp'):
            box = box_of(path.relative_to(root).parent.as_posix())
            others = {box_of(other) for other in INCLUDE.findall(path.read_text(encoding='utf-8'))}
            included[box] |= others - {box}
    return {box: included[box] for box in sorted(included)}


def read_libraries():
    """For each box: the library with most of its sources, or 'programs'."""
    text = ''.join(path.read_text(encoding='utf-8') for path in
                   [ROOT / 'CMakeLists.txt', *sorted((ROOT / 'cmake').glob('*.cmake'))])
    whole = dict(reversed(pair) for pair in re.findall(r'target_sources\((\w+) PRIVATE \$<TARGET_OBJECTS:(\w+)>\)', text))
    votes = collections.defaultdict(collections.Counter)
    for target, sources in re.findall(r'add_library\((\w+)([^)]*)\)', text):
        target = whole.get(target, target)
        for source in re.findall(r'src/(\S+)/[^/\s]+\.cpp', sources):
            if target in COLOURS:
                votes[box_of(source)][target] += 1
    found = {box: sorted(count, key=lambda name: (-count[name], name))[0] for box, count in votes.items()}
    # Folders of headers alone belong to the core, which is below all.
    for folder in (ROOT / 'src').iterdir():
        if not list(folder.rglob('*.cpp')):
            found[box_of(folder.name)] = 'fiber_proximity'
    return found


def reach(included, box):
    """All that a box includes, directly or through others."""
    seen, waiting = set(), [box]
    while waiting:
        for other in included[waiting.pop()] - seen:
            seen.add(other)
            waiting.append(other)
    return seen


def rows_of(included):
    """The boxes by rows, from the lowest: each as low as what it includes lets it be."""
    heights = {}

    def height(box):
        if box not in heights:
            heights[box] = 1 + max((height(other) for other in included[box]), default=-1)
        return heights[box]

    for box in included:
        if box in reach(included, box):
            sys.exit(f'draw_architecture.py: {box} includes itself through others')
        height(box)
    return [[box for box in included if heights[box] == row] for row in range(max(heights.values()) + 1)]


def arrows_of(included):
    """The includes that no longer way implies."""
    return [(box, other) for box in included for other in sorted(included[box])
            if not any(other in reach(included, between) for between in included[box] - {other})]


def places_of(rows, arrows):
    """The left upper corner of each box [px]: in a row in the order of what they include."""
    width = max(len(row) for row in rows) * (BOX[0] + GAP[0]) + 2 * SHIFT + GAP[0]
    places = {}
    for i, row in enumerate(rows):
        def middle(box):
            below = [places[other][0] for one, other in arrows if one == box and other in places]
            return (sum(below) / len(below) if below else width / 2, box)
        row = sorted(row, key=middle)
        left = (width - len(row) * (BOX[0] + GAP[0])) / 2 + (-1) ** i * SHIFT
        for j, box in enumerate(row):
            places[box] = (left + j * (BOX[0] + GAP[0]), 20 + (len(rows) - 1 - i) * (BOX[1] + GAP[1]))
    return places, width


def draw():
    included = read_includes()
    libraries = read_libraries()
    arrows = arrows_of(included)
    rows = rows_of(included)
    places, width = places_of(rows, arrows)
    height = 20 + len(rows) * (BOX[1] + GAP[1])
    used = [name for name in COLOURS if name in {libraries.get(box, 'programs') for box in included}]
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width + 240:.0f}" height="{height:.0f}" '
        'font-family="sans-serif" font-size="13">',
        '<defs><marker id="tip" markerWidth="8" markerHeight="8" refX="7" refY="4" orient="auto">'
        '<path d="M0,0 L8,4 L0,8 z" fill="#666"/></marker></defs>',
        '<rect width="100%" height="100%" fill="white"/>']
    for box, other in arrows:
        (x0, y0), (x1, y1) = places[box], places[other]
        lines.append(f'<line x1="{x0 + BOX[0] / 2:.1f}" y1="{y0 + BOX[1]:.1f}" x2="{x1 + BOX[0] / 2:.1f}" y2="{y1:.1f}" '
                     'stroke="#666" marker-end="url(#tip)"/>')
    for box, (x, y) in sorted(places.items()):
        colour = COLOURS[libraries.get(box, 'programs')]
        lines.append(f'<rect x="{x:.1f}" y="{y:.1f}" width="{BOX[0]}" height="{BOX[1]}" rx="4" fill="{colour}" '
                     'stroke="#444"/>')
        lines.append(f'<text x="{x + BOX[0] / 2:.1f}" y="{y + 20:.1f}" text-anchor="middle">{html.escape(box)}</text>')
    for i, name in enumerate(used):
        y = 20 + 24 * i
        lines.append(f'<rect x="{width + 10:.1f}" y="{y}" width="16" height="16" fill="{COLOURS[name]}" stroke="#444"/>')
        lines.append(f'<text x="{width + 34:.1f}" y="{y + 13}">{name}</text>')
    return '\n'.join([*lines, '</svg>', ''])


def main():
    if sys.argv[1:] not in ([], ['--check']):
        sys.exit(__doc__)
    picture = draw()
    if not sys.argv[1:]:
        PICTURE.write_text(picture, encoding='utf-8')
    elif not PICTURE.exists() or PICTURE.read_text(encoding='utf-8') != picture:
        sys.exit('draw_architecture.py: docs/architecture.svg is not what the code is; draw it again: scripts/draw_architecture.py')


if __name__ == '__main__':
    main()
