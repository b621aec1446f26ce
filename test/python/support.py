"""Random fibres, and what numpy makes of them by brute force: nothing here is taken from the library."""
import numpy as np

import fiber_proximity as fp


def random_fibers(rng, fibers=6, length=8, step=0.1, box=0.4, radii='one'):
    """Walks in a box: (points, offsets, radii)."""
    counts = rng.integers(2, length + 1, fibers)
    offsets = np.concatenate([[0], np.cumsum(counts)])
    points = np.concatenate([rng.uniform(-box, box, 3) + np.cumsum(rng.normal(0, step, (count, 3)), axis=0)
                             for count in counts])
    sizes = {'one': 0.01, 'fiber': rng.uniform(0.0, 0.03, fibers), 'point': rng.uniform(0.0, 0.03, len(points))}
    return points, offsets, sizes[radii]


def segments_of(points, offsets, radii):
    """(fiber, segment, first point, second point, radius) of each segment, by arrays."""
    fiber = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets) - 1)
    first = np.concatenate([np.arange(a, b - 1) for a, b in zip(offsets[:-1], offsets[1:])]).astype(int)
    radii = np.atleast_1d(radii)
    if len(radii) == 1:
        radius = np.full(len(first), radii[0])
    elif len(radii) == len(offsets) - 1:
        radius = radii[fiber]
    else:
        radius = np.maximum(radii[first], radii[first + 1])
    return fiber, first - np.asarray(offsets)[fiber], points[first], points[first + 1], radius


def _from_point(p, a, b):
    """Distance of points from segments; broadcasts over the leading dimensions."""
    along = b - a
    square = (along * along).sum(-1)
    t = np.clip(((p - a) * along).sum(-1) / np.where(square > 0, square, 1.0), 0.0, 1.0)
    return np.linalg.norm(p - a - t[..., None] * along, axis=-1)


def distances(p0, p1, q0, q1):
    """Of segments: the least of the four ends, and of where the lines are nearest if that is within both."""
    ends = np.minimum.reduce([_from_point(p0, q0, q1), _from_point(p1, q0, q1), _from_point(q0, p0, p1),
                              _from_point(q1, p0, p1)])
    u, v, w = p1 - p0, q1 - q0, q0 - p0
    across = np.cross(u, v)
    square = (across * across).sum(-1)
    safe = np.where(square > 0, square, 1.0)
    s = (np.cross(w, v) * across).sum(-1) / safe
    t = (np.cross(w, u) * across).sum(-1) / safe
    inside = (square > 0) & (s >= 0) & (s <= 1) & (t >= 0) & (t <= 1)
    lines = np.abs((w * across).sum(-1)) / np.sqrt(safe)
    return np.where(inside, np.minimum(ends, lines), ends)


def gaps(points, offsets, radii):
    """Signed distance of all pairs of segments (n, n), infinite where they are no pair: a segment with itself, with
    its neighbours, and the second half; and the segments."""
    fiber, segment, p0, p1, radius = segments_of(points, offsets, radii)
    gap = distances(p0[:, None], p1[:, None], p0[None], p1[None]) - radius[:, None] - radius[None]
    same = fiber[:, None] == fiber[None]
    neighbours = same & (np.abs(segment[:, None] - segment[None]) <= 1)
    index = np.arange(len(fiber))
    return np.where(neighbours | (index[:, None] >= index[None]), np.inf, gap), (fiber, segment, p0, p1, radius)


def keys(contacts):
    """Pairs of contacts as tuples, in their order."""
    return list(zip(*(contacts[name].tolist() for name in ('fiber_a', 'segment_a', 'fiber_b', 'segment_b'))))


def pairs_of(mask, fiber, segment):
    """The same of a matrix of pairs."""
    a, b = np.nonzero(mask)
    return list(zip(fiber[a].tolist(), segment[a].tolist(), fiber[b].tolist(), segment[b].tolist()))


def message_of(call):
    """What an error says, and its type."""
    try:
        call()
    except Exception as error:  # whichever it is
        return type(error), str(error)
    return None, ''


def two_cables():
    """Two straight ones that cross, 0.08 m apart."""
    return fp.Fibers([[0, 0, 0], [1, 0, 0], [0.5, -1, 0.1], [0.5, 1, 0.1]], [0, 2, 4], 0.01)
