//! The Orthoglide against an independent program [R chapters 5.5.3, 6]: every number was
//! computed by an independent program to 13 digits. Printed values are checked to the print.

use crate::common::{
    Orthoglide, all_close, assert_equilibrium, block_error, close, golden, matrix, name, number,
    numbers, rank,
};
use kinetostat::{Directions, MechanismEquilibrium, Pose, Twist, Wrench, compensate, model::Role};
use kinetostat_testing::{LargestEntry, largest_size};
use nalgebra::{Matrix6, Vector3};
use serde_json::Value;

pub fn target(point: &Value) -> Pose {
    let p = numbers(&point["point"]);
    Pose::translation(p[0] * 1e-3, p[1] * 1e-3, p[2] * 1e-3)
}

/// SI compliance -> N, mm: m/N to mm/N, 1/N stays, rad/(N m) to rad/(N mm).
pub fn compliance_to_mm(c: &Matrix6<f64>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| match (i < 3, j < 3) {
        (true, true) => c[(i, j)] * 1e3,
        (false, false) => c[(i, j)] * 1e-3,
        _ => c[(i, j)],
    })
}

/// SI stiffness -> N, mm: N/m to N/mm, N stays, N m to N mm.
fn to_mm(k: &Matrix6<f64>) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| match (i < 3, j < 3) {
        (true, true) => k[(i, j)] * 1e-3,
        (false, false) => k[(i, j)] * 1e3,
        _ => k[(i, j)],
    })
}

pub fn milling(file: &Value) -> Wrench {
    let w = numbers(&file["wrench"]);
    Wrench::new(
        Vector3::new(w[0], w[1], w[2]),
        Vector3::new(w[3], w[4], w[5]) * 1e-3,
    )
}

pub fn mm(twist: &Twist) -> [f64; 3] {
    let d = twist.linear() * 1e3;
    [d.x, d.y, d.z]
}

#[test]
fn unloaded_compliance_and_legs_of_section_2_4() {
    let file = golden("orthoglide_unloaded.json");
    let machine = Orthoglide::default().build();
    for point in file["points"].as_array().unwrap() {
        let q = name(point);
        let computed = &point["computed"];
        let posture = machine.posture(&target(point)).unwrap();
        for (leg, own) in posture
            .limbs()
            .iter()
            .zip(computed["legs"].as_array().unwrap())
        {
            close(q, leg.commands[0] * 1e3, number(&own["rho"]), 1e-9);
            let chain = &machine.limbs()[0].nominal;
            let joints = chain.indices_of(Role::Passive);
            close(q, leg.coordinates[joints[0]], number(&own["q1"]), 1e-12);
            close(q, leg.coordinates[joints[1]], number(&own["q2"]), 1e-12);
        }
        let k = posture.stiffness().unwrap();
        let c_mm = compliance_to_mm(&k.cartesian.compliance().unwrap());
        let expected = matrix(&computed["C"]);
        for i in 0..6 {
            for j in 0..6 {
                let size = (expected[(i, i)] * expected[(j, j)]).sqrt();
                close(
                    &format!("{q} C[{i}][{j}]"),
                    c_mm[(i, j)],
                    expected[(i, j)],
                    1e-9 * size,
                );
            }
        }
        let printed = &point["printed"];
        let (diag, off, rot) = (
            numbers(&printed["diag"]),
            numbers(&printed["off"]),
            numbers(&printed["rot"]),
        );
        for i in 0..3 {
            close(q, c_mm[(i, i)] * 1e4, diag[i], 1e-6 * diag[i]);
            close(q, c_mm[(3 + i, 3 + i)] * 1e7, rot[i], 1e-6 * rot[i]);
        }
        for (k, (i, j)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            close(q, c_mm[(i, j)] * 1e4, off[k], 1e-6 * diag[0]);
        }
        for (limb, own) in k.limbs.iter().zip(computed["leg_K"].as_array().unwrap()) {
            assert_eq!(
                limb.rank,
                file["leg_rank"].as_u64().unwrap() as usize,
                "{q}"
            );
            assert_eq!(rank(&limb.cartesian.matrix, 0.3), 3, "{q}");
            assert!(limb.redundant_passive.is_empty(), "{q}");
            let (found, expected) = (to_mm(&limb.cartesian.matrix), matrix(own));
            let size = |i: usize| {
                if i < 3 {
                    expected.fixed_view::<3, 3>(0, 0).largest_entry()
                } else {
                    expected.fixed_view::<3, 3>(3, 3).largest_entry()
                }
            };
            for i in 0..6 {
                for j in 0..6 {
                    let unit = (size(i) * size(j)).sqrt();
                    close(
                        &format!("{q} leg K[{i}][{j}]"),
                        found[(i, j)],
                        expected[(i, j)],
                        1e-9 * unit,
                    );
                }
            }
        }
        // Leg 1: no moment about w, no force across u: its wrenches are those of its own springs.
        assert_eq!(k.rank(), 6, "{q}");
    }
}

#[test]
fn milling_wrench_moves_the_platform_as_in_section_2_5() {
    let file = golden("orthoglide_milling.json");
    let machine = Orthoglide::default().build();
    let wrench = milling(&file);
    for point in file["points"].as_array().unwrap() {
        let q = name(point);
        let posture = machine.posture(&target(point)).unwrap();
        let e = posture.deflected_by(&wrench).unwrap();
        assert_equilibrium(&posture, &e);
        assert!(e.stable(), "{q}");
        let computed = &point["computed"];
        all_close(
            &format!("{q} dp"),
            &mm(&e.displacement),
            &numbers(&computed["dp"]),
            1e-9,
        );
        all_close(
            &format!("{q} rotation"),
            e.displacement.angular().as_slice(),
            &numbers(&computed["rotvec"]),
            1e-11,
        );
        all_close(
            &format!("{q} forces"),
            &e.actuator_forces(),
            &numbers(&computed["actuator_forces"]),
            1e-7,
        );
        for (limb, own) in e
            .limbs
            .iter()
            .zip(computed["leg_wrenches"].as_array().unwrap())
        {
            let own = numbers(own);
            all_close(q, limb.wrench.force().as_slice(), &own[..3], 1e-6);
            all_close(q, (limb.wrench.moment() * 1e3).as_slice(), &own[3..], 1e-4);
        }
        let error = block_error(&to_mm(&e.stiffness.matrix), &matrix(&computed["K_C"]));
        assert!(error < 1e-9, "{q}: loaded K_C off by {error:.1e}");
        // As printed: 1e-6 mm, 1e-9 rad, forces to the printed digits.
        let printed = &point["printed"];
        all_close(q, &mm(&e.displacement), &numbers(&printed["dp"]), 1e-6);
        all_close(
            q,
            e.displacement.angular().as_slice(),
            &numbers(&printed["rotation"]),
            1e-9,
        );
        all_close(
            q,
            &e.actuator_forces(),
            &numbers(&printed["forces"]),
            5.1e-5,
        );
    }
}

#[test]
fn the_platform_shifts_with_position_errors_as_in_table_6_1() {
    let file = golden("table_6_1.json");
    for case in file["cases"].as_array().unwrap() {
        let machine = Orthoglide {
            bar_length: number(&case["bar_length_mm"]) * 1e-3,
            slide_error: number(&file["error_mm"]) * 1e-3,
            ..Default::default()
        }
        .build();
        let q = format!("L {} {}", case["bar_length_mm"], name(case));
        let posture = machine.posture(&target(case)).unwrap();
        let (computed, printed) = (&case["computed"], &case["printed"]);

        let errors = posture.assembly_errors();
        for (i, e) in errors.iter().enumerate() {
            close(&q, e.0[i], 1e-3, 1e-15);
            close(&q, e.0.norm(), 1e-3, 1e-15);
        }
        let linear = posture.linear_assembly(&errors).unwrap();
        all_close(
            &q,
            &mm(&linear.shift),
            &numbers(&computed["linear_dp"]),
            1e-9,
        );
        assert!(linear.shift.angular().norm() < 1e-12, "{q}");
        let dq = largest_size(linear.passive.iter().flatten().copied()).to_degrees();
        close(&q, dq, number(&computed["linear_dq_max_deg"]), 1e-9);
        all_close(&q, &mm(&linear.shift), &numbers(&printed["dp"]), 0.005001);
        close(&q, dq, number(&printed["dq_max_deg"]), 0.005001);
        for w in &linear.wrenches {
            assert!(
                w.force().norm() < 1e-6 && w.moment().norm() < 1e-7,
                "{q}: {w:?}"
            );
        }

        let e = posture.deflected_by(&Wrench::zero()).unwrap();
        assert_equilibrium(&posture, &e);
        all_close(
            &q,
            &mm(&e.displacement),
            &numbers(&computed["exact_dp"]),
            1e-8,
        );
        let joints = machine.limbs()[0].nominal.indices_of(Role::Passive);
        let moved = e.limbs.iter().zip(posture.limbs()).flat_map(|(l, p)| {
            joints
                .iter()
                .map(|&i| l.coordinates[i] - p.coordinates[i])
                .collect::<Vec<_>>()
        });
        close(
            &q,
            largest_size(moved).to_degrees(),
            number(&computed["exact_dq_max_deg"]),
            1e-8,
        );
    }
}

#[test]
fn turned_actuator_lines_strain_the_machine_as_in_table_6_2() {
    let file = golden("table_6_2.json");
    let machine = Orthoglide {
        line_error: number(&file["error_deg"]).to_radians(),
        ..Default::default()
    }
    .build();
    let nominal = &machine.limbs()[0].nominal;
    let springs = nominal.indices_of(Role::Spring);
    let rotations: Vec<bool> = springs
        .iter()
        .map(|&i| nominal.coordinates()[i].kind == kinetostat::MotionKind::Revolute)
        .collect();
    for point in file["points"].as_array().unwrap() {
        let q = name(point);
        let posture = machine.posture(&target(point)).unwrap();

        let own = &point["computed"]["linear_own"];
        let linear = posture.linear_assembly(&posture.assembly_errors()).unwrap();
        all_close(q, &mm(&linear.shift), &numbers(&own["dp"]), 1e-8);
        let degrees: Vec<f64> = linear
            .shift
            .angular()
            .iter()
            .map(|x| x.to_degrees())
            .collect();
        all_close(q, &degrees, &numbers(&own["phi_deg"]), 1e-9);
        let m = largest_size(
            linear
                .wrenches
                .iter()
                .flat_map(|w| w.moment().as_slice().to_vec()),
        );
        close(q, m, number(&own["M_max_Nm"]), 1e-8);
        let dq = largest_size(linear.passive.iter().flatten().copied()).to_degrees();
        close(q, dq, number(&own["dq_max_deg"]), 1e-9);
        let of = |turning: bool| {
            largest_size(linear.springs.iter().flat_map(|l| {
                l.iter()
                    .zip(&rotations)
                    .filter(|(_, r)| **r == turning)
                    .map(|(x, _)| *x)
                    .collect::<Vec<_>>()
            }))
        };
        close(q, of(false) * 1e3, number(&own["theta_p_max_mm"]), 1e-8);
        close(
            q,
            of(true).to_degrees(),
            number(&own["theta_phi_max_deg"]),
            1e-9,
        );
        if point["printed_agrees"].as_bool().unwrap() {
            let printed = &point["printed"];
            all_close(q, &mm(&linear.shift), &numbers(&printed["dp"]), 0.005001);
            all_close(q, &degrees, &numbers(&printed["phi_deg"]), 0.005001);
            close(q, m, number(&printed["M_max_Nm"]), 0.005001);
            close(
                q,
                of(true).to_degrees(),
                number(&printed["theta_phi_max_deg"]),
                0.007,
            );
        }

        let e = posture.deflected_by(&Wrench::zero()).unwrap();
        assert_equilibrium(&posture, &e);
        let nonlinear = &point["computed"]["nonlinear"];
        check_shift(q, &e, nonlinear, 1e-8);
        let degrees: Vec<f64> = e
            .displacement
            .angular()
            .iter()
            .map(|x| x.to_degrees())
            .collect();
        all_close(q, &degrees, &numbers(&nonlinear["phi_deg"]), 1e-9);
        let moment = largest_size(
            e.limbs
                .iter()
                .flat_map(|l| l.wrench.moment().as_slice().to_vec()),
        );
        let force = largest_size(
            e.limbs
                .iter()
                .flat_map(|l| l.wrench.force().as_slice().to_vec()),
        );
        close(q, moment, number(&nonlinear["M_max_Nm"]), 1e-8);
        close(q, force, number(&nonlinear["F_max_N"]), 1e-7);
    }
}

fn check_shift(q: &str, e: &MechanismEquilibrium, expected: &Value, tolerance_mm: f64) {
    all_close(
        q,
        &mm(&e.displacement),
        &numbers(&expected["dp"]),
        tolerance_mm,
    );
    all_close(
        q,
        e.displacement.angular().as_slice(),
        &numbers(&expected["rotvec"]),
        tolerance_mm * 1e-1,
    );
    all_close(
        q,
        &e.actuator_forces(),
        &numbers(&expected["actuator_forces"]),
        1e-6,
    );
}

#[test]
fn errors_and_milling_wrench_act_together() {
    let file = golden("orthoglide_errors_and_milling.json");
    let machine = Orthoglide {
        line_error: number(&file["error_deg"]).to_radians(),
        ..Default::default()
    }
    .build();
    let wrench = milling(&file);
    for point in file["points"].as_array().unwrap() {
        let posture = machine.posture(&target(point)).unwrap();
        let e = posture.deflected_by(&wrench).unwrap();
        assert_equilibrium(&posture, &e);
        check_shift(name(point), &e, &point["computed"], 1e-8);
        for (limb, own) in e
            .limbs
            .iter()
            .zip(point["computed"]["leg_wrenches"].as_array().unwrap())
        {
            let own = numbers(own);
            all_close(name(point), limb.wrench.force().as_slice(), &own[..3], 1e-6);
            all_close(
                name(point),
                (limb.wrench.moment() * 1e3).as_slice(),
                &own[3..],
                1e-4,
            );
        }
    }
}

#[test]
fn a_compensated_target_brings_the_tool_to_every_reference_point() {
    let file = golden("orthoglide_milling.json");
    let machine = Orthoglide {
        line_error: 1_f64.to_radians(),
        ..Default::default()
    }
    .build();
    let wrench = milling(&file);
    let position = Directions::POSITION;
    for point in file["points"].as_array().unwrap() {
        let desired = target(point);
        let c = compensate(&machine, &desired, &wrench, position, &Default::default()).unwrap();
        assert_equilibrium(&c.posture, &c.equilibrium);
        assert!(c.left_over.linear().norm() < 1e-12, "{:?}", c.left_over);
        // Three drives: the rotation is what it is, and it is reported.
        let again = c.posture.deflected_by(&wrench).unwrap();
        let residual = kinetostat::spatial::pose_residual(&again.tool, &desired);
        assert!(residual.linear().norm() < 1e-12, "{residual:?}");
        assert!((residual.angular() - c.left_over.angular()).norm() < 1e-11);
        assert!(c.left_over.angular().norm() > 1e-4);
        assert!(c.correction.angular().norm() < 1e-14);
    }
}
