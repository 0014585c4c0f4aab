//! `kinetostat check --pose`: the model against poses that were measured on the machine.
//!
//! It takes a model and a file of poses (CSV or TOML) and gives the differences, and the sign, offset, coupling or
//! frame that explains them.

mod comparison;
mod csv_file;
mod pose_row;
mod tables;

use std::collections::BTreeMap;
use std::path::Path;

use kinetostat_analysis::measured_poses::{MeasuredPose, Tolerance};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_model::Model;
use kinetostat_model::schema::Placement;
use serde::Deserialize;
use serde_spanned::Spanned;

pub(crate) use crate::check::poses::comparison::PoseComparison;
use crate::check::poses::comparison::{axes, compare};
use crate::check::poses::csv_file::from_csv;
use crate::check::poses::pose_row::{MOST, PoseRow};
use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::job::source::Source;
use crate::place::joints::Named;
use crate::ui::failure::{Answer, Failing};
use crate::ui::json;
use crate::ui::layout::{columns, item, wrapped};
use crate::ui::numbers::{fixed, short, triple};

/// The model and where it came from, for one file of poses.
pub(crate) fn run(
    model: &Model,
    source: &str,
    file: &Path,
    tolerance_mm: f64,
    json: bool,
) -> Answer<()> {
    if !(tolerance_mm > 0.0 && tolerance_mm <= 1e4) {
        return Err(ErrorCode::Value.failure(format!(
            "--pose-tolerance-mm is {tolerance_mm}; a length from above 0 to 10000 mm is needed"
        )));
    }
    let names = axes(model);
    let rows = read(&InputFiles::default(), file, &names)?;
    let tolerance = Tolerance {
        distance: 1e-3 * tolerance_mm,
        angle: (0.1 * tolerance_mm).to_radians(),
    };
    let answer = compare(model, source, file, &names, &rows, tolerance, tolerance_mm)?;
    let text = answer_text(&answer);
    json::print_answer(&text, &answer, json)
}

pub(crate) fn read(files: &InputFiles, path: &Path, names: &[Named]) -> Answer<Vec<PoseRow>> {
    let bytes = files.bytes("file of poses", path)?;
    let name = path.display().to_string();
    let text = String::from_utf8(bytes).map_err(|_| {
        ErrorCode::FileNotRead.failure(format!("{name}: not UTF-8 text; save it as UTF-8"))
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let toml = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let rows = match toml {
        true => from_toml(&name, text, names)?,
        false => from_csv(&with_decimal_points(text), names).map_err(|f| f.within(&name))?,
    };
    if rows.is_empty() {
        return Err(ErrorCode::FileForm.failure(format!(
            "{name}: there is no pose in it; write one row for each"
        )));
    }
    if rows.len() > MOST {
        return Err(ErrorCode::FileForm.failure(format!(
            "{name}: {} poses, at most {MOST} are read",
            rows.len()
        )));
    }
    Ok(rows)
}

/// Explanations shown where several fit.
const SHOWN: usize = 6;

fn answer_text(a: &PoseComparison) -> String {
    let mut out = wrapped(
        &format!(
            "{} ({}) against {} ({} {}), joint values {}",
            a.model,
            a.model_source,
            a.poses_file,
            a.poses.len(),
            if a.poses.len() == 1 { "pose" } else { "poses" },
            a.joints_are
        ),
        0,
    );
    out.push('\n');
    out.push_str(&table(a));
    out.push('\n');
    out.push_str(&result_text(a));
    out
}

fn table(a: &PoseComparison) -> String {
    let mut rows = vec![
        [
            "pose",
            "measured at, mm",
            "computed at, mm",
            "apart, mm",
            "deg",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    for p in &a.poses {
        rows.push(vec![
            p.name.clone(),
            triple(p.measured_position_mm, |x| fixed(x, 2)),
            triple(p.computed_position_mm, |x| fixed(x, 2)),
            fixed(p.difference_mm, 3),
            p.difference_deg
                .map_or_else(|| "-".to_owned(), |x| fixed(x, 3)),
        ]);
    }
    columns(&rows, 2)
}

/// States whether the model agrees, and the explanation if not.
fn result_text(a: &PoseComparison) -> String {
    let within = format!(
        "{} mm and {} deg",
        short(a.tolerance_mm),
        short(a.tolerance_deg)
    );
    if a.agrees {
        return wrapped(
            &format!("The model agrees with all of them within {within}."),
            0,
        );
    }
    let mut out = explanations_text(a, &within);
    if let Some(reason) = &a.tables_missing {
        out.push_str(&wrapped(
            &format!("It is not written as tables of the model file: {reason}."),
            0,
        ));
    }
    if let Some(tables) = &a.tables {
        out.extend(tables.undecided.iter().map(|text| item(text)));
        out.push_str(match a.ambiguous {
            true => "\nTables for the model file, for the first of them:\n\n",
            false => "\nTables for the model file:\n\n",
        });
        out.push_str(&tables.toml);
    }
    out
}

/// The explanations, or the nearest one.
fn explanations_text(a: &PoseComparison, within: &str) -> String {
    let mut out = String::new();
    match a.explanations.as_slice() {
        [] => {
            out.push_str(&wrapped(
                &format!(
                    "The model does not agree, and no reversed sign, quarter turn, single offset, coupling or frame explains the differences within {within}."
                ),
                0,
            ));
            if let Some(n) = &a.nearest {
                out.push_str(&item(&format!(
                    "nearest: {}; then up to {} mm{} are left",
                    n.in_words,
                    short(n.difference_mm),
                    n.difference_deg
                        .map_or_else(String::new, |d| format!(" and {} deg", short(d)))
                )));
            }
            out.push_str(&wrapped(
                "Lengths of the links may differ; compare a data sheet's figures with the model's.",
                0,
            ));
        }
        [only] => {
            out.push_str(&wrapped(
                &format!(
                    "The differences are systematic. This explains all of them within {within}:"
                ),
                0,
            ));
            out.push_str(&item(only));
            if a.poses.len() < 3 {
                out.push_str(&wrapped(
                    "That is few poses: jog a third one, with every joint elsewhere, to be sure.",
                    0,
                ));
            }
        }
        several => {
            out.push_str(&wrapped(
                &format!(
                    "The differences are systematic, but these poses do not decide: {} explanations are equally simple and explain all within {within}:",
                    several.len()
                ),
                0,
            ));
            for text in several.iter().take(SHOWN) {
                out.push_str(&item(text));
            }
            if several.len() > SHOWN {
                out.push_str(&item(&format!("and {} more", several.len() - SHOWN)));
            }
            out.push_str(&wrapped(
                "Jog one more pose with every joint away from zero and from the other poses. Some always look alike: an offset of the first joint and a turned base, an offset of the last one and a turned tool.",
                0,
            ));
        }
    }
    out
}

/// The file in TOML.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    schema: u32,
    pose: Vec<Spanned<Entry>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: Option<String>,
    joints: BTreeMap<String, f64>,
    tool: Placement,
}

fn from_toml(file: &str, text: &str, names: &[Named]) -> Answer<Vec<PoseRow>> {
    let source = Source { file, text };
    let document: Document = source.read_as(
        "write schema = 1 and, for each pose, [[pose]] with joints = { ... } and tool = { position_mm = [...], ... }",
    )?;
    if document.schema != 1 {
        return Err(ErrorCode::FileForm.failure(format!(
            "{file}: this is version {} of the format; version 1 is read here",
            document.schema
        )));
    }
    let mut rows = Vec::new();
    for (number, entry) in document.pose.iter().enumerate() {
        let refuse = |message: &str, help: &str| source.error(entry.span(), message, help);
        let written = entry.get_ref();
        let mut joints = vec![0.0; names.len()];
        for (i, (name, _, size)) in names.iter().enumerate() {
            let value = written.joints.get(name).ok_or_else(|| {
                refuse(
                    &format!("the joint '{name}' is missing in this pose"),
                    "write all joints of every pose",
                )
            })?;
            joints[i] = value * size;
        }
        if let Some(other) = written
            .joints
            .keys()
            .find(|k| names.iter().all(|n| n.0 != **k))
        {
            let known: Vec<&str> = names.iter().map(|n| n.0.as_str()).collect();
            return Err(refuse(
                &format!("there is no joint '{other}'"),
                &format!("there are {}", known.join(", ")),
            ));
        }
        let tool = &written.tool;
        let placed = tool.position_mm.is_some()
            || tool.position_m.is_some()
            || tool.translation_mm.is_some()
            || tool.translation_m.is_some();
        if !placed {
            return Err(refuse(
                "the measured place of the tool is missing",
                "write tool = { position_mm = [x, y, z] }",
            ));
        }
        let pose = tool
            .pose()
            .map_err(|(message, help)| refuse(&message, &help))?;
        let bare = Placement {
            position_mm: None,
            position_m: None,
            translation_mm: None,
            translation_m: None,
            ..tool.clone()
        };
        rows.push(PoseRow {
            name: written
                .name
                .clone()
                .unwrap_or_else(|| (number + 1).to_string()),
            line: 1 + text[..entry.span().start].matches('\n').count(),
            measured: MeasuredPose {
                joints,
                position: pose.translation.vector,
                rotation: (bare != Placement::default()).then_some(pose.rotation),
            },
        });
    }
    Ok(rows)
}
