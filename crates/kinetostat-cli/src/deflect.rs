//! `kinetostat deflect`: how far the tool is off, at one place or along a program.

use std::path::Path;

use kinetostat::{
    DirectionKind, FoundBy, LoadLimit, Mechanism, MechanismEquilibrium, MotionKind, Posture, Wrench,
};
use kinetostat_machining::{NearSingular, Warning, WarningCode, number as formatter};
use serde::Serialize;

use crate::along::{self, Aim, Files as Targets, tell};
use crate::args::DeflectArgs;
use crate::failure::{Answer, Failure};
use crate::faults::{Asked, with_all_others};
use crate::free_machine::{Nearness, way_to};
use crate::input::Files;
use crate::job::looks_like_a_job;
use crate::joints::{self, JointValue};
use crate::machine::{machine, no_potential, of_model, with_smells};
use crate::output::{Existing, Outputs};
use crate::overcome::{Overcome, overcome};
use crate::place::{Spot, spot};
use crate::screen::{self, Stream, columns, fixed, number, triple, wrapped};
use crate::setting::{JobFile, WritingFlags, setting};
use crate::stiffness::motion_in_words;
use crate::summary;

pub(crate) fn run(args: DeflectArgs) -> Answer<()> {
    let subject = Path::new(&args.subject);
    let is_job = !args.place.given()
        && subject.is_file()
        && Files::default()
            .job(subject)
            .is_ok_and(|t| looks_like_a_job(&t));
    if is_job || args.program.program.is_some() {
        if args.place.given() {
            return Err(Failure::input(
                "--at, --joints and --pendant ask for one place, --program for all of a program: keep one of them",
            ));
        }
        return along_program(&args, is_job).map_err(|failure| {
            let asked = Asked {
                job: is_job.then_some(subject),
                model: None,
                program: &args.program,
                writing: WritingFlags::default(),
            };
            with_all_others(&Files::default(), &asked, failure)
        });
    }
    at_place(&args)
}

fn along_program(args: &DeflectArgs, is_job: bool) -> Answer<()> {
    let files = Files::default();
    let job = is_job
        .then(|| JobFile::read(&files, Path::new(&args.subject)))
        .transpose()?;
    let named = (!is_job).then_some(args.subject.as_str());
    let flags = WritingFlags {
        json: args.json.as_deref(),
        ..WritingFlags::default()
    };
    let mut setting = setting(&files, job.as_ref(), &args.program, &flags)?;
    let mut chosen = setting.targets.clone();
    // The job's outputs are those of the compensation: an analysis writes what is named here.
    chosen.report.clone_from(&args.program.report);
    chosen.points.clone_from(&args.program.points);
    chosen.json = args.json.clone().filter(|p| p != Path::new("-"));
    let existing = existing(args);
    let (machine, model) = machine(
        &files,
        job.as_ref(),
        named,
        &args.program,
        &mut setting.inputs,
    )?;
    along::read_program(&setting)?;
    let mut targets = Targets::claim(Aim::Analyse, &chosen, existing, &setting.inputs)?;
    let mut run = along::solve(Aim::Analyse, &machine, &setting, args.program.threads)
        .map_err(|failure| with_smells(failure, &model))?;
    run.result.warnings.extend(of_model(&model));
    run.result.warnings.extend(no_potential(&model.mechanism));
    let odd = job.iter().flat_map(|job| job.odd_angles());
    run.result.warnings.extend(odd);
    targets.list(args.program.all_points, &model);
    targets.fill(&run)?;
    let note = targets.note(&run);
    let paths = targets.outputs.commit()?;
    let text = format!(
        "{}{}{note}",
        summary::of_run(&run.result),
        along::written(&paths)
    );
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    tell(&text, to_screen.then_some(&run.result))
}

fn existing(args: &DeflectArgs) -> Existing {
    if args.program.force_overwrite {
        Existing::Replace
    } else {
        Existing::Refuse
    }
}

/// The answer at one place, stable names with units.
#[derive(Serialize)]
struct Deflection {
    schema: u32,
    kinetostat_version: &'static str,
    model: String,
    model_source: String,
    tool: String,
    place: PlaceAsked,
    force_n: [f64; 3],
    moment_n_m: [f64; 3],
    displacement_mm: [f64; 3],
    displacement_size_mm: f64,
    rotation_vector_deg: [f64; 3],
    rotation_size_deg: f64,
    actuators: Vec<ActuatorAnswer>,
    /// What the controller shows, in the order of its axes; empty without a section `controller`.
    pendant: Vec<JointValue>,
    limbs: Vec<LimbAnswer>,
    /// Against a force in the softest direction, the tool free to turn; none if no force moves it.
    smallest_stiffness_n_per_mm: f64,
    free_directions: usize,
    /// Motions by which the tool runs away by itself: `turns about z by arm: q`.
    negative_directions: Vec<String>,
    /// The tool stays where it is, or does not go away at least (see `platform_may_flutter`).
    platform_stable: bool,
    /// Under loads without a potential the tool does not go away, but may swing with growing amplitude.
    platform_may_flutter: bool,
    /// How near the load brings the machine with its tool free to instability, 1 is there: never less
    /// than the largest share of its limbs. At least 1 or none where it is not stable; behind a snap
    /// the share of the equilibrium told here.
    share_to_instability_of_free_machine: Option<f64>,
    /// The same where the limbs do not tell it.
    #[serde(skip)]
    free_beyond_limbs: Option<f64>,
    /// The load cannot be reached from rest without a snap.
    #[serde(skip)]
    snapped: bool,
    /// Every limb keeps its shape while the tool is held.
    shapes_stable: bool,
    /// Both.
    stable: bool,
    /// Joints whose springs the loads beat; empty where it is stable.
    overcome_joints: Vec<Overcome>,
    /// All loads have a potential; if not, see the reasons.
    conservative: bool,
    not_conservative_because: Vec<String>,
    /// Of springs, weights and loads on limbs, without the load on the tool; none without a
    /// potential. Its zero is arbitrary.
    energy_j: Option<f64>,
    converged: bool,
    iterations: usize,
    /// How the equilibrium was found, where it was not directly from the commanded posture.
    #[serde(skip_serializing_if = "Option::is_none")]
    found_by: Option<FoundBy>,
    /// Last correction of the iteration by the one before it; none with fewer than two.
    rate_observed: Option<f64>,
    /// How far the loops are from closing; rotations at the machine's length.
    closure_mm: f64,
    /// The nearest singular posture, where one is near.
    near_singularity: Option<NearSingular>,
    warnings: Vec<Warning>,
}

/// Where it was asked.
#[derive(Serialize)]
pub(crate) struct PlaceAsked {
    pub(crate) position_mm: [f64; 3],
    pub(crate) rotation_vector_deg: [f64; 3],
    /// Where the orientation follows: how far the tool has turned from the one it is kept near to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) tool_turn_deg: Option<f64>,
    pub(crate) axes: &'static str,
    pub(crate) reference_point: &'static str,
}

#[derive(Serialize)]
struct ActuatorAnswer {
    name: String,
    command: f64,
    command_unit: &'static str,
    force: f64,
    force_unit: &'static str,
}

#[derive(Serialize)]
struct LimbAnswer {
    name: String,
    force_n: [f64; 3],
    moment_n_m: [f64; 3],
    force_without_load_n: [f64; 3],
    moment_without_load_n_m: [f64; 3],
    stable: bool,
    /// None without inner freedom; also where a passive motion is pushed out of line (then unstable).
    share_to_buckling: Option<f64>,
    neutral_passive_joints: Vec<String>,
    links: Vec<LinkAnswer>,
}

/// How a link is loaded along its axis.
#[derive(Serialize)]
struct LinkAnswer {
    name: String,
    /// Of its most compressed segment; negative compresses.
    axial_force_n: f64,
    /// Both ends pinned, in its softer plane.
    euler_load_n: f64,
    /// Compression as a share of the Euler load; zero in tension.
    share_of_euler_load: f64,
}

/// Why nothing is told of a place where the machine's own loads find no equilibrium.
fn without_load(error: kinetostat::Error) -> Failure {
    match &error {
        kinetostat::Error::NotConverged {
            place,
            load_factor,
            limit: None,
            ..
        } => Failure::unanswered(format!(
            "{place}: without any load on the tool, weights, preloads and deviations of the model lead from the commanded place to no equilibrium (only {} of them could be followed); check them, or let `kinetostat equilibria` search for the shapes that the machine can take",
            kinetostat_machining::number::share(*load_factor)
        )),
        _ => error.into(),
    }
}

fn at_place(args: &DeflectArgs) -> Answer<()> {
    refuse_program_flags(args)?;
    let files = Files::default();
    let spot = spot(
        &files,
        &args.subject,
        &args.place,
        args.program.tool_length_mm,
        args.program.force.as_deref(),
        args.program.moment.as_deref(),
    )?;
    let posture = spot.posture()?;
    let rest = posture.deflected_by(&Wrench::zero());
    let rest = rest.map_err(without_load)?;
    let loaded = posture.deflected_by(&spot.wrench)?;
    let limit = posture.snaps_on_the_way(&rest, &loaded)?;
    let mut answer = answer(&spot, &posture, &loaded, &rest, limit.is_some());
    answer.warnings.extend(limit.as_ref().map(snaps));
    let text = in_words(&spot, &answer);
    let to_screen = args.json.as_deref() == Some(Path::new("-"));
    let mut paths = Vec::new();
    if let Some(path) = args.json.as_deref().filter(|_| !to_screen) {
        let mut outputs = Outputs::new(existing(args), spot.inputs.clone());
        let index = outputs.claim("result", path)?;
        outputs.fill(index, along::json(&answer)?.as_bytes())?;
        paths = outputs.commit()?;
    }
    if to_screen {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(along::json(&answer)?.as_bytes());
    }
    screen::print(Stream::Out, &format!("{text}{}", along::written(&paths)))
}

/// From this rate of the last corrections on, an iteration is slow.
const SLOW: f64 = 0.2;

/// A displacement by this share of the machine's size is no deflection any more.
const LARGE: f64 = 0.05;

/// The tool moves by `far`, which is no deflection any more of a machine of this size, m.
pub(crate) fn folds(far: f64, size: f64) -> Option<Warning> {
    (far > LARGE * size).then(|| {
        Warning::new(WarningCode::LargeDisplacement, format!(
            "the tool moves by {} % of the machine's size: the machine folds over under this load; check the force and the stiffnesses",
            number(100.0 * far / size, 2)
        ))
    })
}

/// The answer lies beyond a limit point of the load.
pub(crate) fn snaps(limit: &LoadLimit) -> Warning {
    let d = 1e3 * limit.displacement.linear();
    let said = format!(
        "the machine SNAPS on the way to this load: from rest it carries only {} of it, up to a limit point of the load at {} mm; what is told here is another equilibrium behind it. `kinetostat curve` shows the way, `kinetostat equilibria` all of them",
        number(limit.share, 4),
        triple(d.into(), |x| fixed(x, 4))
    );
    Warning::new(WarningCode::Snaps, said)
}

/// Options that say something about a program are not dropped silently.
fn refuse_program_flags(args: &DeflectArgs) -> Answer<()> {
    let p = &args.program;
    let given = [
        ("--report", p.report.is_some()),
        ("--points", p.points.is_some()),
        ("--all-points", p.all_points),
        ("--milling", p.milling.is_some()),
        ("--part-origin-mm", p.part_origin_mm.is_some()),
        ("--part-orientation", p.part_orientation.is_some()),
        ("--tool-orientation", p.tool_orientation.is_some()),
        ("--below-z-mm", p.below_z_mm.is_some()),
        ("--load-axes", p.load_axes.is_some()),
        ("--load-at-corners", p.load_at_corners.is_some()),
        ("--scale", p.scale.is_some()),
        ("--units", p.units.is_some()),
        ("--arc-tolerance", p.arc_tolerance.is_some()),
        ("--work-offset", !p.work_offset.is_empty()),
        ("--block-delete", p.block_delete.is_some()),
        ("--axes-stand-still", p.axes_stand_still),
        ("--start-position-mm", p.start_position_mm.is_some()),
        ("--chord-tolerance-um", p.chord_tolerance_um.is_some()),
        ("--limit", !p.limits.is_empty()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((name, _)) => Err(Failure::input(format!(
            "{name} belongs to a run along a program; name the program with --program FILE or give a job file"
        ))),
        None => Ok(()),
    }
}

fn answer(
    spot: &Spot,
    posture: &Posture<'_>,
    loaded: &MechanismEquilibrium,
    rest: &MechanismEquilibrium,
    snapped: bool,
) -> Deflection {
    let shift = loaded.displacement.linear() * 1e3;
    let turn = loaded.displacement.angular().map(f64::to_degrees);
    let mut warnings = spot.warnings.clone();
    let near_singularity = spot.near_singular();
    warnings.extend(near_singularity.iter().map(NearSingular::warning));
    if loaded.platform.free > 0 {
        warnings.push(Warning::new(
            WarningCode::FreeDirection,
            format!(
                "the machine has {} without any stiffness here: see `kinetostat stiffness`",
                formatter::counted(loaded.platform.free, "direction")
            ),
        ));
    }
    let nearness = Nearness::of(posture, loaded);
    if !loaded.stable() {
        warnings.push(Warning::new(
            WarningCode::NotStable,
            "the machine does NOT stay in its shape under this load",
        ));
    } else if nearness.near() {
        let said = nearness.in_words(true);
        warnings.push(Warning::new(WarningCode::NearBuckling, said));
    }
    warnings.extend(folds(1e-3 * shift.norm(), spot.mechanism.size()));
    Deflection {
        schema: 3,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: spot.name.clone(),
        model_source: spot.source.clone(),
        tool: spot.tool_words.clone(),
        place: spot.asked(),
        force_n: spot.wrench.force().into(),
        moment_n_m: spot.wrench.moment().into(),
        displacement_mm: shift.into(),
        displacement_size_mm: shift.norm(),
        rotation_vector_deg: turn.into(),
        rotation_size_deg: turn.norm(),
        actuators: actuators(&spot.mechanism, posture, &loaded.actuator_forces()),
        pendant: spot.on_pendant(posture),
        limbs: loaded
            .limbs
            .iter()
            .zip(&rest.limbs)
            .map(|(l, r)| LimbAnswer {
                name: l.name.clone(),
                force_n: l.wrench.force().into(),
                moment_n_m: l.wrench.moment().into(),
                force_without_load_n: r.wrench.force().into(),
                moment_without_load_n_m: r.wrench.moment().into(),
                stable: l.stability.stable,
                share_to_buckling: l.stability.share_to_buckling.filter(|m| m.is_finite()),
                neutral_passive_joints: l.stability.neutral.clone(),
                links: l
                    .link_loads
                    .iter()
                    .map(|link| LinkAnswer {
                        name: link.link.clone(),
                        axial_force_n: link.axial_force,
                        euler_load_n: link.euler_load,
                        share_of_euler_load: link.share,
                    })
                    .collect(),
            })
            .collect(),
        smallest_stiffness_n_per_mm: 1e-3 * loaded.stiffness_against_force(),
        free_directions: loaded.platform.free,
        negative_directions: loaded
            .directions
            .iter()
            .filter(|d| d.kind == DirectionKind::Negative)
            .map(motion_in_words)
            .collect(),
        platform_stable: loaded.platform.stable,
        platform_may_flutter: loaded.platform.may_flutter,
        share_to_instability_of_free_machine: nearness.free,
        free_beyond_limbs: nearness.free_beyond_limbs(),
        snapped,
        shapes_stable: loaded.shapes_stable(),
        stable: loaded.stable(),
        overcome_joints: overcome(posture, loaded, &spot.load_names),
        conservative: loaded.conservative,
        not_conservative_because: not_conservative(loaded),
        energy_j: loaded.energy,
        converged: true,
        iterations: loaded.residual.iterations,
        found_by: Some(loaded.found_by).filter(|by| *by != FoundBy::Directly),
        rate_observed: loaded.residual.rate,
        closure_mm: 1e3 * loaded.residual.closure_m,
        near_singularity,
        warnings,
    }
}

/// Why statements about energy do not hold.
fn not_conservative(e: &MechanismEquilibrium) -> Vec<String> {
    let limbs = e.limbs.iter().filter(|l| !l.conservative);
    let mut reasons: Vec<String> = limbs
        .map(|l| format!("a load on limb '{}' has no potential", l.name))
        .collect();
    if reasons.is_empty() && !e.conservative {
        reasons.push(
            "the moment on the tool keeps its direction while the tool can turn about several axes"
                .to_owned(),
        );
    }
    reasons
}

fn actuators(mechanism: &Mechanism, posture: &Posture<'_>, forces: &[f64]) -> Vec<ActuatorAnswer> {
    let kinds = mechanism
        .limbs()
        .iter()
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind));
    mechanism
        .actuator_names()
        .into_iter()
        .zip(kinds)
        .zip(posture.commands())
        .zip(forces)
        .map(|(((name, kind), command), force)| {
            let (factor, command_unit, force_unit) = match kind {
                MotionKind::Prismatic => (1e3, "mm", "N"),
                MotionKind::Revolute => (1_f64.to_degrees(), "deg", "N m"),
            };
            ActuatorAnswer {
                name,
                command: factor * command,
                command_unit,
                force: *force,
                force_unit,
            }
        })
        .collect()
}

fn in_words(spot: &Spot, a: &Deflection) -> String {
    let mut out = spot.heading();
    out.push_str(&wrapped(
        &format!(
            "The tool's tip moves by {} and turns by {}.",
            formatter::length(a.displacement_size_mm, 4, formatter::Rounding::Nearest),
            formatter::angle(a.rotation_size_deg, 4, formatter::Rounding::Nearest)
        ),
        2,
    ));
    if let Some(by) = a.found_by.filter(|by| by.may_be_another_branch()) {
        let said = by.sentence();
        out.push_str(&wrapped(&format!("Note: {said}."), 2));
    }
    out.push('\n');
    let row = |name: &str, v: [f64; 3], decimals: usize, unit: &str| {
        let mut cells = vec![format!("{name}, {unit}")];
        let most = v.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        // With fixed places a small load, or what it does, would be shown as nothing.
        let small = most > 0.0 && most < 10.0_f64.powf(1.0 - decimals as f64);
        cells.extend(v.iter().map(|x| match small {
            true => number(*x, 4),
            false => fixed(*x, decimals),
        }));
        cells
    };
    out.push_str(&columns(
        &[
            ["base axes", "x", "y", "z"].map(str::to_owned).to_vec(),
            row("force on the tool", a.force_n, 3, "N"),
            row("moment about its tip", a.moment_n_m, 3, "N m"),
            row("displacement of the tip", a.displacement_mm, 6, "mm"),
            row("rotation vector", a.rotation_vector_deg, 6, "deg"),
        ],
        2,
    ));
    out.push('\n');
    let mut rows = vec![
        ["actuator", "command", "", "force", ""]
            .map(str::to_owned)
            .to_vec(),
    ];
    for x in &a.actuators {
        rows.push(vec![
            x.name.clone(),
            fixed(x.command, 4),
            x.command_unit.to_owned(),
            fixed(x.force, 3),
            x.force_unit.to_owned(),
        ]);
    }
    match a.actuators.as_slice() {
        [] => out.push_str("The machine has no actuators.\n"),
        _ => out.push_str(&columns(&rows, 2)),
    }
    out.push_str(&joints::in_words("On the pendant", &a.pendant));
    out.push_str("\nStability\n");
    for limb in &a.limbs {
        out.push_str(&screen::item(&limb_in_words(limb)));
    }
    let platform = if a.platform_may_flutter {
        let ways = match a.negative_directions.as_slice() {
            [] => String::new(),
            list => format!(
                ", as its stiffness is not positive where it {}",
                list.join("; it ")
            ),
        };
        format!(
            "the platform does not go away, but may swing with growing amplitude (flutter), which depends on its masses{ways}"
        )
    } else if !a.platform_stable {
        match a.negative_directions.as_slice() {
            [] => "the platform does NOT stay: one in between has negative stiffness".to_owned(),
            list => format!(
                "the platform does NOT stay, its stiffness is negative: it {}",
                list.join("; it ")
            ),
        }
    } else if a.free_directions > 0 {
        format!(
            "the platform stays, but without any stiffness in {}",
            formatter::counted(a.free_directions, "direction")
        )
    } else {
        match a.smallest_stiffness_n_per_mm.is_finite() {
            true => format!(
                "the platform stays; its smallest stiffness against a force is {} N/mm",
                number(a.smallest_stiffness_n_per_mm, 4)
            ),
            false => "the platform stays; no force moves it".to_owned(),
        }
    };
    out.push_str(&screen::item(&platform));
    if let Some(share) = a.free_beyond_limbs.filter(|_| a.stable) {
        let of = match a.snapped {
            true => "this equilibrium behind the snap, with the tool free,",
            false => "the machine with its tool free",
        };
        out.push_str(&screen::item(&format!(
            "{of} is {} % of the way to {}",
            number(100.0 * share, 3),
            way_to(a.conservative)
        )));
    }
    for joint in &a.overcome_joints {
        out.push_str(&screen::item(&joint.in_words()));
    }
    if !a.conservative {
        out.push_str(&screen::item(&format!(
            "not conservative: {}; where the symmetric part of the stiffness is positive, nothing goes away, whatever the masses are; beyond, something goes away for all masses where the determinant is negative or that part is negative in every motion; flutter depends on masses and damping",
            a.not_conservative_because.join(", ")
        )));
    }
    out.push_str(&links(a));
    out.push_str(&internal(a));
    // Newton's corrections fall faster and faster; where they do not, something is singular nearby.
    if let Some(rate) = a.rate_observed.filter(|rate| *rate > SLOW) {
        out.push('\n');
        out.push_str(&wrapped(
            &format!(
                "The iteration ended slowly, its last correction {} of the one before: a limit of the load or a change of shape is near.",
                number(rate, 2)
            ),
            2,
        ));
    }
    out.push_str(&summary::warnings(&a.warnings));
    out
}

/// Where a share of the way leads: without a potential only the bound is known below which all is well
/// (see [`kinetostat::CriticalLoad::definite_until`]).
fn limb_in_words(limb: &LimbAnswer) -> String {
    let share = match limb.share_to_buckling {
        Some(mu) if mu.abs() < 1e-6 => "no load bends or buckles it".to_owned(),
        Some(mu) if mu < 0.0 => format!("{}: the load stretches it", formatter::share(mu)),
        Some(mu) => format!("{} of the way to buckling", formatter::share(mu)),
        None if limb.stable => "it has no inner freedom that could buckle".to_owned(),
        None => "a passive joint is pushed out of line".to_owned(),
    };
    let verdict = match limb.stable {
        // Only loads without a potential are stable beyond one.
        true if limb.share_to_buckling.is_some_and(|mu| mu > 1.0) => {
            "does not go away, but may swing with growing amplitude (flutter), which depends on its masses"
        }
        true => "keeps its shape",
        false => "does NOT keep its shape: it snaps to another one",
    };
    let neutral = if limb.neutral_passive_joints.is_empty() {
        String::new()
    } else {
        format!(
            "; {} can turn for nothing",
            limb.neutral_passive_joints.join(", ")
        )
    };
    format!("limb '{}' {verdict} ({share}){neutral}", limb.name)
}

/// Axial loads of the links.
fn links(a: &Deflection) -> String {
    let single = a.limbs.len() == 1;
    let mut rows = vec![
        ["link", "axial force, N", "Euler load, N", "share of it"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for (limb, link) in a
        .limbs
        .iter()
        .flat_map(|l| l.links.iter().map(move |k| (l, k)))
    {
        rows.push(vec![
            match single {
                true => link.name.clone(),
                false => format!("{}: {}", limb.name, link.name),
            },
            fixed(link.axial_force_n, 3),
            number(link.euler_load_n, 4),
            formatter::share(link.share_of_euler_load),
        ]);
    }
    if rows.len() == 1 {
        return String::new();
    }
    format!(
        "\n{}{}",
        columns(&rows, 2),
        wrapped(
            "Negative forces compress; the Euler load is that of the link pinned at both ends, in its softer plane.",
            2
        )
    )
}

/// What the limbs do to each other through the platform without any load on the tool.
fn internal(a: &Deflection) -> String {
    let size = |v: &[f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let any = a
        .limbs
        .iter()
        .any(|l| size(&l.force_without_load_n) > 1e-6 || size(&l.moment_without_load_n_m) > 1e-6);
    if !any {
        return String::new();
    }
    let mut rows = vec![
        [
            "without load on the tool",
            "force on its end, N",
            "moment, N m",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    for l in &a.limbs {
        rows.push(vec![
            format!("limb '{}'", l.name),
            triple(l.force_without_load_n, |x| fixed(x, 3)),
            triple(l.moment_without_load_n_m, |x| fixed(x, 4)),
        ]);
    }
    format!("\n{}", columns(&rows, 2))
}
