//! Tools, material, stock and spindle of the program: from options, and else from the job file.

use std::f64::consts::PI;

use kinetostat::Pose;
use kinetostat_cutting::{CutError, Engagement, Rotation, Side, Stock};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{CutQuestion, EngagementSource, Placement};
use nalgebra::UnitQuaternion;

use crate::engagement::arguments::{EngagementArgs, RotationWord, StockArgs};
use crate::files::input_files::InputFiles;
use crate::force::arguments::{MaterialArgs, PartWord, ToolArgs};
use crate::force::cut::curve;
use crate::force::material::{Made, correction, material, materials};
use crate::force::refusal::{refused, within};
use crate::force::tool::{CutTool, tool_of, tool_table};
use crate::job::arguments::ProgramArgs;
use crate::job::cut::cutters::{Cutter, ToolRange, called, cutters};
use crate::job::cut::material::{MaterialSetup, material as material_of_job};
use crate::job::cut::question::{curve as curve_of_job, spindle_speed, where_it_cuts};
use crate::job::cut::refused::refused as refused_in_job;
use crate::job::cut::stock::{About, Resolution};
use crate::job::cut::{CutSetup, FilesOfCut, cut_setup};
use crate::job::format::Job;
use crate::job::job_file::JobFile;
use crate::job::setting::program_path;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::short;

/// The cut, each part of it from the options, and else from the job.
pub(super) fn cut(
    files: &InputFiles,
    job: Option<&JobFile>,
    args: &EngagementArgs,
    flags: &ProgramArgs,
) -> Answer<CutSetup> {
    if let Some(j) = job.filter(|_| !options_given(args)) {
        no_factors(&args.material)?;
        let of_job = cut_setup(files, job, flags, &as_programmed())?;
        return of_job.ok_or_else(|| {
            ErrorCode::Missing.failure(format!(
                "the job file '{}' names no material: without it nothing is known of a cut; write [material] name = \"AlMg4.5Mn\" with [stock] (or [engagement]) and the cutter of the tool, or give --material, --block-mm and --tool",
                j.path.display()
            ))
        });
    }
    nothing_missing(job, args)?;
    let mut read = FilesOfCut::default();
    let mut of_tools = Vec::new();
    let cutters = match (args.tool.given(), job) {
        (false, Some(j)) => cutters(files, j, flags, &mut read, &mut of_tools)?,
        _ => own_cutters(files, &args.tool, job, flags, &mut read)?,
    };
    let Some(range) = ToolRange::of(&cutters) else {
        return Err(ErrorCode::Missing.failure("no tool: the program calls none of the table (T); give --tool-number for the whole program",
        ));
    };
    let of_job = job.and_then(|j| Some((j, j.job.material.as_ref()?)));
    let material = match (&args.material.material, of_job) {
        (None, Some((j, table))) => {
            no_factors(&args.material)?;
            material_of_job(files, j, table.get_ref(), &mut read)?
        }
        _ => own_material(files, args, range, &mut read)?,
    };
    let mut words = material.words.clone();
    words.append(&mut of_tools);
    let tools = cutters
        .iter()
        .map(|cutter| material.for_tool(cutter, &mut words))
        .collect::<Result<Vec<_>, CutError>>()
        .map_err(|error| match (&args.material.material, of_job) {
            (None, Some((j, table))) => refused_in_job(j, &table.get_ref().name, &error),
            _ => refused(&error),
        })?;
    let (engagement, source_words) = match (own_engagement(&args.stock, range)?, job) {
        (Some(own), _) => own,
        (None, Some(j)) => where_it_cuts(files, &mut read, j, range)?
            .ok_or_else(|| ErrorCode::Missing.failure(NO_STOCK))?,
        (None, None) => return Err(ErrorCode::Missing.failure(NO_STOCK)),
    };
    words.push(source_words);
    let table = job.and_then(|j| j.job.spindle.as_ref().map(|s| (j, s.get_ref())));
    let rpm = match (args.turning.rpm, table) {
        (Some(rpm), _) => Some(within(
            "speed of the spindle",
            rpm,
            1e-3..=1e6,
            "turns per minute",
        )?),
        (None, Some((j, table))) => spindle_speed(j, table)?,
        (None, None) => None,
    };
    let rotation = args.turning.rotation.map(|word| match word {
        RotationWord::Clockwise => Rotation::Clockwise,
        RotationWord::CounterClockwise => Rotation::CounterClockwise,
    });
    let spindle = match (curve(&args.spindle)?, table) {
        (None, Some((j, table))) => curve_of_job(j, table)?,
        (own, _) => own,
    };
    let choice = table.and_then(|(_, table)| table.force).unwrap_or_default();
    words.push(format!("force that counts: {}", choice.description()));
    Ok(CutSetup {
        material: material.name().to_owned(),
        question: CutQuestion {
            tools,
            engagement,
            choice,
            rpm,
            rotation: rotation.or(table.and_then(|(_, table)| table.rotation)),
            spindle,
        },
        words,
        files: read,
    })
}

/// True if an option describes the cut; a job alone is read as `compensate` reads it.
fn options_given(args: &EngagementArgs) -> bool {
    args.material.material.is_some()
        || args.tool.given()
        || args.stock.block_mm.is_some()
        || args.stock.width_mm.is_some()
        || args.turning.rpm.is_some()
        || args.turning.rotation.is_some()
        || args.spindle.spindle_power_w.is_some()
}

/// The program in its own coordinates, the tool along z: a cut knows no machine.
fn as_programmed() -> Placement {
    Placement {
        base_from_part: Pose::identity(),
        tool_orientation: UnitQuaternion::identity(),
        orientation_follows: false,
        scale: 1.0,
    }
}

const NO_STOCK: &str = "no stock: give --block-mm X0 Y0 Z0 X1 Y1 Z1 (two corners, program coordinates), --width-mm with --depth-mm for the same cut everywhere, or --job JOB";

/// Reports all missing data at once.
fn nothing_missing(job: Option<&JobFile>, args: &EngagementArgs) -> Answer<()> {
    let of_job = |says: fn(&Job) -> bool| job.is_some_and(|j| says(&j.job));
    let mut missing = Vec::new();
    if args.material.material.is_none() && !of_job(|job| job.material.is_some()) {
        missing.push(
            "no material: give --material NAME (`kinetostat force --list-materials` shows the names), or [material] in a job file",
        );
    }
    let cutter = |job: &Job| {
        let numbered = job.tools.iter().any(|tool| tool.get_ref().cutter.is_some());
        job.tool.cutter.is_some() || numbered || job.cutters.is_some()
    };
    if !args.tool.given() && !of_job(cutter) {
        missing.push(
            "no tool: give --tool flat (ball, bull, face) with --diameter-mm and --teeth, --tool-table FILE.toml, or a cutter in a job file",
        );
    }
    let stated = args.stock.block_mm.is_some() || args.stock.width_mm.is_some();
    if !stated && !of_job(|job| job.stock.is_some() || job.engagement.is_some()) {
        missing.push(NO_STOCK);
    }
    match missing.is_empty() {
        true => Ok(()),
        false => Err(ErrorCode::Missing.failure(missing.join("; "))),
    }
}

/// Factors belong to a material that is named beside them.
fn no_factors(args: &MaterialArgs) -> Answer<()> {
    let given = [
        ("--materials", args.materials.is_some()),
        ("--rake-deg", args.rake_deg.is_some()),
        ("--wear", args.wear.is_some()),
        ("--coolant", args.coolant.is_some()),
        ("--edge", args.edge.is_some()),
        ("--correct-speed", args.correct_speed),
        ("--process-factor", args.process_factor.is_some()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(ErrorCode::Missing.failure(format!(
            "{option} needs --material: the job names the material together with its factors"
        ))),
        None => Ok(()),
    }
}

fn own_material(
    files: &InputFiles,
    args: &EngagementArgs,
    tools: ToolRange<'_>,
    read: &mut FilesOfCut,
) -> Answer<MaterialSetup> {
    let own = args.material.materials.as_deref();
    let all = materials(files, own)?;
    if let Some(path) = own {
        read.stated(files, "file of materials", path.to_owned())?;
    }
    let found = material(&all, &args.material)?;
    let speed = match (args.material.correct_speed, args.turning.rpm) {
        (false, _) => None,
        (true, None) => {
            return Err(ErrorCode::Missing
                .failure("--correct-speed needs --rpm: the cutting speed follows from it"));
        }
        (true, Some(_)) if tools.is_mixed() => {
            return Err(ErrorCode::Unused.failure("--correct-speed: tools of different diameters have different cutting speeds; leave it out, or look at one tool after the other",
            ));
        }
        (true, Some(rpm)) => Some(1e-3 * PI * tools.largest.diameter_mm() * rpm),
    };
    let correction = correction(&args.material, Made::Milled, None, speed);
    MaterialSetup::new(&found, correction).map_err(|error| refused(&error))
}

fn own_cutters(
    files: &InputFiles,
    args: &ToolArgs,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    read: &mut FilesOfCut,
) -> Answer<Vec<Cutter>> {
    if let Some(path) = &args.tool_table {
        read.stated(files, "table of tools", path.clone())?;
        if args.tool_number.is_none() {
            let program = program_path(job, flags)?;
            let table = tool_table(files, path)?;
            let called = called(files, &program, &table)?.into_iter();
            return Ok(called
                .filter_map(|(number, entry)| Some(Cutter::of_entry(Some(number), entry?)))
                .collect());
        }
    }
    let CutTool {
        tool,
        rake_deg,
        max_chip_mm,
        flute_length_mm,
        stick_out_mm,
        ..
    } = tool_of(files, args)?;
    Ok(vec![Cutter {
        number: None,
        tool,
        rake_deg,
        max_chip_mm,
        reach_mm: flute_length_mm.or(stick_out_mm),
    }])
}

/// Returns the engagement of the tools, if options state it.
fn own_engagement(
    args: &StockArgs,
    tools: ToolRange<'_>,
) -> Answer<Option<(EngagementSource, String)>> {
    if let Some(corners) = &args.block_mm {
        return block(corners, args, tools).map(Some);
    }
    match (args.width_mm, args.depth_mm) {
        (Some(width), Some(depth)) => everywhere(width, depth, args.part, tools).map(Some),
        _ => Ok(None),
    }
}

fn block(
    corners: &[f64],
    args: &StockArgs,
    tools: ToolRange<'_>,
) -> Answer<(EngagementSource, String)> {
    let [x0, y0, z0, x1, y1, z1] = corners[..] else {
        return Err(ErrorCode::Value.failure("--block-mm needs six numbers"));
    };
    let refuse = |about: About, message: &str, help: &str| {
        let option = match about {
            About::Cell => "--cell-mm",
            About::Memory => "--memory-mb",
            About::Stock => "--block-mm",
        };
        ErrorCode::Value.failure(format!("{option}: {message}; {help}"))
    };
    let resolution = Resolution {
        cell_mm: args.cell_mm,
        memory_mb: args.memory_mb,
        names: ["--cell-mm", "--memory-mb"],
        refuse: &refuse,
    };
    let settings = resolution.settings(tools)?;
    let (low, high) = ([x0, y0, z0], [x1, y1, z1]);
    let stock = Stock::block(low, high, &settings).map_err(|error| {
        let what = format!("{}: {}", error.quantity, error.found);
        refuse(About::Stock, &what, &format!("expected {}", error.expected))
    })?;
    let words = resolution.of_stock(&stock, tools.smallest)?;
    let [a, b] = [low, high].map(|corner| corner.map(short).join(", "));
    let words = format!("stock: a block from ({a}) to ({b}) mm; {words}");
    Ok((EngagementSource::Stock(Box::new(stock)), words))
}

/// Applies one constant cut to all feed moves.
fn everywhere(
    width: f64,
    depth: f64,
    part: Option<PartWord>,
    tools: ToolRange<'_>,
) -> Answer<(EngagementSource, String)> {
    if tools.is_mixed() {
        return Err(ErrorCode::Missing.failure("--width-mm: a width of cut is another engagement for tools of different diameters; give --block-mm, from which each tool has its own",
        ));
    }
    let radius = tools.smallest.radius_mm();
    let side = match part {
        Some(PartWord::Left) => Side::Left,
        Some(PartWord::Right) => Side::Right,
        None if width >= 2.0 * radius => Side::Left,
        None => {
            return Err(ErrorCode::Missing.failure("on which side is the part? Give --part left or --part right as seen along the feed",
            ));
        }
    };
    let engagement = Engagement::straight(radius, width, depth, side);
    let engagement = engagement.map_err(|error| refused(&error))?;
    let words = format!(
        "engagement as stated on all feed moves: {} mm wide, {} mm deep",
        short(width),
        short(depth)
    );
    Ok((EngagementSource::Constant(engagement), words))
}
