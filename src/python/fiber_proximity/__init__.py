"""Proximity queries of fibres: cables, ropes, hair, yarn.

A fibre is a chain of points with a radius. This package finds which segments of fibres touch or
come closer than a margin, now and while they move, how close they are to what is around them, who
crosses over whom; and it simulates them. Arrays are numpy's; lengths are in metres, angles in
radians, distances negative in penetration.

>>> import numpy as np
>>> from fiber_proximity import Engine, Fibers
>>> cable = np.linspace([0, 0, 0], [1, 0, 0], 11)
>>> fibers = Fibers(np.stack([cable, cable + [0, 0, 0.02]]), radii=0.005)
>>> engine = Engine(fibers)
>>> float(engine.closest()["distance"].round(6))
0.01
>>> fibers.move(np.stack([cable, cable + [0, 0, 0.03]]))
>>> engine.update()
>>> float(engine.closest()["distance"].round(6))
0.02

With ROS, the generated messages are in here, too: ``from fiber_proximity.msg import Contact``.
"""
# Messages are generated into another folder than a wheel is installed in: both are this package, in
# whatever order they stand on the path.
from importlib import import_module
from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)
del extend_path

__all__ = [
    'CANDIDATE', 'CheckResult', 'DeviceArray', 'DeviceContacts', 'DeviceProximity', 'Engine', 'Environment', 'FIBER', 'Fibers', 'Forces',
    'LockedPoints', 'MotionResult', 'OBJECT', 'QueryResult', 'Robot', 'SHAPE', 'Simulation',
    'candidate_contact_dtype', 'candidate_motion_contact_dtype', 'check', 'check_motions',
    'contact_dtype', 'crossing_dtype', 'crossings', 'engine_names', 'from_msg', 'gradients',
    'linking_dtype', 'linking_number', 'linking_numbers', 'message_contact_dtype',
    'motion_contact_dtype', 'read', 'read_frames', 'to_msg', 'write', 'write_frames', 'writhe',
]


# What is not compiled, and where it is.
_MODULES = {'Robot': 'robot', 'from_msg': 'messages', 'message_contact_dtype': 'messages', 'to_msg': 'messages'}


# What only wants the messages does not wait for the libraries.
def __getattr__(name):
    if name.startswith('__') or name not in __all__:
        raise AttributeError(f'module {__name__!r} has no attribute {name!r}')
    module = f"{__name__}.{_MODULES.get(name, '_native')}"
    try:
        value = globals()[name] = getattr(import_module(module), name)
    except ModuleNotFoundError as error:
        if error.name != f'{__name__}._native':
            raise
        raise ImportError(f'{__name__}.{name} is not here: the package was built without pybind11, '
                          'with its messages alone', name=__name__) from None
    return value


def _restore_fibers(kind, points, offsets, radii, names, closed=None, joints=None, joint_tolerance=None):
    """Fibers of a class, as copy and pickle make them: without the constructor of a subclass."""
    fibers_class = __getattr__('Fibers')
    fibers = fibers_class.__new__(kind)
    fibers_class.__init__(fibers, points, offsets, radii, closed, joints, joint_tolerance)
    fibers_class.names.__set__(fibers, names)
    return fibers


def __dir__():
    return sorted({*globals(), *__all__})
