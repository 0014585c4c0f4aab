//! The machine at home, in words.

use kinetostat::DirectionKind;
use kinetostat::number::counted;
use kinetostat_machining::number as formatter;

use crate::check::model::findings::Findings;
use crate::check::model::home::HomeFinding;
use crate::check::model::reach;
use crate::machine::principal_directions::{Principal, principals, what_moves};
use crate::ui::layout::item;
use crate::ui::numbers::{fixed, triple};

pub(crate) fn home_text(f: &Findings, h: &HomeFinding) -> String {
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
    out.push_str(&over_constraints_text(&h.over_constraints));
    out.push_str(&redundant(h));
    out.push_str(&held(h));
    out.push_str(&item(&at_rest(f, h)));
    out.push_str(&item(&stability(h)));
    for joint in &h.overcome_joints {
        out.push_str(&item(&joint.description()));
    }
    if !h.conservative {
        out.push_str(&item(
            "not conservative: a load on a limb has no potential, so that nothing is said of flutter, which depends on the masses",
        ));
    }
    if let Some(reach) = &f.reach {
        out.push_str(&reach::reach_text(reach));
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

/// Describes the constraint by springs and the corrections by actuators.
fn held(h: &HomeFinding) -> String {
    let mut out = String::new();
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
    out
}

/// Describes the pose of the unloaded tool.
fn at_rest(f: &Findings, h: &HomeFinding) -> String {
    let (shift, turn) = (h.shift_without_load_mm, h.rotation_without_load_deg);
    let moved = shift.iter().chain(&turn).any(|x| x.abs() > 1e-9);
    if !moved {
        return "without load the tool is where it is commanded".to_owned();
    }
    let mut text = format!(
        "{} the tool is shifted by {} mm and turned by {} deg",
        causes(f),
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
    text
}

/// Lists the causes of tool motion without a load on it.
fn causes(f: &Findings) -> String {
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
    match causes.as_slice() {
        [] => "without load".to_owned(),
        ["its own weight"] => "under its own weight".to_owned(),
        ["its deviations"] => "by its deviations, without load".to_owned(),
        causes => format!("by {}", causes.join(" and ")),
    }
}

fn stability(h: &HomeFinding) -> String {
    match (h.stable, h.largest_share_to_buckling) {
        (true, _) if h.may_flutter => {
            "it does not diverge, but may swing with growing amplitude (flutter), which depends on its masses".to_owned()
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
    }
}

/// Upper limit of the sets of wrenches shown; the JSON has all.
const MOST_OVER_CONSTRAINTS: usize = 6;

fn over_constraints_text(list: &[String]) -> String {
    let mut out = String::new();
    for (i, one) in list.iter().take(MOST_OVER_CONSTRAINTS).enumerate() {
        out.push_str(&item(&format!("over-constraint {}: {one}", i + 1)));
    }
    if list.len() > MOST_OVER_CONSTRAINTS {
        out.push_str(&item(&format!(
            "and {} more over-constraints; --json has them all",
            list.len() - MOST_OVER_CONSTRAINTS
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
