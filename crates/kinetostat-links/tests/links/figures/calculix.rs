//! The example `examples/link-from-calculix` with gmsh and CalculiX themselves: three ways through the
//! files of CalculiX to one 6 x 6, against beam theory. Says so and ends where they are not installed.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use kinetostat_links::{
    CondensationRequest, Dof, Nodes, SYMMETRIC_TO, SectionShape, Shear, Superelement, Text, Tie,
    Units, cantilever, check_stiffness, condense, free_test, identify, read_displacements,
    read_nodes, read_superelement, unit_loads,
};
use kinetostat_testing::{largest, largest_size};
use nalgebra::{Matrix6, Rotation3, Vector3};

use crate::{apart, at_most};

fn installed(program: &str, argument: &str) -> bool {
    Command::new(program)
        .arg(argument)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok()
}

struct Folder(PathBuf);

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn call(folder: &Path, program: &str, arguments: &[&str]) {
    let done = Command::new(program)
        .args(arguments)
        .current_dir(folder)
        .env("OMP_NUM_THREADS", "1")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .expect("starts");
    assert!(done.success(), "{program} {arguments:?}: {done}");
}

#[test]
fn a_meshed_beam_through_calculix_agrees_with_beam_theory() {
    if !installed("ccx", "-v") || !installed("gmsh", "-version") {
        println!(
            "SKIPPED: gmsh or ccx is not installed (Debian: apt-get install gmsh calculix-ccx)"
        );
        return;
    }
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/link-from-calculix");
    let folder =
        Folder(std::env::temp_dir().join(format!("kinetostat-calculix-{}", std::process::id())));
    fs::create_dir_all(&folder.0).expect("folder");
    for name in ["link.geo", "loads.inp", "matrix.inp", "substructure.inp"] {
        fs::copy(example.join(name), folder.0.join(name)).expect("example");
    }
    call(
        &folder.0,
        "gmsh",
        &["-3", "link.geo", "-format", "inp", "-o", "gmsh.inp"],
    );
    // gmsh writes the faces as elements too; only their nodes are wanted.
    let mut skip = false;
    let mesh: String = fs::read_to_string(folder.0.join("gmsh.inp"))
        .expect("mesh")
        .lines()
        .filter(|l| {
            if l.starts_with('*') {
                skip = l.contains("type=CPS")
                    || l.starts_with("*ELSET,ELSET=ROOT")
                    || l.starts_with("*ELSET,ELSET=TIP");
            }
            !skip
        })
        .map(|l| l.to_owned() + "\n")
        .collect();
    fs::write(folder.0.join("link-mesh.inp"), mesh).expect("mesh");
    for job in ["loads", "matrix", "substructure"] {
        call(&folder.0, "ccx", &[job]);
    }
    let read = |name: &str| Text::read(&folder.0.join(name)).expect(name);
    let units = Units::named("n_mm").expect("known");
    let nodes = read_nodes(&read("link-mesh.inp"), units).expect("nodes");
    let end = Vector3::new(0.6, 0.0, 0.0);
    let cases = read_displacements(
        &read("loads.dat"),
        &unit_loads(1000.0, 100.0),
        Some(&nodes),
        Some(units),
    )
    .expect("displacements");
    let by_loads = identify("loads.dat", &cases, &end).expect("identified");
    let request = CondensationRequest {
        units,
        interface: nodes.named("TIP").expect("set"),
        fixed: nodes.named("ROOT").expect("set"),
        end: Some(end),
        axes: Rotation3::identity(),
        tie: Tie::Rigid,
    };
    let whole =
        read_superelement(&read("matrix.sti"), Some(&read("matrix.dof")), None).expect("matrix");
    let by_matrix = condense(&whole, &nodes, &request).expect("condensed");
    let tip = read_superelement(&read("condensed.mtx"), None, None).expect("substructure");
    let by_substructure = condense(&tip, &nodes, &request).expect("condensed");
    // Debian's ccx 2.20 writes the retained rows of the matrix as they are, without condensing what is
    // behind them; a later one may do better. Nothing else passes.
    if condensed_by_ccx(&whole, &tip) {
        at_most(
            "ccx: stored matrix against substructure",
            apart(&by_matrix.stiffness, &by_substructure.stiffness),
            1e-9,
            "of the diagonal",
        );
    } else {
        println!(
            "this ccx does not condense its substructures: its .mtx holds the retained rows of the whole matrix"
        );
        assert!(by_substructure.stiffness[(0, 0)] > 10.0 * by_matrix.stiffness[(0, 0)]);
    }
    at_most(
        "ccx: displacement table of 7 digits against stored matrix",
        apart(&by_loads.stiffness, &by_matrix.stiffness),
        5e-6,
        "of the diagonal",
    );
    // Beam theory with shear; E 210 GPa, nu 0.3. The mesh is stiffer: its ends can neither contract
    // across nor warp.
    let found = by_matrix.stiffness;
    let checked = check_stiffness(&found, SYMMETRIC_TO);
    assert!(
        checked.is_definite() && checked.findings.is_empty(),
        "{checked:?}"
    );
    at_most(
        "ccx: meshed beam 40 x 60 x 600 mm against Timoshenko's 6 x 6",
        100.0 * apart(&found, &beam(0.3)),
        2.0,
        "% of the diagonal",
    );
    // An end that may warp, with the load on its nodes alike, is softer in every direction.
    let averaged = CondensationRequest {
        tie: Tie::Averaged,
        ..request.clone()
    };
    let averaged = condense(&whole, &nodes, &averaged)
        .expect("condensed")
        .stiffness;
    let softer = |i: usize| 100.0 * (1.0 - averaged[(i, i)] / found[(i, i)]);
    let shares: Vec<f64> = (0..6).map(softer).collect();
    println!("averaged interface softer than the rigid one by {shares:.3?} %");
    at_most(
        "ccx: averaged interface against the rigid one, softer by",
        largest(shares.iter().copied()),
        6.0,
        "% of a diagonal entry",
    );
    assert!(shares.iter().all(|s| *s > 0.0), "{shares:?}");
    // Without contraction (nu 0) the stretch is exact and bending nearly so: that was the difference.
    let matrix = fs::read_to_string(folder.0.join("matrix.inp"))
        .expect("input")
        .replace("210000, 0.3", "210000, 0.0");
    fs::write(folder.0.join("matrix.inp"), matrix).expect("input");
    call(&folder.0, "ccx", &["matrix"]);
    let plain =
        read_superelement(&read("matrix.sti"), Some(&read("matrix.dof")), None).expect("matrix");
    let plain = condense(&plain, &nodes, &request)
        .expect("condensed")
        .stiffness;
    let share = |i: usize| (plain[(i, i)] / beam(0.0)[(i, i)] - 1.0).abs();
    at_most(
        "ccx: the same without Poisson's ratio, stretch",
        share(0),
        1e-8,
        "relative",
    );
    at_most(
        "ccx: the same without Poisson's ratio, bending",
        100.0 * largest([1, 2, 4, 5].map(share)),
        0.2,
        "%",
    );
    // The root is held: said by the rigid-body test.
    let held = free_test(&whole, &nodes, units);
    assert!(!held.is_free() && free_test(&tip, &Nodes::default(), units).zero_modes == Some(0));
}

/// False if the substructure is nothing but its rows of the whole matrix.
fn condensed_by_ccx(whole: &Superelement, part: &Superelement) -> bool {
    let entries: BTreeMap<(Dof, Dof), f64> = whole
        .entries
        .iter()
        .flat_map(|&(i, j, v)| {
            let (a, b) = (whole.dofs[i as usize], whole.dofs[j as usize]);
            [((a, b), v), ((b, a), v)]
        })
        .collect();
    let largest = largest_size(part.entries.iter().map(|e| e.2));
    part.entries.iter().any(|&(i, j, v)| {
        let pair = (part.dofs[i as usize], part.dofs[j as usize]);
        (v - entries.get(&pair).copied().unwrap_or(0.0)).abs() > 1e-9 * largest
    })
}

fn beam(poissons_ratio: f64) -> Matrix6<f64> {
    let shape = SectionShape::Rectangle {
        width: 0.04,
        height: 0.06,
    };
    cantilever(
        &shape,
        &shape,
        0.6,
        210e9,
        poissons_ratio,
        Shear::Timoshenko,
    )
    .expect("beam")
}
