//! One model of robot programs for all languages: motions with poses, and where in the text these stand.
//!
//! A reader fills it, [`crate::write()`] takes it. It knows no language; lengths are in mm, angles in degrees where the name
//! says so, poses in the axes of the work object as written.

pub(crate) mod external;
pub(crate) mod motion;
pub(crate) mod orientation;
pub(crate) mod parsed;
pub(crate) mod program;
pub(crate) mod site;
pub(crate) mod stated_value;
pub(crate) mod target;

macro_rules! enumerated {
    ($($name:ident, $words:literal, $entry:expr;)*) => {
        /// The languages that are read.
        ///
        /// Facts of a language are asked of it by methods.
        ///
        /// ```
        /// use kinetostat_formats::Language;
        ///
        /// assert_eq!(Language::Krl.name(), "KRL");
        /// assert!(Language::Siemens.rapids_are_straight());
        /// ```
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum Language {
            $(#[doc = $words] $name,)*
        }

        impl Language {
            /// Each language once.
            pub const ALL: [Self; [$($words),*].len()] = [$(Self::$name),*];
        }
    };
}

each_language!(enumerated);
