#!/usr/bin/python3
"""Plays a tracker such as TrackDLO: a cable with a loop that sways 0.6 m before a camera.

Publishes the ordered points of the cable's axis as a PointCloud2, in the camera's optical frame (x to
the right, y down, z forward), which nobody publishes a transform of.

Parameters: ~topic (/trackdlo/results_pc), ~frame_id (camera_color_optical_frame), ~rate (15 Hz).
"""
import threading

import numpy
import rospy
from sensor_msgs import point_cloud2
from std_msgs.msg import Header

POINTS = 45
PERIOD = 8.0  # [s]
DEPTH = 0.6  # [m] before the camera


def cable(time):
    """Points of the axis [m], POINTS by 3: the strands cross where t is 1.1 and -1.1."""
    phase = 2 * numpy.pi * time / PERIOD
    t = numpy.linspace(-1.6, 1.6, POINTS)
    x = 0.10 * (t ** 3 - 1.2 * t) + 0.02 * numpy.sin(phase)
    y = 0.10 * t ** 2 - 0.12
    gap = 0.016 + 0.008 * numpy.cos(phase)  # of the axes, where they cross
    return numpy.stack([x, y, DEPTH + gap * t / 2.2], axis=-1)


def warn_where_time_stands_still():
    """To be called every now and then; nothing is published before the first /clock."""
    if rospy.get_param("/use_sim_time", False) and rospy.Time.now().is_zero():
        rospy.logwarn_once("time stands still: the parameter /use_sim_time is true, and nothing publishes /clock. "
                           "`rosparam set /use_sim_time false` makes it go on for nodes that are started then")


def main():
    rospy.init_node("play_tracker")
    timer = threading.Timer(5.0, warn_where_time_stands_still)  # as rospy's own stand still, too
    timer.daemon = True
    timer.start()
    publisher = rospy.Publisher(rospy.get_param("~topic", "/trackdlo/results_pc"),
                                point_cloud2.PointCloud2, queue_size=1)
    header = Header(frame_id=rospy.get_param("~frame_id", "camera_color_optical_frame"))
    rate = rospy.Rate(rospy.get_param("~rate", 15.0))
    while not rospy.is_shutdown():
        header.stamp = rospy.Time.now()
        publisher.publish(point_cloud2.create_cloud_xyz32(header, cable(header.stamp.to_sec())))
        try:
            rate.sleep()
        except rospy.ROSInterruptException:
            return


if __name__ == "__main__":
    main()
