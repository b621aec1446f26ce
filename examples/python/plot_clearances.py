#!/usr/bin/python3
"""Plots how near fibres come to themselves and to each other, while they move: rosrun fiber_proximity
plot_clearances.py ~fibers:=/proximity/fibers. Where it ends, the plot is written to the file ~picture, if that is set.
Time is that of the messages' stamps."""
import struct
import sys

import matplotlib.pyplot as plt
import rospy

from fiber_proximity import Engine, from_msg

PAIRINGS = 'same_fiber', 'different_fibers'
rospy.init_node('plot_clearances')
engine, track = Engine(), []
figure, axes = plt.subplots()
lines = [axes.plot([], [], label=pairing)[0] for pairing in PAIRINGS]
axes.set(xlabel='time [s]', ylabel='clearance [mm]')
axes.legend()


def stamp_of(message):
    """[s], from its bytes: a header comes first, in an array of markers after their number. Without a stamp: now."""
    place = 8 if message._connection_header['type'].endswith('/MarkerArray') else 4
    seconds, nanoseconds = struct.unpack_from('<II', message._buff, place)
    return seconds + 1e-9 * nanoseconds or rospy.get_time()


def receive(message):  # its bytes, which from_msg reads at once
    engine.update(from_msg(message))
    closest = [engine.closest(pairing=pairing) for pairing in PAIRINGS]
    stamp = stamp_of(message)
    if track and stamp < track[-1][0]:  # a bag that begins anew
        track.clear()
    track.append([stamp] + [None if contact is None else 1000 * contact['distance'] for contact in closest])


rospy.Subscriber('~fibers', rospy.AnyMsg, receive, queue_size=1)
while not rospy.is_shutdown() and plt.fignum_exists(figure.number):
    for line, column in zip(lines, (1, 2)):
        line.set_data(*zip(*[(row[0] - track[0][0], row[column]) for row in track[-600:]] or [(None, None)]))
    axes.relim()
    axes.autoscale_view()
    plt.pause(0.1)
if not track:
    sys.exit(f'plot_clearances.py: no fibres have come on {rospy.resolve_name("~fibers")}')
if rospy.has_param('~picture'):
    figure.savefig(rospy.get_param('~picture'))
