//! Forms of program files, and their name endings.

use crate::model::Language;

/// Form of a program file, as its name ending implies it.
///
/// ```
/// use kinetostat_formats::{FileForm, Language};
///
/// let csv = FileForm::of(Some(Language::Poses), "poses.csv", b"x_mm,y_mm,z_mm\n");
/// assert_eq!(csv, FileForm::Csv);
/// assert!(csv.fits("corrected.CSV") && !csv.fits("corrected.parquet"));
/// assert!(csv.fits("corrected.txt")); // what no language is known by
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum FileForm {
    /// G-code.
    Gcode,
    /// A program in a language that has one form.
    Program(Language),
    /// A table of poses or joint values as text.
    Csv,
    /// A list of poses in YAML.
    Yaml,
    /// A table of poses in Parquet.
    Parquet,
}

impl FileForm {
    /// Form of a program in a language (`None`: G-code), from its name and its bytes.
    ///
    /// ```
    /// use kinetostat_formats::{FileForm, Language};
    ///
    /// assert_eq!(FileForm::of(None, "part.nc", b"G21\n"), FileForm::Gcode);
    /// assert_eq!(FileForm::of(Some(Language::Poses), "list", b"PAR1"), FileForm::Parquet);
    /// ```
    #[must_use]
    pub fn of(language: Option<Language>, name: &str, bytes: &[u8]) -> Self {
        let form = |of: Language| of.form(name, bytes).unwrap_or(Self::Program(of));
        language.map_or(Self::Gcode, form)
    }

    /// Endings of the form's file names, in small letters, the usual ending first.
    fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Gcode => &["ngc", "nc", "gcode", "tap", "cnc", "iso", "prg"],
            Self::Program(language) => language.written_endings(),
            Self::Csv => &["csv", "tsv"],
            Self::Yaml => &["yaml", "yml"],
            Self::Parquet => &["parquet"],
        }
    }

    /// Usual ending of the form's file names.
    ///
    /// ```
    /// use kinetostat_formats::{FileForm, Language};
    ///
    /// assert_eq!(FileForm::Program(Language::Krl).ending(), "src");
    /// ```
    #[must_use]
    pub fn ending(self) -> &'static str {
        self.endings().first().copied().unwrap_or_default()
    }

    /// True if the ending of a name belongs to this form, or to no known language.
    ///
    /// ```
    /// use kinetostat_formats::{FileForm, Language};
    ///
    /// let [rapid, krl] = [Language::Rapid, Language::Krl].map(FileForm::Program);
    /// assert!(rapid.fits("part.MODX") && FileForm::Gcode.fits("part"));
    /// assert!(!FileForm::Gcode.fits("part.src") && !krl.fits("part.dat"));
    /// ```
    #[must_use]
    pub fn fits(self, name: &str) -> bool {
        let ending = ending_of(name);
        let mut languages = Language::ALL.iter();
        let is_known = Self::Gcode.endings().contains(&ending.as_str())
            || languages.any(|language| language.endings().contains(&ending.as_str()));
        self.endings().contains(&ending.as_str()) || !is_known
    }

    /// Name of the form in sentences.
    ///
    /// ```
    /// assert_eq!(kinetostat_formats::FileForm::Parquet.title(), "a table in Parquet");
    /// ```
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Gcode => "G-code",
            Self::Program(language) => language.file_title(),
            Self::Csv => "a table as text",
            Self::Yaml => "a list in YAML",
            Self::Parquet => "a table in Parquet",
        }
    }
}

/// The ending of a name in small letters.
pub(crate) fn ending_of(name: &str) -> String {
    let ending = name.rsplit_once('.');
    ending.map_or_else(String::new, |(_, ending)| ending.to_ascii_lowercase())
}
