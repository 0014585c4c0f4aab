//! Shoulder, elbow and wrist branches of a target's configuration.

use crate::model::language::Language;
use crate::model::target::Configuration;

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
    /// To which side the elbow bends (KUKA: bit 1 of S; ABB: bit 1 of cfx; FANUC: D).
    pub elbow: Option<bool>,
    /// To which side the wrist bends (KUKA: bit 2 of S; ABB: bit 0 of cfx; FANUC: F).
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
