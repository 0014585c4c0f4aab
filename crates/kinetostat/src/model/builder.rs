//! The words from which a chain is written: offsets, actuators, passive joints, springs, links.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, Matrix3, Matrix6, Unit, Vector3};

use crate::error::{Error, Part, Place, Result};
use crate::model::actuator::ActuatorSpec;
use crate::model::chain::{Actuator, Body, Chain, Coordinate, Drive, Element, Motion, Role, Scale};
use crate::model::chain_check::{natural_scale, spring_fault, usable};
use crate::model::springs::block::{Segment, SpringBlock, SpringLaw};
use crate::model::springs::parallelogram::ParallelogramLaw;
use crate::spatial::{MotionKind, Pose};

/// Directions of a 6-D virtual spring in the order of its motions: `x y z rx ry rz`.
const SIX: [(MotionKind, usize); 6] = [
    (MotionKind::Prismatic, 0),
    (MotionKind::Prismatic, 1),
    (MotionKind::Prismatic, 2),
    (MotionKind::Revolute, 0),
    (MotionKind::Revolute, 1),
    (MotionKind::Revolute, 2),
];
const SIX_NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

fn unit(axis: usize) -> Vector3<f64> {
    let mut v = Vector3::zeros();
    v[axis] = 1.0;
    v
}

/// Mistake: part of the chain, and description.
type Mistake = (Option<Part>, String);

/// Builds a [`Chain`], base first. Mistakes are collected and reported by [`Self::build`].
#[derive(Clone, Debug)]
pub struct ChainBuilder {
    pub(crate) chain: Chain,
    mistake: Option<Mistake>,
}

impl Chain {
    /// Starts a description.
    #[must_use]
    pub fn builder(name: impl Into<String>) -> ChainBuilder {
        ChainBuilder::new(name)
    }
}

impl ChainBuilder {
    pub(crate) fn new(name: impl Into<String>) -> Self {
        Self {
            chain: Chain {
                name: name.into(),
                elements: Vec::new(),
                coordinates: Vec::new(),
                actuators: Vec::new(),
                springs: Vec::new(),
                nodes: Vec::new(),
                bodies: Vec::new(),
                segment_masses: Vec::new(),
                scale: Scale {
                    length: 1.0,
                    stiffness: 1.0,
                },
            },
            mistake: None,
        }
    }

    /// Keeps what is wrong with the chain, if it is the first mistake.
    fn fault(&mut self, text: String) {
        self.mistake.get_or_insert((None, text));
    }

    /// Keeps what is wrong with a part of the chain, if it is the first mistake.
    pub(crate) fn fault_of(&mut self, part: fn(String) -> Part, name: &str, text: String) {
        self.mistake
            .get_or_insert_with(|| (Some(part(name.to_owned())), text));
    }

    fn unit_axis(&mut self, name: &str, axis: Vector3<f64>) -> Unit<Vector3<f64>> {
        Unit::try_new(axis, 1e-12)
            .filter(|a| a.iter().all(|x| x.is_finite()))
            .unwrap_or_else(|| {
                self.fault_of(
                    Part::Coordinate,
                    name,
                    format!(
                        "the axis [{}, {}, {}] has no direction",
                        axis.x, axis.y, axis.z
                    ),
                );
                Vector3::x_axis()
            })
    }

    fn coordinate(&mut self, name: String, role: Role, kind: MotionKind, home: f64) -> usize {
        if !home.is_finite() {
            self.fault_of(
                Part::Coordinate,
                &name,
                format!("the start value is {home}"),
            );
        }
        self.chain.coordinates.push(Coordinate {
            name,
            role,
            kind,
            home,
        });
        self.chain.coordinates.len() - 1
    }

    fn motion(
        &mut self,
        kind: MotionKind,
        axis: Unit<Vector3<f64>>,
        coordinate: Option<Drive>,
        command: Option<Drive>,
    ) {
        self.chain.elements.push(Element::Motion(Motion {
            kind,
            axis,
            coordinate,
            command,
        }));
    }

    /// A constant offset.
    #[must_use]
    pub fn rigid(mut self, pose: Pose) -> Self {
        if pose.to_homogeneous().iter().any(|x| !usable(*x)) {
            self.fault("a rigid offset holds a number that is not finite, or beyond 1e60".into());
        }
        self.chain.elements.push(Element::Rigid(pose));
        self
    }

    /// A constant translation, m.
    #[must_use]
    pub fn translation(self, offset: Vector3<f64>) -> Self {
        self.rigid(Pose::translation(offset.x, offset.y, offset.z))
    }

    /// An actuator: its command plus, in series, the spring of its drive.
    #[must_use]
    pub fn actuator(mut self, name: &str, spec: ActuatorSpec) -> Self {
        let axis = self.unit_axis(name, spec.axis);
        let index = self.chain.actuators.len();
        let coordinate = spec.stiffness.map(|k| {
            let c = self.coordinate(name.to_owned(), Role::Spring, spec.kind, 0.0);
            self.block(
                name,
                c,
                vec![spec.rest],
                SpringLaw::Linear(DMatrix::from_element(1, 1, k)),
            );
            c
        });
        if let Some((low, high)) = spec.limits
            && !(low <= spec.home && spec.home <= high)
        {
            self.fault_of(
                Part::Actuator,
                name,
                format!(
                    "its home {} is outside its limits {low} .. {high}",
                    spec.home
                ),
            );
        }
        if !spec.home.is_finite() {
            self.fault_of(Part::Actuator, name, format!("its home is {}", spec.home));
        }
        self.chain.actuators.push(Actuator {
            name: name.to_owned(),
            kind: spec.kind,
            home: spec.home,
            limits: spec.limits,
            coordinate,
            rotor: spec.rotor,
        });
        self.motion(
            spec.kind,
            axis,
            coordinate.map(|index| Drive { index, ratio: 1.0 }),
            Some(Drive { index, ratio: 1.0 }),
        );
        self
    }

    /// A screw whose far end is free to turn, as in a strut between two universal joints: the actuator
    /// `name`, then the passive rotation `name.turn` about the same axis, which also changes the
    /// length by `lead / (2 pi)` (m per turn; positive for a right-hand thread). A force `F` along the
    /// axis and the moment `M` about it then hold `M + F lead / (2 pi) = 0`: a screw without friction.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let (drive, lead) = (2e8, 0.01); // N/m, m per turn
    /// let strut = Chain::builder("strut")
    ///     .screw("screw", ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), drive), lead)
    ///     .build()?;
    /// let (at_rest, commands) = (strut.home_coordinates(), strut.home_commands());
    /// let stiffness = unloaded_stiffness(&strut, &Pose::identity(), &at_rest, &commands)?;
    /// // A nut that turns travels by its lead ...
    /// let free = stiffness.directions.iter().find(|direction| direction.kind == DirectionKind::Free);
    /// let twist = free.expect("the far end is free to turn").twist;
    /// let pitch = lead / std::f64::consts::TAU; // m/rad
    /// assert!((twist.linear().x / twist.angular().x - pitch).abs() < 1e-12);
    /// // ... so that a force of the drive comes with a moment about the axis.
    /// let pushed = stiffness.cartesian * Twist::new(vector![1e-6, 0.0, 0.0], Vector3::zeros());
    /// assert!((pushed.force().x - 1e-6 * drive).abs() < 1e-6);
    /// assert!((pushed.moment().x + pushed.force().x * pitch).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn screw(mut self, name: &str, spec: ActuatorSpec, lead: f64) -> Self {
        if spec.kind != MotionKind::Prismatic {
            self.fault_of(
                Part::Actuator,
                name,
                "a screw slides; its actuator turns".to_owned(),
            );
        }
        let axis = spec.axis;
        let turn = format!("{name}.turn");
        self.actuator(name, spec)
            .passive(&turn, MotionKind::Revolute, axis, 0.0)
            .coupled(
                &turn,
                MotionKind::Prismatic,
                axis,
                lead / std::f64::consts::TAU,
            )
    }

    /// A passive joint of one degree of freedom. `home` (m or rad) starts inverse kinematics.
    #[must_use]
    pub fn passive(mut self, name: &str, kind: MotionKind, axis: Vector3<f64>, home: f64) -> Self {
        let axis = self.unit_axis(name, axis);
        let index = self.coordinate(name.to_owned(), Role::Passive, kind, home);
        self.motion(kind, axis, Some(Drive { index, ratio: 1.0 }), None);
        self
    }

    /// A universal joint: two passive rotations in this order, named `name.1`, `name.2`.
    #[must_use]
    pub fn passive_universal(self, name: &str, first: Vector3<f64>, second: Vector3<f64>) -> Self {
        self.passive(&format!("{name}.1"), MotionKind::Revolute, first, 0.0)
            .passive(&format!("{name}.2"), MotionKind::Revolute, second, 0.0)
    }

    /// A spherical joint: passive rotations about x, y, z in this order, named `name.x` ...
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let slide = ActuatorSpec::new(MotionKind::Prismatic, vector![1.0, 2.0, 2.0], 9e6); // N/m
    /// let strut = Chain::builder("strut").actuator("slide", slide).passive_spherical("ball").build()?;
    /// let (at_rest, commands) = (strut.home_coordinates(), strut.home_commands());
    /// let stiffness = unloaded_stiffness(&strut, &Pose::identity(), &at_rest, &commands)?;
    /// assert_eq!(stiffness.count(DirectionKind::Free), 3, "it turns about every axis");
    /// // What the drive holds is the force along its axis (1, 2, 2) / 3.
    /// let pushed = stiffness.cartesian * Twist::new(vector![0.0, 1e-6, 0.0], vector![0.3, -0.2, 0.1]);
    /// assert!((pushed.force() - vector![2.0, 4.0, 4.0]).norm() < 1e-9); // N
    /// assert!(pushed.moment().norm() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn passive_spherical(mut self, name: &str) -> Self {
        for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
            self = self.passive(
                &format!("{name}.{letter}"),
                MotionKind::Revolute,
                unit(axis),
                0.0,
            );
        }
        self
    }

    /// One more motion driven by an existing coordinate: displacement `ratio * coordinate`. This is
    /// how parallelograms and mimic joints are written. Where the name is an actuator's, the motion
    /// follows the joint: its command, and with it the deflection of its drive.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let swing = Chain::builder("parallelogram")
    ///     .passive("swing", MotionKind::Revolute, Vector3::y(), 0.0)
    ///     .translation(vector![0.5, 0.0, 0.1])
    ///     .coupled("swing", MotionKind::Revolute, Vector3::y(), -1.0)
    ///     .build()?;
    /// assert_eq!(swing.coordinate_count(), 1);
    /// let angle = 0.4_f64; // rad
    /// let end = model::unloaded_tip(&swing, &Pose::identity(), &[angle], &[]);
    /// assert!(end.rotation.angle() < 1e-15, "it swings without turning");
    /// let (s, c) = angle.sin_cos();
    /// let place = vector![0.5 * c + 0.1 * s, 0.0, 0.1 * c - 0.5 * s]; // m
    /// assert!((end.translation.vector - place).norm() < 1e-15);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn coupled(
        mut self,
        coordinate: &str,
        kind: MotionKind,
        axis: Vector3<f64>,
        ratio: f64,
    ) -> Self {
        let axis = self.unit_axis(coordinate, axis);
        if !ratio.is_finite() {
            self.fault(format!("a motion is coupled to '{coordinate}' by {ratio}"));
        }
        let drive = |index| Drive { index, ratio };
        let follows = self
            .chain
            .coordinates
            .iter()
            .position(|c| c.name == coordinate);
        let commanded = self
            .chain
            .actuators
            .iter()
            .position(|a| a.name == coordinate);
        if follows.is_none() && commanded.is_none() {
            self.fault(format!(
                "a motion is coupled to '{coordinate}', but no coordinate of that name comes before it"
            ));
        } else {
            self.motion(kind, axis, follows.map(drive), commanded.map(drive));
        }
        self
    }

    /// A virtual spring of one degree of freedom: stiffness N/m or N m/rad, `rest` is `theta0`.
    #[must_use]
    pub fn spring(
        self,
        name: &str,
        kind: MotionKind,
        axis: Vector3<f64>,
        stiffness: f64,
        rest: f64,
    ) -> Self {
        let law = SpringLaw::Linear(DMatrix::from_element(1, 1, stiffness));
        self.spring_with_law(name, kind, axis, law, rest)
    }

    /// A virtual spring of one degree of freedom with any law of one coordinate, such as
    /// [`crate::model::BilinearLaw`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// use kinetostat::model::{BilinearLaw, SpringLaw};
    ///
    /// let gear = BilinearLaw { stiffness: 1e4, beyond: 3e4, knee: 1e-3 }; // N m/rad, rad
    /// let joint = Chain::builder("joint")
    ///     .spring_with_law("gear", MotionKind::Revolute, Vector3::z(), SpringLaw::Bilinear(gear), 0.0)
    ///     .build()?;
    /// for (moment, angle) in [(8.0, 8e-4), (40.0, 1e-3 + 30.0 / 3e4), (-40.0, -2e-3)] {
    ///     let load = Wrench::new(vector![0.0, 0.0, 90.0], vector![5.0, 0.0, moment]); // N, N m
    ///     let problem = ChainProblem::new(&joint, EndCondition::wrench(load));
    ///     let found = solve_chain(&problem, &Settings::default())?;
    ///     assert!((found.coordinates[0] - angle).abs() < 1e-12, "only the moment about z turns it");
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn spring_with_law(
        mut self,
        name: &str,
        kind: MotionKind,
        axis: Vector3<f64>,
        law: SpringLaw,
        rest: f64,
    ) -> Self {
        let axis = self.unit_axis(name, axis);
        let index = self.coordinate(name.to_owned(), Role::Spring, kind, 0.0);
        self.block(name, index, vec![rest], law);
        self.motion(kind, axis, Some(Drive { index, ratio: 1.0 }), None);
        self
    }

    /// Value (m or rad) that the coordinate `name`, written before, has when the machine is at home
    /// without load. For a spring inverse kinematics keeps it: a spring whose home is its rest
    /// stands there unloaded; one at home elsewhere is assembled with a preload.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let buffer = |home| {
    ///     Chain::builder("buffer")
    ///         .spring("slide", MotionKind::Prismatic, Vector3::x(), 2e4, 0.02) // N/m, at rest at 20 mm
    ///         .home("slide", home)
    ///         .build()
    /// };
    /// // Where it rests it needs no force; 20 mm shorter it is assembled with 2e4 N/m * 0.02 m.
    /// for (home, force) in [(0.02, 0.0), (0.0, -400.0)] {
    ///     let chain = buffer(home)?;
    ///     let held = EndCondition::pose(Pose::translation(home, 0.0, 0.0));
    ///     let found = solve_chain(&ChainProblem::new(&chain, held), &Settings::default())?;
    ///     assert!((found.wrench.force().x - force).abs() < 1e-9);
    /// }
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn home(mut self, name: &str, value: f64) -> Self {
        match self.chain.coordinates.iter_mut().find(|c| c.name == name) {
            Some(_) if !value.is_finite() => {
                self.fault_of(
                    Part::Coordinate,
                    name,
                    format!("the start value is {value}"),
                );
            }
            Some(coordinate) => coordinate.home = value,
            None => self.fault(format!("home: there is no coordinate '{name}' before it")),
        }
        self
    }

    /// A 6-D virtual spring, translations before rotations ("TR"): `Tx Ty Tz Rx Ry Rz` with a full
    /// symmetric 6 x 6 matrix (N/m, N/rad, N m/m, N m/rad) in local axes, and `theta0` (m, rad).
    #[must_use]
    pub fn spring6(self, name: &str, stiffness: &Matrix6<f64>, rest: [f64; 6]) -> Self {
        let matrix = DMatrix::from_fn(6, 6, |i, j| stiffness[(i, j)]);
        self.springs(
            name,
            &[0, 1, 2, 3, 4, 5],
            SpringLaw::Linear(matrix),
            rest.to_vec(),
        )
    }

    /// Some of the six directions (0..6 = `x y z rx ry rz`, increasing) held by one law.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// use kinetostat::model::SpringLaw;
    ///
    /// // A leaf: what a force along y does and what a moment about z does are coupled.
    /// let (across, coupling, turn) = (4e5, -6e4, 1.5e4); // N/m, N/rad, N m/rad
    /// let law = nalgebra::DMatrix::from_row_slice(2, 2, &[across, coupling, coupling, turn]);
    /// let leaf = Chain::builder("leaf").springs("leaf", &[1, 5], SpringLaw::Linear(law), vec![0.0; 2]).build()?;
    /// let stiffness = unloaded_stiffness(&leaf, &Pose::identity(), &leaf.home_coordinates(), &[])?;
    /// assert_eq!(stiffness.count(DirectionKind::Rigid), 4);
    /// // A force alone finds the leaf softer than a motion that may not turn.
    /// let load = Wrench::new(vector![0.0, 1.0, 0.0], Vector3::zeros()); // N
    /// let found = solve_chain(&ChainProblem::new(&leaf, EndCondition::wrench(load)), &Settings::default())?;
    /// let softened = across - coupling * coupling / turn;
    /// assert!((found.tip.translation.y * softened - 1.0).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn springs(
        mut self,
        name: &str,
        directions: &[usize],
        law: SpringLaw,
        rest: Vec<f64>,
    ) -> Self {
        self.add_springs(name, directions, false, law, rest);
        self
    }

    /// Coordinates are numbered as the directions; their motions follow each other in that order or,
    /// with `rotations_first`, rotations before translations.
    pub(crate) fn add_springs(
        &mut self,
        name: &str,
        directions: &[usize],
        rotations_first: bool,
        law: SpringLaw,
        rest: Vec<f64>,
    ) {
        if directions.is_empty()
            || directions.windows(2).any(|w| w[0] >= w[1])
            || directions.iter().any(|&d| d > 5)
        {
            self.fault_of(
                Part::Spring,
                name,
                "directions must increase and lie in 0..6".to_owned(),
            );
            return;
        }
        let first = self.chain.coordinates.len();
        let mut motions = Vec::with_capacity(directions.len());
        for &d in directions {
            let (kind, axis) = SIX[d];
            let name = format!("{name}.{}", SIX_NAMES[d]);
            motions.push((kind, axis, self.coordinate(name, Role::Spring, kind, 0.0)));
        }
        if rotations_first {
            motions.sort_by_key(|&(kind, ..)| kind == MotionKind::Prismatic);
        }
        for (kind, axis, index) in motions {
            let axis = Unit::new_unchecked(unit(axis));
            self.motion(kind, axis, Some(Drive { index, ratio: 1.0 }), None);
        }
        self.block(name, first, rest, law);
    }

    /// Declares the spring written last a piece of a link.
    pub(crate) fn last_spring_is(&mut self, segment: Segment) {
        if let Some(block) = self.chain.springs.last_mut() {
            block.segment = Some(segment);
        }
    }

    /// A bar parallelogram along local x that swings about local y: `Ry(q2) Tx(length) V5 Ry(-q2)`,
    /// with the passive coordinate `name` and the spring `name.bars` (see [`ParallelogramLaw`]).
    /// `bar` is the cantilever matrix of one bar, `width` the distance of the bars (m).
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let (length, width, q) = (0.6, 0.1, 0.4_f64); // m, m, rad
    /// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.02, 0.014); // Pa, m
    /// let leg = Chain::builder("leg").parallelogram("bars", length, width, &bar.cantilever(length)?, q).build()?;
    /// let posture = leg.home_coordinates();
    /// let end = model::unloaded_tip(&leg, &Pose::identity(), &posture, &[]);
    /// assert!(end.rotation.angle() < 1e-15, "it swings about y and does not turn");
    /// let stiffness = unloaded_stiffness(&leg, &Pose::identity(), &posture, &[])?;
    /// // Along the bars there are two of them, each E A / L.
    /// let along = vector![q.cos(), 0.0, -q.sin()];
    /// let pulled = stiffness.cartesian * Twist::new(along * 1e-6, Vector3::zeros());
    /// let axial = 2.1e11 * bar.area / length; // N/m
    /// assert!((pulled.force() - along * (2e-6 * axial)).norm() < 1e-9 * axial);
    /// // A turn about y lengthens one and shortens the other, half the distance of their lines away.
    /// let turned = stiffness.cartesian * Twist::new(Vector3::zeros(), vector![0.0, 1e-6, 0.0]);
    /// let arm = 0.5 * width * q.cos();
    /// assert!((turned.moment().y / (2e-6 * axial * arm * arm) - 1.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn parallelogram(
        self,
        name: &str,
        length: f64,
        width: f64,
        bar: &Matrix6<f64>,
        home: f64,
    ) -> Self {
        let axis = Vector3::y();
        let mut this = self.passive(name, MotionKind::Revolute, axis, home);
        let inclination = this.chain.coordinates.len() - 1;
        if !(length > 0.0 && width > 0.0 && length.is_finite() && width.is_finite()) {
            this.fault(format!(
                "parallelogram '{name}': length {length} and width {width} must be positive"
            ));
        }
        let law = SpringLaw::Parallelogram(Box::new(ParallelogramLaw {
            bar: *bar,
            width,
            inclination,
        }));
        this.translation(Vector3::new(length, 0.0, 0.0))
            .springs(&format!("{name}.bars"), &[0, 1, 3, 4, 5], law, vec![0.0; 5])
            .coupled(name, MotionKind::Revolute, axis, -1.0)
    }

    /// Names the frame reached so far. The end of the chain is the node `tip` without being named.
    #[must_use]
    pub fn node(mut self, name: &str) -> Self {
        self.chain
            .elements
            .push(Element::Node(self.chain.nodes.len()));
        self.chain.nodes.push(name.to_owned());
        self
    }

    /// A mass (kg) fixed to the frame reached so far: centre of mass (m, local) and inertia about
    /// it (kg m^2, local axes). Its centre becomes a node named `name`.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let (mass, g) = (30.0, 9.81); // kg, m/s^2
    /// let arm = Chain::builder("arm")
    ///     .spring("shoulder", MotionKind::Revolute, Vector3::z(), 2e3, 0.0) // N m/rad
    ///     .body("motor", mass, vector![0.4, 0.15, 0.2], nalgebra::Matrix3::zeros())
    ///     .translation(vector![0.8, 0.0, 0.0])
    ///     .build()?;
    /// let mut problem = ChainProblem::new(&arm, EndCondition::wrench(Wrench::zero()));
    /// problem.loads.push(Load::gravity(vector![0.0, -g, 0.0]));
    /// let found = solve_chain(&problem, &Settings::default())?;
    /// let sunk = found.nodes[arm.node("motor")?].translation;
    /// assert!((found.spring_torques[0] + mass * g * sunk.x).abs() < 1e-6, "the spring carries weight times arm");
    /// assert_eq!(found.tip.translation.vector.norm(), 0.8, "the mass moves no frame");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn body(
        mut self,
        name: &str,
        mass: f64,
        centre_of_mass: Vector3<f64>,
        inertia: Matrix3<f64>,
    ) -> Self {
        if !(mass.is_finite() && mass >= 0.0) {
            self.fault_of(
                Part::Body,
                name,
                format!("its mass is {mass} kg, a number not below zero is needed"),
            );
        }
        if centre_of_mass
            .iter()
            .chain(inertia.iter())
            .any(|x| !x.is_finite())
        {
            self.fault_of(
                Part::Body,
                name,
                "centre of mass or inertia is not finite".to_owned(),
            );
        }
        let offset = Pose::translation(centre_of_mass.x, centre_of_mass.y, centre_of_mass.z);
        self.chain.elements.push(Element::Rigid(offset));
        let node = self.chain.nodes.len();
        self = self.node(name);
        self.chain.elements.push(Element::Rigid(offset.inverse()));
        self.chain.bodies.push(Body {
            name: name.to_owned(),
            node,
            mass,
            inertia,
        });
        self
    }

    fn block(&mut self, name: &str, first: usize, rest: Vec<f64>, law: SpringLaw) {
        let block = SpringBlock {
            name: name.to_owned(),
            first,
            rest,
            law,
            segment: None,
        };
        if block.rest.iter().any(|x| !usable(*x)) {
            self.fault_of(
                Part::Spring,
                name,
                "its rest position is not finite, or beyond 1e60".to_owned(),
            );
        }
        self.chain.springs.push(block);
    }

    /// Checks the description and freezes it.
    ///
    /// # Errors
    /// [`Error::Model`] for an axis without direction, a stiffness that is not symmetric and
    /// positive definite, a name used twice, or a number that is not finite.
    pub fn build(mut self) -> Result<Chain> {
        let place = Place::chain(self.chain.name.as_str());
        self = self.node("tip");
        if let Some((part, reason)) = self.mistake {
            let place = match part {
                Some(part) => place.with_part(part),
                None => place,
            };
            return Err(Error::model(place, reason));
        }
        let mut chain = self.chain;
        for names in [
            chain
                .coordinates
                .iter()
                .map(|c| &c.name)
                .collect::<Vec<_>>(),
            chain.nodes.iter().collect(),
            chain.actuators.iter().map(|a| &a.name).collect(),
        ] {
            let mut seen = BTreeSet::new();
            if let Some(twice) = names.into_iter().find(|n| !seen.insert(n.as_str())) {
                return Err(Error::model(
                    place,
                    format!("the name '{twice}' is used twice"),
                ));
            }
        }
        for spring in &chain.springs {
            if let Some(reason) = spring_fault(spring) {
                let place = place.with_part(Part::Spring(spring.name.clone()));
                return Err(Error::model(place, reason));
            }
        }
        chain.scale = natural_scale(&chain);
        Ok(chain)
    }
}
