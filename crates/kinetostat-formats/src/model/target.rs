//! Targets of motions, with the shoulder, elbow and wrist branches of their configuration.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::model::Language;

/// Arm configuration of a pose, as written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Configuration {
    /// The text: `[0,-1,-1,0]`, `S 2,T 35`, `N U T, 0, 0, 0`; empty where nothing is stated.
    pub text: String,
    /// Numbers of the configuration in their order.
    pub numbers: Vec<f64>,
}

/// A pose of the tool in the axes of the work object.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PoseTarget {
    /// Place of the tool centre point in mm.
    pub position_mm: Vector3<f64>,
    /// Turns the work object's axes into the tool's.
    pub orientation: UnitQuaternion<f64>,
    /// Arm configuration.
    pub configuration: Configuration,
    /// External axes as written, mm or degrees; none where an axis is not stated (RAPID's 9E9).
    pub external: Vec<Option<f64>>,
}

impl PoseTarget {
    /// Place and orientation as one.
    ///
    /// ```
    /// use kinetostat_formats::{Configuration, PoseTarget};
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let target = PoseTarget {
    ///     position_mm: Vector3::new(1.0, 2.0, 3.0),
    ///     orientation: UnitQuaternion::identity(),
    ///     configuration: Configuration::default(),
    ///     external: Vec::new(),
    /// };
    /// assert_eq!(target.isometry().translation.vector.z, 3.0);
    /// ```
    #[must_use]
    pub fn isometry(&self) -> Isometry3<f64> {
        Isometry3::from_parts(Translation3::from(self.position_mm), self.orientation)
    }
}

/// Target of a motion.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// A pose of the tool.
    Pose(PoseTarget),
    /// Values of the robot's joints as written: degrees, or mm of linear ones.
    Joints {
        /// Values in the order of the joints.
        values_deg: Vec<f64>,
    },
    /// Target that is unknown from the text: only with [`crate::UnknownTargets::LeftAsWritten`].
    Unknown {
        /// Reason in words.
        reason: String,
    },
}

impl Target {
    /// The pose, where it is one.
    ///
    /// ```
    /// use kinetostat_formats::Target;
    ///
    /// assert_eq!(Target::Joints { values_deg: vec![0.0; 6] }.pose(), None);
    /// ```
    #[must_use]
    pub fn pose(&self) -> Option<&PoseTarget> {
        match self {
            Self::Pose(pose) => Some(pose),
            _ => None,
        }
    }
}

/// Shoulder, elbow and wrist of an arm as a target states them; `None` where it says nothing of one.
///
/// Which side of the elbow and of the wrist a flag means depends on the zeros and directions of the maker's axes, which a program does
/// not say: two targets with the same flag bend to the same side, and two with different flags to different ones.
///
/// ```
/// use kinetostat_formats::{Configuration, Language, StatedArm};
///
/// let stated = |text: &str, numbers: &[f64]| Configuration {
///     text: text.to_owned(),
///     numbers: numbers.to_vec(),
/// };
/// let abb = StatedArm::of(Language::Rapid, &stated("[0,-1,-1,6]", &[0.0, -1.0, -1.0, 6.0]));
/// assert_eq!(abb, StatedArm { is_back: Some(true), elbow: Some(true), wrist: Some(false) });
/// let kuka = StatedArm::of(Language::Krl, &stated("S 2,T 35", &[2.0, 35.0]));
/// assert_eq!(kuka, StatedArm { is_back: Some(false), elbow: Some(true), wrist: Some(false) });
/// let fanuc = StatedArm::of(Language::FanucLs, &stated("F U B, 0, 0, 0", &[0.0; 3]));
/// assert_eq!(fanuc, StatedArm { is_back: Some(true), elbow: Some(false), wrist: Some(true) });
/// assert_eq!(StatedArm::of(Language::Apt, &stated("", &[])), StatedArm::default());
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[allow(
    clippy::exhaustive_structs,
    reason = "an arm of six axes has these three"
)]
pub struct StatedArm {
    /// The centre of the wrist is behind axis 1 (KUKA: bit 0 of S; ABB: cfx of 4 and above; FANUC: B).
    pub is_back: Option<bool>,
    /// Elbow branch (KUKA: bit 1 of S; ABB: bit 1 of cfx; FANUC: D).
    pub elbow: Option<bool>,
    /// Wrist branch (KUKA: bit 2 of S; ABB: bit 0 of cfx; FANUC: F).
    pub wrist: Option<bool>,
}

impl StatedArm {
    /// Decodes a configuration.
    #[must_use]
    pub fn of(language: Language, configuration: &Configuration) -> Self {
        language.stated_arm(configuration)
    }

    /// Shoulder, elbow and wrist in a number below 8, each with the value of its bit.
    pub(crate) fn of_bits(number: Option<&f64>, bits: [u8; 3]) -> Self {
        let is_whole = |value: &&f64| (0.0..8.0).contains(*value) && value.fract() == 0.0;
        let whole = number.filter(is_whole).map(|value| *value as u8);
        let [is_back, elbow, wrist] = bits.map(|bit| whole.map(|whole| whole & bit != 0));
        Self {
            is_back,
            elbow,
            wrist,
        }
    }

    /// Number of [`Self::of_bits`], where all three are known.
    pub(crate) fn in_bits(&self, bits: [u8; 3]) -> Option<u8> {
        let all = [self.is_back?, self.elbow?, self.wrist?];
        let set = all.into_iter().zip(bits);
        Some(set.map(|(is, bit)| if is { bit } else { 0 }).sum())
    }
}
