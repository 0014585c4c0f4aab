"""Statics of serial arms in plain numpy, written apart from the core: joints that turn, springs in them and behind rigid links."""

from __future__ import annotations

import dataclasses

import numpy as np

AXES = {"x": np.array([1.0, 0, 0]), "y": np.array([0, 1.0, 0]), "z": np.array([0, 0, 1.0])}


def turn(axis, angle):
    """Rotation matrix about a unit axis, Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


@dataclasses.dataclass
class Arm:
    """Revolute drives with torsion springs, each followed by a rigid link."""

    axes: list[str]
    links: np.ndarray
    """(n, 3): m, in the frame behind the joint."""
    stiffness: np.ndarray
    """(n,): N m/rad."""

    def document(self):
        """The same arm as a dictionary of a model file."""
        elements = []
        for i, (axis, link, k) in enumerate(zip(self.axes, self.links, self.stiffness, strict=True)):
            elements.append({"actuator": "revolute", "name": f"joint {i + 1}", "axis": axis, "stiffness_n_m_per_rad": k, "home_deg": 0.0})
            elements.append({"rigid": {"translation_mm": (link * 1e3).tolist()}, "name": f"link {i + 1}"})
        position, rotation = self.tool(np.zeros(len(self.axes)))
        home = {"position_mm": (position * 1e3).tolist(), "x_axis": "x", "y_axis": "y"}
        assert np.allclose(rotation, np.eye(3))
        return {
            "schema": 1,
            "mechanism": {"name": "random arm", "source": "drawn by a test"},
            "platform": [{"name": "tool", "home": home, "source": "drawn by a test"}],
            "chain": {"arm": {"elements": elements}},
            "limb": [{"name": "arm", "from": "base", "to": "tool", "chain": "arm"}],
        }

    def frames(self, angles):
        """Origins and axes of the joints in base axes, and the pose of the tool."""
        position, rotation, joints = np.zeros(3), np.eye(3), []
        for axis, link, angle in zip(self.axes, self.links, angles, strict=True):
            joints.append((position, rotation @ AXES[axis]))
            rotation = rotation @ turn(AXES[axis], angle)
            position = position + rotation @ link
        return joints, position, rotation

    def tool(self, angles):
        """Position and rotation matrix of the tool."""
        _, position, rotation = self.frames(angles)
        return position, rotation

    def jacobian(self, angles):
        """(6, n): velocity of the tool and its rotation by joint rates, base axes."""
        joints, position, _ = self.frames(angles)
        return np.array([np.concatenate([np.cross(axis, position - origin), axis]) for origin, axis in joints]).T

    def equilibrium(self, commands, wrench):
        """Joint angles at which springs balance a dead wrench: theta = q + K^-1 J(theta)^T w, by Newton with differences."""
        theta = np.array(commands, dtype=float)

        def residual(angles):
            return self.stiffness * (angles - commands) - self.jacobian(angles).T @ wrench

        for _ in range(50):
            now = residual(theta)
            step = 1e-7
            columns = [(residual(theta + step * e) - residual(theta - step * e)) / (2 * step) for e in np.eye(len(theta))]
            change = np.linalg.solve(np.array(columns).T, now)
            theta = theta - change
            if np.abs(change).max() < 1e-15:
                break
        assert np.abs(residual(theta)).max() < 1e-9 * max(1.0, np.abs(wrench).max())
        return theta


def random_arm(seed):
    """An arm of six or seven joints, no two neighbours about the same axis."""
    draw = np.random.default_rng(seed)
    count = int(draw.integers(6, 8))
    axes = ["z"]
    while len(axes) < count:
        axes.append(str(draw.choice([a for a in "xyz" if a != axes[-1]])))
    return Arm(axes, draw.uniform(-0.6, 0.9, (count, 3)), 10 ** draw.uniform(4.5, 6.5, count))
