#!/usr/bin/python3
"""Tells what each setting costs and errs on the fibres of a bag, and which one to take.

Usage: accuracy_of_bag.py BAG --topic TOPIC [--radius METRES] [--node NAME] [options of `fiber_query accuracy`]

Writes the messages of the topic as the frames of a fibre file and has `fiber_query accuracy` measure them; the rate
comes from their stamps. Options that are not named here go on to it: --margin, --noise, --picture, --format …

Ends as `fiber_query` does: 0, or 1 if the bounds of an answer do not hold, or 2 for what cannot be measured.
"""
import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import time

import numpy as np
import rosbag

from fiber_proximity import from_msg, write_frames


def refuse(reason):
    print(f'accuracy_of_bag.py: {reason}', file=sys.stderr)
    sys.exit(2)


def open_bag(path):
    try:
        return rosbag.Bag(path)
    except (OSError, rosbag.ROSBagException) as error:
        return refuse(f'{path}: {error}')


def topic_type(bag, path, topic):
    """The type of a topic's messages; refuses one that is not there."""
    topics = bag.get_type_and_topic_info().topics
    if topic not in topics:
        there = ', '.join(f'{name} ({info.msg_type})' for name, info in sorted(topics.items()))
        refuse(f'{path}: no messages on {topic}, it has {there or "none at all"}')
    return topics[topic].msg_type


def stamp_of(message, received):
    """[s] Of a message its own stamp, or that of its first part; where nobody filled it in, when it was received."""
    for part in (message, *getattr(message, 'markers', ())[:1]):
        stamp = getattr(getattr(part, 'header', None), 'stamp', None)
        if stamp is not None and not stamp.is_zero():
            return stamp.to_sec()
    return received.to_sec()


def read(path, topic, radius):
    """The stamps [s] of the messages of a topic, (number, fibres) of each, and why others have none."""
    stamps, frames, refused = [], [], []
    with open_bag(path) as bag:
        kind = topic_type(bag, path, topic)
        for number, (_, message, received) in enumerate(bag.read_messages([topic])):
            try:
                fibers = from_msg(message, radius)
            except TypeError as error:
                refuse(f'{path}: {topic} has messages of type {kind}, which are no input: {error}')
            except ValueError as error:
                refused.append(str(error))
                continue
            if not hasattr(fibers, 'offsets'):
                refuse(f'{path}: {topic} has messages of type {kind}, which hold no fibres')
            stamps.append(stamp_of(message, received))
            frames.append((number, fibers))
    return np.array(stamps), frames, refused


def rate_options(stamps):
    """The rate of the messages, as options; none where it cannot be told."""
    steps = np.diff(stamps)
    steps = steps[steps > 0.0]
    return [f'--rate={1.0 / np.median(steps):.6g}'] if steps.size else []


def fiber_query():
    """Where the tool is: beside this script's name, as rosrun has it, or on the path."""
    beside = os.path.join(os.path.dirname(os.path.abspath(sys.argv[0])), 'fiber_query')
    tool = beside if os.access(beside, os.X_OK) else shutil.which('fiber_query')
    return tool or refuse('fiber_query is neither beside this script nor on the PATH')


def share_of(node, answers=50, patience=20.0):
    """A line about how much of a running node's answers is its own work, from its next statistics."""
    import rosgraph
    import rospy
    from fiber_proximity.msg import Statistics

    topic = rosgraph.names.ns_join(node, 'statistics')
    if not rosgraph.is_master_online():
        return f'no share of {node}: no roscore answers'
    rospy.init_node('accuracy_of_bag', anonymous=True, disable_signals=True)
    heard = []
    subscriber = rospy.Subscriber(topic, Statistics, heard.append)
    end = time.monotonic() + patience
    while len(heard) < answers and time.monotonic() < end:
        time.sleep(0.05)
    subscriber.unregister()
    if not heard:
        return f'no share of {node}: nothing came on {topic} for {patience:g} s'
    heard = heard[:answers]
    total = np.array([told.total_time for told in heard])
    own = total - np.array([told.update_time + told.detect_time for told in heard])
    return (f"{node}: {len(heard)} answers of {1e3 * np.median(total):.3g} ms (median), of which "
            f"{1e3 * np.median(own):.3g} ms are the node's own share: all but updates and queries of fibres")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False,
                                     epilog='Other options go on to fiber_query accuracy; see its --help.')
    parser.add_argument('bag')
    parser.add_argument('--topic', required=True)
    parser.add_argument('--radius', type=float, default=0.0, help='of all fibres [m], where messages have none')
    parser.add_argument('--node', help='of this node that runs, such as /proximity, tell its own share of the time')
    arguments, options = parser.parse_known_args()

    stamps, frames, refused = read(arguments.bag, arguments.topic, arguments.radius)
    if not frames:
        refuse(f'{arguments.bag}: no message on {arguments.topic} has fibres, the first one: {refused[0]}'
               if refused else f'{arguments.bag}: no messages on {arguments.topic}')
    if refused:
        print(f'accuracy_of_bag.py: {len(refused)} of {len(refused) + len(frames)} messages left out, the first one: '
              f'{refused[0]}', file=sys.stderr)
    if not any(option.split('=')[0] == '--rate' for option in options):
        options += rate_options(stamps)
    name = os.path.splitext(os.path.basename(arguments.bag))[0]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, f'{name}.csv')
        write_frames(path, frames)
        ending = subprocess.run([fiber_query(), 'accuracy', path, *options], check=False).returncode
    if arguments.node:
        print(f'accuracy_of_bag.py: {share_of(arguments.node)}', file=sys.stderr)
    sys.exit(ending)


if __name__ == '__main__':
    main()
