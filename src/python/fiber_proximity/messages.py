"""Messages of ROS as arrays, by their buffers: no object for each point.

``from_msg(message)`` takes what a subscriber gets. FiberArray and ContactArray of the type ``rospy.AnyMsg`` are not even
unpacked: their bytes become arrays. What ``to_msg()`` makes is packed as one piece.
"""
import io
import struct
from importlib import import_module

import numpy as np

from fiber_proximity import Fibers, contact_dtype, marker_messages, point_messages
from fiber_proximity._native import refuse_masked

_POINT = ('<f8', (3,))
# As bytes of the message Contact, up to its gradients.
_WIRE_CONTACT = np.dtype([
    ('type_a', 'u1'), ('type_b', 'u1'), ('fiber_a', '<u4'), ('segment_a', '<u4'), ('s', '<f8'), ('fiber_b', '<u4'),
    ('segment_b', '<u4'), ('t', '<f8'), ('distance', '<f8'), ('lower', '<f8'), ('upper', '<f8'), ('point_a', *_POINT),
    ('point_b', *_POINT), ('normal', *_POINT), ('id', '<u8'), ('age', '<f8'), ('time_lower', '<u4', (2,)),
    ('time_upper', '<u4', (2,)), ('gone', '?'), ('certain', '?'), ('gradient_count', '<u4')])

#: What from_msg() makes of a ContactArray: the fields of the message Contact; times in seconds, and gradients (4, 3),
#: which are not numbers where the message has none.
message_contact_dtype = np.dtype(
    [(name, *_WIRE_CONTACT.fields[name][:1]) for name in _WIRE_CONTACT.names[:16]] +
    [('time_lower', 'f8'), ('time_upper', 'f8'), ('gone', '?'), ('certain', '?'), ('gradients', 'f8', (4, 3))])


class _Reader:
    """Reads the bytes of a message from front to back."""

    def __init__(self, data):
        self.data = data
        self.place = 0

    def array(self, dtype, count):
        dtype = np.dtype(dtype)
        end = self.place + count * dtype.itemsize
        if end > len(self.data):
            raise ValueError(f'the message ends at byte {len(self.data)}, it must have {end} at least')
        values = np.frombuffer(self.data, dtype, count, self.place)
        self.place = end
        return values

    def count(self):
        return int(self.array('<u4', 1)[0])

    def list(self, dtype):
        return self.array(dtype, self.count())

    def text(self):
        return self.list('u1').tobytes().decode('utf-8', 'replace')

    def texts(self):
        return [self.text() for _ in range(self.count())]

    def header(self):
        self.array('<u4', 3)
        return self.text()


def _is_any(message):
    return getattr(message, '_type', None) == '*'  # rospy.AnyMsg


def _bytes_of(message):
    if _is_any(message):
        return message._buff
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def _unpacked(message):
    """Of AnyMsg the message that it holds."""
    if not _is_any(message):
        return message
    package, name = message._connection_header['type'].split('/')
    return getattr(import_module(f'{package}.msg'), name)().deserialize(message._buff)


def _from_fibers(message, default_radius):
    reader = _Reader(_bytes_of(message))
    reader.header()
    names = reader.texts()
    offsets = reader.list('<u4')
    points = reader.list(np.dtype(_POINT))
    radii = reader.list('<f8')
    closed = reader.list('u1')
    joints = reader.list('<i4')
    return point_messages.named(Fibers(points, offsets, radii if radii.size else default_radius,
                                       **point_messages.topology_of(closed, joints)), names)


def _read_gradients(reader, count):
    """Contacts of a list whose numbers of gradients differ, one by one."""
    contacts = np.empty(count, _WIRE_CONTACT)
    gradients = np.full((count, 4, 3), np.nan)
    for i in range(count):
        contacts[i] = reader.array(_WIRE_CONTACT, 1)[0]
        given = reader.array(np.dtype(_POINT), int(contacts[i]['gradient_count']))
        if len(given) == 4:
            gradients[i] = given
    return contacts, gradients


def _read_contacts(reader):
    count = reader.count()
    begin = reader.place
    given = int(reader.array(_WIRE_CONTACT, min(count, 1))['gradient_count'].sum())
    reader.place = begin
    # As a rule all have gradients or none has.
    rows = np.dtype([('contact', _WIRE_CONTACT), ('gradients', '<f8', (given, 3))])
    if given in (0, 4) and begin + count * rows.itemsize <= len(reader.data):
        items = reader.array(rows, count)
        if (items['contact']['gradient_count'] == given).all():
            return items['contact'], items['gradients'] if given else np.nan
        reader.place = begin
    return _read_gradients(reader, count)


def _from_contacts(message, default_radius):
    reader = _Reader(_bytes_of(message))
    reader.header()
    reader.texts()
    reader.texts()
    reader.array('u1', 9)  # since, continuous
    read, gradients = _read_contacts(reader)
    contacts = np.empty(len(read), message_contact_dtype)
    for name in _WIRE_CONTACT.names[:16]:
        contacts[name] = read[name]
    for name in ('time_lower', 'time_upper'):
        contacts[name] = read[name] @ [1.0, 1e-9]
    contacts['gone'] = read['gone']
    contacts['certain'] = read['certain']
    contacts['gradients'] = gradients
    return contacts


# As bytes, which only messages of ROS 1 become.
_BYTE_READERS = {'FiberArray': _from_fibers, 'ContactArray': _from_contacts}
_READERS = {**point_messages.READERS, **marker_messages.READERS}


def _names_of(message):
    """What a message may be called: its type without the package; without a type its class and what this is made of."""
    full = message._connection_header['type'] if _is_any(message) else getattr(message, '_type', None)
    return [full.split('/')[-1]] if isinstance(full, str) else [kind.__name__ for kind in type(message).__mro__]


def from_msg(message, default_radius=0.0):
    """Makes of a message of ROS what this package works with.

    Messages are known by the names of their types and by their attributes, so those of ROS 2 (rclpy) are taken as those
    of ROS 1, which need not be there.

    Parameters
    ----------
    message : FiberArray, PointCloud2, PointCloud, PoseArray, Path, Marker, MarkerArray, or in ROS 1 a ContactArray or a
        rospy.AnyMsg that is one of these
        A message of points is one fibre; of markers each LINE_STRIP or list of points (POINTS, SPHERE_LIST, CUBE_LIST).
    default_radius : float [m]
        Of all fibres if the message has no radii; the widths of markers are none.

    Returns
    -------
    Fibers, or of a ContactArray (m,) of ``message_contact_dtype``

    Raises
    ------
    TypeError
        For other messages.
    ValueError
        As ``Fibers``: for points that are not finite, as trackers mark those they do not see, for example. For markers of
        other types, and where none is added.
    """
    for name in _names_of(message):
        if name in _BYTE_READERS and (_is_any(message) or hasattr(message, 'serialize')):
            return _BYTE_READERS[name](message, default_radius)
        read, attributes = _READERS.get(name, (None, ()))
        if read is not None:
            held = _unpacked(message)
            if all(hasattr(held, attribute) for attribute in attributes):
                return read(held, default_radius)
    raise TypeError(f'a message is a {_names_of(message)[0]}, it must be one of: '
                    f'{", ".join(sorted({*_READERS, *_BYTE_READERS}))}')


def _packed_texts(texts):
    encoded = [text.encode() for text in texts]
    return struct.pack('<I', len(texts)) + b''.join(struct.pack('<I', len(text)) + text for text in encoded)


def _packed(array, dtype):
    values = np.ascontiguousarray(array, dtype)
    return struct.pack('<I', len(values)) + values.tobytes()


def _packed_class(message_class):
    """Messages of a class whose body, all but the header, is there as bytes; unpacked when somebody looks at it."""
    unpacked = [name for name in message_class.__slots__ if name != 'header']

    class Packed(message_class):
        __slots__ = ('_body',)
        __doc__ = message_class.__doc__

        def __init__(self, header, body):
            object.__setattr__(self, '_body', None)
            super().__init__()
            self.header = header
            self._body = body

        def _bytes(self):
            buffer = io.BytesIO()
            self.header.serialize(buffer)
            return buffer.getvalue() + self._body

        def _unpack(self):
            data = self._bytes()
            self._body = None  # from now on the fields count, which may be changed
            message_class.deserialize(self, data)

        def serialize(self, buffer):
            if self._body is None:
                super().serialize(buffer)
            else:
                buffer.write(self._bytes())

        def __eq__(self, other):  # genpy's takes a plain message for another class
            return isinstance(other, message_class) and all(
                getattr(self, name) == getattr(other, name) for name in message_class.__slots__)

        def __getattribute__(self, name):
            if name in unpacked and self._body is not None:
                self._unpack()
            return object.__getattribute__(self, name)

        def __setattr__(self, name, value):
            if name in unpacked and self._body is not None:
                self._unpack()
            object.__setattr__(self, name, value)

    Packed.__slots__ = message_class.__slots__  # which genpy goes through
    Packed.__name__ = message_class.__name__
    return Packed


_packed_classes = {}


def _make_packed(message_class, header, body):
    if message_class not in _packed_classes:
        _packed_classes[message_class] = _packed_class(message_class)
    return _packed_classes[message_class](header, body)


def _check_names(names, count):
    if names and len(names) != count:
        raise ValueError(f'{len(names)} names for {count} fibres; give one for each or none')


def _fibers_to_msg(fibers, header, names):
    from fiber_proximity.msg import FiberArray
    _check_names(names, len(fibers))
    body = (_packed_texts(names) + _packed(fibers.offsets, '<u4') + _packed(fibers.points, '<f8') +
            _packed(fibers.radii, '<f8') + _packed(fibers.closed if fibers.closed.any() else (), 'u1') +
            _packed(fibers.joints if (fibers.joints >= 0).any() else (), '<i4'))
    return _make_packed(FiberArray, header, body)


def _contacts_to_msg(contacts, header, names, margin):
    from fiber_proximity.msg import ContactArray
    wire = np.zeros(len(contacts), _WIRE_CONTACT)
    for name in contacts.dtype.names:
        if name in _WIRE_CONTACT.names[:16]:
            wire[name] = contacts[name]
    wire['certain'] = wire['upper'] <= margin
    message = ContactArray(header=header, fiber_names=list(names), since=header.stamp, margin=margin, complete=True,
                           kernel='robust')
    buffer = io.BytesIO()
    message.serialize(buffer)
    whole = buffer.getvalue()
    header_bytes = io.BytesIO()
    header.serialize(header_bytes)
    # The list of contacts, still empty, comes after names and what is of fixed size.
    place = len(header_bytes.getvalue()) + len(_packed_texts(names)) + 4 + 9
    body = whole[len(header_bytes.getvalue()):place] + struct.pack('<I', len(wire)) + wire.tobytes() + whole[place + 4:]
    return _make_packed(ContactArray, header, body)


def to_msg(value, frame_id='', stamp=None, names=(), margin=0.0):
    """Makes a message of ROS.

    Parameters
    ----------
    value : Fibers, or contacts (m,) of ``contact_dtype`` or ``message_contact_dtype``
    frame_id : str
    stamp : genpy.Time, optional
        Zero without.
    names : sequence of str
        One for each fibre, or none.
    margin : float [m]
        Of contacts: the margin of the query.

    Returns
    -------
    FiberArray or ContactArray
        Packed as one piece: what is published is not packed again, and its fields are made when somebody looks at them.
    """
    refuse_masked(value, 'value')
    from genpy import Time
    from std_msgs.msg import Header
    header = Header(frame_id=frame_id, stamp=stamp or Time())
    if isinstance(value, Fibers):
        return _fibers_to_msg(value, header, list(names))
    contacts = np.asarray(value)
    if contacts.dtype not in (contact_dtype, message_contact_dtype) or contacts.ndim != 1:
        raise TypeError(f'cannot make a message of a {type(value)}, it must be Fibers or an array of contacts')
    return _contacts_to_msg(contacts, header, list(names), margin)
