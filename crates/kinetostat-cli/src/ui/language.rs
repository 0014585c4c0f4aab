//! The language of reports, as options name it.

use clap::ValueEnum;
use kinetostat_report::Language;
use serde::Deserialize;

/// Language of reports, as it is named.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "snake_case")]
pub(crate) enum LanguageWord {
    /// English
    En,
    /// French
    Fr,
    /// German
    De,
}

impl LanguageWord {
    /// English where none is named.
    pub(crate) fn language(word: Option<Self>) -> Language {
        match word {
            None | Some(Self::En) => Language::English,
            Some(Self::Fr) => Language::French,
            Some(Self::De) => Language::German,
        }
    }
}
