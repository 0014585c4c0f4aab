#!/usr/bin/env python3
"""Compares `kinetostat identify` with FIGAROH on an arm with elastic joints that carries a known mass.

    validation/scripts/identify_with_figaroh.py [PATH OF KINETOSTAT]

FIGAROH (PyPI: figaroh; it brings Pinocchio) calibrates arms. One of its parameters is the compliance of a joint: the joint turns by
the compliance times the torque of the arm's own weight at the commanded posture. The arm has six axes and a known geometry, its links
have no mass. FIGAROH reads the load of 150 kg as the mass of the tool in the URDF, kinetostat as `mass_kg` of the table. Both read the
same places of the tool in 30 postures. Pinocchio computes three sets of them:

- real: the equilibrium (torques of the deflected arm) with random errors of 30 um. The two estimates differ by less than their deviations.
- exact: the equilibrium without errors. `identify` finds the true compliances to 1e-6. FIGAROH misses them by up to 0.3 %.
- commanded: torques of the commanded posture, without errors. FIGAROH finds the true compliances to 1e-6, which explains the 0.3 %.

In each set `identify --small-loads` agrees to 1e-6 with the linear least squares of FIGAROH's derivatives at the rigid arm. FIGAROH
multiplies a compliance by the torque that holds the weight, so its values are negative. Both programs leave out joint 1, because a
vertical load puts no torque on it. FIGAROH's deviations assume independent errors, those of kinetostat use the scatter between postures.
If FIGAROH is missing, the script prints it and ends with 0. Exit status 1: a difference.
"""

import contextlib
import io
import json
import pathlib
import subprocess
import sys
import tempfile
import warnings

# FIGAROH warns at its import and of its default weights, which are the same for all readings.
warnings.simplefilter("ignore")
try:
    import numpy as np
    import pinocchio as pin
    from figaroh.calibration.base_calibration import BaseCalibration
    from figaroh.calibration.calibration_tools import calc_updated_fkm, measurement_jacobian
    from figaroh.tools.robot import Robot
except ImportError as missing:
    print(f"left out: {missing}")
    sys.exit(0)

MASS_KG = 150.0
TRUE = 1e-6 * np.array([0.25, 0.30, 0.40, 3.0, 3.3, 2.4])  # rad/(N m)
NAMES = ["A1", "A2", "A3", "A4", "A5", "A6"]
AXES = ["0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0"]
ORIGINS = ["0 0 0", "0.35 0 0.75", "0 0 1.25", "0 0 -0.055", "1.5 0 0", "0 0 0"]  # m, in the frame of the joint before
LIMITS = np.radians([150, 60, 75, 170, 110, 170])
TOOL = "0.48 0.40 -0.05"  # m; a load on axis 6 would not show joint 6, so the tool is 0.4 m beside it


def urdf(inertial):
    """URDF of the arm, with the given element in the link of the tool."""
    links = "".join(f'<link name="{name}"/>' for name in ["base", *NAMES])
    joints = "".join(
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{name}"/><origin xyz="{origin}"/>'
        f'<axis xyz="{axis}"/><limit lower="{-limit}" upper="{limit}" effort="1e5" velocity="1"/></joint>'
        for name, parent, origin, axis, limit in zip(NAMES, ["base", *NAMES[:-1]], ORIGINS, AXES, LIMITS, strict=True)
    )
    tip = f'<joint name="tip" type="fixed"><parent link="A6"/><child link="tool"/><origin xyz="{TOOL}"/></joint>'
    return f'<robot name="arm">{links}<link name="tool">{inertial}</link>{joints}{tip}</robot>'


def place(robot, q, rounds):
    """Place of the tool (m): one round takes the torques of the commanded posture, more rounds converge to the equilibrium."""
    bent = q
    for _ in range(rounds):
        bent = q - TRUE * pin.computeGeneralizedGravity(robot.model, robot.data, bent)
    return robot.framePlacement(bent, robot.model.getFrameId("tool")).translation.copy()


def by_figaroh(robot, folder, rows):
    """Linear estimate, estimate and its standard deviations of joints 2 to 6."""
    np.savetxt(folder / "figaroh.csv", rows, "%.17g", ",", header=",".join([*NAMES, "x1", "y1", "z1"]), comments="")
    task = {"kinematics": {"tool_frame": "tool"}, "measurements": {"markers": [{}]}, "data": {"source_file": str(folder / "figaroh.csv")}}
    task["parameters"] = {"calibration_level": "joint_offset", "include_non_geometric": True}
    (folder / "figaroh.yaml").write_text(json.dumps({"robot": {"name": "arm"}, "tasks": {"calibration": task}}))
    with contextlib.redirect_stdout(io.StringIO()):
        fit = BaseCalibration(robot, str(folder / "figaroh.yaml"))
        fit.load_data_set()
        fit.eliminate_absorbed_parameters()  # `create_param_list` would add the geometry, which is known
        fit.solve(enable_logging=False)
    assert fit.calib_config["param_name"] == ["k_RY_A2", "k_RY_A3", "k_RX_A4", "k_RY_A5", "k_RX_A6"]
    arm = (robot.model, robot.data, np.zeros(5), fit.q_measured, fit.calib_config)
    # FIGAROH's default step of 1e-6 rad/(N m) is as large as the compliances.
    linear = np.linalg.lstsq(measurement_jacobian(*arm, step=1e-10), fit.PEE_measured - calc_updated_fkm(*arm), rcond=None)[0]
    return -linear, -fit.var_, np.array(fit.std_dev)


def by_kinetostat(program, folder, *options):
    """Compliances of joints 2 to 6 and their standard deviations."""
    command = [program, "identify", folder / "arm.toml", "--measured", folder / "places.csv", "--json", *options]
    numbers = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)["numbers"]
    assert [number["knowledge"] == "unseen" for number in numbers] == [True] + [False] * 5
    compliances = np.array([1 / number["identified"] for number in numbers[1:]])
    return compliances, compliances * [number["deviation_percent"] / 100 for number in numbers[1:]]


def main(program, folder):
    """Runs both programs on the three sets, prints what they find and asserts what the head of this file states."""
    inertia = '<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>'
    (folder / "loaded.urdf").write_text(urdf(f'<inertial><mass value="{MASS_KG}"/>{inertia}</inertial>'))
    (folder / "bare.urdf").write_text(urdf(""))
    options = ["--tip", "tool", "--joint-stiffness", "1e6", "-o", folder / "arm.toml"]
    subprocess.run([program, "import", "urdf", folder / "bare.urdf", *options], check=True, capture_output=True)
    robot, random = Robot(str(folder / "loaded.urdf"), str(folder)), np.random.default_rng(20261126)
    commanded = LIMITS * random.uniform(-1, 1, (30, 6))
    rigid, exact, first = (np.array([place(robot, q, rounds) for q in commanded]) for rounds in (0, 60, 1))
    sets = {"real": exact + 30e-6 * random.standard_normal((30, 3)), "exact": exact, "commanded": first}
    for name, measured in sets.items():
        rows = [[commanded, 1e3 * rigid, np.zeros((30, 1))], [commanded, 1e3 * measured, np.full((30, 1), MASS_KG)]]
        columns = ",".join([*(f"{joint}_rad" for joint in NAMES), "x_mm", "y_mm", "z_mm", "mass_kg"])
        np.savetxt(folder / "places.csv", np.block(rows), "%.17g", ",", header=columns, comments="")
        linear, theirs, theirs_std = by_figaroh(robot, folder, np.hstack([commanded, measured]))
        (small, _), (ours, ours_std) = by_kinetostat(program, folder, "--small-loads"), by_kinetostat(program, folder)
        print(f"{name} (1e-6 rad/(N m), joints 2 to 6)")
        shown = {"true": TRUE[1:], "FIGAROH, linear": linear, "kinetostat --small-loads": small, "FIGAROH": theirs}
        shown |= {"FIGAROH, deviation": theirs_std, "kinetostat": ours, "kinetostat, deviation": ours_std}
        for label, values in shown.items():
            print(f"  {label:24}", *(f"{1e6 * value:10.7f}" for value in values))
        np.testing.assert_allclose(small, linear, rtol=1e-6)
        if name == "real":
            assert np.all(np.abs(ours - theirs) < np.minimum(ours_std, theirs_std)), "the estimates differ"
            assert np.all(np.abs(ours - TRUE[1:]) < 3 * ours_std), "an estimate is not the true one"
            np.testing.assert_allclose(ours_std, theirs_std, rtol=0.45)  # a scatter of 30 postures is known to 15 %
        else:
            np.testing.assert_allclose(ours if name == "exact" else theirs, TRUE[1:], rtol=1e-6)


with tempfile.TemporaryDirectory() as scratch:
    main(sys.argv[1] if len(sys.argv) > 1 else "kinetostat", pathlib.Path(scratch))
