//! Figure 2.3: the forces of the machining process, over one revolution of a milling cutter.

use kinetostat_cutting::{
    Engagement, Feed, Kienzle, Milling, Peaks, Result, Revolution, Shape, Side, Tool,
    force_as_printed,
};
use kinetostat_report::{Plot, PlotLine};

use crate::chapter_2::library::kienzle;
use crate::{Cause, Contents, Item};

/// Chip and width of the first row of Table 2.3, mm: feed per tooth and depth of cut.
const CHIP: (f64, f64) = (0.2, 8.0);
/// Diameter of the cutter, mm; its teeth.
const CUTTER: (f64, usize) = (20.0, 2);

const DRAWING: &str = "The figure is a drawing of the forces without numbers, and it is not in the text that exists. The cut is assumed: a slot with the thinner chip and width of Table 2.3, Al Mg 4.5 Mn, a cutter of 20 mm with two teeth, factors 1, radial and axial parts as the library assumes them.";

/// The force over one revolution with teeth of this helix, rad, and its mean.
fn slot(law: &Kienzle, helix: f64) -> Result<(Revolution, Peaks, [f64; 4])> {
    let tool = Tool::new(Shape::Flat, CUTTER.0, CUTTER.1)?.with_helix(helix)?;
    let slot = Engagement::straight(tool.radius_mm(), CUTTER.0, CHIP.1, Side::Left)?;
    let cut = Milling::new(&tool, law, &slot, Feed::level(CHIP.0)?);
    let mean = cut.mean();
    let [x, y, z] = mean.force_n.into();
    Ok((
        cut.revolution(),
        cut.peaks(),
        [x, y, z, 1e-3 * mean.torque_n_mm()],
    ))
}

pub(crate) fn fig_2_3() -> std::result::Result<Contents, Cause> {
    let law = kienzle("AlMg4.5Mn")?;
    let (mut items, mut plots) = (Vec::new(), Vec::new());
    for (helix, teeth) in [(0.0_f64, "straight teeth"), (30.0, "helix of 30 degrees")] {
        let (revolution, peaks, mean) = slot(&law, helix.to_radians())?;
        let named = |what: &str| format!("{teeth}: {what}");
        if helix == 0.0 {
            // One tooth cuts at a time, across the feed with the whole chip.
            let tangential = peaks.torque.force.torque_n_mm() / (0.5 * CUTTER.0);
            items.push(Item::formula(
                named("largest tangential force"),
                "b h k_c",
                CHIP.0 * CHIP.1 * law.specific_n_per_mm2(CHIP.0),
                tangential,
                "N",
                "Equation 2.1 with all factors 1, where the tooth has its whole chip.",
            ));
        }
        let parts = ["along the feed", "across the feed", "along the axis"];
        for (part, force) in parts.iter().zip(mean) {
            let name = named(&format!("mean force on the tool {part}"));
            items.push(Item::unprinted(name, force, "N", DRAWING));
        }
        items.push(Item::unprinted(
            named("mean torque"),
            mean[3],
            "N m",
            DRAWING,
        ));
        let peak = revolution.peak_n();
        items.push(Item::unprinted(named("largest force"), peak, "N", DRAWING));
        items.push(Item::unprinted(
            named("largest force, as a share of 2 k_c b h"),
            peak / force_as_printed(&law, CHIP.0, CHIP.1),
            "",
            "Equation 2.4 as printed is meant for the worst case: it stays above one sharp tooth.",
        ));
        plots.push(plot(teeth, &revolution));
    }
    Ok(Contents { items, plots })
}

fn plot(teeth: &str, revolution: &Revolution) -> Plot {
    let parts = [
        "F_x, along the feed",
        "F_y, to its left",
        "F_z, along the axis",
    ];
    let line = |(i, name): (usize, &&str)| {
        PlotLine::solid(
            *name,
            i,
            revolution
                .turns()
                .zip(&revolution.forces)
                .map(|(turn, force)| (turn.to_degrees(), force.force_n[i]))
                .collect(),
        )
    };
    Plot {
        title: format!(
            "Figure 2.3: force on the tool over one revolution of an assumed cut, {teeth}"
        ),
        x_label: "angle of the spindle, degrees".into(),
        y_label: "force, N".into(),
        lines: parts.iter().enumerate().map(line).collect(),
        marks: Vec::new(),
    }
}
