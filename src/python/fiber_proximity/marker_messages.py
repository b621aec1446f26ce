"""Fibres of markers, by their attributes as in point_messages.

As the node reads them (src/ros/inputs/marker_input.hpp): of lines and lists of points what comes first in this order is read, the other
repeats the same cable in another look. Kinds whose pieces the node must join are refused.
"""
import numpy as np

from fiber_proximity import Fibers
from fiber_proximity.point_messages import positions

# Of visualization_msgs/Marker.
_ADD = 0
_TYPES = ('ARROW', 'CUBE', 'SPHERE', 'CYLINDER', 'LINE_STRIP', 'LINE_LIST', 'CUBE_LIST', 'SPHERE_LIST', 'POINTS',
          'TEXT_VIEW_FACING', 'MESH_RESOURCE', 'TRIANGLE_LIST')
_LINES = ('LINE_STRIP', 'LINE_LIST')
_POINT_LISTS = ('POINTS', 'SPHERE_LIST', 'CUBE_LIST')


def _type(marker):
    return _TYPES[marker.type] if 0 <= marker.type < len(_TYPES) else str(marker.type)


def _name(marker):
    return f'marker {marker.ns}/{marker.id}'


def _rotation(quaternion):
    """(3, 3); of one that nobody filled in none, as in rviz."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    squared = x * x + y * y + z * z + w * w
    if squared == 0.0:
        return np.eye(3)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 / squared * (w * cross + cross @ cross)


def _curve(marker):
    pose = marker.pose
    return positions(marker.points) @ _rotation(pose.orientation).T + positions([pose.position])


def _read(markers, default_radius):
    added = [marker for marker in markers if marker.action == _ADD]
    if not added:
        raise ValueError('there is no marker to read, nothing is added')
    found = [[marker for marker in added if _type(marker) in kind] for kind in (_LINES, _POINT_LISTS)]
    read = found[0] or found[1] or added
    for marker in read:
        if _type(marker) not in ('LINE_STRIP', *_POINT_LISTS):
            raise ValueError(f'{_name(marker)} is a {_type(marker)}, it must be a LINE_STRIP, POINTS, SPHERE_LIST or '
                             'CUBE_LIST; pieces of fibres are joined by the node')
        if marker.header.frame_id != read[0].header.frame_id:
            raise ValueError(f"{_name(marker)} is in frame '{marker.header.frame_id}', {_name(read[0])} in "
                             f"'{read[0].header.frame_id}'; they must be the same")
    pieces = [marker for marker in found[0] if len(marker.points) == 2]
    if len(pieces) > 1:
        raise ValueError(f'{_name(pieces[0])} and {_name(pieces[1])} have two points each, they may be pieces of one fibre, '
                         'which are joined by the node')
    return Fibers([_curve(marker) for marker in read], radii=default_radius)


def _from_marker(message, default_radius):
    return _read([message], default_radius)


def _from_markers(message, default_radius):
    return _read(message.markers, default_radius)


#: As those of point_messages.
READERS = {
    'Marker': (_from_marker, ('header', 'type', 'action', 'pose', 'points')),
    'MarkerArray': (_from_markers, ('markers',)),
}
