//! The query of `curve`, from its options: what grows, how far, and what acts besides.

use kinetostat::number::{larger, largest_size};
use kinetostat::{EndCondition, Load, Parameter, Twist, Wrench, continuation::LoadPattern};
use kinetostat_analysis::serial_chain::SerialChain;
use kinetostat_diagnostic::ErrorCode;
use nalgebra::{Vector3, Vector6};

use crate::curve::arguments::CurveArgs;
use crate::end_condition::chain::node_force;
use crate::end_condition::holding::{Driven, Holding, axis_description, holding};
use crate::end_condition::loads::{constant, constant_loads_text, no_growing_nodes, wrench};
use crate::end_condition::moves::Moves;
use crate::options::vector;
use crate::place::query::FARTHEST;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{number, short, triple};

/// Quantity in which a curve is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Measure {
    /// Displacement (mm) and force (N) along one line; the force per unit of the parameter's load.
    Force(f64),
    /// Rotation (deg) and moment (N m) about one line.
    Moment(f64),
    /// Several loads at once: work per unit factor (J) and factor.
    Work,
}

#[derive(Clone, Debug)]
pub(crate) struct CurveQuery {
    pub(crate) holding: Holding,
    pub(crate) parameter: Parameter,
    pub(crate) driven: Option<Driven>,
    pub(crate) measure: Measure,
    /// Range of the parameter: m, rad or a factor.
    pub(crate) range: (f64, f64),
    /// Limits of the force along the displacement, N or N m.
    pub(crate) force_limits: Option<(f64, f64)>,
    pub(crate) branches: usize,
    pub(crate) points: usize,
    pub(crate) all: bool,
    pub(crate) words: String,
}

impl CurveQuery {
    pub(crate) fn by_load(&self) -> bool {
        matches!(self.parameter, Parameter::Load(_))
    }

    /// The parameter's value nearest to none.
    pub(crate) fn start(&self) -> f64 {
        0.0_f64.clamp(self.range.0, self.range.1)
    }

    /// The largest load on the tool that was asked for: what acts all the time, and of a growing load the worse end.
    pub(crate) fn largest_load(&self) -> Wrench {
        let constant = self.holding.end.wrench;
        let Parameter::Load(pattern) = &self.parameter else {
            return constant;
        };
        let [low, high] =
            [self.range.0, self.range.1].map(|factor| constant + pattern.end * factor);
        match largest_size(&low.0) > largest_size(&high.0) {
            true => low,
            false => high,
        }
    }

    /// The parameter in the unit of the query (mm, deg or a factor).
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
        return Err(ErrorCode::Value.failure(format!(
                "{option} goes from {a} to {b}: there is nothing between equal ends; give two different numbers"
            ),
        ));
    }
    Ok((a.min(b), a.max(b)))
}

fn unit(option: &str, values: &[f64]) -> Answer<Vector3<f64>> {
    let v = vector(option, values)?;
    // The direction is scaled first: squares of very large or very small numbers overflow or underflow.
    let most = largest_size(&v);
    if most == 0.0 {
        return Err(ErrorCode::Value.failure(format!(
            "{option} 0 0 0 is no direction; give one, as in {option} 1 0 0"
        )));
    }
    Ok((v / most).normalize())
}

/// A number of the query, as short as it can be: a small one is never called nothing.
fn given(value: f64) -> String {
    match short(value).as_str() {
        "0" | "-0" if value != 0.0 => number(value, 4),
        text => text.to_owned(),
    }
}

/// Three components of the query; what turning them left of nothing is nothing.
fn given_triple(v: [f64; 3]) -> String {
    let most = largest_size(v);
    triple(v, |x| {
        if x.abs() < 1e-12 * most {
            "0".into()
        } else {
            given(x)
        }
    })
}

/// The query of `curve`. `chain`: for growing forces on its nodes; a machine has none.
pub(crate) fn curve_query(
    moves: &Moves,
    chain: Option<&SerialChain>,
    args: &CurveArgs,
) -> Answer<CurveQuery> {
    let constant = constant(&args.end)?;
    let place = moves.place;
    let counts = [
        ("--branches", args.branches, 1, 1000),
        ("--points", args.points, 10, 100_000),
    ];
    for (option, value, low, high) in counts {
        if value.is_some_and(|v| !(low..=high).contains(&v)) {
            return Err(
                ErrorCode::Value.failure(format!("{option} takes a number from {low} to {high}"))
            );
        }
    }
    let mut query = CurveQuery {
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
        query.force_limits = Some(ends("--force-limits", limits)?);
    }
    match (&args.direction, &args.about, &args.factor) {
        (Some(direction), None, None) => pushed(&mut query, direction, args)?,
        (None, Some(about), None) => turned(&mut query, about, args)?,
        (None, None, Some(range)) => query.range = ends("--factor", range)?,
        _ => {
            return Err(ErrorCode::Missing.failure("what shall grow? Either a displacement (--direction X Y Z --displacement-mm FROM TO, or --about X Y Z --turn-deg FROM TO) or a load (--force FX FY FZ --factor FROM TO)",
            ));
        }
    }
    if query.driven.is_some()
        && (args.force.is_some() || args.moment.is_some() || !args.grow.is_empty())
    {
        return Err(ErrorCode::Conflict.failure("--force, --moment and --grow are loads that grow with --factor; here the motion grows. A load that acts all the time is --constant-force, --constant-moment or --load NODE=FX,FY,FZ",
        ));
    }
    if let Some(driven) = query.driven {
        query.parameter = Parameter::Displacement(Twist(driven.twist()));
        query.holding = holding(moves, &args.end, &place, constant, true, Some(&driven))?;
    } else {
        load_pattern(&mut query, moves, chain, args, constant)?;
    }
    query.words.push(' ');
    query.words.push_str(&query.holding.description());
    query.words.push_str(&constant_loads_text(&args.end));
    Ok(query)
}

/// The tool is pushed along a direction.
fn pushed(query: &mut CurveQuery, direction: &[f64], args: &CurveArgs) -> Answer<()> {
    let range = args.displacement_mm.as_ref().ok_or_else(|| {
        ErrorCode::Missing.failure(
            "how far? --direction needs --displacement-mm FROM TO, as in --displacement-mm 0 20",
        )
    })?;
    let (low, high) = ends("--displacement-mm", range)?;
    if 1e-3 * larger(low.abs(), high.abs()) > FARTHEST {
        return Err(ErrorCode::Value
            .failure("--displacement-mm leads farther than 10 km; displacements are in mm"));
    }
    query.range = (1e-3 * low, 1e-3 * high);
    query.measure = Measure::Force(1.0);
    let driven = Driven {
        axis: unit("--direction", direction)?,
        turns: false,
    };
    query.words = format!(
        "The tool is pushed along {} from {} to {} mm; the force is what pushes it that way.",
        axis_description(&driven.axis),
        short(low),
        short(high)
    );
    query.driven = Some(driven);
    Ok(())
}

/// The tool is turned about a direction.
fn turned(query: &mut CurveQuery, about: &[f64], args: &CurveArgs) -> Answer<()> {
    let range = args.turn_deg.as_ref().ok_or_else(|| {
        ErrorCode::Missing
            .failure("how far? --about needs --turn-deg FROM TO, as in --turn-deg 0 5")
    })?;
    let (low, high) = ends("--turn-deg", range)?;
    if low < -180.0 || high > 180.0 {
        return Err(
            ErrorCode::Value.failure("--turn-deg: the tool can be turned by -180 to 180 degrees")
        );
    }
    query.range = (low.to_radians(), high.to_radians());
    query.measure = Measure::Moment(1.0);
    let driven = Driven {
        axis: unit("--about", about)?,
        turns: true,
    };
    query.words = format!(
        "The tool is turned about {} from {} to {} deg; the moment is what turns it that way.",
        axis_description(&driven.axis),
        short(low),
        short(high)
    );
    query.driven = Some(driven);
    Ok(())
}

/// The growing load of the options.
fn load_pattern(
    query: &mut CurveQuery,
    moves: &Moves,
    chain: Option<&SerialChain>,
    args: &CurveArgs,
    constant: Wrench,
) -> Answer<()> {
    let end = wrench(
        "--force",
        args.force.as_deref(),
        "--moment",
        args.moment.as_deref(),
    )?;
    let mut loads = Vec::new();
    for text in &args.grow {
        match chain {
            Some(chain) => loads.push(node_force(&chain.chain, "--grow", "", text)?),
            None => return Err(no_growing_nodes("--grow")),
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
        return Err(ErrorCode::Missing.failure("which load shall grow? Give --force FX FY FZ, --moment MX MY MZ or --grow NODE=FX,FY,FZ, not all zero",
        ));
    }
    query.measure = match (force > 0.0, moment > 0.0, sizes.as_slice()) {
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
    query.words = format!(
        "The load grows from {} to {} times {}.",
        given(query.range.0),
        given(query.range.1),
        parts.join(" with ")
    );
    let holding = holding(moves, &args.end, &moves.place, constant, false, None)?;
    holding.accepts("the growing load", &end)?;
    // Work of the wrench on the motions that the chain can make, moments at the natural length.
    let length = moves.directions.length;
    let pull = Vector6::from_fn(|i, _| if i < 3 { end.0[i] * length } else { end.0[i] });
    if loads.is_empty() && (moves.directions.basis.transpose() * pull).norm() < 1e-9 * pull.norm() {
        return Err(ErrorCode::RigidDirection.failure(format!(
                "the growing load does nothing: the {} is rigid in {}, where it acts. Choose another direction",
                moves.subject,
                holding.rigid.join(", ")
            ),
        ));
    }
    query.holding = holding;
    query.parameter = Parameter::Load(LoadPattern { end, loads });
    Ok(())
}
