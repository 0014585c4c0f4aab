//! One chain about its equilibrium, its end free, held or partly held.

use kinetostat::chain::ChainTangent;
use kinetostat::model::{Element, Segment};
use kinetostat::{Chain, ChainProblem, MotionKind, Pose, Wrench};
use nalgebra::{DMatrix, Vector3};

use crate::ends::Held;
use crate::error::Result;
use crate::linear::build::Whole;
use crate::linear::limb::LimbShare;
use crate::linear::rotor::rotors_of_chain;
use crate::linear::{LinearDynamics, LumpedLink, NamedCoordinate};

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
