//! Deviations along the path: as measured and smoothed, and below them the correction of the next trial.

use kinetostat_mirror::{Measurement, MirrorState};
use kinetostat_report::{Plot, PlotLine, PlotMark};
use nalgebra::Vector3;

use crate::ui::numbers::{number, short};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Points that a picture holds; of more, every so many.
const MOST: usize = 4000;

pub(crate) fn drawing(title: String, measured: &Measurement, state: &MirrorState) -> String {
    let x_label = "length along the feed moves, mm".to_owned();
    let along = |k: usize,
                 name: String,
                 dashed: bool,
                 all: &mut dyn Iterator<Item = (f64, Vector3<f64>)>| {
        let points = all.map(|(at, v)| (at, 1e3 * v[k])).collect();
        PlotLine {
            name,
            colour: k,
            dashed,
            points,
        }
    };
    let every = measured.points.len().div_ceil(MOST).max(1);
    let mut lines = Vec::new();
    for (k, axis) in AXES.iter().enumerate() {
        let points = measured.points.iter().step_by(every);
        let mut raw = points.map(|p| (p.along_mm, p.deviation_mm));
        lines.push(along(k, format!("{axis}, measured"), true, &mut raw));
        let places = state.along_mm.iter().copied();
        let mut smoothed = places.zip(&measured.at_stations).map(|(at, s)| {
            let lost = Vector3::repeat(f64::NAN);
            (
                at,
                if s.effective_points > 0.0 {
                    s.deviation_mm
                } else {
                    lost
                },
            )
        });
        lines.push(along(k, format!("{axis}, smoothed"), false, &mut smoothed));
    }
    let marks = measured.outliers.iter().map(|outlier| {
        let axis = outlier.deviation_mm.iamax();
        PlotMark {
            at: (outlier.along_mm, 1e3 * outlier.deviation_mm[axis]),
            name: String::new(),
            detail: format!(
                "outlier, row {}: {} um from the path at {} mm",
                outlier.row,
                number(1e3 * outlier.distance_mm, 3),
                short(outlier.along_mm)
            ),
        }
    });
    let deviation = Plot {
        title,
        x_label: x_label.clone(),
        y_label: "deviation across the path, um".into(),
        lines,
        marks: marks.collect(),
    };
    let correction = Plot {
        title: "Correction of the next trial".into(),
        x_label,
        y_label: "correction, um".into(),
        lines: (0..3)
            .map(|k| {
                let places = state.along_mm.iter().copied();
                let mut all = places.zip(state.correction_mm.iter().copied());
                along(k, AXES[k].to_owned(), false, &mut all)
            })
            .collect(),
        marks: Vec::new(),
    };
    deviation.svg_above(&[correction])
}
