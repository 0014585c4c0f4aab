"""The machines of the benchmark cases W1 to W5 and their samples, for the numpy baseline.

SI units; wrenches are dead (constant in base axes), [force, moment] about the tool's origin; Jacobians
are [linear, angular] in base axes at the tool's origin. Every link is a plain spring, the product
Tx Ty Tz Rx Ry Rz of its six coordinates, with the full matrix of a clamped beam. The same machines for
kinetostat are the files of benches/models; a disagreement of the two shows in every case.
"""
import numpy as np

STEEL, STEEL_SHEAR = 2.1e11, 2.1e11 / 2.6


def clamped_beam(length, axial, bend_y, bend_z, twist):
    """Stiffness at the free end of a beam along x from its rigidities EA, EI_y, EI_z, GJ."""
    k = np.diag([axial / length, 12 * bend_z / length**3, 12 * bend_y / length**3,
                 twist / length, 4 * bend_y / length, 4 * bend_z / length])
    k[1, 5] = k[5, 1] = -6 * bend_z / length**2
    k[2, 4] = k[4, 2] = 6 * bend_y / length**2
    return k


def steel_tube(length, outer, inner=0.0):
    area = np.pi / 4 * (outer**2 - inner**2)
    second = np.pi / 64 * (outer**4 - inner**4)
    return clamped_beam(length, STEEL * area, STEEL * second, STEEL * second, STEEL_SHEAR * 2 * second)


def along(k, vector):
    """A stiffness whose own x axis lies along `vector`, in the axes of the vector."""
    x = vector / np.linalg.norm(vector)
    y = np.cross([0, 1, 0] if abs(x[2]) >= 0.9 else [0, 0, 1], x)
    y = y / np.linalg.norm(y)
    turn = np.kron(np.eye(2), np.column_stack([x, y, np.cross(x, y)]))
    return turn @ k @ turn.T


def random_directions(rng, count, length):
    v = rng.normal(size=(count, 3))
    return v * (length / np.linalg.norm(v, axis=1))[:, None]


def dead_wrenches(seed, count, force, moment):
    """A force and a moment of the given sizes (N, N m), each in its own random direction."""
    rng = np.random.default_rng(seed)
    return np.hstack([random_directions(rng, count, force), random_directions(rng, count, moment)])


class Arm:
    """W1, W3: heavy six-axis arm; in each joint a drive's spring, then a tube, then its weight."""
    axes = [2, 1, 1, 0, 1, 0]
    link = np.array([[.35, 0, .75], [0, 0, 1.25], [.55, 0, -.055], [.55, 0, 0], [.23, 0, 0], [.15, 0, .1]])
    drive = np.array([3.8e6, 6.6e6, 3.9e6, 5.6e5, 6.6e5, 4.7e5])
    tube = [(.40, .36), (.32, .28), (.26, .23), (.22, .19), (.16, .13), (.12, .08)]
    mass = np.array([330., 270., 190., 90., 35., 25.])
    centre = -link / 2
    gravity = np.array([0, 0, -9.81])
    spring = [along(steel_tube(np.linalg.norm(v), *d), v) for v, d in zip(link, tube)]

    @classmethod
    def stiffness(cls):
        """All 42 spring coordinates: per joint the drive, then the six of the link."""
        k = np.zeros((42, 42))
        for i, own in enumerate(cls.spring):
            k[7 * i, 7 * i] = cls.drive[i]
            k[7 * i + 1:7 * i + 7, 7 * i + 1:7 * i + 7] = own
        return k

    @staticmethod
    def postures(count):
        low = np.array([-2.5, -1.0, -.6, -2.5, -1.8, -2.5])
        high = np.array([2.5, 1.0, 1.6, 2.5, 1.8, 2.5])
        return low + (high - low) * np.random.default_rng(1).random((count, 6))

    @staticmethod
    def wrenches(count):
        return dead_wrenches(2, count, 2000., 300.)


class Hexapod:
    """W2: Stewart-Gough platform, legs of universal joint, ram, tube, spherical joint."""
    foot = .60 * np.array([[np.cos(a), np.sin(a), 0] for a in np.deg2rad([-10, 10, 110, 130, 230, 250])])
    head = .35 * np.array([[np.cos(a), np.sin(a), 0] for a in np.deg2rad([-50, 50, 70, 170, 190, 290])])
    drive = 4e7
    spring = along(steel_tube(.95, .06, .04), np.array([0., 0., 1.]))

    @staticmethod
    def postures(count):
        """Positions (m), and angles of the turn Rx Ry Rz (rad)."""
        rng = np.random.default_rng(3)
        place = [.12 * (2 * rng.random(count) - 1), .12 * (2 * rng.random(count) - 1),
                 .90 + .10 * (2 * rng.random(count) - 1)]
        return np.column_stack(place), np.deg2rad(15) * (2 * rng.random((count, 3)) - 1)


class Puu:
    """W4: 3-PUU; per leg a drive, a foot, a universal joint, a strut, a universal joint."""
    strut_length, arm = .31, .03
    # Columns: the axes of each leg in the base.
    turn = np.array([np.eye(3), [[0, 0, 1], [1, 0, 0], [0, 1, 0]], [[0, 1, 0], [0, 0, 1], [1, 0, 0]]], float)
    drive = 2.8e6
    foot = steel_tube(.08, .04)
    strut = steel_tube(.31, .022, .014)
    # Coordinates of a leg in the order of its product.
    drive_at, foot_at, near_at, strut_at, far_at, count = 0, 1, 7, 9, 15, 17

    @classmethod
    def stiffness(cls):
        """The 17 coordinates of a leg; passive joints have none."""
        k = np.zeros((17, 17))
        k[0, 0] = cls.drive
        k[1:7, 1:7] = cls.foot
        k[9:15, 9:15] = cls.strut
        return k

    @staticmethod
    def postures(count):
        return .09 * (2 * np.random.default_rng(4).random((count, 3)) - 1)

    @staticmethod
    def wrenches(count):
        return dead_wrenches(5, count, 300., 10.)


class Rod:
    """W5: a thin rod of length 1 m and bending rigidity 1 N m^2, divided into pieces."""
    pieces, force = 100, 10.

    @classmethod
    def piece(cls):
        return clamped_beam(1 / cls.pieces, 1e6, 1., 1., .8)
