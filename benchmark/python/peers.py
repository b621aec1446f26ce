#!/usr/bin/python3
"""The same questions about cables, asked in Python of what Debian has for them: JSON Lines, one for each size and side.

Usage: peers.py contacts|closest|check|nearest [--quick]

Sides take turns; `ms` is the median of a side. `wrong` tells how its answer differs from that of brute force or, where that
would take too long, from ours: pairs of segments too many or too few, or the largest error of a distance [m].

    fiber_proximity   this library
    numpy             distances of all pairs of segments
    kd_tree           scipy's cKDTree over the middles of segments, then distances of the pairs it finds
    kd_tree_sampled   cKDTree over points half a radius apart on the axes, their distances taken for those of the cables
    bullet            capsules in DART's Python bindings (python3-dartpy) with Bullet's detector, moved one by one
"""
import argparse
import json
import pathlib
import statistics
import sys
import time

import numpy as np
from scipy.spatial import cKDTree

import fiber_proximity as fp

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'test' / 'python'))
import support  # noqa: E402  (distances of segments in numpy, which tests use, too)

try:
    import dartpy
except ImportError:
    dartpy = None

POINTS = 100  # of a cable
RADIUS, MARGIN = 0.005, 0.005  # [m]
LARGEST_FOR_NUMPY = 1000  # segments: all pairs of more fill the memory


def cables(count, rng, points=POINTS):
    """Cables of 1 m that wave a little, side by side with as many per area whatever their number: (count, points, 3)."""
    line = np.linspace([0, 0, 0], [1, 0, 0], points)
    places = rng.uniform(-1, 1, (count, 1, 3)) * [0, 1, 1] * 0.03 * np.sqrt(count)
    return line + places + np.cumsum(rng.normal(0, 0.1 / points, (count, points, 3)), axis=1)


def ends(points):
    """Both ends of all segments (m, 3), and the fibre of each (m,)."""
    count, length = points.shape[:2]
    return points[:, :-1].reshape(-1, 3), points[:, 1:].reshape(-1, 3), np.repeat(np.arange(count), length - 1)


class OfNumpy:
    name, largest = 'numpy', LARGEST_FOR_NUMPY

    def pairs(self, points, margin):
        """Pairs of segments (m, 2) of different fibres within the margin, and their distances (m,)."""
        begin, end, fiber = ends(points)
        gap = support.distances(begin[:, None], end[:, None], begin[None], end[None]) - 2 * RADIUS
        gap[fiber[:, None] >= fiber[None]] = np.inf
        pairs = np.argwhere(gap <= margin)
        return pairs, gap[tuple(pairs.T)]

    def closest(self, points):
        return self.pairs(points, np.inf)[1].min()


class OfTree:
    name, largest = 'kd_tree', np.inf

    def pairs(self, points, margin):
        begin, end, fiber = ends(points)
        reach = np.linalg.norm(end - begin, axis=1).max() + 2 * RADIUS + margin
        found = cKDTree(0.5 * (begin + end)).query_pairs(reach, output_type='ndarray')
        found = np.sort(found[fiber[found[:, 0]] != fiber[found[:, 1]]], axis=1)
        gap = support.distances(*(side[found[:, column]] for column in (0, 1) for side in (begin, end))) - 2 * RADIUS
        return found[gap <= margin], gap[gap <= margin]


class OfSamples:
    name, largest = 'kd_tree_sampled', np.inf

    def samples(self, points):
        """Points on the axes, and the segment of each."""
        begin, end, _ = ends(points)
        each = 1 + int(np.ceil(np.linalg.norm(end - begin, axis=1).max() / (0.5 * RADIUS)))
        along = np.linspace(0, 1, each)[None, :, None]
        return (begin[:, None] + along * (end - begin)[:, None]).reshape(-1, 3), np.repeat(np.arange(len(begin)), each)

    def pairs(self, points, margin):
        places, segment = self.samples(points)
        fiber = ends(points)[2]
        found = np.sort(segment[cKDTree(places).query_pairs(2 * RADIUS + margin, output_type='ndarray')], axis=1)
        return np.unique(found[fiber[found[:, 0]] != fiber[found[:, 1]]], axis=0), None

    def closest(self, points):
        """Of two cables."""
        places, _ = self.samples(points)
        first, second = places.reshape(2, -1, 3)
        return cKDTree(first).query(second)[0].min() - 2 * RADIUS

    def nearest(self, points, places):
        return cKDTree(self.samples(points)[0]).query(places)[0] - RADIUS


class OfBullet:
    name, largest = 'bullet', 10_000  # more take minutes

    def __init__(self):
        self.frames = []

    def make(self, begin, end, margin):
        world = dartpy.dynamics.Frame.World()
        self.frames = [dartpy.dynamics.SimpleFrame(world, str(number)) for number in range(len(begin))]
        self.group = dartpy.collision.BulletCollisionDetector().createCollisionGroup()
        for frame, length in zip(self.frames, np.linalg.norm(end - begin, axis=1)):
            frame.setShape(dartpy.dynamics.CapsuleShape(RADIUS + 0.5 * margin, length))
            self.group.addShapeFrame(frame)
        self.option = dartpy.collision.CollisionOption()
        self.option.maxNumContacts = 1000 * len(begin)

    def pairs(self, points, margin):
        """Lengths of segments are those of the first call with as many."""
        begin, end, fiber = ends(points)
        if len(self.frames) != len(begin):
            self.make(begin, end, margin)
        for frame, pose in zip(self.frames, poses(begin, end)):
            frame.setTransform(dartpy.math.Isometry3(pose))
        result = dartpy.collision.CollisionResult()
        self.group.collide(self.option, result)
        found = [[int(side.getShapeFrame().getName()) for side in (contact.collisionObject1, contact.collisionObject2)]
                 for contact in result.getContacts()]
        found = np.sort(np.array(found, dtype=int).reshape(-1, 2), axis=1)
        return np.unique(found[fiber[found[:, 0]] != fiber[found[:, 1]]], axis=0), None


def poses(begin, end):
    """Of capsules along z (m, 4, 4)."""
    along = (end - begin) / np.linalg.norm(end - begin, axis=1)[:, None]
    across = np.cross(np.where(np.abs(along[:, [0]]) < 0.9, [[1.0, 0, 0]], [[0, 1.0, 0]]), along)
    across /= np.linalg.norm(across, axis=1)[:, None]
    found = np.tile(np.eye(4), (len(begin), 1, 1))
    found[:, :3, :3] = np.stack([across, np.cross(along, across), along], axis=2)
    found[:, :3, 3] = 0.5 * (begin + end)
    return found


class Ours:
    name, largest = 'fiber_proximity', np.inf

    def __init__(self):
        self.fibers = None

    def update(self, points):
        if self.fibers is None or self.fibers.point_count != points.shape[0] * points.shape[1]:
            self.fibers = fp.Fibers(points, radii=RADIUS)
            self.engine = fp.Engine(self.fibers)
        else:
            self.fibers.move(points)
            self.engine.update()

    def pairs(self, points, margin):
        self.update(points)
        found = self.engine.contacts(margin, pairing='different_fibers')
        per_fiber = points.shape[1] - 1
        pairs = np.stack([per_fiber * found[f'fiber_{side}'].astype(int) + found[f'segment_{side}'] for side in 'ab'], axis=1)
        return pairs, found['distance']

    def closest(self, points):
        self.update(points)
        return self.engine.closest(pairing='different_fibers')['distance']

    def nearest(self, points, places):
        self.update(points)
        return self.engine.nearest(places)['distance'][:, 0]

    def check(self, candidates):
        return fp.check(candidates, radii=RADIUS, pairing='different_fibers').free


def sides(segments):
    """Those that can, ours first."""
    found = [Ours(), OfNumpy(), OfTree(), OfSamples()] + ([OfBullet()] if dartpy else [])
    return [side for side in found if segments <= side.largest]


def is_free(side, candidate):
    return len(side.pairs(candidate, 0.0)[0]) == 0


def moved(points, rng):
    """The next frame: each cable a little elsewhere."""
    return points + rng.normal(0.0, 0.001, (len(points), 1, 3))


def take_turns(calls, frames):
    """Seconds of each side in each frame, and its last answer: {name: ([s], answer)}."""
    found = {name: ([], None) for name in calls}
    for frame in frames:
        for name, call in calls.items():
            begin = time.perf_counter()
            answer = call(frame)
            found[name] = (found[name][0] + [time.perf_counter() - begin], answer)
    return found


def report(job, segments, found, wrong, **more):
    for name, (seconds, answer) in found.items():
        # The first frame also makes what is kept from frame to frame.
        print(json.dumps({'job': job, 'segments': segments, 'side': name, 'ms': 1e3 * statistics.median(seconds[1:]),
                          'wrong': wrong(answer), **more}), flush=True)


def contacts(counts, turns, rng):
    for count in counts:
        points = cables(count, rng)
        frames = [moved(points, rng) for _ in range(turns + 1)]
        segments = count * (POINTS - 1)
        calls = {side.name: lambda frame, side=side: side.pairs(frame, MARGIN)[0] for side in sides(segments)}
        found = take_turns(calls, frames)
        right = set(map(tuple, found['numpy' if 'numpy' in found else 'fiber_proximity'][1].tolist()))
        report('contacts', segments, found, lambda pairs: len(right ^ set(map(tuple, pairs.tolist()))), pairs=len(right))


def closest(counts, turns, rng):
    for _ in counts[:1]:
        points = cables(2, rng)
        points[1] += [0, 0, 0.3]
        frames = [moved(points, rng) for _ in range(turns + 1)]
        found = take_turns({side.name: side.closest for side in sides(0) if hasattr(side, 'closest')}, frames)
        report('closest', 2 * (POINTS - 1), found, lambda distance: abs(distance - found['numpy'][1]))


def check(counts, turns, rng):
    """1000 candidates for us; others take them one by one, are asked about the first of them, and their time is that of as
    many."""
    grid = np.stack(np.meshgrid(range(5), range(2)), axis=-1).reshape(10, 1, 2) * 0.1
    candidates = np.stack([cables(10, rng) for _ in range(1000 if turns > 2 else 100)])
    # Half of them touch nothing.
    candidates[::2, ..., 1:] += grid - candidates[::2, :, :1, 1:]
    few = candidates[:20 if turns > 2 else 4]
    calls = {'fiber_proximity': lambda _: Ours().check(candidates)}
    for side in sides(10 * (POINTS - 1))[1:]:
        calls[side.name] = lambda _, side=side: np.array([is_free(side, candidate) for candidate in few])
    found = take_turns(calls, range(turns + 1))
    for name, (seconds, _) in found.items():
        if name != 'fiber_proximity':
            seconds[:] = [second * len(candidates) / len(few) for second in seconds]
    right = found['numpy'][1]
    free = int(found['fiber_proximity'][1].sum())
    report('check', 10 * (POINTS - 1), found, lambda answer: int((answer[:len(few)] != right).sum()),
           candidates=len(candidates), free=free)


def nearest(counts, turns, rng):
    for count in counts:
        points = cables(count, rng)
        places = rng.uniform(points.min(axis=(0, 1)), points.max(axis=(0, 1)), (10_000, 3))
        frames = [moved(points, rng) for _ in range(turns + 1)]
        segments = count * (POINTS - 1)
        calls = {side.name: lambda frame, side=side: side.nearest(frame, places)
                 for side in sides(segments) if hasattr(side, 'nearest')}
        found = take_turns(calls, frames)
        report('nearest', segments, found, lambda gaps: np.abs(gaps - found['fiber_proximity'][1]).max(), points=len(places))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('job', choices=('contacts', 'closest', 'check', 'nearest'))
    parser.add_argument('--quick', action='store_true', help='small sizes and few turns')
    arguments = parser.parse_args()
    counts, turns = ([2, 10], 2) if arguments.quick else ([2, 10, 100, 1000], 7)
    globals()[arguments.job](counts, turns, np.random.default_rng(1))


if __name__ == '__main__':
    main()
