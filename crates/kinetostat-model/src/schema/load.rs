//! Loads on a limb. Each load has exactly one word that says what it is; the word is the key and its value the load's
//! name.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A load on a limb. Gravity is written once, under `[mechanism]`; a preloaded joint is a spring
/// with a `rest`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum LoadTable {
    /// Force and moment.
    Wrench(WrenchLoad),
    /// Spring between two points.
    Spring(SpringLoad),
    /// Gas spring between two points.
    GasSpring(GasSpringLoad),
    /// Constant pull at every length between two points.
    ConstantTension(ConstantTensionLoad),
    /// Mass on a lever.
    Counterweight(CounterweightLoad),
}

/// Axes in which the components of a wrench stay constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WrenchAxes {
    /// Base axes: the wrench keeps its direction while the machine moves (dead).
    Base,
    /// Axes of its node: the wrench turns with it (follower). Not conservative.
    Node,
}

/// A point on the limb or in the base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Anchor {
    /// Name of a node, a body or a named element of the limb's chain (the frame reached behind it),
    /// 'tip' for the end of the chain, or 'base' for the machine's fixed base.
    pub node: String,
    /// The point in the axes of that node or of the base, mm; its origin if not given.
    pub position_mm: Option<[f64; 3]>,
    /// The point in the axes of that node or of the base, m.
    pub position_m: Option<[f64; 3]>,
}

/// An end of something between two points.
pub trait End {
    /// Name of what carries it, the point in mm, the point in m.
    fn written(&self) -> (&str, Option<[f64; 3]>, Option<[f64; 3]>);

    /// `'flange' at (1, 2, 3) mm`.
    fn description(&self) -> String {
        let (name, mm, m) = self.written();
        let place = match name {
            "base" => "the base".to_owned(),
            name => format!("'{name}'"),
        };
        let point = [(mm, "mm"), (m, "m")];
        let mut point = point.iter().filter_map(|(p, unit)| Some(((*p)?, unit)));
        match point.next() {
            Some(([x, y, z], unit)) => format!("{place} at ({x}, {y}, {z}) {unit}"),
            None => place,
        }
    }
}

impl End for Anchor {
    fn written(&self) -> (&str, Option<[f64; 3]>, Option<[f64; 3]>) {
        (&self.node, self.position_mm, self.position_m)
    }
}

/// A point fixed to a platform or to the base.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PlatformPoint {
    /// Name of a platform, or 'base' for the machine's fixed base.
    pub platform: String,
    /// The point in the platform's frame, mm; its origin if not given.
    pub position_mm: Option<[f64; 3]>,
    /// The point in the platform's frame, m.
    pub position_m: Option<[f64; 3]>,
}

impl End for PlatformPoint {
    fn written(&self) -> (&str, Option<[f64; 3]>, Option<[f64; 3]>) {
        (&self.platform, self.position_mm, self.position_m)
    }
}

/// A load on platforms, between any two of them or on one, whatever limbs they belong to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum PlatformLoadTable {
    /// Force and moment on one platform.
    Wrench(PlatformWrench),
    /// Spring between points of two platforms.
    Spring(SpringLoad<PlatformPoint>),
    /// Gas spring between points of two platforms.
    GasSpring(GasSpringLoad<PlatformPoint>),
    /// Constant pull at every length between points of two platforms.
    ConstantTension(ConstantTensionLoad<PlatformPoint>),
}

/// Axes in which the components of a wrench on a platform stay constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum PlatformAxes {
    /// Base axes: the wrench keeps its direction while the machine moves (dead).
    Base,
    /// Axes of the platform: the wrench turns with it (follower). Not conservative.
    Platform,
}

/// Force and moment on a platform.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "wrench"))]
pub struct PlatformWrench {
    /// Name of the load, unique among those on platforms.
    pub wrench: String,
    /// Name of the platform.
    pub platform: String,
    /// 'base': constant in base axes, as a weight is; 'platform': constant in the platform's axes, so
    /// that it turns with it.
    pub axes: PlatformAxes,
    /// Point at which the force acts, in the platform's frame, mm; its origin if not given.
    pub position_mm: Option<[f64; 3]>,
    /// Point at which the force acts, in the platform's frame, m.
    pub position_m: Option<[f64; 3]>,
    /// Force, N, in the axes that `axes` names.
    pub force_n: Option<[f64; 3]>,
    /// Moment about that point, N m.
    pub moment_n_m: Option<[f64; 3]>,
    /// Moment about that point, N mm.
    pub moment_n_mm: Option<[f64; 3]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

impl PlatformLoadTable {
    /// The word that says what the load is.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Wrench(_) => "wrench",
            Self::Spring(_) => "spring",
            Self::GasSpring(_) => "gas_spring",
            Self::ConstantTension(_) => "constant_tension",
        }
    }

    /// Name of the load: what is written at its word (`wrench`, `spring` and so on).
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Wrench(l) => &l.wrench,
            Self::Spring(l) => &l.spring,
            Self::GasSpring(l) => &l.gas_spring,
            Self::ConstantTension(l) => &l.constant_tension,
        }
    }

    /// Describes the effect in a sentence without the name of the load.
    #[must_use]
    pub fn description(&self) -> String {
        match self {
            Self::Wrench(l) => {
                let wrench = wrench_description(l.force_n, l.moment_n_m, l.moment_n_mm);
                let axes = match l.axes {
                    PlatformAxes::Base => "in base axes, keeps its direction",
                    PlatformAxes::Platform => "in the axes of its platform, turns with it",
                };
                let at = PlatformPoint {
                    platform: l.platform.clone(),
                    position_mm: l.position_mm,
                    position_m: l.position_m,
                };
                format!("{wrench} on {} {axes}", at.description())
            }
            Self::Spring(l) => l.description(),
            Self::GasSpring(l) => l.description(),
            Self::ConstantTension(l) => l.description(),
        }
    }

    /// Platforms it is fixed to, each with the keys that lead to its name.
    pub(crate) fn places(&self) -> Vec<(&'static [&'static str], &str)> {
        fn ends<'a>(
            from: &'a PlatformPoint,
            to: &'a PlatformPoint,
        ) -> Vec<(&'static [&'static str], &'a str)> {
            vec![
                (&["from", "platform"], from.platform.as_str()),
                (&["to", "platform"], to.platform.as_str()),
            ]
        }
        match self {
            Self::Wrench(l) => vec![(&["platform"], l.platform.as_str())],
            Self::Spring(l) => ends(&l.from, &l.to),
            Self::GasSpring(l) => ends(&l.from, &l.to),
            Self::ConstantTension(l) => ends(&l.from, &l.to),
        }
    }
}

fn one(list: &[(Option<f64>, &str)]) -> String {
    let mut given = list.iter().filter_map(|(v, unit)| Some((((*v)?), unit)));
    given
        .next()
        .map_or_else(String::new, |(v, unit)| format!("{v} {unit}"))
}

fn wrench_description(
    force_n: Option<[f64; 3]>,
    moment_n_m: Option<[f64; 3]>,
    moment_n_mm: Option<[f64; 3]>,
) -> String {
    let triple =
        |v: Option<[f64; 3]>, unit: &str| v.map(|[x, y, z]| format!("({x}, {y}, {z}) {unit}"));
    let force = triple(force_n, "N").map(|t| format!("force {t}"));
    let moment = triple(moment_n_m, "N m").or(triple(moment_n_mm, "N mm"));
    let moment = moment.map(|t| format!("moment {t}"));
    let parts: Vec<String> = force.into_iter().chain(moment).collect();
    parts.join(" and ")
}

impl<A: End> SpringLoad<A> {
    fn description(&self) -> String {
        let stiffness = one(&[
            (self.stiffness_n_per_m, "N/m"),
            (self.stiffness_n_per_mm, "N/mm"),
        ]);
        let free = one(&[(self.free_length_mm, "mm"), (self.free_length_m, "m")]);
        let preload = match self.preload_n {
            None | Some(0.0) => format!("no force at {free}"),
            Some(pull) => format!("{pull} N at {free}"),
        };
        let (from, to) = (self.from.description(), self.to.description());
        format!("spring of {stiffness} from {from} to {to}, {preload}")
    }
}

impl<A: End> GasSpringLoad<A> {
    fn description(&self) -> String {
        let length = one(&[(self.length_mm, "mm"), (self.length_m, "m")]);
        let (from, to) = (self.from.description(), self.to.description());
        let push = self.force_n;
        format!("gas spring from {from} to {to}, pushes with {push} N at {length}")
    }
}

impl<A: End> ConstantTensionLoad<A> {
    fn description(&self) -> String {
        let (from, to) = (self.from.description(), self.to.description());
        format!("pull of {} N between {from} and {to}", self.tension_n)
    }
}

/// Force and moment on a node, about its origin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "wrench"))]
pub struct WrenchLoad {
    /// Name of the load, unique in the limb.
    pub wrench: String,
    /// Name of a node, a body or a named element of the limb's chain, or 'tip'.
    pub node: String,
    /// 'base': constant in base axes, as a weight is; 'node': constant in the node's axes, so that
    /// it turns with it, as a jet or a propeller does.
    pub axes: WrenchAxes,
    /// Force on the node, N.
    pub force_n: Option<[f64; 3]>,
    /// Moment on the node about its origin, N m.
    pub moment_n_m: Option<[f64; 3]>,
    /// Moment on the node about its origin, N mm.
    pub moment_n_mm: Option<[f64; 3]>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Spring between two points of the limb, of one and the base, or of two platforms: a compensator. It pulls with
/// `preload + stiffness * (length - free length)`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "spring"))]
pub struct SpringLoad<A = Anchor> {
    /// Name of the load, unique in the limb or among those on platforms.
    pub spring: String,
    /// One end.
    pub from: A,
    /// The other end.
    pub to: A,
    /// Pull per length beyond the free length, N/m.
    pub stiffness_n_per_m: Option<f64>,
    /// Pull per length beyond the free length, N/mm.
    pub stiffness_n_per_mm: Option<f64>,
    /// Length at which it pulls with the preload (without force if none is given), mm. 0 is allowed:
    /// the ideal compensator.
    pub free_length_mm: Option<f64>,
    /// Length at which it pulls with the preload (without force if none is given), m.
    pub free_length_m: Option<f64>,
    /// Pull at the free length, N; negative pushes.
    pub preload_n: Option<f64>,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// Gas spring between two points of the limb, of one and the base, or of two platforms. Pressed in by `s` it
/// pushes with `force * (column / (column - s))^exponent`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "gas_spring"))]
pub struct GasSpringLoad<A = Anchor> {
    /// Name of the load, unique in the limb or among those on platforms.
    pub gas_spring: String,
    /// One end.
    pub from: A,
    /// The other end.
    pub to: A,
    /// Push at the length that is given, N.
    pub force_n: f64,
    /// Length at which it pushes with that force (usually extended), mm.
    pub length_mm: Option<f64>,
    /// Length at which it pushes with that force, m.
    pub length_m: Option<f64>,
    /// Volume of the gas at that length over the area of the rod, mm: the stroke at which the push
    /// would become infinite. The longer, the flatter the characteristic.
    pub column_mm: Option<f64>,
    /// Volume of the gas at that length over the area of the rod, m.
    pub column_m: Option<f64>,
    /// 1 for slow motion (isothermal), 1.4 for fast motion of nitrogen (adiabatic).
    pub exponent: f64,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// A pull that does not depend on the length: a rope over a pulley, a balancer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "constant_tension"))]
pub struct ConstantTensionLoad<A = Anchor> {
    /// Name of the load, unique in the limb or among those on platforms.
    pub constant_tension: String,
    /// One end.
    pub from: A,
    /// The other end.
    pub to: A,
    /// Pull between the ends, N; negative pushes.
    pub tension_n: f64,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

/// A mass on a lever that is fixed to a node; gravity pulls at it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("x-word" = "counterweight"))]
pub struct CounterweightLoad {
    /// Name of the load, unique in the limb.
    pub counterweight: String,
    /// Position of its centre.
    pub at: Anchor,
    /// Mass, kg, whose weight acts at its centre.
    pub mass_kg: f64,
    /// Source of the figures.
    pub source: Option<String>,
    /// Assumption behind the figures.
    pub assumption: Option<String>,
}

impl LoadTable {
    /// The word that says what the load is.
    #[must_use]
    pub fn word(&self) -> &'static str {
        match self {
            Self::Wrench(_) => "wrench",
            Self::Spring(_) => "spring",
            Self::GasSpring(_) => "gas_spring",
            Self::ConstantTension(_) => "constant_tension",
            Self::Counterweight(_) => "counterweight",
        }
    }

    /// Name of the load: what is written at its word (`wrench`, `spring` and so on).
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Wrench(l) => &l.wrench,
            Self::Spring(l) => &l.spring,
            Self::GasSpring(l) => &l.gas_spring,
            Self::ConstantTension(l) => &l.constant_tension,
            Self::Counterweight(l) => &l.counterweight,
        }
    }

    /// Describes the effect in a sentence without the name of the load: `spring of 5 N/mm from the base at ...`.
    #[must_use]
    pub fn description(&self) -> String {
        match self {
            Self::Wrench(l) => {
                let wrench = wrench_description(l.force_n, l.moment_n_m, l.moment_n_mm);
                let axes = match l.axes {
                    WrenchAxes::Base => "in base axes, keeps its direction",
                    WrenchAxes::Node => "in the axes of its node, turns with it",
                };
                format!("{wrench} on '{}' {axes}", l.node)
            }
            Self::Spring(l) => l.description(),
            Self::GasSpring(l) => l.description(),
            Self::ConstantTension(l) => l.description(),
            Self::Counterweight(l) => format!("{} kg at {}", l.mass_kg, l.at.description()),
        }
    }

    /// Places it is fixed to: the key, further keys to the name of the place, that name.
    pub(crate) fn places(&self) -> Vec<(&'static [&'static str], &str)> {
        const FROM: &[&str] = &["from", "node"];
        const TO: &[&str] = &["to", "node"];
        let between = |from, to| {
            let (from, to): (&Anchor, &Anchor) = (from, to);
            vec![(FROM, from.node.as_str()), (TO, to.node.as_str())]
        };
        match self {
            Self::Wrench(l) => vec![(&["node"], l.node.as_str())],
            Self::Counterweight(l) => vec![(&["at", "node"], l.at.node.as_str())],
            Self::Spring(l) => between(&l.from, &l.to),
            Self::GasSpring(l) => between(&l.from, &l.to),
            Self::ConstantTension(l) => between(&l.from, &l.to),
        }
    }
}
