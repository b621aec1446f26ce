#!/usr/bin/python3
"""Prints the contacts that a proximity node publishes, a line per second.

Usage: print_contacts.py [TOPIC]     TOPIC: default /proximity/contacts; or
                                            /proximity/environment_contacts
Ends with SIGINT or SIGTERM; the exit code is 0 if there was a contact, 1 if there was none.
"""
import sys
import time

import rospy
from fiber_proximity.msg import Contact, ContactArray


class ContactPrinter:
    def __init__(self):
        self.seen_contact = False
        self.messages = 0
        self.start = None
        self.last_line = None

    def receive(self, message):
        now = time.monotonic()  # a bag played in a loop sets ROS's clock back
        self.start = self.start or now
        self.messages += 1
        self.seen_contact = self.seen_contact or bool(message.contacts)
        if self.last_line is not None and now - self.last_line < 1.0:
            return
        self.last_line = now
        try:
            print(self.line(message, now - self.start), flush=True)
        except BrokenPipeError:  # whoever read along has gone, e.g. head
            rospy.signal_shutdown("nobody reads")

    def line(self, message, elapsed):
        line = f"{elapsed:6.1f} s  {self.messages:5d} messages  {len(message.contacts):3d} contacts"
        if message.has_minimum:
            nearest = message.minimum
            names = (message.object_names if nearest.type_b == Contact.OBJECT else
                     message.fiber_names)
            line += (f"  closest: {message.fiber_names[nearest.fiber_a]}[{nearest.segment_a}] - "
                     f"{names[nearest.fiber_b]}[{nearest.segment_b}]  "
                     f"{1e3 * message.minimum_distance:+.1f} mm")
        return line


def main():
    arguments = rospy.myargv()[1:]
    if len(arguments) > 1 or any(argument.startswith("-") for argument in arguments):
        print(f"print_contacts.py: unknown arguments {arguments}; usage: print_contacts.py [TOPIC]",
              file=sys.stderr)
        return 2
    rospy.init_node("print_contacts", anonymous=True)
    printer = ContactPrinter()
    rospy.Subscriber(arguments[0] if arguments else "/proximity/contacts", ContactArray,
                     printer.receive, queue_size=10)
    rospy.spin()
    sys.stdout = None  # flushing it at exit would complain of a reader that has gone
    return 0 if printer.seen_contact else 1


if __name__ == "__main__":
    sys.exit(main())
