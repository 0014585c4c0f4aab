//! Input of postures and its storage: from lists to lanes and back.

use pulp::Simd;

use crate::batch::limb::reach::Target;
use crate::batch::numbers::lanes::Lanes;
use crate::batch::status::Status;
use crate::batch::table::{BLOCK, Columns, Table};
use crate::spatial::{Pose, Wrench};

/// Below this relative pivot a posture is left to the general engine: its rank has to be decided.
pub(crate) const REGULAR: f64 = 1e-9;

/// Commanded places.
#[derive(Clone, Copy)]
pub(crate) enum Places<'a> {
    Poses(&'a [Pose]),
    Joints {
        commands: &'a [f64],
        each: usize,
    },
    /// Poses with the joints that lead to them, and the equilibrium of a similar machine there under a load; along a path with those
    /// of the first pose of each run.
    Known {
        poses: &'a [Pose],
        joints: &'a Table,
        standing: Option<&'a Standing>,
        /// Deviations of the machine's numbers, in the order of [`Standing::slopes`].
        deviations: &'a [f64],
        /// Row of the first pose in both.
        first: usize,
    },
}

/// A loaded machine: 12 numbers of its tool as in [`crate::batch::BatchEquilibrium`], coordinates of all limbs, six numbers of
/// the wrench on the tip of each; not numbers where it is not known.
#[derive(Clone, Debug)]
pub(crate) struct Standing {
    pub tool: Table,
    pub coordinates: Table,
    pub wrenches: Table,
    /// Correctors of the passes of an equilibrium there ([`crate::batch::machine::kept`]).
    pub correctors: Table,
    /// Derivatives by numbers of the machine, per unit of each: six numbers of the tool's motion, coordinates,
    /// wrenches.
    pub slopes: Vec<Table>,
}

impl<'a> Places<'a> {
    pub fn len(&self) -> usize {
        match self {
            Self::Poses(poses) | Self::Known { poses, .. } => poses.len(),
            Self::Joints { commands, each } => commands.len() / each,
        }
    }

    /// A machine like the one at hand is known to stand at them under a load.
    pub fn have_a_start(&self) -> bool {
        matches!(self, Self::Known { standing, .. } if standing.is_some())
    }

    /// Drops the first ones, which are whole blocks.
    pub fn from(&self, first: usize) -> Self {
        match *self {
            Self::Poses(poses) => Self::Poses(&poses[first..]),
            Self::Joints { commands, each } => Self::Joints {
                commands: &commands[first * each..],
                each,
            },
            Self::Known {
                poses,
                joints,
                standing,
                deviations,
                first: before,
            } => Self::Known {
                poses: &poses[first..],
                joints,
                standing,
                deviations,
                first: before + first,
            },
        }
    }
}

/// Postures side by side in one register: `first`, `first + stride`, and so on.
pub(crate) struct Group {
    pub first: usize,
    pub stride: usize,
    pub count: usize,
}

impl Group {
    /// Neighbours in the list.
    pub fn of_neighbours(first: usize, count: usize) -> Self {
        Self {
            first,
            stride: 1,
            count,
        }
    }

    /// Posture in a lane; the last one fills up.
    #[inline(always)]
    fn item(&self, lane: usize) -> usize {
        (self.first + lane * self.stride).min(self.count - 1)
    }

    /// Lanes that have a posture of their own.
    #[inline(always)]
    fn filled(&self, lanes: usize) -> usize {
        (self.count - self.first).div_ceil(self.stride).min(lanes)
    }

    /// One number of every posture: `numbers(item)[k]`.
    #[inline(always)]
    fn gather<S: Simd, T, const N: usize>(
        &self,
        simd: S,
        items: &[T],
        numbers: impl Fn(&T) -> [f64; N],
    ) -> [Lanes<S>; N] {
        let mut values = [[0.0; BLOCK]; N];
        for lane in 0..S::F64_LANES {
            let own = numbers(&items[self.item(lane)]);
            for k in 0..N {
                values[k][lane] = own[k];
            }
        }
        let mut out = [Lanes::new(simd, 0.0); N];
        for k in 0..N {
            out[k] = Lanes::load(simd, &values[k]);
        }
        out
    }

    #[inline(always)]
    pub fn wrench<S: Simd>(&self, simd: S, wrenches: &[Wrench]) -> [Lanes<S>; 6] {
        self.gather(simd, wrenches, |w| w.0.into())
    }

    /// Numbers of these postures into their places of a table.
    #[inline(always)]
    pub fn put<S: Simd>(&self, table: &mut [f64], from: usize, numbers: &[Lanes<S>]) {
        let width = table.len() / self.count.div_ceil(BLOCK) / BLOCK;
        if self.stride > 1 {
            self.scatter(table, width, from, numbers);
            return;
        }
        let start = ((self.first / BLOCK) * width + from) * BLOCK;
        let block = &mut table[start..start + numbers.len() * BLOCK];
        let (places, _) = block.as_chunks_mut::<BLOCK>();
        let lane = self.first % BLOCK;
        for k in 0..numbers.len() {
            numbers[k].store(&mut places[k][lane..]);
        }
    }

    /// Stores the numbers of postures that are not consecutive.
    #[inline(always)]
    fn scatter<S: Simd>(&self, table: &mut [f64], width: usize, from: usize, numbers: &[Lanes<S>]) {
        if width == 0 {
            // A machine without springs has nothing in its table.
            return;
        }
        for lane in 0..self.filled(S::F64_LANES) {
            let item = self.item(lane);
            let start = ((item / BLOCK) * width + from) * BLOCK + item % BLOCK;
            let places = table[start..].iter_mut().step_by(BLOCK);
            for (place, number) in places.zip(numbers) {
                *place = number.lane(lane);
            }
        }
    }

    /// Marks the lanes whose least pivot or other measure of good is well above zero.
    #[inline(always)]
    pub fn conclude<S: Simd>(&self, good: Lanes<S>, status: &mut [Status]) {
        let mut values = [0.0; BLOCK];
        good.store(&mut values);
        for lane in 0..self.filled(S::F64_LANES) {
            if values[lane] > REGULAR {
                status[self.item(lane)] = Status::Vectorised;
            }
        }
    }

    #[inline(always)]
    pub fn target<S: Simd>(&self, simd: S, poses: &[Pose]) -> Target<S> {
        let [x, y, z, w] = self.gather(simd, poses, |p| p.rotation.coords.into());
        let point = self.gather(simd, poses, |p| p.translation.vector.into());
        let one = Lanes::new(simd, 1.0);
        let double = |a: Lanes<S>, b: Lanes<S>| a * b * 2.0;
        Target {
            rotation: [
                one - double(y, y) - double(z, z),
                double(x, y) - double(z, w),
                double(x, z) + double(y, w),
                double(x, y) + double(z, w),
                one - double(x, x) - double(z, z),
                double(y, z) - double(x, w),
                double(x, z) - double(y, w),
                double(y, z) + double(x, w),
                one - double(x, x) - double(y, y),
            ],
            point,
        }
    }

    /// Numbers of these postures from their places of a table, those after the first `from` of `width`.
    #[inline(always)]
    pub fn numbers<S: Simd>(&self, simd: S, table: Columns<'_>, from: usize, to: &mut [Lanes<S>]) {
        if self.stride == 1 && self.first + S::F64_LANES <= self.count {
            // Consecutive postures lie side by side.
            let start = ((self.first / BLOCK) * table.width + from) * BLOCK;
            let (places, _) = table.numbers[start..start + to.len() * BLOCK].as_chunks::<BLOCK>();
            for (x, place) in to.iter_mut().zip(places) {
                *x = Lanes::load(simd, &place[self.first % BLOCK..]);
            }
            return;
        }
        for (k, x) in to.iter_mut().enumerate() {
            let mut values = [0.0; BLOCK];
            for lane in 0..S::F64_LANES {
                let item = self.item(lane);
                let block = (item / BLOCK) * table.width + from + k;
                values[lane] = table.numbers[block * BLOCK + item % BLOCK];
            }
            *x = Lanes::load(simd, &values);
        }
    }

    #[inline(always)]
    pub fn commands<S: Simd>(&self, simd: S, from: &[f64], each: usize, to: &mut [Lanes<S>]) {
        for (k, x) in to.iter_mut().enumerate() {
            let mut values = [0.0; BLOCK];
            for lane in 0..S::F64_LANES {
                values[lane] = from[self.item(lane) * each + k];
            }
            *x = Lanes::load(simd, &values);
        }
    }
}
