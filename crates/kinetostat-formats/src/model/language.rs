//! The languages of robots and machines.

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
