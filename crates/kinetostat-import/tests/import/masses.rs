//! Mass matrices of imported robots, as kinetostat-dynamics has them, against Pinocchio's.

use kinetostat::{ChainProblem, EndCondition, Wrench};
use kinetostat_dynamics::{Held, LinearDynamics};
use kinetostat_import::{Imported, JointStiffness, UrdfOptions};
use kinetostat_testing::Worst;

use crate::agreement::{TREE, ask_pinocchio, list, postures};
use crate::robots::{ROBOTS, robot};
use crate::{figure_at_least, figure_at_most};

/// All drives are elastic, so that each has a coordinate; stiffnesses do not enter masses.
fn elastic() -> JointStiffness {
    JointStiffness::All(1e6)
}

/// Largest difference of entries, as a share of the geometric mean of the two diagonal entries; `None` without Pinocchio.
fn with_pinocchio(urdf: &str, imported: &Imported, count: usize) -> Option<f64> {
    let postures = postures(imported, count);
    let found = ask_pinocchio(urdf, imported, &postures)?;
    let chain = &imported.model.mechanism.limbs()[0].nominal;
    let mut problem = ChainProblem::new(chain, EndCondition::wrench(Wrench::zero()));
    problem.base = imported.model.mechanism.platforms()[0].home;
    let mut worst = Worst::new();
    for (i, commands) in postures.iter().enumerate() {
        // A third of every motion is deflection of its drive.
        problem.commands = commands.iter().map(|c| c * 2.0 / 3.0).collect();
        let mut coordinates = chain.home_coordinates();
        let own: Vec<usize> = (chain.actuators().iter())
            .map(|a| a.coordinate.unwrap())
            .collect();
        for (command, &c) in commands.iter().zip(&own) {
            coordinates[c] = command / 3.0;
        }
        let dynamics =
            LinearDynamics::of_chain(&problem, &coordinates, &Wrench::zero(), &Held::nothing());
        let mass = dynamics.unwrap().mass().clone();
        let n = commands.len();
        let expected = list(&found["masses"][i]);
        assert_eq!((mass.nrows(), expected.len()), (n, n * n));
        for a in 0..n {
            for b in 0..n {
                let size = (expected[a * n + a] * expected[b * n + b]).sqrt();
                let apart = mass[(own[a], own[b])] - expected[a * n + b];
                worst.add_at(apart / size, || format!("posture {i}, {a} {b}"));
            }
        }
    }
    Some(worst.value())
}

#[test]
fn figure_mass_matrices_of_robots_agree_with_pinocchio() {
    let mut worst = Worst::new();
    let mut without = 0;
    for (name, _) in ROBOTS {
        let mut options = UrdfOptions::default();
        options.stiffness = elastic();
        let Some((text, imported)) = robot(name, options) else {
            return;
        };
        assert_eq!(
            imported.bodies.is_empty(),
            !text.contains("<inertial"),
            "{name}"
        );
        if imported.bodies.is_empty() {
            println!("{name}: its file has no masses to compare");
            without += 1;
            continue;
        }
        let Some(apart) = with_pinocchio(&text, &imported, 200) else {
            return;
        };
        println!("{name}: {apart:.1e}");
        worst.add_at(apart, || name);
    }
    figure_at_least(
        "URDF of 8 robots with masses, Pinocchio",
        ROBOTS.len() - without,
        2,
    );
    figure_at_most(
        "URDF of robots, Pinocchio: mass matrices at 200 postures",
        worst.of(ROBOTS.len() - without),
        1e-10,
        "of the diagonal",
    );
}

#[test]
fn figure_mass_matrix_of_a_tree_with_everything_agrees_with_pinocchio() {
    let mut options = crate::between("foot", "hand");
    // One of them slides, which one number for all does not reach.
    options.stiffness = JointStiffness::Table {
        file: "drives.csv".into(),
        text: "name,value,unit\nturn,1e6,N m/rad\nlift,1e6,N m/rad\nslide,1e6,N/m\n".into(),
    };
    let imported = crate::import(TREE, &options);
    if let Some(apart) = with_pinocchio(TREE, &imported, 200) {
        figure_at_most(
            "URDF tree with mimic branches, Pinocchio: mass matrices",
            apart,
            1e-10,
            "of the diagonal",
        );
    }
}
