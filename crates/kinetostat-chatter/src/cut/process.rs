//! Any cut with its delay.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use crate::cut::milling::MillingCut;
use crate::cut::piece::{Active, Piece, force_direction, normal};
use crate::error::{ChatterError, ChatterErrorKind, Result, above};
use crate::number::larger;

/// A cut whose edge meets the track of the one before.
#[derive(Clone, Debug, PartialEq)]
pub enum Cut {
    /// Teeth come and go.
    Milling(MillingCut),
    /// One edge stays in.
    Turning(TurningCut),
}

impl From<MillingCut> for Cut {
    fn from(cut: MillingCut) -> Self {
        Self::Milling(cut)
    }
}

impl From<TurningCut> for Cut {
    fn from(cut: TurningCut) -> Self {
        Self::Turning(cut)
    }
}

impl Cut {
    /// Edges that pass in one turn.
    #[must_use]
    pub fn teeth(&self) -> usize {
        match self {
            Self::Milling(cut) => cut.teeth(),
            Self::Turning(_) => 1,
        }
    }

    /// Time from edge to edge at a spindle speed, s: `60/(N rpm)` [D 8].
    ///
    /// # Errors
    /// A speed that is not positive.
    pub fn delay(&self, speed_rpm: f64) -> Result<f64> {
        let speed = checked_speed(speed_rpm)?;
        Ok(60.0 / (speed * self.teeth() as f64))
    }

    /// Mean of the directional matrix over the turn, N/m^2, in the axes of the cut [D 9]: force on the tool by depth and
    /// displacement.
    #[must_use]
    pub fn mean_matrix(&self) -> Matrix3<f64> {
        match self {
            Self::Milling(cut) => cut.mean(),
            Self::Turning(cut) => cut.matrix(),
        }
    }

    /// Largest size of the directional matrix, at most, N/m^2.
    pub(crate) fn bound(&self) -> f64 {
        match self {
            Self::Milling(cut) => {
                let k = cut.coefficients();
                let one = k.tangential().hypot(k.radial()).hypot(k.axial());
                let arc = (cut.arc().exit() - cut.arc().entry()) / TAU;
                one * (arc * cut.teeth() as f64).ceil()
            }
            Self::Turning(cut) => cut.matrix().norm(),
        }
    }

    /// Longest stretch of the turn with something in the material at any depth up to one, m, rad: no less than it is.
    pub(crate) fn longest(&self, up_to: f64) -> f64 {
        let lag = match self {
            Self::Milling(cut) => cut.lag_per_depth().abs() * up_to,
            Self::Turning(_) => 0.0,
        };
        // A helix adds breaks to those of straight teeth, and reaches by its lag into what is air for these.
        let length = |piece: Piece| match piece.active.is_empty() && lag < piece.length {
            true => lag,
            false => piece.length,
        };
        self.pieces(0.0).into_iter().map(length).fold(0.0, larger)
    }

    /// True if the pieces depend on the depth.
    pub(crate) fn pieces_depend_on_depth(&self) -> bool {
        match self {
            Self::Milling(cut) => cut.lag_per_depth() != 0.0,
            Self::Turning(_) => false,
        }
    }

    /// Pieces of one period, in order of time.
    pub(crate) fn pieces(&self, depth: f64) -> Vec<Piece> {
        match self {
            Self::Milling(cut) => cut.pieces(depth),
            Self::Turning(cut) => vec![Piece {
                start: 0.0,
                length: TAU,
                active: vec![Active::Constant(cut.matrix())],
            }],
        }
    }

    /// Directional matrix of a piece at a turn as a sum of products, force by displacement: N/m^2, and unit vectors.
    ///
    /// One product where one straight edge is in the cut, else those of feed and its left.
    pub(crate) fn factors(&self, piece: &Piece, turn: f64) -> Vec<(Vector3<f64>, Vector3<f64>)> {
        match self {
            Self::Turning(cut) => {
                let (chip, force) = cut.factors();
                vec![(force, chip)]
            }
            Self::Milling(cut) => match piece.single_edge() {
                Some(offset) => {
                    let angle = turn + offset;
                    let force = force_direction(cut.coefficients(), angle);
                    vec![(force, normal(angle))]
                }
                None => {
                    let matrix = piece.matrix(cut.coefficients(), turn);
                    let column = |i: usize| matrix.column(i).into_owned();
                    vec![(column(0), Vector3::x()), (column(1), Vector3::y())]
                }
            },
        }
    }
}

/// A spindle speed that turns.
pub(crate) fn checked_speed(speed_rpm: f64) -> Result<f64> {
    above(
        ChatterErrorKind::Setting,
        "spindle speed",
        speed_rpm,
        0.0,
        true,
        "rpm",
    )
}

/// A depth that is not negative.
pub(crate) fn checked_depth(depth: f64) -> Result<f64> {
    above(
        ChatterErrorKind::Setting,
        "depth of cut",
        depth,
        0.0,
        false,
        "m",
    )
}

/// A single edge that never leaves the cut and meets its own track after one turn.
#[derive(Clone, Debug, PartialEq)]
pub struct TurningCut {
    chip: Vector3<f64>,
    force: Vector3<f64>,
}

impl TurningCut {
    /// The force on the tool is `-coefficient a (chip . (r - r_before)) force`: a displacement along `chip` thickens the chip,
    /// and the cut pushes back against `force`; coefficient in N/m^2, `a` the width of the chip. Both directions are made
    /// unit vectors; the frame is that of the tool's response.
    ///
    /// # Errors
    /// A direction without length, a coefficient that is not positive.
    pub fn new(chip: Vector3<f64>, force: Vector3<f64>, coefficient: f64) -> Result<Self> {
        let kind = ChatterErrorKind::Cut;
        above(kind, "cutting coefficient", coefficient, 0.0, true, "N/m^2")?;
        for (quantity, vector) in [("chip direction", chip), ("force direction", force)] {
            if !(vector.norm() > 0.0 && vector.norm().is_finite()) {
                return Err(ChatterError::new(
                    kind,
                    quantity,
                    format!("{:?}", vector.as_slice()),
                    "a direction: finite numbers, not all zero",
                ));
            }
        }
        Ok(Self {
            chip: chip.normalize(),
            force: -coefficient * force.normalize(),
        })
    }

    /// Force on the tool per width and displacement, N/m^2.
    #[must_use]
    pub fn matrix(&self) -> Matrix3<f64> {
        self.force * self.chip.transpose()
    }

    /// Unit vector along which a displacement thickens the chip, and force on the tool per width and displacement, N/m^2.
    pub(crate) fn factors(&self) -> (Vector3<f64>, Vector3<f64>) {
        (self.chip, self.force)
    }
}
