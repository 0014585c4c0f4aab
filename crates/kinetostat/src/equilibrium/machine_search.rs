//! The search of a machine's equilibria: places of its tool and joints spread evenly, those beyond a singular posture
//! first; curves along every free motion of the tool; down the potential from beside unstable shapes.

use std::f64::consts::{PI, TAU};

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::directions::DirectionKind;
use crate::continuation::machine::tool_conditions::ToolConditions;
use crate::continuation::settings::CurveSettings;
use crate::equilibrium::all_of_chain::SearchSettings;
use crate::equilibrium::chain_starts::Bounds;
use crate::equilibrium::found::Equilibria;
use crate::equilibrium::limb_shapes::{
    are_searched_one_by_one, combinations, is_inside_out, limb_shapes, state_of,
};
use crate::equilibrium::search::{Entry, SearchOutcome, Searched};
use crate::machine::equilibrium::{MechanismEquilibrium, conclude};
use crate::machine::platforms::parts::Unknowns;
use crate::machine::state::MechanismState;
use crate::model::chain::Role;
use crate::model::kinematics::unloaded_tip;
use crate::parallel;
use crate::spatial::{MotionKind, Pose, Twist, moved, pose_residual};

/// Displacements of the tool from the target, as shares of the machine's size.
const AMPLITUDES: [f64; 4] = [0.05, 0.2, 0.5, 1.0];

/// Starts that are made side by side.
const TOGETHER: usize = 16;

/// Curves are followed through so many equilibria at most.
const FOLLOWED: usize = 24;

/// Length of the curves from the target, in sizes of the machine.
const FOLLOWED_SIZES: f64 = 2.0;

/// Starts in a row without a new shape after which the search at one place ends, see [`limb_shapes`].
const SHAPE_STARTS: usize = 100;

/// A limb that so many starts bring to no shape at a place, whichever, does not reach it: most places that a tool with few
/// freedoms is displaced to are such.
const PROBES: usize = 20;

/// Combinations of the limbs' shapes that are tried at one place of the tool, those of least energy.
const COMBINATIONS: usize = 100;

/// Places of a free tool at which the limbs' shapes are starts.
const PLACES: usize = 24;

/// Start of an iteration.
pub(crate) enum Start {
    /// Number in the sequence of spread places.
    Spread(usize),
    /// Every limb in one of the shapes that it has with the tool held.
    Shapes(Box<MechanismState>),
}

/// An equilibrium that is known.
pub(crate) struct Known {
    pub equilibrium: MechanismEquilibrium,
    /// True if it is stable under the conditions as prescribed.
    pub stable: bool,
    pub may_flutter: bool,
    /// True at a limit: a motion of the tool that needs no force and is free.
    pub singular: bool,
    /// Energy of springs and loads less the work of the dead wrench, J; `None` where a load has no potential.
    pub potential: Option<f64>,
    /// Free motions along which the curve through it was followed.
    followed: Vec<bool>,
}

/// An equilibrium, and the free motion along whose curve it lies, if it is known.
pub(crate) struct Candidate {
    equilibrium: MechanismEquilibrium,
    on_curve: Option<usize>,
}

impl Candidate {
    fn of(equilibrium: Option<MechanismEquilibrium>) -> SearchOutcome<Self> {
        equilibrium.map_or(SearchOutcome::Nothing, |equilibrium| {
            SearchOutcome::Equilibrium(Self {
                equilibrium,
                on_curve: None,
            })
        })
    }
}

/// Search for the equilibria of a machine.
pub(crate) struct MachineSearch<'p> {
    conditions: ToolConditions<'p>,
    bounds: Vec<Bounds>,
    /// The first starts: mirrored at the singular postures nearby, and at rest.
    first: Vec<Twist>,
    /// Free motions of the tool that the machine can make.
    free: DMatrix<f64>,
    /// The machine held where it is commanded.
    rest: Option<MechanismEquilibrium>,
}

impl<'p> MachineSearch<'p> {
    pub fn new(conditions: ToolConditions<'p>) -> Self {
        let posture = conditions.posture;
        let mut first = vec![Twist::zero()];
        let near = posture.motion_gained(conditions.length);
        first.extend(near.map(|n| Twist(n.towards.0 * (2.0 * n.distance_m))));
        let limbs = posture.mechanism.limbs().iter();
        let commanded = moved(
            &posture.target,
            &Twist(conditions.prescribed_displacement()),
        );
        Self {
            first,
            free: conditions.free_motions(),
            bounds: limbs.map(|l| Bounds::of(&l.actual)).collect(),
            rest: posture.wrench_at(&commanded).ok(),
            conditions,
        }
    }

    /// Equilibrium after a release at a spread start: from the tool displaced by a motion, in every second start with
    /// joints turned.
    fn let_go(&self, k: usize) -> Option<MechanismEquilibrium> {
        let path = &self.conditions;
        let posture = path.posture;
        let (mechanism, tool) = (&posture.mechanism, posture.mechanism.tool());
        let motion = match self.first.get(k) {
            Some(motion) => path.freely(&motion.0),
            None => spread(&self.free, k, path),
        };
        let mut pose = moved(&posture.target, &Twist(path.prescribed_displacement()));
        pose = moved(&pose, &Twist(motion));
        let mut state: MechanismState = posture.rest_state();
        if k.is_multiple_of(2) && motion.norm() > 0.0 {
            let held = match posture.wrench_at(&pose) {
                Ok(held) => held,
                // Motions of the tool may be bound to each other.
                Err(_) => path.displaced_to_end(self.rest.clone()?, &motion)?,
            };
            let there = held.state.clone();
            return path.descend(held).or_else(|| path.rest(there, &path.dead));
        }
        if k > 0 {
            for (limb, joints) in mechanism.limbs().iter().zip(&mut state.coordinates) {
                for (i, c) in limb.actual.coordinates().iter().enumerate() {
                    if c.role == Role::Passive && c.kind == MotionKind::Revolute {
                        let share = ((k * 7 + i) as f64 * 0.618_034).fract() - 0.5;
                        joints[i] += TAU * AMPLITUDES[k / 2 % 4] * share;
                    }
                }
            }
        }
        let carriers = mechanism.limbs().iter().enumerate();
        let carriers = carriers.filter(|(_, l)| l.from == 0 && l.to == tool);
        let carriers: Vec<_> = carriers.collect();
        if k % 4 == 3
            && let Some((i, limb)) = carriers.get(k / 4 % carriers.len().max(1))
        {
            // Holds the tool where its turned joints bring it: loops close there differently.
            let (joints, commands) = (&state.coordinates[*i], &posture.limbs[*i].commands);
            let tip = unloaded_tip(&limb.actual, &Pose::identity(), joints, commands);
            state.platforms[tool] = tip * limb.platform_from_tip.inverse();
            let mut solver = posture.solver(state, Unknowns::Displacement);
            let (iterations, norms) = solver.solve(1.0, 0).ok()?;
            let held = conclude(&mut solver, norms.residual(iterations)).ok()?;
            return path.descend(held);
        }
        state.platforms[tool] = pose;
        path.rest(state, &path.dead)
    }

    /// Every combination of the limbs' own shapes with the tool held at a place, if limbs are short.
    fn shapes_at(&self, place: &Pose) -> Vec<Start> {
        let posture = self.conditions.posture;
        if !are_searched_one_by_one(posture) {
            return Vec::new();
        }
        let few = SearchSettings::default().with_fruitless(SHAPE_STARTS);
        let probe = few.with_starts(PROBES).with_most(1);
        let reached = |limb: &Equilibria| limb.outside > 0 || !limb.found.is_empty();
        let probed = limb_shapes(posture, place, &probe).ok();
        let probed = probed.filter(|limbs| limbs.iter().all(reached));
        let Some(shapes) = probed.and_then(|_| limb_shapes(posture, place, &few).ok()) else {
            return Vec::new();
        };
        let list = combinations(&shapes).into_iter().take(COMBINATIONS);
        let states = list.map(|c| state_of(posture, place, &shapes, &c));
        states.map(|state| Start::Shapes(Box::new(state))).collect()
    }

    /// Shapes with a drive whose slide is turned inside out do not count, nor do unstable ones far away.
    fn counts(&self, found: &Known) -> bool {
        let posture = self.conditions.posture;
        let (mechanism, e) = (&posture.mechanism, &found.equilibrium);
        let joints = mechanism.limbs().iter().zip(&e.state.coordinates);
        let mut drives = joints.clone().zip(&posture.limbs);
        let inside_out = drives.any(|((limb, x), own)| {
            is_inside_out(&limb.actual, &own.commands, x, mechanism.size())
        });
        let off = pose_residual(&e.tool, &posture.target).linear();
        let near = || {
            off.norm() <= 3.0 * mechanism.size()
                && joints
                    .clone()
                    .zip(&self.bounds)
                    .all(|((limb, x), bounds)| bounds.hold_springs(&limb.actual, x))
        };
        !inside_out && (found.stable || near())
    }

    /// Drives the tool along each of its free motions that was not followed yet, in both directions, from an equilibrium or
    /// (`None`) from the commanded place.
    fn driven(&self, known: Option<&Known>) -> Vec<SearchOutcome<Candidate>> {
        let path = &self.conditions;
        let from = known.map(|k| &k.equilibrium);
        let reach = FOLLOWED_SIZES * path.posture.mechanism.size();
        let mut settings = CurveSettings::within(-reach, reach);
        settings.points = 60;
        settings.largest_change = Some(0.05 * reach);
        let open = |i: &usize| known.is_none_or(|k| !k.followed[*i]);
        let motions: Vec<usize> = (0..path.free.ncols()).filter(open).collect();
        let curve = |i: usize| {
            let motion = Vector6::from_fn(|row, _| path.free[(row, i)]);
            path.driven(&motion, settings.clone()).unloaded(from)
        };
        let curves = parallel::map(motions.clone(), curve);
        let mut list = Vec::new();
        for (i, [crossings, ends]) in motions.into_iter().zip(curves) {
            for state in crossings {
                let there = state.platforms[path.posture.mechanism.tool()];
                let Some(equilibrium) = path.rest(state, &path.dead) else {
                    continue;
                };
                let apart = path.scaled(&pose_residual(&equilibrium.tool, &there).0);
                list.push(SearchOutcome::Equilibrium(Candidate {
                    on_curve: (apart.norm() < 1e-3 * path.length).then_some(i),
                    equilibrium,
                }));
            }
            let ends = ends.into_iter().map(|state| path.rest(state, &path.dead));
            list.extend(ends.map(Candidate::of));
        }
        list
    }

    /// Lets the machine go from beside an unstable equilibrium.
    fn let_go_beside(&self, known: &Known) -> Vec<SearchOutcome<Candidate>> {
        if known.stable {
            return Vec::new();
        }
        let beside = self.conditions.pushed_off(&known.equilibrium);
        let ended = parallel::map(beside, |e| self.conditions.descend(e));
        ended.into_iter().map(Candidate::of).collect()
    }
}

impl Searched for MachineSearch<'_> {
    type Start = Start;
    type Candidate = Candidate;
    type Known = Known;

    /// The limbs' shapes at the commanded place and at some around it.
    fn structured(&mut self) -> Vec<Start> {
        let path = &self.conditions;
        let there = Twist(path.prescribed_displacement());
        let there = moved(&path.posture.target, &there);
        let motions = (1..PLACES).map(|k| Twist(spread(&self.free, k, path)));
        let places = motions.map(|motion| moved(&there, &motion)).chain([there]);
        places.flat_map(|place| self.shapes_at(&place)).collect()
    }

    /// Other shapes of the limbs at its place, from which the tool moves on. It is let go beside, too, see
    /// [`Self::connected`].
    fn suggested(&mut self, known: &Known) -> Vec<Start> {
        self.shapes_at(&known.equilibrium.tool)
    }

    fn spread(&mut self, from: usize, count: usize) -> Vec<Start> {
        (from..from + count).map(Start::Spread).collect()
    }

    fn side_by_side(&self) -> usize {
        TOGETHER
    }

    fn patience(&self) -> usize {
        1
    }

    fn solve(&mut self, starts: &[Start]) -> Vec<SearchOutcome<Candidate>> {
        let ended = parallel::map(starts.iter().collect(), |start: &Start| match start {
            Start::Spread(k) => self.let_go(*k),
            Start::Shapes(state) => {
                (self.conditions).rest((**state).clone(), &self.conditions.dead)
            }
        });
        ended.into_iter().map(Candidate::of).collect()
    }

    /// Descents do not repel each other.
    fn deflated(&mut self, _start: &Start, _known: &[Entry<Known>]) -> SearchOutcome<Candidate> {
        SearchOutcome::Nothing
    }

    fn same(&self, known: &Known, candidate: &Candidate) -> bool {
        (self.conditions).same(&known.equilibrium, &candidate.equilibrium)
    }

    fn recognised(&self, known: &mut Known, candidate: &Candidate) {
        if let Some(i) = candidate.on_curve {
            known.followed[i] = true;
        }
    }

    fn described(&mut self, candidate: Candidate) -> Option<Known> {
        let mut known = self.conditions.described(candidate.equilibrium);
        if let Some(i) = candidate.on_curve {
            known.followed[i] = true;
        }
        self.counts(&known).then_some(known)
    }

    fn curves_first(&self) -> bool {
        true
    }

    fn most_curves(&self) -> usize {
        FOLLOWED
    }

    fn connected(&mut self, from: Option<&Known>) -> Vec<SearchOutcome<Candidate>> {
        let mut list = self.driven(from);
        list.extend(from.into_iter().flat_map(|known| self.let_go_beside(known)));
        list
    }
}

/// The k-th of evenly spread motions of some directions (scaled): Kronecker's sequence. Distances
/// are shares of the machine's size, angles of half a turn.
fn spread(free: &DMatrix<f64>, k: usize, path: &ToolConditions<'_>) -> Vector6<f64> {
    let roots = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0_f64];
    let parts = DVector::from_fn(free.ncols(), |i, _| {
        2.0 * (k as f64 * roots[i % 6].sqrt()).fract() - 1.0
    });
    let motion = free * parts * AMPLITUDES[k / 2 % 4];
    let size = path.posture.mechanism.size();
    Vector6::from_fn(|i, _| motion[i] * if i < 3 { size } else { PI })
}

impl ToolConditions<'_> {
    /// Adds stability and energy to an equilibrium.
    pub(crate) fn described(&self, e: MechanismEquilibrium) -> Known {
        let k = self.scaled_stiffness(&e);
        let possible = self.possible(&e, &self.free);
        let possible = self.without(&e, &possible, DirectionKind::Free);
        let k = possible.transpose() * (&k + k.transpose()) * &possible * 0.5;
        let singular = !k.is_empty() && {
            let values = k.symmetric_eigenvalues();
            let most = values.amax();
            values.iter().any(|v| v.abs() < 1e-7 * most)
        };
        let holding = self.holds(&e, &self.free);
        let motion = self.motion(&e.tool);
        Known {
            stable: e.shapes_stable() && e.others_hold && holding.stays,
            may_flutter: holding.may_flutter(),
            singular,
            potential: e.energy.map(|energy| energy - self.dead.0.dot(&motion)),
            followed: vec![false; self.free.ncols()],
            equilibrium: e,
        }
    }
}
