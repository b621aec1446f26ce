#!/usr/bin/python3
"""Plays the demo of launch/cell.launch: an arm that moves the end of a cable about a table.

Publishes joint_states of urdf/arm.urdf (read from the parameter robot_description) and, for the
same moment, the cables as fibers, in the frame world. All is a function of the time, which repeats
every PERIOD; what the numbers below say of tables and rails stands in config/cell.yaml, too.
"""
import math
import sys
import xml.etree.ElementTree

import numpy
import rospy
from fiber_proximity.msg import FiberArray
from geometry_msgs.msg import Point
from sensor_msgs.msg import JointState

PERIOD = 16.0  # [s]
RATE = 30.0  # [Hz]
TABLE = 0.70  # [m] height of its top


def wave(time, cycles, phase=0.0):
    """Cycles are whole, so that the motion repeats."""
    return math.sin(2 * math.pi * cycles * time / PERIOD + phase)


class Arm:
    """Inverse kinematics of the arm, with the lengths of its URDF."""

    JOINTS = ("waist", "shoulder", "elbow", "wrist", "roll")

    def __init__(self, description):
        """Raises ValueError if a joint is missing."""
        robot = xml.etree.ElementTree.fromstring(description)

        def origin(name):
            element = robot.find(f"./joint[@name='{name}']/origin")
            if element is None:
                raise ValueError(f"robot_description has no joint '{name}' with an origin; "
                                 f"it must be that of urdf/arm.urdf")
            return numpy.array([float(x) for x in element.get("xyz").split()])

        self.base = origin("mount") + origin("waist") + origin("shoulder")
        self.upper = origin("elbow")[2]
        self.lower = origin("wrist")[2]
        self.hand = origin("roll")[2] + origin("grip")[2]

    def joints(self, tool, roll):
        """Angles that bring the tool to a point, pointing down, elbow up [rad].

        Raises ValueError for a point out of reach.
        """
        x, y, z = tool - self.base
        z += self.hand
        reach = math.hypot(x, y)
        cosine = ((reach ** 2 + z ** 2 - self.upper ** 2 - self.lower ** 2) /
                  (2 * self.upper * self.lower))
        if not -1.0 <= cosine <= 1.0:
            raise ValueError(f"the arm cannot reach {tool}")
        elbow = math.acos(cosine)
        shoulder = math.atan2(reach, z) - math.atan2(self.lower * math.sin(elbow),
                                                     self.upper + self.lower * math.cos(elbow))
        return [math.atan2(y, x), shoulder, elbow, math.pi - shoulder - elbow, roll]


def tool_at(time):
    """Where the arm holds the cable [m]."""
    return numpy.array([0.02 + 0.07 * wave(time, 2, 0.6),
                        0.02 + 0.155 * wave(time, 1),
                        TABLE + 0.15 + 0.06 * wave(time, 3, 1.0)])


class Cable:
    """A curve through knots, cut off at a length: what is not needed at its begin hangs at its end.
    """

    def __init__(self, name, radius, length, segments, knots):
        """knots(time): points, the curve through them longer than the cable [m]"""
        self.name = name
        self.radius = radius
        self.length = length
        self.segments = segments
        self.knots = knots

    def points(self, time):
        """Points at equal distances along the curve, shape (segments + 1, 3) [m]."""
        curve = spline(numpy.array(self.knots(time)))
        lengths = numpy.linalg.norm(numpy.diff(curve, axis=0), axis=1)
        along = numpy.concatenate([[0.0], numpy.cumsum(lengths)])
        assert along[-1] >= self.length, f"the curve of '{self.name}' is too short: {along[-1]} m"
        places = numpy.linspace(0.0, self.length, self.segments + 1)
        return numpy.stack([numpy.interp(places, along, curve[:, i]) for i in range(3)], axis=1)


def spline(knots, steps=24):
    """Points on the uniform Catmull-Rom spline through the knots, shape (n, 3)."""
    ends = [2 * knots[0] - knots[1]], [2 * knots[-1] - knots[-2]]
    a, b, c, d = (numpy.concatenate([ends[0], knots, ends[1]])[i:i + len(knots) - 1, None]
                  for i in range(4))
    x = numpy.linspace(0.0, 1.0, steps, endpoint=False)[None, :, None]
    points = b + 0.5 * x * ((c - a) + x * ((2 * a - 5 * b + 4 * c - d) +
                                           x * (3 * (b - c) + d - a)))
    return numpy.concatenate([points.reshape(-1, 3), knots[-1:]])


def held_knots(time):
    """From the gripper down to the table, around the bottle, and over the table's front edge."""
    tool = tool_at(time)
    lie = TABLE + 0.0085
    sway = wave(time, 4, 0.5)
    return [tool, tool - [0, 0, 0.05], 0.6 * tool + [0.06, -0.01, 0.4 * (TABLE - 0.10)],
            [0.19, 0.02, lie + 0.008], [0.31, 0.09, lie], [0.41, 0.02, lie],
            [0.40, -0.12, lie], [0.27, -0.20, lie + 0.002 * (1 + sway)], [0.20, -0.32, lie],
            [0.19, -0.375, lie + 0.001], [0.19, -0.407, TABLE + 0.007],
            [0.19, -0.412, TABLE - 0.03],
            [0.19, -0.43 + 0.012 * sway, TABLE - 0.18],
            [0.19 + 0.02 * sway, -0.435 + 0.035 * sway, TABLE - 0.36],
            [0.19 + 0.05 * sway, -0.435 + 0.07 * sway, TABLE - 0.60]]


def cord_knots(time):
    """From the rail down past the arm, over the held cable twice, and over the table's end."""
    lie = TABLE + 0.0055
    over = TABLE + 0.0225
    sway = wave(time, 2, 2.0)
    return [[-0.16, 0.30, 1.283], [-0.155, 0.295, 1.22], [-0.12, 0.26 + 0.03 * sway, 1.05],
            [-0.03, 0.253 + 0.03 * sway, 0.88], [0.09, 0.245, TABLE + 0.06], [0.20, 0.20, lie],
            [0.29, 0.09, over + 0.002 * sway], [0.35, 0.045, lie + 0.003],
            [0.42, 0.02, over - 0.002 * sway], [0.51, 0.08, lie + 0.001], [0.575, 0.13, lie + 0.001],
            [0.605, 0.14, TABLE + 0.006], [0.609, 0.14, TABLE - 0.03],
            [0.62 + 0.01 * sway, 0.14, TABLE - 0.18],
            [0.63 + 0.03 * sway, 0.14, TABLE - 0.40]]


CABLES = [Cable("held", 0.008, 1.45, 96, held_knots), Cable("cord", 0.005, 1.42, 90, cord_knots)]


def joint_state(arm, time, stamp):
    message = JointState()
    message.header.stamp = stamp
    message.name = list(Arm.JOINTS)
    message.position = arm.joints(tool_at(time), 0.5 * wave(time, 1, 1.0))
    return message


def fiber_array(time, stamp):
    message = FiberArray()
    message.header.stamp = stamp
    message.header.frame_id = "world"
    message.offsets = [0]
    for cable in CABLES:
        message.names.append(cable.name)
        message.radii.append(cable.radius)
        message.points += [Point(*point) for point in cable.points(time)]
        message.offsets.append(len(message.points))
    return message


def main():
    rospy.init_node("play_cell")
    try:
        arm = Arm(rospy.get_param("robot_description"))
    except (KeyError, ValueError, xml.etree.ElementTree.ParseError) as error:
        rospy.logfatal("robot_description: %s", error)
        return 1
    joints = rospy.Publisher("joint_states", JointState, queue_size=1)
    fibers = rospy.Publisher("fibers", FiberArray, queue_size=1)

    rate = rospy.Rate(RATE)
    while not rospy.is_shutdown():
        stamp = rospy.Time.now()
        time = stamp.to_sec() % PERIOD
        joints.publish(joint_state(arm, time, stamp))
        fibers.publish(fiber_array(time, stamp))
        try:
            rate.sleep()
        except rospy.ROSInterruptException:
            break
    return 0


if __name__ == "__main__":
    sys.exit(main())
