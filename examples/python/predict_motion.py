#!/usr/bin/python3
"""Asks cable_sim what comes of a motion of the arm of launch/arm_harness.launch, and makes it if nothing does.

Usage: predict_motion.py JOINT=RADIANS... [--clearance M] [--pull N] [--go]
  --clearance M   [m] fibres must be so far from objects; default: 0.02
  --pull N        [N] no clip may pull more; default: 50
  --go            moves the arm if the motion is free
Prints what the cables do on the way, and one of these as the last line: "free", "not free: ...". The exit code is 0
if it is free, 1 if it is not, 2 for what cannot be asked.
"""
import argparse
import sys

import numpy as np
import rospy
from fiber_proximity import Robot
from fiber_proximity.msg import Contact, FiberArray, HoldTrajectory
from fiber_proximity.srv import Predict, PredictRequest
from geometry_msgs.msg import Pose
from sensor_msgs.msg import JointState

STEP = 0.05  # [s] between poses of links
MAX_DURATION = 60.0  # [s] of a motion
AFTERWARDS = 0.5  # [s] cables swing on when the arm stands
CLIPS = ('shoulder_link', 'upper_arm', 'forearm', 'hand')  # the links that hold fibres, in config/sim/arm_harness.yaml


def read_goals(texts):
    goals = {}
    for text in texts:
        name, _, value = text.partition('=')
        try:
            goals[name] = float(value)
        except ValueError:
            goals[name] = np.nan
        if not np.isfinite(goals[name]):
            raise ValueError(f"a goal is JOINT=RADIANS, not '{text}'")
    return goals


def way(start, goal, speed):
    """The motion of scripts/play_arm.py: times [s], and the positions of joints at these."""
    joints = sorted(start)
    begin = np.array([start[name] for name in joints])
    change = np.array([goal.get(name, start[name]) for name in joints]) - begin
    duration = max(STEP, 1.5 * np.abs(change).max() / speed)
    if not duration <= MAX_DURATION:
        raise ValueError(f'the motion takes {duration:.3g} s, it may take at most {MAX_DURATION:g} s')
    times = np.append(np.arange(STEP, duration, STEP), duration)
    part = times / duration
    shares = part ** 2 * (3.0 - 2.0 * part)
    return times, [dict(zip(joints, begin + share * change)) for share in shares]


def to_pose(matrix):
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = matrix[:3, 3]
    # The largest of the four is found first (Shepperd 1978).
    r = matrix[:3, :3]
    squares = np.array([np.trace(r), r[0, 0], r[1, 1], r[2, 2]])
    k = int(squares.argmax())
    if k == 0:
        q = np.array([1 + np.trace(r), r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    else:
        i = k - 1
        j, l = (i + 1) % 3, (i + 2) % 3
        q = np.zeros(4)
        q[0] = r[l, j] - r[j, l]
        q[1 + i] = 1 + r[i, i] - r[j, j] - r[l, l]
        q[1 + j] = r[j, i] + r[i, j]
        q[1 + l] = r[l, i] + r[i, l]
    pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z = q / np.linalg.norm(q)
    return pose


def request(robot, start, goal, speed, margin):
    times, joints = way(start, goal, speed)
    poses = [robot.poses(each) for each in joints]
    asked = PredictRequest(duration=times[-1] + AFTERWARDS, margin=margin)
    for link in CLIPS:
        asked.trajectories.append(
            HoldTrajectory(frame=link, times=times, poses=[to_pose(pose[link]) for pose in poses]))
    return asked


def objections(answer, names, clearance, pull):
    """What speaks against the motion; prints what it looks at."""
    found = []
    for contact, when in zip(answer.clearances, answer.clearance_times):
        is_object = contact.type_b == Contact.OBJECT
        other = (answer.object_names if is_object else names)[contact.fiber_b]
        pair = f'{names[contact.fiber_a]} - {other}'
        print(f'least distance  {pair}: {1e3 * contact.distance:.1f} mm at {when:.2f} s')
        if is_object and contact.distance < clearance:
            found.append(f'{pair}: {1e3 * contact.distance:.1f} mm')
    for touch in answer.touches:
        other = (answer.object_names if touch.type_b == Contact.OBJECT else names)[touch.body_b]
        print(f'touch           {names[touch.fiber]} - {other}: {touch.force:.2f} N, '
              f'{touch.first:.2f} to {touch.last:.2f} s')
    for hold in sorted(answer.holds, key=lambda each: -each.force)[:3]:
        print(f'clip            {names[hold.fiber]}[{hold.index}]: {hold.force:.1f} N at {hold.time:.2f} s')
        if hold.force > pull:
            found.append(f'the clip at {names[hold.fiber]}[{hold.index}] pulls {hold.force:.1f} N')
    print(f'computed {answer.time:.2f} s in {answer.computing_time:.2f} s')
    return found


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split('\n\n')[1])
    parser.add_argument('goal', nargs='+')
    parser.add_argument('--clearance', type=float, default=0.02)
    parser.add_argument('--pull', type=float, default=50.0)
    parser.add_argument('--go', action='store_true')
    arguments = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node('predict_motion', anonymous=True)
    try:
        goal = read_goals(arguments.goal)
        robot = Robot(rospy.get_param('robot_description'))
        state = rospy.wait_for_message('joint_states', JointState, timeout=10.0)
        start = dict(zip(state.name, state.position))
        robot.poses({**start, **goal})
        rospy.wait_for_service('cable_sim/predict', timeout=10.0)
        speed = rospy.get_param('play_arm/speed', 0.6)
        names = rospy.wait_for_message('cable_sim/fibers', FiberArray, timeout=10.0).names
        answer = rospy.ServiceProxy('cable_sim/predict', Predict)(
            request(robot, start, goal, speed, max(0.1, arguments.clearance)))
    except (ValueError, KeyError, rospy.ROSException, rospy.ServiceException) as error:
        print(f'predict_motion.py: {error}', file=sys.stderr)
        return 2
    if not answer.success:
        print(f'predict_motion.py: {answer.message}', file=sys.stderr)
        return 2
    against = objections(answer, names, arguments.clearance, arguments.pull)
    if against:
        print(f'not free: {"; ".join(against)}')
        return 1
    if arguments.go:
        goals = rospy.Publisher('play_arm/goal', JointState, queue_size=1, latch=True)
        while goals.get_num_connections() == 0 and not rospy.is_shutdown():
            rospy.sleep(0.05)
        goals.publish(JointState(name=list(goal), position=list(goal.values())))
        rospy.sleep(0.5)
    print('free')
    return 0


if __name__ == '__main__':
    sys.exit(main())
