//! How cost grows with springs, limbs and postures.

use anyhow::Result;
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, Limb, LinkConvention, LinkSpec, Mechanism, MotionKind,
    Platform, Pose,
};
use kinetostat_bench::{Places, Task, Work, sample};
use nalgebra::Vector3;

use crate::machines::ARM;
use crate::{BLOCK, at_most, exponent, shortest};

/// A cantilever of `pieces` pieces.
fn cantilever(pieces: usize) -> Result<Mechanism> {
    let section = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03);
    let link = LinkSpec::beam(section, 1.0)
        .segments(pieces)
        .convention(LinkConvention::TranslationsFirst);
    let chain = Chain::builder("beam").link_with("beam", &link).build()?;
    Ok(Mechanism::serial(
        chain,
        Pose::translation(1.0, 0.0, 0.0),
        Vector3::zeros(),
    )?)
}

/// Chains of 6 to 6000 spring coordinates.
pub fn springs() -> Result<()> {
    println!("Growth with the springs of one chain, us per posture");
    println!(
        "{:<10}{:>12}{:>14}{:>14}{:>16}",
        "springs", "J and K_C", "K_C alone", "equilibrium", "equil. and K_C"
    );
    let works = [
        Work::Stiffness,
        Work::Equilibrium,
        Work::EquilibriumAndStiffness,
    ];
    let mut rows = [const { Vec::new() }; 3];
    for pieces in [1, 3, 10, 30, 100, 300, 1000] {
        let count = (1000 / pieces).clamp(16, 256);
        let springs = 6 * pieces;
        print!("{springs:<10}{:>12}", "");
        for (work, rows) in works.into_iter().zip(&mut rows) {
            let wrenches = match work {
                Work::Stiffness => Vec::new(),
                _ => sample::wrenches(0..count, 20.0, 5.0),
            };
            let home = Places::Poses(vec![Pose::translation(1.0, 0.0, 0.0); count]);
            let task = Task::new(cantilever(pieces)?, work, home, &wrenches)?;
            let time = shortest(&task, BLOCK)?;
            print!("{time:>14.3}");
            rows.push((springs, time));
        }
        println!();
    }
    report(
        &rows,
        &["K_C", "equilibrium", "equilibrium and K_C"],
        "springs, 60 to 6000",
        2,
        1.15,
    );
    Ok(())
}

/// Exponents from the row `first` on, where fixed costs are past.
fn report(rows: &[Vec<(usize, f64)>], names: &[&str], of: &str, first: usize, most: f64) {
    for (name, rows) in names.iter().zip(rows) {
        println!("exponent of {name} ({of}): {:.2}", exponent(&rows[first..]));
    }
    for (name, rows) in names.iter().zip(rows) {
        let name = format!("growth of {name} with {of}");
        at_most(&name, exponent(&rows[first..]), most, "exponent");
    }
    println!();
}

/// A plate on so many legs that hold four directions each.
fn table_on_legs(legs: usize) -> Result<Mechanism> {
    let mut builder = Mechanism::builder(format!("{legs} legs"));
    let tool = builder.platform(Platform::new("tool", Pose::translation(0.0, 0.0, 1.0)));
    for i in 0..legs {
        let turn = std::f64::consts::TAU * i as f64 / legs as f64;
        let section = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03);
        let mut drive = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 4e7);
        drive.home = 0.5;
        let upright = Pose::rotation(Vector3::y() * -std::f64::consts::FRAC_PI_2);
        let chain = Chain::builder(format!("leg {i}"))
            .rigid(Pose::rotation(Vector3::z() * turn))
            .translation(Vector3::new(0.6, 0.0, 0.0))
            .rigid(upright)
            .passive_universal("foot", Vector3::y(), Vector3::z())
            .actuator("ram", drive)
            .link_with(
                "rod",
                &LinkSpec::beam(section, 0.5).convention(LinkConvention::TranslationsFirst),
            )
            .rigid(upright.inverse())
            .translation(Vector3::new(-0.6, 0.0, 0.0))
            .rigid(Pose::rotation(Vector3::z() * -turn))
            .build()?;
        builder = builder.limb(Limb {
            name: format!("leg {i}"),
            from: 0,
            to: tool,
            platform_from_tip: Pose::identity(),
            nominal: chain.clone(),
            actual: chain,
        });
    }
    Ok(builder.build()?)
}

/// Machines of 2 to 12 limbs.
pub fn limbs() -> Result<()> {
    println!("Growth with the limbs of a machine, us per posture");
    println!("{:<10}{:>12}{:>14}", "limbs", "K_C", "equilibrium");
    let mut rows = [const { Vec::new() }; 2];
    for legs in [2, 3, 4, 6, 8, 12] {
        print!("{legs:<10}");
        for (work, rows) in [Work::Stiffness, Work::Equilibrium]
            .into_iter()
            .zip(&mut rows)
        {
            let home = Places::Poses(vec![Pose::translation(0.0, 0.0, 1.0); BLOCK]);
            let wrenches = match work {
                Work::Stiffness => Vec::new(),
                _ => sample::wrenches(0..BLOCK, 300.0, 10.0),
            };
            let task = Task::new(table_on_legs(legs)?, work, home, &wrenches)?;
            let time = shortest(&task, BLOCK)?;
            print!("{time:>13.3}");
            rows.push((legs, time));
        }
        println!();
    }
    report(&rows, &["K_C", "equilibrium"], "limbs, 2 to 12", 0, 1.15);
    Ok(())
}

/// 1 to 1e6 postures of the arm, in blocks.
pub fn postures() -> Result<()> {
    println!("Growth with the number of postures (arm, blocks of {BLOCK}), us per posture");
    println!("{:<10}{:>12}{:>14}", "postures", "J and K_C", "equilibrium");
    let mut rows = [const { Vec::new() }; 2];
    for count in [1, 10, 100, 1000, 10_000, 100_000, 1_000_000] {
        print!("{count:<10}");
        let works = [Work::StiffnessAndJacobian, Work::Equilibrium];
        for (work, rows) in works.into_iter().zip(&mut rows) {
            let task = ARM.task(work, count, false)?;
            let time = shortest(&task, BLOCK)?;
            print!("{time:>13.3}");
            rows.push((count, time * count as f64));
        }
        println!();
    }
    report(
        &rows,
        &["J and K_C", "equilibrium"],
        "postures, 1000 to 1e6",
        3,
        1.05,
    );
    Ok(())
}
