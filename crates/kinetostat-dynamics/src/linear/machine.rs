//! A machine of platforms and limbs about an equilibrium [D4, D5].

use kinetostat::chain::ChainTangent;
use kinetostat::model::{Element, Segment};
use kinetostat::spatial::shift_matrix;
use kinetostat::{Chain, ChainProblem, MechanismEquilibrium, MotionKind, Pose, Posture, Wrench};
use nalgebra::{DMatrix, Matrix6xX, Vector3};

use crate::ends::Held;
use crate::error::Result;
use crate::linear::build::Whole;
use crate::linear::limb::LimbShare;
use crate::linear::rotor::{rotors_of, rotors_of_chain};
use crate::linear::{LinearDynamics, LumpedLink, NamedCoordinate, Place};
use crate::mass::body;

impl LinearDynamics {
    /// A machine at an equilibrium of a posture; `held` are the directions in which the tool does not move.
    ///
    /// Masses are those of bodies, links and platforms of the machine as it is built, at the loaded posture. Closures
    /// are met exactly, whatever they are worth twice: over-constraint, redundant joints and limbs that cannot move in
    /// some direction need nothing from the caller.
    ///
    /// # Errors
    /// A state of another machine; [`crate::Error::NoMass`]; [`crate::Error::Inertia`].
    ///
    /// ```
    /// # use kinetostat::nalgebra::{Matrix3, Vector3, vector};
    /// # use kinetostat::*;
    /// use kinetostat_dynamics::{Held, LinearDynamics};
    ///
    /// let slide = ActuatorSpec::new(MotionKind::Prismatic, Vector3::x(), 1e6); // N/m
    /// let rail = Chain::builder("rail").actuator("trolley", slide).build()?;
    /// let mut crane = Mechanism::builder("crane");
    /// let hook = Platform { mass: 25.0, ..Platform::new("hook", Pose::identity()) }; // kg
    /// let hook = crane.platform(hook);
    /// let crane = crane.limb(Limb::between("rail", 0, hook, rail)).build()?;
    /// let posture = crane.posture(&Pose::identity())?;
    /// let at = posture.deflected_by(&Wrench::zero())?;
    /// let modes = LinearDynamics::of_machine(&posture, &at, &Held::nothing())?.modes()?;
    /// let hertz = (1e6_f64 / 25.0).sqrt() / std::f64::consts::TAU;
    /// assert!((modes.modes[0].frequency_hz() - hertz).abs() < 1e-9);
    /// assert_eq!(modes.counts.rigid, 5, "the hook moves along the rail and nowhere else");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_machine(posture: &Posture, at: &MechanismEquilibrium, held: &Held) -> Result<Self> {
        Self::of_state(posture, &at.state, &at.wrench, held)
    }

    /// Linearises at a state that is known to be in equilibrium under a wrench on the tool.
    ///
    /// # Errors
    /// See [`Self::of_machine`].
    pub fn of_state(
        posture: &Posture,
        state: &kinetostat::machine::MechanismState,
        wrench: &kinetostat::Wrench,
        held: &Held,
    ) -> Result<Self> {
        let machine = posture.mechanism();
        let tangents = posture.tangents_at(state, wrench)?;
        let length = machine.natural_length();
        let limbs = machine.limbs();
        let moving = machine.platforms().len() - 1;
        let mut firsts = Vec::with_capacity(limbs.len());
        let mut all = Vec::new();
        for limb in limbs {
            firsts.push(all.len());
            all.extend(units(&limb.actual, length));
        }
        let motions = all.len();
        for _ in 0..moving {
            all.extend([length, length, length, 1.0, 1.0, 1.0]);
        }
        let platform = |p: usize| motions + 6 * (p - 1)..motions + 6 * p;
        let mut blocks: Vec<Vec<usize>> = (limbs.iter().zip(&firsts))
            .map(|(limb, &first)| {
                let own = first..first + limb.actual.coordinate_count();
                match limb.from {
                    0 => own.collect(),
                    base => own.chain(platform(base)).collect(),
                }
            })
            .collect();
        blocks.extend((1..=moving).map(|p| platform(p).collect::<Vec<_>>()));
        let mut whole = Whole::sized(all, blocks);
        let mut tips = Vec::with_capacity(limbs.len());
        for (i, (limb, at)) in limbs.iter().zip(&tangents.limbs).enumerate() {
            let prefix = match limbs.len() {
                1 => String::new(),
                _ => format!("{}.", limb.name),
            };
            let share = LimbShare::new(&limb.actual, &prefix, i, at)?;
            let arm = state.platforms[limb.to].rotation * limb.platform_from_tip.translation.vector;
            // Motion of the platform's origin that goes with the limb's tip.
            let tip = DMatrix::from_fn(6, share.tip.ncols(), |r, c| share.tip[(r, c)]);
            tips.push(shift_matrix(&-arm) * Matrix6xX::from_fn(tip.ncols(), |r, c| tip[(r, c)]));
            whole.add_limb(i, share);
            whole
                .coordinates
                .extend(named(&limb.actual, &prefix, firsts[i]));
            whole
                .coarse_links
                .extend(coarse_links(&limb.actual, &prefix));
            whole
                .lumped_links
                .extend(lumped_links(&limb.actual, &prefix));
        }
        let mut view = whole
            .tangent
            .view_mut((motions, motions), (6 * moving, 6 * moving));
        view += &tangents.platforms;
        for (p, own) in machine.platforms().iter().enumerate().skip(1) {
            body::check(&own.name, own.mass, &own.inertia)?;
            let pose = &state.platforms[p];
            let rotation = *pose.rotation.to_rotation_matrix().matrix();
            let arm = rotation * own.centre_of_mass;
            whole.add_platform(
                &own.name,
                limbs.len() + p - 1,
                body::about_point(own.mass, &own.inertia, &rotation, &arm),
            );
            whole.places.push(Place {
                name: own.name.clone(),
                position: pose.translation.vector,
                block: limbs.len() + p - 1,
                motions: Matrix6xX::identity(6),
            });
        }
        let tool = whole.places.len() - moving + machine.tool() - 1;
        closed(whole, posture, &tips, held, tool, length)?.with_rotors(&rotors_of(machine))
    }
}

/// Platforms follow the first limb that leads to them; what is left of the closures becomes conditions.
fn closed(
    whole: Whole,
    posture: &Posture,
    tips: &[Matrix6xX<f64>],
    held: &Held,
    tool: usize,
    length: f64,
) -> Result<LinearDynamics> {
    let machine = posture.mechanism();
    let limbs = machine.limbs();
    let moving = machine.platforms().len() - 1;
    let n = whole.units.len();
    let free = n - 6 * moving;
    let mut start = DMatrix::zeros(n, free);
    start.view_mut((0, 0), (free, free)).fill_with_identity();
    let mut placed = vec![false; moving + 1];
    placed[0] = true;
    let mut leads = vec![false; limbs.len()];
    while let Some(next) = limbs.iter().position(|l| placed[l.from] && !placed[l.to]) {
        let motion = of_tip(&whole, next, &tips[next], &start);
        start
            .view_mut((free + 6 * (limbs[next].to - 1), 0), (6, free))
            .copy_from(&motion);
        placed[limbs[next].to] = true;
        leads[next] = true;
    }
    let others: Vec<usize> = (0..limbs.len()).filter(|&i| !leads[i]).collect();
    // A platform that only limbs to it from beyond lead to keeps its six motions as unknowns of its own.
    let lost: Vec<usize> = (1..=moving).filter(|&p| !placed[p]).collect();
    let kept = free + 6 * lost.len();
    let mut start = start.resize_horizontally(kept, 0.0);
    for (k, p) in lost.iter().enumerate() {
        for i in 0..6 {
            start[(free + 6 * (p - 1) + i, free + 6 * k + i)] = 1.0;
        }
    }
    let held_motions = DMatrix::from_fn(6, kept, |i, j| {
        start[(free + 6 * (machine.tool() - 1) + i, j)]
    });
    let hands = held_rows(held, &held_motions, length);
    let mut rows = DMatrix::zeros(6 * others.len() + hands.nrows(), kept);
    for (k, &i) in others.iter().enumerate() {
        let motion = of_tip(&whole, i, &tips[i], &start);
        let platform = start.rows(free + 6 * (limbs[i].to - 1), 6);
        let mut own = motion - platform;
        own.rows_mut(0, 3).scale_mut(1.0 / length);
        rows.rows_mut(6 * k, 6).copy_from(&own);
    }
    rows.rows_mut(6 * others.len(), hands.nrows())
        .copy_from(&hands);
    let mut start_units = whole.units[..free].to_vec();
    for _ in &lost {
        start_units.extend([length, length, length, 1.0, 1.0, 1.0]);
    }
    let name = machine.name().to_owned();
    let own = whole.constrained(&name, Some(start), Some(rows), tool, length, start_units)?;
    Ok(without_rounding(own, held))
}

/// Removes rounding from the tool's motions along held directions: it would look like a motion where there is no other.
fn without_rounding(mut own: LinearDynamics, held: &Held) -> LinearDynamics {
    let tool = &own.blocks[own.places[own.tool].block];
    let (Some(basis), Some(&first)) = (&mut own.basis, tool.first()) else {
        return own;
    };
    for k in (0..6).filter(|&k| held.directions[k]) {
        let along = held.axes.matrix().column(k % 3).into_owned();
        for mut column in basis.column_iter_mut() {
            let mut part = column.fixed_rows_mut::<3>(first + 3 * (k / 3));
            let moved = along.dot(&part);
            part -= along * moved;
        }
    }
    own
}

/// Motion of a platform's origin as the tip of a limb has it, by the unknowns of `start`, 6 x m.
fn of_tip(whole: &Whole, limb: usize, tip: &Matrix6xX<f64>, start: &DMatrix<f64>) -> DMatrix<f64> {
    let own = start.select_rows(&whole.blocks[limb]);
    let motion = tip * own;
    DMatrix::from_fn(6, motion.ncols(), |i, j| motion[(i, j)])
}

/// Natural units of a chain's coordinates: a slide by the natural length, a turn by a radian.
pub(crate) fn units(chain: &Chain, length: f64) -> impl Iterator<Item = f64> + '_ {
    chain.coordinates().iter().map(move |c| match c.kind {
        MotionKind::Prismatic => length,
        MotionKind::Revolute => 1.0,
    })
}

/// Names of links in one segment.
pub(crate) fn coarse_links<'a>(
    chain: &'a Chain,
    prefix: &'a str,
) -> impl Iterator<Item = String> + 'a {
    let links = chain.springs().iter().filter_map(|s| s.segment.as_ref());
    links
        .clone()
        .filter(move |s| links.clone().filter(|other| other.link == s.link).count() == 1)
        .map(move |s| format!("{prefix}{}", s.link))
}

/// Links whose masses stand at their ends.
pub(crate) fn lumped_links(chain: &Chain, prefix: &str) -> Vec<LumpedLink> {
    let mut found = Vec::new();
    // The link that has just ended, and the way from its end.
    let mut behind: Option<&Segment> = None;
    let mut way = Pose::identity();
    for element in chain.elements() {
        match element {
            Element::Rigid(pose) => way *= pose,
            Element::Motion(motion) => {
                let of = |index: usize| {
                    let mut all = chain.springs().iter();
                    all.find(|s| (s.first..s.first + s.len()).contains(&index))
                };
                let spring = motion.coordinate.and_then(|drive| of(drive.index));
                behind = spring.and_then(|spring| spring.segment.as_ref());
                way = Pose::identity();
            }
            Element::Node(node) => {
                let bodies = chain.bodies().iter();
                let body = bodies
                    .filter(|body| body.node == *node)
                    .find(|b| b.mass > 0.0);
                if let (Some(link), Some(body)) = (behind, body)
                    && is_along(link, &way.translation.vector)
                {
                    found.push(LumpedLink {
                        link: format!("{prefix}{}", link.link),
                        body: format!("{prefix}{}", body.name),
                    });
                }
            }
        }
    }
    found
}

/// True if a place, seen from the far end of a link, lies beside it: well before its end, and nearer than its length.
fn is_along(link: &Segment, place: &Vector3<f64>) -> bool {
    let back = -place.dot(&link.along) / link.link_length;
    let aside = (place + link.along * (back * link.link_length)).norm();
    (0.1..=1.0).contains(&back) && aside < 0.5 * link.link_length
}

/// Rows `axes^T J` of the held directions, in units of a natural length.
pub(crate) fn held_rows(held: &Held, motions: &DMatrix<f64>, length: f64) -> DMatrix<f64> {
    let axes = held.axes.matrix();
    let all: Vec<usize> = (0..6).filter(|&k| held.directions[k]).collect();
    DMatrix::from_fn(all.len(), motions.ncols(), |row, j| {
        let k = all[row];
        let part = 3 * (k / 3);
        let along: f64 = (0..3)
            .map(|i| axes[(i, k % 3)] * motions[(part + i, j)])
            .sum();
        if k < 3 { along / length } else { along }
    })
}

impl LinearDynamics {
    /// A chain at coordinates (m, rad) at which it is in equilibrium under the loads of `problem` and a wrench on its
    /// end; `held` are the directions in which the end does not move.
    ///
    /// # Errors
    /// Wrong input as in [`kinetostat::solve_chain`]; [`crate::Error::NoMass`]; [`crate::Error::Inertia`].
    pub fn of_chain(
        problem: &ChainProblem<'_>,
        coordinates: &[f64],
        wrench: &Wrench,
        held: &Held,
    ) -> Result<Self> {
        let chain = problem.chain;
        let tangent = ChainTangent::at(problem, coordinates, wrench)?;
        let length = chain.scale().length;
        let n = chain.coordinate_count();
        let share = LimbShare::new(chain, "", 0, &tangent)?;
        let rows = (!held.is_free()).then(|| {
            let tip = DMatrix::from_fn(6, n, |i, j| share.tip[(i, j)]);
            held_rows(held, &tip, length)
        });
        let units: Vec<f64> = units(chain, length).collect();
        let mut whole = Whole::sized(units.clone(), vec![(0..n).collect()]);
        whole.add_limb(0, share);
        whole.coordinates.extend(named(chain, "", 0));
        whole.coarse_links.extend(coarse_links(chain, ""));
        whole.lumped_links.extend(lumped_links(chain, ""));
        let without = whole.constrained(chain.name(), None, rows, chain.tip(), length, units)?;
        without.with_rotors(&rotors_of_chain(chain, ""))
    }
}

/// Joints and springs of a chain as places of dampers.
pub(crate) fn named<'a>(
    chain: &'a Chain,
    prefix: &'a str,
    first: usize,
) -> impl Iterator<Item = NamedCoordinate> + 'a {
    chain
        .coordinates()
        .iter()
        .enumerate()
        .map(move |(i, c)| NamedCoordinate {
            name: format!("{prefix}{}", c.name),
            index: first + i,
        })
}
