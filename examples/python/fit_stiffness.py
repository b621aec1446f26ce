#!/usr/bin/python3
"""Fits the bending stiffness of a cable to a recorded track of it: EI / (ρA), bending stiffness over mass per length.

Usage: fit_stiffness.py [TRACK] [--picture PNG]
       fit_stiffness.py --record TRACK

The cable is clamped at one end, is let go, and swings. Its track (CSV with frames) is compared with a simulation of the
same swing; least squares find the stiffness and the damping with which they differ least. A camera cannot weigh, so
that EI and ρA alone are not to be found, and need not be: the same quotient moves the same way.

--record makes the track that is shipped as swinging_cable.csv: a simulation with finer steps, and 1 mm of
noise on each coordinate, as of a camera.
"""
import argparse
import os

import matplotlib
import numpy as np
from scipy.optimize import least_squares

from fiber_proximity import Fibers, Simulation, read_frames, write_frames

matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402  (once it is known that there may be no screen)

FRAME = 1.0 / 30.0  # [s] from one to the next
RADIUS = 0.004  # [m]
RECORDED = 0.05, 0.01  # stiffness [m⁴/s²] and relaxation time [s] of the shipped track


def simulate(begin, stiffness, relaxation_time, frames, segments, substeps):
    """Points in each frame (frames, segments + 1, 3) of a cable that is clamped where it begins, (n, 3) [m]."""
    density = 1000.0  # any: it is in EI, too
    modulus = 4.0 * density * stiffness / RADIUS ** 2  # EI = E π r⁴ / 4, ρA = ρ π r²
    simulation = Simulation({
        'time_step': FRAME, 'substeps': substeps, 'integrator': 'bdf2',
        'fibers': [{'name': 'cable', 'shape': {'polyline': begin}, 'segments': segments, 'radius': RADIUS,
                    'material': {'youngs_modulus': modulus, 'shear_modulus': modulus / 3.0, 'density': density}}],
        'effects': ['gravity', 'inextensible', 'bend', {'damping': {'relaxation_time': relaxation_time}},
                    {'attachment': [{'fiber': 'cable', 'node': 'first', 'kind': 'clamp', 'tangent': [1, 0, 0]}]}]})
    track = [simulation.positions]
    for _ in range(frames - 1):
        simulation.step()
        track.append(simulation.positions)
    return np.array(track)


def record(path):
    track = simulate([[0, 0, 1], [0.6, 0, 1]], *RECORDED, frames=45, segments=80, substeps=16)[:, ::4]
    track += np.random.default_rng(1).normal(0.0, 0.001, track.shape)
    write_frames(path, [Fibers(points.round(5), radii=RADIUS) for points in track])


def fit(track):
    """Stiffness [m⁴/s²], relaxation time [s] and length [m], the standard errors of these, and the track that they
    give."""
    frames, points = track.shape[:2]
    clamp = track[:, 0].mean(axis=0)
    length = track[0, -1, 0] - clamp[0]  # as far as one noisy point tells

    def moved(logarithms):
        stiffness, relaxation_time, length = np.exp(logarithms)
        begin = [clamp, clamp + [length, 0, 0]]
        return simulate(begin, stiffness, relaxation_time, frames, 4 * (points - 1), substeps=8)[:, ::4]

    found = least_squares(lambda logarithms: (moved(logarithms) - track).ravel(), np.log([0.5, 0.05, length]),
                          diff_step=1e-3)
    residuals = moved(found.x) - track
    covariance = np.linalg.inv(found.jac.T @ found.jac) * residuals.var()
    return np.exp(found.x), np.exp(found.x) * np.sqrt(np.diag(covariance)), residuals + track


def draw(track, fitted, text, picture):
    figure, (shapes, errors) = plt.subplots(1, 2, figsize=(10, 4), layout='constrained')
    for frame in range(0, len(track), 4):
        color = plt.cm.viridis(frame / len(track))
        shapes.plot(track[frame, :, 0], track[frame, :, 2], '.', color=color, markersize=4)
        shapes.plot(fitted[frame, :, 0], fitted[frame, :, 2], '-', color=color, linewidth=1)
    shapes.set(xlabel='x [m]', ylabel='z [m]', aspect='equal', title='recorded (dots) and fitted (lines)')
    errors.plot(FRAME * np.arange(len(track)), 1000 * np.sqrt(((fitted - track) ** 2).mean(axis=(1, 2))))
    errors.set(xlabel='time [s]', ylabel='difference of coordinates, RMS [mm]', title=text, ylim=(0, None))
    errors.margins(x=0)
    figure.savefig(picture, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('track', nargs='?', default=os.path.join(os.path.dirname(os.path.realpath(__file__)),
                                                                 'swinging_cable.csv'))
    parser.add_argument('--picture', default='fit_stiffness.png')
    parser.add_argument('--record', metavar='TRACK', help='makes the track instead')
    arguments = parser.parse_args()
    if arguments.record:
        record(arguments.record)
        return

    track = np.array([fibers.points for _, fibers in read_frames(arguments.track)])
    (stiffness, relaxation, length), (error, relaxation_error, length_error), fitted = fit(track)
    text = f'EI / (ρA) = {stiffness:.5f} ± {error:.5f} m⁴/s²'
    print(f'{len(track)} frames of {track.shape[1]} points')
    print(text)
    print(f'relaxation time = {1000 * relaxation:.1f} ± {1000 * relaxation_error:.1f} ms')
    print(f'length = {1000 * length:.1f} ± {1000 * length_error:.1f} mm')
    print(f'difference of coordinates: {1000 * (fitted - track).std():.2f} mm RMS')
    draw(track, fitted, text, arguments.picture)


if __name__ == '__main__':
    main()
