"""Fibres of messages that hold points, by their attributes: of ROS 1, of ROS 2, or of anything shaped like them.

Nothing here imports ROS.
"""
import numpy as np

from fiber_proximity import Fibers

# Of sensor_msgs/PointField.
_FORMATS = {7: '<f4', 8: '<f8'}


def positions(points):
    """(n, 3) float64 of messages with x, y and z."""
    return np.array([(point.x, point.y, point.z) for point in points], dtype=float).reshape(-1, 3)


def named(fibers, names):
    """Fibres with the names of their message, if it has any."""
    if names:
        fibers.names = names
    return fibers


def topology_of(closed, joints):
    """Arguments of Fibers that say what is joined; those that are empty say nothing. uint8[] may be bytes."""
    closed = np.frombuffer(bytes(closed), np.uint8)
    joints = np.asarray(joints, dtype=np.int64)
    return {**({'closed': closed != 0} if closed.size else {}), **({'joints': joints} if joints.size else {})}


def _from_fiber_array(message, default_radius):
    radii = np.asarray(message.radii, dtype=float)
    return named(Fibers(positions(message.points), np.asarray(message.offsets, dtype=np.int64),
                        radii if radii.size else default_radius,
                        **topology_of(getattr(message, 'closed', ()), getattr(message, 'joints', ()))),
                 getattr(message, 'names', ()))


def _from_cloud(cloud, default_radius):
    if cloud.is_bigendian:
        raise ValueError('the cloud is big-endian, only little-endian is supported')
    fields = {field.name: field for field in cloud.fields}
    if any(name not in fields or fields[name].datatype not in _FORMATS for name in 'xyz'):
        raise ValueError(f"the cloud has the fields {sorted(fields)}, it needs x, y and z of FLOAT32 or FLOAT64")
    dtype = np.dtype({'names': list('xyz'), 'formats': [_FORMATS[fields[name].datatype] for name in 'xyz'],
                      'offsets': [fields[name].offset for name in 'xyz'], 'itemsize': cloud.point_step})
    if len(cloud.data) != cloud.height * cloud.row_step or cloud.row_step < cloud.width * cloud.point_step:
        raise ValueError(f'data has {len(cloud.data)} bytes, it must be {cloud.height} rows of row_step {cloud.row_step}, '
                         f'each of {cloud.width} points of point_step {cloud.point_step}')
    points = np.ndarray((cloud.height, cloud.width), dtype, bytes(cloud.data), 0, (cloud.row_step, cloud.point_step))
    return Fibers(np.stack([points[name].ravel() for name in 'xyz'], axis=1).astype(float), radii=default_radius)


def _from_point_cloud(message, default_radius):
    return Fibers(positions(message.points), radii=default_radius)


def _from_poses(message, default_radius):
    return Fibers(positions(pose.position for pose in message.poses), radii=default_radius)


def _from_path(message, default_radius):
    frame = message.header.frame_id
    for i, pose in enumerate(message.poses):
        # Many publishers fill in the path's frame only.
        if pose.header.frame_id not in ('', frame):
            raise ValueError(f"pose {i} is in frame '{pose.header.frame_id}', the path in '{frame}'; they must be the same")
    return Fibers(positions(pose.pose.position for pose in message.poses), radii=default_radius)


#: By the name of the message: its reader, and the attributes that this needs.
READERS = {
    'FiberArray': (_from_fiber_array, ('offsets', 'points', 'radii')),
    'PointCloud2': (_from_cloud, ('fields', 'data', 'point_step', 'row_step', 'width', 'height', 'is_bigendian')),
    'PointCloud': (_from_point_cloud, ('points',)),
    'PoseArray': (_from_poses, ('poses',)),
    'Path': (_from_path, ('header', 'poses')),
}
