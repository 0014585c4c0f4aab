//! The axes of the cut: x along the feed, z along the tool axis towards the spindle, y to the left of the feed.

use nalgebra::{Matrix3, Vector3};

use crate::error::{ChatterError, ChatterErrorKind, Result};

/// Axes of the cut in those of the machine: the columns are feed, left of the feed, and tool axis towards the spindle.
///
/// ```
/// use kinetostat_chatter::FeedFrame;
///
/// // A vertical spindle, fed along the base's y: left of the feed is -x.
/// let frame = FeedFrame::new([0.0, 1.0, 0.0].into(), [0.0, 0.0, 1.0].into())?;
/// assert_eq!(frame.rotation().column(1).as_slice(), [-1.0, 0.0, 0.0]);
/// # Ok::<(), kinetostat_chatter::ChatterError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FeedFrame {
    rotation: Matrix3<f64>,
}

/// Tolerance of the columns' right angles and unit lengths.
const TOLERANCE: f64 = 1e-6;

impl FeedFrame {
    /// Frame from the feed and the tool axis (from the tip towards the spindle), in base axes; a component of the feed
    /// along the axis is ignored.
    ///
    /// # Errors
    /// A direction that is not finite or has no length; a feed along the tool axis, which has no left side.
    pub fn new(feed: Vector3<f64>, towards_spindle: Vector3<f64>) -> Result<Self> {
        let kind = ChatterErrorKind::Cut;
        let unit = |vector: Vector3<f64>, quantity: &str| {
            vector
                .iter()
                .all(|value| value.is_finite())
                .then(|| vector.try_normalize(0.0))
                .flatten()
                .ok_or_else(|| {
                    ChatterError::new(
                        kind,
                        quantity,
                        format!("{:?}", vector.as_slice()),
                        "a direction: finite numbers, not all zero",
                    )
                })
        };
        let z = unit(towards_spindle, "tool axis")?;
        let along = unit(feed, "feed direction")?;
        let across = along - z * z.dot(&along);
        if across.norm() < TOLERANCE {
            return Err(ChatterError::new(
                kind,
                "feed direction",
                "along the tool axis",
                "a feed across the tool axis",
            ));
        }
        let x = across.normalize();
        Ok(Self {
            rotation: Matrix3::from_columns(&[x, z.cross(&x), z]),
        })
    }

    /// A vertical spindle (base z) fed at an angle from base x, rad.
    ///
    /// # Errors
    /// An angle that is not finite.
    pub fn vertical(angle: f64) -> Result<Self> {
        Self::new(Vector3::new(angle.cos(), angle.sin(), 0.0), Vector3::z())
    }

    /// Columns: feed, left of the feed, tool axis towards the spindle.
    #[must_use]
    pub fn rotation(&self) -> &Matrix3<f64> {
        &self.rotation
    }
}
