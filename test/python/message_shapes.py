#!/usr/bin/python3
"""Messages are known by their shape: of classes as rclpy generates them, where no ROS is installed."""
import array
import pathlib
import re
import sys
import unittest
from types import SimpleNamespace as Part
from unittest import mock

import numpy as np

import fiber_proximity as fp

LINE_STRIP, LINE_LIST, CUBE_LIST, SPHERE_LIST, POINTS, SPHERE, TEXT = 4, 5, 6, 7, 8, 2, 9
CURVE = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.5), (2.0, 0.25, 0.0)]


def message(name, **fields):
    """An object of a class of this name; rclpy's have their fields behind properties, no `_type` and no `serialize`."""
    kind = type(name, (), {'__slots__': ['_' + field for field in fields],
                           **{field: property(lambda self, field=field: getattr(self, '_' + field)) for field in fields}})
    made = kind()
    for field, value in fields.items():
        setattr(made, '_' + field, value)
    return made


def point(x, y, z):
    return Part(x=x, y=y, z=z)


def header(frame='world'):
    return Part(frame_id=frame, stamp=Part(sec=1, nanosec=2))


def pose(x=0.0, y=0.0, z=0.0, orientation=(0.0, 0.0, 0.0, 1.0)):
    return Part(position=point(x, y, z), orientation=Part(**dict(zip('xyzw', orientation))))


def cloud(points, form='f4', convert=bytes):
    record = np.dtype({'names': ['rgb', 'z', 'x', 'y'], 'formats': ['u4', form, form, form], 'offsets': [0, 4, 12, 20],
                       'itemsize': 32})
    data = np.zeros(len(points), record)
    for i, name in enumerate('xyz'):
        data[name] = np.asarray(points)[:, i]
    datatype = {'f4': 7, 'f8': 8}[form]
    fields = [Part(name=name, offset=record.fields[name][1], datatype=6 if name == 'rgb' else datatype, count=1)
              for name in record.names]
    return message('PointCloud2', header=header(), height=1, width=len(points), fields=fields, is_bigendian=False,
                   point_step=32, row_step=32 * len(points), data=convert(data.tobytes()), is_dense=True)


def marker(kind, points=CURVE, name=('cable', 0), action=0, where=None, frame='world'):
    return message('Marker', header=header(frame), ns=name[0], id=name[1], type=kind, action=action, pose=where or pose(),
                   points=[point(*p) for p in points], scale=point(0.1, 0.1, 0.1), texture_resource='')


def markers(*items):
    return message('MarkerArray', markers=list(items))


class MessageShapes(unittest.TestCase):

    def refuse(self, kind, words, call):
        with self.assertRaisesRegex(kind, re.escape(words)) as caught:
            call()
        self.assertNotIn('\n', str(caught.exception))

    def expect(self, sent, *curves, **options):
        fibers = fp.from_msg(sent, **options)
        self.assertEqual(len(fibers), len(curves))
        for fiber, curve in zip(fibers, curves):
            np.testing.assert_allclose(fiber, curve, rtol=0, atol=1e-15)
        return fibers

    def test_messages_of_points(self):
        for convert in (bytes, lambda data: array.array('B', data), lambda data: np.frombuffer(data, 'u1'), list, bytearray):
            self.expect(cloud(CURVE, convert=convert), CURVE)
        self.expect(cloud(np.array(CURVE) / 3, 'f8'), np.array(CURVE) / 3)
        self.expect(message('PointCloud', header=header(), points=[point(*p) for p in CURVE], channels=[]), CURVE)
        self.expect(message('PoseArray', header=header(), poses=[pose(*p) for p in CURVE]), CURVE)
        path = [Part(header=header(frame), pose=pose(*p)) for frame, p in zip(('', 'world', ''), CURVE)]
        np.testing.assert_array_equal(self.expect(message('Path', header=header(), poses=path), CURVE,
                                                  default_radius=0.25).radii, [0.25])
        path[2].header.frame_id = 'camera'
        self.refuse(ValueError, "pose 2 is in frame 'camera', the path in 'world'",
                    lambda: fp.from_msg(message('Path', header=header(), poses=path)))

    def test_fiber_arrays(self):
        for offsets, radii in ((array.array('I', [0, 2, 5]), array.array('d', [0.1, 0.2])),
                               (np.array([0, 2, 5], 'u4'), np.array([0.1, 0.2])), ([0, 2, 5], [0.1, 0.2])):
            sent = message('FiberArray', header=header(), names=['a', 'b'], offsets=offsets,
                           points=[point(*p) for p in CURVE[:2] + CURVE], radii=radii)
            np.testing.assert_array_equal(self.expect(sent, CURVE[:2], CURVE).radii, [0.1, 0.2])
        for closed in ([1, 0], b'\x01\x00', np.array([1, 0], 'u1')):
            sent = message('FiberArray', header=header(), names=[], offsets=[0, 3, 5], radii=[0.1], closed=closed,
                           joints=np.array([-1, -1, 4, 4, -1], 'i4'),
                           points=[point(*p) for p in CURVE[:3] + CURVE[2:3] + [(9, 9, 9)]])
            np.testing.assert_array_equal(fp.from_msg(sent).closed, [True, False])
            np.testing.assert_array_equal(fp.from_msg(sent).joints, [-1, -1, 4, 4, -1])
        sent = message('FiberArray', header=header(), names=[], offsets=[0, 3], points=[point(*p) for p in CURVE], radii=[])
        np.testing.assert_array_equal(self.expect(sent, CURVE, default_radius=0.3).radii, [0.3])
        sent = message('FiberArray', header=header(), names=[], offsets=[0, 4], points=[point(*p) for p in CURVE], radii=[])
        self.refuse(ValueError, 'offset 4 lies beyond the 3 points', lambda: fp.from_msg(sent))

    def test_clouds_that_are_wrong(self):
        for field, value, words in (('is_bigendian', True, 'big-endian'), ('row_step', 95, 'data has 96 bytes'),
                                    ('fields', [], 'x, y and z of FLOAT32 or FLOAT64')):
            sent = cloud(CURVE)
            setattr(sent, '_' + field, value)
            self.refuse(ValueError, words, lambda sent=sent: fp.from_msg(sent))
        self.refuse(ValueError, 'nan', lambda: fp.from_msg(cloud([[0, 0, np.nan], [0, 0, 1]])))

    def test_each_line_strip_and_each_list_of_points_is_a_fiber(self):
        for kind in (LINE_STRIP, POINTS, SPHERE_LIST, CUBE_LIST):
            self.expect(marker(kind), CURVE)
            self.expect(markers(marker(kind), marker(kind, CURVE[::-1] * 2)), CURVE, CURVE[::-1] * 2)
        self.expect(marker(LINE_STRIP, CURVE[:2]), CURVE[:2])
        np.testing.assert_array_equal(fp.from_msg(marker(LINE_STRIP), default_radius=0.5).radii, [0.5])  # no width of marker

    def test_other_looks_of_the_same_cable_are_left_out(self):
        strip, dots = marker(LINE_STRIP), marker(SPHERE_LIST, CURVE[:2])
        self.expect(markers(dots, strip, marker(TEXT, [])), CURVE)
        self.expect(markers(marker(SPHERE, []), dots), CURVE[:2])
        self.expect(markers(marker(LINE_STRIP, action=3), dots, marker(POINTS, action=2)), CURVE[:2])

    def test_poses_of_markers_count(self):
        # A quarter turn about z, not normalised, then a shift.
        turned = [(1.0 - y, 2.0 + x, 3.0 + z) for x, y, z in CURVE]
        self.expect(marker(LINE_STRIP, where=pose(1.0, 2.0, 3.0, (0.0, 0.0, 2.0, 2.0))), turned)
        self.expect(marker(LINE_STRIP, where=pose(1.0, 2.0, 3.0, (0.0, 0.0, 0.0, 0.0))), np.add(CURVE, (1, 2, 3)))
        rng = np.random.default_rng(5)
        quaternion = rng.normal(size=4)
        x, y, z, w = quaternion / np.linalg.norm(quaternion)
        rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                             [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                             [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        self.expect(marker(POINTS, where=pose(0.0, 0.0, 0.0, quaternion)), np.array(CURVE) @ rotation.T)

    def test_markers_that_are_refused(self):
        pair = [marker(LINE_STRIP, CURVE[i:i + 2], ('cable', i)) for i in range(2)]
        for sent, words in (
                (marker(LINE_LIST), 'marker cable/0 is a LINE_LIST, it must be a LINE_STRIP, POINTS, SPHERE_LIST or CUBE_LIST'),
                (markers(marker(LINE_LIST), marker(SPHERE_LIST)), 'is a LINE_LIST'),
                (markers(marker(SPHERE, [], ('ball', 7))), 'marker ball/7 is a SPHERE'), (marker(77), 'is a 77'),
                (markers(*pair), 'marker cable/0 and marker cable/1 have two points each'),
                (markers(marker(POINTS), marker(POINTS, name=('b', 1), frame='camera')),
                 "marker b/1 is in frame 'camera', marker cable/0 in 'world'"),
                (markers(), 'nothing is added'), (marker(LINE_STRIP, action=2), 'nothing is added'),
                (marker(LINE_STRIP, []), 'fibre 0')):
            self.refuse(ValueError, words, lambda sent=sent: fp.from_msg(sent))

    def test_other_objects(self):
        for other in (pathlib.Path('a'), message('Image', data=b''), message('PointCloud2', data=b''), 5, None,
                      message('ContactArray', contacts=[])):
            self.refuse(TypeError, 'it must be one of: ContactArray, FiberArray, Marker, MarkerArray, Path, PointCloud, '
                        'PointCloud2, PoseArray', lambda other=other: fp.from_msg(other))

    def test_the_program_of_the_page(self):
        page = (pathlib.Path(__file__).parents[2] / 'docs' / 'ros2_and_containers.md').read_text(encoding='utf-8')
        program, = re.findall(r'^```python\n(.*?)^```$', page, re.M | re.S)
        there = [(0.01 * i, 0.0, 0.0) for i in range(21)]
        back = [(x, 0.014, 0.0) for x, _, _ in reversed(there)]
        receivers, warnings = [], []
        node = Part(create_subscription=lambda kind, topic, receive, depth: receivers.append(receive),
                    get_logger=lambda: Part(warn=warnings.append))
        rclpy = Part(init=lambda: None, create_node=lambda name: node,
                     spin=lambda spun: [receive(cloud(points)) for receive in receivers for points in (there, there + back)])
        with mock.patch.dict(sys.modules, {'rclpy': rclpy, 'sensor_msgs': Part(), 'sensor_msgs.msg': Part(PointCloud2=None)}):
            exec(compile(program, 'page', 'exec'), {})
        self.assertEqual(warnings, ['4.0 mm apart'])

    def test_no_ros_is_needed(self):
        self.assertFalse({'genpy', 'rospy', 'sensor_msgs', 'geometry_msgs', 'rclpy'} & set(sys.modules))


if __name__ == '__main__':
    unittest.main()
