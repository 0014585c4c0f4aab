//! The registry of languages: a line for each.
//!
//! A language is a folder of this crate: its reader, its writer, its table of statements, and a file `language.rs` with what all other
//! files ask of it ([`ProgramLanguage`]). They ask the [`Language`] of a program, which is one of this list and stands for its entry.

use std::ops::Deref;

use crate::model::language::Language;
use crate::program_language::ProgramLanguage;

/// Gives a macro the languages in the order in which they are listed: the name of each in code, in words, and its entry.
macro_rules! each_language {
    ($made:ident) => {
        $made! {
            Rapid, "ABB RAPID.", crate::rapid::language::RapidLanguage;
            Krl, "KUKA KRL.", crate::krl::language::KrlLanguage;
            FanucLs, "FANUC TP programs as text.", crate::ls::language::LsLanguage;
            Apt, "APT and CLDATA.", crate::apt::language::AptLanguage;
            Siemens, "SINUMERIK 840D.", crate::siemens::language::SiemensLanguage;
            Heidenhain, "Heidenhain conversational.", crate::heidenhain::language::HeidenhainLanguage;
            Val3, "Staubli VAL3.", crate::val3::language::Val3Language;
            Poses, "Lists of poses: tables (CSV) and YAML.", crate::poses::language::PosesLanguage;
        }
    };
}

macro_rules! entries {
    ($($name:ident, $words:literal, $entry:expr;)*) => {
        /// Facts and acts of a language, as its folder states them.
        impl Deref for Language {
            type Target = dyn ProgramLanguage;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$name => &$entry,)*
                }
            }
        }
    };
}

each_language!(entries);
