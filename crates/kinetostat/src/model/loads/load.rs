//! Loads on the nodes of a chain [R 4.2, 4.22-4.23].
//!
//! A load answers at given node poses: which wrench acts on which node, how that wrench changes
//! when nodes move (its tangent, which enters `H`), and, where it has one, its potential energy. A
//! dead load has no tangent. What touches two limbs is a platform's business, not a load's.

use std::sync::Arc;

use nalgebra::Vector3;

use crate::model::chain::Chain;
use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::model::loads::follower::{Follower, PointForce};
use crate::model::loads::function::FunctionLoad;
use crate::model::loads::length_law::LengthLaw;
use crate::model::loads::node_load::NodeLoad;
use crate::model::loads::strut::{Anchor, Strut};
use crate::spatial::Wrench;

/// Something that acts on the nodes of a chain. Preloaded joints are no loads: give their springs
/// a rest position (`theta0`).
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Load {
    /// A wrench that keeps its components in base axes while its node moves.
    Dead {
        /// Node it acts on.
        node: usize,
        /// Base axes, about the node's origin.
        wrench: Wrench,
    },
    /// Weight of all bodies of the chain; the vector is gravity in base axes, m/s^2.
    Gravity(Vector3<f64>),
    /// Anything else.
    Custom(Arc<dyn NodeLoad>),
}

impl PartialEq for Load {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Dead { node, wrench },
                Self::Dead {
                    node: other_node,
                    wrench: other_wrench,
                },
            ) => node == other_node && wrench == other_wrench,
            (Self::Gravity(one), Self::Gravity(other)) => one == other,
            (Self::Custom(one), Self::Custom(other)) => {
                Arc::ptr_eq(one, other) || one.numbers().is_some_and(|n| Some(n) == other.numbers())
            }
            _ => false,
        }
    }
}

/// Number of first steps that may leave the tangents of loads out [R 4.15]: as many as wanted where all loads are dead,
/// none where one changes as its node moves. A spring between two nodes is no less real than the springs of the chain,
/// and a step without it goes too far, past the equilibrium to which the load leads.
pub(crate) fn lagged_steps<'a>(mut loads: impl Iterator<Item = &'a Load>, wanted: usize) -> usize {
    match loads.any(|load| matches!(load, Load::Custom(_))) {
        true => 0,
        false => wanted,
    }
}

impl Load {
    /// A wrench (N, N m; base axes, about the node's origin) that keeps its components while its
    /// node moves. With a moment it has a potential only if all turns share one axis.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let lever = Chain::builder("lever") // a joint about z on a spring, and an arm of 0.4 m
    /// #     .spring("joint", MotionKind::Revolute, Vector3::z(), 500.0, 0.0) // N m/rad
    /// #     .translation(vector![0.4, 0.0, 0.0])
    /// #     .node("lug")
    /// #     .translation(vector![0.2, 0.0, 0.0])
    /// #     .build()?;
    /// # let lug = lever.node("lug")?;
    /// let mut problem = ChainProblem::new(&lever, EndCondition::wrench(Wrench::zero()));
    /// let (force, moment) = (vector![0.0, 300.0, 50.0], vector![4.0, 0.0, -20.0]); // N, N m
    /// problem.loads.push(Load::dead(lug, Wrench::new(force, moment)));
    /// let angle = solve_chain(&problem, &Settings::default())?.coordinates[0];
    /// // The force keeps its direction while its arm turns away: k a = F r cos(a) + M.
    /// assert!((500.0 * angle - 300.0 * 0.4 * angle.cos() + 20.0).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn dead(node: usize, wrench: Wrench) -> Self {
        Self::Dead { node, wrench }
    }

    /// Weight of all bodies; gravity in base axes, m/s^2.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let (k, g) = (2e4, 9.81); // N/m, m/s^2
    /// let scale = Chain::builder("scale")
    ///     .spring("spring", MotionKind::Prismatic, vector![0.0, 0.6, 0.8], k, 0.0) // an inclined guide
    ///     .body("pan", 3.0, vector![0.1, 0.0, 0.0], nalgebra::Matrix3::zeros()) // kg, m
    ///     .body("goods", 5.0, vector![0.0, -0.2, 0.1], nalgebra::Matrix3::zeros())
    ///     .build()?;
    /// let mut problem = ChainProblem::new(&scale, EndCondition::wrench(Wrench::zero()));
    /// problem.loads.push(Load::gravity(vector![0.0, 0.0, -g]));
    /// let sunk = solve_chain(&problem, &Settings::default())?.coordinates[0];
    /// assert!((sunk + 8.0 * g * 0.8 / k).abs() < 1e-12, "both weights, as far as they point along the guide");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn gravity(gravity: Vector3<f64>) -> Self {
        Self::Gravity(gravity)
    }

    /// A wrench (N, N m) with constant components in the axes of its node, about the node's
    /// origin: a follower. Not conservative.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let lever = Chain::builder("lever") // a joint about z on a spring, and an arm of 0.4 m
    /// #     .spring("joint", MotionKind::Revolute, Vector3::z(), 500.0, 0.0) // N m/rad
    /// #     .translation(vector![0.4, 0.0, 0.0])
    /// #     .node("lug")
    /// #     .translation(vector![0.2, 0.0, 0.0])
    /// #     .build()?;
    /// # let lug = lever.node("lug")?;
    /// let mut problem = ChainProblem::new(&lever, EndCondition::wrench(Wrench::zero()));
    /// let jet = Wrench::new(vector![70.0, 900.0, 0.0], Vector3::zeros()); // N, in the axes of the lug
    /// problem.loads.push(Load::follower(lug, jet));
    /// let found = solve_chain(&problem, &Settings::default())?;
    /// // It turns with its arm, so that its moment stays: k a = F r, for angles as large as this.
    /// assert!((found.coordinates[0] - 900.0 * 0.4 / 500.0).abs() < 1e-9);
    /// assert!(!found.conservative, "it would work for ever on a lever that turns on");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn follower(node: usize, local: Wrench) -> Self {
        Self::custom(Follower { node, local })
    }

    /// A dead force (N, base axes) at a point of a node's frame (m, node's axes): a lever.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let lever = Chain::builder("lever") // a joint about z on a spring, and an arm of 0.4 m
    /// #     .spring("joint", MotionKind::Revolute, Vector3::z(), 500.0, 0.0) // N m/rad
    /// #     .translation(vector![0.4, 0.0, 0.0])
    /// #     .node("lug")
    /// #     .translation(vector![0.2, 0.0, 0.0])
    /// #     .build()?;
    /// # let lug = lever.node("lug")?;
    /// let mut problem = ChainProblem::new(&lever, EndCondition::wrench(Wrench::zero()));
    /// let horn = vector![0.0, 0.15, 0.3]; // m, from the lug
    /// problem.loads.push(Load::point_force(lug, horn, vector![-200.0, 0.0, 0.0])); // N
    /// let angle = solve_chain(&problem, &Settings::default())?.coordinates[0];
    /// // The height of its point over the joint is the arm of a force along x.
    /// let height = 0.4 * angle.sin() + 0.15 * angle.cos();
    /// assert!((500.0 * angle - 200.0 * height).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn point_force(node: usize, point: Vector3<f64>, force: Vector3<f64>) -> Self {
        Self::custom(PointForce { node, point, force })
    }

    /// A mass (kg) on a lever: at a point of a node's frame (m, node's axes), under gravity (m/s^2,
    /// base axes).
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let down = vector![0.0, -9.81, 0.0]; // m/s^2
    /// let arm = Chain::builder("arm")
    ///     .spring("joint", MotionKind::Revolute, Vector3::z(), 500.0, 0.3) // at rest at 0.3 rad
    ///     .body("motor", 20.0, vector![0.6, 0.1, 0.05], nalgebra::Matrix3::zeros()) // kg, m
    ///     .translation(vector![0.8, 0.0, 0.0])
    ///     .build()?;
    /// let mut problem = ChainProblem::new(&arm, EndCondition::wrench(Wrench::zero()));
    /// problem.loads.push(Load::gravity(down));
    /// let sunk = solve_chain(&problem, &Settings::default())?.coordinates[0];
    /// assert!(sunk < 0.3 - 0.1);
    /// // Three times the mass at a third of the arm, on the other side of the joint: here the motor's node.
    /// let motor = arm.node("motor")?;
    /// let other_side = vector![0.6, 0.1, 0.0] * (-4.0 / 3.0); // m, from the motor's centre
    /// problem.loads.push(Load::counterweight(motor, other_side, 60.0, down));
    /// let balanced = solve_chain(&problem, &Settings::default())?.coordinates[0];
    /// assert!((balanced - 0.3).abs() < 1e-9);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn counterweight(
        node: usize,
        point: Vector3<f64>,
        mass: f64,
        gravity: Vector3<f64>,
    ) -> Self {
        Self::point_force(node, point, gravity * mass)
    }

    /// A compensator between two points: it pulls or pushes along their line as its length says.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let cart = Chain::builder("cart") // a slide along x on a spring
    /// #     .spring("slide", MotionKind::Prismatic, Vector3::x(), 1e4, 0.0) // N/m
    /// #     .build()?;
    /// # let (post, hook) = (Anchor::Base(vector![-0.3, 0.4, 0.0]), Anchor::node(cart.tip())); // 0.5 m apart
    /// let mut problem = ChainProblem::new(&cart, EndCondition::wrench(Wrench::zero()));
    /// let gas = LengthLaw::Gas { force: 800.0, length: 0.5, column: 0.2, exponent: 1.0 }; // N, m, m
    /// problem.loads.push(Load::strut(post, hook, gas));
    /// let x = solve_chain(&problem, &Settings::default())?.coordinates[0];
    /// // It pushes along its line; force times column of gas stays (isothermal).
    /// let length = (0.3 + x).hypot(0.4);
    /// let push = 800.0 * 0.2 / (0.2 + length - 0.5);
    /// assert!(x > 0.0 && (1e4 * x - push * (0.3 + x) / length).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn strut(from: Anchor, to: Anchor, law: LengthLaw) -> Self {
        Self::custom(Strut { from, to, law })
    }

    /// A linear spring (N/m) between two points, without force at `free_length` (m).
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let cart = Chain::builder("cart") // a slide along x on a spring
    /// #     .spring("slide", MotionKind::Prismatic, Vector3::x(), 1e4, 0.0) // N/m
    /// #     .build()?;
    /// # let (post, hook) = (Anchor::Base(vector![-0.3, 0.4, 0.0]), Anchor::node(cart.tip())); // 0.5 m apart
    /// let mut problem = ChainProblem::new(&cart, EndCondition::wrench(Wrench::zero()));
    /// problem.loads.push(Load::spring_between(post, hook, 4e3, 0.45)); // N/m, m
    /// let x = solve_chain(&problem, &Settings::default())?.coordinates[0];
    /// let length = (0.3 + x).hypot(0.4);
    /// assert!(x < 0.0, "50 mm longer than at rest, it pulls");
    /// assert!((1e4 * x + 4e3 * (length - 0.45) * (0.3 + x) / length).abs() < 1e-6);
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn spring_between(from: Anchor, to: Anchor, stiffness: f64, free_length: f64) -> Self {
        let law = LengthLaw::Linear {
            stiffness,
            free_length,
            preload: 0.0,
        };
        Self::strut(from, to, law)
    }

    /// A rope with constant tension (N) between two points: a balancer, a weight over a pulley.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// let (mass, g) = (40.0, 9.81); // kg, m/s^2
    /// let head = Chain::builder("head")
    ///     .spring("slide", MotionKind::Prismatic, Vector3::z(), 1e5, 0.0) // N/m
    ///     .body("spindle", mass, vector![0.2, 0.1, -0.1], nalgebra::Matrix3::zeros())
    ///     .build()?;
    /// // A rope goes up from the spindle over a pulley 2 m above it, to a weight as heavy as the spindle.
    /// let (pulley, spindle) = (Anchor::Base(vector![0.2, 0.1, 1.9]), Anchor::node(head.node("spindle")?));
    /// let mut problem = ChainProblem::new(&head, EndCondition::wrench(Wrench::zero()));
    /// problem.loads.push(Load::gravity(vector![0.0, 0.0, -g]));
    /// problem.loads.push(Load::constant_tension(pulley, spindle, mass * g));
    /// let found = solve_chain(&problem, &Settings::default())?;
    /// assert!(found.coordinates[0].abs() < 1e-12, "the head hangs without its drive");
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn constant_tension(from: Anchor, to: Anchor, tension: f64) -> Self {
        Self::strut(from, to, LengthLaw::Constant { tension })
    }

    /// A load given as a function of node poses.
    #[must_use]
    pub fn function(function: FunctionLoad) -> Self {
        Self::custom(function)
    }

    /// Any other load.
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Vector3, vector};
    /// # use kinetostat::*;
    /// # let lever = Chain::builder("lever") // a joint about z on a spring, and an arm of 0.4 m
    /// #     .spring("joint", MotionKind::Revolute, Vector3::z(), 500.0, 0.0) // N m/rad
    /// #     .translation(vector![0.4, 0.0, 0.0])
    /// #     .node("lug")
    /// #     .translation(vector![0.2, 0.0, 0.0])
    /// #     .build()?;
    /// # let lug = lever.node("lug")?;
    /// let force = model::PointForce { node: lug, point: vector![0.0, 0.1, 0.0], force: vector![0.0, 0.0, 9.0] };
    /// let load = Load::custom(force);
    /// assert_eq!(load, Load::point_force(lug, vector![0.0, 0.1, 0.0], vector![0.0, 0.0, 9.0]));
    /// assert!(load.conservative(&lever));
    /// # Ok::<(), Error>(())
    /// ```
    #[must_use]
    pub fn custom(load: impl NodeLoad + 'static) -> Self {
        Self::Custom(Arc::new(load))
    }

    /// Appends the wrenches, multiplied by `factor`.
    pub(crate) fn add_wrenches(
        &self,
        chain: &Chain,
        kinematics: &Kinematics,
        factor: f64,
        out: &mut Vec<(usize, Wrench)>,
    ) {
        match self {
            Self::Dead { node, wrench } => out.push((*node, *wrench * factor)),
            Self::Gravity(gravity) => {
                out.extend(chain.bodies().iter().map(|body| {
                    let weight = Wrench::new(gravity * (body.mass * factor), Vector3::zeros());
                    (body.node, weight)
                }));
                for segment in chain.segment_masses() {
                    let weight = segment.weight(kinematics, gravity);
                    out.push((segment.near, weight.near * factor));
                    out.push((segment.far, weight.far * factor));
                }
            }
            Self::Custom(load) => {
                let first = out.len();
                load.wrenches(kinematics, out);
                for (_, wrench) in &mut out[first..] {
                    *wrench = *wrench * factor;
                }
            }
        }
    }

    /// Appends the tangents, multiplied by `factor`.
    pub(crate) fn add_tangents(
        &self,
        chain: &Chain,
        kinematics: &Kinematics,
        factor: f64,
        out: &mut Vec<NodeTangent>,
    ) {
        match self {
            Self::Dead { .. } => {}
            Self::Gravity(gravity) => {
                for segment in chain.segment_masses() {
                    let weight = segment.weight(kinematics, gravity);
                    out.extend(weight.tangents(segment, factor));
                }
            }
            Self::Custom(load) => {
                let first = out.len();
                load.tangents(kinematics, out);
                for tangent in &mut out[first..] {
                    tangent.matrix *= factor;
                }
            }
        }
    }
}
