//! The file as it is written, and where its problems are gathered.

use std::ops::Range;

use kinetostat_model::{Problem, Severity};
use serde::Deserialize;
use serde_spanned::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Written {
    pub(super) schema: Spanned<u32>,
    #[serde(default)]
    pub(super) uncertain: Vec<Spanned<Row>>,
    #[serde(default)]
    pub(super) correlation: Vec<Spanned<Pair>>,
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
