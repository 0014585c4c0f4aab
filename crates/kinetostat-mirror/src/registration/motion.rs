//! Motions of measured points, and the one that fits pairs of points best.

use nalgebra::{Matrix3, Matrix4, Quaternion, UnitQuaternion, Vector3, Vector4};

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

/// Eigenvalues so near to the largest (as a share of the largest size) belong to turns that fit as well: points on a line.
const AS_WELL: f64 = 1e-9;

/// Points (from, to) with a weight.
pub(crate) type Pair = (Vector3<f64>, Vector3<f64>, f64);

/// The motion with the smallest weighted sum of squares between the first of each pair, moved, and the second; of several that
/// fit as well the one that turns least, or the one without a turn (`only_shift`). `None` of nothing.
///
/// B. K. P. Horn, Closed-form solution of absolute orientation using unit quaternions, J. Opt. Soc. Am. A 4 (1987) 629: the
/// turn is the eigenvector of the largest eigenvalue of a symmetric 4 x 4 matrix.
pub(crate) fn closest_motion(pairs: &[Pair], only_shift: bool) -> Option<Motion> {
    let total: f64 = pairs.iter().map(|pair| pair.2).sum();
    if total.is_nan() || total <= 0.0 {
        return None;
    }
    let mean = |of: fn(&Pair) -> Vector3<f64>| {
        let sum: Vector3<f64> = pairs.iter().map(|pair| of(pair) * pair.2).sum();
        sum / total
    };
    let (from_middle, to_middle) = (mean(|pair| pair.0), mean(|pair| pair.1));
    if only_shift {
        return Some(Motion {
            shift_mm: to_middle - from_middle,
            ..Motion::default()
        });
    }
    let mut product = Matrix3::zeros();
    for (from, to, weight) in pairs {
        let (from, to) = (from - from_middle, to - to_middle);
        product += from * to.transpose() * *weight;
    }
    let rotation = turn(&product)?;
    Some(Motion {
        rotation,
        shift_mm: to_middle - rotation * from_middle,
        scale: 1.0,
    })
}

/// The turn of the sum of products of what is turned with what it is turned to.
fn turn(s: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    if !s.iter().all(|entry| entry.is_finite()) {
        return None;
    }
    let (xx, yy, zz) = (s[(0, 0)], s[(1, 1)], s[(2, 2)]);
    let (yz, zx, xy) = (
        s[(1, 2)] - s[(2, 1)],
        s[(2, 0)] - s[(0, 2)],
        s[(0, 1)] - s[(1, 0)],
    );
    let (xy_both, zx_both, yz_both) = (
        s[(0, 1)] + s[(1, 0)],
        s[(2, 0)] + s[(0, 2)],
        s[(1, 2)] + s[(2, 1)],
    );
    let matrix = Matrix4::new(
        xx + yy + zz,
        yz,
        zx,
        xy,
        yz,
        xx - yy - zz,
        xy_both,
        zx_both,
        zx,
        xy_both,
        yy - xx - zz,
        yz_both,
        xy,
        zx_both,
        yz_both,
        zz - xx - yy,
    );
    let eigen = matrix.symmetric_eigen();
    let size = eigen.eigenvalues.iter().fold(0.0, |size, value| {
        if value.abs() > size {
            value.abs()
        } else {
            size
        }
    });
    let largest = eigen.eigenvalues[eigen.eigenvalues.imax()];
    let unmoved = Vector4::new(1.0, 0.0, 0.0, 0.0);
    let mut best = Vector4::zeros();
    let mut any = Vector4::zeros();
    for (value, vector) in eigen
        .eigenvalues
        .iter()
        .zip(eigen.eigenvectors.column_iter())
    {
        if largest - value <= AS_WELL * size {
            any = vector.into_owned();
            best += any * any.dot(&unmoved);
        }
    }
    let chosen = if best.norm() > 1e-6 { best } else { any };
    let quaternion = Quaternion::new(chosen[0], chosen[1], chosen[2], chosen[3]);
    UnitQuaternion::try_new(quaternion, f64::MIN_POSITIVE)
}
