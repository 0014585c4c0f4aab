//! A chain: an ordered product of rigid offsets and one-degree-of-freedom motions [R 4.1].
//!
//! `base_from_tip = E_1 E_2 ... E_m`, each `E` a constant [`Pose`] or a screwless motion
//! `exp(axis * (ratio * coordinate + command))`. Universal joints, 6-D virtual springs and
//! parallelograms are words of the [builder](crate::ChainBuilder) that expand into such motions;
//! a coordinate may drive several of them with ratios (a parallelogram: +1 and -1), so
//! `J = J_e C` and `H = C^T H_e C` hold from the first day.

use nalgebra::{DMatrix, Matrix3, Unit, Vector3};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::error::{Error, Place, Result};
use crate::model::actuator::DriveRotor;
use crate::model::limits::check_number;
use crate::model::link_mass::SegmentMass;
use crate::model::springs::block::SpringBlock;
use crate::spatial::{MotionKind, Pose};

/// A share of a coordinate or a command in a motion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Drive {
    /// Index of the coordinate (or of the actuator).
    pub index: usize,
    /// Motion per unit of it.
    pub ratio: f64,
}

/// One elementary motion: displacement `ratio * coordinate + ratio * command` along or about
/// `axis`, which is given in the frame reached so far.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Motion {
    /// Translation or rotation.
    pub kind: MotionKind,
    /// Unit axis in the local frame.
    pub axis: Unit<Vector3<f64>>,
    /// The elastic or passive coordinate behind it, if any.
    pub coordinate: Option<Drive>,
    /// The actuator behind it, if any.
    pub command: Option<Drive>,
}

/// One factor of the product. Exhaustive: who goes along a chain must not pass over a factor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub enum Element {
    /// Constant offset.
    Rigid(Pose),
    /// Motion along or about an axis, by a command, a coordinate or both.
    Motion(Motion),
    /// A named place (index into [`Chain::nodes`]).
    Node(usize),
}

/// Support of a coordinate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Role {
    /// A spring, `theta`.
    Spring,
    /// Passive joint without support, `q`.
    Passive,
}

/// A degree of freedom that no command moves: of a spring or of a passive joint.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Coordinate {
    /// Name, unique in the chain.
    pub name: String,
    /// Spring or passive.
    pub role: Role,
    /// Kind of its first motion: the unit is m or rad.
    pub kind: MotionKind,
    /// Value from which inverse kinematics starts (m or rad).
    pub home: f64,
}

/// A commanded joint.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Actuator {
    /// Name, unique in the chain.
    pub name: String,
    /// Prismatic (m) or revolute (rad).
    pub kind: MotionKind,
    /// Command from which inverse kinematics starts (m or rad).
    pub home: f64,
    /// Lower and upper limit of the command (m or rad).
    pub limits: Option<(f64, f64)>,
    /// The spring coordinate in series with it; `None` for a rigid drive.
    pub coordinate: Option<usize>,
    /// Rotor of the drive, for vibrations.
    pub rotor: Option<DriveRotor>,
}

/// A rigid mass fixed to the frame of a node.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Body {
    /// Name; the node at the centre of mass has the same.
    pub name: String,
    /// Node whose origin is the centre of mass.
    pub node: usize,
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about the centre of mass, 3 x 3, kg m^2, axes of the node (kept for dynamics; statics
    /// does not use it).
    pub inertia: Matrix3<f64>,
}

/// An ordered product of elementary motions with springs, passive joints, nodes and masses.
/// Never changes after [`crate::ChainBuilder::build`].
///
/// # Examples
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// use kinetostat::model::{Element, Role};
///
/// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03); // Pa, m
/// let slide = ActuatorSpec { home: 0.2, ..ActuatorSpec::new(MotionKind::Prismatic, Vector3::z(), 1e7) }; // m, N/m
/// let leg = Chain::builder("leg")
///     .actuator("slide", slide)
///     .node("carriage")
///     .body("motor", 12.0, vector![0.1, 0.0, -0.05], nalgebra::Matrix3::zeros()) // kg, m
///     .passive("hinge", MotionKind::Revolute, Vector3::y(), 0.4)
///     .link("bar", &bar, 0.5)
///     .build()?;
/// assert_eq!(leg.name(), "leg");
/// assert_eq!(leg.nodes(), ["carriage", "motor", "tip"]);
/// assert!(leg.node("carriage")? == 0 && leg.tip() == 2);
/// assert_eq!(leg.bodies()[0].mass, 12.0);
/// // The drive's deflection, the hinge, and six of the bar: springs but for the hinge.
/// assert!(leg.coordinate_count() == 8 && leg.coordinates().len() == 8);
/// assert_eq!(leg.indices_of(Role::Passive), [1]);
/// assert_eq!(leg.springs().len(), 2, "the drive's and the bar's");
/// assert_eq!(leg.actuators()[0].coordinate, Some(0), "the drive is elastic");
/// assert_eq!(leg.home_commands(), [0.2]);
/// assert_eq!(leg.home_coordinates(), [0.0, 0.4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
/// let motions = leg.elements().iter().filter(|element| matches!(element, Element::Motion(_)));
/// assert_eq!(motions.count(), 8, "drive and command share one motion");
/// assert!((leg.scale().length - 0.5).abs() < 1e-15, "the way to the motor's centre does not count");
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Chain {
    pub(crate) name: String,
    pub(crate) elements: Vec<Element>,
    pub(crate) coordinates: Vec<Coordinate>,
    pub(crate) actuators: Vec<Actuator>,
    pub(crate) springs: Vec<SpringBlock>,
    pub(crate) nodes: Vec<String>,
    pub(crate) bodies: Vec<Body>,
    #[cfg_attr(feature = "serde", serde(default))]
    pub(crate) segment_masses: Vec<SegmentMass>,
    pub(crate) scale: Scale,
}

/// Natural length and stiffness of a chain: they make metres and radians comparable where a rank
/// is decided; results do not depend on them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Scale {
    /// m.
    pub length: f64,
    /// N/m.
    pub stiffness: f64,
}

impl Chain {
    /// Place of this chain in errors.
    pub(crate) fn place(&self) -> Place {
        Place::chain(self.name.as_str())
    }

    /// Name of the chain, as error messages show it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The product, base first.
    #[must_use]
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Elastic and passive coordinates in order of first appearance.
    #[must_use]
    pub fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    /// Commanded joints in order of appearance.
    #[must_use]
    pub fn actuators(&self) -> &[Actuator] {
        &self.actuators
    }

    /// Spring blocks in order of appearance.
    #[must_use]
    pub fn springs(&self) -> &[SpringBlock] {
        &self.springs
    }

    /// Names of the nodes; the last one is `tip`.
    #[must_use]
    pub fn nodes(&self) -> &[String] {
        &self.nodes
    }

    /// Bodies with mass, in order of appearance.
    #[must_use]
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Masses along elastic links, segment by segment (those of [`crate::model::MassModel::Consistent`]; the others are bodies).
    #[must_use]
    pub fn segment_masses(&self) -> &[SegmentMass] {
        &self.segment_masses
    }

    /// Mass of its bodies and of what is spread along its links, kg.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3};
    /// # use kinetostat::*;
    /// use kinetostat::model::LinkMass;
    ///
    /// let bar = BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.03); // Pa, m
    /// let spec = LinkSpec::beam(bar, 1.5).with_mass(LinkMass::of_section(&bar, 7850.0));
    /// let boom = Chain::builder("boom").link_with("bar", &spec).body("head", 12.0, Vector3::zeros(), Matrix3::zeros()).build()?;
    /// assert!((boom.mass() - 12.0 - 7850.0 * bar.area * 1.5).abs() < 1e-12);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn mass(&self) -> f64 {
        let spread = self.segment_masses.iter();
        self.bodies.iter().map(|body| body.mass).sum::<f64>()
            + spread.map(|s| s.mass.per_length * s.length).sum::<f64>()
    }

    /// Natural length and stiffness.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Index of the end node.
    #[must_use]
    pub fn tip(&self) -> usize {
        self.nodes.len() - 1
    }

    /// Number of elastic and passive coordinates.
    #[must_use]
    pub fn coordinate_count(&self) -> usize {
        self.coordinates.len()
    }

    /// Indices of the coordinates of one role, in order.
    #[must_use]
    pub fn indices_of(&self, role: Role) -> Vec<usize> {
        (0..self.coordinates.len())
            .filter(|&i| self.coordinates[i].role == role)
            .collect()
    }

    /// Index of a node by name.
    ///
    /// # Errors
    /// [`Error::UnknownName`] with the names that exist.
    pub fn node(&self, name: &str) -> Result<usize> {
        self.nodes
            .iter()
            .position(|n| n == name)
            .ok_or_else(|| Error::UnknownName {
                place: self.place(),
                what: "node",
                name: name.into(),
                known: self.nodes.join(", "),
            })
    }

    /// Coordinates from which inverse kinematics starts (m, rad).
    #[must_use]
    pub fn home_coordinates(&self) -> Vec<f64> {
        self.coordinates.iter().map(|c| c.home).collect()
    }

    /// Commands from which inverse kinematics starts (m, rad).
    #[must_use]
    pub fn home_commands(&self) -> Vec<f64> {
        self.actuators.iter().map(|a| a.home).collect()
    }

    /// Stiffness matrix `K_theta` of the springs at an unloaded posture [R 3.5], in the order of
    /// [`Self::indices_of`] for [`Role::Spring`]; N/m, N, N m/rad.
    ///
    /// ```
    /// # use kinetostat::*;
    /// # use kinetostat::nalgebra::Vector3;
    /// let column = Chain::builder("column").spring("lift", MotionKind::Prismatic, Vector3::z(), 2e6, 0.0);
    /// let chain = column.build()?;
    /// assert_eq!(chain.spring_stiffness(&chain.home_coordinates())?[(0, 0)], 2e6);
    /// # Ok::<(), Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Size`] for a list of another length.
    pub fn spring_stiffness(&self, coordinates: &[f64]) -> Result<DMatrix<f64>> {
        self.check(coordinates, &self.home_commands())?;
        let indices = self.indices_of(Role::Spring);
        let mut whole = DMatrix::zeros(coordinates.len(), coordinates.len());
        let mut torque = vec![0.0; coordinates.len()];
        for block in &self.springs {
            let mut entry = |i, j, value| whole[(block.first + i, block.first + j)] += value;
            block.add(
                coordinates,
                coordinates,
                1.0,
                &mut torque,
                &mut entry,
                &mut Vec::new(),
            );
        }
        Ok(whole.select_rows(&indices).select_columns(&indices))
    }

    /// Moves the end by a rigid offset (old end from new end): a tool, say. The old end stays a node under the name
    /// `name`, with its loads. Natural length and stiffness stay those of the chain without it.
    ///
    /// # Errors
    /// [`Error::Model`] if a node has that name already.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let (length, bar) = (0.5, BeamSection::tube(2.1e11, 8.1e10, 0.04, 0.0)); // m, Pa
    /// # let ei = 2.1e11 * bar.second_moment_z; // N m^2
    /// let cantilever = Chain::builder("boom").link("bar", &bar, length).build()?;
    /// let (along, up) = (0.2, 0.1); // m
    /// let tooled = cantilever.with_end("flange", &Pose::translation(along, up, 0.0))?;
    /// assert_eq!(tooled.nodes(), ["flange", "tip"]);
    /// let at_rest = tooled.home_coordinates();
    /// let stiffness = unloaded_stiffness(&tooled, &Pose::identity(), &at_rest, &[])?.cartesian;
    /// let compliance = stiffness.compliance().expect("a clamped bar holds its end"); // m/N
    /// // A force across bends the bar, and its end turns the tool.
    /// let across = ((length + along).powi(3) - along.powi(3)) / (3.0 * ei);
    /// let turn = (0.5 * length + along) * length / ei;
    /// assert!((compliance[(1, 1)] / across - 1.0).abs() < 1e-9);
    /// assert!((compliance[(0, 1)] / (-up * turn) - 1.0).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    pub fn with_end(&self, name: &str, offset: &Pose) -> Result<Self> {
        if self.nodes.iter().any(|n| n == name) {
            return Err(Error::model(
                self.place(),
                format!("the name '{name}' is used twice"),
            ));
        }
        let mut chain = self.clone();
        let tip = chain.tip();
        chain.nodes[tip] = name.to_owned();
        chain.nodes.push("tip".to_owned());
        chain.elements.push(Element::Rigid(*offset));
        chain.elements.push(Element::Node(tip + 1));
        Ok(chain)
    }

    /// Checks the lengths of a configuration and that its numbers are finite.
    pub(crate) fn check(&self, coordinates: &[f64], commands: &[f64]) -> Result<()> {
        let place = || self.place();
        for (what, expected, given) in [
            ("coordinates", self.coordinates.len(), coordinates),
            ("commands", self.actuators.len(), commands),
        ] {
            if given.len() != expected {
                return Err(Error::Size {
                    place: place(),
                    what,
                    expected,
                    found: given.len(),
                });
            }
            for (i, &value) in given.iter().enumerate() {
                check_number(&place(), || format!("{what}[{i}]"), value)?;
            }
        }
        Ok(())
    }
}
