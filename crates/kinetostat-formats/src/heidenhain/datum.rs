//! Coordinate transformations: datum shift, mirror image, rotation and scaling (cycles 7, 8, 10, 11), tilted planes.

use nalgebra::{Matrix3, Vector3};

use crate::heidenhain::words::Word;

/// Rotation, mirror image or scaling of the coordinates; only one at a time is followed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) enum Bend {
    #[default]
    None,
    /// Axes that are mirrored.
    Mirror([bool; 3]),
    /// Rotation about Z, degrees.
    Rotation(f64),
    Scale(f64),
    /// PLANE tilts the axes.
    Tilt(Matrix3<f64>),
}

impl Bend {
    /// Scale factor of an axis; `None` for rotations, tilted planes and scaled lengths.
    pub(crate) fn factor(&self, axis: usize) -> Option<f64> {
        match self {
            Self::None => Some(1.0),
            Self::Mirror(axes) if axes[axis] => Some(-1.0),
            Self::Mirror(_) => Some(1.0),
            Self::Rotation(_) | Self::Scale(_) | Self::Tilt(_) => None,
        }
    }
}

/// The coordinates of a program in those of the control's preset: shifted, then bent about the shifted datum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Datum {
    pub shift_mm: Vector3<f64>,
    pub bend: Bend,
}

impl Datum {
    fn matrix(&self) -> Matrix3<f64> {
        match self.bend {
            Bend::None => Matrix3::identity(),
            Bend::Mirror(axes) => Matrix3::from_diagonal(&Vector3::from_fn(|i, _| match axes[i] {
                true => -1.0,
                false => 1.0,
            })),
            Bend::Rotation(degrees) => {
                let (sin, cos) = degrees.to_radians().sin_cos();
                Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
            }
            Bend::Scale(factor) => Matrix3::identity() * factor,
            Bend::Tilt(turn) => turn,
        }
    }

    /// A programmed place in the axes of the preset, mm.
    pub(crate) fn preset(&self, place: &Vector3<f64>) -> Vector3<f64> {
        match self.bend {
            Bend::None => place + self.shift_mm,
            _ => self.matrix() * place + self.shift_mm,
        }
    }

    /// A place of the preset as it is programmed, mm.
    pub(crate) fn programmed(&self, place: &Vector3<f64>) -> Vector3<f64> {
        let place = place - self.shift_mm;
        match self.bend {
            Bend::None => place,
            Bend::Scale(factor) => place / factor,
            // A mirror image is its own inverse; a rotation is inverted.
            Bend::Mirror(_) => self.matrix() * place,
            Bend::Rotation(_) | Bend::Tilt(_) => self.matrix().transpose() * place,
        }
    }

    /// A step of the preset as it is programmed, mm.
    pub(crate) fn step(&self, step: &Vector3<f64>) -> Vector3<f64> {
        self.programmed(&(step + self.shift_mm))
    }

    /// A direction in the axes of the preset, of length 1.
    pub(crate) fn direction(&self, way: &Vector3<f64>) -> Vector3<f64> {
        (self.matrix() * way).normalize()
    }

    /// A direction of the preset as it is programmed, of length 1.
    pub(crate) fn programmed_direction(&self, way: &Vector3<f64>) -> Vector3<f64> {
        (self.matrix().transpose() * way).normalize()
    }

    /// -1 where the sense of arcs turns over.
    pub(crate) fn sense(&self) -> f64 {
        self.matrix().determinant().signum()
    }

    /// True if a step along one axis is a step along the same axis of the preset.
    pub(crate) fn keeps_axes(&self) -> bool {
        !matches!(self.bend, Bend::Rotation(_) | Bend::Tilt(_))
    }
}

/// A cycle that moves the coordinates, from a line of it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Change {
    /// Axis, mm, whether it is added.
    Shift(Vec<(usize, f64, bool)>),
    Bend(Bend),
    /// The transformation does not change.
    Kept,
    Refused(&'static str),
}

/// True if the holes of a cycle are expanded.
pub(crate) fn is_followed(cycle: u32) -> bool {
    matches!(cycle, 1 | 200 | 201 | 203)
}

/// Borings, taps and other holes whose way is the control's own: such a cycle stays, one call over each hole.
pub(crate) const KEPT: [u32; 8] = [202, 204, 205, 206, 207, 209, 240, 241];

/// The number of an axis.
pub(crate) fn axis_of(word: &Word) -> Option<(usize, bool)> {
    match word.letters.letters() {
        b"X" => Some((0, false)),
        b"Y" => Some((1, false)),
        b"Z" => Some((2, false)),
        b"IX" => Some((0, true)),
        b"IY" => Some((1, true)),
        b"IZ" => Some((2, true)),
        _ => None,
    }
}

/// Reason for the refusal of a change by a parameter.
pub(crate) const PARAMETER: &str = "a Q parameter says by how much";

/// Change by a line `CYCL DEF n.m`, from the words after the number.
pub(crate) fn change(cycle: u32, part: u32, words: &[Word], unit_mm: f64) -> Change {
    if part == 0 {
        return Change::Kept;
    }
    match cycle {
        7 => {
            let mut shifts = Vec::new();
            for word in words {
                match (axis_of(word), word.value()) {
                    (Some((axis, adds)), Some(value)) => {
                        shifts.push((axis, value * unit_mm, adds));
                    }
                    (Some(_), None) => return Change::Refused(PARAMETER),
                    (None, _) => {
                        return Change::Refused("the datum is in a table, or of another axis");
                    }
                }
            }
            Change::Shift(shifts)
        }
        8 => {
            let mut axes = [false; 3];
            for word in words {
                match axis_of(word) {
                    Some((axis, false)) => axes[axis] = true,
                    _ => return Change::Refused("it mirrors another axis than X, Y or Z"),
                }
            }
            Change::Bend(match axes {
                [false, false, false] => Bend::None,
                _ => Bend::Mirror(axes),
            })
        }
        10 => match words {
            [word] if word.is("ROT") => match word.value() {
                Some(0.0) => Change::Bend(Bend::None),
                Some(angle) => Change::Bend(Bend::Rotation(angle)),
                None => Change::Refused(PARAMETER),
            },
            [word] if word.is("IROT") => {
                Change::Refused("the rotation adds to the one before (IROT), which is not followed")
            }
            _ => Change::Refused("the rotation is not one angle `ROT`"),
        },
        11 => match words {
            [word] if word.is("SCL") => match word.value() {
                Some(1.0) => Change::Bend(Bend::None),
                Some(factor) if (1e-3..=1e3).contains(&factor) => Change::Bend(Bend::Scale(factor)),
                Some(_) => Change::Refused("the factor is not from 0.001 to 1000"),
                None => Change::Refused(PARAMETER),
            },
            _ => Change::Refused("the scaling is not one factor `SCL`"),
        },
        _ => Change::Kept,
    }
}
