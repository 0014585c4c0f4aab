//! Shapes of the limbs of a machine while its tool is held: each limb by itself, as a chain.

use crate::chain::problem::{ChainProblem, EndCondition};
use crate::chain::scaling::nudged;
use crate::equilibrium::all_of_chain::{SearchSettings, equilibria};
use crate::equilibrium::chain_starts::Bounds;
use crate::equilibrium::found::{Equilibria, FoundEquilibrium};
use crate::error::Result;
use crate::linalg::singular_values::SingularValues;
use crate::machine::inverse::limb::LimbPosture;
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::model::chain::{Chain, Role};
use crate::model::kinematics::Kinematics;
use crate::number::largest_size;
use crate::parallel;
use crate::spatial::{MotionKind, Pose, pose_residual};

/// Combinations of the limbs' shapes that are made, those of least energy.
pub(crate) const LISTED: usize = 1000;

/// Limbs with more coordinates are not searched one by one: each start costs many times as much, and shapes are many.
const SHORT: usize = 8;

/// Limbs of so many coordinates are searched one by one in any case: where nothing is free in them, they still have two elbows.
const SHORTEST: usize = 4;

/// Shapes are one if no spring's deflection and no node differ by more, rad and shares of the machine's size: where a limb is
/// stretched out, what closes within 1e-12 leaves its joints within the root of that.
const SAME: f64 = 1e-5;

/// A slide that turns inside out goes further than this share of the machine's size.
const INSIDE_OUT: f64 = 0.25;

/// One shape of each limb, by number, and the sum of their energies, J.
#[derive(Clone)]
pub(crate) struct Combination {
    pub shapes: Vec<usize>,
    pub energy: f64,
}

/// True if the limbs go from the base to the tool, are short, and some can take several shapes while the tool is held: it has
/// more freedoms than it moves its tip in, or all have so few that their elbows are found at once. Long limbs have shapes without number, of energies far beyond what the machine
/// is made for, and are searched together.
pub(crate) fn are_searched_one_by_one(posture: &Posture) -> bool {
    let mechanism = &posture.mechanism;
    let limbs = || mechanism.limbs().iter().map(|limb| &limb.actual);
    let mut joints = limbs().zip(&posture.limbs);
    let gives_way = |(chain, own): (&Chain, &LimbPosture)| {
        let beside = nudged(chain, &own.coordinates, 0.5);
        let kinematics = Kinematics::new(chain, &Pose::identity(), &beside, &own.commands);
        let motions = SingularValues::of(&kinematics.jacobian(chain.tip()));
        motions.rank(1e-8) < chain.coordinate_count()
    };
    mechanism.platforms().len() == 2
        && limbs().all(|chain| chain.coordinate_count() <= SHORT)
        && (limbs().all(|chain| chain.coordinate_count() <= SHORTEST) || joints.any(gives_way))
}

/// Shapes of every limb with the tool held at a place, as far as they can be found.
pub(crate) fn limb_shapes(
    posture: &Posture,
    place: &Pose,
    settings: &SearchSettings,
) -> Result<Vec<Equilibria>> {
    let limbs = (0..posture.mechanism.limbs().len()).collect();
    let found = parallel::map(limbs, |i| shapes_of(posture, i, place, settings));
    found.into_iter().collect()
}

/// Shapes of one limb; those with a slide turned inside out do not count.
fn shapes_of(
    posture: &Posture,
    i: usize,
    place: &Pose,
    settings: &SearchSettings,
) -> Result<Equilibria> {
    let mechanism = &posture.mechanism;
    let (limb, joints) = (&mechanism.limbs()[i], &posture.limbs[i]);
    let mut platforms = posture.platforms.clone();
    platforms[mechanism.tool()] = *place;
    let problem = ChainProblem {
        chain: &limb.actual,
        base: platforms[limb.from],
        commands: joints.commands.clone(),
        posture: joints.coordinates.clone(),
        loads: mechanism.acting(i),
        end: EndCondition::pose(platforms[limb.to] * limb.platform_from_tip),
    };
    let mut all = equilibria(&problem, &Bounds::of(&limb.actual), settings)?;
    let mut kept: Vec<FoundEquilibrium> = Vec::with_capacity(all.found.len());
    for next in all.found.drain(..) {
        let x = &next.equilibrium.coordinates;
        if is_inside_out(&limb.actual, &joints.commands, x, mechanism.size()) {
            all.hits -= next.hits;
            all.outside += next.hits;
            continue;
        }
        match kept
            .iter_mut()
            .find(|own| same(&limb.actual, own, &next, mechanism.size()))
        {
            // A chain that is stretched out and locked is one shape under every force along itself.
            Some(own) => {
                let hits = own.hits + next.hits;
                let size = |f: &FoundEquilibrium| f.equilibrium.wrench.0.norm();
                if size(&next) < size(own) {
                    *own = next;
                }
                own.hits = hits;
            }
            None => kept.push(next),
        }
    }
    all.found = kept;
    Ok(all)
}

/// One shape twice: all springs have the same torques, or the same deflections within rounding (what is left of torques
/// where a limb is stretched out and locked), and all nodes are at the same places. Joints that turn for nothing do not
/// count, nor do the two sets of angles of a universal joint that turn it the same way.
fn same(chain: &Chain, a: &FoundEquilibrium, b: &FoundEquilibrium, size: f64) -> bool {
    let (a, b) = (&a.equilibrium, &b.equilibrium);
    let pairs = a.coordinates.iter().zip(&b.coordinates);
    let mut springs =
        (chain.coordinates().iter().zip(pairs)).filter(|(c, _)| c.role == Role::Spring);
    let alike = springs.all(|(c, (x, y))| {
        let unit = if c.kind == MotionKind::Revolute {
            1.0
        } else {
            size
        };
        (x - y).abs() <= SAME * unit
    });
    let most = largest_size(a.spring_torques.iter().chain(&b.spring_torques));
    let mut torques = a.spring_torques.iter().zip(&b.spring_torques);
    let mut nodes = a.nodes.iter().zip(&b.nodes);
    (alike || torques.all(|(x, y)| (x - y).abs() <= 1e-5 * most + 1e-9))
        && nodes.all(|(p, q)| pose_residual(p, q).linear().norm() <= SAME * size)
}

/// The combinations of one shape of each limb, those of least energy, by rising energy.
pub(crate) fn combinations(limbs: &[Equilibria]) -> Vec<Combination> {
    let mut list = vec![Combination {
        shapes: Vec::new(),
        energy: 0.0,
    }];
    for limb in limbs {
        let longer = list.iter().flat_map(|begun| {
            limb.found.iter().enumerate().map(move |(i, shape)| {
                let mut shapes = begun.shapes.clone();
                shapes.push(i);
                Combination {
                    shapes,
                    energy: begun.energy + shape.energy(),
                }
            })
        });
        list = longer.collect();
        // Whatever follows, it adds the same to all of them.
        list.sort_by(|a, b| a.energy.total_cmp(&b.energy));
        list.truncate(LISTED);
    }
    list
}

/// The machine with its tool held at a place, its limbs in these shapes.
pub(crate) fn state_of(
    posture: &Posture,
    place: &Pose,
    limbs: &[Equilibria],
    combination: &Combination,
) -> MechanismState {
    let shapes = limbs.iter().zip(&combination.shapes);
    let shapes = shapes.map(|(limb, &i)| &limb.found[i].equilibrium);
    let (coordinates, wrenches) = shapes.map(|e| (e.coordinates.clone(), e.wrench)).unzip();
    let mut platforms = posture.platforms.clone();
    platforms[posture.mechanism.tool()] = *place;
    MechanismState {
        platforms,
        coordinates,
        wrenches,
    }
}

/// True if a drive's slide is turned inside out.
///
/// A leg is as long as its command, which no spring turns negative. Other slides count from a zero that anybody may
/// set: there a deflection passes it, but by nothing like the size of the machine (m).
pub(crate) fn is_inside_out(chain: &Chain, commands: &[f64], x: &[f64], size: f64) -> bool {
    let mut drives = chain.actuators().iter().zip(commands);
    drives.any(|(drive, command)| {
        let spring = (drive.coordinate).filter(|_| drive.kind == MotionKind::Prismatic);
        spring.is_some_and(|own| {
            x[own].abs() > INSIDE_OUT * size && (command + x[own]) * command < 0.0
        })
    })
}
