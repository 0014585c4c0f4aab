//! The languages that programs are made in, and what each of them takes.

use crate::file_form::FileForm;
use crate::making::template::Template;
use crate::model::Language;

/// A language that a program is made in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum MakeLanguage {
    /// KUKA KRL.
    Krl,
    /// ABB RAPID.
    Rapid,
    /// FANUC TP programs as text.
    FanucLs,
    /// APT.
    Apt,
    /// G-code of three axes.
    Gcode,
    /// A table of poses (CSV).
    Csv,
}

/// Arcs that a language supports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Arcs {
    None,
    /// Flat, through a place.
    Through,
    /// Arcs or helices about the z axis.
    AboutZ,
}

/// Limits of a language.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Limits {
    pub arcs: Arcs,
    /// Minimum chord length of an arc, mm.
    pub least_chord_mm: f64,
    /// Minimum sweep of an arc, rad.
    pub least_sweep_rad: f64,
    /// The language states the tool orientation.
    pub orientation: bool,
    /// Limit of the characters of the program's name.
    pub name: usize,
    /// Default and maximum of the positions in a file; `None` if a program is one file.
    pub points: Option<(usize, usize)>,
    /// Default limit of the decimals of a speed.
    pub speed_decimals: usize,
}

/// RAPID reference manual, `MoveC`: start, circle point and end at least 0.1 mm apart, circle point and end at least 1 degree
/// apart as seen from the start, which is a quarter of the sweep where the circle point lies in the middle.
const RAPID_CHORD_MM: f64 = 0.1;
const RAPID_SWEEP_RAD: f64 = 4.0 * std::f64::consts::PI / 180.0;

/// Numbers of positions in a TP program have 16 bits: InstitutMaupertuis, fanuc_post_processor, issue 43.
const LS_MOST_POINTS: usize = 32_766;

impl MakeLanguage {
    /// Each of them once.
    pub const ALL: [Self; 6] = [
        Self::Krl,
        Self::Rapid,
        Self::FanucLs,
        Self::Apt,
        Self::Gcode,
        Self::Csv,
    ];

    /// True for the languages of robot controllers.
    pub(crate) fn is_of_an_arm(self) -> bool {
        matches!(self, Self::Krl | Self::Rapid | Self::FanucLs)
    }

    pub(crate) fn limits(self) -> Limits {
        let robot = Limits {
            arcs: Arcs::Through,
            least_chord_mm: 1e-3,
            least_sweep_rad: 0.0,
            orientation: true,
            name: 24,
            points: Some((10_000, 1_000_000)),
            speed_decimals: 9,
        };
        match self {
            Self::Krl => robot,
            Self::Rapid => Limits {
                least_chord_mm: RAPID_CHORD_MM,
                least_sweep_rad: RAPID_SWEEP_RAD,
                name: 32,
                ..robot
            },
            Self::FanucLs => Limits {
                name: 32,
                points: Some((5_000, LS_MOST_POINTS)),
                // Teach pendants take tenths of mm/s.
                speed_decimals: 1,
                ..robot
            },
            Self::Apt => Limits {
                arcs: Arcs::None,
                name: 64,
                points: None,
                ..robot
            },
            Self::Csv => Limits {
                arcs: Arcs::None,
                name: 64,
                points: None,
                ..robot
            },
            Self::Gcode => Limits {
                arcs: Arcs::AboutZ,
                orientation: false,
                name: 64,
                points: None,
                ..robot
            },
        }
    }

    /// Limits of a program that is made in the language, in words.
    ///
    /// ```
    /// use kinetostat_formats::MakeLanguage;
    ///
    /// let limits = MakeLanguage::FanucLs.limits_in_words();
    /// assert!(limits.contains("5000 places a file") && limits.contains("at most 1 decimal"));
    /// assert!(MakeLanguage::Krl.limits_in_words().contains("24 characters"));
    /// ```
    #[must_use]
    pub fn limits_in_words(self) -> String {
        let limits = self.limits();
        let mut all = vec![format!("its name has at most {} characters", limits.name)];
        all.push(match limits.points {
            Some((usual, most)) => format!(
                "at most {usual} places a file (most_points in the template, up to {most}), beyond that a main program and numbered parts"
            ),
            None => "one file, however many places".to_owned(),
        });
        let defaults = Template::default();
        all.push(format!(
            "places with {} decimals of mm unless the template says otherwise",
            defaults.position_decimals
        ));
        all.push(match limits.speed_decimals {
            1 => "speeds with at most 1 decimal unless the template says otherwise".to_owned(),
            more => format!("speeds with at most {more} decimals"),
        });
        let chord = limits.least_chord_mm;
        all.push(match limits.arcs {
            Arcs::None => "arcs become lines".to_owned(),
            Arcs::AboutZ => "arcs about z, rising where asked; others become lines".to_owned(),
            Arcs::Through if limits.least_sweep_rad > 0.0 => format!(
                "flat arcs through places at least {chord} mm apart, of at least {:.0} deg; others become lines",
                limits.least_sweep_rad.to_degrees()
            ),
            Arcs::Through => format!(
                "flat arcs through places at least {chord} mm apart; others become lines"
            ),
        });
        all.join("; ")
    }

    /// File ending of the language.
    ///
    /// ```
    /// assert_eq!(kinetostat_formats::MakeLanguage::Krl.ending(), "src");
    /// ```
    #[must_use]
    pub fn ending(self) -> &'static str {
        self.form().ending()
    }

    /// Form of the language's files.
    ///
    /// ```
    /// use kinetostat_formats::{FileForm, MakeLanguage};
    ///
    /// assert_eq!(MakeLanguage::Csv.form(), FileForm::Csv);
    /// ```
    #[must_use]
    pub fn form(self) -> FileForm {
        FileForm::of(self.language(), "", b"")
    }

    /// The language that reads it; `None` for G-code.
    ///
    /// ```
    /// use kinetostat_formats::{Language, MakeLanguage};
    ///
    /// assert_eq!(MakeLanguage::Krl.language(), Some(Language::Krl));
    /// assert_eq!(MakeLanguage::Gcode.language(), None);
    /// ```
    #[must_use]
    pub const fn language(self) -> Option<Language> {
        match self {
            Self::Krl => Some(Language::Krl),
            Self::Rapid => Some(Language::Rapid),
            Self::FanucLs => Some(Language::FanucLs),
            Self::Apt => Some(Language::Apt),
            Self::Csv => Some(Language::Poses),
            Self::Gcode => None,
        }
    }

    /// The one that a language is made in (`None`: G-code), if programs are made in it.
    ///
    /// ```
    /// use kinetostat_formats::{Language, MakeLanguage};
    ///
    /// assert_eq!(MakeLanguage::of(Some(Language::Poses)), Some(MakeLanguage::Csv));
    /// assert_eq!(MakeLanguage::of(Some(Language::Siemens)), None);
    /// ```
    #[must_use]
    pub fn of(language: Option<Language>) -> Option<Self> {
        let mut all = Self::ALL.into_iter();
        all.find(|made| made.language() == language)
    }

    /// Name of the language in sentences.
    ///
    /// ```
    /// assert_eq!(kinetostat_formats::MakeLanguage::FanucLs.title(), "a TP program");
    /// ```
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Krl => "KRL",
            Self::Rapid => "RAPID",
            Self::FanucLs => "a TP program",
            Self::Apt => "APT",
            Self::Gcode => "G-code",
            Self::Csv => "a table of poses",
        }
    }
}
