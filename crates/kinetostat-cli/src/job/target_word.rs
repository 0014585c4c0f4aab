//! Languages that programs are made in, as options write them.

use clap::ValueEnum;
use kinetostat_formats::{Language, MakeLanguage};
use serde::Deserialize;

/// A language that a program is made in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
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
    /// Table of joint values of an arm (.csv)
    Joints,
}

impl TargetWord {
    pub(crate) fn language(self) -> MakeLanguage {
        match self {
            Self::Krl => MakeLanguage::Krl,
            Self::Rapid => MakeLanguage::Rapid,
            Self::Ls => MakeLanguage::FanucLs,
            Self::Apt => MakeLanguage::Apt,
            Self::Gcode => MakeLanguage::Gcode,
            // Joint values are found for a table of poses.
            Self::Csv | Self::Joints => MakeLanguage::Csv,
        }
    }

    /// Name in sentences.
    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Joints => "a table of joint values",
            _ => self.language().title(),
        }
    }
}

/// A language of robots that a run makes its program in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RobotWord {
    /// KUKA KRL (.src)
    Krl,
    /// ABB RAPID (.mod)
    Rapid,
    /// FANUC TP program as text (.ls)
    Ls,
}

impl RobotWord {
    pub(crate) fn language(self) -> MakeLanguage {
        match self {
            Self::Krl => MakeLanguage::Krl,
            Self::Rapid => MakeLanguage::Rapid,
            Self::Ls => MakeLanguage::FanucLs,
        }
    }

    /// Language for reading its programs.
    pub(crate) fn of_robot(self) -> Language {
        match self {
            Self::Krl => Language::Krl,
            Self::Rapid => Language::Rapid,
            Self::Ls => Language::FanucLs,
        }
    }
}
