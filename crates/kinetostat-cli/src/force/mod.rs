//! `kinetostat force`: the force of one cut (milling; drilling and turning in short), for somebody who knows material, tool, depth and feed.
//!
//! It takes options and perhaps files of materials and tools, and gives mean, peak and the force that makes the wall, torque,
//! power and harmonics, as text, JSON, table and drawing. It knows no machine and no program.

mod answer;
mod answer_of;
pub(crate) mod arguments;
mod assumed;
mod csv;
pub(crate) mod cut;
mod drilling;
mod findings;
pub(crate) mod fit;
pub(crate) mod fit_arguments;
mod help;
mod list;
pub(crate) mod material;
mod plot;
pub(crate) mod refusal;
mod text;
pub(crate) mod tool;
mod trust;
mod turning;

use std::path::PathBuf;

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::force::answer_of::answer_of;
use crate::force::arguments::ForceArgs;
use crate::force::cut::cut_of;
use crate::force::material::{Made, applied, material, materials};
use crate::force::tool::tool_of;
use crate::ui::background::interruptible;
use crate::ui::failure::{Answer, Failure};
use crate::ui::given::Given;

/// Options of a dynamometer's log.
const OF_A_FIT: [&str; 4] = ["--acts-on", "--group", "--spread-percent", "--out-material"];

/// Options of a milling cut, and of its tool.
const OF_A_MILLING_CUT: [&str; 11] = [
    "--helix-deg",
    "--corner-radius-mm",
    "--lead-angle-deg",
    "--run-out-um",
    "--run-out-angle-deg",
    "--max-chip-mm",
    "--flute-length-mm",
    "--stick-out-mm",
    "--counter-clockwise",
    "--down-feed-per-tooth-mm",
    "--feed-per-tooth-mm",
];

/// Refuses options of another kind of cut than the one that is asked for.
fn refuse_unused(args: &ForceArgs, given: &Given) -> Answer<()> {
    let steady = &args.steady;
    if args.list_materials {
        let used = [
            "--list-materials",
            "--materials",
            "--json",
            "--force-overwrite",
        ];
        return given.refuse_but(
            &used,
            "is for a cut, and --list-materials lists materials: leave one of them out",
        );
    }
    if args.fit.fit.is_none() {
        given.refuse(
            &OF_A_FIT,
            "belongs to --fit FILE: add that, or leave it out",
        )?;
    }
    if steady.drill || steady.turning {
        given.refuse(
            &OF_A_MILLING_CUT,
            "is for a milling cut: leave it out with --drill and --turning",
        )?;
    }
    if steady.drill {
        let of_turning = ["--approach-angle-deg", "--speed-m-per-min"];
        given.refuse(
            &of_turning,
            "belongs to --turning: leave it out with --drill",
        )?;
    }
    if steady.turning {
        let of_drilling = [
            "--point-angle-deg",
            "--hole-mm",
            "--chisel-factor",
            "--lips",
        ];
        given.refuse(
            &of_drilling,
            "belongs to --drill: leave it out with --turning",
        )?;
    }
    Ok(())
}

pub(crate) fn run(args: &ForceArgs, given: &Given) -> Answer<()> {
    let files = InputFiles::default();
    refuse_unused(args, given)?;
    if let Some(means) = &args.fit.fit {
        return fit::run(&files, args, means);
    }
    let materials = materials(&files, args.material.materials.as_deref())?;
    let mut inputs: Vec<PathBuf> = args.material.materials.iter().cloned().collect();
    if args.list_materials {
        let claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
        let shown = Shown {
            text: list::list_text(&materials),
            csv: Vec::new(),
            svg: String::new(),
            failure: None,
        };
        return claimed.finish(&shown, &list::list(&materials));
    }
    let material = material(&materials, &args.material)?;
    if args.steady.drill || args.steady.turning {
        let claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
        return match args.steady.drill {
            true => drilling::run(args, &material, claimed),
            false => turning::run(args, &material, claimed),
        };
    }
    if args.steady.feed_per_turn_mm.is_some() {
        return Err(Failure::input(
            "--feed-per-turn-mm is the feed of --drill and --turning; a milling cut has --feed-per-tooth-mm, or --feed-mm-per-min with --rpm",
        ));
    }
    let tool = tool_of(&files, &args.tool)?;
    inputs.extend(tool.table.clone());
    let cut = cut_of(&tool.tool, &args.cut, &args.spindle)?;
    let speed = match args.material.correct_speed {
        true => Some(cut.speed_m_per_min().ok_or_else(|| {
            Failure::input("--correct-speed needs --rpm: the cutting speed follows from it")
        })?),
        false => None,
    };
    let applied = applied(
        &material,
        &args.material,
        Made::Milled,
        tool.rake_deg,
        speed,
    )?;
    let claimed = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let question = text::question(&material.name, &tool, &cut);
    // A cutter of two hundred teeth may take seconds.
    let answer = interruptible(move |_| answer_of(question, &material, &applied, &tool, &cut))?;
    let shown = Shown {
        text: text::answer_text(&answer),
        csv: csv::of_force(&answer)?,
        svg: plot::drawing(&answer),
        failure: None,
    };
    claimed.finish(&shown, &answer)
}
