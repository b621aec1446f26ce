"""Robots from URDF as objects of an Environment."""
import os
import re
import xml.etree.ElementTree

import numpy as np

from fiber_proximity import Environment
from fiber_proximity._native import refuse_masked


def _numbers(element, name, default):
    text = element.get(name) if element is not None else None
    if text is None:
        return np.array(default, dtype=float)
    try:
        numbers = np.array([float(word) for word in text.split()])
    except ValueError:
        numbers = np.array([])
    if numbers.shape != np.shape(default):
        raise ValueError(f'<{element.tag} {name}="{text}">: it must be {np.size(default)} numbers')
    return numbers


def _number(element, name, what):
    text = element.get(name)
    try:
        return float(text)
    except (TypeError, ValueError):
        raise ValueError(f'{what}: {name} is {text!r}, it must be a number') from None


def _turn(axis, angle):
    """Rotation about an axis of unit length (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def _pose(origin):
    """Of an element <origin>: first about x, then y, then z."""
    pose = np.eye(4)
    roll, pitch, yaw = _numbers(origin, 'rpy', [0.0, 0.0, 0.0])
    pose[:3, :3] = _turn([0, 0, 1], yaw) @ _turn([0, 1, 0], pitch) @ _turn([1, 0, 0], roll)
    pose[:3, 3] = _numbers(origin, 'xyz', [0.0, 0.0, 0.0])
    return pose


class _Joint:
    """What brings a link to another."""

    def __init__(self, element):
        self.name = element.get('name')
        self.type = element.get('type')
        if self.type not in ('fixed', 'revolute', 'continuous', 'prismatic', 'floating', 'planar'):
            raise ValueError(f'joint {self.name!r} is of the type {self.type!r}, it must be one of URDF')
        self.parent = element.find('parent').get('link')
        self.child = element.find('child').get('link')
        self.origin = _pose(element.find('origin'))
        self.axis = _numbers(element.find('axis'), 'xyz', [1.0, 0.0, 0.0])
        self.mimic = element.find('mimic')
        if self.moves:
            length = np.linalg.norm(self.axis)
            if not length > 0.0:
                raise ValueError(f'joint {self.name!r}: its axis has no direction')
            self.axis = self.axis / length

    @property
    def moves(self):
        return self.type in ('revolute', 'continuous', 'prismatic')

    def motion(self, value):
        pose = np.eye(4)
        if self.type == 'prismatic':
            pose[:3, 3] = value * self.axis
        elif self.moves:
            pose[:3, :3] = _turn(self.axis, value)
        return self.origin @ pose


class Robot:
    """The collision geometry of a robot; each link an object ``robot/LINK`` of an Environment.

    Parameters
    ----------
    urdf : str
        The description, or the name of a file that holds it.
    packages : dict, optional
        Folders by the names in ``package://NAME/``; what is not in it is looked for as ROS does, where there is ROS.
    folder : str, optional
        Where paths of meshes begin that are neither absolute nor of a package; that of the file by default.

    Raises
    ------
    ValueError
        For what is no URDF, naming link or joint.
    FileNotFoundError
        For a file or mesh that is not there.

    >>> from fiber_proximity import Environment, Fibers, Robot
    >>> robot = Robot('''<robot name="arm"><link name="base"/>
    ...   <link name="hand"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
    ...   <joint name="lift" type="prismatic"><parent link="base"/><child link="hand"/><axis xyz="0 0 1"/></joint>
    ... </robot>''')
    >>> robot.joints
    ['lift']
    >>> environment = Environment()
    >>> robot.add_to(environment)
    >>> robot.move(environment, {'lift': 0.5})
    >>> cable = Fibers([[-1, 0, 0], [1, 0, 0]], radii=0.1)
    >>> float(environment.closest(cable)['distance'].round(6))
    0.3
    """

    def __init__(self, urdf, packages=None, folder=None):
        if not urdf.lstrip().startswith('<'):
            folder = folder or os.path.dirname(urdf)
            with open(urdf, encoding='utf-8') as file:
                urdf = file.read()
        try:
            self._root = xml.etree.ElementTree.fromstring(urdf)
        except xml.etree.ElementTree.ParseError as error:
            raise ValueError(f"the robot's description is no XML: {error}") from None
        if self._root.tag != 'robot':
            raise ValueError(f"the robot's description is a <{self._root.tag}>, it must be a <robot>")
        self._packages = packages or {}
        self._folder = folder or '.'
        self._links = {link.get('name'): link.findall('collision') for link in self._root.findall('link')}
        self._joints = {}
        for element in self._root.findall('joint'):
            joint = self._read_joint(element)
            self._joints[joint.child] = joint
        self._order = [link for link, collisions in self._links.items() if collisions]
        if not self._order:
            raise ValueError(f"the robot {self._root.get('name')!r} has no collision geometry, it needs that of 1 link "
                             'at least')
        self.poses()  # of links that hang on each other there are none

    def _read_joint(self, element):
        if element.find('parent') is None or element.find('child') is None:
            raise ValueError(f"joint {element.get('name')!r} lacks parent or child")
        joint = _Joint(element)
        for link in (joint.parent, joint.child):
            if link not in self._links:
                raise ValueError(f'joint {joint.name!r}: there is no link {link!r}')
        if joint.child in self._joints:
            raise ValueError(f'link {joint.child!r} hangs on two joints, {self._joints[joint.child].name!r} and '
                             f'{joint.name!r}')
        return joint

    @property
    def joints(self):
        """Names of the joints that move, a list of str: revolute, continuous [rad] and prismatic [m] ones."""
        return [joint.name for joint in self._joints.values() if joint.moves and joint.mimic is None]

    @property
    def links(self):
        """Names of the links with collision geometry, a list of str."""
        return list(self._order)

    def poses(self, joints=None, base=None):
        """Where links are.

        Parameters
        ----------
        joints : dict, optional
            Positions by name [rad or m], 0 of others.
        base : (4, 4), optional
            Pose of the robot's root.

        Returns
        -------
        dict of (4, 4) float64 by link
        """
        values = self._values(joints or {})
        refuse_masked(base, 'base')
        found = {}

        def pose_of(link, below):
            if link not in found:
                joint = self._joints.get(link)
                if link in below:
                    raise ValueError(f'link {link!r} hangs on itself')
                found[link] = (np.eye(4) if base is None else np.asarray(base, dtype=float)) if joint is None else (
                    pose_of(joint.parent, below | {link}) @ joint.motion(values[joint.name]))
            return found[link]

        return {link: pose_of(link, frozenset()) for link in self._links}

    def _values(self, joints):
        known = self.joints
        for name, value in joints.items():
            if name not in known:
                raise ValueError(f'there is no joint {name!r} that moves, there are {", ".join(known)}')
            if not np.isfinite(value):
                raise ValueError(f'joint {name!r} is at {value}, it must be finite')
        values = {joint.name: float(joints.get(joint.name, 0.0)) for joint in self._joints.values()}
        for joint in self._joints.values():
            if joint.mimic is not None:
                other = joint.mimic.get('joint')
                if other not in values:
                    raise ValueError(f'joint {joint.name!r} follows {other!r}, which there is not')
                values[joint.name] = (float(joint.mimic.get('multiplier', 1.0)) * values[other] +
                                      float(joint.mimic.get('offset', 0.0)))
        return values

    def add_to(self, environment, joints=None, base=None):
        """Adds all links to an Environment, in place of those that are there. Parameters as those of ``poses()``."""
        poses = self.poses(joints, base)
        for link in self._order:
            parts = Environment()
            for i, collision in enumerate(self._links[link]):
                self._add_part(parts, str(i), collision, f'link {link!r}, collision {i}')
            name = f'robot/{link}'
            if name in environment:
                environment.remove(name)
            environment.append(name, parts)
            environment.move(name, poses[link])

    def move(self, environment, joints=None, base=None):
        """Moves the links, which ``add_to()`` has added, to where they are with these joints."""
        poses = self.poses(joints, base)
        for link in self._order:
            environment.move(f'robot/{link}', poses[link])

    def _add_part(self, parts, name, collision, what):
        geometry = collision.find('geometry')
        shapes = [] if geometry is None else list(geometry)
        if len(shapes) != 1 or shapes[0].tag not in ('box', 'sphere', 'cylinder', 'mesh'):
            raise ValueError(f'{what}: its geometry must be a box, sphere, cylinder or mesh')
        shape, pose = shapes[0], _pose(collision.find('origin'))
        if shape.tag == 'box':
            parts.add_box(name, _numbers(shape, 'size', [0.0, 0.0, 0.0]), pose)
        elif shape.tag == 'sphere':
            parts.add_sphere(name, _number(shape, 'radius', what), pose)
        elif shape.tag == 'cylinder':
            parts.add_cylinder(name, _number(shape, 'radius', what), _number(shape, 'length', what), pose)
        else:
            parts.add_mesh_file(name, self._find(shape.get('filename', '')),
                                _numbers(shape, 'scale', [1.0, 1.0, 1.0]), pose)

    def _find(self, resource):
        """The file that a resource names."""
        package = re.fullmatch('package://([^/]+)/(.*)', resource)
        if package is None:
            return os.path.join(self._folder, resource[len('file://'):] if resource.startswith('file://') else resource)
        name, path = package.groups()
        if name in self._packages:
            return os.path.join(self._packages[name], path)
        try:
            import rospkg
            return os.path.join(rospkg.RosPack().get_path(name), path)
        except Exception:  # of rospkg, or there is none
            raise FileNotFoundError(f'{resource}: there is no package {name!r}; packages={{{name!r}: FOLDER}} says where '
                                    'it is') from None
