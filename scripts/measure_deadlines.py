#!/usr/bin/python3
"""Measures how well a running node keeps its deadline, and prints a table in Markdown.

Usage: measure_deadlines.py [--node /proximity] [--seconds 10] [--continuous] [--prediction S] DEADLINE...

Sets each deadline [s] in turn, 0 for none, listens to all answers for a while and leaves the node's parameters as they were.
`times` are those of the whole answer in deadlines, without one in ms; `kept` is the share of answers that took no more than
1.1 of them; `busy` the share in which updates alone took longer than the deadline; `complete` tells of each part how many
answers had all of it.
"""
import argparse
import sys

import dynamic_reconfigure.client
import rospy
from fiber_proximity.msg import ContactArray, Statistics, TimeToContact
from visualization_msgs.msg import MarkerArray

UPDATES = ("merge", "update", "environment_update")


def percentile(values, part):
    return sorted(values)[min(int(part * len(values)), len(values) - 1)]


def measure(node, seconds):
    answers = []
    subscribers = [rospy.Subscriber(node + "/statistics", Statistics, answers.append)]
    subscribers += [rospy.Subscriber(f"{node}/{topic}", kind, lambda message: None) for topic, kind in (
        ("contacts", ContactArray), ("environment_contacts", ContactArray), ("time_to_contact", TimeToContact),
        ("markers", MarkerArray))]
    rospy.sleep(1.0)
    answers.clear()
    rospy.sleep(seconds)
    for subscriber in subscribers:
        subscriber.unregister()
    return answers


def print_row(deadline, answers):
    unit = deadline or 1e-3
    times = [answer.total_time / unit for answer in answers]
    busy = [sum(time for part, time in zip(answer.parts, answer.part_times) if part in UPDATES) > unit for answer in answers]
    kept = [time <= 1.1 for time, is_busy in zip(times, busy) if not is_busy]
    parts = {}
    for answer in answers:
        for part, time, complete in zip(answer.parts, answer.part_times, answer.part_complete):
            parts.setdefault(part, []).append((time / unit, complete))
    told = ", ".join(f"{part} {percentile([time for time, _ in known], 0.5):.2g}"
                     + (f" ({sum(complete for _, complete in known) / len(known):.0%})" if deadline else "")
                     for part, known in parts.items())
    print(f"| {deadline:g} | {len(answers)} | {percentile(times, 0.5):.2f} | {percentile(times, 0.9):.2f} | "
          f"{percentile(times, 0.99):.2f} | {sum(kept) / len(kept) if deadline and kept else float('nan'):.1%} | "
          f"{sum(busy) / len(busy) if deadline else 0:.1%} | {told} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deadlines", metavar="DEADLINE", type=float, nargs="+")
    parser.add_argument("--node", default="/proximity")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--continuous", action="store_true")
    parser.add_argument("--prediction", type=float, default=0.0)
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("measure_deadlines", anonymous=True)
    client = dynamic_reconfigure.client.Client(options.node, timeout=10.0)
    before = client.get_configuration()
    print("| deadline [s] | answers | times p50 | p90 | p99 | kept | busy | parts, median (complete) |\n" + 8 * "|-" + "|")
    for deadline in options.deadlines:
        client.update_configuration({"deadline": deadline, "continuous": options.continuous, "prediction": options.prediction})
        answers = measure(options.node, options.seconds)
        if not answers:
            sys.exit(f"measure_deadlines.py: {options.node} gave no answer in {options.seconds:g} s")
        print_row(deadline, answers)
    client.update_configuration({name: before[name] for name in ("deadline", "continuous", "prediction")})


if __name__ == "__main__":
    main()
