//! What a file of a program holds, and by which endings it is known.

use crate::language::endings_of;
use crate::model::language::Language;

/// What a file of a program holds, as the ending of its name says it.
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
    /// ABB RAPID.
    Rapid,
    /// KUKA KRL.
    Krl,
    /// A FANUC TP program as text.
    FanucLs,
    /// APT.
    Apt,
    /// SINUMERIK.
    Siemens,
    /// Heidenhain conversational.
    Heidenhain,
    /// A table of poses or joint values as text.
    Csv,
    /// A list of poses in YAML.
    Yaml,
    /// A table of poses in Parquet.
    Parquet,
}

const ALL: [FileForm; 10] = [
    FileForm::Gcode,
    FileForm::Rapid,
    FileForm::Krl,
    FileForm::FanucLs,
    FileForm::Apt,
    FileForm::Siemens,
    FileForm::Heidenhain,
    FileForm::Csv,
    FileForm::Yaml,
    FileForm::Parquet,
];

impl FileForm {
    /// That of a program in a language (`None`: G-code), of which the name and the bytes are known.
    ///
    /// ```
    /// use kinetostat_formats::{FileForm, Language};
    ///
    /// assert_eq!(FileForm::of(None, "part.nc", b"G21\n"), FileForm::Gcode);
    /// assert_eq!(FileForm::of(Some(Language::Poses), "list", b"PAR1"), FileForm::Parquet);
    /// ```
    #[must_use]
    pub fn of(language: Option<Language>, name: &str, bytes: &[u8]) -> Self {
        match language {
            None => Self::Gcode,
            Some(Language::Rapid) => Self::Rapid,
            Some(Language::Krl) => Self::Krl,
            Some(Language::FanucLs) => Self::FanucLs,
            Some(Language::Apt) => Self::Apt,
            Some(Language::Siemens) => Self::Siemens,
            Some(Language::Heidenhain) => Self::Heidenhain,
            Some(Language::Poses) if bytes.starts_with(b"PAR1") => Self::Parquet,
            Some(Language::Poses) => match ["yaml", "yml"].contains(&ending_of(name).as_str()) {
                true => Self::Yaml,
                false => Self::Csv,
            },
        }
    }

    /// How the names of its files end, in small letters, the usual ending first.
    fn endings(self) -> &'static [&'static str] {
        match self {
            Self::Gcode => &["ngc", "nc", "gcode", "tap", "cnc", "iso", "prg"],
            Self::Rapid => endings_of(Language::Rapid),
            Self::Krl => &["src", "sub"],
            Self::FanucLs => endings_of(Language::FanucLs),
            Self::Apt => endings_of(Language::Apt),
            // Its programs are known by what stands in them where they have the endings of G-code.
            Self::Siemens => &["mpf", "spf", "ngc", "nc", "tap", "cnc", "iso"],
            Self::Heidenhain => endings_of(Language::Heidenhain),
            Self::Csv => &["csv", "tsv"],
            Self::Yaml => &["yaml", "yml"],
            Self::Parquet => &["parquet"],
        }
    }

    /// How the names of its files usually end.
    ///
    /// ```
    /// assert_eq!(kinetostat_formats::FileForm::Krl.ending(), "src");
    /// ```
    #[must_use]
    pub fn ending(self) -> &'static str {
        self.endings().first().copied().unwrap_or_default()
    }

    /// Whether the ending of a name is one of this form, or none that a language is known by.
    ///
    /// ```
    /// use kinetostat_formats::FileForm;
    ///
    /// assert!(FileForm::Rapid.fits("part.MODX") && FileForm::Gcode.fits("part"));
    /// assert!(!FileForm::Gcode.fits("part.src") && !FileForm::Krl.fits("part.dat"));
    /// ```
    #[must_use]
    pub fn fits(self, name: &str) -> bool {
        let ending = ending_of(name);
        let is_known = |ending: &str| {
            let own = ALL.iter().any(|form| form.endings().contains(&ending));
            own || endings_of(Language::Krl).contains(&ending)
        };
        self.endings().contains(&ending.as_str()) || !is_known(&ending)
    }

    /// Its name in sentences.
    ///
    /// ```
    /// assert_eq!(kinetostat_formats::FileForm::Parquet.title(), "a table in Parquet");
    /// ```
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Gcode => "G-code",
            Self::Rapid => "RAPID",
            Self::Krl => "KRL",
            Self::FanucLs => "a TP program of FANUC",
            Self::Apt => "APT",
            Self::Siemens => "a SINUMERIK program",
            Self::Heidenhain => "a Heidenhain program",
            Self::Csv => "a table as text",
            Self::Yaml => "a list in YAML",
            Self::Parquet => "a table in Parquet",
        }
    }
}

/// The ending of a name in small letters.
fn ending_of(name: &str) -> String {
    let ending = name.rsplit_once('.');
    ending.map_or_else(String::new, |(_, ending)| ending.to_ascii_lowercase())
}
