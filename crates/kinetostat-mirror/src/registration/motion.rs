//! Motions of measured points.

use nalgebra::{UnitQuaternion, Vector3};

/// A turn, a scale and a shift: `rotation * position * scale + shift`.
///
/// ```
/// use kinetostat_mirror::Motion;
/// use nalgebra::{UnitQuaternion, Vector3};
///
/// let motion = Motion {
///     rotation: UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, std::f64::consts::FRAC_PI_2)),
///     shift_mm: Vector3::new(0.0, 0.0, 5.0),
///     scale: 1.0,
/// };
/// let moved = motion.of(&Vector3::new(10.0, 0.0, 0.0));
/// assert!((moved - Vector3::new(0.0, 10.0, 5.0)).norm() < 1e-14);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// The turn.
    pub rotation: UnitQuaternion<f64>,
    /// The shift after it, mm.
    pub shift_mm: Vector3<f64>,
    /// The scale, 1 where none is sought.
    pub scale: f64,
}

impl Default for Motion {
    fn default() -> Self {
        Self {
            rotation: UnitQuaternion::identity(),
            shift_mm: Vector3::zeros(),
            scale: 1.0,
        }
    }
}

impl Motion {
    /// Moved point, mm.
    #[must_use]
    pub fn of(&self, position_mm: &Vector3<f64>) -> Vector3<f64> {
        self.rotation * position_mm * self.scale + self.shift_mm
    }
}

/// A motion that the points do not determine: it changes no distance from the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FreeMotion {
    /// A turn about an axis through a place (mm).
    Turn {
        /// A place of the axis, mm.
        through_mm: Vector3<f64>,
        /// Direction of the axis.
        along: Vector3<f64>,
    },
    /// A shift.
    Shift {
        /// Direction of the shift.
        along: Vector3<f64>,
    },
    /// A scale, where one is sought.
    Growth,
}

impl FreeMotion {
    /// Motion in words.
    ///
    /// ```
    /// use kinetostat_mirror::FreeMotion;
    /// use nalgebra::Vector3;
    ///
    /// let free = FreeMotion::Shift { along: Vector3::x() };
    /// assert_eq!(free.to_string(), "a shift along (1.00, 0.00, 0.00)");
    /// ```
    fn words(&self) -> String {
        let of = |v: &Vector3<f64>, digits: usize| {
            let number = |x: f64| {
                let text = format!("{x:.digits$}");
                let is_zero = text.trim_start_matches('-').parse() == Ok(0.0);
                match is_zero {
                    true => text.trim_start_matches('-').to_owned(),
                    false => text,
                }
            };
            format!("({}, {}, {})", number(v.x), number(v.y), number(v.z))
        };
        match self {
            Self::Turn { through_mm, along } => format!(
                "a turn about the axis through {} mm along {}",
                of(through_mm, 3),
                of(along, 2)
            ),
            Self::Shift { along } => format!("a shift along {}", of(along, 2)),
            Self::Growth => "a scale".to_owned(),
        }
    }
}

impl std::fmt::Display for FreeMotion {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.words())
    }
}
