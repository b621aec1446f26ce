#!/usr/bin/python3
"""Measures how much predictions delay a running cable_sim, and prints a table in Markdown.

Usage: measure_predictions.py [--node /cable_sim] [--duration 5] [--predictions 4] [--rounds 5]

In turns the scene runs alone, and beside as many predictions at once as told, each of which looks so far ahead [s].
`frames` are those published per second, `gap` the time from one to the next [ms], median and 99th percentile;
`prediction` is the median of what a prediction takes [s].
"""
import argparse
import sys
import threading
import time

import rospy
from fiber_proximity.srv import Predict, PredictRequest


def percentile(values, part):
    return sorted(values)[min(int(part * len(values)), len(values) - 1)]


class Frames:
    """When frames came [s]."""

    def __init__(self, node):
        self.times = []
        self.subscriber = rospy.Subscriber(node + "/fibers", rospy.AnyMsg, self.take, queue_size=100)

    def take(self, _message):
        self.times.append(time.monotonic())

    def between(self, begin, end):
        return [each for each in list(self.times) if begin <= each <= end]


def predict_at_once(service, request, count):
    """Returns what each took [s]."""
    taken = []

    def ask():
        begin = time.monotonic()
        answer = service(request)
        if not answer.success:
            rospy.logerr("~predict: %s", answer.message)
        taken.append(time.monotonic() - begin)

    threads = [threading.Thread(target=ask) for _ in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return taken


def print_row(name, spans, frames, taken):
    gaps = []
    for begin, end in spans:
        times = frames.between(begin, end)
        gaps += [1e3 * (after - before) for before, after in zip(times, times[1:])]
    if not gaps:
        sys.exit("measure_predictions.py: too few frames came")
    rate = 1e3 * len(gaps) / sum(gaps)
    told = f"{percentile(taken, 0.5):.2f}" if taken else ""
    print(f"| {name} | {rate:.1f} | {percentile(gaps, 0.5):.2f} | {percentile(gaps, 0.99):.2f} | {told} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--node", default="/cable_sim")
    parser.add_argument("--duration", type=float, default=5.0)
    parser.add_argument("--predictions", type=int, default=4)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node("measure_predictions", anonymous=True)
    frames = Frames(options.node)
    try:
        rospy.wait_for_service(options.node + "/predict", timeout=10.0)
    except rospy.ROSException as error:
        sys.exit(f"measure_predictions.py: {error}")
    service = rospy.ServiceProxy(options.node + "/predict", Predict)
    request = PredictRequest(duration=options.duration, margin=0.1)
    alone, beside, taken = [], [], []
    rospy.sleep(1.0)
    for _ in range(options.rounds):
        begin = time.monotonic()
        took = predict_at_once(service, request, options.predictions)
        middle = time.monotonic()
        rospy.sleep(middle - begin)
        taken += took
        beside.append((begin, middle))
        alone.append((middle, time.monotonic()))
    print("| scene | frames | gap, median | gap, 99 % | prediction |\n" + 5 * "|-" + "|")
    print_row("alone", alone, frames, [])
    print_row(f"beside {options.predictions} predictions", beside, frames, taken)


if __name__ == "__main__":
    main()
