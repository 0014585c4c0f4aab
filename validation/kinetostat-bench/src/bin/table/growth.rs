//! Growth of the cost with springs, limbs and postures.

use anyhow::Result;
use kinetostat::{
    ActuatorSpec, BeamSection, Chain, Limb, LinkSpec, Mechanism, MotionKind, Platform, Pose,
    model::LinkConvention,
};
use kinetostat_bench::{BenchQuantity, Places, Task, sample};
use nalgebra::Vector3;

use crate::{BLOCK, exponent, median};
use kinetostat_bench::figure::at_most;
use kinetostat_bench::machines::{ARM, LinkLaw};

/// A clamped steel tube of 1 m in `pieces` segments.
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

/// Times (us per posture) of several sizes, one list per benchmark case.
type Rows<const N: usize> = [Vec<(usize, f64)>; N];

/// Measures one line of a table; says how many postures were solved one by one, and not at all.
fn line<const N: usize>(
    size: usize,
    rows: &mut Rows<N>,
    tasks: impl Fn(usize) -> Result<Task>,
) -> Result<()> {
    print!("{size:<10}");
    let (mut scalar_counts, mut not_found) = (0, 0);
    for (k, rows) in rows.iter_mut().enumerate() {
        let task = tasks(k)?;
        let time = median(&task, BLOCK)?;
        let (scalar, not) = task.not_vectorised(BLOCK)?;
        (scalar_counts, not_found) = (scalar_counts + scalar, not_found + not);
        print!("{time:>16.3}");
        rows.push((size, time));
    }
    println!("{scalar_counts:>8}{not_found:>11}");
    Ok(())
}

fn heading(size: &str, names: &[&str]) {
    print!("{size:<10}");
    names.iter().for_each(|name| print!("{name:>16}"));
    println!("{:>8}{:>11}", "scalar", "not found");
}

/// Chains of 6 to 6000 spring coordinates.
pub fn springs() -> Result<()> {
    println!("Growth with the springs of one chain, us per posture");
    let names = ["K_C", "equilibrium", "equil. and K_C"];
    heading("springs", &names);
    let quantities = [
        BenchQuantity::Stiffness,
        BenchQuantity::Equilibrium,
        BenchQuantity::EquilibriumAndStiffness,
    ];
    let mut rows = [const { Vec::new() }; 3];
    for pieces in [1, 3, 10, 30, 100, 300, 1000] {
        let count = (1000 / pieces).clamp(16, 256);
        line(6 * pieces, &mut rows, |k| {
            let wrenches = match quantities[k] {
                BenchQuantity::Stiffness => Vec::new(),
                _ => sample::wrenches(0..count, 20.0, 5.0),
            };
            let home = Places::Poses(vec![Pose::translation(1.0, 0.0, 0.0); count]);
            Task::new(cantilever(pieces)?, quantities[k], home, &wrenches)
        })?;
    }
    report(&rows, &names, "springs, 60 to 6000", 2);
    Ok(())
}

/// Exponents of growth from the row `first` on, where fixed costs are past.
fn report(rows: &[Vec<(usize, f64)>], names: &[&str], of: &str, first: usize) {
    for (name, rows) in names.iter().zip(rows) {
        println!("exponent of {name} ({of}): {:.2}", exponent(&rows[first..]));
    }
    for (name, rows) in names.iter().zip(rows) {
        let name = format!("{name}: growth with {of}");
        at_most(&name, exponent(&rows[first..]), 1.15, "exponent");
    }
    println!();
}

/// A plate on so many legs that hold five directions each: over-constrained from two on.
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
            .passive("foot", MotionKind::Revolute, Vector3::y(), 0.0)
            .actuator("ram", drive)
            .link_with(
                "rod",
                &LinkSpec::beam(section, 0.5).convention(LinkConvention::TranslationsFirst),
            )
            .rigid(upright.inverse())
            .translation(Vector3::new(-0.6, 0.0, 0.0))
            .rigid(Pose::rotation(Vector3::z() * -turn))
            .build()?;
        builder = builder.limb(Limb::between(format!("leg {i}"), 0, tool, chain));
    }
    Ok(builder.build()?)
}

/// Machines of 2 to 12 limbs.
pub fn limbs() -> Result<()> {
    println!("Growth with the limbs of a machine, us per posture");
    let names = ["K_C", "equilibrium"];
    heading("limbs", &names);
    let mut rows = [const { Vec::new() }; 2];
    for legs in [2, 3, 4, 6, 8, 12] {
        line(legs, &mut rows, |k| {
            let home = Places::Poses(vec![Pose::translation(0.0, 0.0, 1.0); BLOCK]);
            let machine = table_on_legs(legs)?;
            match k {
                0 => Task::new(machine, BenchQuantity::Stiffness, home, &[]),
                _ => {
                    let wrenches = sample::wrenches(0..BLOCK, 300.0, 10.0);
                    Task::new(machine, BenchQuantity::Equilibrium, home, &wrenches)
                }
            }
        })?;
    }
    report(&rows, &names, "limbs, 2 to 12", 0);
    Ok(())
}

/// 1 to 1e6 postures of the arm, in blocks.
pub fn postures() -> Result<()> {
    println!("Growth with the number of postures (arm, blocks of {BLOCK}), us per posture");
    let names = ["J and K_C", "equilibrium"];
    heading("postures", &names);
    let quantities = [
        BenchQuantity::StiffnessAndJacobian,
        BenchQuantity::Equilibrium,
    ];
    let mut rows = [const { Vec::new() }; 2];
    for count in [1, 10, 100, 1000, 10_000, 100_000, 1_000_000] {
        line(count, &mut rows, |k| {
            ARM.task(quantities[k], count, LinkLaw::Plain)
        })?;
    }
    // The time of all postures grows with their number, so that of one must stay.
    for rows in &mut rows {
        rows.iter_mut()
            .for_each(|(count, time)| *time *= *count as f64);
    }
    report(&rows, &names, "postures, 1000 to 1e6", 3);
    Ok(())
}
