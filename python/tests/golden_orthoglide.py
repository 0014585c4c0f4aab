"""The Orthoglide against an independent program, through Python [R chapters 5.5.3, 6]: tolerances are those of the Rust tests."""

from __future__ import annotations

import numpy as np

import kinetostat as ks

# From N/m, N, N m to N/mm, N, N mm: of u^T K u.
MM = np.diag([1e-3] * 3 + [1.0] * 3)


def stiffness_to_mm(k):
    """N/m, N, N m as N/mm, N, N mm."""
    return 1e3 * MM @ k @ MM


def compliance_to_mm(c):
    """m/N, 1/N, rad/(N m) as mm/N, 1/N, rad/(N mm)."""
    return 1e-3 * np.linalg.inv(MM) @ c @ np.linalg.inv(MM)


def close(found, wanted, tolerance, what=""):
    """Numbers agree to an absolute tolerance; NaN never does."""
    np.testing.assert_allclose(found, np.asarray(wanted, dtype=float), rtol=0, atol=tolerance, equal_nan=False, err_msg=what)


def close_by_block(found, wanted, relative, what=""):
    """6 x 6: every entry to a share of the mean of its blocks on the diagonal, as units of blocks differ."""
    wanted = np.asarray(wanted, dtype=float)
    size = np.repeat([np.abs(wanted[:3, :3]).max(), np.abs(wanted[3:, 3:]).max()], 3)
    assert np.isfinite(found).all(), what
    assert (np.abs(found - wanted) / np.sqrt(np.outer(size, size))).max() <= relative, what


def postures(machine, rows):
    """Each row of a golden file with the posture at its point."""
    assert len(rows) >= 4
    for row in rows:
        yield row, machine.posture(position=1e-3 * np.array(row["point"]))


def wrench_of(file):
    """N and N mm as N and N m."""
    return np.array(file["wrench"]) * [1, 1, 1, 1e-3, 1e-3, 1e-3]


def one_leg(machine, index):
    """A machine of one leg only: its stiffness at the tool is that of the leg."""
    document = machine.to_dict()
    document["limb"] = [document["limb"][index]]
    return ks.Machine.from_dict(document)


def orthoglide_unloaded(file):
    """Compliance of the machine, commands, passive joints, stiffness and rank of every leg."""
    machine = ks.Machine.preset("orthoglide")
    legs = [one_leg(machine, i) for i in range(3)]
    many = machine.stiffness(1e-3 * np.array([row["point"] for row in file["points"]]))
    assert many.solved.all()
    for i, (row, posture) in enumerate(postures(machine, file["points"])):
        name, computed, printed = row["name"], row["computed"], row["printed"]
        close(1e3 * posture.commands, [leg["rho"] for leg in computed["legs"]], 1e-9, name)
        for (commands, coordinates), leg in zip(posture.limbs, computed["legs"], strict=True):
            assert commands.shape == (1,)
            # Drive, six springs of the foot, q1, ... : passive joints are the two that turn from home.
            assert np.abs(coordinates - leg["q1"]).min() < 1e-12, name
            assert np.abs(coordinates - leg["q2"]).min() < 1e-12, name
        one = posture.stiffness()
        wanted = np.array(computed["C"])
        size = np.sqrt(np.outer(np.diag(wanted), np.diag(wanted)))
        for found in (one.compliance, np.linalg.inv(many.matrix[i])):
            assert (np.abs(compliance_to_mm(found) - wanted) / size).max() < 1e-9, name
        close_by_block(stiffness_to_mm(one.matrix), computed["K"], 1e-9, name)
        c = compliance_to_mm(one.compliance)
        np.testing.assert_allclose(1e4 * np.diag(c)[:3], printed["diag"], rtol=1e-6)
        np.testing.assert_allclose(1e7 * np.diag(c)[3:], printed["rot"], rtol=1e-6)
        close(1e4 * c[[0, 0, 1], [1, 2, 2]], printed["off"], 1e-6 * printed["diag"][0], name)
        assert one.rank == 6
        for leg, wanted in zip(legs, computed["leg_K"], strict=True):
            own = leg.posture(position=1e-3 * np.array(row["point"])).stiffness()
            assert own.rank == file["leg_rank"], name
            close_by_block(stiffness_to_mm(own.matrix), wanted, 1e-9, name)


def orthoglide_milling(file):
    """Displacement, forces, wrenches of the legs and tangent stiffness; compensated targets bring the tool there."""
    machine = ks.Machine.preset("orthoglide")
    wrench = wrench_of(file)
    points = 1e-3 * np.array([row["point"] for row in file["points"]])
    many = machine.equilibrium(points, wrench)
    assert many.solved.all()
    assert many.stable.all()
    for i, (row, posture) in enumerate(postures(machine, file["points"])):
        name, wanted, printed = row["name"], row["computed"], row["printed"]
        one = posture.deflected_by(wrench)
        assert one.stable
        for displacement, forces, stiffness in (
            (many.displacement[i], many.actuator_forces[i], many.stiffness[i]),
            (one.displacement, one.actuator_forces, one.stiffness),
        ):
            close(1e3 * displacement[:3], wanted["dp"], 1e-9, name)
            close(displacement[3:], wanted["rotvec"], 1e-11, name)
            close(forces, wanted["actuator_forces"], 1e-7, name)
            close_by_block(stiffness_to_mm(stiffness), wanted["K_C"], 1e-9, name)
            close(1e3 * displacement[:3], printed["dp"], 1e-6, name)
            close(displacement[3:], printed["rotation"], 1e-9, name)
            close(forces, printed["forces"], 5.1e-5, name)
        turned = ks.rotation_vector(one.tool[:3, :3] @ machine.home[:3, :3].T)
        close(turned, wanted["rotvec"], 1e-11, name)
        # Of legs the assembly tells.
        legs = posture.assembly(force=wrench[:3], moment=wrench[3:]).wrench_under_load
        close(legs[:, :3], np.array(wanted["leg_wrenches"])[:, :3], 1e-6, name)
        close(1e3 * legs[:, 3:], np.array(wanted["leg_wrenches"])[:, 3:], 1e-4, name)
    targets = machine.targets(points, wrench)
    assert targets.solved.all()
    close(targets.tool[:, :3, 3], points, 1e-12)


def with_bars(length_mm):
    """The Orthoglide with other bars: drives stand farther away by as much."""
    document = ks.Machine.preset("orthoglide").to_dict()
    for element in document["chain"]["leg"]["elements"]:
        if "parallelogram" in element:
            element["length_mm"] = length_mm
        if "actuator" in element:
            element["home_mm"] = -40.5 - length_mm
    return ks.Machine.from_dict(document)


def joints_deg(found, case):
    """Largest turn of a passive joint, deg."""
    turns = [joint["shift"][case] for limb in found.answer["limbs"] for joint in limb["passive_joints"]]
    assert all(joint["unit"] == "deg" for limb in found.answer["limbs"] for joint in limb["passive_joints"])
    return np.abs(turns).max()


def table_6_1(file):
    """A millimetre along every slider shifts the platform."""
    lengths = {row["bar_length_mm"] for row in file["cases"]}
    assert len(lengths) >= 2
    for length in lengths:
        rows = [row for row in file["cases"] if row["bar_length_mm"] == length]
        for row, posture in postures(with_bars(length), rows):
            name, wanted, printed = f"{length} {row['name']}", row["computed"], row["printed"]
            found = posture.assembly(deviations=[f"*:line:{file['error_mm']}mm along x"])
            close(1e3 * found.displacement_linear[0, :3], wanted["linear_dp"], 1e-9, name)
            close(1e3 * found.displacement_linear[0, :3], printed["dp"], 0.005001, name)
            close(1e3 * found.displacement[0, :3], wanted["exact_dp"], 1e-8, name)
            assert np.linalg.norm(found.displacement_linear[0, 3:]) < 1e-12
            close(joints_deg(found, "without_load_linear"), wanted["linear_dq_max_deg"], 1e-9, name)
            close(joints_deg(found, "without_load_linear"), printed["dq_max_deg"], 0.005001, name)
            close(joints_deg(found, "without_load"), wanted["exact_dq_max_deg"], 1e-8, name)
            # Parallel shifts of the legs are no strain.
            linear = [
                [*limb["force_n"]["without_load_linear"], *limb["moment_n_m"]["without_load_linear"]] for limb in found.answer["limbs"]
            ]
            assert np.linalg.norm(np.array(linear)[:, :3], axis=1).max() < 1e-6
            assert np.linalg.norm(np.array(linear)[:, 3:], axis=1).max() < 1e-7


def table_6_2(file):
    """A degree about every slider strains the machine."""
    deviation = f"*:line:{file['error_deg']}deg about x"
    for row, posture in postures(ks.Machine.preset("orthoglide"), file["points"]):
        name, own, nonlinear = row["name"], row["computed"]["linear_own"], row["computed"]["nonlinear"]
        found = posture.assembly(deviations=[deviation])
        shift, turn = 1e3 * found.displacement_linear[0, :3], np.rad2deg(found.displacement_linear[0, 3:])
        close(shift, own["dp"], 1e-8, name)
        close(turn, own["phi_deg"], 1e-9, name)
        limbs = found.answer["limbs"]
        most = np.abs([limb["moment_n_m"]["without_load_linear"] for limb in limbs]).max()
        close(most, own["M_max_Nm"], 1e-8, name)
        close(joints_deg(found, "without_load_linear"), own["dq_max_deg"], 1e-9, name)
        springs = [spring for limb in limbs for spring in limb["springs"]]

        def largest(what, unit, springs=springs):
            return np.abs([s[what]["without_load_linear"] for s in springs if s[f"{what}_unit"] == unit]).max()

        close(largest("deflection", "mm"), own["theta_p_max_mm"], 1e-8, name)
        close(largest("deflection", "deg"), own["theta_phi_max_deg"], 1e-9, name)
        close(largest("torque", "N m"), own["tau_phi_max_Nm"], 1e-8, name)
        if row["printed_agrees"]:
            printed = row["printed"]
            close(shift, printed["dp"], 0.005001, name)
            close(turn, printed["phi_deg"], 0.005001, name)
            close(most, printed["M_max_Nm"], 0.005001, name)
            close(largest("deflection", "deg"), printed["theta_phi_max_deg"], 0.007, name)
        close(1e3 * found.displacement[0, :3], nonlinear["dp"], 1e-8, name)
        close(found.displacement[0, 3:], nonlinear["rotvec"], 1e-9, name)
        close(np.rad2deg(found.displacement[0, 3:]), nonlinear["phi_deg"], 1e-9, name)
        close(np.abs(found.wrench[:, 3:]).max(), nonlinear["M_max_Nm"], 1e-8, name)
        close(np.abs(found.wrench[:, :3]).max(), nonlinear["F_max_N"], 1e-7, name)
        sliders = [spring["torque"] for spring in found.springs if spring["spring"] == "slider"]
        close(sliders, nonlinear["actuator_forces"], 1e-6, name)
    assert sum(row["printed_agrees"] for row in file["points"]) >= 3


def orthoglide_errors_and_milling(file):
    """Errors of assembly and a load together."""
    deviation, wrench = f"*:line:{file['error_deg']}deg about x", wrench_of(file)
    for row, posture in postures(ks.Machine.preset("orthoglide"), file["points"]):
        name, wanted = row["name"], row["computed"]
        found = posture.assembly(deviations=[deviation], force=wrench[:3], moment=wrench[3:])
        close(1e3 * found.displacement_under_load[0, :3], wanted["dp"], 1e-8, name)
        close(found.displacement_under_load[0, 3:], wanted["rotvec"], 1e-9, name)
        legs = np.array(wanted["leg_wrenches"])
        close(found.wrench_under_load[:, :3], legs[:, :3], 1e-6, name)
        close(1e3 * found.wrench_under_load[:, 3:], legs[:, 3:], 1e-4, name)
        sliders = [s["torque"]["under_load"] for limb in found.answer["limbs"] for s in limb["springs"] if s["name"] == "slider"]
        close(sliders, wanted["actuator_forces"], 1e-6, name)
