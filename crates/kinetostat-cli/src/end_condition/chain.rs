//! The chain of a machine with one limb, commanded for a place, with everything that acts on it.

use kinetostat::{Chain, ChainProblem, EndCondition, Kinematics, Load, MotionKind, Pose, Wrench};
use nalgebra::DMatrix;

use crate::end_condition::coordinates::{CoordinateName, coordinates_of, outline_of, values_of};
use crate::end_condition::moves::Moves;
use crate::machine::units::unit_of;
use crate::place::query::Spot;
use crate::ui::failure::{Answer, Failure};

/// A serial chain from the base to the tool's tip.
#[derive(Clone, Debug)]
pub(crate) struct SerialChain {
    pub(crate) chain: Chain,
    pub(crate) base: Pose,
    /// m or rad.
    pub(crate) commands: Vec<f64>,
    /// Coordinates of the commanded, unloaded posture, m or rad.
    pub(crate) posture: Vec<f64>,
    /// Gravity and everything else that acts all the time.
    pub(crate) loads: Vec<Load>,
    /// Where the tool is commanded to be.
    pub(crate) place: Pose,
}

/// Whether a machine is one chain from the base to the tool.
pub(crate) fn is_chain(spot: &Spot) -> bool {
    let m = &spot.mechanism;
    matches!(m.limbs(), [limb] if limb.from == 0 && limb.to == m.tool())
}

/// Takes the chain out of a machine that [`is_chain`].
pub(crate) fn serial_chain(spot: &Spot) -> Answer<SerialChain> {
    let m = &spot.mechanism;
    let (tool, limb) = (m.tool(), &m.limbs()[0]);
    let posture = spot.posture()?;
    let joints = &posture.limbs()[0];
    let offset = limb.platform_from_tip.inverse();
    // The old end keeps what acts on it; results refer to the tool's tip.
    let chain = if offset == Pose::identity() {
        limb.actual.clone()
    } else {
        let free = ["flange", "flange of the tool", "last frame of the chain"];
        let taken = limb.actual.nodes();
        let name = free.iter().find(|n| !taken.iter().any(|t| t == *n));
        limb.actual
            .with_end(name.copied().unwrap_or("old tip"), &offset)?
    };
    let gravity = m.gravity();
    let platform = &m.platforms()[tool];
    let mut loads = Vec::new();
    if gravity.norm() > 0.0 && !chain.bodies().is_empty() {
        loads.push(Load::gravity(gravity));
    }
    loads.extend(m.loads(0).iter().cloned());
    if gravity.norm() > 0.0 && platform.mass > 0.0 {
        loads.push(Load::counterweight(
            chain.tip(),
            platform.centre_of_mass,
            platform.mass,
            gravity,
        ));
    }
    Ok(SerialChain {
        base: m.platforms()[0].home,
        commands: joints.commands.clone(),
        posture: joints.coordinates.clone(),
        loads,
        place: spot.target,
        chain,
    })
}

impl SerialChain {
    /// The question to the core with an end condition.
    pub(crate) fn problem(&self, end: EndCondition) -> ChainProblem<'_> {
        ChainProblem {
            chain: &self.chain,
            base: self.base,
            commands: self.commands.clone(),
            posture: self.posture.clone(),
            loads: self.loads.clone(),
            end,
        }
    }

    /// A dead force at a node, written `NODE=FX,FY,FZ`.
    pub(crate) fn node_force(&self, option: &str, text: &str) -> Answer<Load> {
        let refuse = |reason: String| Failure::input(format!("{option} '{text}': {reason}"));
        let Some((name, values)) = text.split_once('=') else {
            return Err(refuse(format!(
                "write a node of the chain and three forces in N, as in {option} {}=0,0,-100",
                self.chain.nodes().first().map_or("tip", String::as_str)
            )));
        };
        let name = name.trim();
        let known = self.chain.nodes();
        let Some(node) = known.iter().position(|n| n == name) else {
            let names: Vec<&str> = known.iter().map(String::as_str).collect();
            let near = crate::ui::spelling::nearest(name, &names)
                .map_or_else(|| ".".to_owned(), |n| format!("; did you mean '{n}'?"));
            return Err(refuse(format!(
                "the chain has no node '{name}'{near} It has: {}. A model file names one with {{ node = \"NAME\" }}",
                known.join(", ")
            )));
        };
        let numbers: Vec<f64> = values
            .split(',')
            .map(|v| v.trim().parse::<f64>().ok().filter(|x| x.is_finite()))
            .collect::<Option<_>>()
            .filter(|list: &Vec<f64>| list.len() == 3)
            .ok_or_else(|| {
                refuse(
                    "three numbers with decimal points, separated by commas, are needed (N)".into(),
                )
            })?;
        let force = nalgebra::Vector3::new(numbers[0], numbers[1], numbers[2]);
        Ok(Load::dead(
            node,
            Wrench::new(force, nalgebra::Vector3::zeros()),
        ))
    }

    /// Motions that the end can make near the commanded posture, whatever moves: columns of an
    /// orthonormal basis, rotations at the natural length. What is missing is rigid everywhere: a
    /// planar chain does not leave its plane.
    pub(crate) fn movable(&self) -> DMatrix<f64> {
        let n = self.chain.coordinate_count();
        let length = self.chain.scale().length;
        let sizes = [0.0, 0.4, -0.9, 1.7];
        let mut all = DMatrix::zeros(6, n * sizes.len());
        for (k, size) in sizes.into_iter().enumerate() {
            let x: Vec<f64> = self
                .posture
                .iter()
                .zip(self.chain.coordinates())
                .enumerate()
                .map(|(i, (x, c))| {
                    let unit = match c.kind {
                        MotionKind::Revolute => 1.0,
                        MotionKind::Prismatic => 0.1 * length,
                    };
                    // Irregular, so that no posture is singular by symmetry.
                    x + size * unit * (0.4 + 0.6 * ((i + k) as f64 * 0.618_034).fract())
                })
                .collect();
            let kinematics = Kinematics::new(&self.chain, &self.base, &x, &self.commands, false);
            let jacobian = kinematics.jacobian(self.chain.tip());
            for j in 0..n {
                for i in 0..6 {
                    let unit = if i < 3 { 1.0 / length } else { 1.0 };
                    all[(i, k * n + j)] = unit * jacobian[(i, j)];
                }
                // Each coordinate counts alike, in whatever unit it is.
                let size = all.column(k * n + j).norm();
                if size > 0.0 {
                    all.column_mut(k * n + j).unscale_mut(size);
                }
            }
        }
        kinetostat::SingularValues::of(&all).range(1e-8)
    }

    /// What every coordinate is, for people and for tables.
    pub(crate) fn coordinates(&self) -> Vec<CoordinateName> {
        coordinates_of(&self.chain, &self.commands)
    }

    /// Values of all coordinates in their units; of a drive the joint's whole position, command
    /// included.
    pub(crate) fn values(&self, coordinates: &[f64]) -> Vec<f64> {
        values_of(&self.chain, &self.commands, coordinates)
    }

    /// Places along the chain at a state, base to tip, m, without repetition.
    pub(crate) fn outline(&self, coordinates: &[f64]) -> Vec<nalgebra::Vector3<f64>> {
        outline_of(&self.chain, &self.base, &self.commands, coordinates)
    }

    /// Where its end can go.
    pub(crate) fn moves(&self) -> Moves {
        Moves {
            subject: "chain",
            place: self.place,
            basis: self.movable(),
            length: self.chain.scale().length,
        }
    }
}

/// A motion of all coordinates in words: the joints that move most, each by how much while the
/// largest turns by one degree (or slides by one millimetre, where nothing turns).
pub(crate) fn mode_in_words(chain: &SerialChain, mode: &[f64]) -> String {
    let coordinates = chain.chain.coordinates();
    let largest = |kind: MotionKind| {
        coordinates
            .iter()
            .zip(mode)
            .filter(|(c, _)| c.kind == kind)
            .map(|(c, m)| m.abs() * unit_of(c.kind))
            .fold(0.0, f64::max)
    };
    let (turns, slides) = (
        largest(MotionKind::Revolute),
        largest(MotionKind::Prismatic),
    );
    // Radians against the natural length decide which kind leads.
    let length = 1e3 * chain.chain.scale().length;
    let unit = if turns.to_radians() * length >= slides {
        turns
    } else {
        slides
    };
    if unit <= 0.0 {
        return "nothing moves".into();
    }
    let mut parts: Vec<(f64, String)> = coordinates
        .iter()
        .zip(mode)
        .filter_map(|(c, m)| {
            let by = m * unit_of(c.kind) / unit;
            let (size, word) = match c.kind {
                MotionKind::Revolute => (by.abs().to_radians() * length, "deg"),
                MotionKind::Prismatic => (by.abs(), "mm"),
            };
            let shown = crate::ui::numbers::fixed(by, 3);
            let something = shown.bytes().any(|b| (b'1'..=b'9').contains(&b));
            something.then(|| (size, format!("{} by {shown} {word}", c.name)))
        })
        .collect();
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let most = parts.first().map_or(0.0, |p| p.0);
    parts.retain(|p| p.0 > 0.02 * most);
    let more = parts.len().saturating_sub(6);
    let mut text: Vec<String> = parts.into_iter().take(6).map(|p| p.1).collect();
    if more > 0 {
        text.push(format!("{more} more by less"));
    }
    text.join(", ")
}
