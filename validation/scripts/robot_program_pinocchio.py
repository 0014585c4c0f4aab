"""Where the tool of an elastic arm really is along a compensated program of a robot, by Pinocchio.

Nothing of kinetostat takes part but its outputs: the program is read here from its text, the controller's
interpolation, inverse kinematics, deflection and weight are computed here. Reads one JSON object from the standard
input:
  language             "krl", "rapid", "tp", "urscript", "val3" or "joints"
  programmed, written  paths of the program before and after the compensation; one motion a line;
                       of "joints" a table (CSV) with the columns note, A1_deg, ..., A6_deg: of rows with one note the
                       last one counts, and those with the first note are in air
  points               path of the table of points (CSV) of the compensation, of every point; not of "joints"
  orientation          between two targets: "one_axis" or "swivel_and_turn"; not of "joints"
  tool_mm              tip of the tool in the flange, of "joints": the others say it themselves
  force_n, moment_n_m  on the tip, base axes
  gravity_m_per_s2     base axes
  machine              {"urdf", "base", "tip", "joints", "stiffness_n_m_per_rad": one a joint} or {"model": path}

A model file may have revolute drives and links of tubes in series: each link is a rigid offset and then six joints
(x, y, z, rx, ry, rz) with the 6 x 6 stiffness of a cantilever at its end.

How the tool turns between two targets of a linear or circular motion:
  one_axis         about one axis, evenly: slerp of quaternions (ABB, FANUC, Universal Robots, Staubli)
  swivel_and_turn  the tool's x goes along a great circle, evenly, and the tool turns evenly about its x (KUKA's LIN)

Equilibrium: springs in all joints hold what force, moment and weight put on them in the deflected posture, found by
iteration to the last digits. Errors are those of the tool's real pose against the programmed one at the same share of
the motion, at all ends of pieces and at other places between them (of circles: against the place of the motion beside it);
pieces on which the load comes only are left out. Exit code 3: Pinocchio is not installed.
"""

import csv
import json
import math
import re
import sys
import tomllib
from pathlib import Path
from xml.etree import ElementTree

try:
    import numpy as np
    import pinocchio as pin
except ImportError:
    sys.exit(3)

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
# Irregular places inside a piece, and its end.
PLACES = (0.113, 0.271, 0.5, 0.683, 0.897, 1.0)


# --- programs ---


def numbers(text):
    return [float(word) for word in re.findall(NUMBER, text)]


def of_abc(x, y, z, a, b, c):
    turn = pin.utils.rotate("z", math.radians(a)) @ pin.utils.rotate("y", math.radians(b))
    return pin.SE3(turn @ pin.utils.rotate("x", math.radians(c)), 1e-3 * np.array([x, y, z]))


def of_quaternion(place, quaternion):
    w, x, y, z = np.array(quaternion) / np.linalg.norm(quaternion)
    return pin.SE3(pin.Quaternion(w, x, y, z).toRotationMatrix(), 1e-3 * np.array(place))


def krl_frame(text):
    words = dict(re.findall(rf"\b([XYZABC])\s+({NUMBER})", text))
    return of_abc(*(float(words[letter]) for letter in "XYZABC"))


def read_krl(path):
    """Motions {line: (word, pose, via)} in their order, tool, base."""
    frames, motions = {}, {}
    for number, line in enumerate(open(path, encoding="utf-8"), 1):
        line = line.split(";")[0].strip()
        setting = re.match(r"\$(TOOL|BASE)\s*=\s*(\{.*\})", line)
        if setting:
            frames[setting[1]] = krl_frame(setting[2])
        motion = re.match(r"(PTP|LIN|CIRC|SLIN|SCIRC)\s+(\{[^}]*\})(?:\s*,\s*(\{[^}]*\}))?", line)
        if motion:
            poses = [krl_frame(text) for text in motion.groups()[1:] if text]
            motions[number] = (motion[1], poses[-1], poses[0] if len(poses) > 1 else None)
    return motions, frames["TOOL"], frames["BASE"]


def rapid_pose(values):
    return of_quaternion(values[:3], values[3:7])


def read_rapid(path):
    """As read_krl."""
    text = open(path, encoding="utf-8").read()
    tool = re.search(r"tooldata \w+:=\[TRUE,\[(\[.*?\],\[.*?\])\],", text)
    work = re.search(r'wobjdata \w+:=\[FALSE,TRUE,"",(.*)\];', text)
    declared = {
        name: rapid_pose(numbers(values))
        for name, values in re.findall(r"robtarget (\w+):=(\[.*\]);", text)
    }
    motions = {}
    for number, line in enumerate(text.splitlines(), 1):
        motion = re.match(r"\s*Move(J|L|C)\s+(.*);", line)
        if motion is None:
            continue
        # A target is a list of lists, or a name.
        target = r"(\[\[.*?\],\[.*?\],\[.*?\],\[.*?\]\]|\w+)"
        count = 2 if motion[1] == "C" else 1
        found = re.match(",".join([target] * count), motion[2]).groups()
        poses = [declared.get(text) or rapid_pose(numbers(text)) for text in found]
        word = {"J": "PTP", "L": "LIN", "C": "CIRC"}[motion[1]]
        motions[number] = (word, poses[-1], poses[0] if count > 1 else None)
    frame = numbers(work[1])
    base = rapid_pose(frame[:7]) * rapid_pose(frame[7:])
    return motions, rapid_pose(numbers(tool[1])), base


WORDS = {"j": "PTP", "l": "LIN", "c": "CIRC"}


def read_tp(path):
    """As read_krl: W, P and R turn about x, y and z of the frame, in this order."""
    text = open(path, encoding="utf-8").read()
    pose = lambda v: of_abc(*(float(v[letter]) for letter in "XYZRPW"))
    registers = {}
    for register, part, value in re.findall(rf"PR\[(\d),(\d)\]=({NUMBER})", text):
        registers.setdefault(register, {})["XYZWPR"[int(part) - 1]] = value
    frames = dict(re.findall(r"(UTOOL|UFRAME)\[1\]=PR\[(\d)\]", text))
    tool, base = (pose(registers[frames[name]]) for name in ("UTOOL", "UFRAME"))
    positions = {
        name: pose(dict(re.findall(rf"\b([XYZWPR]) *= *({NUMBER})", values)))
        for name, values in re.findall(r"^P\[(\d+)\]\{(.*?)\};", text, re.M | re.S)
    }
    motions = {}
    for found in re.finditer(r"^ *\d+:([JLC]) P\[(\d+)\](?:\s*:\s*P\[(\d+)\])?", text, re.M):
        poses = [positions[name] for name in found.groups()[1:] if name]
        number = text.count("\n", 0, found.start()) + 1
        motions[number] = (WORDS[found[1].lower()], poses[-1], poses[0] if len(poses) > 1 else None)
    return motions, tool, base


def read_urscript(path):
    """As read_krl: poses in metres with rotation vectors, in a frame `table`."""
    pose = lambda text: pin.SE3(pin.exp3(np.array(numbers(text)[3:])), np.array(numbers(text)[:3]))
    text = open(path, encoding="utf-8").read()
    tool, base = (pose(re.search(rf"{name} ?p\[(.*?)\]", text)[1]) for name in (r"set_tcp\(", "table ="))
    motions = {}
    for number, line in enumerate(text.splitlines(), 1):
        if motion := re.match(r" *move([jlc])\(", line):
            poses = [pose(values) for values in re.findall(r"pose_trans\(table, ?p\[(.*?)\]\)", line)]
            motions[number] = (WORDS[motion[1]], poses[-1], poses[0] if len(poses) > 1 else None)
    return motions, tool, base


def read_val3(path):
    """As read_krl: the data lie beside the program; rx, ry and rz turn about the axes that were turned before."""

    def pose(values):
        x, y, z, a, b, c = values
        turns = [pin.utils.rotate(axis, math.radians(angle)) for axis, angle in zip("xyz", (a, b, c))]
        return pin.SE3(turns[0] @ turns[1] @ turns[2], 1e-3 * np.array([x, y, z]))

    data = {}
    for own in ElementTree.parse(Path(path).parent / "cell.dtx").iterfind(".//{*}Data"):
        value = own.find("{*}Value")
        data[own.get("name")] = pose([float(value.get(name, 0.0)) for name in ("x", "y", "z", "rx", "ry", "rz")])
    motions = {}
    for number, line in enumerate(open(path, encoding="utf-8"), 1):
        if motion := re.match(r" *move([jlc])\((.*),tMill,mCut\)", line):
            poses = [
                data[point or about] * (pose(numbers(by)) if about else pin.SE3.Identity())
                for about, by, point in re.findall(r"appro\((\w+),\{(.*?)\}\)|(\w+)", motion[2])
            ]
            motions[number] = (WORDS[motion[1]], poses[-1], poses[0] if len(poses) > 1 else None)
    return motions, data["tMill"], data["fPart"]


READERS = {"krl": read_krl, "rapid": read_rapid, "tp": read_tp, "urscript": read_urscript, "val3": read_val3}


# --- the controller ---


def one_axis(a, b, share):
    return a @ pin.exp3(share * pin.log3(a.T @ b))


def swivel_and_turn(a, b, share):
    x0, x1 = a[:, 0], b[:, 0]
    axis = np.cross(x0, x1)
    size = np.linalg.norm(axis)
    angle = math.atan2(size, x0 @ x1)
    axis = axis / size if size > 1e-12 else np.zeros(3)
    swivelled = pin.exp3(angle * axis) @ a
    rest = swivelled.T @ b
    turn = math.atan2(rest[2, 1], rest[1, 1])
    return pin.exp3(share * angle * axis) @ a @ pin.exp3(np.array([share * turn, 0.0, 0.0]))


def circle(a, via, b):
    """Centre, two axes and angle of the arc from a through via to b."""
    u, v = via - a, b - a
    normal = np.cross(u, v)
    square = normal @ normal
    offset = (np.cross(normal, u) * (v @ v) + np.cross(v, normal) * (u @ u)) / (2.0 * square)
    centre = a + offset
    first = a - centre
    radius = np.linalg.norm(first)
    first = first / radius
    second = np.cross(normal / math.sqrt(square), first)

    def turn(p):
        return math.atan2((p - centre) @ second, (p - centre) @ first) % (2.0 * math.pi)

    return centre, radius, first, second, turn(b)


class Segment:
    """A motion with its start."""

    def __init__(self, start, motion, orientation):
        self.start, (word, self.end, via) = start, motion
        self.turned = {"one_axis": one_axis, "swivel_and_turn": swivel_and_turn}[orientation]
        self.arc = None
        if via is not None:
            self.arc = circle(start.translation, via.translation, self.end.translation)

    def pose(self, share):
        turn = self.turned(self.start.rotation, self.end.rotation, share)
        if self.arc is None:
            place = self.start.translation + share * (self.end.translation - self.start.translation)
        else:
            centre, radius, first, second, angle = self.arc
            place = centre + radius * (math.cos(share * angle) * first + math.sin(share * angle) * second)
        return pin.SE3(turn, place)

    def share(self, place):
        """Of the point of the motion beside a place."""
        if self.arc is None:
            way = self.end.translation - self.start.translation
            return (place - self.start.translation) @ way / (way @ way)
        centre, _, first, second, angle = self.arc
        return (math.atan2((place - centre) @ second, (place - centre) @ first) % (2.0 * math.pi)) / angle


# --- the arm ---


class Arm:
    """Joints that are commanded, and springs in all joints."""

    def __init__(self, machine, gravity):
        self.model = pin.Model()
        if "urdf" in machine:
            self.of_urdf(machine)
        else:
            self.of_model(machine["model"])
        self.data = self.model.createData()
        pin.framesForwardKinematics(self.model, self.data, pin.neutral(self.model))
        self.world_from_base = self.data.oMf[self.base].copy()
        self.model.gravity.linear = self.world_from_base.rotation @ np.array(gravity)
        self.compliance = np.linalg.inv(self.stiffness)
        assert self.model.nq == self.model.nv, "a joint without limits"

    def of_urdf(self, machine):
        self.model = pin.buildModelFromUrdf(machine["urdf"])
        self.base = self.model.getFrameId(machine["base"], pin.FrameType.BODY)
        self.tip = self.model.getFrameId(machine["tip"], pin.FrameType.BODY)
        self.drives = [self.model.joints[self.model.getJointId(name)].idx_v for name in machine["joints"]]
        self.stiffness = np.zeros((self.model.nv, self.model.nv))
        self.stiffness[self.drives, self.drives] = machine["stiffness_n_m_per_rad"]

    def of_model(self, path):
        document = tomllib.load(open(path, "rb"))
        axes = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}
        joint, placement, blocks, self.drives = 0, pin.SE3.Identity(), [], []
        for element in document["chain"]["arm"]["elements"]:
            name = element.get("name", element.get("body"))
            if "actuator" in element:
                turn = pin.JointModelRevoluteUnaligned(np.array(axes[element["axis"]], dtype=float))
                joint = self.model.addJoint(joint, turn, placement, name)
                placement = pin.SE3.Identity()
                self.drives.append(self.model.joints[joint].idx_v)
                blocks.append(np.array([[element["stiffness_n_m_per_rad"]]]))
            elif "link" in element:
                way = 1e-3 * np.array(element["vector_mm"])
                length = np.linalg.norm(way)
                along = pin.Quaternion.FromTwoVectors(np.array([1.0, 0, 0]), way / length).toRotationMatrix()
                placement = placement * pin.SE3(along, way)
                for part, kind in enumerate(
                    [pin.JointModelPX, pin.JointModelPY, pin.JointModelPZ, pin.JointModelRX, pin.JointModelRY, pin.JointModelRZ]
                ):
                    joint = self.model.addJoint(joint, kind(), placement, f"{name} {part}")
                    placement = pin.SE3.Identity()
                placement = pin.SE3(along.T, np.zeros(3))
                blocks.append(cantilever(document["section"][element["link"]], length))
            else:
                weight = pin.Inertia(element["mass_kg"], 1e-3 * np.array(element["centre_of_mass_mm"]), np.zeros((3, 3)))
                self.model.appendBodyToJoint(joint, weight, placement)
        # Of limb.end: the chain's end seen from the flange, whose x lies along z there and whose y along y.
        end = document["limb"][0]["end"]
        x, y = (np.array(axes[end[key]], dtype=float) for key in ("x_axis", "y_axis"))
        flange = placement * pin.SE3(np.column_stack([x, y, np.cross(x, y)]), np.zeros(3)).inverse()
        self.base = 0
        self.tip = self.model.addFrame(pin.Frame("flange", joint, flange, pin.FrameType.OP_FRAME))
        self.stiffness = np.zeros((self.model.nv, self.model.nv))
        at = 0
        for block in blocks:
            size = len(block)
            self.stiffness[at : at + size, at : at + size] = block
            at += size

    def pose(self, q, tool):
        pin.computeJointJacobians(self.model, self.data, q)
        pin.updateFramePlacements(self.model, self.data)
        return self.world_from_base.inverse() * self.data.oMf[self.tip] * tool

    def jacobian(self, tool):
        """Of the tip, after `pose`: axes of the world."""
        pose = self.data.oMf[self.tip] * tool
        jacobian = pin.getFrameJacobian(self.model, self.data, self.tip, pin.LOCAL_WORLD_ALIGNED)
        arm = pose.translation - self.data.oMf[self.tip].translation
        jacobian[:3] -= pin.skew(arm) @ jacobian[3:]
        return jacobian

    def commands(self, wanted, tool, near):
        """Values of the drives of the rigid arm for a pose."""
        q = np.zeros(self.model.nv)
        q[self.drives] = near
        for _ in range(50):
            pose = self.pose(q, tool)
            off = np.concatenate([wanted.translation - pose.translation, pose.rotation @ pin.log3(pose.rotation.T @ wanted.rotation)])
            off[:3] = self.world_from_base.rotation @ off[:3]
            off[3:] = self.world_from_base.rotation @ off[3:]
            if np.abs(off).max() < 1e-13:
                break
            q[self.drives] += np.linalg.solve(self.jacobian(tool)[:, self.drives], off)
        assert np.abs(off).max() < 1e-11, "no inverse kinematics"
        return q

    def real(self, wanted, tool, near, wrench):
        """Where the tool is when the controller commands a pose, and the commands."""
        commands = self.commands(wanted, tool, near)
        return self.deflected(commands, tool, wrench), commands[self.drives]

    def deflected(self, commands, tool, wrench):
        """Where the tool is when the drives are commanded."""
        turn = self.world_from_base.rotation
        wrench = np.concatenate([turn @ wrench[:3], turn @ wrench[3:]])
        bent = np.zeros(self.model.nv)
        for _ in range(200):
            self.pose(commands + bent, tool)
            loads = self.jacobian(tool).T @ wrench
            loads -= pin.computeGeneralizedGravity(self.model, self.data, commands + bent)
            before, bent = bent, self.compliance @ loads
            if np.abs(bent - before).max() < 1e-14:
                break
        assert np.abs(bent - before).max() < 1e-12, "no equilibrium"
        return self.pose(commands + bent, tool)


def cantilever(section, length):
    """6 x 6 at the free end of a tube of this length, m, along x."""
    outer, inner = (1e-3 * section["tube"][f"{which}_diameter_mm"] for which in ("outer", "inner"))
    modulus = 1e9 * section["youngs_modulus_gpa"]
    shear = modulus / (2.0 * (1.0 + section["poissons_ratio"]))
    area = math.pi / 4.0 * (outer**2 - inner**2)
    second = math.pi / 64.0 * (outer**4 - inner**4)
    # Compliance: forces and moments at the free end.
    c = np.zeros((6, 6))
    c[0, 0] = length / (modulus * area)
    c[3, 3] = length / (shear * 2.0 * second)
    bending = modulus * second
    for across, about, sign in ((1, 5, 1.0), (2, 4, -1.0)):
        c[across, across] = length**3 / (3.0 * bending)
        c[about, about] = length / bending
        c[across, about] = c[about, across] = sign * length**2 / (2.0 * bending)
    return np.linalg.inv(c)


# --- comparison ---


def segments(motions, orientation):
    before, found = None, {}
    for line, motion in motions.items():
        if motion[0] != "PTP":
            found[line] = Segment(before, motion, orientation)
        before = motion[1]
    return found


def pieces(rows):
    """Rows of the same piece, in order; only motions at feed."""
    groups = []
    for row in rows:
        if row["kind"] == "rapid":
            continue
        assert row["kind"] == "feed", row["kind"]
        if not groups or groups[-1][-1]["output_line"] != row["output_line"]:
            groups.append([])
        groups[-1].append(row)
    return groups


def joints_of(path):
    """Joint values, rad, by note."""
    lines = [line for line in open(path, encoding="utf-8") if not line.startswith("#")]
    return {
        row["note"]: np.radians([float(row[f"A{joint}_deg"]) for joint in range(1, 7)])
        for row in csv.DictReader(lines)
    }


def compare_joints(asked, arm, wrench):
    tool = pin.SE3(np.eye(3), 1e-3 * np.array(asked["tool_mm"]))
    written = joints_of(asked["written"])
    figures = {name: 0.0 for name in ("at_points_m", "at_points_rad", "without_m", "without_rad")}
    rows = list(joints_of(asked["programmed"]).items())[1:]
    for note, joints in rows:
        def all_of(drives):
            q = np.zeros(arm.model.nv)
            q[arm.drives] = drives
            return q

        wanted = arm.pose(all_of(joints), tool)
        for which, drives in (("at_points", written[note]), ("without", joints)):
            real = arm.deflected(all_of(drives), tool, wrench)
            for unit, size in (
                ("m", np.linalg.norm(real.translation - wanted.translation)),
                ("rad", np.linalg.norm(pin.log3(real.rotation.T @ wanted.rotation))),
            ):
                key = f"{which}_{unit}"
                figures[key] = max(figures[key], size) if math.isfinite(size) else math.nan
    figures["rows"] = len(rows)
    return figures


def main():
    asked = json.load(sys.stdin)
    if asked["language"] == "joints":
        arm = Arm(asked["machine"], asked["gravity_m_per_s2"])
        wrench = np.concatenate([asked["force_n"], asked["moment_n_m"]])
        json.dump(compare_joints(asked, arm, wrench), sys.stdout)
        return
    read = READERS[asked["language"]]
    programmed, tool, base = read(asked["programmed"])
    written, same_tool, same_base = read(asked["written"])
    assert tool.isApprox(same_tool, 0.0) and base.isApprox(same_base, 0.0), "frames were changed"
    programmed = segments(programmed, asked["orientation"])
    written = segments(written, asked["orientation"])
    arm = Arm(asked["machine"], asked["gravity_m_per_s2"])
    wrench = np.concatenate([asked["force_n"], asked["moment_n_m"]])
    rows = list(csv.DictReader(open(asked["points"], encoding="utf-8")))
    commands = [name for name in rows[0] if "_command_" in name]
    units = [math.pi / 180.0 if name.endswith("_deg") else math.nan for name in commands]

    figures = {
        name: 0.0
        for name in (
            "at_points_m", "at_points_rad", "between_m", "between_rad",
            "without_m", "without_rad", "before_against_table_m", "commands_against_table_rad",
        )
    }

    def worst(name, value):
        figures[name] = max(figures[name], value) if math.isfinite(value) else math.nan

    def loaded(row):
        force = math.hypot(*(float(row[f"force_{axis}_n"]) for axis in "xyz"))
        return abs(force - np.linalg.norm(asked["force_n"])) < 0.02

    used, last, parts, beside = set(), (None, 0.0), [], 0
    for group in pieces(rows):
        line, output_line = int(group[0]["line"]), int(group[0]["output_line"])
        motion, piece = programmed[line], written[output_line]
        used.add(output_line)
        near = np.array([float(group[-1][name]) for name in commands]) * units
        end = 1e-3 * np.array([float(group[-1][f"{axis}_mm"]) for axis in "xyz"])
        begin = last[1] if last[0] == line else 0.0
        to = motion.share(end)
        to = 1.0 if abs(to - 1.0) < 1e-6 else to
        last = (line, to)
        if not all(loaded(row) for row in group):
            beside += 1
            continue
        parts.append(to - begin)
        for place in PLACES:
            wanted = base * motion.pose(begin + place * (to - begin))
            real, drives = arm.real(base * piece.pose(place), tool, near, wrench)
            if piece.arc is not None and place != 1.0:
                # Circles that were fitted pass the places of the path at slightly other times: what counts is how far beside it.
                wanted = base * motion.pose(motion.share((base.inverse() * real).translation))
            where = "at_points" if place == 1.0 else "between"
            worst(f"{where}_m", np.linalg.norm(real.translation - wanted.translation))
            worst(f"{where}_rad", np.linalg.norm(pin.log3(real.rotation.T @ wanted.rotation)))
            if place == 1.0:
                worst("commands_against_table_rad", np.abs(drives - near).max())
                plain, _ = arm.real(wanted, tool, near, wrench)
                off = base.rotation.T @ (plain.translation - wanted.translation)
                worst("without_m", np.linalg.norm(off))
                worst("without_rad", np.linalg.norm(pin.log3(plain.rotation.T @ wanted.rotation)))
                told = 1e-3 * np.array([float(group[-1][f"error_before_{axis}_mm"]) for axis in "xyz"])
                worst("before_against_table_m", np.linalg.norm(off - told))
    figures["pieces"] = len(parts)
    figures["pieces_where_the_load_comes"] = beside
    figures["motions"] = len(programmed)
    figures["written_and_not_seen"] = len(set(written) - used)
    figures["version"] = pin.__version__
    json.dump(figures, sys.stdout)


main()
