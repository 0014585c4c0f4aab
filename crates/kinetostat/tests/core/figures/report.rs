//! Numbers of an independent program: eqs 3.25, 3.26, 3.34, 3.35, Tables 3.2 and 3.3, section 4.6.1.

use super::{Figures, Worst};
use crate::beam_tables_3_2_and_3_3::{beam, expand, section};
use crate::common::{golden, number};
use crate::{stewart_gough_3_34_and_3_35, two_link_chain_4_31};
use kinetostat::{Pose, solve_chain, unloaded_stiffness};

#[test]
fn beams_of_eqs_3_25_and_3_26_and_of_tables_3_2_and_3_3() {
    let mut f = Figures::new();
    let file = golden("table_3_2.json");
    let (section, length) = section(&file["beam"]);
    let k0 = section.cantilever(length).unwrap();
    let mut worst = Worst::new();
    worst.matrix(&k0, &expand(&file["computed_beam"]), &k0);
    let unit = "relative, worst entry (test's tolerance)";
    f.at_most("Eqs 3.25, 3.26: beam stiffness", &worst, 1e-11, unit);

    for (table, at_root) in [("3.2", false), ("3.3", true)] {
        let file = golden(&format!("table_{}.json", table.replace('.', "_")));
        let (mut worst, mut ranks) = (Worst::new(), vec![]);
        for case in file["cases"].as_array().unwrap() {
            let chain = beam(case, &section, length, at_root);
            let home = chain.home_coordinates();
            let k = unloaded_stiffness(&chain, &Pose::identity(), &home, &[]).unwrap();
            let expected = expand(&case["printed"]).component_mul(&k0);
            worst.matrix(&k.cartesian.matrix, &expected, &k0);
            ranks.push(k.rank);
        }
        let name = format!("Table {table}: stiffness of beam and joint");
        f.at_most(&name, &worst, 1e-10, unit);
        f.exactly(
            &format!("Table {table}: rank of every case"),
            &ranks,
            5,
            "rank",
        );
    }
    f.finish();
}

#[test]
fn six_legged_platforms_of_eqs_3_34_and_3_35() {
    let mut f = Figures::new();
    let file = golden("stewart_gough.json");
    for (case, eq) in file["cases"].as_array().unwrap().iter().zip([34, 35]) {
        let (mut worst, mut ranks) = (Worst::new(), vec![]);
        for arm_in_chain in [false, true] {
            let machine = stewart_gough_3_34_and_3_35::machine(&file, case, arm_in_chain);
            let home = machine.platforms()[machine.tool()].home;
            let k = machine.posture(&home).unwrap().stiffness().unwrap();
            let expected = expand(&case["computed"]);
            worst.all_apart(k.cartesian.matrix.as_slice(), expected.as_slice());
            ranks.push(k.rank());
        }
        f.at_most(
            &format!("Eq 3.{eq}: stiffness"),
            &worst,
            1e-5,
            "N/m, N, N m (test's tolerance)",
        );
        let rank = case["rank"].as_u64().unwrap() as usize;
        f.exactly(&format!("Eq 3.{eq}: rank"), &ranks, rank, "rank");
    }
    f.finish();
}

#[test]
fn closed_form_of_section_4_6_1() {
    let file = golden("table_5_2.json");
    let chain = two_link_chain_4_31::chain();
    let a0 = number(&file["alpha0_deg"]).to_radians();
    let [mut f_x, mut f_y, mut k_x, mut k_y] = [(); 4].map(|()| Worst::new());
    for case in file["cases"].as_array().unwrap() {
        let (problem, load) = two_link_chain_4_31::loaded(&chain, a0, case);
        let e = solve_chain(&problem, &Default::default()).unwrap();
        let expected = |key: &str| number(&case["computed"][key]);
        let k = e.stiffness.cartesian.matrix;
        f_x.add((e.wrench.0[0] - expected("F_x")) / (1.0 + load));
        f_y.apart(e.wrench.0[1], expected("F_y"));
        let x = expected("K_x");
        k_x.add((k[(0, 0)] - x) / (1.0 + x.abs()));
        k_y.apart(k[(1, 1)], expected("K_y"));
    }
    let mut f = Figures::new();
    let mut put = |what: &str, worst: &Worst, most: f64, unit: &str| {
        let name = format!("Section 4.6.1, two-link chain, 12 loads: {what}");
        f.at_most(&name, worst, most, &format!("{unit} (test's tolerance)"));
    };
    // The reference has 8 to 10 digits.
    put("F_x", &f_x, 2e-9, "share of K/L + G");
    put("F_y", &f_y, 1e-9, "K/L");
    put("K_x", &k_x, 1e-7, "share of K/L^2 + K_x");
    put("K_y", &k_y, 1e-7, "K/L^2");
    f.finish();
}
