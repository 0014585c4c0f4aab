//! The force over one revolution as a drawing, the torque below it.

use kinetostat_report::{Plot, PlotLine};

use crate::force::answer::{AtAngle, ForceAnswer};
use crate::force::text::milling;
use crate::ui::numbers::given;

pub(crate) fn drawing(a: &ForceAnswer) -> String {
    let names = [
        "Fx, along the feed",
        "Fy, to its left",
        "Fz, along the tool",
    ];
    let force = |k: usize| line(names[k], k, a, |at| at.force_n[k]);
    let mut lines: Vec<PlotLine> = (0..3).map(force).collect();
    let means = a.mean.force_n.iter().enumerate();
    lines.extend(means.map(|(k, mean)| level(["means", "", ""][k], k, *mean)));
    let over = "angle of the spindle, deg";
    let forces = Plot {
        title: title(a),
        x_label: over.into(),
        y_label: "force on the tool, N".into(),
        lines,
        marks: Vec::new(),
    };
    let torque = |at: &AtAngle| 1e-3 * at.torque_n_mm;
    let torques = Plot {
        title: "Torque of the spindle".into(),
        x_label: over.into(),
        y_label: "torque, N m".into(),
        lines: vec![
            line("torque", 3, a, torque),
            level("mean", 3, 1e-3 * a.mean.torque_n_mm),
        ],
        marks: Vec::new(),
    };
    forces.svg_above(&[torques])
}

fn title(a: &ForceAnswer) -> String {
    let c = &a.cut;
    format!(
        "{}: {} mm wide, {} mm deep, {} mm per tooth in {}",
        milling(c.milling),
        given(c.width_mm),
        given(c.depth_mm),
        given(c.feed_per_tooth_mm),
        a.material.name
    )
}

/// One quantity over the whole turn, its end being its beginning.
fn line(name: &str, colour: usize, a: &ForceAnswer, of: impl Fn(&AtAngle) -> f64) -> PlotLine {
    let mut points: Vec<(f64, f64)> = a.revolution.iter().map(|p| (p.angle_deg, of(p))).collect();
    if let Some(first) = a.revolution.first() {
        points.push((360.0, of(first)));
    }
    PlotLine::solid(name, colour, points)
}

fn level(name: &str, colour: usize, value: f64) -> PlotLine {
    PlotLine::dashed(name, colour, vec![(0.0, value), (360.0, value)])
}
