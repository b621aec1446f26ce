#!/usr/bin/python3
"""Measures what the rviz panel Accuracy costs a running node, and by how much `~measure_settings` delays its answers.

Usage: measure_panel.py [--node /proximity] [--seconds 5] [--rounds 6]

The panel listens to `~statistics`. In turns, nobody or somebody does, and the node's processor time per answer is
compared; then, in turns, nothing or the settings are measured, and the time from the stamp of each answer's fibres to its
arrival is.
Somebody listens to `~contacts` and `~markers` all the time. Prints medians over the rounds and, of delays, percentiles.
"""
import argparse
import os
import statistics
import sys
import threading

import rosgraph
import rosnode
import rospy
from fiber_proximity.msg import ContactArray, Statistics
from fiber_proximity.srv import MeasureSettings
from visualization_msgs.msg import MarkerArray


def process_of(node):
    """The process of a node on this machine."""
    uri = rosnode.get_api_uri(rosgraph.Master("/measure_panel"), node)
    if uri is None:
        sys.exit(f"measure_panel.py: no node {node}")
    import xmlrpc.client
    return xmlrpc.client.ServerProxy(uri).getPid("/measure_panel")[2]


def processor_time(process):
    """[s] Of all its threads until now."""
    with open(f"/proc/{process}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Answers:
    """When the answers of a node come."""

    def __init__(self, node):
        self.delays = []
        self.subscribers = [rospy.Subscriber(f"{node}/contacts", ContactArray, self.take),
                            rospy.Subscriber(f"{node}/markers", MarkerArray, lambda message: None)]

    def take(self, message):
        self.delays.append((rospy.Time.now() - message.header.stamp).to_sec())

    def during(self, seconds):
        first = len(self.delays)
        rospy.sleep(seconds)
        return self.delays[first:]


def percentile(values, part):
    return sorted(values)[min(int(part * len(values)), len(values) - 1)]


def cost_of_listening(node, process, answers, seconds):
    """[s] of processor time per answer without and with somebody who listens to the statistics."""
    costs = []
    for listens in (False, True):
        subscriber = rospy.Subscriber(f"{node}/statistics", Statistics, lambda message: None) if listens else None
        rospy.sleep(0.5)
        before = processor_time(process)
        count = len(answers.during(seconds))
        costs.append((processor_time(process) - before) / max(count, 1))
        if subscriber is not None:
            subscriber.unregister()
    return costs


def delays_of_measuring(node, answers, seconds):
    """[s] Delays of answers without and with a measurement beside them."""
    alone = answers.during(seconds)
    measure = rospy.ServiceProxy(f"{node}/measure_settings", MeasureSettings)
    thread = threading.Thread(target=lambda: measure(seconds=seconds, noise=0.0))
    thread.start()
    beside = answers.during(seconds)
    thread.join()
    return alone, beside


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--node", default="/proximity")
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--rounds", type=int, default=6)
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("measure_panel", anonymous=True)
    process = process_of(options.node)
    answers = Answers(options.node)
    if not answers.during(2.0):
        sys.exit(f"measure_panel.py: {options.node} gave no answer in 2 s")
    costs, alone, beside = [], [], []
    for number in range(options.rounds):
        print(f"round {number + 1} of {options.rounds}", file=sys.stderr, flush=True)
        costs.append(cost_of_listening(options.node, process, answers, options.seconds))
        quiet, measured = delays_of_measuring(options.node, answers, options.seconds)
        alone += quiet
        beside += measured
    without = statistics.median(cost[0] for cost in costs)
    ratio = statistics.median(cost[1] / cost[0] for cost in costs)
    print(f"processor time of an answer: {1e3 * without:.3g} ms, {ratio:.3f} times that for listeners of statistics")
    for name, delays in (("alone", alone), ("while settings are measured", beside)):
        parts = ", ".join(f"{label} {1e3 * percentile(delays, part):.3g}"
                          for label, part in (("p50", 0.5), ("p90", 0.9), ("p99", 0.99), ("most", 1.0)))
        print(f"delay of {len(delays)} answers {name}: {parts} ms")


if __name__ == "__main__":
    main()
