//! A machine at home: mobility, what holds it, what its own loads do.

use kinetostat::number::counted;
use kinetostat::{
    DirectionKind, Kinematics, Mechanism, MechanismEquilibrium, Posture, Role, Wrench,
};
use kinetostat_machining::number as formatter;
use nalgebra::{DMatrix, Vector3};
use serde::Serialize;

use crate::check::assumptions::{AssumptionsFinding, assumptions};
use crate::check::limbs::LimbFinding;
use crate::check::{Findings, reach};
use crate::machine::unstable_joints::{Overcome, overcome};
use crate::stiffness::{Principal, principal, principals, uneven, what_moves};
use crate::ui::screen::{fixed, item, triple};

#[derive(Serialize)]
pub(crate) struct HomeFinding {
    pub(crate) mobility: usize,
    pub(crate) actuators: usize,
    pub(crate) degrees_of_over_constraint: usize,
    /// Sets of wrenches by which the limbs can strain each other without any load, about each
    /// limb's tip in base axes.
    pub(crate) over_constraints: Vec<String>,
    /// Independent ways in which actuators can move while the tool stays.
    pub(crate) redundant_motions: usize,
    /// Joints that move while both ends of their limb stay: `limb: joint`.
    pub(crate) redundant_actuators: Vec<String>,
    pub(crate) redundant_passive_joints: Vec<String>,
    pub(crate) correctable_directions: Vec<&'static str>,
    pub(crate) stiffness_rank: usize,
    pub(crate) principal_directions: Vec<Principal>,
    pub(crate) shift_without_load_mm: [f64; 3],
    pub(crate) rotation_without_load_deg: [f64; 3],
    pub(crate) largest_internal_force_n: f64,
    pub(crate) largest_internal_moment_n_m: f64,
    /// Every limb keeps its shape while the tool is held.
    pub(crate) shapes_stable: bool,
    /// The tool stays where it is.
    pub(crate) platform_stable: bool,
    /// Both.
    pub(crate) stable: bool,
    /// Under loads without a potential it does not go away, but may swing with growing amplitude.
    pub(crate) may_flutter: bool,
    /// Joints whose springs the loads beat; empty where it is stable.
    pub(crate) overcome_joints: Vec<Overcome>,
    pub(crate) conservative: bool,
    pub(crate) largest_share_to_buckling: Option<f64>,
}

const DIRECTIONS: [&str; 6] = [
    "x",
    "y",
    "z",
    "turn about x",
    "turn about y",
    "turn about z",
];

pub(crate) fn at_home(
    m: &Mechanism,
    posture: &Posture<'_>,
    force: Option<Vector3<f64>>,
    limbs: &mut [LimbFinding],
    load_names: &[Vec<String>],
) -> Result<(HomeFinding, AssumptionsFinding), String> {
    let stiffness = posture.stiffness().map_err(|e| e.to_string())?;
    for (i, found) in limbs.iter_mut().enumerate() {
        let k = &stiffness.limbs[i];
        found
            .redundant_passive_joints
            .clone_from(&k.redundant_passive);
        found.stiffness_rank = Some(k.rank);
        found.constrained_directions = alone(m, posture, i);
    }
    let mobility = posture.mobility().ncols();
    let correctable = posture.correctable();
    let rest = posture
        .deflected_by(&Wrench::zero())
        .map_err(|e| e.to_string())?;
    let over = posture.overconstraint();
    let mut assumptions = assumptions(posture, &rest, force);
    assumptions
        .warnings
        .extend(uneven(m, &stiffness.directions));
    let home = HomeFinding {
        mobility,
        actuators: m.actuator_count(),
        degrees_of_over_constraint: over.degree,
        over_constraints: over
            .stresses
            .iter()
            .map(|s| fight(&s.in_words(posture)))
            .collect(),
        redundant_motions: posture.redundancy(),
        redundant_actuators: (0..limbs.len())
            .flat_map(|i| redundant_actuators(m, posture, i))
            .collect(),
        redundant_passive_joints: limbs
            .iter()
            .flat_map(|l| {
                let joints = l.redundant_passive_joints.iter();
                joints.map(|j| format!("{}: {j}", l.name))
            })
            .collect(),
        correctable_directions: DIRECTIONS
            .iter()
            .zip(correctable)
            .filter_map(|(name, can)| can.then_some(*name))
            .collect(),
        stiffness_rank: stiffness.rank(),
        principal_directions: stiffness.directions.iter().map(principal).collect(),
        shift_without_load_mm: (rest.displacement.linear() * 1e3).into(),
        rotation_without_load_deg: rest.displacement.angular().map(f64::to_degrees).into(),
        largest_internal_force_n: largest(&rest, |w| w.force().norm()),
        largest_internal_moment_n_m: largest(&rest, |w| w.moment().norm()),
        shapes_stable: rest.shapes_stable(),
        platform_stable: rest.platform.stable,
        stable: rest.stable(),
        may_flutter: rest.may_flutter(),
        overcome_joints: overcome(posture, &rest, load_names),
        conservative: rest.conservative,
        largest_share_to_buckling: rest.share_to_buckling().filter(|m| m.is_finite()),
    };
    Ok((home, assumptions))
}

/// A set of wrenches in balance: `leg x with a moment about x, against leg z with a moment about x`.
fn fight(words: &str) -> String {
    let limbs = words.split("; ").map(|part| match part.split_once(": ") {
        Some((limb, wrench)) => {
            let wrench = wrench
                .replace("force", "a force")
                .replace("moment", "a moment");
            format!("{limb} with {wrench}")
        }
        None => part.to_owned(),
    });
    limbs.collect::<Vec<_>>().join(", against ")
}

/// Actuators of a limb that can move while both its ends stay, its passive joints following.
fn redundant_actuators(m: &Mechanism, posture: &Posture<'_>, index: usize) -> Vec<String> {
    let limb = &m.limbs()[index];
    let (chain, joints) = (&limb.nominal, &posture.limbs()[index]);
    let base = &posture.platforms()[limb.from];
    let k = Kinematics::new(chain, base, &joints.coordinates, &joints.commands, false);
    let all = k.jacobian(chain.tip());
    let n = chain.coordinate_count();
    let length = chain.scale().length;
    let passive = chain.indices_of(Role::Passive).into_iter();
    let own = (0..chain.actuators().len()).map(|a| n + a);
    let columns: Vec<usize> = own.chain(passive).collect();
    let count = columns.len();
    if count == 0 {
        return Vec::new();
    }
    let a = DMatrix::from_fn(6, count, |i, j| {
        all[(i, columns[j])] * if i < 3 { 1.0 } else { length }
    });
    // Motions that leave the end where it is are the zero directions of the square.
    let eigen = (a.transpose() * &a).symmetric_eigen();
    let zero = 1e-12 * eigen.eigenvalues.amax();
    let moves = |joint: usize| {
        (0..count)
            .filter(|&k| eigen.eigenvalues[k].abs() <= zero)
            .any(|k| eigen.eigenvectors[(joint, k)].abs() > 1e-6)
    };
    let actuators = chain.actuators().iter().enumerate();
    actuators
        .filter(|(i, _)| moves(*i))
        .map(|(_, a)| format!("{}: {}", limb.name, a.name))
        .collect()
}

fn largest(e: &MechanismEquilibrium, size: impl Fn(&Wrench) -> f64) -> f64 {
    e.limbs.iter().map(|l| size(&l.wrench)).fold(0.0, f64::max)
}

/// Directions of the tool that one limb alone leaves no motion in, links taken as rigid.
fn alone(m: &Mechanism, posture: &Posture<'_>, index: usize) -> Option<usize> {
    let mut builder = Mechanism::builder(m.name());
    for platform in m.platforms().iter().skip(1) {
        builder.platform(platform.clone());
    }
    if m.platforms().len() != 2 {
        return None;
    }
    let single = builder.limb(m.limbs()[index].clone()).build().ok()?;
    let own = single
        .posture_from_joints(posture.target(), vec![posture.limbs()[index].clone()])
        .ok()?;
    Some(6 - own.mobility().ncols())
}

pub(crate) fn home_in_words(f: &Findings, h: &HomeFinding) -> String {
    let mut out = String::from("\nAt home\n");
    let over = match h.degrees_of_over_constraint {
        0 => "no over-constraint: deviations shift the tool without straining the limbs".to_owned(),
        1 => "1 degree of over-constraint: deviations strain the limbs".to_owned(),
        n => format!("{n} degrees of over-constraint: deviations strain the limbs"),
    };
    out.push_str(&item(&format!(
        "mobility {} with {}; {over}",
        h.mobility,
        counted(h.actuators, "actuator")
    )));
    out.push_str(&fights(&h.over_constraints));
    out.push_str(&redundant(h));
    let all_rigid = h
        .principal_directions
        .iter()
        .all(|p| p.kind == DirectionKind::Rigid);
    out.push_str(&item(&match h.stiffness_rank {
        6 if all_rigid => {
            "rank 6: the tool is held in all directions, rigidly: the model has no springs there"
                .to_owned()
        }
        6 => "rank 6: springs hold the tool in all directions".to_owned(),
        rank => format!(
            "rank {rank}: no spring holds the tool in {} of 6 directions (see the table below)",
            6 - rank
        ),
    }));
    out.push_str(&item(&if h.mobility > h.actuators {
        format!(
            "{} of these motions no actuator holds",
            h.mobility - h.actuators
        )
    } else {
        format!(
            "the machine can correct by itself: {}",
            match h.correctable_directions.as_slice() {
                [] => "nothing".to_owned(),
                list => list.join(", "),
            }
        )
    }));
    let (shift, turn) = (h.shift_without_load_mm, h.rotation_without_load_deg);
    let causes: Vec<&str> = [
        ("its deviations", !f.deviations.is_empty()),
        ("its own weight", f.mass_kg > 0.0),
        (
            "the loads on its limbs",
            f.limbs.iter().any(|l| !l.loads.is_empty()),
        ),
        ("the loads on its platforms", !f.loads.is_empty()),
        (
            "its preloads",
            f.limbs.iter().any(|l| !l.preloaded_springs.is_empty()),
        ),
    ]
    .into_iter()
    .filter_map(|(cause, acts)| acts.then_some(cause))
    .collect();
    let cause = match causes.as_slice() {
        [] => "without load".to_owned(),
        ["its own weight"] => "under its own weight".to_owned(),
        ["its deviations"] => "by its deviations, without load".to_owned(),
        causes => format!("by {}", causes.join(" and ")),
    };
    let moved = shift.iter().chain(&turn).any(|x| x.abs() > 1e-9);
    if moved {
        let mut text = format!(
            "{cause} the tool is shifted by {} mm and turned by {} deg",
            triple(shift, |x| fixed(x, 5)),
            triple(turn, |x| fixed(x, 5)),
        );
        if f.limbs.len() > 1 {
            text.push_str(&format!(
                "; inside, up to {} N and {} N m act on the limbs' ends",
                fixed(h.largest_internal_force_n, 3),
                fixed(h.largest_internal_moment_n_m, 4),
            ));
        }
        out.push_str(&item(&text));
    } else {
        out.push_str(&item("without load the tool is where it is commanded"));
    }
    out.push_str(&item(&match (h.stable, h.largest_share_to_buckling) {
        (true, _) if h.may_flutter => {
            "it does not go away, but may swing with growing amplitude (flutter), which depends on its masses".to_owned()
        }
        (true, Some(mu)) if mu.abs() > 1e-9 && h.stiffness_rank == 6 => {
            format!(
                "stable; largest share of the way to buckling {}",
                formatter::share(mu)
            )
        }
        (true, _) if h.stiffness_rank < 6 => format!(
            "stable where it is held; {} of 6 directions are free",
            6 - h.stiffness_rank
        ),
        (true, _) => "stable".to_owned(),
        (false, _) if h.shapes_stable => {
            "NOT STABLE: the limbs keep their shapes, but the tool does not stay".to_owned()
        }
        (false, _) => "NOT STABLE: it would jump to another shape".to_owned(),
    }));
    for joint in &h.overcome_joints {
        out.push_str(&item(&joint.in_words()));
    }
    if !h.conservative {
        out.push_str(&item(
            "not conservative: a load on a limb has no potential, so that nothing is said of flutter, which depends on the masses",
        ));
    }
    if let Some(reach) = &f.reach {
        out.push_str(&reach::in_words(reach));
    }
    if !f.deviations.is_empty() {
        out.push_str("\nDeviations\n");
        for d in &f.deviations {
            out.push_str(&item(d));
        }
    }
    out.push_str(&format!(
        "\nStiffness at home, unloaded: {} of 6 directions\n\n",
        h.stiffness_rank
    ));
    out.push_str(&principals(&h.principal_directions));
    let loose = |p: &&Principal| p.kind != DirectionKind::Finite;
    if h.principal_directions.iter().any(|p| loose(&p)) {
        out.push_str("\nWhat moves, and what nothing moves\n");
        h.principal_directions
            .iter()
            .filter(loose)
            .for_each(|p| out.push_str(&what_moves(p)));
    }
    out
}

/// Most sets of wrenches shown; the JSON has all.
const FIGHTS: usize = 6;

fn fights(list: &[String]) -> String {
    let mut out = String::new();
    for (i, one) in list.iter().take(FIGHTS).enumerate() {
        out.push_str(&item(&format!("over-constraint {}: {one}", i + 1)));
    }
    if list.len() > FIGHTS {
        out.push_str(&item(&format!(
            "and {} more over-constraints; --json has them all",
            list.len() - FIGHTS
        )));
    }
    out
}

fn redundant(h: &HomeFinding) -> String {
    let mut out = String::new();
    let list = |names: &[String]| {
        const NAMES: usize = 8;
        let shown = names.iter().take(NAMES).cloned().collect::<Vec<_>>();
        match names.len().saturating_sub(NAMES) {
            0 => shown.join(", "),
            more => format!("{} and {more} more", shown.join(", ")),
        }
    };
    match (h.redundant_motions, h.redundant_actuators.as_slice()) {
        (0, []) => {}
        (0, names) => out.push_str(&item(&format!(
            "can move while both ends of their limb stay: {}",
            list(names)
        ))),
        (n, []) => out.push_str(&item(&format!(
            "{n} of the actuators' motions leave the tool where it is (redundant, shared by several limbs): of all commands the ones nearest to home are taken"
        ))),
        (n, names) => out.push_str(&item(&format!(
            "{n} of the actuators' motions leave the tool where it is (redundant): {} move then; of all commands those of least motion are taken",
            list(names)
        ))),
    }
    match h.redundant_passive_joints.as_slice() {
        [] if out.is_empty() => out.push_str(&item("no joint is redundant")),
        [] => {}
        names => out.push_str(&item(&format!(
            "redundant passive joints, which move while the ends of their limb are held: {}",
            list(names)
        ))),
    }
    out
}
