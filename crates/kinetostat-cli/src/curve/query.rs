//! What `curve` and `equilibria` are asked, from their options: how the tool is held, direction by
//! direction, what acts on it, and what grows.

use kinetostat::{
    EndCondition, Load, LoadPattern, Parameter, Pose, Prescribed, Twist, Wrench, turn_matrix,
};
use nalgebra::{Rotation3, Vector3, Vector6};
use serde::Serialize;

use crate::curve::arguments::{CurveArgs, EndArgs};
use crate::end_condition::chain::{Moves, SerialChain};
use crate::job::machine::short;
use crate::job::setting::vector;
use crate::place::orientation;
use crate::ui::failure::{Answer, Failure};
use crate::ui::screen::{number, triple};

pub(crate) const DIRECTIONS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

/// How the tool is held.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Holding {
    /// Directions in which it is held.
    pub(crate) held: Vec<&'static str>,
    /// Directions in which a load acts on it (none is a load of zero).
    pub(crate) free: Vec<&'static str>,
    /// Directions in which the chain cannot move its end at all.
    pub(crate) rigid: Vec<&'static str>,
    /// Rotation vector of the axes of these directions, degrees.
    pub(crate) axes_rotation_vector_deg: [f64; 3],
    #[serde(skip)]
    pub(crate) end: EndCondition,
    /// `chain` or `machine`.
    #[serde(skip)]
    pub(crate) subject: &'static str,
}

/// What is driven, base axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Driven {
    pub(crate) axis: Vector3<f64>,
    pub(crate) turns: bool,
}

impl Driven {
    pub(crate) fn twist(&self) -> Vector6<f64> {
        let zero = Vector3::zeros();
        let (v, w) = if self.turns {
            (zero, self.axis)
        } else {
            (self.axis, zero)
        };
        Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z)
    }

    fn in_words(&self) -> String {
        let word = if self.turns { "about" } else { "along" };
        format!("{word} {}", axis_in_words(&self.axis))
    }
}

/// `x`, `-y` or the components.
pub(crate) fn axis_in_words(axis: &Vector3<f64>) -> String {
    for (k, name) in ["x", "y", "z"].into_iter().enumerate() {
        if axis[k].abs() > 1.0 - 1e-12 {
            let sign = if axis[k] < 0.0 { "-" } else { "" };
            return format!("{sign}{name}");
        }
    }
    triple((*axis).into(), short)
}

/// Names of directions, with words for groups of them.
fn list(option: &str, text: &str, driven: Option<usize>) -> Answer<[bool; 6]> {
    let mut set = [false; 6];
    for word in text.split([',', ' ']).filter(|w| !w.is_empty()) {
        match word.to_ascii_lowercase().as_str() {
            "none" => {}
            "all" => set = [true; 6],
            "translations" => set[..3].fill(true),
            "rotations" => set[3..].fill(true),
            "others" => {
                let Some(driven) = driven else {
                    return Err(Failure::input(format!(
                        "{option} {text}: 'others' means all directions but the one along which the tool is pushed, and here it is pushed along none; name the directions"
                    )));
                };
                for (k, free) in set.iter_mut().enumerate() {
                    *free |= k != driven;
                }
            }
            name => match DIRECTIONS.iter().position(|d| *d == name) {
                Some(k) => set[k] = true,
                None => {
                    return Err(Failure::input(format!(
                        "{option} {text}: '{word}' is no direction; there are x, y, z (moves along) and rx, ry, rz (turns about), and the words all, none, translations, rotations, others"
                    )));
                }
            },
        }
    }
    Ok(set)
}

/// How the tool is held at `place`, with the constant wrench where it is free.
pub(crate) fn holding(
    moves: &Moves,
    args: &EndArgs,
    place: &Pose,
    constant: Wrench,
    held_by_default: bool,
    driven: Option<&Driven>,
) -> Answer<Holding> {
    let others = |text: &Option<String>| {
        text.as_ref().is_some_and(|t| {
            t.split([',', ' '])
                .any(|w| w.eq_ignore_ascii_case("others"))
        })
    };
    let mut axes = match &args.axes {
        Some(text) => orientation::option("--axes", text)?.to_rotation_matrix(),
        None => Rotation3::identity(),
    };
    // The direction of the six along which the tool is driven, if it is one of them.
    let alone = |axes: &Rotation3<f64>| {
        let d = driven?;
        let local = axes.inverse() * d.axis;
        let k = local.iamax();
        (local[k].abs() > 1.0 - 1e-9).then(|| k + if d.turns { 3 } else { 0 })
    };
    if others(&args.free)
        && args.axes.is_none()
        && alone(&axes).is_none()
        && let Some(d) = driven
    {
        axes = Rotation3::rotation_between(&Vector3::x(), &d.axis).unwrap_or_default();
    }
    let free = match (&args.hold, &args.free) {
        (Some(text), _) => list("--hold", text, alone(&axes))?.map(|held| !held),
        (None, Some(text)) => {
            if others(&args.free) && driven.is_some() && alone(&axes).is_none() {
                return Err(Failure::input(
                    "--free others: with these --axes the tool is not pushed along one of the axes; leave --axes out, then they follow the direction",
                ));
            }
            list("--free", text, alone(&axes))?
        }
        (None, None) => [!held_by_default; 6],
    };
    let turn = turn_matrix(&axes);
    let rigid: [bool; 6] =
        std::array::from_fn(|k| moves.share(&turn.column(k).into_owned()) < 1e-6);
    if let Some(d) = driven {
        let twist = d.twist();
        if moves.share(&twist) < 1.0 - 1e-6 {
            return Err(Failure::input(format!(
                "the tool cannot be moved {}: the {} is rigid {}. Choose a direction in which it can move",
                d.in_words(),
                moves.subject,
                in_words_of(&rigid, "along or about a skew direction"),
            )));
        }
        let local = turn.transpose() * twist;
        if let Some(k) = (0..6).find(|&k| free[k] && local[k].abs() > 1e-9) {
            return Err(Failure::input(format!(
                "the tool is pushed {}, and is to be free in '{}', which is a part of that: hold it there, or write --free others to free all that is across",
                d.in_words(),
                DIRECTIONS[k]
            )));
        }
    }
    let holding = Holding {
        subject: moves.subject,
        held: names(|k| !free[k] && !rigid[k]),
        free: names(|k| free[k] && !rigid[k]),
        rigid: names(|k| rigid[k]),
        axes_rotation_vector_deg: axes.scaled_axis().map(f64::to_degrees).into(),
        end: EndCondition {
            axes,
            prescribed: free.map(|f| {
                if f {
                    Prescribed::Wrench
                } else {
                    Prescribed::Pose
                }
            }),
            pose: *place,
            wrench: constant,
        },
    };
    holding.accepts("the constant load", &constant)?;
    Ok(holding)
}

fn names(of: impl Fn(usize) -> bool) -> Vec<&'static str> {
    (0..6).filter(|&k| of(k)).map(|k| DIRECTIONS[k]).collect()
}

fn in_words_of(set: &[bool; 6], otherwise: &str) -> String {
    let list = names(|k| set[k]);
    if list.is_empty() {
        otherwise.to_owned()
    } else {
        format!("in {}", list.join(", "))
    }
}

impl Holding {
    /// That a wrench on the tool acts only where the tool is free.
    pub(crate) fn accepts(&self, what: &str, wrench: &Wrench) -> Answer<()> {
        let local = turn_matrix(&self.end.axes).transpose() * wrench.0;
        let most = local.amax();
        let wrong = (0..6)
            .find(|&k| self.end.prescribed[k] == Prescribed::Pose && local[k].abs() > 1e-9 * most);
        match wrong {
            Some(k) => Err(Failure::input(format!(
                "{what} has a part in '{}', where the tool is held: it would change nothing. Free that direction (--free {}), or leave that part out",
                DIRECTIONS[k], DIRECTIONS[k]
            ))),
            None => Ok(()),
        }
    }

    /// What holds the tool, in words.
    pub(crate) fn in_words(&self) -> String {
        let mut text = match (self.held.as_slice(), self.free.as_slice()) {
            ([], []) => format!("The end of this {} cannot move at all", self.subject),
            ([], _) => "The tool is free".to_owned(),
            (held, []) => format!("The tool is held in {}", held.join(", ")),
            (held, free) => format!(
                "The tool is held in {} and free in {}",
                held.join(", "),
                free.join(", ")
            ),
        };
        let turned = Vector3::from(self.axes_rotation_vector_deg);
        if turned.norm() > 1e-9 {
            text.push_str(&format!(
                " (axes turned from the base by the rotation vector {} deg)",
                triple(turned.into(), short)
            ));
        }
        let moves = !self.held.is_empty() || !self.free.is_empty();
        if moves && !self.rigid.is_empty() {
            text.push_str(&format!(
                "; the {} cannot move in {}",
                self.subject,
                self.rigid.join(", ")
            ));
        }
        text.push('.');
        text
    }
}

/// In which quantity a curve is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Measure {
    /// Displacement (mm) and force (N) along one line; the force per unit of the parameter's load.
    Force(f64),
    /// Rotation (deg) and moment (N m) about one line.
    Moment(f64),
    /// Several loads at once: work per unit factor (J) and factor.
    Work,
}

/// A question of `curve`.
#[derive(Clone, Debug)]
pub(crate) struct Question {
    pub(crate) holding: Holding,
    pub(crate) parameter: Parameter,
    pub(crate) driven: Option<Driven>,
    pub(crate) measure: Measure,
    /// Of the parameter: m, rad or a factor.
    pub(crate) range: (f64, f64),
    /// Of the force along the displacement, N or N m.
    pub(crate) force_limits: Option<(f64, f64)>,
    pub(crate) branches: usize,
    pub(crate) points: usize,
    pub(crate) all: bool,
    /// What is asked, in words.
    pub(crate) words: String,
}

impl Question {
    pub(crate) fn by_load(&self) -> bool {
        matches!(self.parameter, Parameter::Load(_))
    }

    /// The parameter's value nearest to none.
    pub(crate) fn start(&self) -> f64 {
        0.0_f64.clamp(self.range.0, self.range.1)
    }

    /// The parameter in the unit of the question (mm, deg or a factor).
    pub(crate) fn shown(&self, value: f64) -> f64 {
        match (&self.parameter, self.measure) {
            (Parameter::Displacement(_), Measure::Moment(_)) => value.to_degrees(),
            (Parameter::Displacement(_), _) => 1e3 * value,
            (Parameter::Load(_), _) => value,
        }
    }
}

/// Two different numbers, the smaller first.
fn ends(option: &str, values: &[f64]) -> Answer<(f64, f64)> {
    let (a, b) = (values[0], values[1]);
    if a == b {
        return Err(Failure::input(format!(
            "{option} goes from {a} to {b}: there is nothing between equal ends; give two different numbers"
        )));
    }
    Ok((a.min(b), a.max(b)))
}

fn unit(option: &str, values: &[f64]) -> Answer<Vector3<f64>> {
    let v = vector(option, values)?;
    if v.norm() == 0.0 {
        return Err(Failure::input(format!(
            "{option} 0 0 0 is no direction; give one, as in {option} 1 0 0"
        )));
    }
    Ok(v.normalize())
}

/// The wrench of two options.
pub(crate) fn wrench(
    force: (&str, Option<&[f64]>),
    moment: (&str, Option<&[f64]>),
) -> Answer<Wrench> {
    let part = |(name, values): (&str, Option<&[f64]>)| {
        values.map_or_else(|| Ok(Vector3::zeros()), |v| vector(name, v))
    };
    Ok(Wrench::new(part(force)?, part(moment)?))
}

/// The wrench that acts all the time.
pub(crate) fn constant(args: &EndArgs) -> Answer<Wrench> {
    wrench(
        ("--constant-force", args.constant_force.as_deref()),
        ("--constant-moment", args.constant_moment.as_deref()),
    )
}

/// That a force on a node is asked of a machine.
pub(crate) fn no_nodes(option: &str) -> Failure {
    Failure::input(format!(
        "{option} puts a force on a node of a chain, and this model has several limbs; write such a load into the model file, or a force on the tool"
    ))
}

/// Adds the forces on nodes that act all the time.
pub(crate) fn with_loads(mut chain: SerialChain, args: &EndArgs) -> Answer<SerialChain> {
    for text in &args.load {
        let load = chain.node_force("--load", text)?;
        chain.loads.push(load);
    }
    Ok(chain)
}

/// A number that was asked for, as short as it can be: a small one is never called nothing.
fn given(value: f64) -> String {
    match short(value).as_str() {
        "0" | "-0" if value != 0.0 => number(value, 4),
        text => text.to_owned(),
    }
}

/// Three components that were asked for; what turning them left of nothing is nothing.
fn given_triple(v: [f64; 3]) -> String {
    let most = v.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    triple(v, |x| {
        if x.abs() < 1e-12 * most {
            "0".into()
        } else {
            given(x)
        }
    })
}

/// What acts all the time, in words; nothing if nothing does.
pub(crate) fn constant_in_words(args: &EndArgs) -> String {
    let mut parts = Vec::new();
    if let Some(f) = &args.constant_force {
        parts.push(format!(
            "the force ({}, {}, {}) N on the tool",
            f[0], f[1], f[2]
        ));
    }
    if let Some(m) = &args.constant_moment {
        parts.push(format!(
            "the moment ({}, {}, {}) N m on the tool",
            m[0], m[1], m[2]
        ));
    }
    for text in &args.load {
        if let Some((node, force)) = text.split_once('=') {
            parts.push(format!("the force ({force}) N on '{}'", node.trim()));
        }
    }
    if parts.is_empty() {
        String::new()
    } else {
        format!(" All the time: {}.", parts.join(", "))
    }
}

/// The question of `curve`. `chain`: for forces on its nodes; a machine has none here.
pub(crate) fn question(
    moves: &Moves,
    chain: Option<&SerialChain>,
    args: &CurveArgs,
) -> Answer<Question> {
    let constant = constant(&args.end)?;
    let place = moves.place;
    let counts = [
        ("--branches", args.branches, 1, 1000),
        ("--points", args.points, 10, 100_000),
    ];
    for (option, value, low, high) in counts {
        if value.is_some_and(|v| !(low..=high).contains(&v)) {
            return Err(Failure::input(format!(
                "{option} takes a number from {low} to {high}"
            )));
        }
    }
    let mut question = Question {
        holding: Holding {
            subject: moves.subject,
            held: Vec::new(),
            free: Vec::new(),
            rigid: Vec::new(),
            axes_rotation_vector_deg: [0.0; 3],
            end: EndCondition::pose(place),
        },
        parameter: Parameter::Displacement(Twist::zero()),
        driven: None,
        measure: Measure::Work,
        range: (0.0, 0.0),
        force_limits: None,
        branches: args.branches.unwrap_or(12),
        points: args.points.unwrap_or(600),
        all: args.all,
        words: String::new(),
    };
    if let Some(limits) = &args.force_limits {
        question.force_limits = Some(ends("--force-limits", limits)?);
    }
    match (&args.direction, &args.about, &args.factor) {
        (Some(direction), None, None) => {
            let range = args.displacement_mm.as_ref().ok_or_else(|| {
                Failure::input(
                    "how far? --direction needs --displacement-mm FROM TO, as in --displacement-mm 0 20",
                )
            })?;
            let (low, high) = ends("--displacement-mm", range)?;
            question.range = (1e-3 * low, 1e-3 * high);
            question.measure = Measure::Force(1.0);
            let driven = Driven {
                axis: unit("--direction", direction)?,
                turns: false,
            };
            question.words = format!(
                "The tool is pushed along {} from {} to {} mm; the force is what pushes it that way.",
                axis_in_words(&driven.axis),
                short(low),
                short(high)
            );
            question.driven = Some(driven);
        }
        (None, Some(about), None) => {
            let range = args.turn_deg.as_ref().ok_or_else(|| {
                Failure::input("how far? --about needs --turn-deg FROM TO, as in --turn-deg 0 5")
            })?;
            let (low, high) = ends("--turn-deg", range)?;
            if low < -180.0 || high > 180.0 {
                return Err(Failure::input(
                    "--turn-deg: the tool can be turned by -180 to 180 degrees",
                ));
            }
            question.range = (low.to_radians(), high.to_radians());
            question.measure = Measure::Moment(1.0);
            let driven = Driven {
                axis: unit("--about", about)?,
                turns: true,
            };
            question.words = format!(
                "The tool is turned about {} from {} to {} deg; the moment is what turns it that way.",
                axis_in_words(&driven.axis),
                short(low),
                short(high)
            );
            question.driven = Some(driven);
        }
        (None, None, Some(range)) => question.range = ends("--factor", range)?,
        _ => {
            return Err(Failure::input(
                "what shall grow? Either a displacement (--direction X Y Z --displacement-mm FROM TO, or --about X Y Z --turn-deg FROM TO) or a load (--force FX FY FZ --factor FROM TO)",
            ));
        }
    }
    if question.driven.is_some()
        && (args.force.is_some() || args.moment.is_some() || !args.grow.is_empty())
    {
        return Err(Failure::input(
            "--force, --moment and --grow are loads that grow with --factor; here the motion grows. A load that acts all the time is --constant-force, --constant-moment or --load NODE=FX,FY,FZ",
        ));
    }
    if let Some(driven) = question.driven {
        question.parameter = Parameter::Displacement(Twist(driven.twist()));
        question.holding = holding(moves, &args.end, &place, constant, true, Some(&driven))?;
    } else {
        load_pattern(&mut question, moves, chain, args, constant)?;
    }
    question.words.push(' ');
    question.words.push_str(&question.holding.in_words());
    question.words.push_str(&constant_in_words(&args.end));
    Ok(question)
}

/// The growing load of the options.
fn load_pattern(
    question: &mut Question,
    moves: &Moves,
    chain: Option<&SerialChain>,
    args: &CurveArgs,
    constant: Wrench,
) -> Answer<()> {
    let end = wrench(
        ("--force", args.force.as_deref()),
        ("--moment", args.moment.as_deref()),
    )?;
    let mut loads = Vec::new();
    for text in &args.grow {
        match chain {
            Some(chain) => loads.push(chain.node_force("--grow", text)?),
            None => return Err(no_nodes("--grow")),
        }
    }
    let (force, moment) = (end.force().norm(), end.moment().norm());
    let sizes: Vec<f64> = loads
        .iter()
        .map(|l| match l {
            Load::Dead { wrench, .. } => wrench.force().norm(),
            _ => 0.0,
        })
        .collect();
    if force == 0.0 && moment == 0.0 && sizes.iter().all(|s| *s == 0.0) {
        return Err(Failure::input(
            "which load shall grow? Give --force FX FY FZ, --moment MX MY MZ or --grow NODE=FX,FY,FZ, not all zero",
        ));
    }
    question.measure = match (force > 0.0, moment > 0.0, sizes.as_slice()) {
        (true, false, []) => Measure::Force(force),
        (false, true, []) => Measure::Moment(moment),
        (false, false, [size]) => Measure::Force(*size),
        _ => Measure::Work,
    };
    let mut parts = Vec::new();
    if force > 0.0 {
        parts.push(format!(
            "the force {} N on the tool",
            given_triple(end.force().into())
        ));
    }
    if moment > 0.0 {
        parts.push(format!(
            "the moment {} N m on the tool",
            given_triple(end.moment().into())
        ));
    }
    for load in &loads {
        if let (Load::Dead { node, wrench }, Some(chain)) = (load, chain) {
            parts.push(format!(
                "the force {} N on '{}'",
                given_triple(wrench.force().into()),
                chain.chain.nodes()[*node]
            ));
        }
    }
    question.words = format!(
        "The load grows from {} to {} times {}.",
        given(question.range.0),
        given(question.range.1),
        parts.join(" with ")
    );
    let holding = holding(moves, &args.end, &moves.place, constant, false, None)?;
    holding.accepts("the growing load", &end)?;
    // Work of the wrench on the motions that the chain can make, moments at the natural length.
    let length = moves.length;
    let pull = Vector6::from_fn(|i, _| if i < 3 { end.0[i] * length } else { end.0[i] });
    if loads.is_empty() && (moves.basis.transpose() * pull).norm() < 1e-9 * pull.norm() {
        return Err(Failure::input(format!(
            "the growing load does nothing: the {} is rigid in {}, where it acts. Choose another direction",
            moves.subject,
            holding.rigid.join(", ")
        )));
    }
    question.holding = holding;
    question.parameter = Parameter::Load(LoadPattern { end, loads });
    Ok(())
}
