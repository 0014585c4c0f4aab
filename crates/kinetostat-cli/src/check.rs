//! `kinetostat check`: what a model file says, in words, and what looks wrong.

use std::path::Path;

use kinetostat::{
    DirectionKind, Mechanism, MechanismEquilibrium, MotionKind, Posture, Role, Wrench,
};
use kinetostat_model::Model;
use kinetostat_model::schema::{Convention, Element};
use serde::Serialize;

use crate::along;
use crate::args::CheckArgs;
use crate::failure::Answer;
use crate::input::Files;
use crate::machine::{deviations_in_words, short};
use crate::screen::{self, Stream, fixed, item, number, triple, wrapped};
use crate::stiffness::{Principal, principal, principals, what_moves};

/// Findings, stable names with units.
#[derive(Serialize)]
struct Findings {
    schema: u32,
    kinetostat_version: &'static str,
    model: String,
    model_source: String,
    description: Option<String>,
    gravity_m_per_s2: [f64; 3],
    platforms: Vec<PlatformFinding>,
    limbs: Vec<LimbFinding>,
    mass_kg: f64,
    deviations: Vec<String>,
    home: Option<HomeFinding>,
    /// Why nothing could be solved at home.
    home_problem: Option<String>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct PlatformFinding {
    name: String,
    home_position_mm: [f64; 3],
    home_rotation_vector_deg: [f64; 3],
    mass_kg: f64,
    carries_the_tool: bool,
}

#[derive(Serialize)]
struct LimbFinding {
    name: String,
    from: String,
    to: String,
    actuators: Vec<ActuatorFinding>,
    passive_joints: Vec<String>,
    springs: Vec<String>,
    spring_coordinates: usize,
    preloaded_springs: Vec<String>,
    links: Vec<LinkFinding>,
    loads: Vec<LoadFinding>,
    bodies: Vec<String>,
    mass_kg: f64,
    redundant_passive_joints: Vec<String>,
    /// Directions of the tool that this limb blocks for rigid links.
    constrained_directions: Option<usize>,
    stiffness_rank: Option<usize>,
}

/// An elastic link.
#[derive(Serialize)]
struct LinkFinding {
    name: String,
    length_mm: f64,
    segments: usize,
    convention: Convention,
    /// Pinned at both ends, in its softer plane.
    euler_load_n: f64,
}

/// A load on a limb.
#[derive(Serialize)]
struct LoadFinding {
    name: String,
    kind: &'static str,
    in_words: String,
    conservative: bool,
}

#[derive(Serialize)]
struct ActuatorFinding {
    name: String,
    kind: &'static str,
    unit: &'static str,
    home: f64,
    limits: Option<[f64; 2]>,
    rigid_drive: bool,
}

#[derive(Serialize)]
struct HomeFinding {
    mobility: usize,
    actuators: usize,
    degrees_of_over_constraint: Option<usize>,
    correctable_directions: Vec<&'static str>,
    stiffness_rank: usize,
    principal_directions: Vec<Principal>,
    shift_without_load_mm: [f64; 3],
    rotation_without_load_deg: [f64; 3],
    largest_internal_force_n: f64,
    largest_internal_moment_n_m: f64,
    /// Every limb keeps its shape while the tool is held.
    shapes_stable: bool,
    /// The tool stays where it is.
    platform_stable: bool,
    /// Both.
    stable: bool,
    conservative: bool,
    largest_buckling_margin: Option<f64>,
}

pub(crate) fn run(args: &CheckArgs) -> Answer<()> {
    let (model, path) = Files::default().model(&args.model, Path::new(""))?;
    let source = match path {
        Some(_) => args.model.clone(),
        None => format!("preset {}", args.model),
    };
    let findings = findings(&model, source);
    let text = in_words(&findings, &model);
    if args.json {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(along::json(&findings)?.as_bytes());
    }
    screen::print(Stream::Out, &text)
}

fn findings(model: &Model, source: String) -> Findings {
    let m = &model.mechanism;
    let home = m.platforms()[m.tool()].home;
    let posture = m.posture(&home);
    let mut limbs: Vec<LimbFinding> = (0..m.limbs().len()).map(|i| limb(model, i)).collect();
    let solved = posture
        .as_ref()
        .map_err(ToString::to_string)
        .and_then(|p| at_home(m, p, &mut limbs));
    let (home, home_problem) = match solved {
        Ok(found) => (Some(found), None),
        Err(reason) => (None, Some(reason)),
    };
    Findings {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: model.name().to_owned(),
        model_source: source,
        description: model.document.mechanism.description.clone(),
        gravity_m_per_s2: m.gravity().into(),
        mass_kg: limbs.iter().map(|l| l.mass_kg).sum::<f64>()
            + m.platforms().iter().map(|p| p.mass).sum::<f64>(),
        platforms: m
            .platforms()
            .iter()
            .enumerate()
            .skip(1)
            .map(|(i, p)| PlatformFinding {
                name: p.name.clone(),
                home_position_mm: (p.home.translation.vector * 1e3).into(),
                home_rotation_vector_deg: p.home.rotation.scaled_axis().map(f64::to_degrees).into(),
                mass_kg: p.mass,
                carries_the_tool: i == m.tool(),
            })
            .collect(),
        limbs,
        deviations: deviations_in_words(model),
        home,
        home_problem,
        warnings: model
            .warnings
            .iter()
            .map(|w| match w.line {
                Some(line) => format!("line {line}: {}; {}", w.message, w.help),
                None => format!("{}; {}", w.message, w.help),
            })
            .collect(),
    }
}

fn limb(model: &Model, index: usize) -> LimbFinding {
    let m = &model.mechanism;
    let limb = &m.limbs()[index];
    let chain = &limb.nominal;
    let name = |i: usize| m.platforms()[i].name.clone();
    LimbFinding {
        name: limb.name.clone(),
        from: name(limb.from),
        to: name(limb.to),
        actuators: chain
            .actuators()
            .iter()
            .map(|a| {
                let (kind, unit, factor) = match a.kind {
                    MotionKind::Prismatic => ("slides", "mm", 1e3),
                    MotionKind::Revolute => ("turns", "deg", 1_f64.to_degrees()),
                };
                ActuatorFinding {
                    name: a.name.clone(),
                    kind,
                    unit,
                    home: factor * a.home,
                    limits: a.limits.map(|(low, high)| [factor * low, factor * high]),
                    rigid_drive: a.coordinate.is_none(),
                }
            })
            .collect(),
        passive_joints: chain
            .coordinates()
            .iter()
            .filter(|c| c.role == Role::Passive)
            .map(|c| c.name.clone())
            .collect(),
        springs: chain.springs().iter().map(|s| s.name.clone()).collect(),
        spring_coordinates: chain.springs().iter().map(|s| s.len()).sum(),
        preloaded_springs: chain
            .springs()
            .iter()
            .filter(|s| s.rest.iter().any(|x| *x != 0.0))
            .map(|s| s.name.clone())
            .collect(),
        links: links(model, index),
        loads: loads(model, index),
        bodies: chain.bodies().iter().map(|b| b.name.clone()).collect(),
        mass_kg: chain.bodies().iter().map(|b| b.mass).sum(),
        redundant_passive_joints: Vec::new(),
        constrained_directions: None,
        stiffness_rank: None,
    }
}

fn links(model: &Model, index: usize) -> Vec<LinkFinding> {
    let chain = &model.mechanism.limbs()[index].nominal;
    let written = &model.document.limb[index].chain;
    let elements = model.document.chain.get(written).map(|c| c.elements.iter());
    let elements = elements.into_iter().flatten().enumerate();
    elements
        .filter_map(|(i, element)| {
            let Element::Link(link) = element else {
                return None;
            };
            let name = element
                .name()
                .map_or_else(|| format!("{} {}", element.word(), i + 1), str::to_owned);
            let own = |s: &&kinetostat::Segment| s.link == name;
            let pieces = || chain.springs().iter().filter_map(|s| s.segment.as_ref());
            let piece = pieces().find(own)?;
            let slenderness = std::f64::consts::PI / piece.link_length;
            Some(LinkFinding {
                length_mm: 1e3 * piece.link_length,
                segments: pieces().filter(own).count(),
                convention: link.convention.unwrap_or_default(),
                euler_load_n: slenderness * slenderness * piece.bending_stiffness,
                name,
            })
        })
        .collect()
}

fn loads(model: &Model, index: usize) -> Vec<LoadFinding> {
    let m = &model.mechanism;
    let written = &model.document.limb[index].load;
    let both = written.iter().zip(m.loads(index));
    both.map(|(written, load)| LoadFinding {
        name: written.name().to_owned(),
        kind: written.word(),
        in_words: written.in_words(),
        conservative: m.load_conservative(index, load),
    })
    .collect()
}

const DIRECTIONS: [&str; 6] = [
    "x",
    "y",
    "z",
    "turn about x",
    "turn about y",
    "turn about z",
];

fn at_home(
    m: &Mechanism,
    posture: &Posture<'_>,
    limbs: &mut [LimbFinding],
) -> Result<HomeFinding, String> {
    let stiffness = posture.stiffness().map_err(|e| e.to_string())?;
    let mut held = 0;
    for (i, found) in limbs.iter_mut().enumerate() {
        let k = &stiffness.limbs[i];
        found
            .redundant_passive_joints
            .clone_from(&k.redundant_passive);
        found.stiffness_rank = Some(k.rank);
        found.constrained_directions = alone(m, posture, i);
        held += k.rank + k.count(DirectionKind::Rigid);
    }
    let mobility = posture.mobility().ncols();
    let correctable = posture.correctable();
    let rest = posture
        .deflected_by(&Wrench::zero())
        .map_err(|e| e.to_string())?;
    Ok(HomeFinding {
        mobility,
        actuators: m.actuator_count(),
        // What the limbs hold beyond what the tool needs: they strain each other there.
        degrees_of_over_constraint: Some(held.saturating_sub(stiffness.rank())),
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
        conservative: rest.conservative,
        largest_buckling_margin: rest.margin().filter(|m| m.is_finite()),
    })
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

fn in_words(f: &Findings, model: &Model) -> String {
    let mut out = wrapped(&format!("{} ({})", f.model, f.model_source), 0);
    if let Some(text) = &f.description {
        out.push_str(&wrapped(text, 0));
    }
    if let Some((low, high)) = model.workspace() {
        out.push_str(&wrapped(
            &format!(
                "workspace from {} to {} mm",
                triple((low * 1e3).into(), short),
                triple((high * 1e3).into(), short)
            ),
            0,
        ));
    }
    out.push_str("\nPlatforms\n");
    for p in &f.platforms {
        let mut text = format!(
            "'{}' at home at {} mm, {}",
            p.name,
            triple(p.home_position_mm, short),
            turned(p.home_rotation_vector_deg)
        );
        if p.mass_kg > 0.0 {
            text.push_str(&format!(", {} kg", number(p.mass_kg, 4)));
        }
        if p.carries_the_tool {
            text.push_str("; carries the tool");
        }
        out.push_str(&item(&text));
    }
    for l in &f.limbs {
        out.push_str(&format!(
            "\n{}",
            wrapped(
                &format!("Limb '{}', from '{}' to '{}'", l.name, l.from, l.to),
                0
            )
        ));
        out.push_str(&limb_in_words(l));
    }
    if f.mass_kg > 0.0 {
        out.push('\n');
        out.push_str(&wrapped(
            &format!(
                "Moving mass {} kg, gravity {} m/s^2.",
                number(f.mass_kg, 5),
                triple(f.gravity_m_per_s2, short)
            ),
            0,
        ));
    }
    if let Some(home) = &f.home {
        out.push_str(&home_in_words(f, home));
    }
    if let Some(problem) = &f.home_problem {
        out.push_str("\nAt home\n");
        out.push_str(&item(&format!("nothing can be solved: {problem}")));
    }
    out.push_str(&crate::summary::warnings(&f.warnings));
    if f.warnings.is_empty() {
        out.push_str("\nNothing looks wrong in the file.\n");
    }
    out
}

/// `1 actuator`, `3 actuators`.
fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

fn turned(v: [f64; 3]) -> String {
    if v.iter().all(|x| x.abs() < 1e-9) {
        "parallel to the base".to_owned()
    } else {
        format!("turned by the rotation vector {} deg", triple(v, short))
    }
}

fn limb_in_words(l: &LimbFinding) -> String {
    let mut rows = Vec::new();
    for a in &l.actuators {
        rows.push(vec![
            format!("actuator '{}' {}", a.name, a.kind),
            format!("home {}", short(a.home)),
            match a.limits {
                Some([low, high]) => format!("limits {} .. {}", short(low), short(high)),
                None => "no limits".to_owned(),
            },
            format!(
                "{}{}",
                a.unit,
                if a.rigid_drive { ", rigid drive" } else { "" }
            ),
        ]);
    }
    let mut out = screen::listed(&rows, 2);
    let list = |names: &[String]| {
        if names.is_empty() {
            "none".to_owned()
        } else {
            names.join(", ")
        }
    };
    out.push_str(&wrapped(
        &format!("passive joints: {}", list(&l.passive_joints)),
        2,
    ));
    let mut springs = format!(
        "springs: {} ({})",
        list(&l.springs),
        counted(l.spring_coordinates, "coordinate")
    );
    if !l.preloaded_springs.is_empty() {
        springs.push_str(&format!("; preloaded: {}", list(&l.preloaded_springs)));
    }
    out.push_str(&wrapped(&springs, 2));
    for link in &l.links {
        let pieces = match link.segments {
            1 => String::new(),
            n => format!(" in {n} segments"),
        };
        out.push_str(&wrapped(
            &format!(
                "link '{}': {} mm{pieces}, {}; Euler load {} N",
                link.name,
                short(link.length_mm),
                convention_in_words(link.convention),
                number(link.euler_load_n, 4)
            ),
            2,
        ));
    }
    for load in &l.loads {
        let flag = if load.conservative {
            ""
        } else {
            " (not conservative)"
        };
        out.push_str(&wrapped(
            &format!("load '{}': {}{flag}", load.name, load.in_words),
            2,
        ));
    }
    if l.mass_kg > 0.0 {
        out.push_str(&wrapped(
            &format!(
                "masses: {}, {} kg in all",
                list(&l.bodies),
                number(l.mass_kg, 5)
            ),
            2,
        ));
    }
    if let (Some(rank), Some(blocked)) = (l.stiffness_rank, l.constrained_directions) {
        out.push_str(&wrapped(
            &format!(
                "stiffness of rank {rank} at its end; blocks {blocked} of the tool's directions"
            ),
            2,
        ));
    }
    if !l.redundant_passive_joints.is_empty() {
        out.push_str(&wrapped(
            &format!(
                "redundant: {} can move while the end is held",
                list(&l.redundant_passive_joints)
            ),
            2,
        ));
    }
    out
}

fn convention_in_words(convention: Convention) -> &'static str {
    match convention {
        Convention::Bowing => "bows",
        Convention::TranslationsFirst => "plain spring, translations first",
        Convention::RotationsFirst => "plain spring, rotations first",
        Convention::Middle => "plain spring in the middle",
        Convention::Exponential => "plain spring, exponential coordinates",
        Convention::ConstantStrain => "constant strain",
    }
}

fn home_in_words(f: &Findings, h: &HomeFinding) -> String {
    let mut out = String::from("\nAt home\n");
    let over = match h.degrees_of_over_constraint {
        Some(0) => {
            "no over-constraint: deviations shift the tool without straining the limbs".to_owned()
        }
        Some(1) => "1 degree of over-constraint: deviations strain the limbs".to_owned(),
        Some(n) => format!("{n} degrees of over-constraint: deviations strain the limbs"),
        None => "over-constraint not counted for machines with several platforms".to_owned(),
    };
    out.push_str(&item(&format!(
        "mobility {} with {}; {over}",
        h.mobility,
        counted(h.actuators, "actuator")
    )));
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
    if h.stiffness_rank < 6 {
        out.push_str(&item(&format!(
            "no spring holds the tool in {} of 6 directions (see the table below)",
            6 - h.stiffness_rank
        )));
    }
    let (shift, turn) = (h.shift_without_load_mm, h.rotation_without_load_deg);
    let causes: Vec<&str> = [
        ("its deviations", !f.deviations.is_empty()),
        ("its own weight", f.mass_kg > 0.0),
        (
            "the loads on its limbs",
            f.limbs.iter().any(|l| !l.loads.is_empty()),
        ),
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
    out.push_str(&item(&match (h.stable, h.largest_buckling_margin) {
        (true, Some(mu)) if mu.abs() > 1e-9 && h.stiffness_rank == 6 => {
            format!(
                "stable; largest share of the way to buckling {}",
                number(mu, 3)
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
    if !h.conservative {
        out.push_str(&item(
            "not conservative: a load on a limb has no potential, so that stability is judged by stiffness alone",
        ));
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
