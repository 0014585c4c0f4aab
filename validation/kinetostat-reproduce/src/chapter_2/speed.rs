//! Figure 2.2: what the cutting speed makes of the cutting force.

use kinetostat_cutting::{Correction, largest_force};
use kinetostat_report::{Plot, PlotLine, PlotMark};

use crate::chapter_2::library::kienzle;
use crate::{Cause, Contents, Item};

/// The figure shows five quantities over the cutting speed, without a scale that could be read.
const NO_SCALE: &str = "The figure itself is not in the text that exists. Of its curves (forces, surface, volume, heat, tool life) only that of the force follows from chapter 2: from K_V of Table 2.1.";

/// Thickness and width of the chip, mm: first row of Table 2.3.
const CHIP: (f64, f64) = (0.2, 8.0);

pub(crate) fn fig_2_2() -> Result<Contents, Cause> {
    let mut items = Vec::new();
    for speed in [20.0, 50.0, 200.0, 500.0, 1000.0, 2000.0] {
        items.push(Item::unprinted(
            format!("force at {speed} m/min, as a share of that at 100 m/min"),
            Correction::of_speed(speed) / Correction::of_speed(100.0),
            "",
            NO_SCALE,
        ));
    }
    let share = Plot {
        title: "Figure 2.2: cutting force over the cutting speed, by K_V".into(),
        x_label: "cutting speed v_c, m/min".into(),
        y_label: "force as a share of that at 100 m/min".into(),
        lines: vec![PlotLine::solid(
            "K_V of Table 2.1",
            0,
            speeds(10.0, 2000.0)
                .map(|v| (v, Correction::of_speed(v) / Correction::of_speed(100.0)))
                .collect(),
        )],
        marks: Vec::new(),
    };
    let mut force = Plot {
        title: "Largest force over the cutting speed: Table 2.3, chip of 0.2 x 8 mm".into(),
        x_label: "cutting speed v_c, m/min".into(),
        y_label: "largest force, kN".into(),
        ..Plot::default()
    };
    let printed = [
        ("Monel 400", "Monel 400", [6.97, 6.77, 6.64]),
        ("Al Mg 4.5 Mn", "AlMg4.5Mn", [2.23, 2.17, 2.12]),
    ];
    for (colour, (shown, name, table)) in printed.into_iter().enumerate() {
        let law = kienzle(name)?;
        let at = |v: f64| 1e-3 * largest_force(&law, CHIP.0, CHIP.1, v);
        // From there on the factor 2 stands for K_V and all others.
        force.lines.push(PlotLine::solid(
            shown,
            colour,
            speeds(1000.0, 2000.0).map(|v| (v, at(v))).collect(),
        ));
        for (speed, kilonewtons) in [1000.0, 1500.0, 2000.0].into_iter().zip(table) {
            force.marks.push(PlotMark {
                at: (speed, kilonewtons),
                name: format!("{kilonewtons:.2}"),
                detail: format!("{shown} at {speed} m/min as Table 2.3 prints it, kN"),
            });
        }
        items.push(Item::unprinted(
            format!("{shown}: force saved from 1000 to 2000 m/min"),
            100.0 * (1.0 - at(2000.0) / at(1000.0)),
            "%",
            "A twentieth for twice the speed: above 100 m/min the speed hardly matters to the force.",
        ));
    }
    Ok(Contents {
        items,
        plots: vec![share, force],
    })
}

/// Speeds evenly spaced by their ratio, m/min.
fn speeds(from: f64, to: f64) -> impl Iterator<Item = f64> {
    (0..=120).map(move |k| from * (to / from).powf(f64::from(k) / 120.0))
}
