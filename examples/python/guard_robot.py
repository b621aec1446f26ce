#!/usr/bin/python3
"""Stops a robot unless the proximity node's answers say that no cable is near what is around it, nor will be soon.

It fails closed: whatever is not certain is a reason to stop. docs/tutorials/stop_the_robot.md shows it at work, and
docs/tutorials/guard_a_gripper.md with `time`.

Parameters:
  ~distance      [m] required: it stops where the true distance may be smaller
  ~timeout (0.5) [s] it stops where no answer has come for so long, or the newest is of a moment so long ago
  ~time (0)      [s] it stops where something may touch within this time, as ~time_to_contact says; 0: it does not ask
  ~node (/proximity)      the node whose ~environment_contacts it listens to
  ~among_fibers (false)   to its ~contacts as well: cables near each other or themselves stop the robot, too
  ~objects ([])  names that must be among those of the answers, such as [robot/tool]
  ~hold (true)   a stop holds until ~reset is called; false: until answers are free again
  ~service (none)         a std_srvs/Trigger, called at the start and at each stop, again and again until it succeeds
Publishes ~stop (std_msgs/Bool), at each change and 20 times a second. Who hears nothing has to stop as well.
Serves ~reset (std_srvs/Trigger). It starts stopped.
"""
import math
import sys
import threading
import time

import rospy
from fiber_proximity.msg import Contact, ContactArray, TimeToContact
from std_msgs.msg import Bool
from std_srvs.srv import Trigger, TriggerResponse

PERIOD = 0.05  # [s] of ~stop
RETRY_AFTER = 0.5  # [s] the service that did not stop the robot is called again
PARAMETERS = 'distance', 'timeout', 'time', 'node', 'among_fibers', 'objects', 'hold', 'service'
REQUIRED = object()


def read(name, default, is_allowed, allowed):
    value = rospy.get_param('~' + name, default)
    if value is REQUIRED or not is_allowed(value):
        state = 'not set' if value is REQUIRED else repr(value)
        raise ValueError(f'parameter {rospy.resolve_name("~" + name)} is {state}, it must be {allowed}')
    return value


def check_names():
    """A parameter that is misspelt would leave a guard that is not the one that was meant."""
    for name in rospy.get_param('~', {}):
        if name not in PARAMETERS:
            raise ValueError(f'parameter {rospy.resolve_name("~" + name)} is unknown, it must be one of: '
                             f'{", ".join(PARAMETERS)}')


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def is_flag(value):
    return isinstance(value, bool)


def is_text(value):
    return isinstance(value, str)


def name_of(answer, contact):
    names = answer.object_names if contact.type_b == Contact.OBJECT else answer.fiber_names
    return f'{answer.fiber_names[contact.fiber_a]} and {names[contact.fiber_b]}'


def lack(answer):
    """What an answer does not know; None if it knows all."""
    if answer.complete and not answer.unknown:
        return None
    return 'not complete: ' + ('; '.join(answer.unknown) or 'it does not say why')


def objection(answer, distance, objects, is_about_objects):
    """Why no robot may move after this answer; None if it may."""
    if lack(answer):
        return lack(answer)
    for name in objects:
        if name not in answer.object_names:
            return f'{name} is not among the objects'
    if not answer.fiber_names:
        return 'there are no cables'
    # A number that is none is not above the distance either. Contacts may be nearer than the closest pair: with
    # ~continuous those that came and went since the answer before.
    bounds = [(answer.minimum_lower, answer.minimum if answer.has_minimum else None)]
    for bound, contact in bounds + [(contact.lower, contact) for contact in answer.contacts]:
        if not bound >= distance:
            pair = name_of(answer, contact) if contact else 'the closest pair'
            return f'{pair}: {1e3 * bound:.1f} mm, it must be {1e3 * distance:.1f} mm'
    if is_about_objects and answer.minimum_lower == math.inf:
        return 'no pair counts: there are no objects, or all may touch'
    return None


def objection_to_times(answer, time, among_fibers):
    """Why no robot may move after this prediction; None if it may."""
    if lack(answer):
        return lack(answer)
    if not answer.fiber_names:
        return 'there are no cables'
    if not answer.horizon >= time:
        return f'it looks {answer.horizon:g} s ahead, ~prediction must be at least {time:g} s'
    parts = [('a cable and an object', answer.environment)]
    if among_fibers:
        parts += [('two cables', answer.different_fibers), ('a cable and itself', answer.same_fiber)]
    for pair, told in parts:
        if told.touching:  # these are not predicted
            return f'{pair} are within the margin of {1e3 * answer.margin:g} mm'
        if not told.time_lower >= time:
            return f'{pair} may touch in {told.time_lower:.2f} s, it must be {time:g} s'
    return None


class Guard:
    def __init__(self):
        check_names()
        self.distance = read('distance', REQUIRED, lambda value: is_number(value) and value >= 0.0,
                             'a number of at least 0 [m]')
        self.timeout = read('timeout', 0.5, lambda value: is_number(value) and value > 0.0, 'a number above 0 [s]')
        self.holds = read('hold', True, is_flag, 'true or false')
        self.objects = read('objects', [], lambda value: isinstance(value, list) and all(map(is_text, value)),
                            'a list of names')
        node = read('node', '/proximity', lambda value: is_text(value) and value, 'the name of a node')
        time_ahead = read('time', 0, lambda value: is_number(value) and value >= 0.0, 'a number of at least 0 [s]')
        among_fibers = read('among_fibers', False, is_flag, 'true or false')
        # By topic: its type, and what may object to its answers.
        self.topics = {node + '/environment_contacts': (
            ContactArray, lambda answer: objection(answer, self.distance, self.objects, True))}
        if among_fibers:
            self.topics[node + '/contacts'] = (ContactArray, lambda answer: objection(answer, self.distance, [], False))
        if time_ahead > 0.0:
            self.topics[node + '/time_to_contact'] = (
                TimeToContact, lambda answer: objection_to_times(answer, time_ahead, among_fibers))
        service = read('service', '', is_text, 'the name of a service')

        self.lock = threading.RLock()
        self.heard = {}  # by topic: when, the stamp, the objection
        self.is_stopped = True
        self.has_to_call = threading.Event()
        self.has_to_call.set()  # at the start, too
        self.publisher = rospy.Publisher('~stop', Bool, queue_size=1)
        rospy.loginfo('free is what is %g mm apart by answers of the last %g s on %s; a stop holds until %s',
                      1e3 * self.distance, self.timeout, ' and '.join(self.topics),
                      'reset is called' if self.holds else 'they are free again')
        rospy.Service('~reset', Trigger, self.reset)
        if service:
            threading.Thread(target=self.call, args=(service,), daemon=True).start()
        for topic, (kind, _) in self.topics.items():
            rospy.Subscriber(topic, kind, self.receive, callback_args=topic, queue_size=10, buff_size=2**24)
        rospy.on_shutdown(lambda: self.publisher.publish(True))

    def receive(self, answer, topic):
        try:
            found = self.topics[topic][1](answer)
        except IndexError:  # of a fibre or an object without a name
            found = 'its indices are wrong'
        with self.lock:
            self.heard[topic] = time.monotonic(), answer.header.stamp, found
            self.look()

    def reason(self):
        """Why the robot has to stop now; None if it does not."""
        for topic in self.topics:
            if topic not in self.heard:
                return f'no answer on {topic} yet'
            arrival, stamp, found = self.heard[topic]
            if found:
                return f'{topic}: {found}'
            silence = time.monotonic() - arrival  # also where ROS's time stands still
            if silence > self.timeout:
                return f'no answer on {topic} for {silence:.1f} s'
            age = (rospy.get_rostime() - stamp).to_sec()
            if abs(age) > self.timeout:
                return f'the answer on {topic} is of {abs(age):.1f} s {"ago" if age > 0.0 else "ahead"}'
        return None

    def look(self):
        with self.lock:
            reason = self.reason()
            if reason and not self.is_stopped:
                self.is_stopped = True
                self.has_to_call.set()
                self.publisher.publish(True)  # before anything that may take time
                rospy.logwarn('stop: %s', reason)
                return
            if not reason and self.is_stopped and not self.holds:
                self.go()
            self.publisher.publish(self.is_stopped)

    def go(self):
        self.is_stopped = False
        rospy.loginfo('free')

    def reset(self, _):
        with self.lock:
            reason = self.reason()
            if not reason and self.is_stopped:
                self.go()
            self.publisher.publish(self.is_stopped)
        return TriggerResponse(success=not reason, message=reason or 'free')

    def call(self, service):
        """Calls the service, once for each stop, on a thread that may wait for it."""
        while True:
            self.has_to_call.wait()
            self.has_to_call.clear()
            while self.is_stopped and not self.has_succeeded(service):
                time.sleep(RETRY_AFTER)

    def has_succeeded(self, service):
        try:
            answer = rospy.ServiceProxy(service, Trigger)()
            if answer.success:
                return True
            problem = answer.message
        except (rospy.ServiceException, rospy.ROSException) as error:
            problem = error
        rospy.logerr('%s has not stopped the robot: %s', service, problem)
        return False


def main():
    rospy.init_node('guard')
    try:
        guard = Guard()
    except ValueError as error:
        rospy.logfatal('%s', error)
        return 2
    while not rospy.is_shutdown():
        guard.look()
        time.sleep(PERIOD)  # not ROS's time, which may stand still
    return 0


if __name__ == '__main__':
    sys.exit(main())
