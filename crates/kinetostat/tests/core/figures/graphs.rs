//! Graphs of platforms and parallel machines: condensed against flattened, against closed forms.

use serde_json::json;

use super::{Figures, Worst};
use crate::graphs::{hybrids_apart, parallelogram_apart, rigid_limbs_apart, tower_of};
use crate::parallel_machines::{
    cubic_hexapod_apart, delta_apart, hexapod_apart, internal_wrenches, planar_3_rrr_apart,
    tripteron_apart, truss_apart,
};

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
    let shown = "explained: bars turn with their ends";
    f.print(
        &format!("{name}: wrench, loaded"),
        json!(loaded),
        "shown",
        shown,
        true,
    );
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
            put(
                &mut f,
                &format!("{name}: time of {what}"),
                time,
                most,
                "s (test's tolerance)",
            );
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
    f.finish();
}
