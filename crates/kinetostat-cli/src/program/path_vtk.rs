//! The path of a run as lines for ParaView: errors, corrections and loads as vectors at its points.

use kinetostat_formats::fields::{PointQuantity, Polylines};
use kinetostat_machining::{PointKind, PointResult, RunInputs, thinned};

/// Most points of a file: of longer programs the worst of every stretch, as in the table of points.
const MOST: usize = 200_000;

/// A legacy VTK file, program coordinates in mm. A line for each run of cutting moves; rapids are left out.
pub(crate) fn vtk(run_inputs: &RunInputs, points: &[PointResult]) -> Vec<u8> {
    let kept: Vec<&PointResult> = match points.len() > MOST {
        true => thinned(points, &[], MOST)
            .into_iter()
            .map(|i| &points[i])
            .collect(),
        false => points.iter().collect(),
    };
    // The end of a rapid is where the next cut begins.
    let begins = |p: &PointResult| p.kind == PointKind::Rapid;
    let runs = kept.chunk_by(|_, next| !begins(next));
    let vector = |name: &str, of: fn(&PointResult) -> [f64; 3]| PointQuantity {
        name: name.to_owned(),
        width: 3,
        values: kept.iter().flat_map(|p| of(p)).collect(),
    };
    let number = |name: &str, of: fn(&PointResult) -> f64| PointQuantity {
        name: name.to_owned(),
        width: 1,
        values: kept.iter().map(|p| of(p)).collect(),
    };
    let mut quantities = vec![vector("error_before_mm", |p| p.error_before_mm)];
    if run_inputs.compensated {
        quantities.push(vector("error_after_mm", |p| p.error_after_mm));
        quantities.push(vector("correction_mm", |p| p.correction_mm));
    }
    quantities.extend([
        vector("force_n", |p| p.force_n),
        vector("moment_n_m", |p| p.moment_n_m),
        number("line", |p| p.line as f64),
        number("path_mm", |p| p.path_mm),
        number("smallest_stiffness_n_per_mm", |p| {
            p.smallest_stiffness_n_per_mm
        }),
        number("share_to_buckling", |p| {
            p.share_to_buckling.unwrap_or(f64::NAN)
        }),
        number("stable", |p| f64::from(u8::from(p.stable))),
    ]);
    Polylines {
        title: format!("{} on {}, mm, N", run_inputs.program, run_inputs.model),
        points: kept.iter().map(|p| p.position_mm).collect(),
        lines: runs.map(<[_]>::len).collect(),
        quantities,
    }
    .vtk()
}
