#!/usr/bin/python3
"""Plays a cable that jumps through another one with every message: none shows them touch.

Publishes both as a FiberArray on ~topic (/passing/fibers), and where they were in the frame before on
/passing/before, for the picture.
"""
import numpy
import rospy
from fiber_proximity.msg import FiberArray
from geometry_msgs.msg import Point

POINTS = 40
RADIUS = 0.004  # [m]
RATE = 2.0  # [Hz]
HEIGHT = 0.09  # [m] of the jumping cable above and below the other one


def still_cable():
    """Points of a cable that sags between its ends [m], POINTS by 3."""
    t = numpy.linspace(-1.0, 1.0, POINTS)
    return numpy.stack([0.4 * t, 0.05 * numpy.sin(3.0 * t), 0.06 * t ** 2], axis=-1)


def jumping_cable(frame):
    """Points of a cable across it, which is above it and below it in turns [m]."""
    t = numpy.linspace(-1.0, 1.0, POINTS)
    height = HEIGHT if frame % 2 == 0 else -HEIGHT
    return numpy.stack([0.08 + 0.05 * numpy.sin(2.0 * t), 0.35 * t, height * (1.0 - t ** 2) + 0.02],
                       axis=-1)


def message_of(cables, stamp):
    message = FiberArray(offsets=[0], radii=[RADIUS], names=["still", "jumping"])
    message.header.frame_id = "world"
    message.header.stamp = stamp
    for points in cables:
        message.points += [Point(*point) for point in points]
        message.offsets.append(len(message.points))
    return message


def main():
    rospy.init_node("play_passing")
    publisher = rospy.Publisher(rospy.get_param("~topic", "/passing/fibers"), FiberArray, queue_size=1)
    before = rospy.Publisher("/passing/before", FiberArray, queue_size=1)
    rate = rospy.Rate(RATE)
    frame = 0
    while not rospy.is_shutdown():
        stamp = rospy.Time.now()
        before.publish(message_of([still_cable(), jumping_cable(frame - 1)], stamp))
        publisher.publish(message_of([still_cable(), jumping_cable(frame)], stamp))
        frame += 1
        try:
            rate.sleep()
        except rospy.ROSInterruptException:
            return


if __name__ == "__main__":
    main()
