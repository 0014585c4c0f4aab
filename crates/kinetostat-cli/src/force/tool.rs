//! The tool of a cut: by its sizes, or from a table of tools.

use std::path::PathBuf;

use kinetostat_cutting::{RunOut, Shape, Tool, ToolTable};
use kinetostat_diagnostic::ErrorCode;

use crate::files::input_files::InputFiles;
use crate::force::arguments::{ShapeWord, ToolArgs};
use crate::force::refusal::{refused, within};
use crate::ui::failure::{Answer, Failing};

/// A tool with what is known beside its edges.
#[derive(Clone, Debug)]
pub(crate) struct CutTool {
    pub(crate) tool: Tool,
    /// Number and name in the table.
    pub(crate) number: Option<u32>,
    pub(crate) name: String,
    pub(crate) rake_deg: Option<f64>,
    pub(crate) max_chip_mm: Option<f64>,
    pub(crate) flute_length_mm: Option<f64>,
    pub(crate) stick_out_mm: Option<f64>,
    /// The table, which no output may overwrite.
    pub(crate) table: Option<PathBuf>,
}

pub(crate) fn tool_of(files: &InputFiles, args: &ToolArgs) -> Answer<CutTool> {
    match &args.tool_table {
        Some(path) => from_table(files, path, args.tool_number),
        None => by_sizes(args),
    }
}

pub(crate) fn tool_table(files: &InputFiles, path: &std::path::Path) -> Answer<ToolTable> {
    let text = files.settings("table of tools", path)?;
    let table = ToolTable::read(&path.display().to_string(), &text);
    table.map_err(|error| refused(&error))
}

fn from_table(
    files: &InputFiles,
    path: &std::path::Path,
    number: Option<usize>,
) -> Answer<CutTool> {
    let table = tool_table(files, path)?;
    let numbers = || -> Vec<String> { table.entries().map(|e| e.number.to_string()).collect() };
    if number.is_none() {
        return Err(ErrorCode::Missing.failure(format!(
            "--tool-table needs --tool-number T: which of the tools of '{}' cuts? It has {}",
            path.display(),
            numbers().join(", ")
        )));
    }
    let number = number.and_then(|number| u32::try_from(number).ok());
    let entry = number.and_then(|number| table.entries().find(|e| e.number == number));
    let entry = entry.ok_or_else(|| {
        let known = match numbers() {
            none if none.is_empty() => "it has no tools".to_owned(),
            some => format!("it has {}", some.join(", ")),
        };
        ErrorCode::UnknownName.failure(format!(
            "--tool-number: that tool is not in the table of tools '{}'; {known}",
            path.display()
        ))
    })?;
    Ok(CutTool {
        tool: entry.tool,
        number: Some(entry.number),
        name: entry.name.clone(),
        rake_deg: entry.rake_deg,
        max_chip_mm: entry.max_chip_mm,
        flute_length_mm: entry.flute_length_mm,
        stick_out_mm: entry.stick_out_mm,
        table: Some(path.to_owned()),
    })
}

fn by_sizes(args: &ToolArgs) -> Answer<CutTool> {
    let Some(word) = args.tool else {
        return Err(ErrorCode::Missing.failure("which tool? Give --tool flat, ball, bull or face with --diameter-mm and --teeth, or --tool-table FILE.toml with --tool-number",
        ));
    };
    let (Some(diameter_mm), Some(teeth)) = (args.diameter_mm, args.teeth) else {
        let missing = match args.diameter_mm {
            None => "--diameter-mm D, in mm",
            Some(_) => "--teeth N",
        };
        return Err(ErrorCode::Missing.failure(format!("the tool needs {missing}")));
    };
    let tool = Tool::new(shape(word, args)?, diameter_mm, teeth)
        .and_then(|tool| tool.with_helix(args.helix_deg.unwrap_or(0.0).to_radians()))
        .map_err(|error| refused(&error))?;
    let angle = args.run_out_angle_deg.unwrap_or(0.0);
    within("angle of the run-out", angle, -360.0..=360.0, "deg")?;
    let run_out_um = args.run_out_um.unwrap_or(0.0);
    let most_um = 1e3 * 0.1 * diameter_mm;
    within("run-out", run_out_um, 0.0..=most_um, "um")?;
    let run_out = RunOut {
        offset_mm: 1e-3 * run_out_um,
        angle: angle.to_radians(),
    };
    let tool = tool
        .with_run_out(run_out)
        .map_err(|error| refused(&error))?;
    let given =
        |quantity: &str, value: Option<f64>, least: f64, most: f64| -> Answer<Option<f64>> {
            value
                .map(|value| within(quantity, value, least..=most, "mm"))
                .transpose()
        };
    let stick_out_mm = given("stick-out", args.stick_out_mm, 0.1, 2000.0)?;
    let longest = stick_out_mm.unwrap_or(2000.0);
    Ok(CutTool {
        tool,
        number: None,
        name: String::new(),
        rake_deg: None,
        max_chip_mm: given("feed per tooth allowed", args.max_chip_mm, 1e-4, 10.0)?,
        flute_length_mm: given("length of the edges", args.flute_length_mm, 0.01, longest)?,
        stick_out_mm,
        table: None,
    })
}

/// The envelope; a size of another shape is refused.
fn shape(word: ShapeWord, args: &ToolArgs) -> Answer<Shape> {
    let only = |option: &str, given: Option<f64>, of: ShapeWord, name: &str| -> Answer<f64> {
        match (given, word == of) {
            (Some(value), true) => Ok(value),
            (None, false) => Ok(0.0),
            (None, true) => {
                Err(ErrorCode::Missing.failure(format!("--tool {name} needs {option}")))
            }
            (Some(_), false) => Err(ErrorCode::Unused.failure(format!(
                "{option} belongs to --tool {name} alone; leave it out, or change the shape"
            ))),
        }
    };
    let corner = only(
        "--corner-radius-mm",
        args.corner_radius_mm,
        ShapeWord::Bull,
        "bull",
    )?;
    let lead = only(
        "--lead-angle-deg",
        args.lead_angle_deg,
        ShapeWord::Face,
        "face",
    )?;
    Ok(match word {
        ShapeWord::Flat => Shape::Flat,
        ShapeWord::Ball => Shape::Ball,
        ShapeWord::Bull => Shape::Bull {
            corner_radius_mm: corner,
        },
        ShapeWord::Face => Shape::Face {
            lead_angle: lead.to_radians(),
        },
    })
}
