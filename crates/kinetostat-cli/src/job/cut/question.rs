//! Cutting data of a job as one question.

use std::ops::RangeInclusive;

use kinetostat_cutting::{Engagement, Side, SpindleCurve, Tool};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{CutQuestion, EngagementSource, Placement};
use nalgebra::Vector3;
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::cut::cutters::{ToolRange, cutters};
use crate::job::cut::files_of_cut::FilesOfCut;
use crate::job::cut::material::material;
use crate::job::cut::refused::refused;
use crate::job::cut::stock::stock;
use crate::job::cut_tables::{EngagementTable, MaterialTable, SpindleTable};
use crate::job::format::LoadTable;
use crate::job::job_file::JobFile;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::short;

/// The cuts of a job.
pub(crate) struct CutSetup {
    /// Name of the material.
    pub(crate) material: String,
    pub(crate) question: CutQuestion,
    /// Assumptions, one sentence each.
    pub(crate) words: Vec<String>,
    pub(crate) files: FilesOfCut,
}

/// The cuts of a job that names a material; `None` where it names none.
pub(crate) fn cut_setup(
    files: &InputFiles,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    placement: &Placement,
) -> Answer<Option<CutSetup>> {
    let Some(j) = job else {
        return Ok(None);
    };
    let Some(table) = &j.job.material else {
        return no_material(j).map(|()| None);
    };
    not_typed_too(j, flags, table, &MATERIAL)?;
    stands_along_the_part(j, table, placement)?;
    let mut read = FilesOfCut::default();
    let of_material = material(files, j, table.get_ref(), &mut read)?;
    let mut words = of_material.words.clone();
    let cutters = cutters(files, j, flags, &mut read, &mut words)?;
    let mut tools = Vec::new();
    for cutter in &cutters {
        let tool = of_material.for_tool(cutter, &mut words);
        tools.push(tool.map_err(|error| refused(j, &table.get_ref().name, &error))?);
    }
    let Some(range) = ToolRange::of(&cutters) else {
        // The fault of the cutter has been reported.
        if j.lacks("cutter") {
            return Ok(None);
        }
        return Err(j.error(
            table,
            "a material is named, and no tool has a cutter",
            "write cutter = { shape = \"flat\", diameter_mm = 6, teeth = 2, helix_deg = 30 } under [tool] (or under each of [[tools]]), or [cutters] file = \"tools.toml\"",
        ));
    };
    let source = where_it_cuts(files, &mut read, j, range)?;
    let (source, source_words) = match source {
        Some(source) => source,
        // The fault of the engagement has been reported.
        None if j.lacks("stock") || j.lacks("engagement") => {
            (EngagementSource::Constant(Engagement::air()), String::new())
        }
        None => {
            return Err(j.error(
                table,
                "it is not said where the tool is in the material",
                "write [stock] block_mm = [[x, y, z], [x, y, z]], or [engagement] width_mm = ..., depth_mm = ..., part = \"right\"",
            ));
        }
    };
    words.push(source_words);
    let spindle = j.job.spindle.as_ref().map(|s| s.get_ref().clone());
    let spindle = spindle.unwrap_or_default();
    let rpm = spindle_speed(j, &spindle)?;
    let choice = spindle.force.unwrap_or_default();
    words.push(format!("force that counts: {}", choice.description()));
    Ok(Some(CutSetup {
        material: of_material.name().to_owned(),
        question: CutQuestion {
            tools,
            engagement: source,
            choice,
            rpm,
            rotation: spindle.rotation,
            spindle: curve(j, &spindle)?,
        },
        words,
        files: read,
    }))
}

/// Edges are where the engagement says only if the tool stands along z of the part, and chips as thick as the program says
/// only without a scale.
fn stands_along_the_part(
    j: &JobFile,
    table: &Spanned<MaterialTable>,
    placement: &Placement,
) -> Answer<()> {
    let part_from_tool = placement.base_from_part.rotation.inverse() * placement.tool_orientation;
    let along = (part_from_tool * Vector3::z()).z.abs();
    if along < TILT.cos() {
        return Err(j.error(
            table,
            &format!(
                "the tool is tilted by {:.1} degrees against z of the part; forces of the cut are known for a tool along it",
                along.min(1.0).acos().to_degrees()
            ),
            "turn the part or the tool (part_orientation, tool_orientation), or state the force under [load]",
        ));
    }
    if placement.scale != 1.0 {
        return Err(j.error(
            table,
            "the program is scaled; a cutter, its feed and a stock of another size have another force",
            "leave out the scale, or state the force under [load]",
        ));
    }
    Ok(())
}

/// A tool tilted by less stands along z of the part.
const TILT: f64 = 0.01;

/// Tables that mean nothing without a material.
fn no_material(j: &JobFile) -> Answer<()> {
    if j.lacks("material") {
        return Ok(());
    }
    let help = "name the material: [material] name = \"AlMg4.5Mn\" (`kinetostat force --list-materials` lists them)";
    let span = |table: Option<std::ops::Range<usize>>, what| table.map(|span| (span, what));
    let alone = [
        span(j.job.stock.as_ref().map(Spanned::span), "there is a stock"),
        span(
            j.job.engagement.as_ref().map(Spanned::span),
            "there is an engagement",
        ),
        span(
            j.job.cutters.as_ref().map(Spanned::span),
            "there are cutters",
        ),
        span(
            j.job.spindle.as_ref().map(Spanned::span),
            "there is a spindle",
        ),
    ];
    if let Some((span, what)) = alone.into_iter().flatten().next() {
        let message = format!("{what}, and no material to be cut");
        return Err(j.error(&Spanned::new(span, ()), &message, help));
    }
    Ok(())
}

/// Returns the source of the engagement, and its description; `None` if the job has neither stock nor engagement.
pub(crate) fn where_it_cuts(
    files: &InputFiles,
    read: &mut FilesOfCut,
    j: &JobFile,
    tools: ToolRange<'_>,
) -> Answer<Option<(EngagementSource, String)>> {
    match (&j.job.stock, &j.job.engagement) {
        (Some(table), None) => {
            let (stock, words) = stock(files, j, table, tools, read)?;
            Ok(Some((EngagementSource::Stock(Box::new(stock)), words)))
        }
        (None, Some(table)) if tools.is_mixed() => Err(j.error(
            table,
            "an engagement of some width is another for tools of different diameters",
            "give [stock], from which each tool has its own, or one program for each tool",
        )),
        (None, Some(table)) => engagement(j, table, tools.smallest).map(Some),
        (Some(stock), Some(_)) => Err(j.error(
            stock,
            "the engagement is given twice: by a stock, and as stated",
            "keep [stock] or [engagement]",
        )),
        (None, None) => Ok(None),
    }
}

pub(crate) fn spindle_speed(j: &JobFile, table: &SpindleTable) -> Answer<Option<f64>> {
    let Some(rpm) = &table.rpm else {
        return Ok(None);
    };
    match *rpm.get_ref() > 0.0 && *rpm.get_ref() <= 1e6 {
        true => Ok(Some(*rpm.get_ref())),
        false => Err(j.error(
            rpm,
            "a spindle turns with more than 0 and at most 1000000 rpm",
            "correct the speed",
        )),
    }
}

pub(crate) fn curve(j: &JobFile, table: &SpindleTable) -> Answer<Option<SpindleCurve>> {
    let Some(power) = &table.power_w else {
        return match &j.job.spindle {
            Some(_) if j.lacks("power_w") => Ok(None),
            Some(own) if table.base_rpm.is_some() || table.most_rpm.is_some() => Err(j.error(
                own,
                "speeds alone do not say what the spindle can",
                "write power_w, base_rpm and most_rpm, or none of them",
            )),
            _ => Ok(None),
        };
    };
    let (Some(base), Some(most)) = (&table.base_rpm, &table.most_rpm) else {
        // The fault of the speed has been reported.
        if j.lacks("base_rpm") || j.lacks("most_rpm") {
            return Ok(None);
        }
        return Err(j.error(
            power,
            "a power alone does not say what the spindle can",
            "write base_rpm and most_rpm beside it",
        ));
    };
    let curve = SpindleCurve::rated(*power.get_ref(), *base.get_ref(), *most.get_ref());
    curve.map(Some).map_err(|error| {
        let at = match error.quantity.as_str() {
            "base speed" => base,
            "largest speed" => most,
            _ => power,
        };
        refused(j, at, &error)
    })
}

/// The engagement of `[engagement]` for a tool, and it in words.
fn engagement(
    job: &JobFile,
    table: &Spanned<EngagementTable>,
    tool: &Tool,
) -> Answer<(EngagementSource, String)> {
    let t = table.get_ref();
    let straight = |width: f64, depth: f64, part: Option<Side>| {
        let slot = width >= 2.0 * tool.radius_mm();
        let part = match part {
            Some(side) => side,
            None if slot => Side::Left,
            None => {
                return Err(job.error(
                    table,
                    "it is not said on which side of the feed the part is",
                    "write part = \"left\" or part = \"right\"",
                ));
            }
        };
        Engagement::straight(tool.radius_mm(), width, depth, part)
            .map_err(|error| refused(job, table, &error))
    };
    match (&t.width_mm, &t.depth_mm, t.lines.is_empty()) {
        (Some(width), Some(depth), true) => {
            let (width, depth) = (*width.get_ref(), *depth.get_ref());
            let words = format!(
                "engagement as stated on all feed moves: {} mm wide, {} mm deep",
                short(width),
                short(depth)
            );
            let source = EngagementSource::Constant(straight(width, depth, t.part)?);
            Ok((source, words))
        }
        (None, None, false) => {
            let mut ranges = Vec::new();
            for lines in &t.lines {
                let l = lines.get_ref();
                if l.from == 0 || l.to < l.from {
                    return Err(job.error(
                        lines,
                        "lines count from 1, the first before the last",
                        "correct 'from' and 'to'",
                    ));
                }
                let before = ranges
                    .iter()
                    .find(|(range, _): &&(RangeInclusive<usize>, _)| {
                        *range.start() <= l.to && l.from <= *range.end()
                    });
                if let Some((range, _)) = before {
                    return Err(job.error(
                        lines,
                        &format!(
                            "lines {} to {} have an engagement already",
                            range.start(),
                            range.end()
                        ),
                        "let no line stand in two ranges",
                    ));
                }
                ranges.push((l.from..=l.to, straight(l.width_mm, l.depth_mm, l.part)?));
            }
            Ok((
                EngagementSource::Lines(ranges),
                "engagement as stated for lines of the program, air on all others".to_owned(),
            ))
        }
        _ => Err(missing(job, table)),
    }
}

fn missing(job: &JobFile, table: &Spanned<EngagementTable>) -> Failure {
    job.error(
        table,
        "an engagement is 'width_mm' and 'depth_mm', or 'lines'",
        "write both, or lines = [{ from = 10, to = 40, width_mm = 2, depth_mm = 3, part = \"right\" }]",
    )
}

/// Source of a computed force that excludes a typed one, in words.
pub(super) struct OtherForce {
    /// Text after "a force, and".
    what: &'static str,
    /// Text after "on the command line, and by".
    whose: &'static str,
    table: &'static str,
}

pub(super) const MATERIAL: OtherForce = OtherForce {
    what: "a material to compute it from",
    whose: "the material",
    table: "[material]",
};

pub(super) const MEASURED: OtherForce = OtherForce {
    what: "measured forces",
    whose: "the measured forces",
    table: "[measured]",
};

/// A force that is typed in stands against one that is computed or measured.
pub(super) fn not_typed_too<T>(
    j: &JobFile,
    flags: &ProgramArgs,
    table: &Spanned<T>,
    other: &OtherForce,
) -> Answer<()> {
    let typed = |load: &LoadTable| {
        load.force_n.is_some() || load.moment_n_m.is_some() || load.milling.is_some()
    };
    let of_tools = j
        .job
        .tools
        .iter()
        .filter_map(|tool| tool.get_ref().load.as_ref());
    if typed(&j.job.load) || of_tools.into_iter().any(typed) {
        return Err(j.error(
            table,
            &format!("the load is given twice: a force, and {}", other.what),
            &format!("keep [load] or {}", other.table),
        ));
    }
    if flags.force.is_some() || flags.moment.is_some() || flags.milling.is_some() {
        return Err(ErrorCode::Conflict.failure(format!(
                "the load is given twice: on the command line, and by {} of the job file; keep one of them",
                other.whose
            ),
        ));
    }
    Ok(())
}
