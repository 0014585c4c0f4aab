//! The Orthoglide by an independent program (`tests/golden`): Tables 6.1 and 6.2.

use super::{Figures, Worst};
use crate::common::{Orthoglide, golden, matrix, number, numbers};
use crate::orthoglide_reference::{compliance_to_mm, milling, mm, target};
use kinetostat::{Wrench, model::Role};
use kinetostat_testing::largest_size;

#[test]
fn compliance_of_section_2_4() {
    let file = golden("orthoglide_unloaded.json");
    let machine = Orthoglide::default().build();
    let (mut printed, mut exact, mut ranks) = (Worst::new(), Worst::new(), vec![]);
    for point in file["points"].as_array().unwrap() {
        let posture = machine.posture(&target(point)).unwrap();
        let k = posture.stiffness().unwrap();
        let c = compliance_to_mm(&k.cartesian.compliance().unwrap());
        let expected = matrix(&point["computed"]["C"]);
        for i in 0..6 {
            for j in 0..6 {
                let size = (expected[(i, i)] * expected[(j, j)]).sqrt();
                // An entry that vanishes is compared with the diagonal.
                let own = expected[(i, j)].abs();
                let unit = if own > 1e-9 * size { own } else { size };
                exact.add((c[(i, j)] - expected[(i, j)]) / unit);
            }
        }
        let digits = |key: &str| numbers(&point["printed"][key]);
        let (diagonal, off, rotational) = (digits("diag"), digits("off"), digits("rot"));
        for i in 0..3 {
            printed.add(c[(i, i)] * 1e4 / diagonal[i] - 1.0);
            printed.add(c[(3 + i, 3 + i)] * 1e7 / rotational[i] - 1.0);
        }
        for (expected, (i, j)) in off.iter().zip([(0, 1), (0, 2), (1, 2)]) {
            let unit = if *expected == 0.0 {
                diagonal[0]
            } else {
                *expected
            };
            printed.add((c[(i, j)] * 1e4 - expected) / unit);
        }
        ranks.extend(k.limbs.iter().map(|limb| limb.rank));
    }
    let mut f = Figures::new();
    let name = "Orthoglide, section 2.4, Q0-Q4";
    f.at_most(
        &format!("{name}: compliance against the printed digits"),
        &printed,
        1e-6,
        "relative, worst entry",
    );
    f.at_most(
        &format!("{name}: compliance against 13 digits"),
        &exact,
        1e-6,
        "relative, worst entry",
    );
    f.exactly(&format!("{name}: rank of every leg"), &ranks, 3, "rank");
    f.finish();
}

#[test]
fn loaded_displacement_of_section_2_5() {
    let file = golden("orthoglide_milling.json");
    let machine = Orthoglide::default().build();
    let wrench = milling(&file);
    let [mut mm_13, mut rad_13, mut force_13] = [(); 3].map(|()| Worst::new());
    let [mut mm_7, mut rad_7, mut force_7] = [(); 3].map(|()| Worst::new());
    for point in file["points"].as_array().unwrap() {
        let posture = machine.posture(&target(point)).unwrap();
        let e = posture.deflected_by(&wrench).unwrap();
        let (moved, turned) = (mm(&e.displacement), e.displacement.angular());
        let forces = e.actuator_forces();
        let computed = |key: &str| numbers(&point["computed"][key]);
        mm_13.all_apart(&moved, &computed("dp"));
        rad_13.all_apart(turned.as_slice(), &computed("rotvec"));
        force_13.all_apart(&forces, &computed("actuator_forces"));
        let printed = |key: &str| numbers(&point["printed"][key]);
        mm_7.all_apart(&moved, &printed("dp"));
        rad_7.all_apart(turned.as_slice(), &printed("rotation"));
        for (found, expected) in forces.iter().zip(printed("forces")) {
            force_7.printed(*found, expected, 7);
        }
    }
    let mut f = Figures::new();
    let mut put = |what: &str, worst: &Worst, most: f64, unit: &str| {
        let name = format!("Orthoglide, section 2.5, Q0-Q4 under load: {what}");
        f.at_most(&name, worst, most, unit);
    };
    put("shift against the printed digits", &mm_7, 1e-6, "mm");
    put("shift against 13 digits", &mm_13, 1e-6, "mm");
    put("rotation against the printed digits", &rad_7, 1e-9, "rad");
    put("rotation against 13 digits", &rad_13, 1e-9, "rad");
    put(
        "actuator forces against the printed digits",
        &force_7,
        0.51,
        "units of the 7th digit (rounding)",
    );
    put(
        "actuator forces against 13 digits",
        &force_13,
        1e-7,
        "N (test's tolerance)",
    );
    f.finish();
}

#[test]
fn shifts_of_table_6_1() {
    let file = golden("table_6_1.json");
    let mut f = Figures::new();
    for length in [310.0, 310.25] {
        let [
            mut linear,
            mut linear_q,
            mut exact,
            mut exact_q,
            mut print,
            mut print_q,
        ] = [(); 6].map(|()| Worst::new());
        let machine = Orthoglide {
            bar_length: length * 1e-3,
            slide_error: number(&file["error_mm"]) * 1e-3,
            ..Default::default()
        }
        .build();
        let joints = machine.limbs()[0].nominal.indices_of(Role::Passive);
        let cases = file["cases"].as_array().unwrap();
        for case in cases.iter().filter(|c| c["bar_length_mm"] == length) {
            let posture = machine.posture(&target(case)).unwrap();
            let l = posture.linear_assembly(&posture.assembly_errors()).unwrap();
            let dq = largest_size(l.passive.iter().flatten().copied()).to_degrees();
            let computed = &case["computed"];
            linear.all_apart(&mm(&l.shift), &numbers(&computed["linear_dp"]));
            linear_q.apart(dq, number(&computed["linear_dq_max_deg"]));
            print.all_apart(&mm(&l.shift), &numbers(&case["printed"]["dp"]));
            print_q.apart(dq, number(&case["printed"]["dq_max_deg"]));

            let e = posture.deflected_by(&Wrench::zero()).unwrap();
            let moved = e.limbs.iter().zip(posture.limbs()).flat_map(|(l, p)| {
                let turn = |&i: &usize| l.coordinates[i] - p.coordinates[i];
                joints.iter().map(turn).collect::<Vec<_>>()
            });
            exact.all_apart(&mm(&e.displacement), &numbers(&computed["exact_dp"]));
            exact_q.apart(
                largest_size(moved).to_degrees(),
                number(&computed["exact_dq_max_deg"]),
            );
        }
        let mut put = |what: &str, worst: &Worst, most: f64, unit: &str| {
            let name = format!("Table 6.1, bars of {length} mm: {what}");
            f.at_most(&name, worst, most, unit);
        };
        let (mm, deg) = ("mm (test's tolerance)", "deg (test's tolerance)");
        put("exact shift", &exact, 1e-8, mm);
        put("exact joint angles", &exact_q, 1e-8, deg);
        put("linear shift", &linear, 1e-9, mm);
        put("linear joint angles", &linear_q, 1e-9, deg);
        // Two printed decimals: half a unit, and a ten-thousandth for a tie.
        put("linear shift against the print", &print, 0.005001, "mm");
        put(
            "linear joint angles against the print",
            &print_q,
            0.005001,
            "deg",
        );
    }
    f.finish();
}

#[test]
fn nonlinear_rows_of_table_6_2() {
    let file = golden("table_6_2.json");
    let machine = Orthoglide {
        line_error: number(&file["error_deg"]).to_radians(),
        ..Default::default()
    }
    .build();
    let [mut shift, mut turn, mut moment, mut force] = [(); 4].map(|()| Worst::new());
    for point in file["points"].as_array().unwrap() {
        let posture = machine.posture(&target(point)).unwrap();
        let e = posture.deflected_by(&Wrench::zero()).unwrap();
        let expected = &point["computed"]["nonlinear"];
        let degrees = e.displacement.angular().map(f64::to_degrees);
        let parts = |of: fn(&Wrench) -> nalgebra::Vector3<f64>| {
            let all = e.limbs.iter().flat_map(|l| {
                let v = of(&l.wrench);
                [v.x, v.y, v.z]
            });
            largest_size(all)
        };
        shift.all_apart(&mm(&e.displacement), &numbers(&expected["dp"]));
        turn.all_apart(degrees.as_slice(), &numbers(&expected["phi_deg"]));
        moment.apart(parts(Wrench::moment), number(&expected["M_max_Nm"]));
        force.apart(parts(Wrench::force), number(&expected["F_max_N"]));
    }
    let mut f = Figures::new();
    let mut put = |what: &str, worst: &Worst, most: f64, unit: &str| {
        let name = format!("Table 6.2, non-linear, Q0-Q4: {what}");
        f.at_most(&name, worst, most, &format!("{unit} (test's tolerance)"));
    };
    put("shift", &shift, 1e-8, "mm");
    put("rotation", &turn, 1e-9, "deg");
    put("largest moment", &moment, 1e-8, "N m");
    put("largest force", &force, 1e-7, "N");
    f.finish();
}
