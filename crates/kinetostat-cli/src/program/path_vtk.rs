//! The path of a run as lines for ParaView: errors, corrections and loads as vectors at its points, and at some of them the compliance
//! as a tensor, which is drawn as an ellipsoid.

use std::collections::BTreeMap;

use kinetostat_formats::fields::{PointQuantity, Polylines};
use kinetostat_machining::{PointKind, PointResult, Run, thinned};

/// Upper limit of the points of a file: of longer programs the worst of every stretch, as in the table of points.
const MOST: usize = 200_000;

/// A legacy VTK file, program coordinates in mm. A line for each run of cutting moves; rapids are left out.
pub(crate) fn vtk(run: &Run) -> Vec<u8> {
    let (run_inputs, points) = (&run.result.run_inputs, &run.points);
    let compliances = Compliances::of(run);
    let known: Vec<usize> = (0..points.len())
        .filter(|i| compliances.at(&points[*i]).is_some())
        .collect();
    let kept: Vec<&PointResult> = match points.len() > MOST {
        true => thinned(points, &known, MOST)
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
    if !known.is_empty() {
        quantities.extend(compliances.quantities(&kept));
    }
    Polylines {
        title: format!("{} on {}, mm, N", run_inputs.program, run_inputs.model),
        points: kept.iter().map(|p| p.position_mm).collect(),
        lines: runs.map(<[_]>::len).collect(),
        quantities,
    }
    .vtk()
}

/// The compliances that are known at some points, by the move and the share of it.
struct Compliances(BTreeMap<(usize, u64), [[f64; 3]; 3]>);

impl Compliances {
    fn of(run: &Run) -> Self {
        let known = run.places.iter().filter_map(|place| {
            let at = (place.move_index, place.share.to_bits());
            Some((at, place.compliance_um_per_n?))
        });
        Self(known.collect())
    }

    fn at(&self, point: &PointResult) -> Option<&[[f64; 3]; 3]> {
        // The load of a step changes from one to another.
        let feed = point.kind == PointKind::Feed;
        let at = (point.move_index, point.share.to_bits());
        feed.then(|| self.0.get(&at)).flatten()
    }

    /// The tensors, no numbers where none is known, and where they are.
    fn quantities(&self, kept: &[&PointResult]) -> [PointQuantity; 2] {
        let tensor = |p: &&PointResult| *self.at(p).unwrap_or(&[[f64::NAN; 3]; 3]);
        let has = |p: &&PointResult| f64::from(u8::from(self.at(p).is_some()));
        [
            PointQuantity {
                name: "compliance_um_per_n".to_owned(),
                width: 9,
                values: kept.iter().flat_map(tensor).flatten().collect(),
            },
            PointQuantity {
                name: "has_compliance".to_owned(),
                width: 1,
                values: kept.iter().map(has).collect(),
            },
        ]
    }
}
