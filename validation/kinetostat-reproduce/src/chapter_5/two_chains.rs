//! Two chains of three links with one tool, held [R 5.2.1]: figure 5.2, which has no numbers. The presets are one machine at
//! its place without strain and one with both chains pressed.

use std::f64::consts::PI;

use kinetostat::{
    EndCondition, MechanismEquilibrium, Pose,
    equilibrium::{Equilibria, SpreadSettings},
};
use kinetostat_model::Model;
use kinetostat_report::{Plot, PlotLine};

use crate::{Cause, Contents, Item};

/// Distance from the tool to the feet of the pressed chains, m.
const RADIUS: f64 = 1.35;

/// All equilibria of a preset with its tool held at a place, m.
fn held(preset: &str, x: f64, y: f64) -> Result<Equilibria<MechanismEquilibrium>, Cause> {
    let machine = Model::preset(preset)?.mechanism;
    let posture = machine.posture(&machine.platforms()[machine.tool()].home)?;
    let end = EndCondition::pose(Pose::translation(x, y, 0.0));
    Ok(posture.equilibria(&end, &SpreadSettings::default())?)
}

/// Feet, joints and tool, from the first foot to the second.
fn outline(e: &MechanismEquilibrium) -> Vec<(f64, f64)> {
    let foot = |turn: f64| (RADIUS * turn.cos(), RADIUS * turn.sin());
    let joints = |i: usize| {
        let nodes = e.limbs[i].nodes.iter();
        nodes.map(|pose| (pose.translation.x, pose.translation.y))
    };
    let there = std::iter::once(foot(0.0)).chain(joints(0));
    let back = joints(1).rev().chain([foot(2.0 * PI / 3.0)]);
    there.chain(back).collect()
}

pub(crate) fn fig_5_2() -> Result<Contents, Cause> {
    let all = held("two_chains_pressed", 0.0, 0.0)?;
    let count = |number: usize| f64::from(u32::try_from(number).unwrap_or(u32::MAX));
    let mut items = vec![
        Item::unprinted("equilibria", count(all.count()), "", "four of each chain"),
        Item::unprinted("stable", count(all.stable_count()), "", "two of each chain"),
    ];
    let mut plot = Plot {
        title: "Figure 5.2: shapes of two chains with one tool".into(),
        x_label: "x, m".into(),
        y_label: "y, m".into(),
        lines: Vec::new(),
        marks: Vec::new(),
    };
    for (colour, (name, wanted)) in [
        ("both chains stable", [true, true]),
        ("first chain unstable", [false, true]),
        ("second chain unstable", [true, false]),
        ("both chains unstable", [false, false]),
    ]
    .into_iter()
    .enumerate()
    {
        let stable = |e: &MechanismEquilibrium| [0, 1].map(|i| e.limbs[i].stability.stable);
        let mut alike = (all.found.iter()).filter(|f| stable(&f.equilibrium) == wanted);
        let missing = || Cause::Missing(format!("a shape with {name}"));
        let first = alike.next().ok_or_else(missing)?;
        let note = "the same for all of this kind";
        items.push(Item::unprinted(
            format!("{name}: energy"),
            first.energy(),
            "N m",
            note,
        ));
        items.push(Item::unprinted(
            format!("{name}: shapes"),
            count(1 + alike.count()),
            "",
            "",
        ));
        plot.lines.push(PlotLine {
            name: name.into(),
            colour,
            dashed: wanted != [true, true],
            dots: false,
            points: outline(&first.equilibrium),
        });
    }
    let turn = PI / 3.0;
    let moved = held("two_chains", 0.1 * turn.cos(), 0.1 * turn.sin())?;
    for (name, number) in [
        ("equilibria", moved.count()),
        ("stable", moved.stable_count()),
    ] {
        items.push(Item::unprinted(
            format!("straight at rest, tool 100 mm between the feet: {name}"),
            count(number),
            "",
            "",
        ));
    }
    Ok(Contents {
        items,
        plots: vec![plot],
    })
}
