//! Common part of both imports of links: remarks, the table of the model file, and the answer.

use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_links::{
    Error, Grade, SYMMETRIC_TO, StiffnessCheck, check_stiffness, in_n_mm, stiffness_table,
};
use kinetostat_machining::number as formatter;
use kinetostat_model::doubts_of_link_matrix;
use nalgebra::Matrix6;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::outputs::{self, Existing, Outputs};
use crate::import::link_arguments::TableArgs;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::layout::{item, listed, wrapped};
use crate::ui::screen::{self, Stream};
use crate::ui::{json, numbers};

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        ErrorCode::FileForm.failure(error)
    }
}

/// The import, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct LinkSummary<'a> {
    schema: u32,
    kinetostat_version: &'static str,
    source: String,
    output: Option<String>,
    name: &'a str,
    /// Rows in N/mm, N/rad, N mm/mm, N mm/rad at the link's end in its axes.
    stiffness_n_mm_rad: [[f64; 6]; 6],
    /// Standard deviations of the same, where the figures are measured.
    deviation_n_mm_rad: Option<[[f64; 6]; 6]>,
    rank: usize,
    antisymmetric_share: f64,
    /// The share that the residuals explain, where the figures are measured.
    explained_share: Option<f64>,
    natural_length_mm: f64,
    zero_modes: Option<usize>,
    notices: &'a [String],
}

/// Remarks on a link besides its matrix.
#[derive(Default)]
pub(crate) struct Remarks {
    pub(crate) rows: Vec<[String; 2]>,
    pub(crate) notices: Vec<String>,
    pub(crate) assumption: Vec<String>,
    pub(crate) deviation: Option<Matrix6<f64>>,
    pub(crate) asymmetry: Option<f64>,
    pub(crate) explained: Option<f64>,
    pub(crate) zero_modes: Option<usize>,
}

impl Remarks {
    pub(crate) fn row(&mut self, what: &str, value: impl Into<String>) {
        self.rows.push([what.to_owned(), value.into()]);
    }
}

/// Checks, writes, reports.
pub(crate) fn finish(
    file: &Path,
    table: &TableArgs,
    inputs: Vec<PathBuf>,
    stiffness: &Matrix6<f64>,
    source: &str,
    mut remarks: Remarks,
) -> Answer<()> {
    let checked = check_stiffness(stiffness, SYMMETRIC_TO);
    refuse_what_is_none(file, &checked)?;
    let doubts = doubts_of_link_matrix(stiffness, None);
    for finding in &checked.findings {
        remarks
            .notices
            .push(format!("{}; {}", finding.message, finding.help));
    }
    for (message, help) in doubts {
        remarks.notices.push(format!("{message}; {help}"));
    }
    let name = match &table.name {
        Some(name) => name.clone(),
        None => file
            .file_stem()
            .map_or_else(|| "link".into(), |s| s.to_string_lossy().into_owned()),
    };
    let assumption = (!remarks.assumption.is_empty()).then(|| remarks.assumption.join("; "));
    let toml = stiffness_table(&name, stiffness, source, assumption.as_deref());
    let existing = Existing::forced(table.force_overwrite);
    let mut outputs = Outputs::new(existing, inputs);
    if let Some(path) = &table.out {
        let index = outputs.claim("table", path)?;
        outputs.fill(index, toml.as_bytes())?;
        outputs.commit()?;
    }
    let share = remarks.asymmetry.unwrap_or(checked.antisymmetric_share);
    let text = answer_text(
        &name,
        &checked,
        stiffness,
        share,
        &remarks,
        table.out.as_deref(),
    );
    if table.json {
        screen::print(Stream::Err, &text)?;
        let rows = |k: &Matrix6<f64>| {
            let k = in_n_mm(k);
            std::array::from_fn(|i| std::array::from_fn(|j| k[(i, j)]))
        };
        let summary = LinkSummary {
            schema: 1,
            kinetostat_version: env!("CARGO_PKG_VERSION"),
            source: source.to_owned(),
            output: table.out.as_ref().map(|p| p.display().to_string()),
            name: &name,
            stiffness_n_mm_rad: rows(stiffness),
            deviation_n_mm_rad: remarks.deviation.as_ref().map(rows),
            rank: checked.rank,
            antisymmetric_share: share,
            explained_share: remarks.explained,
            natural_length_mm: checked.natural_length * 1e3,
            zero_modes: remarks.zero_modes,
            notices: &remarks.notices,
        };
        return screen::print_bytes(json::json(&summary)?.as_bytes());
    }
    if table.out.is_some() {
        return screen::print(Stream::Out, &text);
    }
    // The table itself is the result.
    screen::print(Stream::Err, &text)?;
    screen::print_bytes(toml.as_bytes())
}

fn refuse_what_is_none(file: &Path, checked: &StiffnessCheck) -> Answer<()> {
    let of_grade = |grade| checked.findings.iter().find(|f| f.grade == grade);
    match of_grade(Grade::Refused).or_else(|| of_grade(Grade::Loose)) {
        Some(finding) => Err(ErrorCode::FileForm.failure(format!(
            "{}: this is no stiffness that a link can have: {}; {}",
            file.display(),
            finding.message,
            finding.help
        ))),
        None => Ok(()),
    }
}

fn answer_text(
    name: &str,
    checked: &StiffnessCheck,
    stiffness: &Matrix6<f64>,
    share: f64,
    remarks: &Remarks,
    out: Option<&Path>,
) -> String {
    let mut text = wrapped(&format!("Stiffness of the link '{name}' at its end"), 0);
    let mut rows: Vec<Vec<String>> = remarks.rows.iter().map(|r| r.to_vec()).collect();
    let k = in_n_mm(stiffness);
    let three = |from: usize| {
        (from..from + 3)
            .map(|i| numbers::number(k[(i, i)], 5))
            .collect::<Vec<_>>()
            .join(", ")
    };
    rows.push(vec!["x, y, z".into(), format!("{} N/mm", three(0))]);
    rows.push(vec!["rx, ry, rz".into(), format!("{} N mm/rad", three(3))]);
    rows.push(vec![
        "rank".into(),
        format!(
            "{}; anti-symmetric share {}",
            checked.rank,
            formatter::short(share)
        ),
    ]);
    rows.push(vec![
        "natural length".into(),
        format!("{} mm", numbers::number(checked.natural_length * 1e3, 3)),
    ]);
    text.push_str(&listed(&rows, 2));
    if !remarks.notices.is_empty() {
        text.push_str("\nNotices\n");
        for notice in &remarks.notices {
            text.push_str(&item(notice));
        }
    }
    if let Some(path) = out {
        text.push_str(&outputs::written(&[path.to_owned()]));
    }
    text
}

pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    )
}
