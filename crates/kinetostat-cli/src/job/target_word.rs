//! Languages that programs are made in, as options write them.

use clap::ValueEnum;
use kinetostat_formats::MakeLanguage;
use serde::Deserialize;

/// A language that a program is made in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum TargetWord {
    /// KUKA KRL (.src)
    Krl,
    /// ABB RAPID (.mod)
    Rapid,
    /// FANUC TP program as text (.ls)
    Ls,
    /// APT (.apt)
    Apt,
    /// G-code of three axes (.ngc)
    Gcode,
    /// Table of poses (.csv)
    Csv,
}

impl TargetWord {
    pub(crate) fn language(self) -> MakeLanguage {
        match self {
            Self::Krl => MakeLanguage::Krl,
            Self::Rapid => MakeLanguage::Rapid,
            Self::Ls => MakeLanguage::FanucLs,
            Self::Apt => MakeLanguage::Apt,
            Self::Gcode => MakeLanguage::Gcode,
            Self::Csv => MakeLanguage::Csv,
        }
    }
}
