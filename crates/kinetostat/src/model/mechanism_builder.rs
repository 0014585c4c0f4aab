//! The words from which a mechanism is written, and what is checked before it is frozen.

use std::collections::BTreeSet;

use nalgebra::Vector3;

use crate::error::{Error, Part, Place, Result};
use crate::model::kinematics::Kinematics;
use crate::model::limits::{check_numbers, check_pose};
use crate::model::loads::check::check_load;
use crate::model::loads::load::Load;
use crate::model::loads::platform::PlatformLoad;
use crate::model::mechanism::{Limb, Mechanism, MechanismParts, Platform};
use crate::spatial::Pose;

/// Builds a [`Mechanism`] from platforms, the limbs between them, and loads.
#[derive(Clone, Debug)]
pub struct MechanismBuilder {
    mechanism: MechanismParts,
    /// Name of a limb and a load on it.
    loads: Vec<(String, Load)>,
}

impl MechanismBuilder {
    /// Adds a moving platform and returns its index. The last one added carries the tool.
    pub fn platform(&mut self, platform: Platform) -> usize {
        self.mechanism.platforms.push(platform);
        self.mechanism.tool = self.mechanism.platforms.len() - 1;
        self.mechanism.tool
    }

    /// Adds a limb after those added before; the mechanism keeps their order.
    #[must_use]
    pub fn limb(mut self, limb: Limb) -> Self {
        self.mechanism.limbs.push(limb);
        self
    }

    /// Adds a load to the limb of this name. Nodes are those of the limb's chain
    /// ([`Chain::node`](crate::Chain::node)); `Anchor::Base` and base axes mean the world, also for a limb that starts
    /// at a moving platform. What acts on the limb's tip acts on the platform there. Gravity is
    /// [`Self::gravity`]'s affair, not a load of a limb.
    ///
    /// ```
    /// use kinetostat::*;
    /// use nalgebra::{Vector3, vector};
    ///
    /// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.08, 0.06);
    /// let shoulder = ActuatorSpec::new(MotionKind::Revolute, -Vector3::y(), 2e5);
    /// let chain = Chain::builder("arm")
    ///     .actuator("shoulder", shoulder)
    ///     .translation(vector![0.4, 0.0, 0.0])
    ///     .node("lug")
    ///     .link("arm", &bar, 0.6)
    ///     .build()?;
    /// let (lug, post) = (Anchor::node(chain.node("lug")?), Anchor::Base(vector![0.0, 0.0, 0.5]));
    /// let mut machine = Mechanism::builder("sprung arm");
    /// let tool = machine.platform(Platform::new("tool", Pose::translation(1.0, 0.0, 0.0)));
    /// let machine = machine
    ///     .limb(Limb::between("arm", 0, tool, chain))
    ///     .load("arm", Load::spring_between(post, lug, 4e3, 0.3))
    ///     .build()?;
    /// let home = machine.platforms()[tool].home;
    /// let rest = machine.posture(&home)?.deflected_by(&Wrench::zero())?;
    /// assert!(rest.displacement.linear().z > 1e-3, "the spring lifts the arm");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn load(mut self, limb: impl Into<String>, load: Load) -> Self {
        self.loads.push((limb.into(), load));
        self
    }

    /// Adds a load on platforms: a wrench on any of them, or a spring or compensator between points
    /// of two, whatever limbs they belong to. It is there in every equilibrium; commands and the
    /// unloaded stiffness do not feel it.
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
    /// // A spring from the base, straight under the hook, pulls it down; a wire pulls the carriage aside.
    /// let law = LengthLaw::Linear { stiffness: 2e4, free_length: 0.4, preload: 0.0 }; // N/m, m, N
    /// let spring = PlatformLoad::strut(
    ///     Anchor::on_platform(0, vector![0.3, 0.2, 0.0]),
    ///     Anchor::on_platform(hook, Vector3::zeros()),
    ///     law,
    /// );
    /// let pull = Wrench::new(vector![250.0, 0.0, 0.0], Vector3::zeros()); // N
    /// let point = vector![0.0, 0.1, 0.0]; // m
    /// let wire = PlatformLoad::Wrench { platform: carriage, point, wrench: pull, turns: false };
    /// let crane = machine
    ///     .limb(Limb::between("rail", 0, carriage, rail))
    ///     .limb(Limb::between("boom", carriage, hook, boom))
    ///     .platform_load(spring)
    ///     .platform_load(wire)
    ///     .build()?;
    /// assert_eq!(crane.platform_loads().len(), 2);
    /// let moved = crane.posture(&home)?.deflected_by(&Wrench::zero())?.displacement.linear();
    /// assert!((moved.x - 250.0 / 1e6).abs() < 1e-6, "the trolley's spring gives way, and takes the hook along");
    /// assert!((moved.z + 2e4 * 0.1 / (1e5 + 2e4)).abs() < 1e-6, "two springs share the 100 mm of stretch");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn platform_load(mut self, load: PlatformLoad) -> Self {
        self.mechanism.platform_loads.push(load);
        self
    }

    /// Gravity, m/s^2, base axes; zero if not called.
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
    ///     .gravity(vector![1.0, 0.0, -9.81]) // m/s^2: it stands on a slope
    ///     .build()?;
    /// // The mass of 40 kg hangs on the hoist's spring, and pulls the trolley down the slope.
    /// let sunk = crane.posture(&home)?.deflected_by(&Wrench::zero())?.displacement.linear();
    /// assert!((sunk - vector![40.0 / 1e6, 0.0, -40.0 * 9.81 / 1e5]).norm() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn gravity(mut self, gravity: Vector3<f64>) -> Self {
        self.mechanism.gravity = gravity;
        self
    }

    /// Checks the graph and freezes it.
    ///
    /// # Errors
    /// [`Error::Model`] for an unknown platform, a limb from a platform to itself, a name used
    /// twice, a platform without limbs, a nominal and an actual chain that differ in more than
    /// rigid offsets, or a load that does not fit its limb or its platforms; [`Error::UnknownName`] for a load on
    /// a limb that does not exist.
    pub fn build(self) -> Result<Mechanism> {
        let mut m = self.mechanism;
        let place = Place::mechanism(m.name.as_str());
        let fault = |reason: String| Err(Error::model(place.clone(), reason));
        if m.platforms.len() < 2 {
            return fault("it has no moving platform".into());
        }
        check_numbers(&place, "gravity", &m.gravity)?;
        for names in [
            m.platforms.iter().map(|p| &p.name).collect::<Vec<_>>(),
            m.limbs.iter().map(|l| &l.name).collect(),
        ] {
            let mut seen = BTreeSet::new();
            if let Some(twice) = names.into_iter().find(|n| !seen.insert(n.as_str())) {
                return fault(format!("the name '{twice}' is used twice"));
            }
        }
        for platform in &m.platforms {
            check_platform(&place, platform)?;
        }
        for limb in &m.limbs {
            let count = m.platforms.len();
            if limb.from >= count || limb.to >= count || limb.from == limb.to {
                return fault(format!(
                    "limb '{}': it joins platforms {} and {} of {count}; two different ones are needed",
                    limb.name, limb.from, limb.to
                ));
            }
            let of_limb = place.with_part(Part::Limb(limb.name.clone()));
            let tip = &limb.platform_from_tip;
            check_pose(&of_limb, "the pose of its tip on the platform", tip)?;
            if limb.to == 0 {
                return fault(format!(
                    "limb '{}': it ends at the base; write it from the base to the moving platform",
                    limb.name
                ));
            }
            let same = limb.nominal.coordinates == limb.actual.coordinates
                && limb.nominal.actuators == limb.actual.actuators
                && limb.nominal.springs == limb.actual.springs
                && limb.nominal.bodies == limb.actual.bodies
                && limb.nominal.nodes == limb.actual.nodes;
            if !same {
                return fault(format!(
                    "limb '{}': nominal and actual chain must have the same joints, springs, masses and nodes",
                    limb.name
                ));
            }
        }
        if let Some(lonely) =
            (1..m.platforms.len()).find(|&p| m.limbs.iter().all(|l| l.from != p && l.to != p))
        {
            return fault(format!(
                "no limb holds platform '{}'",
                m.platforms[lonely].name
            ));
        }
        for load in &m.platform_loads {
            check_platform_load(&m, load)?;
        }
        for (name, load) in self.loads {
            add_load(&mut m, &name, load)?;
        }
        Ok(m.into())
    }
}

/// Checks a load on the limb of this name and adds it.
fn add_load(m: &mut MechanismParts, name: &str, load: Load) -> Result<()> {
    let place = Place::mechanism(m.name.as_str());
    let Some(index) = m.limbs.iter().position(|l| l.name == name) else {
        let known: Vec<&str> = m.limbs.iter().map(|l| l.name.as_str()).collect();
        return Err(Error::UnknownName {
            place,
            what: "limb",
            name: name.to_owned(),
            known: known.join(", "),
        });
    };
    let limb = &m.limbs[index];
    if matches!(load, Load::Gravity(_)) {
        return Err(Error::model(
            place,
            format!("limb '{name}': gravity acts on everything; give it to the mechanism once"),
        ));
    }
    let chain = &limb.actual;
    let (x, commands) = (chain.home_coordinates(), chain.home_commands());
    let base = &m.platforms[limb.from].home;
    let home = Kinematics::new(chain, base, &x, &commands);
    check_load(chain, &home, base, &x, &commands, &load)?;
    m.loads.resize(m.loads.len().max(index + 1), Vec::new());
    m.loads[index].push(load);
    Ok(())
}

impl Mechanism {
    /// Adds a load on the limb of this name, see [`MechanismBuilder::load`].
    ///
    /// # Errors
    /// [`Error::UnknownName`] for a limb that does not exist, [`Error::Model`] for a load that does not fit it.
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
    /// #     .build()?;
    /// let hook_node = crane.limbs()[1].actual.tip();
    /// let rope = Load::constant_tension(Anchor::Base(vector![0.3, 0.2, 4.0]), Anchor::node(hook_node), 300.0); // N
    /// let roped = crane.with_load("boom", rope.clone())?;
    /// assert_eq!(roped.loads(1), [rope]);
    /// assert!(crane.loads(1).is_empty(), "the machine itself stays as it was");
    /// let lifted = roped.posture(&home)?.deflected_by(&Wrench::zero())?.displacement.linear();
    /// assert!((lifted - vector![0.0, 0.0, 300.0 / 1e5]).norm() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn with_load(&self, limb: &str, load: Load) -> Result<Self> {
        let mut machine = self.clone();
        add_load(machine.parts_mut(), limb, load)?;
        Ok(machine)
    }

    /// Starts a description; the base platform exists already and has index 0.
    #[must_use]
    pub fn builder(name: impl Into<String>) -> MechanismBuilder {
        MechanismBuilder {
            mechanism: MechanismParts {
                name: name.into(),
                platforms: vec![Platform::new("base", Pose::identity())],
                limbs: Vec::new(),
                gravity: Vector3::zeros(),
                tool: 0,
                loads: Vec::new(),
                platform_loads: Vec::new(),
            },
            loads: Vec::new(),
        }
    }
}

/// Refuses a platform without a sensible home, mass or inertia.
pub(crate) fn check_platform(place: &Place, platform: &Platform) -> Result<()> {
    let place = place.with_part(Part::Platform(platform.name.clone()));
    check_pose(&place, "the home pose", &platform.home)?;
    check_numbers(&place, "the mass", [&platform.mass])?;
    check_numbers(&place, "the centre of mass", &platform.centre_of_mass)?;
    check_numbers(&place, "the inertia", &platform.inertia)?;
    if platform.mass < 0.0 {
        let reason = format!(
            "the mass is {} kg, a number that is not negative is needed",
            platform.mass
        );
        return Err(Error::model(place, reason));
    }
    Ok(())
}

/// Refuses a load on platforms whose numbers, or whose answers at home, are none.
pub(crate) fn check_platform_load(mechanism: &MechanismParts, load: &PlatformLoad) -> Result<()> {
    let place = Place::mechanism(mechanism.name.as_str());
    if let PlatformLoad::Wrench { point, wrench, .. } = load {
        check_numbers(&place, "the place of a wrench on a platform", point)?;
        check_numbers(&place, "a wrench on a platform", &wrench.0)?;
    }
    check_platforms(mechanism, load)?;
    let home: Vec<_> = mechanism.platforms.iter().map(|p| p.home).collect();
    let (mut wrenches, mut tangents) = (Vec::new(), Vec::new());
    load.wrenches(&home, &mut wrenches);
    load.tangents(&home, &mut tangents);
    let what = "what a load on platforms answers at home";
    for (_, wrench) in &wrenches {
        check_numbers(&place, what, &wrench.0)?;
    }
    tangents
        .iter()
        .try_for_each(|tangent| check_numbers(&place, what, &tangent.matrix))
}

/// Checks that a load fits the platforms.
fn check_platforms(mechanism: &MechanismParts, load: &PlatformLoad) -> Result<()> {
    let fault = |reason: String| {
        let place = Place::mechanism(mechanism.name.as_str());
        Err(Error::model(place, reason))
    };
    let own = load.platforms();
    let count = mechanism.platforms.len();
    if let Some(wrong) = own.iter().find(|&&p| p == 0 || p >= count) {
        return fault(format!(
            "a load acts on platform {wrong}; those that move are 1 to {}",
            count - 1
        ));
    }
    match load {
        PlatformLoad::Wrench { point, wrench, .. } => {
            if !point.iter().chain(wrench.0.iter()).all(|x| x.is_finite()) {
                return fault("a wrench on a platform is not finite".into());
            }
        }
        PlatformLoad::Strut(strut) => {
            if own.is_empty() || own.len() == 2 && own[0] == own[1] {
                return fault(
                    "a strut begins and ends at the same platform, so that it does nothing".into(),
                );
            }
            if let Some(reason) = crate::model::loads::node_load::NodeLoad::fault(strut) {
                return fault(reason);
            }
        }
    }
    Ok(())
}
