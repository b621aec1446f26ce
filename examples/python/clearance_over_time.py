#!/usr/bin/python3
"""Draws how near a tracked cable comes to itself, and to what is around it, over the time of a bag.

Usage: clearance_over_time.py BAG [--topic TOPIC] [--radius METRES] [--obstacles YAML] [--picture PNG]

The obstacles are in the frame of the cable's points; docs/environment.md has the keys of the file.
"""
import argparse

import matplotlib
import numpy as np
import rosbag

from fiber_proximity import Engine, Environment, Fibers, from_msg

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  (once it is known that there may be no screen)


def read_track(path, topic, radius):
    """The times [s] of the messages of a topic since the first, and the fibres of each."""
    with rosbag.Bag(path) as bag:
        found = [(stamp.to_sec(), from_msg(message, radius)) for _, message, stamp in bag.read_messages(topic)]
        topics = ', '.join(sorted(bag.get_type_and_topic_info().topics))
    if not found:
        raise SystemExit(f'{path}: no messages on {topic}, it has {topics or "none at all"}')
    times, track = zip(*found)
    return np.array(times) - times[0], track


def clearances(track, environment):
    """The least distance of each frame from itself, and from the environment, infinite where there is none, with the
    contact that has it: two lists of `contact_dtype` or None."""
    fibers = Fibers(track[0].points, track[0].offsets, track[0].radii)
    engine = Engine(fibers)
    of_itself, of_others = [], []
    for frame in track:
        if np.array_equal(frame.offsets, fibers.offsets):
            fibers.move(frame.points)
            engine.update()
        else:  # the tracker has found another number of points
            fibers = frame
            engine.update(fibers)
        of_itself.append(engine.closest())
        of_others.append(environment.closest(fibers) if len(environment) else None)
    return of_itself, of_others


def distances(contacts):
    return np.array([np.inf if contact is None else contact['distance'] for contact in contacts])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('bag')
    parser.add_argument('--topic', default='/trackdlo/results_pc')
    parser.add_argument('--radius', type=float, default=0.005, help='of the cable [m], where messages have none')
    parser.add_argument('--obstacles', help='YAML file of what is around')
    parser.add_argument('--picture', default='clearance_over_time.png')
    arguments = parser.parse_args()

    environment = Environment()
    if arguments.obstacles:
        environment.read(arguments.obstacles)
    times, track = read_track(arguments.bag, arguments.topic, arguments.radius)
    figure, axes = plt.subplots(figsize=(8, 3.5), layout='constrained')
    print(f'{len(times)} frames in {times[-1]:.1f} s')
    for name, contacts in zip(('itself', 'the obstacles'), clearances(track, environment)):
        gaps = distances(contacts)
        if not np.isfinite(gaps).any():
            continue
        least = np.argmin(gaps)
        print(f'closest to {name}: {1000 * gaps[least]:.1f} mm, segment {contacts[least]["segment_a"]}, '
              f'at {times[least]:.1f} s')
        axes.plot(times, 1000 * gaps, label=f'to {name}')
    lowest = min(axes.get_ylim()[0], -1.0)
    axes.axhspan(lowest, 0.0, color='tab:red', alpha=0.15, label='contact')
    axes.set(xlabel='time [s]', ylabel='clearance [mm]', ylim=(lowest, None))
    axes.margins(x=0)
    axes.legend()
    figure.savefig(arguments.picture, dpi=110)


if __name__ == '__main__':
    main()
