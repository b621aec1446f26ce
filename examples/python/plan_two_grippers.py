#!/usr/bin/python3
"""Plans how two grippers carry a cable through a window: RRT-Connect (Kuffner and LaValle 2000) over both positions.

Usage: plan_two_grippers.py [--seed N] [--batch N] [--picture PNG]

A state is where the two grippers are, (6,) [m]. The cable hangs between them as a catenary, as it does where grippers
move slowly; its first and last segments are as thick as the grippers. All candidates of a round are checked in one
call, and so are the motions to them.
"""
import argparse
import time

import matplotlib
import numpy as np

from fiber_proximity import Environment, Fibers, check, check_motions

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  (once it is known that there may be no screen)
from mpl_toolkits.mplot3d.art3d import Poly3DCollection  # noqa: E402

LENGTH = 0.8  # of the cable [m]
POINTS = 41
RADII = np.full(POINTS, 0.006)  # [m]
RADII[[0, -1]] = 0.03  # of the grippers
CLEARANCE = 0.01  # [m] that is to be left
STEP = 0.15  # [m] of a gripper, from state to state at most
SPACING = 0.03  # [m] of a gripper, between the states that a motion is checked through
BEND = 0.004  # [m] that a point of the cable may be beside the straight line between two of these

LOWEST, HIGHEST = np.array([-0.8, -0.6, 0.1] * 2), np.array([0.8, 0.6, 1.3] * 2)
START = np.array([-0.5, -0.3, 0.9, -0.5, 0.3, 0.9])
GOAL = np.array([0.5, -0.3, 0.7, 0.5, 0.3, 0.7])
# Centre and size of boxes [m]: a wall with a window of 0.44 m by 0.56 m, and a post behind it.
BOXES = {
    'left of the window': ([0.0, -0.51, 0.7], [0.06, 0.58, 1.4]),
    'right of the window': ([0.0, 0.51, 0.7], [0.06, 0.58, 1.4]),
    'below the window': ([0.0, 0.0, 0.19], [0.06, 0.44, 0.38]),
    'above the window': ([0.0, 0.0, 1.17], [0.06, 0.44, 0.46]),
    'post': ([0.28, 0.0, 0.3], [0.06, 0.06, 0.6]),
}


def make_environment():
    environment = Environment()
    environment.add_half_space('floor', [0.0, 0.0, 1.0])
    for name, (center, size) in BOXES.items():
        pose = np.eye(4)
        pose[:3, 3] = center
        environment.add_box(name, size, pose)
    return environment


def has_catenary(states):
    """Which states the cable is long enough for, and not folded: (m,)."""
    across = states[:, 3:] - states[:, :3]
    return (np.linalg.norm(across, axis=1) < 0.98 * LENGTH) & (np.linalg.norm(across[:, :2], axis=1) > 0.06)


def catenaries(states):
    """The cable of each state, (m, 6) to (m, POINTS, 3): points at equal distances along it."""
    begin, across = states[:, :3], states[:, 3:] - states[:, :3]
    width, rise = np.linalg.norm(across[:, :2], axis=1), across[:, 2]
    # sinh(x) / x = ratio, by Newton's method from above.
    ratio = np.sqrt(LENGTH ** 2 - rise ** 2) / width
    x = np.minimum(np.sqrt(6.0 * (ratio - 1.0)), np.log(2.0 * ratio) + np.log(1.0 + np.log(2.0 * ratio)) + 0.5)
    for _ in range(30):
        x -= (np.sinh(x) - ratio * x) / (np.cosh(x) - ratio)
    scale = (width / (2.0 * x))[:, None]
    lowest = width[:, None] / 2.0 - scale * np.arctanh(rise / LENGTH)[:, None]
    along = np.linspace(0.0, LENGTH, POINTS)
    u = lowest + scale * np.arcsinh(along / scale - np.sinh(lowest / scale))
    points = np.empty((len(states), POINTS, 3))
    points[:, :, :2] = begin[:, None, :2] + (u / width[:, None])[..., None] * across[:, None, :2]
    points[:, :, 2] = begin[:, None, 2] + scale * (np.cosh((u - lowest) / scale) - np.cosh(lowest / scale))
    return points


def distance(a, b):
    """How far the gripper goes that goes further [m]; broadcasts."""
    both = (a - b).reshape(*np.broadcast(a, b).shape[:-1], 2, 3)
    return np.linalg.norm(both, axis=-1).max(axis=-1)


class Planner:

    def __init__(self, environment, seed, batch):
        self.environment = environment
        self.rng = np.random.default_rng(seed)
        self.batch = batch
        self.checked_states = self.checked_motions = 0

    def free_states(self, states):
        free = has_catenary(states)
        self.checked_states += free.sum()
        free[free] = check(catenaries(states[free]), environment=self.environment, margin=CLEARANCE, radii=RADII).free
        return free

    def free_motions(self, before, after):
        """Whether both grippers can go straight from each state to the other, at the same time.

        The check moves points in straight lines, which the cable's are not: it is asked for more room by as much as
        they may be beside these. Where the cable turns faster than that, as when one gripper passes the other, the
        motion is none."""
        if len(before) == 0:
            return np.zeros(0, bool)
        count = 1 + 2 * max(1, int(np.ceil(distance(before, after).max() / SPACING)))
        through = before[:, None] + np.linspace(0.0, 1.0, count)[:, None] * (after - before)[:, None]
        free = has_catenary(through.reshape(-1, 6)).reshape(-1, count).all(axis=1)
        cables = catenaries(through[free].reshape(-1, 6)).reshape(-1, count, POINTS, 3)
        straight, middle = cables[:, ::2], cables[:, 1::2]
        beside = np.linalg.norm(middle - 0.5 * (straight[:, 1:] + straight[:, :-1]), axis=-1).max(axis=(1, 2))
        free[free] = beside < BEND
        self.checked_motions += free.sum()
        free[free] = check_motions(straight[beside < BEND], environment=self.environment, margin=CLEARANCE + BEND,
                                   radii=RADII).free
        return free

    def steer(self, begin, target):
        """From states towards others, by STEP at most, those that are free; and which these are."""
        far = np.maximum(distance(begin, target) / STEP, 1.0)[:, None]
        states = begin + (target - begin) / far
        free = self.free_states(states)
        free[free] = self.free_motions(begin[free], states[free])
        return states, free

    def plan(self, start, goal, rounds=500):
        """States from start to goal (n, 6) with free motions between them, or None."""
        if not self.free_states(np.array([start, goal])).all():
            return None
        trees = [Tree(start), Tree(goal)]
        for number in range(rounds):
            tree, other = trees if number % 2 == 0 else trees[::-1]
            samples = self.rng.uniform(LOWEST, HIGHEST, (self.batch, 6))
            nearest = tree.nearest(samples)
            states, free = self.steer(tree.states[nearest], samples)
            new = tree.add(states[free], nearest[free])
            met = self.reach(other, tree.states[new])
            if met is not None:
                parts = [tree.to_root(new[met[0]])[::-1], other.to_root(met[1])[1:]]
                return np.concatenate(parts if number % 2 == 0 else [part[::-1] for part in parts[::-1]])
        return None

    def reach(self, tree, targets):
        """Lets a tree grow towards targets until it meets one: (its index, the node that is there), or None."""
        going, nodes = np.arange(len(targets)), tree.nearest(targets)
        while len(going) > 0:
            states, free = self.steer(tree.states[nodes], targets[going])
            nodes = tree.add(states[free], nodes[free])
            going = going[free]
            there = np.flatnonzero(distance(tree.states[nodes], targets[going]) < 1e-9)
            if len(there) > 0:
                return going[there[0]], nodes[there[0]]
        return None

    def shorten(self, path, rounds=30):
        """Leaves out states where the straight motion is free and shorter: the best of a batch in each round."""
        for _ in range(rounds):
            path = np.concatenate([np.linspace(a, b, 2, endpoint=False) for a, b in zip(path, path[1:])] + [path[-1:]])
            along = np.concatenate([[0.0], np.cumsum(distance(path[1:], path[:-1]))])
            first, last = np.sort(self.rng.integers(0, len(path), (2, self.batch)), axis=0)
            gain = along[last] - along[first] - distance(path[first], path[last])
            gain[~self.free_motions(path[first], path[last])] = 0.0
            best = np.argmax(gain)
            path = without_straight(np.concatenate([path[:first[best] + 1], path[last[best]:]]))
        return path


class Tree:
    """States, each with the one that it was reached from."""

    def __init__(self, root):
        self.states, self.parents = np.array([root]), np.array([-1])

    def nearest(self, states):
        return np.argmin(distance(states[:, None], self.states[None]), axis=1)

    def add(self, states, parents):
        """Their indices."""
        self.states = np.concatenate([self.states, states])
        self.parents = np.concatenate([self.parents, parents])
        return np.arange(len(self.states) - len(states), len(self.states))

    def to_root(self, node):
        found = []
        while node >= 0:
            found.append(self.states[node])
            node = self.parents[node]
        return np.array(found)


def without_straight(path):
    """Leaves out states that are on the straight way between their neighbours, or twice there."""
    kept = [path[0]]
    for state, following in zip(path[1:-1], path[2:]):
        before, after = state - kept[-1], following - state
        turn = before * np.linalg.norm(after) - after * np.linalg.norm(before)
        if np.abs(turn).max() > 1e-9:
            kept.append(state)
    return np.array(kept + [path[-1]])


def along(path, spacing):
    """States on the way, no further apart than a spacing [m]."""
    parts = [np.linspace(a, b, 1 + int(np.ceil(distance(a, b) / spacing)))[:-1] for a, b in zip(path, path[1:])]
    return np.concatenate(parts + [path[-1:]])


def clearances(path, environment):
    """[m] of the cable on the way, from what is around."""
    return np.array([environment.closest(Fibers(points, radii=RADII))['distance'] for points in catenaries(path)])


def draw(path, environment, picture):
    figure = plt.figure(figsize=(11, 4.5), layout='constrained')
    scene = figure.add_subplot(1, 2, 1, projection='3d')
    signs = np.array(list(np.ndindex(2, 2, 2))) - 0.5
    sides = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]]
    for center, size in BOXES.values():
        faces = (center + signs * size)[sides]
        scene.add_collection3d(Poly3DCollection(faces, facecolor='tab:gray', edgecolor='k', alpha=0.12, linewidth=0.4))
    shown = along(path, 0.08)
    for points, color in zip(catenaries(shown), plt.cm.viridis(np.linspace(0, 1, len(shown)))):
        scene.plot(*points.T, color=color, linewidth=1.2)
        scene.scatter(*points[[0, -1]].T, color=color, s=12)
    scene.set(xlabel='x [m]', ylabel='y [m]', xlim=(-0.7, 0.7), ylim=(-0.7, 0.7), zlim=(0, 1.4))
    scene.view_init(elev=24, azim=-32)
    way = along(path, 0.005)
    graph = figure.add_subplot(1, 2, 2)
    graph.plot(np.concatenate([[0], np.cumsum(distance(way[1:], way[:-1]))]), 1000 * clearances(way, environment))
    graph.axhline(1000 * CLEARANCE, color='tab:red', linestyle='--', label='asked for')
    graph.set(xlabel='way of the faster gripper [m]', ylabel='clearance [mm]', ylim=(0, None))
    graph.margins(x=0)
    graph.legend()
    figure.savefig(picture, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--batch', type=int, default=64, help='candidates of a round')
    parser.add_argument('--picture', default='plan_two_grippers.png')
    arguments = parser.parse_args()

    environment = make_environment()
    planner = Planner(environment, arguments.seed, arguments.batch)
    begin = time.perf_counter()
    path = planner.plan(START, GOAL)
    if path is None:
        raise SystemExit('no way found')
    found = time.perf_counter()
    short = planner.shorten(path)
    print(f'found {len(path)} states in {found - begin:.2f} s, shortened to {len(short)} in '
          f'{time.perf_counter() - found:.2f} s')
    print(f'{planner.checked_states} states and {planner.checked_motions} motions checked')
    print(f'the way is {distance(short[1:], short[:-1]).sum():.2f} m, at least '
          f'{1000 * clearances(along(short, 0.005), environment).min():.1f} mm from everything')
    draw(short, environment, arguments.picture)


if __name__ == '__main__':
    main()
