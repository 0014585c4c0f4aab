//! A mechanism: a graph of platforms (rigid bodies in equilibrium; the first one, the base, is
//! fixed) joined by limbs (chains) [R ch. 3, 6].
//!
//! Each limb keeps two geometries: the nominal one, from which the controller commands actuators,
//! and the actual one, with its assembly and manufacturing errors, which decides where the machine
//! goes.

use std::sync::Arc;

use crate::error::{Error, Place, Result};
use crate::model::chain::{Chain, Scale};
use crate::model::loads::check::moments_have_potential;
use crate::model::loads::load::Load;
use crate::model::loads::platform::PlatformLoad;
use crate::number::larger;
use crate::spatial::Pose;
use nalgebra::{Matrix3, Vector3};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// A rigid body of the graph.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = ActuatorSpec::new(MotionKind::Revolute, Vector3::x(), 4e4); // N m/rad
/// # let chain = Chain::builder("hinge").actuator("hinge", slide).build()?;
/// let head = Platform {
///     mass: 50.0, // kg
///     centre_of_mass: vector![0.1, 0.2, -0.05], // m
///     ..Platform::new("head", Pose::identity())
/// };
/// let mut machine = Mechanism::builder("tilting head").gravity(vector![0.0, 0.0, -9.81]); // m/s^2
/// let head = machine.platform(head);
/// let machine = machine.limb(Limb::between("hinge", 0, head, chain)).build()?;
/// let tilted = machine.posture(&Pose::identity())?.deflected_by(&Wrench::zero())?;
/// // The hinge turns about x until its spring holds the weight at the arm that it has then.
/// let angle = tilted.tool.rotation.scaled_axis().x;
/// let arm = (tilted.tool * nalgebra::Point3::new(0.1, 0.2, -0.05)).y;
/// assert!(angle < 0.0 && (4e4 * angle + 50.0 * 9.81 * arm).abs() < 1e-6);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Platform {
    /// Name, unique.
    pub name: String,
    /// Pose at which the machine is at home, base from platform.
    pub home: Pose,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the platform's frame, m.
    pub centre_of_mass: Vector3<f64>,
    /// Inertia about the centre of mass, kg m^2, platform axes (kept for dynamics).
    pub inertia: Matrix3<f64>,
}

impl Platform {
    /// A massless platform.
    #[must_use]
    pub fn new(name: impl Into<String>, home: Pose) -> Self {
        Self {
            name: name.into(),
            home,
            mass: 0.0,
            centre_of_mass: Vector3::zeros(),
            inertia: Matrix3::zeros(),
        }
    }
}

/// A chain between two platforms. Its base frame is the frame of `from`; its tip is fixed to `to`.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.05, 0.04); // Pa, m
/// let boom = |head: f64| {
///     Chain::builder("boom")
///         .actuator("slide", ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), 1e7)) // N/m
///         .link("bar", &bar, 0.5)
///         .translation(vector![head, 0.0, 0.0])
///         .build()
/// };
/// // Its tip holds the platform 0.1 m left of the platform's reference point, and it its head came out 1 mm too long.
/// let tip_on_platform = Pose::translation(-0.1, 0.0, 0.05);
/// let limb = Limb::between("boom", 0, 1, boom(0.02)?).fixed_at(tip_on_platform).with_actual(boom(0.021)?);
/// let mut machine = Mechanism::builder("crane");
/// let tool = machine.platform(Platform::new("tool", Pose::translation(0.62, 0.0, -0.05)));
/// let machine = machine.limb(limb).build()?;
/// let posture = machine.posture(&machine.platforms()[tool].home)?;
/// let unloaded = posture.deflected_by(&Wrench::zero())?;
/// assert!((unloaded.displacement.linear() - vector![1e-3, 0.0, 0.0]).norm() < 1e-12, "1 mm beyond its target");
/// // The limb carries the load on the platform, whose lever arm is that between tip and reference point.
/// let load = Wrench::new(vector![200.0, -150.0, 80.0], vector![0.0, 5.0, 10.0]); // N, N m
/// let loaded = posture.deflected_by(&load)?;
/// let arm = loaded.tool.rotation * tip_on_platform.translation.vector;
/// assert!((loaded.limbs[0].wrench - load.shifted(&arm)).0.norm() < 1e-6);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[non_exhaustive]
pub struct Limb {
    /// Name, unique.
    pub name: String,
    /// Index of the platform where it starts.
    pub from: usize,
    /// Index of the platform where it ends.
    pub to: usize,
    /// Pose of the tip in the frame of `to`. A limb that ends at the platform's reference point
    /// has the identity; elsewhere the lever arm's geometric stiffness is accounted for.
    pub platform_from_tip: Pose,
    /// Geometry that the controller believes in.
    pub nominal: Chain,
    /// Geometry that exists: same joints and springs, other rigid offsets.
    pub actual: Chain,
}

impl Limb {
    /// A limb as it is drawn, from one platform to another (their indices), whose tip is the reference
    /// point of the second.
    #[must_use]
    pub fn between(name: impl Into<String>, from: usize, to: usize, chain: Chain) -> Self {
        Self {
            name: name.into(),
            from,
            to,
            platform_from_tip: Pose::identity(),
            nominal: chain.clone(),
            actual: chain,
        }
    }

    /// Fixes the tip elsewhere on the second platform (platform from tip).
    #[must_use]
    pub fn fixed_at(mut self, platform_from_tip: Pose) -> Self {
        self.platform_from_tip = platform_from_tip;
        self
    }

    /// Sets the geometry that exists, errors included.
    #[must_use]
    pub fn with_actual(mut self, actual: Chain) -> Self {
        self.actual = actual;
        self
    }
}

/// Platforms, limbs, loads on limbs and gravity. Never changes after
/// [`MechanismBuilder::build`](crate::MechanismBuilder::build), and is shared: a copy costs nothing, so that
/// postures and batches own theirs and go to other threads with it.
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// # let slide = |axis, home, stiffness| {
/// #     ActuatorSpec { home, ..ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness) }
/// # };
/// # let rail = Chain::builder("rail")
/// #     .translation(vector![0.0, 0.0, 1.0])
/// #     .actuator("trolley", slide(Vector3::x(), 0.3, 1e6)) // N/m
/// #     .build()?;
/// # let boom = Chain::builder("boom")
/// #     .translation(vector![0.0, 0.2, 0.0])
/// #     .actuator("hoist", slide(Vector3::z(), -0.5, 1e5)) // N/m
/// #     .build()?;
/// # let mut machine = Mechanism::builder("crane");
/// # let carriage = machine.platform(Platform::new("carriage", Pose::translation(0.3, 0.0, 1.0)));
/// # let home = Pose::translation(0.3, 0.2, 0.5);
/// # let hook = machine.platform(Platform { mass: 40.0, ..Platform::new("hook", home) });
/// let crane = machine
///     .limb(Limb::between("rail", 0, carriage, rail))
///     .limb(Limb::between("boom", carriage, hook, boom))
///     .gravity(vector![0.0, 0.0, -9.81]) // m/s^2
///     .build()?;
/// assert_eq!(crane.name(), "crane");
/// assert_eq!(crane.platforms()[0].name, "base");
/// assert_eq!(crane.platform_named("hook")?, crane.tool());
/// assert_eq!(crane.limbs()[crane.limb_named("boom")?].from, carriage);
/// assert_eq!(crane.actuator_names(), ["rail.trolley", "boom.hoist"]);
/// assert_eq!(crane.actuator_count(), 2);
/// assert_eq!(crane.posture(&home)?.commands(), [0.3, -0.5]); // m, in this order
/// assert_eq!(crane.gravity(), vector![0.0, 0.0, -9.81]);
/// // A rail of 1 m carries a boom of 0.2 m.
/// assert!((crane.size() - 1.2).abs() < 1e-15 && (crane.natural_length() - 0.6).abs() < 1e-15);
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(from = "MechanismParts", into = "MechanismParts")
)]
pub struct Mechanism {
    parts: Arc<MechanismParts>,
}

/// Parts of a mechanism.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename = "Mechanism"))]
pub(crate) struct MechanismParts {
    pub(crate) name: String,
    pub(crate) platforms: Vec<Platform>,
    pub(crate) limbs: Vec<Limb>,
    pub(crate) gravity: Vector3<f64>,
    pub(crate) tool: usize,
    /// Loads on every limb besides gravity; shorter than the list of limbs where the last have none.
    #[cfg_attr(
        feature = "serde",
        serde(
            default,
            skip_deserializing,
            skip_serializing_if = "Vec::is_empty",
            serialize_with = "refuse_loads"
        )
    )]
    pub(crate) loads: Vec<Vec<Load>>,
    /// Loads on platforms, those between limbs included.
    #[cfg_attr(
        feature = "serde",
        serde(
            default,
            skip_deserializing,
            skip_serializing_if = "Vec::is_empty",
            serialize_with = "refuse_platform_loads"
        )
    )]
    pub(crate) platform_loads: Vec<PlatformLoad>,
}

impl From<MechanismParts> for Mechanism {
    fn from(parts: MechanismParts) -> Self {
        Self {
            parts: Arc::new(parts),
        }
    }
}

impl From<Mechanism> for MechanismParts {
    fn from(mechanism: Mechanism) -> Self {
        Arc::unwrap_or_clone(mechanism.parts)
    }
}

/// A load may be a function, which no file holds; to leave it out in silence would be worse.
#[cfg(feature = "serde")]
fn refuse_loads<S: serde::Serializer>(
    _: &[Vec<Load>],
    _: S,
) -> std::result::Result<S::Ok, S::Error> {
    Err(serde::ser::Error::custom(
        "a mechanism whose limbs carry loads cannot be written; write its model file",
    ))
}

#[cfg(feature = "serde")]
fn refuse_platform_loads<S: serde::Serializer>(
    _: &[PlatformLoad],
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    refuse_loads(&[], serializer)
}

impl Mechanism {
    /// A serial robot: one chain from the base to the platform `tool`.
    ///
    /// # Errors
    /// As [`MechanismBuilder::build`](crate::MechanismBuilder::build).
    pub fn serial(chain: Chain, home: Pose, gravity: Vector3<f64>) -> Result<Self> {
        let name = chain.name.clone();
        let mut builder = Self::builder(&name).gravity(gravity);
        let tool = builder.platform(Platform::new("tool", home));
        builder.limb(Limb::between(name, 0, tool, chain)).build()
    }

    /// Name of the mechanism, as error messages show it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.parts.name
    }

    /// Platforms; index 0 is the fixed base.
    #[must_use]
    pub fn platforms(&self) -> &[Platform] {
        &self.parts.platforms
    }

    /// Mass of everything that moves, kg: platforms, bodies, and what is spread along links.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3};
    /// # use kinetostat::*;
    /// let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 4e6);
    /// let table = Chain::builder("table").actuator("slide", slide).body("table", 40.0, Vector3::zeros(), Matrix3::zeros()).build()?;
    /// let machine = Mechanism::serial(table, Pose::identity(), Vector3::zeros())?;
    /// assert_eq!(machine.moving_mass(), 40.0);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn moving_mass(&self) -> f64 {
        let of_platforms = self.platforms().iter().map(|platform| platform.mass);
        let of_limbs = self.limbs().iter().map(|limb| limb.actual.mass());
        of_platforms.chain(of_limbs).sum()
    }

    /// Limbs in the order in which they were added.
    #[must_use]
    pub fn limbs(&self) -> &[Limb] {
        &self.parts.limbs
    }

    /// Index of the platform of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the names that exist.
    pub fn platform_named(&self, name: &str) -> Result<usize> {
        let names = self.platforms().iter().map(|platform| &platform.name);
        self.index_of("platform", name, names)
    }

    /// Index of the limb of this name.
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the names that exist.
    pub fn limb_named(&self, name: &str) -> Result<usize> {
        let names = self.limbs().iter().map(|limb| &limb.name);
        self.index_of("limb", name, names)
    }

    fn index_of<'a>(
        &self,
        what: &'static str,
        name: &str,
        names: impl Iterator<Item = &'a String>,
    ) -> Result<usize> {
        let known: Vec<&str> = names.map(String::as_str).collect();
        let index = known.iter().position(|known| *known == name);
        index.ok_or_else(|| Error::UnknownName {
            place: self.place(),
            what,
            name: name.to_owned(),
            known: known.join(", "),
        })
    }

    /// Mutable parts; a copy if they are shared.
    pub(crate) fn parts_mut(&mut self) -> &mut MechanismParts {
        Arc::make_mut(&mut self.parts)
    }

    /// Place of this mechanism in errors.
    pub(crate) fn place(&self) -> Place {
        Place::mechanism(self.name())
    }

    /// Gravity, m/s^2, base axes.
    #[must_use]
    pub fn gravity(&self) -> Vector3<f64> {
        self.parts.gravity
    }

    /// Loads on a limb besides gravity, in the order in which they were added.
    #[must_use]
    pub fn loads(&self, limb: usize) -> &[Load] {
        self.parts.loads.get(limb).map_or(&[], Vec::as_slice)
    }

    /// Natural length, m: the mean over its limbs.
    #[must_use]
    pub fn natural_length(&self) -> f64 {
        let sum: f64 = self.limbs().iter().map(|l| l.actual.scale().length).sum();
        sum / self.limbs().len() as f64
    }

    /// True if anything acts on it without a load on its tool: gravity on its masses, or loads of the model.
    #[must_use]
    pub fn has_own_loads(&self) -> bool {
        let loads =
            self.parts.loads.iter().map(Vec::len).sum::<usize>() + self.parts.platform_loads.len();
        let has_weight = self.gravity() != Vector3::zeros() && self.moving_mass() > 0.0;
        has_weight || loads > 0
    }

    /// Removes gravity and the loads of the model (springs between nodes, counterweights and so on). Deviations and
    /// preloads of springs inside its limbs stay.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis, home, stiffness| {
    /// #     ActuatorSpec { home, ..ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness) }
    /// # };
    /// # let rail = Chain::builder("rail")
    /// #     .translation(vector![0.0, 0.0, 1.0])
    /// #     .actuator("trolley", slide(Vector3::x(), 0.3, 1e6)) // N/m
    /// #     .build()?;
    /// # let boom = Chain::builder("boom")
    /// #     .translation(vector![0.0, 0.2, 0.0])
    /// #     .actuator("hoist", slide(Vector3::z(), -0.5, 1e5)) // N/m
    /// #     .build()?;
    /// # let mut machine = Mechanism::builder("crane");
    /// # let carriage = machine.platform(Platform::new("carriage", Pose::translation(0.3, 0.0, 1.0)));
    /// # let home = Pose::translation(0.3, 0.2, 0.5);
    /// # let hook = machine.platform(Platform { mass: 40.0, ..Platform::new("hook", home) });
    /// # let crane = machine
    /// #     .limb(Limb::between("rail", 0, carriage, rail))
    /// #     .limb(Limb::between("boom", carriage, hook, boom))
    /// #     .gravity(vector![0.0, 0.0, -9.81]) // m/s^2
    /// #     .build()?;
    /// assert!(crane.has_own_loads(), "the hook has a mass of 40 kg");
    /// let sunk = crane.posture(&home)?.deflected_by(&Wrench::zero())?.displacement.linear();
    /// assert!((sunk - vector![0.0, 0.0, -40.0 * 9.81 / 1e5]).norm() < 1e-12, "on the spring of its hoist");
    /// let weightless = crane.without_own_loads();
    /// assert!(!weightless.has_own_loads());
    /// let still = weightless.posture(&home)?.deflected_by(&Wrench::zero())?.displacement;
    /// assert!(still.linear().norm() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn without_own_loads(&self) -> Self {
        let mut parts = MechanismParts::clone(&self.parts);
        parts.gravity = Vector3::zeros();
        parts.loads.clear();
        parts.platform_loads.clear();
        parts.into()
    }

    /// Scales the stiffness of springs: limb, index among [`Chain::springs`], factor. Nominal and actual chains change
    /// alike; missing ones are skipped.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let slide = |axis, stiffness| ActuatorSpec::new(MotionKind::Prismatic, axis, stiffness);
    /// # let chain = Chain::builder("table").actuator("long", slide(Vector3::x(), 8e7)).build()?; // N/m
    /// let table = Mechanism::serial(chain, Pose::identity(), Vector3::zeros())?;
    /// let stiffer = table.with_springs_scaled(&[(0, 0, 2.0)]);
    /// assert_eq!(stiffer.limbs()[0].actual.springs()[0].stiffness_at(&[0.0])[(0, 0)], 1.6e8);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn with_springs_scaled(&self, factors: &[(usize, usize, f64)]) -> Self {
        let mut scaled = self.clone();
        let limbs = &mut scaled.parts_mut().limbs;
        for &(limb, spring, factor) in factors {
            let Some(limb) = limbs.get_mut(limb) else {
                continue;
            };
            for chain in [&mut limb.nominal, &mut limb.actual] {
                if let Some(block) = chain.springs.get_mut(spring) {
                    block.law = block.law.scaled(factor);
                }
            }
        }
        scaled
    }

    /// Loads on platforms, those between limbs included, in the order in which they were added.
    #[must_use]
    pub fn platform_loads(&self) -> &[PlatformLoad] {
        &self.parts.platform_loads
    }

    /// Everything that acts on a limb between its ends: gravity, then its loads.
    pub(crate) fn acting(&self, limb: usize) -> Vec<Load> {
        let gravity = (self.gravity() != Vector3::zeros()).then_some(Load::Gravity(self.gravity()));
        gravity
            .into_iter()
            .chain(self.loads(limb).iter().cloned())
            .collect()
    }

    /// The load has a potential on this limb: statements about energy hold. A dead moment has one
    /// only where everything before its node, from the fixed base on, turns about one axis.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let hinge = |axis| ActuatorSpec::new(MotionKind::Revolute, axis, 2e5); // N m/rad
    /// let chain = Chain::builder("wrist")
    ///     .actuator("yaw", hinge(Vector3::z()))
    ///     .node("fork")
    ///     .actuator("pitch", hinge(Vector3::y()))
    ///     .translation(vector![0.1, 0.0, 0.0])
    ///     .build()?;
    /// let (fork, tip) = (chain.node("fork")?, chain.tip());
    /// let wrist = Mechanism::serial(chain, Pose::translation(0.1, 0.0, 0.0), Vector3::zeros())?;
    /// // The fork turns about one axis, and a moment on it has a potential; what is behind turns about two.
    /// let moment = |node| Load::dead(node, Wrench::new(Vector3::zeros(), vector![0.0, 0.0, 5.0])); // N m
    /// assert!(wrist.load_conservative(0, &moment(fork)) && !wrist.load_conservative(0, &moment(tip)));
    /// assert!(wrist.with_load("wrist", moment(fork))?.loads_conservative(0));
    /// assert!(!wrist.with_load("wrist", moment(fork))?.with_load("wrist", moment(tip))?.loads_conservative(0));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn load_conservative(&self, limb: usize, load: &Load) -> bool {
        let own = &self.limbs()[limb];
        match load {
            Load::Dead { wrench, .. } if own.from != 0 => wrench.moment() == Vector3::zeros(),
            load => load.conservative(&own.actual),
        }
    }

    /// All loads of a limb have a potential.
    #[must_use]
    pub fn loads_conservative(&self, limb: usize) -> bool {
        let mut loads = self.loads(limb).iter();
        loads.all(|load| self.load_conservative(limb, load))
    }

    /// A dead moment on the tool (N m) has a potential: some limb from the base lets the tool turn
    /// about one axis only.
    pub(crate) fn tool_moment_has_potential(&self, moment: &Vector3<f64>) -> bool {
        *moment == Vector3::zeros()
            || self.limbs().iter().any(|limb| {
                limb.from == 0
                    && limb.to == self.tool()
                    && moments_have_potential(&limb.actual, limb.actual.tip())
            })
    }

    /// Index of the platform that carries the tool: the last one.
    #[must_use]
    pub fn tool(&self) -> usize {
        self.parts.tool
    }

    /// Natural length and stiffness: means over the limbs as they are.
    pub(crate) fn scale(&self) -> Scale {
        let count = self.limbs().len() as f64;
        let mean = |of: fn(Scale) -> f64| {
            self.limbs()
                .iter()
                .map(|l| of(l.actual.scale()))
                .sum::<f64>()
                / count
        };
        Scale {
            length: mean(|s| s.length),
            stiffness: mean(|s| s.stiffness),
        }
    }

    /// Size, m: the length of the path from the base to the tool through the limbs, or of the longest
    /// limb where that is longer.
    #[must_use]
    pub fn size(&self) -> f64 {
        let lengths: Vec<f64> = self
            .limbs()
            .iter()
            .map(|l| l.nominal.scale().length)
            .collect();
        // Lengths of the shortest paths to all platforms.
        let mut distances = vec![f64::INFINITY; self.platforms().len()];
        distances[0] = 0.0;
        let mut shorter = true;
        while shorter {
            shorter = false;
            for (limb, length) in self.limbs().iter().zip(&lengths) {
                for (to, from) in [(limb.to, limb.from), (limb.from, limb.to)] {
                    if distances[from] + length < distances[to] {
                        distances[to] = distances[from] + length;
                        shorter = true;
                    }
                }
            }
        }
        let longest = lengths.iter().copied().fold(0.0, larger);
        match distances[self.tool()].is_finite() {
            true => larger(longest, distances[self.tool()]),
            false => longest,
        }
    }

    /// Number of actuators of all limbs.
    #[must_use]
    pub fn actuator_count(&self) -> usize {
        self.limbs().iter().map(|l| l.nominal.actuators.len()).sum()
    }

    /// `limb.actuator` of every actuator, in the order of [`crate::Posture::commands`].
    #[must_use]
    pub fn actuator_names(&self) -> Vec<String> {
        let single = self.limbs().len() == 1;
        self.limbs()
            .iter()
            .flat_map(|l| {
                l.nominal.actuators.iter().map(move |a| {
                    if single {
                        a.name.clone()
                    } else {
                        format!("{}.{}", l.name, a.name)
                    }
                })
            })
            .collect()
    }
}

impl Mechanism {
    /// This machine as it was built, commanded by a controller that believes in another one: that of the drawing. Its links,
    /// springs, loads and masses are its own; commands are computed from the geometry of `drawn`.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let arm = |length: f64| {
    ///     let chain = Chain::builder("arm")
    ///         .actuator("slide", ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), 1e6)) // N/m
    ///         .translation(vector![length, 0.0, 0.0])
    ///         .build()?;
    ///     Mechanism::serial(chain, Pose::translation(length, 0.0, 0.0), Vector3::zeros())
    /// };
    /// let drawn = arm(0.5)?;
    /// let built = arm(0.501)?.commanded_as(&drawn)?;
    /// let unloaded = built.posture(&Pose::translation(0.5, 0.0, 0.1))?.deflected_by(&Wrench::zero())?;
    /// assert!((unloaded.displacement.linear() - vector![0.001, 0.0, 0.0]).norm() < 1e-12, "it came out 1 mm too long");
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Model`] if the two differ in more than numbers: in platforms, limbs, joints or springs.
    pub fn commanded_as(&self, drawn: &Self) -> Result<Self> {
        let differ = |what: &str| {
            Err(Error::model(
                self.place(),
                format!("is not built as drawn: {what}"),
            ))
        };
        let mut built = MechanismParts::clone(&self.parts);
        let (ours, theirs) = (&mut built.limbs, drawn.limbs());
        if ours.len() != theirs.len() || built.platforms.len() != drawn.platforms().len() {
            return differ("it has other limbs or platforms");
        }
        for (own, other) in ours.iter_mut().zip(theirs) {
            let (a, b) = (&mut own.actual, &other.nominal);
            if (own.from, own.to) != (other.from, other.to)
                || a.elements.len() != b.elements.len()
                || a.coordinate_count() != b.coordinate_count()
                || a.actuators().len() != b.actuators().len()
            {
                return differ("a limb has other elements");
            }
            // A different attachment to the platform is an error of the limb for a controller that believes in the
            // drawing.
            if own.platform_from_tip != other.platform_from_tip {
                let tip = own.platform_from_tip.inverse() * other.platform_from_tip;
                own.nominal = other.nominal.clone();
                for (chain, offset) in [(a, tip), (&mut own.nominal, Pose::identity())] {
                    // Inserted behind everything but the node of the tip, which is the last element.
                    let at = chain.elements.len().saturating_sub(1);
                    let rigid = crate::model::chain::Element::Rigid(offset);
                    chain.elements.insert(at, rigid);
                }
                own.platform_from_tip = other.platform_from_tip;
            } else {
                own.nominal = other.nominal.clone();
            }
        }
        for (own, other) in built.platforms.iter_mut().zip(drawn.platforms()) {
            own.home = other.home;
        }
        Ok(built.into())
    }

    /// Moves the tool platform's reference point and axes to `tool` (platform from tool): a spindle's tip, say. Results
    /// then refer to that point.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let (length, bar) = (0.6, BeamSection::tube(2.1e11, 8.1e10, 0.08, 0.06)); // m, Pa
    /// let shoulder = 2e5; // N m/rad
    /// let chain = Chain::builder("arm")
    ///     .actuator("shoulder", ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), shoulder))
    ///     .link("arm", &bar, length)
    ///     .build()?;
    /// let arm = Mechanism::serial(chain, Pose::translation(length, 0.0, 0.0), Vector3::zeros())?;
    /// let spindle = Pose::translation(0.15, 0.0, -0.1); // m, ahead of and below the flange
    /// let milling = arm.with_tool(&spindle);
    /// let home = milling.platforms()[milling.tool()].home;
    /// assert!((home.translation.vector - vector![0.75, 0.0, -0.1]).norm() < 1e-15);
    /// let compliance = milling.posture(&home)?.stiffness()?.compliance().springs; // m/N
    /// // A force across at the spindle turns the shoulder, bends the arm, and twists it by the height.
    /// let bending = (0.75_f64.powi(3) - 0.15_f64.powi(3)) / (3.0 * 2.1e11 * bar.second_moment_z);
    /// let torsion = 0.1 * 0.1 * length / (8.1e10 * bar.torsion_constant);
    /// let across = 0.75 * 0.75 / shoulder + bending + torsion;
    /// assert!((compliance[(1, 1)] / across - 1.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn with_tool(&self, tool: &Pose) -> Self {
        let mut moved = MechanismParts::clone(&self.parts);
        let inverse = tool.inverse();
        for limb in &mut moved.limbs {
            if limb.to == moved.tool {
                limb.platform_from_tip = inverse * limb.platform_from_tip;
            }
            if limb.from == moved.tool {
                for chain in [&mut limb.nominal, &mut limb.actual] {
                    chain
                        .elements
                        .insert(0, crate::model::chain::Element::Rigid(inverse));
                }
            }
        }
        for load in &mut moved.platform_loads {
            *load = load.reframed(moved.tool, tool);
        }
        let platform = &mut moved.platforms[moved.tool];
        platform.home *= *tool;
        platform.centre_of_mass =
            (inverse * nalgebra::Point3::from(platform.centre_of_mass)).coords;
        let turn = tool.rotation.to_rotation_matrix();
        platform.inertia = turn.matrix().transpose() * platform.inertia * turn.matrix();
        moved.into()
    }
}
