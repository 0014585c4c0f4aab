//! The languages of robots and machines.

/// The languages that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Language {
    /// ABB RAPID.
    Rapid,
    /// FANUC TP programs as text.
    FanucLs,
    /// APT and CLDATA.
    Apt,
    /// KUKA KRL.
    Krl,
    /// Lists of poses: tables (CSV) and YAML.
    Poses,
    /// SINUMERIK 840D.
    Siemens,
    /// Heidenhain conversational.
    Heidenhain,
}

impl Language {
    /// Whether its rapids go straight: those of robots' languages move all joints in step.
    #[must_use]
    pub const fn rapids_are_straight(self) -> bool {
        matches!(self, Self::Siemens | Self::Heidenhain | Self::Apt)
    }

    /// Each language once.
    pub const ALL: [Self; 7] = [
        Self::Rapid,
        Self::Krl,
        Self::FanucLs,
        Self::Apt,
        Self::Siemens,
        Self::Heidenhain,
        Self::Poses,
    ];
}
