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
