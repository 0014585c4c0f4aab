//! The file as it is written, words for uncertain loads, and where its problems are gathered.

use std::ops::Range;

use kinetostat::Wrench;
use kinetostat_model::{Problem, Severity};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_spanned::Spanned;

/// Tables of uncertainties, alone or among those of a model file.
#[derive(Deserialize)]
pub(super) struct Written {
    pub(super) schema: Spanned<u32>,
    #[serde(default)]
    pub(super) uncertain: Vec<Spanned<Row>>,
    #[serde(default)]
    pub(super) correlation: Vec<Spanned<Pair>>,
    /// Only a model file has it.
    pub(super) mechanism: Option<IgnoredAny>,
}

/// Everything that a file of uncertainties alone may say.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Alone {
    #[serde(rename = "schema")]
    _schema: IgnoredAny,
    #[serde(rename = "uncertain")]
    _uncertain: Option<IgnoredAny>,
    #[serde(rename = "correlation")]
    _correlation: Option<IgnoredAny>,
}

impl Written {
    pub(super) fn read(text: &str) -> Result<Self, toml::de::Error> {
        let written: Self = toml::from_str(text)?;
        if written.mechanism.is_none() {
            toml::from_str::<Alone>(text)?;
        }
        Ok(written)
    }
}

#[derive(Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Row {
    pub(super) parameter: Option<Spanned<String>>,
    pub(super) load: Option<Spanned<String>>,
    /// True if every limb that shares the number scatters by itself.
    pub(super) each: Option<Spanned<bool>>,
    pub(super) normal: Option<Spanned<f64>>,
    pub(super) normal_percent: Option<Spanned<f64>>,
    pub(super) uniform: Option<Spanned<f64>>,
    pub(super) uniform_percent: Option<Spanned<f64>>,
    pub(super) triangular: Option<Spanned<f64>>,
    pub(super) triangular_percent: Option<Spanned<f64>>,
    #[serde(default, rename = "source")]
    pub(super) _source: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Pair {
    pub(super) between: Spanned<[String; 2]>,
    pub(super) coefficient: Spanned<f64>,
}

/// The text with its name: where problems are gathered.
pub(super) struct Reader<'a> {
    pub(super) text: &'a str,
    pub(super) file: &'a str,
    pub(super) problems: Vec<Problem>,
}

impl Reader<'_> {
    pub(super) fn refuse(
        &mut self,
        span: Range<usize>,
        message: impl Into<String>,
        help: impl Into<String>,
    ) {
        let words = [message.into(), help.into()];
        let problem = Problem::found(Severity::Error, self.file, self.text, span, "", words);
        self.problems.push(problem);
    }
}

/// Names of the load's components, and of its factor.
const LOADS: [&str; 7] = [
    "force_n.x",
    "force_n.y",
    "force_n.z",
    "moment_n_m.x",
    "moment_n_m.y",
    "moment_n_m.z",
    "factor",
];

/// Words for a load along a program.
const LOADS_OF_PROGRAM: [&str; 4] = [
    "factor",
    CUTTING_PARTS[0],
    CUTTING_PARTS[1],
    CUTTING_PARTS[2],
];

/// The load that a file's numbers may be of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Load<'a> {
    /// One wrench on the tool: its components, or a factor.
    Stated(&'a Wrench),
    /// Load of a program, another at every place: factors on all of it, or on parts.
    AlongProgram,
}

impl Load<'_> {
    /// Words for it.
    pub(super) fn words(self) -> &'static [&'static str] {
        match self {
            Self::Stated(_) => &LOADS,
            Self::AlongProgram => &LOADS_OF_PROGRAM,
        }
    }

    /// Value as drawn, unit, and what it is of.
    pub(super) fn part(self, at: usize) -> (f64, &'static str, Source) {
        match self {
            Self::Stated(load) if at < 6 => {
                let unit = if at < 3 { "N" } else { "N m" };
                (load.0[at], unit, Source::Load(at))
            }
            Self::AlongProgram if at > 0 => (1.0, "", Source::CuttingPart(at - 1)),
            _ => (1.0, "", Source::LoadFactor),
        }
    }
}

/// Source of an uncertain number.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A number of the model file, by its path.
    Parameter(String),
    /// A component of the load on the tool: force (N), then moment (N m).
    Load(usize),
    /// A factor on the whole load, 1 in the drawing: how far all cutting coefficients may be off together.
    LoadFactor,
    /// A factor on one part of the force of the cut, 1 in the drawing, as an index into [`CUTTING_PARTS`]: how far its coefficients
    /// may be off.
    CuttingPart(usize),
}

impl Source {
    /// Values of the numbers that belong to the model file.
    pub(crate) fn of_model(sources: &[Self], values: &[f64]) -> Vec<f64> {
        let each = sources.iter().zip(values);
        let own = each.filter(|(source, _)| matches!(source, Self::Parameter(_)));
        own.map(|(_, value)| *value).collect()
    }
}

/// Parts of the force of the cut, each with coefficients of its own: against the way of a tooth, against its normal, along its edge; of a
/// stated milling force along the feed, across it, along the tool.
pub const CUTTING_PARTS: [&str; 3] = ["tangential", "radial", "axial"];
