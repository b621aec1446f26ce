#!/usr/bin/python3
"""Makes src/paper/bounds/direction_table.inc, the directions of the paper's k-DOPs: packs 3 to 100 lines through the
origin of R^3 so that the smallest angle between any two is as large as possible.

Starts from the sets in the table, and keeps every bit of those that it finds none better for. The commands that the
table names were run by a program in C++ of the same method with other random numbers: they find sets as good here, not
the same bits.
"""
import argparse
import math
import multiprocessing
import os
import pathlib
import re

os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')  # processes share the work, and the matrices are small
import numpy  # noqa: E402

TABLE = pathlib.Path(__file__).resolve().parent.parent / 'src' / 'paper' / 'bounds' / 'direction_table.inc'
FEWEST_LINES = 3
MOST_LINES = 100
LEAST_GAIN = 1e-9  # [rad] what counts as a better set: above rounding, below what anyone can measure


def unit(vectors):
    return vectors / numpy.linalg.norm(vectors, axis=-1, keepdims=True)


def largest_cosine(lines):
    return numpy.abs(lines @ lines.T - numpy.eye(len(lines))).max()


def smallest_angle(lines):
    """[rad] between two of the lines along these unit vectors."""
    return math.acos(largest_cosine(lines))


class Packing:
    """Interior-point method for: minimise m subject to (u_i · u_j)² ≤ m² for all pairs of lines.

    The point in between is a minimum of F = weight · m − Σ log(m² − (u_i · u_j)²), which follows a smooth path to the
    solution as the weight grows. Unknowns: two tangential coordinates for every line, then m.
    """

    def __init__(self, lines, weight):
        self.lines = lines
        self.bound = 1.05
        self.weight = weight
        self.damping = 1e-6

    def value(self, lines, bound):
        pairs = numpy.tril_indices(len(lines), -1)
        slack = bound ** 2 - (lines @ lines.T)[pairs] ** 2
        return self.weight * bound - numpy.log(slack).sum() if slack.min(initial=1.0) > 0.0 else math.inf

    def assemble(self):
        """Gradient and Hessian: of −log(m² − c²), c = u_i · u_j, summed over all j for each i."""
        count = len(self.lines)
        axis = numpy.eye(3)[numpy.abs(self.lines).argmin(axis=1)]
        first_tangent = unit(numpy.cross(self.lines, axis))
        self.frames = numpy.stack([first_tangent, numpy.cross(self.lines, first_tangent)], axis=1)
        cosine = self.lines @ self.lines.T
        numpy.fill_diagonal(cosine, 0.0)
        others = 1.0 - numpy.eye(count)
        slack = self.bound ** 2 - cosine ** 2
        first = 2.0 * cosine / slack
        second = (2.0 / slack + first ** 2) * others
        mixed = -2.0 * self.bound * first / slack
        slopes = numpy.einsum('ikx,jx->ijk', self.frames, self.lines)  # of u_j's cosine with u_i
        self.gradient = numpy.append(numpy.einsum('ij,ijk->ik', first, slopes),
                                     self.weight - self.bound * (2.0 * others / slack).sum())
        blocks = numpy.einsum('ij,ijk,jil->ikjl', second, slopes, slopes)
        blocks += numpy.einsum('ij,ikx,jlx->ikjl', first, self.frames, self.frames)
        each = numpy.arange(count)
        # On the sphere a step a in the tangent plane also shortens the vector by a²/2.
        blocks[each, :, each] += numpy.einsum('ij,ijk,ijl->ikl', second, slopes, slopes)
        blocks[each, :, each] -= (first * cosine).sum(axis=1)[:, None, None] * numpy.eye(2)
        edge = numpy.einsum('ij,ijk->ik', mixed, slopes).reshape(-1, 1)
        corner = 0.5 * (others * (4.0 * self.bound ** 2 / slack - 2.0) / slack).sum()
        self.hessian = numpy.block([[blocks.reshape(2 * count, 2 * count), edge], [edge.T, corner]])

    def solve(self, right_side):
        """Solves with the Hessian, made positive definite by as little damping as that takes: F is not convex, and does
        not change when the whole set turns."""
        raised = False
        while True:
            damped = self.hessian + numpy.diag(self.damping * (numpy.abs(numpy.diag(self.hessian)) + 1.0))
            try:
                numpy.linalg.cholesky(damped)
            except numpy.linalg.LinAlgError:
                raised = True
                self.damping = max(8.0 * self.damping, 1e-6)
                continue
            if not raised:
                self.damping = max(0.1 * self.damping, 1e-13)
            return numpy.linalg.solve(damped, right_side)

    def move(self, step, least_descent):
        """Moves by the step, or a half of it, and so on, until F is less by that part of `least_descent`."""
        before = self.value(self.lines, self.bound)
        turns = numpy.einsum('ikx,ik->ix', self.frames, step[:-1].reshape(-1, 2))
        for fraction in 0.5 ** numpy.arange(20):
            lines = unit(self.lines + fraction * turns)
            bound = self.bound + fraction * step[-1]
            if self.value(lines, bound) < before - fraction * least_descent:
                self.lines, self.bound = lines, bound
                return True
        return False

    def centre(self, tolerance, most_steps):
        """Newton steps until F is nearly least for the present weight."""
        for _ in range(most_steps):
            self.assemble()
            step = self.solve(-self.gradient)
            decrement = -self.gradient @ step
            # [rad] The tangent plane tells the way up to a turn of 0.3.
            part = min(1.0, 0.3 / numpy.abs(step[:-1]).max(), 0.5 * self.bound / abs(step[-1]))
            if not decrement > tolerance or not self.move(part * step, 1e-4 * part * decrement):
                return

    def advance(self, factor):
        """Multiplies the weight and moves along the tangent of the path. Returns where m would end if the tangent were
        followed to an infinite weight."""
        self.assemble()
        slope = numpy.zeros(len(self.gradient))
        slope[-1] = -self.weight
        tangent = self.solve(slope)
        limit = self.bound + tangent[-1]
        self.move((1.0 - 1.0 / factor) * tangent, -math.inf)  # anywhere that is allowed
        self.weight *= factor
        return limit


def pack_lines(lines, smoothness, target=0.0):
    """Moves lines to a local maximum of the smallest angle between any two: a packing in the Grassmannian space G(3,1)
    (Conway, Hardin and Sloane 1996). Converges to well below 1e-9 rad of that maximum.

    smoothness: how far the surface is levelled at the start; 1 forgets the details of the start, small values keep to
    its neighbourhood.
    target: [rad] gives up, and returns what it has, once it heads for a smaller angle than this.
    """
    packing = Packing(lines, 0.5 * len(lines) * (len(lines) - 1) / smoothness)
    packing.centre(0.3, 200)
    while packing.weight < 1e13:  # m then errs by about its reciprocal times the contacts
        before = packing.bound
        limit = packing.advance(30.0)
        # The forecast errs by a part of the gain it foretells, on either side.
        if limit - 0.3 * (before - limit) > math.cos(target):
            break
        packing.centre(0.3, 200)
    packing.centre(1e-6, 20)
    return packing.lines


def random_lines(count, random):
    return unit(random.normal(size=(count, 3)))


def rotation(order, axis):
    """By a part of a full turn."""
    x, y, z = unit(numpy.array(axis, dtype=float))
    cross = numpy.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = 2.0 * math.pi / order
    return numpy.eye(3) + math.sin(angle) * cross + (1.0 - math.cos(angle)) * cross @ cross


def random_group(random):
    """A cyclic or dihedral group, or the rotations of the tetrahedron, octahedron or icosahedron."""
    kind = random.integers(6)
    if kind < 3:
        golden = 0.5 * (1.0 + math.sqrt(5.0))
        generators = [rotation(3, (1, 1, 1)), rotation((2, 4, 5)[kind], ((0, 0, 1), (0, 0, 1), (0, 1, golden))[kind])]
    else:
        generators = [rotation(random.integers(2, 13), (0, 0, 1))]
        if kind == 3:
            generators.append(rotation(2, (1, 0, 0)))
    group = [numpy.eye(3)]
    for element in group:  # which grows meanwhile
        for product in (generator @ element for generator in generators):
            if not any(numpy.allclose(product, known, atol=1e-6) for known in group):
                group.append(product)
    return numpy.array(group)


def random_seed(group, random):
    """A line whose orbit is short, for a rotation fixes it, or one in general position."""
    direction = random_lines(1, random)[0]
    element = group[random.integers(len(group))]
    if numpy.trace(element) > 3.0 - 1e-6 or random.random() < 0.4:
        return direction
    values, vectors = numpy.linalg.eig(element)
    axis = vectors[:, numpy.abs(values - 1.0).argmin()].real
    if numpy.trace(element) < -1.0 + 1e-6 and random.random() < 0.5:
        return unit(numpy.cross(direction, axis))  # half a turn keeps the lines across its axis, too
    return unit(axis)


def symmetric_lines(count, random):
    """Lines which a random finite group of rotations maps onto each other: orbits of random size as far as they fit,
    independent lines for the rest. Many of the best packings are of this kind, and few random starts lead there."""
    group = random_group(random)
    lines = numpy.empty((0, 3))
    for _ in range(100):
        orbit = numpy.empty((0, 3))
        for image in group @ random_seed(group, random):
            if not (numpy.abs(numpy.concatenate([lines, orbit]) @ image) > 1.0 - 1e-6).any():
                orbit = numpy.append(orbit, [image], axis=0)
        if len(lines) + len(orbit) <= count:
            lines = numpy.concatenate([lines, orbit])
        if len(lines) == count:
            break
    return numpy.concatenate([lines, random_lines(count - len(lines), random)])


def disturbed_lines(lines, random):
    """A packing with a few of its lines, next to one another, put somewhere else."""
    centre = random_lines(1, random)[0]
    lines = lines[numpy.argsort(-numpy.abs(lines @ centre))]
    moved = 1 + random.integers(1 + len(lines) // 8)
    return numpy.concatenate([random_lines(moved, random), lines[moved:]])


def search_directions(count, known, starts, random):
    """The best packing of so many lines that local searches from independent, symmetric and disturbed starts find;
    `known`, if there is one, where they find nothing better."""
    best = random_lines(count, random) if known is None else known
    for i in range(starts):
        start = (random_lines(count, random), symmetric_lines(count, random), disturbed_lines(best, random))[i % 3]
        smoothness = 10.0 ** random.uniform(*((-3.0, 0.5), (-3.0, 0.5), (-4.0, -0.5))[i % 3])
        found = pack_lines(start, smoothness, smallest_angle(best))
        if smallest_angle(found) > smallest_angle(best) + LEAST_GAIN:
            best = found
    return best


def better_of_fewer(lines, one_more):
    """The packing, unless one of one line more has a larger angle: then the best of as many lines that comes from
    leaving out one of those."""
    best = lines
    if smallest_angle(one_more) > smallest_angle(lines) + LEAST_GAIN:
        for i in range(len(one_more)):
            fewer = numpy.delete(one_more, i, axis=0)
            best = max(best, fewer, pack_lines(fewer, 1e-4, smallest_angle(best)), key=smallest_angle)
    return best


def arranged_directions(lines, random):
    """The packing turned so that no line comes near a coordinate axis, with z > 0, in an order in which each is as far
    as possible from all before it."""
    turned = (unit(lines @ numpy.linalg.qr(random.normal(size=(3, 3)))[0]) for _ in range(1000))
    lines = min(turned, key=lambda candidate: numpy.abs(candidate).max())
    lines = numpy.where(lines[:, 2:] < 0.0, -lines, lines)
    order = [0]
    while len(order) < len(lines):
        nearness = numpy.abs(lines @ lines[order].T).max(axis=1)
        nearness[order] = math.inf
        order.append(nearness.argmin())
    return lines[order]


def read_table(text):
    """The sets by their number of lines, and the commands that made them."""
    commands = re.findall(r'^//   (generate_direction_sets .*)$', text, re.MULTILINE)
    sets = {}
    for block in text.split('// N = ')[1:]:
        heading, *rows = block.splitlines()
        sets[int(heading.split(':')[0])] = numpy.array([[float(x) for x in row[1:-2].split(', ')] for row in rows])
    return sets, commands


def table_text(sets, commands):
    lines = ['// Packings of N = 3 ... 100 lines through the origin of R^3, a unit vector for every line,',
             '// one set after another. Generated, do not edit; made by, one after the other:',
             *('//   ' + command for command in commands)]
    for count, directions in sorted(sets.items()):
        lines.append(f'// N = {count}: {math.degrees(smallest_angle(directions)):.6f} degrees')
        lines += ['{' + ', '.join(repr(float(x)) for x in direction) + '},' for direction in directions]
    return '\n'.join(lines) + '\n'


def search(task):
    count, known, starts, seed = task
    found = search_directions(count, known, starts, numpy.random.default_rng([seed, count]))
    print(f'{count} lines: {math.degrees(smallest_angle(found)):.6f} degrees', flush=True)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--seed', type=int, default=1, help='of the random starts')
    parser.add_argument('--starts', type=int, default=1000, help='for each number of lines')
    parser.add_argument('--up-to', type=int, default=MOST_LINES, help='search no sets of more lines')
    arguments = parser.parse_args()
    known, commands = read_table(TABLE.read_text())
    sets = dict(known)
    counts = range(arguments.up_to, FEWEST_LINES - 1, -1)
    with multiprocessing.Pool() as pool:
        tasks = [(count, known[count], arguments.starts, arguments.seed) for count in counts]
        sets.update(zip(counts, pool.map(search, tasks, chunksize=1)))
    for count in range(MOST_LINES - 1, FEWEST_LINES - 1, -1):
        sets[count] = better_of_fewer(sets[count], sets[count + 1])
    random = numpy.random.default_rng(arguments.seed)
    for count, directions in known.items():
        is_better = smallest_angle(sets[count]) > smallest_angle(directions) + LEAST_GAIN
        sets[count] = arranged_directions(sets[count], random) if is_better else directions
    commands.append(f'generate_direction_sets --seed {arguments.seed} --starts {arguments.starts}'
                    + f' --up-to {arguments.up_to}' * (arguments.up_to < MOST_LINES))
    TABLE.write_text(table_text(sets, commands))


if __name__ == '__main__':
    main()
