//! Material, tools and stock as options state them.

use std::f64::consts::PI;

use kinetostat_cutting::{Engagement, Side, Stock, Tool};
use kinetostat_machining::EngagementSource;

use crate::engagement::arguments::{EngagementArgs, StockArgs};
use crate::files::input_files::InputFiles;
use crate::force::arguments::{PartWord, ToolArgs};
use crate::force::material::{Made, correction, material, materials};
use crate::force::refusal::refused;
use crate::force::tool::{CutTool, tool_of, tool_table};
use crate::job::arguments::ProgramArgs;
use crate::job::cut::FilesOfCut;
use crate::job::cut::cutters::{Cutter, called};
use crate::job::cut::material::MaterialSetup;
use crate::job::cut::stock::{About, Resolution};
use crate::job::job_file::JobFile;
use crate::job::setting::program_path;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::short;

pub(super) fn own_material(
    files: &InputFiles,
    args: &EngagementArgs,
    (smallest, largest): (&Tool, &Tool),
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
            return Err(Failure::input(
                "--correct-speed needs --rpm: the cutting speed follows from it",
            ));
        }
        (true, Some(_)) if smallest.diameter_mm() < largest.diameter_mm() => {
            return Err(Failure::input(
                "--correct-speed: tools of different diameters have different cutting speeds; leave it out, or look at one tool after the other",
            ));
        }
        (true, Some(rpm)) => Some(1e-3 * PI * largest.diameter_mm() * rpm),
    };
    let correction = correction(&args.material, Made::Milled, None, speed);
    MaterialSetup::new(&found, correction).map_err(|error| refused(&error))
}

pub(super) fn own_cutters(
    files: &InputFiles,
    args: &ToolArgs,
    (job, flags): (Option<&JobFile>, &ProgramArgs),
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
pub(super) fn own_engagement(
    args: &StockArgs,
    tools: (&Tool, &Tool),
) -> Answer<Option<(EngagementSource, String)>> {
    if let Some(corners) = &args.block_mm {
        return block(corners, args, tools).map(Some);
    }
    match (args.width_mm, args.depth_mm) {
        (Some(width), Some(depth)) => everywhere((width, depth), args.part, tools).map(Some),
        _ => Ok(None),
    }
}

fn block(
    corners: &[f64],
    args: &StockArgs,
    tools: (&Tool, &Tool),
) -> Answer<(EngagementSource, String)> {
    let [x0, y0, z0, x1, y1, z1] = corners[..] else {
        return Err(Failure::input("--block-mm needs six numbers"));
    };
    let refuse = |about: About, message: &str, help: &str| {
        let option = match about {
            About::Cell => "--cell-mm",
            About::Memory => "--memory-mb",
            About::Stock => "--block-mm",
        };
        Failure::input(format!("{option}: {message}; {help}"))
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
    let words = resolution.of_stock(&stock, tools.0)?;
    let [a, b] = [low, high].map(|corner| corner.map(short).join(", "));
    let words = format!("stock: a block from ({a}) to ({b}) mm; {words}");
    Ok((EngagementSource::Stock(Box::new(stock)), words))
}

/// Applies one constant cut to all feed moves.
fn everywhere(
    (width, depth): (f64, f64),
    part: Option<PartWord>,
    (smallest, largest): (&Tool, &Tool),
) -> Answer<(EngagementSource, String)> {
    if smallest.diameter_mm() < largest.diameter_mm() {
        return Err(Failure::input(
            "--width-mm: a width of cut is another engagement for tools of different diameters; give --block-mm, from which each tool has its own",
        ));
    }
    let radius = smallest.radius_mm();
    let side = match part {
        Some(PartWord::Left) => Side::Left,
        Some(PartWord::Right) => Side::Right,
        None if width >= 2.0 * radius => Side::Left,
        None => {
            return Err(Failure::input(
                "on which side is the part? Give --part left or --part right as seen along the feed",
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
