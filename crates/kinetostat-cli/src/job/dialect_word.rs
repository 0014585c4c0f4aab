//! Dialects of G-code by their word.

use clap::ValueEnum;
use kinetostat_program::Dialect;
use serde::Deserialize;

/// Controllers whose readings are followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub(crate) enum DialectWord {
    /// LinuxCNC 2.9
    #[value(name = "linuxcnc")]
    LinuxCnc,
    /// Fanuc's milling controllers, and those that follow them
    Fanuc,
}

impl DialectWord {
    pub(crate) fn dialect(self) -> Dialect {
        match self {
            Self::LinuxCnc => Dialect::LinuxCnc,
            Self::Fanuc => Dialect::Fanuc,
        }
    }
}
