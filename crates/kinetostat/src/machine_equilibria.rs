//! Equilibria of a machine from many starts: places of its tool and joints spread evenly, those
//! beyond a singular posture first.

use nalgebra::{DMatrix, DVector, Vector6};

use crate::chain::{MotionKind, Role};
use crate::equilibrium::EndCondition;
use crate::error::Result;
use crate::platform::MechanismState;
use crate::platform_path::Path;
use crate::posture::{MechanismEquilibrium, Posture};
use crate::spatial::{Twist, moved, pose_residual};

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
    /// Starts that ended there.
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
    /// Those that ended farther than three natural lengths from the nominal target.
    pub outside: usize,
    /// Starts since the last new equilibrium.
    pub fruitless: usize,
    /// Share of the successful starts whose equilibrium was found just once (Good and Turing).
    pub chance_of_more: f64,
    /// Upper end of that chance (95 %).
    pub chance_of_more_at_most: f64,
    /// The search ended because nothing new came.
    pub settled: bool,
}

/// How far tools are put from the target, as shares of the natural length.
const AMPLITUDES: [f64; 4] = [0.05, 0.2, 0.5, 1.0];

impl Posture<'_> {
    /// Equilibria of the machine as it is commanded: the tool held at `end.pose` in the directions
    /// whose pose is prescribed, under the dead wrench `end.wrench` in the others.
    ///
    /// # Errors
    /// Not-a-numbers in the condition. That nothing was found is a result.
    pub fn equilibria(
        &self,
        end: &EndCondition,
        settings: &SpreadSettings,
    ) -> Result<MachineEquilibria> {
        let path = Path::held_at(self, end)?;
        let mut all = MachineEquilibria {
            found: Vec::new(),
            starts: 0,
            hits: 0,
            outside: 0,
            fruitless: 0,
            chance_of_more: 1.0,
            chance_of_more_at_most: 1.0,
            settled: false,
        };
        // Mirrored at the singular postures nearby, and at rest.
        let mut first = vec![Twist::zero()];
        let near = self.motion_gained(path.length);
        first.extend(near.map(|n| Twist(n.way.0 * (2.0 * n.distance_m))));
        let free = path.free_motions();
        while all.starts < settings.starts && all.fruitless < settings.fruitless {
            let k = all.starts;
            all.starts += 1;
            all.fruitless += 1;
            let way = match first.get(k) {
                Some(way) => path.freely(&way.0),
                None => spread(&free, k, path.length),
            };
            let Some(e) = self.fallen(&path, end, &way, k) else {
                continue;
            };
            let off = pose_residual(&e.tool, &self.target).0;
            let size = path.balanced(&off).norm();
            if size > 3.0 * path.length {
                all.outside += 1;
                continue;
            }
            all.hits += 1;
            match all.found.iter_mut().find(|f| path.same(&f.equilibrium, &e)) {
                Some(known) => known.hits += 1,
                None => {
                    all.fruitless = 0;
                    all.found.push(path.judged(e, &end.wrench));
                }
            }
        }
        all.settled = all.fruitless >= settings.fruitless;
        all.found
            .sort_by(|a, b| a.potential.total_cmp(&b.potential));
        let once = all.found.iter().filter(|f| f.hits == 1).count() as f64;
        if all.hits > 0 {
            let n = all.hits as f64;
            all.chance_of_more = once / n;
            // Rule of three where none was found just once.
            let room = if once == 0.0 {
                3.0
            } else {
                once + 1.96 * once.sqrt() + 2.0
            };
            all.chance_of_more_at_most = (room / n).min(1.0);
        }
        Ok(all)
    }

    /// From the tool put aside by a motion (and, in every second start, joints turned) to where it
    /// comes to rest.
    fn fallen(
        &self,
        path: &Path<'_, '_>,
        end: &EndCondition,
        way: &Vector6<f64>,
        k: usize,
    ) -> Option<MechanismEquilibrium> {
        let tool = self.mechanism.tool;
        let mut pose = moved(&self.target, &Twist(path.held_motion()));
        pose = moved(&pose, &Twist(*way));
        let mut state: MechanismState = self.rest_state();
        if k.is_multiple_of(2) && way.norm() > 0.0 {
            state = self.wrench_at(&pose).ok()?.state;
        } else if k > 0 {
            for (limb, joints) in self.mechanism.limbs.iter().zip(&mut state.coordinates) {
                for (i, c) in limb.actual.coordinates().iter().enumerate() {
                    if c.role == Role::Passive && c.kind == MotionKind::Revolute {
                        let share = ((k * 7 + i) as f64 * 0.618_034).fract() - 0.5;
                        joints[i] += 2.0 * AMPLITUDES[k / 2 % 4] * share;
                    }
                }
            }
        }
        state.platforms[tool] = pose;
        path.rest(state, &end.wrench)
    }
}

/// The k-th of evenly spread motions of some directions (balanced): Kronecker's sequence.
fn spread(free: &DMatrix<f64>, k: usize, length: f64) -> Vector6<f64> {
    let roots = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0_f64];
    let parts = DVector::from_fn(free.ncols(), |i, _| {
        2.0 * (k as f64 * roots[i % 6].sqrt()).fract() - 1.0
    });
    let motion = free * parts * (AMPLITUDES[k / 2 % 4] * length);
    Vector6::from_fn(|i, _| motion[i] / if i < 3 { 1.0 } else { length })
}
