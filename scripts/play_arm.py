#!/usr/bin/python3
"""Plays the arm of launch/arm_harness.launch: it stands still, and goes where it is told.

Subscribes to ~goal (sensor_msgs/JointState: names and positions, of some joints or all), publishes joint_states. A goal
takes as long as its longest way takes at ~speed [rad/s], slower at both ends; examples/python/predict_motion.py knows
that. With ~guarded it moves only while /guard/stop says false, and stands where that does not come.
"""
import sys
import time

import numpy
import rospy
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool

JOINTS = ("waist", "shoulder", "elbow", "wrist", "roll")
HOME = (0.0, 0.3, 1.3, 1.5416, 0.0)  # [rad] the hand points down
RATE = 50.0  # [Hz]
SILENCE = 0.2  # [s] for which it goes on without a word of the guard


class Arm:
    def __init__(self, speed, is_guarded):
        self.speed = speed
        self.is_guarded = is_guarded
        self.may_move_until = 0.0
        self.start = self.goal = numpy.array(HOME)
        self.gone = 1.0  # part of the time that the way takes
        self.duration = 1.0
        self.last = time.monotonic()
        self.states = rospy.Publisher("joint_states", JointState, queue_size=1)
        rospy.Subscriber("~goal", JointState, self.take, queue_size=1)
        if is_guarded:
            rospy.Subscriber("/guard/stop", Bool, self.hear, queue_size=1)

    def positions(self):
        share = self.gone ** 2 * (3.0 - 2.0 * self.gone)
        return self.start + share * (self.goal - self.start)

    def take(self, message):
        unknown = [name for name in message.name if name not in JOINTS]
        if unknown or len(message.name) != len(message.position) or not numpy.isfinite(message.position).all():
            rospy.logwarn("~goal: it must be finite positions of some of %s", ", ".join(JOINTS))
            return
        start = self.positions()
        goal = self.goal.copy()
        for name, position in zip(message.name, message.position):
            goal[JOINTS.index(name)] = position
        self.duration = max(1e-3, 1.5 * numpy.abs(goal - start).max() / self.speed)
        self.start, self.goal, self.gone = start, goal, 0.0

    def hear(self, stop):
        self.may_move_until = 0.0 if stop.data else time.monotonic() + SILENCE

    def move(self):
        now = time.monotonic()
        if not self.is_guarded or now < self.may_move_until:
            self.gone = min(1.0, self.gone + (now - self.last) / self.duration)
        self.last = now
        state = JointState(name=list(JOINTS), position=list(self.positions()))
        state.header.stamp = rospy.Time.now()
        self.states.publish(state)


def main():
    rospy.init_node("play_arm")
    speed = rospy.get_param("~speed", 0.6)
    if not speed > 0.0:
        rospy.logfatal("~speed is %s, it must be above 0 rad/s", speed)
        return 1
    arm = Arm(speed, rospy.get_param("~guarded", False))
    rate = rospy.Rate(RATE)
    while not rospy.is_shutdown():
        arm.move()
        try:
            rate.sleep()
        except rospy.ROSInterruptException:
            break
    return 0


if __name__ == "__main__":
    sys.exit(main())
