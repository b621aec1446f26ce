#!/usr/bin/python3
"""Messages of ROS become arrays and come back, without a node."""
import io
import struct
import unittest

import genpy
import numpy as np
import rospy
import support
from geometry_msgs.msg import Point, Pose, PoseArray, PoseStamped, Vector3
from nav_msgs.msg import Path
from sensor_msgs.msg import PointCloud, PointCloud2, PointField
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

import fiber_proximity as fp
from fiber_proximity.msg import Contact, ContactArray, FiberArray


def packed(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def as_any(message):
    """What a subscriber to rospy.AnyMsg gets."""
    received = rospy.AnyMsg()
    received.deserialize(packed(message))
    received._connection_header = {'type': message._type}
    return received


def fiber_message():
    return FiberArray(header=Header(frame_id='world', stamp=genpy.Time(5, 6)), names=['a', 'ö'], offsets=[0, 2, 4],
                      points=[Point(0, 0, 0), Point(1, 0, 0), Point(0, 1, 0), Point(1, 1, 0.5)], radii=[0.1, 0.2])


class Messages(unittest.TestCase):

    def test_fibers_come_in(self):
        for message in (fiber_message(), as_any(fiber_message())):
            fibers = fp.from_msg(message)
            np.testing.assert_array_equal(fibers.points, [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.5]])
            np.testing.assert_array_equal(fibers.offsets, [0, 2, 4])
            np.testing.assert_array_equal(fibers.radii, [0.1, 0.2])
        without = fiber_message()
        without.radii = []
        np.testing.assert_array_equal(fp.from_msg(without, default_radius=0.3).radii, [0.3])

    def test_fibers_go_out(self):
        message = fiber_message()
        made = fp.to_msg(fp.from_msg(message), 'world', genpy.Time(5, 6), ['a', 'ö'])
        self.assertIsInstance(made, FiberArray)
        self.assertEqual(packed(made), packed(message))
        self.assertEqual(made, FiberArray().deserialize(packed(message)))
        self.assertEqual((made._type, made._md5sum, type(made).__name__), (message._type, message._md5sum, 'FiberArray'))
        # As rospy does before it sends.
        self.assertEqual(fp.from_msg(message).names, message.names)
        made = fp.to_msg(fp.from_msg(message), names=['a', 'b'])
        made.header.seq = 77
        self.assertEqual(FiberArray().deserialize(packed(made)).header.seq, 77)
        # What is changed counts.
        self.assertEqual(made.points[1].x, 1.0)
        made.names = ['c', 'd']
        made.points[1].x = 9.0
        again = FiberArray().deserialize(packed(made))
        self.assertEqual((again.names, again.points[1].x, again.header.seq), (['c', 'd'], 9.0, 77))
        made = fp.to_msg(fp.from_msg(message))
        made.radii = [0.7]
        self.assertEqual(FiberArray().deserialize(packed(made)).radii, (0.7,))
        self.assertIn('offsets: ', str(fp.to_msg(fp.from_msg(message))))

    def test_what_is_joined_comes_and_goes(self):
        sent = FiberArray(header=Header(frame_id='world', stamp=genpy.Time(5, 6)), names=[], offsets=[0, 3, 5],
                          points=[Point(0, 0, 0), Point(1, 0, 0), Point(1, 1, 0), Point(1, 1, 0), Point(2, 2, 0)], radii=[0.1],
                          closed=[1, 0], joints=[-1, -1, 4, 4, -1])
        for message in (sent, as_any(sent), FiberArray().deserialize(packed(sent))):
            fibers = fp.from_msg(message)
            np.testing.assert_array_equal(fibers.closed, [True, False])
            np.testing.assert_array_equal(fibers.joints, [-1, -1, 4, 4, -1])
            self.assertEqual(fibers.segment_count, 4)
            self.assertEqual(packed(fp.to_msg(fibers, 'world', genpy.Time(5, 6), fibers.names)),
                             packed(fp.to_msg(fp.from_msg(sent), 'world', genpy.Time(5, 6), fibers.names)))
            self.assertEqual(FiberArray().deserialize(packed(fp.to_msg(fibers))).joints, (-1, -1, 4, 4, -1))

    def test_contacts_come_and_go(self):
        contacts = fp.Engine(fp.Fibers(*support.random_fibers(np.random.default_rng(70)))).contacts(0.3)
        self.assertGreater(len(contacts), 10)
        message = fp.to_msg(contacts, 'world', genpy.Time(5, 6), names=list('abcdef'), margin=0.3)
        self.assertIsInstance(message, ContactArray)
        plain = ContactArray().deserialize(packed(message))
        self.assertEqual((plain.margin, plain.kernel, plain.complete, plain.fiber_names), (0.3, 'robust', True, list('abcdef')))
        self.assertEqual(len(plain.contacts), len(contacts))
        for contact, sent in zip(contacts, plain.contacts):
            self.assertEqual((sent.fiber_a, sent.segment_b, sent.distance), (contact['fiber_a'], contact['segment_b'],
                                                                            contact['distance']))
            self.assertEqual(sent.certain, contact['upper'] <= 0.3)
            self.assertEqual((sent.normal.x, sent.normal.y, sent.normal.z), tuple(contact['normal']))
        for received in (message, plain, as_any(plain)):
            back = fp.from_msg(received)
            self.assertEqual(back.dtype, fp.message_contact_dtype)
            for name in fp.contact_dtype.names:
                np.testing.assert_array_equal(back[name], contacts[name])
            self.assertTrue(np.isnan(back['gradients']).all())
        self.assertEqual(packed(fp.to_msg(back, 'world', genpy.Time(5, 6), names=list('abcdef'), margin=0.3)), packed(plain))

    def test_gradients_of_all_of_none_and_of_some(self):
        with_gradients = Contact(distance=1.0, id=7, age=2.5, time_lower=genpy.Time(3, 500000000), gone=True,
                                 certain=True, type_b=Contact.OBJECT, gradients=[Vector3(i, 0, -i) for i in range(4)])
        without = Contact(distance=2.0)
        for contacts in ([], [without] * 3, [with_gradients] * 3, [with_gradients, without, with_gradients],
                         [without, with_gradients], [Contact(distance=1.0, gradients=[Vector3()] * 2), with_gradients]):
            read = fp.from_msg(ContactArray(contacts=contacts))
            np.testing.assert_array_equal(read['distance'], [contact.distance for contact in contacts])
            for contact, item in zip(contacts, read):
                if len(contact.gradients) == 4:
                    np.testing.assert_array_equal(item['gradients'][:, 2], [0, -1, -2, -3])
                    self.assertEqual(tuple(item[['id', 'age', 'time_lower', 'gone', 'certain', 'type_b']]),
                                     (7, 2.5, 3.5, True, True, Contact.OBJECT))
                else:
                    self.assertTrue(np.isnan(item['gradients']).all())

    def test_clouds(self):
        points = np.array([[1, 2, 3], [4, 5, 6], [7, 8, 9], [10, 11, 12]], float)
        for kind, code in ((PointField.FLOAT32, '<f'), (PointField.FLOAT64, '<d')):
            size = struct.calcsize(code)
            step = 3 * size + 5
            rows = [b''.join(struct.pack('<B', 1) + b''.join(struct.pack(code, x) for x in point) + bytes(4)
                             for point in points[i:i + 2]) + bytes(3) for i in (0, 2)]  # padded rows
            cloud = PointCloud2(height=2, width=2, point_step=step, row_step=2 * step + 3, data=b''.join(rows), fields=[
                PointField(name=name, offset=1 + i * size, datatype=kind, count=1) for i, name in enumerate('xyz')])
            for message in (cloud, as_any(cloud)):
                fibers = fp.from_msg(message, 0.25)
                np.testing.assert_array_equal(fibers.points, points)
                self.assertEqual((len(fibers), fibers.radii.tolist()), (1, [0.25]))
        for change, words in (({'data': cloud.data[:-1]}, 'data has'), ({'is_bigendian': True}, 'big-endian'),
                              ({'fields': cloud.fields[:2]}, 'needs x, y and z'), ({'row_step': 3}, 'data has'),
                              ({'point_step': 4}, ''), ({'width': 2**31}, 'data has')):
            bad = as_any(cloud)
            bad = PointCloud2().deserialize(bad._buff)
            for name, value in change.items():
                setattr(bad, name, value)
            raised, message = support.message_of(lambda bad=bad: fp.from_msg(bad))
            self.assertIs(raised, ValueError, message)
            self.assertIn(words, message)

    def test_poses_and_paths(self):
        poses = [Pose(position=Point(i, 2 * i, 0)) for i in range(3)]
        for message in (PoseArray(poses=poses), Path(poses=[PoseStamped(pose=pose) for pose in poses])):
            for received in (message, as_any(message)):
                np.testing.assert_array_equal(fp.from_msg(received).points, [[0, 0, 0], [1, 2, 0], [2, 4, 0]])

    def test_point_clouds_and_markers(self):
        points = [Point(0, 0, 0), Point(1, 0, 0), Point(2, 0, 1)]
        marker = Marker(type=Marker.LINE_STRIP, points=points, pose=Pose(position=Point(0, 0, 3)))
        for message, height in ((PointCloud(points=points), 0), (marker, 3), (MarkerArray(markers=[marker]), 3)):
            for received in (message, as_any(message)):
                np.testing.assert_array_equal(fp.from_msg(received).points, [[0, 0, height], [1, 0, height], [2, 0, height + 1]])
        marker.type = Marker.SPHERE
        self.assertIn('marker /0 is a SPHERE', support.message_of(lambda: fp.from_msg(as_any(marker)))[1])

    def test_what_is_refused(self):
        for wrong in (Header(), 5, None, as_any(Header()), fp.Fibers([[0, 0, 0], [1, 0, 0]])):
            self.assertIs(support.message_of(lambda wrong=wrong: fp.from_msg(wrong))[0], TypeError)
        for wrong in (5, None, np.zeros(3), 'abc'):
            self.assertIs(support.message_of(lambda wrong=wrong: fp.to_msg(wrong))[0], TypeError)
        fibers = fp.from_msg(fiber_message())
        self.assertEqual(support.message_of(lambda: fp.to_msg(fibers, names=['a'])),
                         (ValueError, '1 names for 2 fibres; give one for each or none'))
        lost = fiber_message()
        lost.points[2].x = float('nan')
        self.assertIn('fibre 1, point 0: x is nan', support.message_of(lambda: fp.from_msg(lost))[1])
        lying = fiber_message()
        lying.offsets = [0, 2, 7]
        self.assertIs(support.message_of(lambda: fp.from_msg(lying))[0], ValueError)
        whole = as_any(fiber_message())
        for length in range(len(whole._buff)):
            cut = as_any(fiber_message())
            cut._buff = whole._buff[:length]
            self.assertIs(support.message_of(lambda cut=cut: fp.from_msg(cut))[0], ValueError)


if __name__ == '__main__':
    unittest.main()
