//! Graphs of platforms and parallel machines: condensed against flattened, against closed forms.

use serde_json::json;

use super::{Figures, Worst};
use crate::graphs::hybrids_apart;
use crate::hybrids::{hybrids_apart as loaded_hybrids_apart, variants};
use crate::loads_on_platforms::{derivatives_apart, loaded_apart, spring_and_limb_apart};
use crate::machines_that_snap::{hexapod_path_apart, toggle_frame_apart, truss_path_apart};
use crate::pantographs_and_lattices::{lattice_apart, lattice_times, rigid_limbs_apart, tower_of};
use crate::parallel_machines::{
    cubic_hexapod_apart, delta_apart, hexapod_apart, internal_wrenches, tripteron_apart,
};
use crate::parallelograms::{left_out, parallelogram_apart};
use crate::planar_machines::{planar_3_rrr_apart, truss_apart};

fn put(f: &mut Figures, name: &str, deviation: f64, most: f64, unit: &str) {
    let mut worst = Worst::new();
    worst.add(deviation);
    f.at_most(name, &worst, most, unit);
}

#[test]
fn hybrids_and_rigid_limbs_against_the_flattened_system() {
    let mut f = Figures::new();
    let name = "Arm with a parallel wrist, arm on a parallel base, minus flattened";
    let [k, tool, wrenches] = hybrids_apart();
    put(
        &mut f,
        &format!("{name}: unloaded K_C"),
        k,
        1e-12,
        "relative",
    );
    put(
        &mut f,
        &format!("{name}: displacement"),
        tool,
        1e-10,
        "relative (test's tolerance)",
    );
    put(
        &mut f,
        &format!("{name}: wrenches"),
        wrenches,
        1e-8,
        "relative (test's tolerance)",
    );
    let name = "Rigid limbs between platforms, minus flattened";
    let [unloaded, loaded] = rigid_limbs_apart();
    put(
        &mut f,
        &format!("{name}: unloaded K_C"),
        unloaded,
        1e-12,
        "relative",
    );
    put(
        &mut f,
        &format!("{name}: loaded K_C"),
        loaded,
        1e-8,
        "relative (test's tolerance)",
    );
    let name = "Parallelogram by a coupled coordinate, minus two bars";
    let [unloaded, loaded] = parallelogram_apart();
    put(
        &mut f,
        &format!("{name}: unloaded K_C"),
        unloaded,
        1e-12,
        "relative",
    );
    f.print(
        &format!("{name}: wrench, loaded"),
        json!(loaded),
        "shown",
        "relative",
        true,
    );
    let [growth, explained, term] = left_out();
    put(
        &mut f,
        &format!("{name}: growth of the difference with the displacement, exponent less 2"),
        growth,
        0.05,
        "exponent",
    );
    put(
        &mut f,
        &format!("{name}: difference less the term left out, halves with the displacement"),
        explained,
        0.02,
        "of the difference at 0.1 mrad",
    );
    put(
        &mut f,
        &format!("{name}: stiffness under tension less N d^2 sin^2 q / (4 L)"),
        term,
        1e-3,
        "relative",
    );
    f.finish();
}

#[test]
fn hybrids_with_errors_preload_and_rigid_limbs_against_the_flattened_system() {
    let mut f = Figures::new();
    for (name, machine) in variants() {
        let [tool, wrenches, stiffness] = loaded_hybrids_apart(&machine);
        // The tangent of the flattened system is taken by differences, to 1e-11.
        for (what, value, most) in [
            ("displacement", tool, 1e-12),
            ("wrenches of limbs", wrenches, 1e-12),
            ("loaded K_C", stiffness, 1e-10),
        ] {
            let name = format!("{name}, minus flattened: {what}");
            put(&mut f, &name, value, most, "relative");
        }
    }
    f.finish();
}

#[test]
fn loads_on_platforms() {
    let mut f = Figures::new();
    let name = "Springs, gas springs, ropes and wrenches on platforms";
    let [tangent, energy] = derivatives_apart();
    let [displacement, stiffness] = loaded_apart();
    let [moved, matrix] = spring_and_limb_apart();
    for (what, value, most) in [
        ("tangent minus differences", tangent, 1e-8),
        ("wrench minus slope of the energy", energy, 1e-8),
        ("displacement minus flattened", displacement, 1e-11),
        ("loaded K_C minus flattened", stiffness, 1e-9),
        ("displacement minus that of a sprung limb", moved, 1e-11),
        ("loaded K_C minus that of a sprung limb", matrix, 1e-10),
    ] {
        put(
            &mut f,
            &format!("{name}: {what}"),
            value,
            most,
            "relative (test's tolerance)",
        );
    }
    f.finish();
}

#[test]
fn parallel_machines_against_closed_forms() {
    let mut f = Figures::new();
    let relative = "relative (test's tolerance)";
    put(
        &mut f,
        "Gough-Stewart at home, off home, turned: K_C",
        hexapod_apart(),
        1e-11,
        relative,
    );
    put(
        &mut f,
        "Cubic hexapod: K_C",
        cubic_hexapod_apart(),
        1e-12,
        relative,
    );
    put(&mut f, "Delta: K_C", delta_apart(), 1e-11, relative);
    put(&mut f, "Tripteron: K_C", tripteron_apart(), 1e-11, relative);
    let name = "Planar 3-RRR minus the minimum of its energy";
    put(&mut f, name, planar_3_rrr_apart(), 1e-9, relative);
    let [determinate, overconstrained] = internal_wrenches();
    let name = "Internal wrenches of a 3-PUU with errors";
    put(&mut f, name, determinate, 1e-9, "of stiffness times shift");
    let name = "Internal wrenches of the Orthoglide with errors";
    let holds = overconstrained > 1e-6;
    f.print(
        name,
        json!(overconstrained),
        "more than 1e-6",
        "of stiffness times shift",
        holds,
    );
    let [force, limits] = truss_apart();
    put(
        &mut f,
        "Truss that snaps: force along its way",
        force,
        1e-11,
        relative,
    );
    put(
        &mut f,
        "Truss that snaps: limit points",
        limits,
        1e-9,
        "m (test's tolerance)",
    );
    f.finish();
}

#[test]
fn a_machine_with_thirty_platforms() {
    let mut f = Figures::new();
    let mut before = None;
    for floors in [15, 30, 60] {
        let name = format!("{floors} platforms in series, {} limbs", 6 * floors);
        let [unloaded, loaded, elsewhere, off] = tower_of(floors);
        for (what, time, most) in [
            ("unloaded stiffness", unloaded, 5.0),
            ("equilibrium", loaded, 10.0),
            ("commands elsewhere", elsewhere, 60.0),
        ] {
            Figures::time(&format!("{name}: time of {what}"), time, most);
        }
        put(
            &mut f,
            &format!("{name}: compliance"),
            off,
            1e-9,
            "relative (test's tolerance)",
        );
        if let Some(before) = before {
            let growth = loaded / before;
            let name = format!("{name}: growth of the equilibrium's time by doubling");
            f.print(&name, json!(growth), "shown", "times", true);
        }
        before = Some(loaded);
    }
    for rigid in [false, true] {
        let bars = if rigid { ", some limbs rigid" } else { "" };
        let name = format!("12 platforms in a lattice{bars}, sparse minus flattened");
        let [unloaded, displacement] = lattice_apart(rigid);
        for (what, value) in [("unloaded K_C", unloaded), ("displacement", displacement)] {
            put(&mut f, &format!("{name}: {what}"), value, 1e-12, "relative");
        }
    }
    let times = [30.0, 60.0, 120.0].map(|n: f64| (n, lattice_times(n as usize / 6, 6)));
    for (k, what) in ["unloaded stiffness", "equilibrium", "commands elsewhere"]
        .iter()
        .enumerate()
    {
        let exponent = (times[2].1[k] / times[0].1[k]).ln() / 4.0_f64.ln();
        let name = format!("Lattices of 30 to 120 platforms: growth exponent of time of {what}");
        f.print(&name, json!(exponent), "shown", "exponent", true);
    }
    f.finish();
}

#[test]
fn machines_near_a_flat_posture() {
    let mut f = Figures::new();
    let [force, limits, landings] = truss_path_apart();
    let name = "Truss that snaps, against statics by hand";
    for (what, apart, most) in [
        ("force", force, 1e-10),
        ("limit points", limits, 1e-6),
        ("landings", landings, 1e-8),
    ] {
        let unit = "share of its height (test's tolerance)";
        put(&mut f, &format!("{name}: {what}"), apart, most, unit);
    }
    let [wrench, limits] = hexapod_path_apart();
    let name = "Hexapod near its flat posture, against the energy of its legs";
    let unit = "relative (test's tolerance, differences)";
    put(&mut f, &format!("{name}: wrenches"), wrench, 1e-6, unit);
    put(
        &mut f,
        &format!("{name}: stiffness left at limits"),
        limits,
        1e-4,
        unit,
    );
    let [exact, small] = toggle_frame_apart();
    let name = "Toggle frame of (5.45) as a machine of three legs";
    let unit = "relative (test's tolerance)";
    put(
        &mut f,
        &format!("{name}: critical displacement and force"),
        exact,
        1e-6,
        unit,
    );
    put(
        &mut f,
        &format!("{name}: minus the print's limits at 0.01 rad"),
        small,
        1e-4,
        "relative",
    );
    f.finish();
}
