//! `kinetostat model draw`: a drawing of a machine, and of how it moves or bends.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use kinetostat::{
    Direction, DirectionKind, MotionKind, Posture, Twist, chain::Share, spatial::moved,
};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_report::{Drawing, Magnified, Moved, Placed, View};

use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::machine::principal_directions::motion_description;
use crate::options::{EXIT_CODES, number};
use crate::place::arguments::PlaceArgs;
use crate::place::query::{PlaceQuery, place_query};
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::wrapped;
use crate::ui::numbers::{self, fixed, load_triple, short, triple};
use crate::ui::screen::{self, Stream};

/// A drawing of a machine (SVG), and of how it moves or bends
///
/// Links that bend, rigid ones, drives, passive joints, platforms, base and tool, at home or at a
/// place. With --motion: how the machine moves in its softest or free direction, by which joints.
/// With --force or --moment: the deflected machine over the undeflected one.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES, after_long_help = HELP)]
pub(crate) struct DrawArgs {
    /// Preset or model file
    #[arg(value_name = "MODEL")]
    model: String,
    #[command(flatten)]
    place: PlaceArgs,
    /// Distance of the tool's tip along z of the flange, mm
    #[arg(long, value_name = "L", allow_negative_numbers = true, value_parser = number)]
    tool_length_mm: Option<f64>,
    /// From where to look; without it, square to a machine in one plane, else obliquely
    #[arg(long, value_enum, value_name = "VIEW")]
    view: Option<ViewWord>,
    /// Draw the motion in the N-th softest direction of the tool; 1 is a free one, if there is any
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "1", allow_negative_numbers = true, value_parser = crate::options::whole, conflicts_with_all = ["force", "moment", "scale"])]
    motion: Option<usize>,
    /// Draw the machine under this force on the tool's tip, N (0 0 0: under its own weight)
    #[arg(long, alias = "load", num_args = 3, value_names = ["FX", "FY", "FZ"], allow_negative_numbers = true, value_parser = number)]
    force: Option<Vec<f64>>,
    /// Draw the machine under this moment on the tool, N m
    #[arg(long, num_args = 3, value_names = ["MX", "MY", "MZ"], allow_negative_numbers = true, value_parser = number)]
    moment: Option<Vec<f64>>,
    /// How many times larger the deflection is drawn; without it, a round number that shows it
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = number)]
    scale: Option<f64>,
    /// The drawing; without it, it goes to the standard output
    #[arg(long, short, value_name = "FILE", help_heading = "Outputs")]
    out: Option<PathBuf>,
    /// Overwrite an existing file
    #[arg(long, help_heading = "Outputs")]
    force_overwrite: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ViewWord {
    /// Obliquely from above, from where the least coincides
    Iso,
    /// Along y: x to the right, z up
    Front,
    /// Against x: y to the right, z up
    Side,
    /// From above: x to the right, y up
    Top,
}

const HELP: &str = "\
Examples:
  kinetostat model draw orthoglide --out orthoglide.svg
  kinetostat model draw my_robot.toml --at 1200 0 800 --view front \\
      --out robot.svg
  kinetostat model draw stewart_gough_a --motion --out free.svg
  kinetostat model draw heavy_6r --force 0 500 -1000 --out bent.svg

Exit codes:
  0    answered
  1    wrong input: a file, a number or an option; the message says which
  2    no answer: not converged, or a point that cannot be reached";

pub(crate) fn run(args: &DrawArgs) -> Answer<()> {
    let loaded = args.force.is_some() || args.moment.is_some();
    if args.scale.is_some() && !loaded {
        return Err(ErrorCode::Unused.failure("--scale says how much larger a deflection is drawn, but there is none; give --force or --moment",
        ));
    }
    let query = place_query(
        &InputFiles::default(),
        &args.model,
        &args.place,
        args.tool_length_mm,
        args.force.as_deref(),
        args.moment.as_deref(),
    )?;
    let existing = Existing::forced(args.force_overwrite);
    let mut outputs = Outputs::new(existing, query.inputs.clone());
    let target = args.out.as_deref();
    let target = target
        .map(|path| outputs.claim("drawing", path))
        .transpose()?;

    let posture = query.posture()?;
    let mut drawing = Drawing::of(&query.mechanism, Placed::at(&posture));
    drawing.view = args.view.map(|view| match view {
        ViewWord::Iso => View::Iso,
        ViewWord::Front => View::Front,
        ViewWord::Side => View::Side,
        ViewWord::Top => View::Top,
    });
    drawing.title = title(&query);
    let mut text = String::new();
    if let Some(rank) = args.motion {
        let (moved, words) = motion(&posture, rank)?;
        drawing.note.clone_from(&words);
        drawing.moved = Some(moved);
        text = words;
    } else if loaded {
        let (moved, words) = deflection(&query, &posture, args.scale)?;
        drawing.note.clone_from(&words);
        drawing.moved = Some(moved);
        drawing.applied = Some(query.wrench);
        text = words;
    }
    let (svg, _) = drawing.svg();
    let mut said = query.heading();
    if !text.is_empty() {
        said.push_str(&wrapped(&text, 0));
    }
    said.push_str(&crate::ui::warnings::warnings(&query.warnings));
    let Some(target) = target else {
        screen::print(Stream::Err, &said)?;
        return screen::print_bytes(svg.as_bytes());
    };
    outputs.fill(target, svg.as_bytes())?;
    said.push_str(&outputs::written(&outputs.commit()?));
    screen::print(Stream::Out, &said)
}

fn title(query: &PlaceQuery) -> String {
    let at = query.target.translation.vector * 1e3;
    let place = if query.at_home {
        "at home, tool at"
    } else {
        "tool at"
    };
    format!(
        "{}, {place} {} mm",
        query.name,
        triple(at.into(), |x| short((x * 10.0).round() / 10.0))
    )
}

/// The motion in the direction of this rank, the softest first.
fn motion(posture: &Posture, rank: usize) -> Answer<(Moved, String)> {
    let stiffness = posture.stiffness()?;
    let mut list: Vec<&Direction> = stiffness
        .directions
        .iter()
        .filter(|d| d.kind != DirectionKind::Rigid)
        .collect();
    list.sort_by(|a, b| a.stiffness_n_per_m.total_cmp(&b.stiffness_n_per_m));
    let count = list.len();
    let Some(direction) = rank.checked_sub(1).and_then(|i| list.get(i)) else {
        return Err(ErrorCode::Value.failure(match count {
            0 => "--motion: the machine is rigid, its tool moves in no direction".to_owned(),
            _ => format!("--motion is {rank}; directions are numbered 1 (the softest) to {count}"),
        }));
    };
    let mut direction = (*direction).clone();
    let (from, to) = small_motion(posture, &stiffness, &direction.twist)?;
    direction.participation = participation(posture, &from, &to);
    let kind = match direction.kind {
        DirectionKind::Free => "free direction: the tool".to_owned(),
        _ => format!(
            "direction {rank} of {count} by principal stiffness ({} N/mm): the tool",
            numbers::number(1e-3 * direction.stiffness_n_per_m, 3)
        ),
    };
    let words = format!("{kind} {}", motion_description(&direction));
    let name = match direction.kind {
        DirectionKind::Free => "moved along the free direction",
        _ => "moved along the direction",
    };
    let moved = Moved {
        from,
        to,
        magnified: Magnified::Direction,
        name: name.to_owned(),
    };
    Ok((moved, words))
}

/// Joints and springs that move between two states, `limb: name`, the most first; what moves less
/// than 0.1 % of all is left out.
fn participation(posture: &Posture, from: &Placed, to: &Placed) -> Vec<Share> {
    let mut list = Vec::new();
    for (i, limb) in posture.mechanism().limbs().iter().enumerate() {
        let length = limb.nominal.scale().length;
        let pairs = from.coordinates[i].iter().zip(&to.coordinates[i]);
        for (coordinate, (a, b)) in limb.nominal.coordinates().iter().zip(pairs) {
            let motion = (b - a) / STEP;
            let size = match coordinate.kind {
                MotionKind::Prismatic => motion,
                MotionKind::Revolute => motion * length,
            };
            list.push(Share {
                name: format!("{}: {}", limb.name, coordinate.name),
                role: coordinate.role,
                kind: coordinate.kind,
                motion,
                share: size * size,
            });
        }
    }
    let total: f64 = list.iter().map(|s| s.share).sum();
    for share in &mut list {
        share.share /= total.max(f64::MIN_POSITIVE);
    }
    list.retain(|s| s.share > 1e-3);
    list.sort_by(|a, b| b.share.total_cmp(&a.share));
    list
}

/// Size of a small motion, m.
const STEP: f64 = 1e-6;

/// The machine, and the machine moved a little along a twist of the tool.
fn small_motion(
    posture: &Posture,
    stiffness: &kinetostat::UnloadedStiffness,
    twist: &Twist,
) -> Answer<(Placed, Placed)> {
    let mechanism = posture.mechanism();
    let small = Twist(twist.0 * STEP);
    let there = moved(posture.target(), &small);
    if mechanism.platforms().len() > 2 {
        // Mechanisms with platforms in between are held at both places; the rest follows.
        let from = posture.wrench_at(posture.target())?;
        let to = posture.wrench_at(&there)?;
        return Ok((
            Placed::solved(posture, &from.state),
            Placed::solved(posture, &to.state),
        ));
    }
    let from = Placed::at(posture);
    let mut to = from.clone();
    to.platforms[mechanism.tool()] = there;
    for (i, limb) in mechanism.limbs().iter().enumerate() {
        let arm = posture.target().rotation * limb.platform_from_tip.translation.vector;
        let shares = stiffness.limbs[i].participation(&limb.nominal, &small.shifted(&arm));
        for (x, share) in to.coordinates[i].iter_mut().zip(shares) {
            *x += share.motion;
        }
    }
    Ok((from, to))
}

/// The machine as built under its loads, from where it was commanded.
fn deflection(
    query: &PlaceQuery,
    posture: &Posture,
    scale: Option<f64>,
) -> Answer<(Moved, String)> {
    let e = posture.deflected_by(&query.wrench)?;
    let (force, moment) = (query.wrench.force(), query.wrench.moment());
    let mut parts = Vec::new();
    if force.norm() > 0.0 || moment.norm() == 0.0 {
        parts.push(format!("{} N", load_triple(force.into())));
    }
    if moment.norm() > 0.0 {
        parts.push(format!("{} N m", load_triple(moment.into())));
    }
    let shift = e.displacement.linear() * 1e3;
    let turn = e.displacement.angular().map(f64::to_degrees);
    let words = format!(
        "under {}: the tool moves by {} mm and turns by {} deg{}",
        parts.join(" and "),
        triple(shift.into(), |x| fixed(x, 4)),
        triple(turn.into(), |x| fixed(x, 4)),
        if e.stable() { "" } else { "; NOT STABLE" }
    );
    let magnified = scale.map_or(Magnified::Round, Magnified::Times);
    let moved = Moved::deflected(posture, &e.state, magnified);
    Ok((moved, words))
}
