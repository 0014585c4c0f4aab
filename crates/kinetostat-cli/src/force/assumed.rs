//! Assumptions behind the numbers, in sentences.

use kinetostat_cutting::{Material, Shape};

use crate::force::cut::{Cut, Part};
use crate::force::tool::CutTool;

pub(crate) fn assumed(material: &Material, tool: &CutTool, cut: &Cut) -> Vec<String> {
    let mut list = material.assumptions.clone();
    let mut say = |text: &str| list.push(text.to_owned());
    if material.chip_mm.is_none() {
        say("At which thicknesses of chip its law was measured is not known.");
    }
    say("Tool and part are rigid: the cut is as wide and as deep as it was asked.");
    match cut.part {
        Part::Slot => {}
        Part::Side(_) => say("The cut is straight: in an inside corner the arc is longer."),
    }
    if tool.tool.run_out().offset_mm == 0.0 {
        say("All teeth cut alike: run-out raises the peaks (--run-out-um).");
    }
    let rounded = match tool.tool.shape() {
        Shape::Ball => true,
        Shape::Bull { corner_radius_mm } => corner_radius_mm > 0.0,
        Shape::Flat | Shape::Face { .. } => false,
    };
    if rounded && !matches!(cut.part, Part::Slot) {
        say(
            "At every height the arc in the material is that of this width at the full diameter; near the tip, where the tool is narrower, the true one is another.",
        );
    }
    if matches!(tool.tool.shape(), Shape::Face { .. }) {
        say("The inserts are straight: corner radius and wiper are left out.");
    }
    list
}
