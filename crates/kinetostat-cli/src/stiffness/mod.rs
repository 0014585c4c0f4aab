//! `kinetostat stiffness`: the 6 x 6 matrix with units, axes and reference point.

use kinetostat::{
    CartesianCompliance, CartesianStiffness, ChainStiffness, Direction, DirectionKind, Mechanism,
    MotionKind, Posture, Role, Wrench,
};
use kinetostat_machining::{NearSingular, Warning, WarningCode};
use nalgebra::Matrix6;
use serde::Serialize;

use crate::command_line::StiffnessArgs;
use crate::deflect::PlaceAsked;
use crate::files::input::Files;
use crate::place::joints::{self, JointValue};
use crate::place::query::{Spot, spot};
use crate::program::{solve, summary};
use crate::ui::failure::Answer;
use crate::ui::screen::{self, Stream, columns, fixed, item, load_triple, number, triple, wrapped};

/// The answer, stable names with units.
#[derive(Serialize)]
struct Stiffness {
    schema: u32,
    kinetostat_version: &'static str,
    model: String,
    model_source: String,
    tool: String,
    place: PlaceAsked,
    /// Commands of the actuators there.
    joints: Vec<JointValue>,
    /// What the controller shows, in the order of its axes; empty without a section `controller`.
    pendant: Vec<JointValue>,
    loaded: bool,
    force_n: [f64; 3],
    moment_n_m: [f64; 3],
    /// Rows: force (N), moment (N m); columns: displacement (m), rotation (rad).
    stiffness_n_m_rad: [[f64; 6]; 6],
    /// The same as the terminal shows it: rows N and N m, columns per mm and per rad.
    stiffness_n_n_m_per_mm_rad: [[f64; 6]; 6],
    /// Inverse, m and rad per N and N m, zero along rigid directions; none where a direction is free.
    compliance_m_rad_per_n: Option<[[f64; 6]; 6]>,
    /// The same as the terminal shows it: micrometres and microradians per N and N m.
    compliance_um_urad_per_n_n_m: Option<[[f64; 6]; 6]>,
    /// Where directions are free: the motion under a load that pushes along none of them, up to
    /// motions along them.
    compliance_besides_free_motions_m_rad_per_n: Option<[[f64; 6]; 6]>,
    /// Smallest stiffness against a force: in its softest direction, the tool free to turn; null if no
    /// force moves the tool. As in `map`, `deflect` and along programs.
    smallest_stiffness_n_per_mm: f64,
    /// What acts in the model and is not in the unloaded stiffness: springs and other loads between
    /// nodes and platforms, and weight.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    left_out: Vec<String>,
    /// The same figures with what is left out: the tangent at rest, without a load on the tool.
    #[serde(skip_serializing_if = "Option::is_none")]
    at_rest: Option<AtRest>,
    rank: usize,
    free_directions: usize,
    rigid_directions: usize,
    negative_directions: usize,
    principal_directions: Vec<Principal>,
    limbs: Vec<LimbShare>,
    /// The nearest singular posture, where one is near.
    near_singularity: Option<NearSingular>,
    warnings: Vec<Warning>,
}

/// Stiffness of the machine as it stands, without a load on the tool.
#[derive(Serialize)]
struct AtRest {
    stiffness_n_m_rad: [[f64; 6]; 6],
    smallest_stiffness_n_per_mm: f64,
    stable: bool,
}

/// One principal direction.
#[derive(Serialize)]
pub(crate) struct Principal {
    pub(crate) kind: DirectionKind,
    /// None where it is rigid (infinite).
    pub(crate) stiffness_n_per_mm: Option<f64>,
    pub(crate) translation_share: [f64; 3],
    pub(crate) rotation_deg_per_mm: [f64; 3],
    /// The motion and what lets it happen: `turns about z by arm: q`.
    pub(crate) in_words: String,
    /// Joints and springs that move with it, the most first.
    pub(crate) behind: Vec<Behind>,
}

/// A joint or spring that moves while the tool moves in a direction.
#[derive(Serialize)]
pub(crate) struct Behind {
    pub(crate) name: String,
    pub(crate) role: Role,
    /// Its motion per mm of the direction's longest part.
    pub(crate) motion_per_mm: f64,
    pub(crate) unit: &'static str,
    /// Of all squares, rotations at the machine's natural length: 0 to 1.
    pub(crate) share: f64,
}

#[derive(Serialize)]
struct LimbShare {
    name: String,
    rank: usize,
    free: usize,
    rigid: usize,
    negative: usize,
    redundant_passive_joints: Vec<String>,
}

pub(crate) fn run(args: &StiffnessArgs) -> Answer<()> {
    let spot = spot(
        &Files::default(),
        &args.model,
        &args.place,
        args.tool_length_mm,
        args.force.as_deref(),
        args.moment.as_deref(),
    )?;
    let posture = spot.posture()?;
    let loaded = args.force.is_some() || args.moment.is_some();
    let answer = if loaded {
        let e = posture.deflected_by(&spot.wrench)?;
        let limbs: Vec<&ChainStiffness> = e.limbs.iter().map(|l| &l.stiffness).collect();
        let behind = |d: &Direction| e.behind(&spot.mechanism, &d.twist);
        let directions = with_causes(&e.directions, behind);
        answer(
            &spot,
            &posture,
            (true, e.stiffness_against_force()),
            &e.stiffness,
            &e.compliance(),
            &directions,
            &limbs,
        )
    } else {
        let k = posture.stiffness()?;
        let limbs: Vec<&ChainStiffness> = k.limbs.iter().collect();
        let directions = with_causes(&k.directions, |d| k.behind(&posture, &d.twist));
        let mut answer = answer(
            &spot,
            &posture,
            (false, k.stiffness_against_force()),
            &k.cartesian,
            &k.compliance(),
            &directions,
            &limbs,
        );
        with_own_loads(&mut answer, &spot, &posture);
        answer
    };
    let text = in_words(&spot, &answer);
    if args.json {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(solve::json(&answer)?.as_bytes());
    }
    screen::print(Stream::Out, &text)
}

/// Directions with the joints and springs behind them, the stiff ones too.
fn with_causes(
    directions: &[Direction],
    behind: impl Fn(&Direction) -> Vec<kinetostat::Share>,
) -> Vec<Direction> {
    let mut list = directions.to_vec();
    for direction in &mut list {
        if direction.kind != DirectionKind::Rigid {
            direction.behind = behind(direction);
        }
    }
    list
}

/// Names what acts in the model and is not in its unloaded stiffness, and adds the stiffness with it.
fn with_own_loads(answer: &mut Stiffness, spot: &Spot, posture: &Posture<'_>) {
    if spot.own_loads.is_empty() {
        return;
    }
    answer.left_out.clone_from(&spot.own_loads);
    match posture.deflected_by(&Wrench::zero()) {
        Ok(rest) => {
            answer.at_rest = Some(AtRest {
                stiffness_n_m_rad: rows(&rest.stiffness.matrix),
                smallest_stiffness_n_per_mm: 1e-3 * rest.stiffness_against_force(),
                stable: rest.stable(),
            });
        }
        Err(error) => answer.warnings.push(Warning::new(
            WarningCode::NoEquilibrium,
            format!("there is no stiffness with what acts in the model besides: {error}"),
        )),
    }
}

/// The warnings of stiffnesses that lie so far apart that digits of the small ones are lost: in the machine's
/// principal directions, and in springs.
pub(crate) fn uneven(
    mechanism: &Mechanism,
    directions: &[Direction],
) -> impl Iterator<Item = Warning> {
    let said = kinetostat::uneven_in_words(directions).into_iter();
    let of_springs = kinetostat::uneven_springs_in_words(mechanism);
    said.chain(of_springs)
        .map(|said| Warning::new(WarningCode::UnevenStiffness, said))
}

fn answer(
    spot: &Spot,
    posture: &Posture<'_>,
    (loaded, against_force): (bool, f64),
    cartesian: &CartesianStiffness,
    compliance: &CartesianCompliance,
    directions: &[Direction],
    limbs: &[&ChainStiffness],
) -> Stiffness {
    let count = |kind| directions.iter().filter(|d| d.kind == kind).count();
    let free = count(DirectionKind::Free);
    let held = free + count(DirectionKind::Rigid) < 6;
    let near_singularity = spot.near_singular();
    let mut warnings = spot.warnings.clone();
    warnings.extend(near_singularity.iter().map(NearSingular::warning));
    warnings.extend(uneven(&spot.mechanism, directions));
    Stiffness {
        schema: 2,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: spot.name.clone(),
        model_source: spot.source.clone(),
        tool: spot.tool_words.clone(),
        place: spot.asked(),
        joints: joints::of_model(&spot.mechanism, &posture.commands()),
        pendant: spot.on_pendant(posture),
        loaded,
        force_n: spot.wrench.force().into(),
        moment_n_m: spot.wrench.moment().into(),
        stiffness_n_m_rad: rows(&cartesian.matrix),
        stiffness_n_n_m_per_mm_rad: std::array::from_fn(|i| {
            std::array::from_fn(|j| per_column(j) * cartesian.matrix[(i, j)])
        }),
        compliance_m_rad_per_n: (free == 0).then(|| rows(&compliance.springs)),
        compliance_um_urad_per_n_n_m: (free == 0).then(|| rows(&(MICRO * compliance.springs))),
        compliance_besides_free_motions_m_rad_per_n: (free > 0 && held)
            .then(|| rows(&compliance.springs)),
        smallest_stiffness_n_per_mm: 1e-3 * against_force,
        left_out: Vec::new(),
        at_rest: None,
        free_directions: free,
        rigid_directions: count(DirectionKind::Rigid),
        negative_directions: count(DirectionKind::Negative),
        rank: directions
            .iter()
            .filter(|d| d.kind != DirectionKind::Free)
            .count(),
        principal_directions: directions.iter().map(principal).collect(),
        limbs: limbs
            .iter()
            .zip(spot.mechanism.limbs())
            .map(|(k, limb)| LimbShare {
                name: limb.name.clone(),
                rank: k.rank,
                free: k.count(DirectionKind::Free),
                rigid: k.count(DirectionKind::Rigid),
                negative: k.count(DirectionKind::Negative),
                redundant_passive_joints: k.redundant_passive.clone(),
            })
            .collect(),
        warnings,
        near_singularity,
    }
}

/// From m and rad to micrometres and microradians.
const MICRO: f64 = 1e6;

/// From per m and per rad to per mm and per rad, as stiffness is shown.
fn per_column(column: usize) -> f64 {
    if column < 3 { 1e-3 } else { 1.0 }
}

fn rows(m: &Matrix6<f64>) -> [[f64; 6]; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]))
}

pub(crate) fn principal(d: &Direction) -> Principal {
    // Per millimetre of the longest part.
    let turn = d.twist.angular().map(|x| 1e-3 * x.to_degrees());
    Principal {
        kind: d.kind,
        stiffness_n_per_mm: d
            .stiffness_n_per_m
            .is_finite()
            .then_some(1e-3 * d.stiffness_n_per_m),
        translation_share: d.twist.linear().into(),
        rotation_deg_per_mm: turn.into(),
        in_words: motion_in_words(d),
        behind: d
            .behind
            .iter()
            .map(|s| {
                let (factor, unit) = match s.kind {
                    MotionKind::Prismatic => (1.0, "mm"),
                    MotionKind::Revolute => (1e-3 * 1_f64.to_degrees(), "deg"),
                };
                Behind {
                    name: s.name.clone(),
                    role: s.role,
                    motion_per_mm: factor * s.motion,
                    unit,
                    share: s.share,
                }
            })
            .collect(),
    }
}

/// `turns about z by arm: q`, with no more names than a line holds.
pub(crate) fn motion_in_words(d: &Direction) -> String {
    const NAMES: usize = 3;
    let mut short = d.clone();
    short.behind.truncate(NAMES);
    let text = short.in_words();
    let motion = text.split_once(": ").map_or(text.as_str(), |(_, m)| m);
    match d.behind.len().saturating_sub(NAMES) {
        0 => motion.to_owned(),
        more => format!("{motion} and {more} more"),
    }
}

fn in_words(spot: &Spot, a: &Stiffness) -> String {
    let mut out = spot.heading();
    if !a.pendant.is_empty() {
        out.push_str(&joints::in_words("On the pendant", &a.pendant));
        out.push('\n');
    }
    let state = if a.loaded {
        format!(
            "Stiffness under the force {} N and the moment {} N m on the tool, with weights, preloads and deviations: what a further small force would meet.",
            load_triple(a.force_n),
            load_triple(a.moment_n_m)
        )
    } else {
        let with = match a.left_out.is_empty() {
            true => String::new(),
            false => format!(
                " Left out are {}; the stiffness with them stands below.",
                a.left_out.join(", ")
            ),
        };
        format!(
            "Stiffness of the unloaded machine as drawn (weights, preloads and deviations left out; give --force for the loaded one).{with}"
        )
    };
    out.push_str(&wrapped(&state, 0));
    out.push_str(&wrapped(
        "Base axes, about the tool's tip. Rows: force in N, moment in N m; columns: motion in mm, rotation in rad.",
        0,
    ));
    out.push('\n');
    out.push_str(&table(&a.stiffness_n_m_rad));
    out.push_str(&asymmetry(spot, a));
    out.push('\n');
    out.push_str(&wrapped(&against_force(a), 0));
    if let Some(rest) = &a.at_rest {
        out.push_str(&at_rest(rest));
    }
    if let Some(c) = &a.compliance_m_rad_per_n {
        out.push_str(match a.rigid_directions {
            0 => "\nCompliance, its inverse: micrometres and microradians\n\n",
            _ => "\nCompliance, zero along rigid directions: micrometres and microradians\n\n",
        });
        out.push_str(&compliance(c));
    } else {
        out.push('\n');
        out.push_str(&wrapped(
            "There is no inverse: a direction is free, so a force along it meets nothing.",
            0,
        ));
    }
    if let Some(c) = &a.compliance_besides_free_motions_m_rad_per_n {
        out.push('\n');
        out.push_str(&wrapped(
            "Compliance besides: motion under a load that pushes along no free direction, up to free motions; micrometres and microradians",
            0,
        ));
        out.push('\n');
        out.push_str(&compliance(c));
    }
    out.push('\n');
    out.push_str(&wrapped(
        &format!(
            "Principal directions: {} of 6 have stiffness{}",
            a.rank,
            match a.rigid_directions {
                0 => String::new(),
                n => format!(", infinite in {n} (the machine cannot move that way)"),
            }
        ),
        0,
    ));
    out.push('\n');
    out.push_str(&principals(&a.principal_directions));
    out.push_str("\nWhat moves\n");
    a.principal_directions
        .iter()
        .for_each(|p| out.push_str(&what_moves(p)));
    out.push_str("\nLimbs\n");
    for limb in &a.limbs {
        out.push_str(&item(&limb_in_words(limb, a.limbs.len())));
    }
    out.push_str(&summary::warnings(&a.warnings));
    out
}

fn compliance(c: &[[f64; 6]; 6]) -> String {
    matrix(
        c,
        [
            "dx, um", "dy, um", "dz, um", "rx, urad", "ry, urad", "rz, urad",
        ],
        ["per N", "per N", "per N", "per N m", "per N m", "per N m"],
        |_, _| MICRO,
    )
}

/// A 6 x 6 table; entries that are rounding noise beside the diagonal show as 0.
fn matrix(
    m: &[[f64; 6]; 6],
    names: [&str; 6],
    units: [&str; 6],
    factor: impl Fn(usize, usize) -> f64,
) -> String {
    let mut header = vec![String::new()];
    header.extend(units.map(str::to_owned));
    let mut rows = vec![header];
    // The largest entry of the translational, and of the rotational, diagonal.
    let scale = |i: usize| {
        let block = if i < 3 { 0..3 } else { 3..6 };
        block.map(|k| m[k][k].abs()).fold(0.0, f64::max)
    };
    let most = m
        .iter()
        .flatten()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    let cell = |i: usize, j: usize, digits: i32| {
        let noise = (1e-9 * (scale(i) * scale(j)).sqrt()).max(1e-15 * most);
        if m[i][j].abs() <= noise {
            "0".to_owned()
        } else {
            number(m[i][j] * factor(i, j), digits)
        }
    };
    // Six columns within the width of a terminal.
    let width = |j: usize| {
        (0..6)
            .map(|i| cell(i, j, 5).len())
            .max()
            .unwrap_or(0)
            .max(7)
    };
    let wide = (0..6).map(|j| width(j) + 2).sum::<usize>() > 70;
    for i in 0..6 {
        let mut row = vec![names[i].to_owned()];
        row.extend((0..6).map(|j| {
            if !wide {
                return cell(i, j, 5);
            }
            match cell(i, j, 4) {
                long if long.len() > 9 => number(m[i][j] * factor(i, j), 3),
                short => short,
            }
        }));
        rows.push(row);
    }
    columns(&rows, 1)
}

/// The smallest stiffness against a force, one sentence.
fn against_force(a: &Stiffness) -> String {
    match a.smallest_stiffness_n_per_mm.is_finite() {
        true => format!(
            "Smallest stiffness against a force: {} N/mm (the tip pushed in its softest direction, the tool free to turn).",
            number(a.smallest_stiffness_n_per_mm, 4)
        ),
        false => "No force on the tip moves it.".to_owned(),
    }
}

/// The stiffness with the loads of the model.
fn at_rest(rest: &AtRest) -> String {
    let mut out = String::from("\n");
    out.push_str(&wrapped(
        &format!(
            "With all that acts in the model and without a load on the tool{}: smallest stiffness against a force {} N/mm.",
            match rest.stable {
                true => "",
                false => " (the machine is NOT stable so)",
            },
            number(rest.smallest_stiffness_n_per_mm, 4)
        ),
        0,
    ));
    out.push('\n');
    out.push_str(&table(&rest.stiffness_n_m_rad));
    out
}

/// A stiffness matrix with its units.
fn table(stiffness: &[[f64; 6]; 6]) -> String {
    matrix(
        stiffness,
        ["fx, N", "fy, N", "fz, N", "mx, N m", "my, N m", "mz, N m"],
        [
            "per mm", "per mm", "per mm", "per rad", "per rad", "per rad",
        ],
        |_, j| per_column(j),
    )
}

/// Under a moment the matrix is not symmetric, which surprises who compares it with a table.
fn asymmetry(spot: &Spot, a: &Stiffness) -> String {
    let moment = spot.wrench.moment();
    if !a.loaded || moment.norm() == 0.0 {
        return String::new();
    }
    let k = &a.stiffness_n_m_rad;
    format!(
        "\n{}",
        wrapped(
            &format!(
                "Under a moment the matrix is not symmetric: its rotational block differs from its transpose by the moment itself. Here K(mx, ry) - K(my, rx) = {} N m/rad, and the moment about z is {} N m. The symmetric part is the curvature of the stored energy.",
                fixed(k[3][4] - k[4][3], 4),
                fixed(moment.z, 4)
            ),
            0
        )
    )
}

/// Principal directions as a table.
pub(crate) fn principals(list: &[Principal]) -> String {
    let mut rows = vec![
        ["kind", "N/mm", "moves along (x, y, z)", "turns, deg per mm"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for p in list {
        rows.push(vec![
            kind_in_words(p.kind).to_owned(),
            p.stiffness_n_per_mm
                .map_or_else(|| "infinite".to_owned(), |s| number(s, 4)),
            triple(p.translation_share, |x| fixed(x, 3)),
            triple(p.rotation_deg_per_mm, |x| fixed(x, 4)),
        ]);
    }
    let mut out = columns(&rows, 2);
    out.push_str(&wrapped(
        "Rotations count at the machine's natural length, so that N/mm compares them: the smallest here is another figure than the smallest stiffness against a force.",
        2,
    ));
    out
}

fn kind_in_words(kind: DirectionKind) -> &'static str {
    match kind {
        DirectionKind::Free => "free",
        DirectionKind::Finite => "stiff",
        DirectionKind::Negative => "NEGATIVE",
        DirectionKind::Rigid => "rigid",
    }
}

/// A direction with the joints and springs behind it.
pub(crate) fn what_moves(p: &Principal) -> String {
    let stiffness = match (p.kind, p.stiffness_n_per_mm) {
        (DirectionKind::Finite | DirectionKind::Negative, Some(s)) => {
            format!(", {} N/mm", number(s, 4))
        }
        _ => String::new(),
    };
    item(&format!(
        "{}{stiffness}: {}",
        kind_in_words(p.kind),
        p.in_words
    ))
}

/// A limb among a number of them.
fn limb_in_words(limb: &LimbShare, of: usize) -> String {
    let mut parts = vec![format!("stiff in {} of 6", limb.rank - limb.negative)];
    if limb.free > 0 {
        parts.push(format!("free in {} (passive joints)", limb.free));
    }
    if limb.rigid > 0 {
        parts.push(format!("rigid in {}", limb.rigid));
    }
    if limb.negative > 0 {
        let held = if of > 1 {
            " (unless the others hold it)"
        } else {
            ""
        };
        parts.push(format!(
            "negative in {}, where its load pulls it away{held}",
            limb.negative
        ));
    }
    let mut text = format!("limb '{}': {}", limb.name, parts.join(", "));
    if !limb.redundant_passive_joints.is_empty() {
        text.push_str(&format!(
            "; {} can move while the end is held (redundant)",
            limb.redundant_passive_joints.join(" and ")
        ));
    }
    text
}
