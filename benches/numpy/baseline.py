"""The benchmark cases W1 to W5 in numpy: arrays over many postures, as a careful user would write them.

It holds no trick against numpy: columns are turned in place of products with rotation matrices, batches
go through LAPACK at once, and every case has the batch size that is best for it (compare.py).
"""
import numpy as np

from machines import Arm, Hexapod, Puu, Rod


def cross(a, b):
    """Cross products of the last axis; several times faster than np.cross."""
    return np.stack([a[..., 1] * b[..., 2] - a[..., 2] * b[..., 1],
                     a[..., 2] * b[..., 0] - a[..., 0] * b[..., 2],
                     a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]], -1)


def hat(v):
    """Matrices of the cross product with v from the left."""
    out = np.zeros(v.shape + (3,))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        out[..., k, j] = v[..., i]
        out[..., j, k] = -v[..., i]
    return out


def turned(frame, axis, angle):
    """frame @ rotation about one of its own axes: touches two columns."""
    c, s = np.cos(angle)[..., None], np.sin(angle)[..., None]
    j, k = (axis + 1) % 3, (axis + 2) % 3
    out = frame.copy()
    out[..., j] = c * frame[..., j] + s * frame[..., k]
    out[..., k] = c * frame[..., k] - s * frame[..., j]
    return out


def flipped(a):
    return a.swapaxes(-1, -2)


# W1: Jacobian and unloaded stiffness of the arm

ARM_COMPLIANCE = [np.linalg.inv(k) for k in Arm.spring]


def arm_stiffness(joints):
    """Jacobians (6 x 42) and stiffnesses K_C = (J K^-1 J^T)^-1, link by link."""
    count = len(joints)
    frame = np.broadcast_to(np.eye(3), (count, 3, 3))
    place = np.zeros((count, 3))
    met = []
    for i, axis in enumerate(Arm.axes):
        about, at = frame[..., axis], place
        frame = turned(frame, axis, joints[:, i])
        place = place + frame @ Arm.link[i]
        met.append((about, at, frame, place))
    jacobian = np.zeros((count, 6, 42))
    compliance = np.zeros((count, 6, 6))
    for i, (about, at, frame, end) in enumerate(met):
        drive = jacobian[:, :, 7 * i]
        drive[:, :3] = cross(about, place - at)
        drive[:, 3:] = about
        link = jacobian[:, :, 7 * i + 1:7 * i + 7]
        link[:, :3, :3] = frame
        link[:, :3, 3:] = hat(end - place) @ frame
        link[:, 3:, 3:] = frame
        compliance += link @ ARM_COMPLIANCE[i] @ flipped(link)
        compliance += drive[:, :, None] * (drive[:, None, :] / Arm.drive[i])
    return jacobian, np.linalg.inv(compliance)


# W2: stiffness of the Stewart-Gough platform

LEG_COMPLIANCE = np.zeros((7, 7))
LEG_COMPLIANCE[0, 0] = 1 / Hexapod.drive
LEG_COMPLIANCE[1:, 1:] = np.linalg.inv(Hexapod.spring)


def turn_xyz(angles):
    frame = np.broadcast_to(np.eye(3), (len(angles), 3, 3))
    for axis in range(3):
        frame = turned(frame, axis, angles[:, axis])
    return frame


def hexapod_stiffness(place, angles):
    """Sum of the legs' stiffnesses, passive joints taken out by their Schur complement [R 3.10]."""
    count = len(place)
    tool = turn_xyz(angles)
    head = np.einsum('bij,lj->bli', tool, Hexapod.head)
    leg = place[:, None] + head - Hexapod.foot
    along = leg / np.linalg.norm(leg, axis=-1)[..., None]
    # Angles of the universal joint, then of the spherical one.
    first, second = np.arctan2(-along[..., 1], along[..., 2]), np.arcsin(along[..., 0])
    base = np.broadcast_to(np.eye(3), (count, 6, 3, 3))
    after_first = turned(base, 0, first)
    ram = turned(after_first, 1, second)
    sphere = flipped(ram) @ tool[:, None]
    after_third = turned(ram, 0, np.arctan2(-sphere[..., 1, 2], sphere[..., 2, 2]))
    after_fourth = turned(after_third, 1, np.arcsin(sphere[..., 0, 2]))
    from_foot, from_head = place[:, None] - Hexapod.foot, -head
    passive = np.empty((count, 6, 6, 5))
    for k, (about, arm) in enumerate([(base[..., 0], from_foot), (after_first[..., 1], from_foot),
                                      (ram[..., 0], from_head), (after_third[..., 1], from_head),
                                      (after_fourth[..., 2], from_head)]):
        passive[..., :3, k] = cross(about, arm)
        passive[..., 3:, k] = about
    springs = np.zeros((count, 6, 6, 7))
    springs[..., :3, 0] = ram[..., 2]
    springs[..., :3, 1:4] = ram
    springs[..., :3, 4:] = hat(head) @ ram
    springs[..., 3:, 4:] = ram
    stiffness = np.linalg.inv(springs @ LEG_COMPLIANCE @ flipped(springs))
    held = stiffness @ passive
    return (stiffness - held @ np.linalg.solve(flipped(passive) @ held, flipped(held))).sum(1)


# Newton's method on the coordinates of serial chains (W3, W4)

def geometric(turn, move, force, moment):
    """d(J^T F)/dx for a dead wrench: `turn` and `move` are the columns of J in the chain's order."""
    a = cross(force[..., None, :], turn) @ flipped(move)
    out = np.triu(a)
    out = out + flipped(np.triu(a, 1))
    out += np.tril(turn @ flipped(cross(moment[..., None, :], turn)), -1)
    return out


# W3: equilibrium of the arm under its weight and a wrench

ARM_STIFFNESS = Arm.stiffness()
SLIDES = np.array([7 * i + 1 + k for i in range(6) for k in range(3)])
LINK_OF = np.arange(42) // 7
OUTER_MASS = Arm.mass[::-1].cumsum()[::-1]


def arm_columns(joints, deflection):
    """Tool, columns of its Jacobian, and first moments of the outer weights per coordinate."""
    count = len(joints)
    frame = np.broadcast_to(np.eye(3), (count, 3, 3))
    place = np.zeros((count, 3))
    turn, axis_of, at = (np.zeros((count, 42, 3)) for _ in range(3))
    centre = np.zeros((count, 6, 3))
    for i, axis in enumerate(Arm.axes):
        k = 7 * i
        turn[:, k] = axis_of[:, k] = frame[..., axis]
        at[:, k] = place
        frame = turned(frame, axis, joints[:, i] + deflection[:, k])
        place = place + frame @ Arm.link[i]
        axis_of[:, k + 1:k + 4] = flipped(frame)
        place = place + np.einsum('bij,bj->bi', frame, deflection[:, k + 1:k + 4])
        for s in range(3):
            turn[:, k + 4 + s] = axis_of[:, k + 4 + s] = frame[..., s]
            at[:, k + 4 + s] = place
            frame = turned(frame, s, deflection[:, k + 4 + s])
        centre[:, i] = place + frame @ Arm.centre[i]
    move = cross(turn, place[:, None] - at)
    move[:, SLIDES] = axis_of[:, SLIDES]
    outer = (Arm.mass[:, None] * centre)[:, ::-1].cumsum(1)[:, ::-1]
    weight = cross(turn, outer[:, LINK_OF] - OUTER_MASS[LINK_OF][:, None] * at)
    weight[:, SLIDES] = axis_of[:, SLIDES] * OUTER_MASS[LINK_OF[SLIDES]][:, None]
    return place, turn, move, weight


def arm_equilibrium(joints, wrench, stiffness, tolerance=1e-10):
    """Deflections (42), tool's position, and the loaded K_C if asked for."""
    force, moment = wrench[:, :3], wrench[:, 3:]
    deflection = np.zeros((len(joints), 42))
    for _ in range(20):
        place, turn, move, weight = arm_columns(joints, deflection)
        torque = np.einsum('bni,bi->bn', move, force) + np.einsum('bni,bi->bn', turn, moment)
        torque += weight @ Arm.gravity
        residual = deflection @ ARM_STIFFNESS - torque
        done = np.sqrt((residual**2).sum(1) / (torque**2).sum(1)).max() < tolerance
        if done and not stiffness:
            return deflection, place, None
        a = cross(np.broadcast_to(Arm.gravity, turn.shape), turn) @ flipped(weight)
        tangent = ARM_STIFFNESS - (np.triu(a) + flipped(np.triu(a, 1)) + geometric(turn, move, force, moment))
        if done:
            jacobian = np.concatenate([move, turn], -1)
            return deflection, place, np.linalg.inv(flipped(jacobian) @ np.linalg.solve(tangent, jacobian))
        deflection = deflection - np.linalg.solve(tangent, residual[..., None])[..., 0]
    raise ArithmeticError('W3 does not converge')


# W4: equilibrium of the 3-PUU

LEG_STIFFNESS = Puu.stiffness()
PASSIVE = [7, 8, 15, 16]
LEG_SLIDES = [0, 1, 2, 3, 9, 10, 11]


def legs_columns(x, slider):
    """Tips of the legs (position, orientation) and columns of their Jacobians."""
    frame = np.broadcast_to(Puu.turn, x.shape[:2] + (3, 3))
    turn, axis_of, at = (np.zeros(x.shape + (3,)) for _ in range(3))
    axis_of[:, :, 0] = frame[..., 0]
    place = frame[..., 0] * (slider + x[:, :, 0])[..., None]

    def spring(k, frame, place):
        axis_of[:, :, k:k + 3] = flipped(frame)
        place = place + np.einsum('blij,blj->bli', frame, x[:, :, k:k + 3])
        for s in range(3):
            frame = joint(k + 3 + s, s, frame, place)
        return frame, place

    def joint(k, axis, frame, place):
        turn[:, :, k] = frame[..., axis]
        at[:, :, k] = place
        return turned(frame, axis, x[:, :, k])

    frame, place = spring(1, frame, place)
    frame = joint(8, 1, joint(7, 2, frame, place), place)
    place = place + Puu.strut_length * frame[..., 0]
    frame, place = spring(9, frame, place)
    frame = joint(16, 2, joint(15, 1, frame, place), place)
    place = place + Puu.arm * frame[..., 0]
    move = cross(turn, place[:, :, None] - at)
    move[:, :, LEG_SLIDES] = axis_of[:, :, LEG_SLIDES]
    return place, frame @ flipped(Puu.turn), turn, move


def puu_start(place):
    """Joints of the undeformed legs with the tool not turned, and the sliders' commands."""
    x = np.zeros((len(place), 3, 17))
    d = np.einsum('lji,bj->bli', Puu.turn, place)
    d[..., 0] -= Puu.arm
    second = np.arcsin(-d[..., 2] / Puu.strut_length)
    first = np.arcsin(d[..., 1] / (Puu.strut_length * np.cos(second)))
    x[..., 7], x[..., 8], x[..., 15], x[..., 16] = first, second, -second, -first
    return x, d[..., 0] - Puu.strut_length * np.cos(first) * np.cos(second)


def logarithm(turn):
    """Rotation vectors of rotation matrices, exact well below half a turn."""
    v = .5 * np.stack([turn[..., 2, 1] - turn[..., 1, 2], turn[..., 0, 2] - turn[..., 2, 0],
                       turn[..., 1, 0] - turn[..., 0, 1]], -1)
    sine = np.linalg.norm(v, axis=-1, keepdims=True)
    far = sine > 1e-9
    return v * np.where(far, np.arcsin(np.minimum(sine, 1)) / np.where(far, sine, 1), 1)


def exponential(v):
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    far = angle > 1e-12
    safe, h = np.where(far, angle, 1), hat(v)
    return np.eye(3) + np.where(far, np.sin(angle) / safe, 1) * h + np.where(far, (1 - np.cos(angle)) / safe**2, .5) * (h @ h)


def puu_equilibrium(place, wrench, tolerance=1e-10):
    """Newton on legs, their end wrenches and the tool at once; a leg is a 23 x 23 block.

    Returns the tool's position and orientation.
    """
    count = len(place)
    x, slider = puu_start(place)
    at, tool = place.copy(), np.broadcast_to(np.eye(3), (count, 3, 3))
    reaction = np.zeros((count, 3, 6))
    block = np.zeros((count, 3, 23, 23))
    right = np.zeros((count, 3, 23, 7))
    right[..., 17:, 1:] = np.eye(6)
    size = np.linalg.norm(wrench, axis=1)
    for _ in range(30):
        tip, orientation, turn, move = legs_columns(x, slider)
        jacobian = np.concatenate([move, turn], -1)
        # Rows of passive joints in the stiffness are zero, so that x may hold their angles.
        forces = x @ LEG_STIFFNESS - np.einsum('blni,bli->bln', jacobian, reaction)
        closure = np.concatenate([tip - at[:, None], logarithm(orientation @ flipped(tool)[:, None])], -1)
        unbalanced = wrench - reaction.sum(1)
        off = max((np.linalg.norm(forces, axis=(1, 2)) / size).max(),
                  np.linalg.norm(closure, axis=(1, 2)).max() / Puu.strut_length,
                  (np.linalg.norm(unbalanced, axis=1) / size).max())
        if off < tolerance:
            return at, tool
        block[..., :17, :17] = LEG_STIFFNESS - geometric(turn, move, reaction[..., :3], reaction[..., 3:])
        block[..., :17, 17:] = -jacobian
        block[..., 17:, :17] = flipped(jacobian)
        right[..., :17, 0] = -forces
        right[..., 17:, 0] = -closure
        solved = np.linalg.solve(block, right)
        stiffness = solved[..., 17:, 1:].sum(1)
        step = np.linalg.solve(stiffness, (unbalanced - solved[..., 17:, 0].sum(1))[..., None])[..., 0]
        change = solved[..., 0] + np.einsum('blij,bj->bli', solved[..., 1:], step)
        x, reaction = x + change[..., :17], reaction + change[..., 17:]
        at, tool = at + step[:, :3], exponential(step[:, 3:]) @ tool
    raise ArithmeticError('W4 does not converge')


# W5: the rod bent far

def rod_equilibrium(steps=4, tolerance=1e-10):
    """Newton with the dense matrix of all 600 coordinates, the load in equal steps: the tool's position."""
    n, h = Rod.pieces, 1 / Rod.pieces
    stiffness = np.kron(np.eye(n), Rod.piece())
    x = np.zeros((n, 6))
    for step in range(1, steps + 1):
        force = np.array([0, Rod.force * step / steps, 0])
        for _ in range(40):
            frame, place = np.eye(3), np.zeros(3)
            turn, at = np.zeros((n, 6, 3)), np.zeros((n, 6, 3))
            slide = np.zeros((n, 3, 3))
            for i in range(n):
                place = place + h * frame[:, 0]
                slide[i] = frame.T
                place = place + frame @ x[i, :3]
                at[i, 3:] = place
                for s in range(3):
                    turn[i, 3 + s] = frame[:, s]
                    frame = turned(frame, s, x[i, 3 + s])
            move = cross(turn, place - at)
            move[:, :3] = slide
            turn, move = turn.reshape(6 * n, 3), move.reshape(6 * n, 3)
            torque = move @ force
            residual = stiffness @ x.ravel() - torque
            if np.linalg.norm(residual) < tolerance * np.linalg.norm(torque):
                break
            a = cross(np.broadcast_to(force, turn.shape), turn) @ move.T
            tangent = stiffness - (np.triu(a) + np.triu(a, 1).T)
            x = (x.ravel() - np.linalg.solve(tangent, residual)).reshape(n, 6)
        else:
            raise ArithmeticError('W5 does not converge')
    return place
