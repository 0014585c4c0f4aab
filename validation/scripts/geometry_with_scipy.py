"""Reference problem P7 of the identification by scipy: geometry together with joint compliances from places of markers.

Draws the problem with its own product of exponentials and loaded equilibria, solves it by scipy.optimize.least_squares,
and prints the compliances of joints 2 to 6 with their standard deviations, chi^2, and the predicted place of marker 1 in
the first posture of validation. m, rad, N; twists are [v; w]. Needs numpy and scipy; the build does not run it.
"""

import math

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

AXES = np.array([[0, 0, 1], [0, 1, 0], [0, 1, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0]], float)
# Points of the joints in the zero posture, then the flange.
POINTS = np.array([[0, 0, 0], [0.35, 0, 0.75], [0.35, 0, 2], [0.35, 0, 1.945], [1.85, 0, 1.945], [1.85, 0, 1.945], [2.08, 0, 1.945]])
RANGES = np.radians([[-150, 150], [-60, 60], [-70, 80], [-170, 170], [-110, 110], [-170, 170]])
COMPLIANCES = np.array([0.25, 0.30, 0.40, 3.0, 3.3, 2.4]) * 1e-6
TOOL = np.array([0.25, 0.10, -0.05])
MARKERS = np.array([[0.30, 0.12, 0.10], [0.28, -0.15, 0.05], [0.22, 0.02, -0.18]])
WEIGHTS = np.array([400, 320, 260, 60, 40, 30])[:, None] * np.array([0, 0, -9.81])
CENTRES = np.array([[0.10, 0.02, 0.55], [0.35, -0.05, 1.35], [0.55, 0.03, 2.0], [1.45, 0, 1.945], [1.87, 0.02, 1.945], [2.02, 0, 1.945]])
LOADS, NOISE = [np.zeros(3), np.array([0.0, 0.0, -2600.0])], 30e-6


class Draws:
    """splitmix64 with normals in pairs."""

    def __init__(self, seed):
        self.state, self.waiting = seed, []

    def unit(self):
        mask = 2**64 - 1
        self.state = z = (self.state + 0x9E3779B97F4A7C15) & mask
        z = ((z ^ z >> 30) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ z >> 27) * 0x94D049BB133111EB) & mask
        return ((z ^ z >> 31) >> 11) * 2.0**-53

    def normal(self):
        if self.waiting:
            return self.waiting.pop()
        r, angle = math.sqrt(-2 * math.log(1 - self.unit())), 2 * math.pi * self.unit()
        self.waiting = [r * math.sin(angle)]
        return r * math.cos(angle)

    def normals(self, count):
        return np.array([self.normal() for _ in range(count)])

    def postures(self, count):
        return np.array([[low + (high - low) * self.unit() for low, high in RANGES] for _ in range(count)])


def exponential(twist):
    """Rotation and translation of the exponential of a small twist, by its series."""
    v, w = twist[:3], twist[3:]
    square = w @ w
    shift = v + (0.5 - square / 24) * np.cross(w, v) + (1 - square / 20) / 6 * np.cross(w, np.cross(w, v))
    return Rotation.from_rotvec(w).as_matrix(), shift


def frames(twists, joints):
    """Axes and points of the joints, centres of mass, rotation and point of the flange, for joint angles in rows."""
    turn, shift = exponential(twists[0])
    rotation, point = np.tile(turn, (len(joints), 1, 1)), np.tile(shift, (len(joints), 1))
    axes, points, centres = [], [], []
    for i in range(6):
        axes.append(rotation @ AXES[i])
        points.append(point)
        rotation = rotation @ Rotation.from_rotvec(joints[:, i : i + 1] * AXES[i]).as_matrix()
        centres.append(point + rotation @ (CENTRES[i] - POINTS[i]))
        turn, shift = exponential(twists[i + 1])
        point = point + rotation @ (POINTS[i + 1] - POINTS[i] + shift)
        rotation = rotation @ turn
    return axes, points, centres, rotation, point


def places(geometry, compliances, commands, load):
    """Places of the markers in equilibrium; `geometry` holds seven twists and three errors of markers."""
    twists, theta = geometry[:42].reshape(7, 6), np.zeros_like(commands)
    for _ in range(60):
        axes, points, centres, rotation, flange = frames(twists, commands + theta)
        before, theta = theta, np.zeros_like(theta)
        for i in range(6):
            moment = np.cross(flange + rotation @ TOOL - points[i], load)
            moment = moment + sum(np.cross(centres[k] - points[i], WEIGHTS[k]) for k in range(i, 6))
            theta[:, i] = compliances[i] * np.sum(axes[i] * moment, axis=1)
        if np.abs(theta - before).max() < 1e-14:
            break
    markers = MARKERS + geometry[42:].reshape(3, 3)
    return (flange[:, None] + np.einsum("pij,mj->pmi", rotation, markers)).ravel()


def main():
    draws = Draws(51)
    errors = draws.normals(51) * np.repeat([2e-3, 5e-4, 1e-3], [6, 36, 9])
    factors = 1 + 0.15 * draws.normals(6)
    # Irreducible directions: what the Jacobian of the rigid arm sees, columns in mm and mrad.
    at = Draws(7).postures(30)
    columns = [(places(e, np.zeros(6), at, LOADS[0]) - places(-e, np.zeros(6), at, LOADS[0])) for e in 1e-6 * np.eye(51)]
    _, values, right = np.linalg.svd(np.array(columns).T, full_matrices=False)
    free = right[values > 1e-7 * values[0]]
    commands, validation = draws.postures(24), draws.postures(10)

    def shown(x, commands, loads):
        compliances = COMPLIANCES * np.append(1, x[:5])
        return np.concatenate([places(1e-3 * free.T @ x[5:], compliances, commands, load) for load in loads])

    read = shown(np.append(factors[1:], 1e3 * free @ errors), commands, LOADS)
    read += NOISE * draws.normals(len(read))
    start = np.append(np.ones(5), np.zeros(len(free)))
    found = least_squares(lambda x: (shown(x, commands, LOADS) - read) / NOISE, start, jac="3-point", xtol=1e-12, ftol=1e-14, gtol=1e-10)
    deviations = np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)))
    print("free parameters", len(found.x))
    print("c2..c6", found.x[:5] * COMPLIANCES[1:], "std", deviations[:5] * COMPLIANCES[1:])
    print("chi2", 2 * found.cost, "of", len(read) - len(found.x))
    print("marker 1", shown(found.x, validation[:1], LOADS[1:])[:3])


if __name__ == "__main__":
    main()
