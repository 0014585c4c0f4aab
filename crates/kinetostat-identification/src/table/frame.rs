//! The frame of an instrument in the base of the machine, from the places of markers without a load.
//!
//! A displacement does not depend on where the instrument stands, only on how it is turned; an error of 1 mrad of that turn changes it by a
//! thousandth. So the frame is found from the model's own geometry, wrong by millimetres as it may be: the rotation and translation
//! that bring the measured places nearest to those of the model (Kabsch 1976).

use kinetostat::linalg::SingularValues;
use kinetostat::{Mechanism, PostureRequest};
use nalgebra::{Matrix3, Rotation3, Vector3};

use crate::body::PlacedBody;
use crate::table::row::MeasuredRow;

/// Frame of an instrument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InstrumentFrame {
    /// Base from instrument.
    pub rotation: Rotation3<f64>,
    /// Origin of the instrument in the base, m.
    pub origin: Vector3<f64>,
    /// Root mean square of the distances that are left, m: errors of the model's geometry, its sag, and of the readings.
    pub left: f64,
    /// Number of places.
    pub places: usize,
}

/// Reason why a frame is not found.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoFrame {
    /// Not enough places.
    #[error(
        "the frame of the instrument needs places (x_mm, y_mm, z_mm) of markers without a load in at least three postures that are not in a line; there are {places}"
    )]
    TooFew {
        /// Number of places.
        places: usize,
    },
    /// The places are those of another machine, or of other joints.
    #[error(
        "the places that were measured do not fit the model: after the best turn and shift they are {left_mm:.0} mm off (root mean square), {share:.0} % of their own spread; joints, markers or the model are others"
    )]
    OtherMachine {
        /// Distance, mm.
        left_mm: f64,
        /// Relative to the spread of the places, percent.
        share: f64,
    },
}

/// Distance relative to the spread of the places above which they are those of another machine.
const MOST: f64 = 0.05;

/// Finds the frame and brings all readings into the base; loads are in the base as they are.
///
/// # Errors
/// [`NoFrame`] for too few places, and for places that do not fit.
pub fn into_base(
    rows: &mut [MeasuredRow],
    mechanism: &Mechanism,
) -> Result<InstrumentFrame, NoFrame> {
    let pairs: Vec<(Vector3<f64>, Vector3<f64>)> = rows
        .iter()
        .filter(|row| !row.is_loaded())
        .filter_map(|row| {
            let posture = mechanism
                .posture(PostureRequest::commands(&row.commands))
                .ok()?;
            let body = PlacedBody::of(row.marker.on, &posture, &posture.rest_state());
            Some((
                row.read.position?,
                body.pose.translation.vector + body.pose.rotation * row.marker.at,
            ))
        })
        .collect();
    let places = pairs.len();
    let count = places.max(1) as f64;
    let measured = pairs.iter().map(|p| p.0).sum::<Vector3<f64>>() / count;
    let modelled = pairs.iter().map(|p| p.1).sum::<Vector3<f64>>() / count;
    let mut spread = Matrix3::zeros();
    for (a, b) in &pairs {
        spread += (a - measured) * (b - modelled).transpose();
    }
    let found = SingularValues::of(&spread);
    let [first, second, ..] = found.values[..] else {
        return Err(NoFrame::TooFew { places });
    };
    if places < 3 || second <= 3e-3 * first || first == 0.0 {
        return Err(NoFrame::TooFew { places });
    }
    let (left, right) = (
        found.left.fixed_view::<3, 3>(0, 0).into_owned(),
        found.right.fixed_view::<3, 3>(0, 0).into_owned(),
    );
    let sign = (right * left.transpose()).determinant().signum();
    let turn = right * Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, sign)) * left.transpose();
    let rotation = Rotation3::from_matrix_unchecked(turn);
    let origin = modelled - rotation * measured;
    let off = pairs
        .iter()
        .map(|(a, b)| (rotation * a + origin - b).norm_squared())
        .sum::<f64>();
    let size = pairs
        .iter()
        .map(|(_, b)| (b - modelled).norm_squared())
        .sum::<f64>();
    let frame = InstrumentFrame {
        rotation,
        origin,
        left: (off / count).sqrt(),
        places,
    };
    let share = (off / size).sqrt();
    if share > MOST {
        return Err(NoFrame::OtherMachine {
            left_mm: 1e3 * frame.left,
            share: 100.0 * share,
        });
    }
    for read in rows.iter_mut().map(|row| &mut row.read) {
        let vectors = [&mut read.displacement, &mut read.turn]
            .into_iter()
            .flatten();
        vectors.for_each(|v| *v = rotation * *v);
        if let Some(position) = &mut read.position {
            *position = rotation * *position + origin;
        }
        if let Some((_, direction)) = &mut read.gauge {
            *direction = rotation * *direction;
        }
    }
    Ok(frame)
}
