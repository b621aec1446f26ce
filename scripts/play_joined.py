#!/usr/bin/python3
"""Plays fibres that are closed or joined: a ring, a net and a harness, as a FiberArray on ~topic (/joined/fibers).

The ring hangs from a trefoil, which is one closed fibre, too. Where yarns of the net meet and where branches leave the
trunk points share the number of a joint: neighbours along the graph do not touch each other. What does touch, in turns, is
the ring and the trefoil, a branch and the net, and the net's free corner and the trunk.
"""
import numpy
import rospy
from fiber_proximity.msg import FiberArray
from geometry_msgs.msg import Point

RATE = 30.0  # [Hz]
NET = 7  # yarns a side


class Fibers:
    """Fibres that are collected for a message."""

    def __init__(self):
        self.message = FiberArray(offsets=[0])
        self.message.closed = []  # rospy's own default is bytes, which cannot grow
        self.next_joint = 0

    def new_joint(self):
        self.next_joint += 1
        return self.next_joint - 1

    def add(self, name, points, radius, closed=False, joints=None):
        """@param joints numbers by index of a point"""
        numbers = [-1] * len(points)
        for index, joint in (joints or {}).items():
            numbers[index] = joint
        message = self.message
        message.names.append(name)
        message.points += [Point(*point) for point in points]
        message.offsets.append(len(message.points))
        message.radii.append(radius)
        message.closed.append(closed)
        message.joints += numbers


def circle(count):
    return numpy.linspace(0.0, 2.0 * numpy.pi, count, endpoint=False)


def trefoil():
    a = circle(90)
    return 0.05 * numpy.stack([numpy.sin(a) + 2.0 * numpy.sin(2.0 * a), 0.8 * numpy.sin(3.0 * a),
                               numpy.cos(a) - 2.0 * numpy.cos(2.0 * a)], axis=-1) + (-0.4, 0.0, 0.35)


def ring(time):
    a, swing = circle(48), 0.012 * numpy.sin(1.7 * time)
    return numpy.stack([0.07 * numpy.cos(a), 0.02 * numpy.sin(a), 0.09 * numpy.sin(a)], axis=-1) + (-0.4, swing, 0.155)


def net_point(u, v, time):
    """A point of the net, u and v from 0 to 1: it hangs by one side and waves [m]."""
    wave = 0.03 * v * numpy.sin(3.0 * u + 2.0 * v - 2.0 * time)
    return numpy.stack([0.32 * (u - 0.5) + 0.02, wave + 0.05 * v ** 2, 0.42 - 0.3 * v], axis=-1)


def add_net(fibers, time):
    along = 4 * (NET - 1) + 1  # points of a yarn
    crossings = [[fibers.new_joint() for _ in range(NET)] for _ in range(NET)]
    t = numpy.linspace(0.0, 1.0, along)
    for i in range(NET):
        at = numpy.full(along, i / (NET - 1))
        fibers.add(f"warp {i}", net_point(at, t, time), 0.002, joints={4 * j: crossings[i][j] for j in range(NET)})
        fibers.add(f"weft {i}", net_point(t, at, time), 0.002, joints={4 * j: crossings[j][i] for j in range(NET)})


def add_harness(fibers, time):
    t = numpy.linspace(0.0, 1.0, 41)
    trunk = numpy.stack([0.9 * t - 0.5, 0.11 + 0.02 * numpy.sin(6.0 * t + time), 0.06 + 0.02 * numpy.cos(5.0 * t)],
                        axis=-1)
    joints = {8 * (i + 1): fibers.new_joint() for i in range(4)}
    fibers.add("trunk", trunk, 0.008, joints=joints)
    s = numpy.linspace(0.0, 1.0, 25)[:, None]
    for number, (index, joint) in enumerate(joints.items()):
        side = -1.0 if number % 2 else 1.0
        sway = 0.05 * numpy.sin(1.3 * time + number)
        out = numpy.array([0.12 + sway, 0.16 * side, 0.12])
        fibers.add(f"branch {number}", trunk[index] + s * out - (0.0, 0.0, 0.1) * s * s, 0.005, joints={0: joint})


def message_of(time):
    fibers = Fibers()
    fibers.add("trefoil", trefoil(), 0.008, closed=True)
    fibers.add("ring", ring(time), 0.006, closed=True)
    add_net(fibers, time)
    add_harness(fibers, time)
    fibers.message.header.frame_id = "world"
    return fibers.message


def main():
    rospy.init_node("play_joined")
    publisher = rospy.Publisher(rospy.get_param("~topic", "/joined/fibers"), FiberArray, queue_size=1)
    rate = rospy.Rate(RATE)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        message = message_of(now.to_sec() % 1000.0)
        message.header.stamp = now
        publisher.publish(message)
        try:
            rate.sleep()
        except rospy.ROSInterruptException:
            return


if __name__ == "__main__":
    main()
