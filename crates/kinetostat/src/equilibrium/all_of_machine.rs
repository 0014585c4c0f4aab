//! Equilibria of a machine from many starts: places of its tool and joints spread evenly, those
//! beyond a singular posture first.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector, Vector6};
use rayon::prelude::*;

use crate::chain::directions::DirectionKind;
use crate::chain::found_by::FoundBy;
use crate::chain::problem::EndCondition;
use crate::continuation::settings::CurveSettings;
use crate::continuation::tool_conditions::ToolConditions;
use crate::equilibrium::all_of_chain::{Bounds, chance_of_more};
use crate::error::Result;
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::Unknowns;
use crate::machine::posture::Posture;
use crate::machine::state::MechanismState;
use crate::model::chain::Role;
use crate::model::kinematics::unloaded_tip;
use crate::spatial::{MotionKind, Pose, Twist, Wrench, moved, pose_residual};

/// How long to search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SpreadSettings {
    /// Starts at most. Default 1000.
    pub starts: usize,
    /// The search ends after this many in a row that found nothing new. Default 100.
    pub fruitless: usize,
}

impl Default for SpreadSettings {
    fn default() -> Self {
        Self {
            starts: 1000,
            fruitless: 100,
        }
    }
}

/// One of them.
#[derive(Clone, Debug)]
pub struct MachineFound {
    /// The equilibrium.
    pub equilibrium: MechanismEquilibrium,
    /// Whether it stays under the conditions as prescribed: held where the tool is held, under the
    /// dead wrench where it is free.
    pub stable: bool,
    /// Under a wrench without a potential it does not go away, but may swing with growing amplitude
    /// (flutter), which depends on the masses.
    pub may_flutter: bool,
    /// At a limit: a motion of the tool that needs no force and is free.
    pub singular: bool,
    /// Energy of springs and loads less the work of the dead wrench from the nominal target, J; of
    /// the springs alone where a load has no potential.
    pub potential: f64,
    /// Spread starts that ended there; 0: found only along a curve.
    pub hits: usize,
}

/// What a search found. It is no proof that there are no others.
#[derive(Clone, Debug)]
pub struct MachineEquilibria {
    /// By rising energy.
    pub found: Vec<MachineFound>,
    /// Starts, and how many of them ended at an equilibrium.
    pub starts: usize,
    /// See `starts`.
    pub hits: usize,
    /// Those that ended where a slide is turned inside out, or at an unstable shape farther than three
    /// sizes of the machine from the nominal target or with springs beyond [`Bounds::of`] their limb.
    pub outside: usize,
    /// Starts since the last new equilibrium.
    pub fruitless: usize,
    /// Share of the successful starts whose equilibrium was found just once (Good and Turing); never,
    /// by spread starts, counts too.
    pub chance_of_more: f64,
    /// Upper end of that chance (95 %).
    pub chance_of_more_at_most: f64,
    /// The search ended because nothing new came.
    pub settled: bool,
}

/// How far tools are put from the target, as shares of the machine's size.
const AMPLITUDES: [f64; 4] = [0.05, 0.2, 0.5, 1.0];

/// Starts that are made side by side.
const TOGETHER: usize = 16;

/// Curves are followed through so many equilibria at most.
const FOLLOWED: usize = 24;

/// How far curves are followed from the target, in sizes of the machine.
const FOLLOWED_SIZES: f64 = 2.0;

impl Posture<'_> {
    /// Equilibria of the machine as it is commanded: the tool held at `end.pose` in the directions
    /// whose pose is prescribed, under the dead wrench `end.wrench` in the others.
    ///
    /// The tool is held at places spread evenly and let go down the potential, and Newton is started
    /// with joints turned; from the commanded place and from every equilibrium found the tool is driven
    /// along each of its free motions, and every place where that takes no force is looked at; from
    /// unstable ones it is pushed along the motions in which they go away.
    ///
    /// # Errors
    /// Not-a-numbers in the condition. That nothing was found is a result.
    pub fn equilibria(
        &self,
        end: &EndCondition,
        settings: &SpreadSettings,
    ) -> Result<MachineEquilibria> {
        let path = ToolConditions::held_at(self, end)?;
        // Mirrored at the singular postures nearby, and at rest.
        let mut first = vec![Twist::zero()];
        let near = self.motion_gained(path.length);
        first.extend(near.map(|n| Twist(n.way.0 * (2.0 * n.distance_m))));
        let free = path.free_motions();
        let mut search = Search {
            path,
            bounds: self
                .mechanism
                .limbs
                .iter()
                .map(|l| Bounds::of(&l.actual))
                .collect(),
            known: Vec::new(),
            starts: 0,
            hits: 0,
            outside: 0,
            fruitless: 0,
        };
        let rest = self.wrench_at(&moved(&self.target, &Twist(search.path.held_motion())));
        let rest = rest.ok();
        search.follow(None);
        let mut followed = 0;
        loop {
            if followed < search.known.len().min(FOLLOWED) {
                search.follow(Some(followed));
                search.push_off(followed);
                followed += 1;
            } else if search.fruitless < settings.fruitless && search.starts < settings.starts {
                let most = TOGETHER.min(settings.starts - search.starts);
                let numbers: Vec<usize> = (search.starts..search.starts + most).collect();
                let start = |&k: &usize| {
                    let way = match first.get(k) {
                        Some(way) => search.path.freely(&way.0),
                        None => spread(&free, k, &search.path),
                    };
                    self.fallen(&search.path, rest.as_ref(), &way, k)
                };
                let ended: Vec<_> = numbers.par_iter().map(start).collect();
                for e in ended {
                    search.starts += 1;
                    search.fruitless += 1;
                    if let Some(e) = e {
                        search.note(e, true);
                    }
                    if search.fruitless >= settings.fruitless {
                        break;
                    }
                }
            } else {
                return Ok(search.finish(settings));
            }
        }
    }

    /// From the tool put aside by a motion (in every second start: with joints turned) to where it
    /// comes to rest; `rest` is the machine held where it is commanded.
    fn fallen(
        &self,
        path: &ToolConditions<'_, '_>,
        rest: Option<&MechanismEquilibrium>,
        way: &Vector6<f64>,
        k: usize,
    ) -> Option<MechanismEquilibrium> {
        let tool = self.mechanism.tool;
        let mut pose = moved(&self.target, &Twist(path.held_motion()));
        pose = moved(&pose, &Twist(*way));
        let mut state: MechanismState = self.rest_state();
        if k.is_multiple_of(2) && way.norm() > 0.0 {
            let held = match self.wrench_at(&pose) {
                Ok(held) => held,
                // Motions of the tool may be bound to each other.
                Err(_) => path.held_at_the_end(rest?.clone(), way)?,
            };
            let there = held.state.clone();
            return path.descend(held).or_else(|| path.rest(there, &path.dead));
        }
        if k > 0 {
            for (limb, joints) in self.mechanism.limbs.iter().zip(&mut state.coordinates) {
                for (i, c) in limb.actual.coordinates().iter().enumerate() {
                    if c.role == Role::Passive && c.kind == MotionKind::Revolute {
                        let share = ((k * 7 + i) as f64 * 0.618_034).fract() - 0.5;
                        joints[i] += TAU * AMPLITUDES[k / 2 % 4] * share;
                    }
                }
            }
        }
        let carriers = self.mechanism.limbs.iter().enumerate();
        let carriers = carriers.filter(|(_, l)| l.from == 0 && l.to == tool);
        let carriers: Vec<_> = carriers.collect();
        if k % 4 == 3
            && let Some((i, limb)) = carriers.get(k / 4 % carriers.len().max(1))
        {
            // Held where its turned joints bring it: loops close there another way.
            let (joints, commands) = (&state.coordinates[*i], &self.limbs[*i].commands);
            let tip = unloaded_tip(&limb.actual, &Pose::identity(), joints, commands);
            state.platforms[tool] = tip * limb.platform_from_tip.inverse();
            let mut solver = self.solver(state, Unknowns::Held);
            let (iterations, balance) = solver.solve(1.0, 0).ok()?;
            let held = conclude(&mut solver, balance.residual(iterations)).ok()?;
            return path.descend(held);
        }
        state.platforms[tool] = pose;
        path.rest(state, &path.dead)
    }
}

/// One that is known.
struct Known {
    found: MachineFound,
    /// Free motions along which the curve through it was followed.
    followed: Vec<bool>,
}

struct Search<'p, 'm> {
    path: ToolConditions<'p, 'm>,
    bounds: Vec<Bounds>,
    known: Vec<Known>,
    starts: usize,
    hits: usize,
    outside: usize,
    fruitless: usize,
}

impl Search<'_, '_> {
    /// Shapes with a drive whose slide is turned inside out do not count, nor do unstable ones far away.
    fn counts(&self, found: &MachineFound) -> bool {
        let posture = self.path.posture;
        let (mechanism, e) = (posture.mechanism, &found.equilibrium);
        let joints = mechanism.limbs.iter().zip(&e.state.coordinates);
        let drives = joints.clone().zip(&posture.limbs);
        let mut slides = drives.flat_map(|((limb, x), own)| {
            let drives = limb.actual.actuators().iter().zip(&own.commands);
            drives.filter_map(move |(drive, command)| {
                let slides = drive.kind == MotionKind::Prismatic;
                let spring = drive.coordinate.filter(|_| slides && *command != 0.0)?;
                Some((command + x[spring]) / command)
            })
        });
        let off = pose_residual(&e.tool, &posture.target).linear();
        let near = || {
            off.norm() <= 3.0 * mechanism.size()
                && joints
                    .clone()
                    .zip(&self.bounds)
                    .all(|((limb, x), bounds)| bounds.hold_springs(&limb.actual, x))
        };
        slides.all(|share| share > 0.0) && (found.stable || near())
    }

    /// Books an equilibrium: its number among the known ones, if it counts.
    fn note(&mut self, e: MechanismEquilibrium, counted: bool) -> Option<usize> {
        let of = |k: &Known| self.path.same(&k.found.equilibrium, &e);
        let number = match self.known.iter().position(of) {
            Some(number) => number,
            None => {
                let found = self.path.judged(e, &self.path.dead);
                if !self.counts(&found) {
                    self.outside += usize::from(counted);
                    return None;
                }
                self.fruitless = 0;
                self.known.push(Known {
                    found,
                    followed: vec![false; self.path.free.ncols()],
                });
                self.known.len() - 1
            }
        };
        self.hits += usize::from(counted);
        self.known[number].found.hits += usize::from(counted);
        Some(number)
    }

    /// Drives the tool along each of its free motions, both ways, from an equilibrium or (`None`) from
    /// the commanded place.
    fn follow(&mut self, known: Option<usize>) {
        let from = known.map(|k| self.known[k].found.equilibrium.clone());
        let reach = FOLLOWED_SIZES * self.path.posture.mechanism.size();
        let mut settings = CurveSettings::within(-reach, reach);
        settings.points = 60;
        settings.largest_change = Some(0.05 * reach);
        let open = |i: &usize| known.is_none_or(|k| !self.known[k].followed[*i]);
        let ways: Vec<usize> = (0..self.path.free.ncols()).filter(open).collect();
        let curve = |&i: &usize| {
            let way = Vector6::from_fn(|row, _| self.path.free[(row, i)]);
            self.path
                .driven(&way, settings.clone())
                .unloaded(from.as_ref())
        };
        let curves: Vec<_> = ways.par_iter().map(curve).collect();
        for (i, [crossings, ends]) in ways.into_iter().zip(curves) {
            for state in crossings {
                let there = state.platforms[self.path.posture.mechanism.tool];
                let Some(e) = self.path.rest(state, &self.path.dead) else {
                    continue;
                };
                let apart = self.path.balanced(&pose_residual(&e.tool, &there).0).norm();
                if let Some(number) = self.note(e, false) {
                    // It lies on the same curve.
                    self.known[number].followed[i] |= apart < 1e-3 * self.path.length;
                }
            }
            for state in ends {
                if let Some(e) = self.path.rest(state, &self.path.dead) {
                    self.note(e, false);
                }
            }
        }
    }

    /// Lets the machine go from beside an unstable equilibrium.
    fn push_off(&mut self, known: usize) {
        if self.known[known].found.stable {
            return;
        }
        let beside = self.path.pushed_off(&self.known[known].found.equilibrium);
        let ended: Vec<_> = beside
            .into_par_iter()
            .map(|e| self.path.descend(e))
            .collect();
        for e in ended.into_iter().flatten() {
            self.note(e, false);
        }
    }

    fn finish(self, settings: &SpreadSettings) -> MachineEquilibria {
        let mut found: Vec<MachineFound> = self.known.into_iter().map(|k| k.found).collect();
        for one in &mut found {
            one.equilibrium.found_by = FoundBy::OtherStart;
        }
        found.sort_by(|a, b| a.potential.total_cmp(&b.potential));
        let once = found.iter().filter(|f| f.hits <= 1).count();
        let (chance_of_more, chance_of_more_at_most) = chance_of_more(self.hits, once);
        MachineEquilibria {
            settled: self.fruitless >= settings.fruitless,
            found,
            starts: self.starts,
            hits: self.hits,
            outside: self.outside,
            fruitless: self.fruitless,
            chance_of_more,
            chance_of_more_at_most,
        }
    }
}

/// The k-th of evenly spread motions of some directions (balanced): Kronecker's sequence. Distances
/// are shares of the machine's size, angles of half a turn.
fn spread(free: &DMatrix<f64>, k: usize, path: &ToolConditions<'_, '_>) -> Vector6<f64> {
    let roots = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0_f64];
    let parts = DVector::from_fn(free.ncols(), |i, _| {
        2.0 * (k as f64 * roots[i % 6].sqrt()).fract() - 1.0
    });
    let motion = free * parts * AMPLITUDES[k / 2 % 4];
    let size = path.posture.mechanism.size();
    Vector6::from_fn(|i, _| motion[i] * if i < 3 { size } else { PI })
}

impl ToolConditions<'_, '_> {
    /// With verdict and energy.
    pub(crate) fn judged(&self, e: MechanismEquilibrium, dead: &Wrench) -> MachineFound {
        let k = self.balanced_stiffness(&e);
        let possible = self.possible(&e, &self.free);
        let possible = self.without(&e, &possible, DirectionKind::Free);
        let k = possible.transpose() * (&k + k.transpose()) * &possible * 0.5;
        let singular = !k.is_empty() && {
            let values = k.symmetric_eigenvalues();
            let most = values.amax();
            values.iter().any(|v| v.abs() < 1e-7 * most)
        };
        let holding = self.holds(&e, &self.free);
        let springs: f64 = e.limbs.iter().map(|l| l.energy).sum();
        let motion = self.motion(&e.tool);
        MachineFound {
            stable: e.shapes_stable() && e.others_hold && holding.stays,
            may_flutter: holding.may_flutter(),
            singular,
            potential: e.energy.unwrap_or(springs) - dead.0.dot(&motion),
            hits: 0,
            equilibrium: e,
        }
    }
}
