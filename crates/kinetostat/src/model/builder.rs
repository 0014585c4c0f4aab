//! The words from which a chain is written: offsets, actuators, passive joints, springs, links.

use std::collections::BTreeSet;

use nalgebra::{DMatrix, Matrix3, Matrix6, Unit, Vector3};

use crate::error::{Error, Part, Place, Result};
use crate::model::chain::{Actuator, Body, Chain, Coordinate, Drive, Element, Motion, Role, Scale};
use crate::model::springs::block::{Segment, SpringBlock, SpringLaw, scaled};
use crate::model::springs::parallelogram::ParallelogramLaw;
use crate::number::short;
use crate::spatial::{MotionKind, Pose};

/// An actuator as the builder takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorSpec {
    /// Prismatic or revolute.
    pub kind: MotionKind,
    /// Axis in the local frame; need not be normalised.
    pub axis: Vector3<f64>,
    /// Stiffness of the drive (N/m or N m/rad); `None` is a rigid drive.
    pub stiffness: Option<f64>,
    /// Deflection at rest, `theta0` (m or rad).
    pub rest: f64,
    /// Command from which inverse kinematics starts (m or rad).
    pub home: f64,
    /// Limits of the command (m or rad).
    pub limits: Option<(f64, f64)>,
}

impl ActuatorSpec {
    /// An actuator with an elastic drive, at home at zero, without limits.
    #[must_use]
    pub fn new(kind: MotionKind, axis: Vector3<f64>, stiffness: f64) -> Self {
        Self {
            kind,
            axis,
            stiffness: Some(stiffness),
            rest: 0.0,
            home: 0.0,
            limits: None,
        }
    }
}

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

/// Finite, and so that powers are finite too.
fn usable(x: f64) -> bool {
    x.abs() <= crate::model::limits::LARGEST
}

fn unit(axis: usize) -> Vector3<f64> {
    let mut v = Vector3::zeros();
    v[axis] = 1.0;
    v
}

/// What is wrong, and in which part of the chain.
type Mistake = (Option<Part>, String);

/// Builds a [`Chain`], base first. Mistakes are collected and reported by [`Self::build`].
#[derive(Clone, Debug)]
pub struct ChainBuilder {
    chain: Chain,
    mistake: Option<Mistake>,
}

/// Smallest eigenvalue of a scaled stiffness matrix that is distinct from rounding.
const SINGULAR: f64 = 1e-12;

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

    /// What is wrong with a spring.
    fn check_spring(block: &SpringBlock) -> Option<String> {
        let posture = vec![0.3; block.first + 6];
        let k = block.stiffness_at(&posture);
        if k.nrows() != block.len() || k.ncols() != block.len() {
            return Some(format!(
                "a {0} x {0} matrix is needed, {1} x {2} was given",
                block.len(),
                k.nrows(),
                k.ncols()
            ));
        }
        if let Some(fault) = block.law.fault() {
            return Some(fault.to_owned());
        }
        if k.iter().any(|x| !usable(*x)) {
            return Some(
                "its stiffness holds a number that is not finite, or beyond 1e60".to_owned(),
            );
        }
        let scaled = scaled(&k);
        if (&scaled - scaled.transpose()).amax() > 1e-9 {
            return Some("its stiffness matrix is not symmetric".to_owned());
        }
        if let Some(i) = (0..k.nrows()).find(|&i| k[(i, i)] <= 0.0) {
            return Some(format!(
                "its stiffness {} is not positive (diagonal entry {}); a free direction is a passive joint",
                k[(i, i)],
                i + 1
            ));
        }
        // A coupling as large as the diagonal is indefinite; found here because extreme numbers can
        // keep an eigenvalue iteration busy for ever.
        if let Some((i, j)) = (0..k.nrows())
            .flat_map(|i| (0..i).map(move |j| (i, j)))
            .find(|&(i, j)| scaled[(i, j)].abs() > 1.0 + SINGULAR)
        {
            return Some(format!(
                "its stiffness matrix is not positive definite: entry ({}, {}) is too large for its diagonal",
                i + 1,
                j + 1
            ));
        }
        let least = scaled.symmetric_eigenvalues().min();
        if least < -SINGULAR {
            return Some(format!(
                "its stiffness matrix is not positive definite (smallest scaled eigenvalue {})",
                short(least)
            ));
        }
        (least <= SINGULAR).then(|| {
            format!("its stiffness matrix is not positive definite, or couples a motion so much softer than the others that numbers of 16 digits do not hold it (smallest scaled eigenvalue {}, more than {} is needed); a free direction is a passive joint, and a very soft one is held where the spring is given in its principal axes (a rotation before it, the inverse one after it) or as single springs", short(least), short(SINGULAR))
        })
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
            if let Some(reason) = Self::check_spring(spring) {
                let place = place.with_part(Part::Spring(spring.name.clone()));
                return Err(Error::model(place, reason));
            }
        }
        chain.scale = natural_scale(&chain);
        Ok(chain)
    }
}

fn is_body(chain: &Chain, node: usize) -> bool {
    chain.bodies.iter().any(|b| b.node == node)
}

/// Length: sum of the rigid offsets. Stiffness: geometric mean of the springs, rotations referred
/// to that length.
fn natural_scale(chain: &Chain) -> Scale {
    let mut length = 0.0;
    for (i, element) in chain.elements.iter().enumerate() {
        // A centre of mass is reached by an offset and left by its inverse: no part of the chain.
        let to_mass =
            matches!(chain.elements.get(i + 1), Some(Element::Node(n)) if is_body(chain, *n));
        let from_mass =
            i > 0 && matches!(chain.elements[i - 1], Element::Node(n) if is_body(chain, n));
        if let Element::Rigid(pose) = element
            && !to_mass
            && !from_mass
        {
            length += pose.translation.vector.norm();
        }
    }
    let length = if length > 1e-9 { length } else { 1.0 };
    let posture = chain.home_coordinates();
    let (mut sum, mut count) = (0.0, 0.0);
    for block in &chain.springs {
        let k = block.stiffness_at(&posture);
        for i in 0..block.len() {
            let unit = match chain.coordinates[block.first + i].kind {
                MotionKind::Prismatic => 1.0,
                MotionKind::Revolute => length * length,
            };
            sum += (k[(i, i)] / unit).ln();
            count += 1.0;
        }
    }
    let stiffness = if count > 0.0 {
        (sum / count).exp()
    } else {
        1.0
    };
    Scale { length, stiffness }
}
