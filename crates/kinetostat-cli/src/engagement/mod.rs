//! `kinetostat engagement`: what a program cuts, where, and with which force, torque and power.
//!
//! It takes program, cutters, material, stock and spindle from options and from a job file, and gives the removed volume, the
//! force along the path, the worst lines and what was assumed, as text, JSON, table and picture. It knows no machine.

mod answer;
pub(crate) mod arguments;
mod cut;
mod text;

use kinetostat_cutting::Stock;
use kinetostat_machining::{
    CutPlace, CuttingTool, EngagementSource, FlatProgram, ForceAlongPath, PointKind, Warning,
    WarningCode, cut_places, cutting_result, marked_as_compensated,
};
use kinetostat_program::{Curve, Knowledge, MoveKind, Path, WarningTopic};
use kinetostat_report::{Cell, PlotLine, PlotMark, Section, engagement_svg};

use crate::engagement::answer::{EngagementAnswer, StockAnswer, ToolAnswer};
use crate::engagement::arguments::EngagementArgs;
use crate::engagement::cut::cut;
use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::cut::CutSetup;
use crate::job::cut::along::{stopped_or_within, warnings};
use crate::job::job_file::JobFile;
use crate::job::output_paths::FLAT_PROGRAM;
use crate::job::program::{ReadProgram, read_program};
use crate::job::setting::{Setting, setting};
use crate::program::flat_lines::{COLUMNS, WithSources, cells, listed_under, of_warnings};
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::Answer;
use crate::ui::numbers::{number, short};
use crate::ui::progress::Progress;
use crate::ui::result_form::ResultForm;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<EngagementAnswer>(
    "engagement along a program",
)];

pub(crate) fn run(args: &EngagementArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = args.job.as_ref();
    let job = job.map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let flags = ProgramArgs {
        // The command line gives a recognised file as a job or a program; any other is taken for a program.
        program: args.program.clone().or(args.subject.clone()),
        reading: args.reading.clone(),
        expansion: args.expansion.clone(),
        ..ProgramArgs::default()
    };
    let mut setting = setting(&files, job.as_ref(), &flags, &WritingFlags::default())?;
    setting.write_flat_to(args.expansion.flat_program.clone());
    let cut = cut(&files, job.as_ref(), args, &flags)?;
    let read = read_program(&setting)?;
    let path = read.path();
    let mut inputs = setting.inputs.clone();
    inputs.extend(cut.files.paths.iter().cloned());
    let mut claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    if let Some(target) = &setting.targets.flat {
        let index = claimed.claim_also(FLAT_PROGRAM, target)?;
        claimed.fill(index, &setting.program)?;
    }
    let progress = Progress::new();
    let walked = cut.question.along_and_left(path, &progress);
    let (forces, left) = walked.map_err(|failure| stopped_or_within(failure, &setting))?;
    progress.finish();
    let answer = answer_of(&setting, &cut, &read, &forces, left.as_ref());
    let flat = setting.flat.as_ref();
    let mut text = text::answer_text(&answer);
    text.push_str(&listed_under(&text, flat));
    let shown = Shown {
        text,
        csv: match args.outputs.csv.is_some() {
            true => of_cut(&forces, path, flat)?,
            false => Vec::new(),
        },
        svg: match args.outputs.plot.is_some() {
            true => drawing(&answer, &cut.question.engagement, left.as_ref(), path),
            false => String::new(),
        },
        failure: None,
    };
    claimed.finish(&shown, &WithSources(&answer, flat))
}

fn answer_of(
    setting: &Setting,
    cut: &CutSetup,
    read: &ReadProgram<'_>,
    forces: &ForceAlongPath,
    left: Option<&Stock>,
) -> EngagementAnswer {
    let path = read.path();
    let mut files = setting.program_files.clone();
    files.extend(setting.job_file.clone());
    files.extend(cut.files.read.iter().cloned());
    let cuts = path.moves.iter();
    let cuts = cuts.filter(|m| m.is_known_feed());
    let mut assumed = cut.words.clone();
    assumed.push(
        "model, placement and tool lengths of a job play no part: the program is cut where and as large as it is written, with the tool along z; tool and part are rigid".to_owned(),
    );
    let mut warned: Vec<Warning> = warnings(Some(forces));
    warned.extend(read.with(marked_as_compensated));
    // Corrections do not apply here: every tool has its own cutter.
    let of_program = path.warnings.iter();
    let of_program = of_program.filter(|w| w.topic != WarningTopic::OneTool);
    let of_program = of_program.map(|w| Warning::of_program(WarningCode::Program, w));
    let mut of_program: Vec<Warning> = of_program.collect();
    of_program.dedup();
    warned.extend(of_program);
    EngagementAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        program: setting.program_name.clone(),
        flat: setting.flat.clone(),
        material: cut.material.clone(),
        files,
        tools: cut.question.tools.iter().map(tool).collect(),
        feed_length_mm: cuts.map(kinetostat_program::Move::length_mm).sum(),
        stock: stock(&cut.question.engagement, left),
        cutting: cutting_result(forces, path),
        assumed,
        warnings: of_warnings(warned, setting.flat.as_ref()),
    }
}

fn tool(of: &CuttingTool) -> ToolAnswer {
    ToolAnswer {
        number: of.number,
        shape: of.tool.shape().word(),
        diameter_mm: of.tool.diameter_mm(),
        teeth: of.tool.teeth(),
        helix_deg: of.tool.helix().to_degrees(),
    }
}

fn stock(source: &EngagementSource, left: Option<&Stock>) -> Option<StockAnswer> {
    let (EngagementSource::Stock(whole), Some(left)) = (source, left) else {
        return None;
    };
    let volume = whole.volume_mm3();
    let removed = volume - left.volume_mm3();
    Some(StockAnswer {
        volume_mm3: volume,
        removed_mm3: removed,
        removed_percent: 100.0 * removed / volume,
        cell_mm: whole.cell_mm(),
    })
}

const HEADER: [&str; 19] = [
    "line",
    "move",
    "share",
    "path_mm",
    "x_mm",
    "y_mm",
    "z_mm",
    "depth_mm",
    "arc_deg",
    "force_n",
    "force_along_feed_n",
    "force_left_n",
    "force_up_n",
    "torque_n_m",
    "power_w",
    "spindle_torque_n_m",
    "chip_mm",
    "feed_per_tooth_mm",
    "rpm",
];

/// A row for each; of a program that was written flat with the line that each line came from.
fn of_cut(forces: &ForceAlongPath, path: &Path, flat: Option<&FlatProgram>) -> Answer<Vec<u8>> {
    let mut header = HEADER.map(String::from).to_vec();
    header.extend(flat.iter().flat_map(|_| COLUMNS.map(String::from)));
    let mut rows = vec![header];
    let stations = cut_places(forces, path).filter(|place| place.kind != PointKind::Rapid);
    rows.extend(stations.map(|place| {
        let mut row = row(&place);
        row.extend(cells(place.line, flat).into_iter().flatten());
        row
    }));
    written(&rows)
}

fn row(p: &CutPlace) -> Vec<String> {
    let [x, y, z] = p.position_mm;
    let mut row = vec![p.line.to_string(), p.move_number.to_string()];
    row.extend([p.share, p.path_mm, x, y, z, p.depth_mm, p.arc_deg].map(cell));
    let parts = [p.force_along_feed_n, p.force_left_n, p.force_up_n];
    row.push(cell(p.force_n()));
    row.extend(parts.map(cell));
    row.extend([p.torque_n_m, p.power_w].map(cell));
    row.push(cell_if_any(p.spindle_torque_n_m));
    row.extend([p.chip_mm, p.feed_per_tooth_mm, p.rpm].map(cell));
    row
}

fn drawing(
    a: &EngagementAnswer,
    source: &EngagementSource,
    left: Option<&Stock>,
    path: &Path,
) -> String {
    let map = match (source, left) {
        (EngagementSource::Stock(whole), Some(left)) => Some(map(a, whole, left, path)),
        _ => None,
    };
    let title = format!(
        "{} in {}: what is cut along the path",
        a.program, a.material
    );
    engagement_svg(&a.cutting, map.as_ref(), &title)
}

/// Upper limit of the cells along an axis.
const MOST_CELLS: f64 = 400.0;
/// Heights that differ by less are the same, mm.
const SAME_MM: f64 = 1e-3;
/// Room around the stock, as a share of its longer side.
const AROUND: f64 = 0.06;
/// Upper limit of the lines that are named.
const MOST_MARKS: usize = 4;
/// Named places are at least so far from each other, as a share of the map's longer side.
const APART: f64 = 0.1;
/// Shade of a stock with one height.
const EVEN: f64 = 0.8;

/// The map of a stock before and after a program.
fn map(a: &EngagementAnswer, whole: &Stock, left: &Stock, path: &Path) -> Section {
    let [low, high] = whole.corners_mm();
    let longest = [0, 1].map(|k| high[k] - low[k]);
    let longest = longest[0].max(longest[1]);
    let cell = whole
        .cell_mm()
        .max(longest * (1.0 + 2.0 * AROUND) / MOST_CELLS);
    let [x, y] = [0, 1].map(|k| {
        let (from, to) = (low[k] - AROUND * longest, high[k] + AROUND * longest);
        let count = ((to - from) / cell).round().max(2.0);
        let step = (to - from) / count;
        let places = (0..count as usize).map(|i| from + (i as f64 + 0.5) * step);
        places.collect::<Vec<f64>>()
    });
    let heights = heights(whole, left, &x, &y);
    let cells = y.iter().flat_map(|y| x.iter().map(move |x| (*x, *y)));
    let cells = cells
        .map(|(x, y)| look(whole, left, x, y, heights))
        .collect();
    let grey_label = match heights {
        Some([least, most]) if most - least > SAME_MM => format!(
            "not cut, {} (dark) to {} mm (light) high",
            short(least),
            short(most)
        ),
        Some([_, top]) => format!("not cut, top at z = {} mm", short(top)),
        None => String::new(),
    };
    Section {
        title: format!("{} in {}: the stock from above", a.program, a.material),
        x_label: "x, mm".to_owned(),
        y_label: "y, mm".to_owned(),
        value_label: "taken off, mm deep".to_owned(),
        x,
        y,
        cells,
        others: vec!["cut through".to_owned()],
        grey_label,
        scale_from: Some(0.0),
        lines: lines(path, 0.2 * cell),
        marks: marks(&a.cutting.worst_lines, longest),
        ..Section::default()
    }
}

/// Stock height at an uncut place; none where it is cut.
fn kept(whole: &Stock, left: &Stock, x: f64, y: f64) -> Option<f64> {
    let (before, after) = (whole.top_mm(x, y)?, left.top_mm(x, y)?);
    (before - after <= SAME_MM).then_some(after)
}

/// Smallest and largest height of the uncut surface.
fn heights(whole: &Stock, left: &Stock, x: &[f64], y: &[f64]) -> Option<[f64; 2]> {
    let places = y.iter().flat_map(|y| x.iter().map(move |x| (*x, *y)));
    places
        .filter_map(|(x, y)| kept(whole, left, x, y))
        .fold(None, |found, top| match found {
            None => Some([top, top]),
            Some([least, most]) => Some([least.min(top), most.max(top)]),
        })
}

fn look(whole: &Stock, left: &Stock, x: f64, y: f64, heights: Option<[f64; 2]>) -> Cell {
    let Some(before) = whole.top_mm(x, y) else {
        return Cell::Value(f64::NAN);
    };
    if let Some(top) = kept(whole, left, x, y) {
        return Cell::Grey(match heights {
            Some([least, most]) if most - least > SAME_MM => (top - least) / (most - least),
            _ => EVEN,
        });
    }
    match left.top_mm(x, y) {
        // Depths are round numbers, and so are the ends of colours: rounding must not speckle them.
        Some(after) => Cell::Value(1e-4 * (1e4 * (before - after)).round()),
        None => Cell::Other(0),
    }
}

/// The path at feed and in rapids, from above.
fn lines(path: &Path, tolerance_mm: f64) -> Vec<PlotLine> {
    let kinds = [
        (MoveKind::Rapid, "rapid", true),
        (MoveKind::Feed, "path of the tip at feed", false),
    ];
    let line = |(kind, name, dashed): (MoveKind, &str, bool)| {
        let mut points: Vec<(f64, f64)> = Vec::new();
        let mut at: Option<[f64; 3]> = None;
        let moves = path.moves.iter();
        for motion in moves.filter(|m| m.kind == kind && m.known == Knowledge::Whole) {
            if at != Some(motion.start.into()) {
                points.push((f64::NAN, f64::NAN));
                points.push((motion.start.x, motion.start.y));
            }
            let pieces = match &motion.curve {
                Curve::Line => 1,
                Curve::Arc(arc) => arc.chords_within(tolerance_mm),
            };
            points.extend((1..=pieces).map(|i| {
                let place = motion.point(i as f64 / pieces as f64);
                (place.x, place.y)
            }));
            at = Some(motion.point(1.0).into());
        }
        PlotLine {
            name: name.to_owned(),
            colour: 0,
            dashed,
            dots: false,
            points,
        }
    };
    let lines = kinds.map(line).into_iter();
    lines.filter(|line| !line.points.is_empty()).collect()
}

/// The lines with the largest forces, not two beside each other.
fn marks(worst: &[CutPlace], longest: f64) -> Vec<PlotMark> {
    let mut marks: Vec<PlotMark> = Vec::new();
    for place in worst {
        let [x, y, _] = place.position_mm;
        let near = |m: &PlotMark| (m.at.0 - x).hypot(m.at.1 - y) < APART * longest;
        if marks.len() == MOST_MARKS || marks.iter().any(near) {
            continue;
        }
        let line = format!("line {}", place.line);
        let force = number(place.force_n(), 3);
        marks.push(PlotMark {
            at: (x, y),
            detail: format!("{line}: {force} N, {} mm deep", short(place.depth_mm)),
            name: format!("{line}, {force} N"),
        });
    }
    marks
}
