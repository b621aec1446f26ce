#!/usr/bin/python3
"""The example that guards a robot: each answer that is not certain to be free stops it, and so does silence."""
import math
import os
import subprocess
import threading
import time
import unittest

import rospkg
import rospy
import rostest
from std_msgs.msg import Bool
from std_srvs.srv import Trigger, TriggerResponse

from fiber_proximity.msg import Contact, ContactArray, PredictedContact, TimeToContact

PATIENCE = 120.0  # [s] that only a broken guard needs
PATIENT = '_timeout:=1000'  # where silence is not what a test is about
SCRIPT = os.path.join(rospkg.RosPack().get_path('fiber_proximity'), 'examples', 'python', 'guard_robot.py')


def free(**changes):
    """An answer that lets the robot move: its tool is 60 mm away from a cable."""
    nearest = Contact(type_b=Contact.OBJECT, distance=0.06, lower=0.06, upper=0.06)
    answer = ContactArray(fiber_names=['cable'], object_names=['robot/tool'], complete=True, has_minimum=True,
                          minimum_distance=0.06, minimum_lower=0.06, minimum_upper=0.06, minimum=nearest)
    answer.header.stamp = rospy.Time.now()
    for name, value in changes.items():
        setattr(answer, name, value)
    return answer


def free_times(**changes):
    """A prediction that lets the robot move: nothing is touched in the half second that it looks ahead."""
    parts = {name: PredictedContact(time_lower=0.5, time_upper=math.inf, complete=True)
             for name in ('same_fiber', 'different_fibers', 'environment')}
    answer = TimeToContact(fiber_names=['cable'], object_names=['robot/tool'], margin=0.01, horizon=0.5, complete=True,
                           **parts)
    answer.header.stamp = rospy.Time.now()
    for name, value in changes.items():
        setattr(answer, name, value)
    return answer


class GuardTest(unittest.TestCase):

    def setUp(self):
        self.changed = threading.Condition()
        self.states = []  # what the guard has published
        self.log = ''

    def start(self, *arguments):
        self.start_process('_distance:=0.05', *arguments)
        self.publisher = rospy.Publisher('/proximity/environment_contacts', ContactArray, queue_size=100)
        self.addCleanup(self.publisher.unregister)
        listener = rospy.Subscriber('/guard/stop', Bool, self.receive)
        self.addCleanup(listener.unregister)
        self.wait_until(lambda: self.publisher.get_num_connections() == 1 and self.states, 'the guard is there')
        self.assertTrue(self.states[0], 'it starts stopped')

    def start_process(self, *arguments):
        if rospy.has_param('/guard'):
            rospy.delete_param('/guard')  # of the guard before
        self.guard = subprocess.Popen([SCRIPT, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        reader = threading.Thread(target=self.read_log)
        reader.start()
        self.addCleanup(reader.join)
        self.addCleanup(self.guard.kill)

    def read_log(self):
        with self.guard.stdout as lines:
            for line in lines:
                self.log += line

    def receive(self, message):
        with self.changed:
            self.states.append(message.data)
            self.changed.notify_all()

    def wait_until(self, is_true, what):
        end = time.monotonic() + PATIENCE
        with self.changed:
            while not is_true():
                self.assertLess(time.monotonic(), end, f'waited in vain until {what}')
                self.changed.wait(0.1)

    def wait_for_state(self, is_stopped):
        """For what is published from now on: twice, as the first may have been on its way."""
        with self.changed:
            first = len(self.states)
        self.wait_until(lambda: self.states[first + 2:] and self.states[-1] == is_stopped, f'stop is {is_stopped}')

    def reset(self):
        return rospy.ServiceProxy('/guard/reset', Trigger)()

    def set_free(self):
        """Until it is, as the answer and the call come on ways of their own."""
        self.publisher.publish(free())
        self.wait_until(lambda: self.reset().success, 'the reset is accepted')
        self.wait_for_state(False)

    def expect_stop(self, answer, reason):
        self.set_free()
        self.publisher.publish(answer)
        self.wait_for_state(True)
        refused = self.reset()
        self.assertFalse(refused.success, reason)
        self.assertIn(reason, refused.message)

    def test_nothing_stops_it_while_answers_are_free(self):
        self.start(PATIENT)
        self.set_free()
        with self.changed:
            self.states.clear()
        for _ in range(50):
            self.publisher.publish(free())
            time.sleep(0.02)
        self.wait_until(lambda: len(self.states) > 50, 'every answer is heard')
        self.assertNotIn(True, self.states)

    def test_what_is_not_certain_stops_it(self):
        self.start(PATIENT)
        nearer = Contact(type_b=Contact.OBJECT, lower=0.049, gone=True)
        for answer, reason in [
                (free(complete=False), 'not complete'),
                (free(complete=False, unknown=['tool since 2: no transform']), 'tool since 2: no transform'),
                (free(unknown=['a cloud']), 'a cloud'),
                (free(minimum_lower=0.049), 'cable and robot/tool: 49.0 mm'),
                (free(minimum_lower=-math.inf), '-inf mm'),
                (free(minimum_lower=math.nan), 'nan mm'),
                (free(contacts=[nearer]), '49.0 mm'),
                (free(contacts=[Contact(type_b=Contact.OBJECT, fiber_b=7, lower=0.01)]), 'indices'),
                (free(fiber_names=[]), 'no cables'),
                (free(object_names=[], has_minimum=False, minimum_lower=math.inf), 'no pair counts'),
                (ContactArray(), 'not complete')]:
            with self.subTest(reason):
                self.expect_stop(answer, reason)

    def test_a_pair_at_the_distance_is_free(self):
        self.start(PATIENT)
        self.publisher.publish(free(minimum_lower=0.05))
        self.wait_until(lambda: self.reset().success, 'the reset is accepted')

    def test_objects_that_are_named_must_be_there(self):
        self.start(PATIENT, '_objects:=[robot/tool]')
        self.expect_stop(free(object_names=['table']), 'robot/tool is not among the objects')

    def test_silence_stops_it(self):
        self.start('_timeout:=0.5')
        self.publisher.publish(free())
        self.wait_until(lambda: 'no answer on /proximity/environment_contacts for' in self.reset().message,
                        'silence is noticed')
        self.wait_for_state(True)

    def test_answers_about_another_moment_stop_it(self):
        self.start('_timeout:=100')
        for seconds, reason in [(-101.0, 'ago'), (101.0, 'ahead')]:
            answer = free()
            answer.header.stamp += rospy.Duration(seconds)
            self.expect_stop(answer, reason)

    def test_a_stop_holds_until_it_is_reset(self):
        self.start(PATIENT)
        self.expect_stop(free(complete=False), 'not complete')
        self.publisher.publish(free())
        self.wait_for_state(True)
        self.set_free()

    def test_without_hold_it_goes_on_by_itself(self):
        self.start(PATIENT, '_hold:=false')
        for is_free in (True, False, True):
            self.publisher.publish(free(complete=is_free))
            self.wait_for_state(not is_free)

    def test_cables_among_themselves_count_where_they_are_asked_for(self):
        self.start(PATIENT, '_among_fibers:=true')
        self.publisher.publish(free())
        self.wait_until(lambda: self.reset().message == 'no answer on /proximity/contacts yet', 'the other is missed')
        among = rospy.Publisher('/proximity/contacts', ContactArray, queue_size=100)
        self.addCleanup(among.unregister)
        self.wait_until(lambda: among.get_num_connections() == 1, 'the guard listens')
        # A straight cable has no pair of segments that could touch.
        among.publish(free(object_names=[], has_minimum=False, minimum_lower=math.inf))
        self.wait_until(lambda: self.reset().success, 'the reset is accepted')
        among.publish(free(complete=False))
        self.wait_for_state(True)

    def test_what_may_touch_soon_stops_it_where_it_is_asked_for(self):
        self.start(PATIENT, '_time:=0.3')
        self.publisher.publish(free())
        self.wait_until(lambda: self.reset().message == 'no answer on /proximity/time_to_contact yet',
                        'the prediction is missed')
        times = rospy.Publisher('/proximity/time_to_contact', TimeToContact, queue_size=100)
        self.addCleanup(times.unregister)
        self.wait_until(lambda: times.get_num_connections() == 1, 'the guard listens')
        soon = PredictedContact(time_lower=0.29, time_upper=0.31, expected=True, complete=True)
        near = PredictedContact(time_lower=0.5, touching=1, complete=True)
        for answer, reason in [
                (free_times(environment=soon), 'a cable and an object may touch in 0.29 s, it must be 0.3 s'),
                (free_times(environment=near), 'within the margin of 10 mm'),
                (free_times(environment=PredictedContact(time_lower=math.nan, complete=True)), 'nan s'),
                (free_times(complete=False, unknown=['robot/tool since 2: no transform']), 'robot/tool since 2'),
                (free_times(horizon=0.2), 'it looks 0.2 s ahead'),
                (free_times(fiber_names=[]), 'no cables'),
                (TimeToContact(), 'not complete')]:
            with self.subTest(reason):
                times.publish(free_times(different_fibers=soon, same_fiber=near))  # nobody asked about these
                self.set_free()
                times.publish(answer)
                self.wait_for_state(True)
                refused = self.reset()
                self.assertFalse(refused.success, reason)
                self.assertIn(reason, refused.message)

    def test_a_service_is_called_at_each_stop_until_it_succeeds(self):
        answers = [False, True, True]
        called = []

        def stop(_):
            with self.changed:
                called.append(answers[len(called)])
                self.changed.notify_all()
                return TriggerResponse(success=called[-1], message='the brake is stuck')

        service = rospy.Service('/robot/stop', Trigger, stop)
        self.addCleanup(service.shutdown)
        self.start(PATIENT, '_service:=/robot/stop')
        self.wait_until(lambda: len(called) == 2, 'it is called again')
        self.set_free()
        self.publisher.publish(free(complete=False))
        self.wait_until(lambda: len(called) == 3, 'it is called at the next stop')
        self.wait_until(lambda: 'the brake is stuck' in self.log, 'the log tells why')

    def test_bad_parameters_end_it(self):
        for arguments, line in [
                ([], 'parameter /guard/distance is not set, it must be a number of at least 0 [m]'),
                (['_distance:=-1'], 'parameter /guard/distance is -1, it must be'),
                (['_distance:=.nan'], 'parameter /guard/distance is nan, it must be'),
                (['_distance:=5mm'], "parameter /guard/distance is '5mm', it must be"),
                (['_distance:=0.05', '_timeout:=0'], 'parameter /guard/timeout is 0, it must be a number above 0 [s]'),
                (['_distance:=0.05', '_hold:=1'], 'parameter /guard/hold is 1, it must be true or false'),
                (['_distance:=0.05', '_objects:=tool'], "parameter /guard/objects is 'tool', it must be a list"),
                (['_distance:=0.05', '_time:=-1'], 'parameter /guard/time is -1, it must be a number of at least 0 [s]'),
                (['_distance:=0.05', '_timout:=1'], 'parameter /guard/timout is unknown')]:
            with self.subTest(line):
                self.log = ''
                self.start_process(*arguments)
                self.assertEqual(self.guard.wait(PATIENCE), 2)
                self.wait_until(lambda: line in self.log, line)


if __name__ == '__main__':
    rospy.init_node('guard_robot_test')
    rostest.rosrun('fiber_proximity', 'guard_robot_test', GuardTest)
