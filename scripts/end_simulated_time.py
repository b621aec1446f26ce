#!/usr/bin/python3
"""Deletes the parameter /use_sim_time when it ends: a launch file that sets it cannot take it back.

Nodes read it when they start. Left behind, it has time stand still for all that are started later, as nothing publishes
/clock any more.
"""
import rospy


def main():
    rospy.init_node("end_simulated_time")

    def forget():
        try:
            rospy.delete_param("/use_sim_time")
        except (KeyError, OSError, rospy.ROSException):
            pass  # it is gone already, or the master is

    rospy.on_shutdown(forget)
    rospy.spin()


if __name__ == "__main__":
    main()
