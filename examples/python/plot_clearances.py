#!/usr/bin/python3
"""Plots how near fibres come to themselves and to each other, while they move: rosrun fiber_proximity
plot_clearances.py ~fibers:=/proximity/fibers. Where it ends, the plot is written to the file ~picture, if that is set.
Time is that of the messages' stamps."""
import os
import struct
import sys

import matplotlib.pyplot as plt
import rospy

from fiber_proximity import Engine, from_msg

PAIRINGS = 'same_fiber', 'different_fibers'
rospy.init_node('plot_clearances')
engine, track, refusals = Engine(), [], []
figure, axes = plt.subplots()
lines = [axes.plot([], [], label=pairing, marker='.', markersize=3)[0] for pairing in PAIRINGS]
axes.set(xlabel='time [s]', ylabel='clearance [mm]')
axes.legend()


def fail(reason):
    sys.exit(f'plot_clearances.py: {reason}')


def stamp_of(message):
    """[s], from its bytes: a header comes first, in an array of markers after their number. Without a stamp: now."""
    place = 8 if message._connection_header['type'].endswith('/MarkerArray') else 4
    seconds, nanoseconds = struct.unpack_from('<II', message._buff, place)
    return seconds + 1e-9 * nanoseconds or rospy.get_time()


def receive(message):  # its bytes, which from_msg reads at once
    try:
        engine.update(from_msg(message))
    except (TypeError, ValueError) as error:  # no fibres, or points that are not finite
        refusals[:] = [str(error)]
        rospy.logwarn_throttle(10.0, f'a message on {topic} is left out: {error}')
        return
    closest = [engine.closest(pairing=pairing) for pairing in PAIRINGS]
    stamp = stamp_of(message)
    if track and stamp < track[-1][0]:  # a bag that begins anew
        track.clear()
    track.append([stamp] + [None if contact is None else 1000 * contact['distance'] for contact in closest])


picture, topic = str(rospy.get_param('~picture', '')), rospy.resolve_name('~fibers')
if picture:  # an hour later it would be too late to say so
    folder, ending = os.path.dirname(picture) or '.', os.path.splitext(picture)[1][1:].lower()
    if not os.access(folder, os.W_OK) or os.path.isdir(picture):
        fail(f'~picture: {picture} cannot be written')
    if ending not in figure.canvas.get_supported_filetypes():
        fail(f'~picture: {picture} must end in one of: {", ".join(figure.canvas.get_supported_filetypes())}')
rospy.Subscriber('~fibers', rospy.AnyMsg, receive, queue_size=1)
while not rospy.is_shutdown() and plt.fignum_exists(figure.number):
    rows = list(track)
    for line, column in zip(lines, (1, 2)):
        line.set_data(*zip(*[(row[0] - rows[0][0], row[column]) for row in rows[-600:]] or [(None, None)]))
    axes.relim()
    axes.autoscale_view()
    plt.pause(0.1)
if not track:
    fail(f'no fibres have come on {topic}' + ''.join(f'; the last message was left out: {why}' for why in refusals))
if picture:
    try:
        figure.savefig(picture)
    except OSError as error:
        fail(f'~picture: {picture} cannot be written: {error.strerror}')
