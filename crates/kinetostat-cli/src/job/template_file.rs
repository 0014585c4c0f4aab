//! A template file read, options over it.

use std::path::{Path, PathBuf};

use kinetostat_formats::{
    PlacesUnknown, Rapids, SpindleStatements, StatedFrame, StatedTool, Template, Zones,
};
use kinetostat_model::schema::Placement as PoseTable;
use nalgebra::{Isometry3, Vector3};
use serde::Deserialize;
use serde_spanned::Spanned;

use crate::files::file_names::stem;
use crate::files::input_files::InputFiles;
use crate::job::job_file::JobFile;
use crate::job::source::Source;
use crate::place::orientation;
use crate::ui::failure::Answer;

/// A template with the name of its file.
pub(crate) struct TemplateFile {
    pub(crate) template: Template,
    /// Absent without a file.
    pub(crate) name: Option<String>,
}

/// Default remedy for a fault in a template.
const HELP: &str = "correct this value; `kinetostat help convert` shows a whole template";

/// Options of a template.
pub(crate) struct TemplateAsked<'a> {
    pub(crate) file: Option<&'a Path>,
    pub(crate) out: &'a Path,
    pub(crate) tool_orientation: Option<&'a str>,
    pub(crate) tolerance_mm: Option<f64>,
}

impl TemplateFile {
    /// Reads the options and the file that they name.
    pub(crate) fn read(files: &InputFiles, args: &TemplateAsked<'_>) -> Answer<Self> {
        let mut file = match args.file {
            Some(path) => Self::of_file(files, path)?,
            None => Self {
                template: Template::default(),
                name: None,
            },
        };
        let template = &mut file.template;
        if file.name.is_none() || template.program_name.is_empty() {
            template.program_name = stem(args.out);
        }
        if let Some(text) = args.tool_orientation {
            template.tool_orientation = Some(orientation::option("--tool-orientation", text)?);
        }
        template.tolerance_mm = args.tolerance_mm.unwrap_or(template.tolerance_mm);
        Ok(file)
    }

    /// The template that an option names, or `[robot]` of the job.
    pub(crate) fn path(job: Option<&JobFile>, named: Option<&Path>) -> Option<PathBuf> {
        let in_job = || {
            let j = job?;
            let written = j.job.robot.as_ref()?.get_ref().template.as_ref()?;
            Some(j.base().join(written.get_ref()))
        };
        named.map(Path::to_owned).or_else(in_job)
    }

    /// The name of the program that the template states, where it states one.
    pub(crate) fn program_name(files: &InputFiles, path: Option<&Path>) -> Answer<Option<String>> {
        let file = path.map(|path| Self::of_file(files, path)).transpose()?;
        let name = file.map(|file| file.template.program_name);
        Ok(name.filter(|name| !name.is_empty()))
    }

    pub(crate) fn of_file(files: &InputFiles, path: &Path) -> Answer<Self> {
        let text = files.settings("template", path)?;
        let name = path.display().to_string();
        let source = Source {
            file: &name,
            text: &text,
        };
        let table: TemplateTable = source.read_as(HELP)?;
        if *table.schema.get_ref() != 1 {
            return Err(source.error(
                table.schema.span(),
                &format!("schema {} is not known", table.schema.get_ref()),
                "write  schema = 1",
            ));
        }
        if let Some((span, message)) = kinetostat_model::odd_angles(&text).into_iter().next() {
            return Err(source.error(span, &message, "correct the value, or the unit in its name"));
        }
        Ok(Self {
            template: template(source, table)?,
            name: Some(name),
        })
    }
}

fn template(source: Source<'_>, table: TemplateTable) -> Answer<Template> {
    let mut template = Template::default();
    // The default name is that of the output.
    template.program_name = table.program_name.unwrap_or_default();
    if let Some(written) = &table.tool_orientation {
        let turn = pose(source, written)?;
        if turn.translation.vector.norm() > 0.0 {
            return Err(source.error(
                written.span(),
                "this is an orientation, but a position is given in it",
                "write the tool's tip as pose under [tool]",
            ));
        }
        template.tool_orientation = Some(turn.rotation);
    }
    if table.rapids == Some(RapidsWord::Joint) {
        template.rapids = Rapids::Joint;
    }
    if table.places_unknown == Some(PlacesWord::LeftOut) {
        template.places_unknown = PlacesUnknown::LeftOut;
    }
    let set = |to: &mut f64, value: Option<f64>| *to = value.unwrap_or(*to);
    set(
        &mut template.rapid_speed_mm_per_s,
        table.rapid_speed_mm_per_s,
    );
    set(&mut template.joint_speed_percent, table.joint_speed_percent);
    set(&mut template.tolerance_mm, table.tolerance_mm);
    template.unstated_feed_mm_per_s = table.unstated_feed_mm_per_s;
    template.acceleration_m_per_s2 = table.acceleration_m_per_s2;
    template.configuration = table.configuration;
    template.start_joints_deg = table.start_joints_deg;
    template.most_points = table.most_points;
    template.speed_decimals = table.speed_decimals;
    let count = |to: &mut usize, value: Option<usize>| *to = value.unwrap_or(*to);
    count(&mut template.position_decimals, table.position_decimals);
    count(&mut template.angle_decimals, table.angle_decimals);
    count(&mut template.quaternion_decimals, table.quaternion_decimals);
    let usual = Zones::default();
    template.zones = Zones {
        rapids_mm: table.zones.rapids_mm.unwrap_or(usual.rapids_mm),
        feeds_mm: table.zones.feeds_mm.unwrap_or(usual.feeds_mm),
        rapids_percent: table.zones.rapids_percent.unwrap_or(usual.rapids_percent),
        feeds_percent: table.zones.feeds_percent.unwrap_or(usual.feeds_percent),
    };
    template.spindle = SpindleStatements {
        clockwise: statements(source, table.spindle.clockwise)?,
        counter_clockwise: statements(source, table.spindle.counter_clockwise)?,
        stop: statements(source, table.spindle.stop)?,
    };
    template.base = frame(source, table.base)?;
    template.tool = tool(source, table.tool)?;
    for written in table.tools {
        let span = written.span();
        let NumberedToolTable {
            in_program,
            number,
            name,
            pose,
            mass_kg,
            centre_of_mass_mm,
        } = written.into_inner();
        let table = ToolTable {
            number,
            name,
            pose,
            mass_kg,
            centre_of_mass_mm,
        };
        let stated = tool(source, table)?;
        if template.tools.insert(in_program, stated).is_some() {
            return Err(source.error(
                span,
                &format!("the tool {in_program} is stated twice"),
                "keep one of the two",
            ));
        }
    }
    Ok(template)
}

/// Statements of the controller, each of which is one line.
fn statements(source: Source<'_>, written: Vec<Spanned<String>>) -> Answer<Vec<String>> {
    let is_line = |text: &str| !text.trim().is_empty() && !text.contains(char::is_control);
    let wrong = written.iter().find(|line| !is_line(line.get_ref()));
    match wrong {
        Some(line) => Err(source.error(
            line.span(),
            "this is not one line of a program",
            "write each statement as a text of its own, as in  clockwise = [\"$OUT[12]=TRUE\"]",
        )),
        None => Ok(written.into_iter().map(Spanned::into_inner).collect()),
    }
}

/// A pose in mm.
fn pose(source: Source<'_>, written: &Spanned<PoseTable>) -> Answer<Isometry3<f64>> {
    let pose = written.get_ref().pose();
    let pose = pose.map_err(|(message, help)| source.error(written.span(), &message, &help))?;
    let in_mm = 1e3 * pose.translation.vector;
    Ok(Isometry3::from_parts(in_mm.into(), pose.rotation))
}

fn frame(source: Source<'_>, table: FrameTable) -> Answer<StatedFrame> {
    let stated = table.pose.as_ref().map(|written| pose(source, written));
    Ok(StatedFrame {
        number: table.number,
        name: table.name,
        pose: stated.transpose()?,
        ..StatedFrame::default()
    })
}

fn tool(source: Source<'_>, table: ToolTable) -> Answer<StatedTool> {
    let frame = FrameTable {
        number: table.number,
        name: table.name,
        pose: table.pose,
    };
    Ok(StatedTool {
        frame: self::frame(source, frame)?,
        mass_kg: table.mass_kg,
        centre_of_mass_mm: table.centre_of_mass_mm.map(Vector3::from),
        ..StatedTool::default()
    })
}

/// A whole template.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct TemplateTable {
    pub schema: Spanned<u32>,
    pub program_name: Option<String>,
    pub tool_orientation: Option<Spanned<PoseTable>>,
    pub rapids: Option<RapidsWord>,
    pub rapid_speed_mm_per_s: Option<f64>,
    pub joint_speed_percent: Option<f64>,
    pub unstated_feed_mm_per_s: Option<f64>,
    pub acceleration_m_per_s2: Option<f64>,
    pub configuration: Option<String>,
    pub start_joints_deg: Option<Vec<f64>>,
    pub places_unknown: Option<PlacesWord>,
    pub tolerance_mm: Option<f64>,
    pub most_points: Option<usize>,
    pub position_decimals: Option<usize>,
    pub angle_decimals: Option<usize>,
    pub quaternion_decimals: Option<usize>,
    pub speed_decimals: Option<usize>,
    #[serde(default)]
    pub base: FrameTable,
    #[serde(default)]
    pub tool: ToolTable,
    #[serde(default)]
    pub tools: Vec<Spanned<NumberedToolTable>>,
    #[serde(default)]
    pub spindle: SpindleTable,
    #[serde(default)]
    pub zones: ZonesTable,
}

/// A base.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct FrameTable {
    pub number: Option<u32>,
    pub name: Option<String>,
    pub pose: Option<Spanned<PoseTable>>,
}

/// The tool of a program with one.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ToolTable {
    pub number: Option<u32>,
    pub name: Option<String>,
    pub pose: Option<Spanned<PoseTable>>,
    pub mass_kg: Option<f64>,
    pub centre_of_mass_mm: Option<[f64; 3]>,
}

/// Tool among several.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct NumberedToolTable {
    pub in_program: u32,
    pub number: Option<u32>,
    pub name: Option<String>,
    pub pose: Option<Spanned<PoseTable>>,
    pub mass_kg: Option<f64>,
    pub centre_of_mass_mm: Option<[f64; 3]>,
}

/// Statements that start and stop the spindle.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpindleTable {
    #[serde(default)]
    pub clockwise: Vec<Spanned<String>>,
    #[serde(default)]
    pub counter_clockwise: Vec<Spanned<String>>,
    #[serde(default)]
    pub stop: Vec<Spanned<String>>,
}

/// Rounding of corners.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ZonesTable {
    pub rapids_mm: Option<f64>,
    pub feeds_mm: Option<f64>,
    pub rapids_percent: Option<f64>,
    pub feeds_percent: Option<f64>,
}

/// Conversion of rapids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum RapidsWord {
    /// Straight motions.
    Linear,
    /// Joint motions.
    Joint,
}

/// Policy for moves to places of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum PlacesWord {
    /// Refused between moves.
    Refused,
    /// Left out.
    LeftOut,
}
