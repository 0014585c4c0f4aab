"""Poses, gravity torques and mass matrices of a URDF by Pinocchio, for comparison with the import.

Reads one JSON object from the standard input:
  urdf      path of the file
  base, tip links
  joints    names of independent joints, in order
  values    list of postures, one number (rad or m) for each of these joints
Other joints stand at zero; mimic joints are set here from the file, and their torques are added to
those of the joint that they follow.

Writes {"poses": [[12 numbers: three rows of the 3x4 matrix base from tip], ...],
        "torques": [[torque that holds the joint against gravity, N m or N], ...],
        "masses": [[rows of the mass matrix by the independent joints, one after the other], ...]}.
Gravity is 9.81 m/s^2 against z of the root link. Exit code 3: Pinocchio is not installed.
"""

import json
import sys
import xml.etree.ElementTree as ElementTree

try:
    import numpy as np
    import pinocchio as pin
except ImportError:
    sys.exit(3)


def mimics(path):
    """Follower -> (source, multiplier, offset), resolved to independent joints."""
    written = {}
    for joint in ElementTree.parse(path).getroot().findall("joint"):
        mimic = joint.find("mimic")
        if mimic is not None and joint.get("type") != "fixed":
            written[joint.get("name")] = (
                mimic.get("joint"),
                float(mimic.get("multiplier", 1.0)),
                float(mimic.get("offset", 0.0)),
            )
    resolved = {}
    for name in written:
        source, multiplier, offset = written[name]
        while source in written:
            source, m, o = written[source]
            offset += multiplier * o
            multiplier *= m
        resolved[name] = (source, multiplier, offset)
    return resolved


def main():
    asked = json.load(sys.stdin)
    model = pin.buildModelFromUrdf(asked["urdf"])
    model.gravity.linear = np.array([0.0, 0.0, -9.81])
    data = model.createData()
    followers = mimics(asked["urdf"])
    base = model.getFrameId(asked["base"], pin.FrameType.BODY)
    tip = model.getFrameId(asked["tip"], pin.FrameType.BODY)

    def put(q, name, value):
        if not model.existJointName(name):
            return
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 2:  # without limits: cosine and sine
            q[joint.idx_q] = np.cos(value)
            q[joint.idx_q + 1] = np.sin(value)
        else:
            q[joint.idx_q] = value

    # Velocities of all joints by those of the independent ones.
    rates = np.zeros((model.nv, len(asked["joints"])))
    for column, name in enumerate(asked["joints"]):
        if model.existJointName(name):
            rates[model.joints[model.getJointId(name)].idx_v, column] = 1.0
        for follower, (source, multiplier, _) in followers.items():
            if source == name and model.existJointName(follower):
                rates[model.joints[model.getJointId(follower)].idx_v, column] = multiplier

    poses, torques, masses = [], [], []
    for posture in asked["values"]:
        q = pin.neutral(model)
        values = dict(zip(asked["joints"], posture))
        for name, value in values.items():
            put(q, name, value)
        for name, (source, multiplier, offset) in followers.items():
            put(q, name, multiplier * values.get(source, 0.0) + offset)
        pin.framesForwardKinematics(model, data, q)
        pose = data.oMf[base].inverse() * data.oMf[tip]
        poses.append(np.hstack([pose.rotation, pose.translation[:, None]]).ravel().tolist())
        each = pin.computeGeneralizedGravity(model, data, q)
        total = []
        for name in asked["joints"]:
            torque = 0.0
            if model.existJointName(name):
                torque = each[model.joints[model.getJointId(name)].idx_v]
            for follower, (source, multiplier, _) in followers.items():
                if source == name and model.existJointName(follower):
                    torque += multiplier * each[model.joints[model.getJointId(follower)].idx_v]
            total.append(float(torque))
        torques.append(total)
        mass = np.triu(pin.crba(model, data, q))
        mass = mass + np.triu(mass, 1).T
        masses.append((rates.T @ mass @ rates).ravel().tolist())
    json.dump({"poses": poses, "torques": torques, "masses": masses, "version": pin.__version__}, sys.stdout)


main()
