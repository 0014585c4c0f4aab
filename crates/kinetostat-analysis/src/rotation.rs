//! The rotation of the tool, continuous along every branch of a curve: a rotation vector by itself
//! ends at half a turn, where it jumps to the other side.

use std::f64::consts::TAU;

use kinetostat::{
    Pose,
    continuation::{Branch, CurveEquilibrium, CurvePoint, Special},
};
use nalgebra::{UnitQuaternion, Vector3};

/// Continuous rotation vectors of the tool from where the curve starts, base axes, rad.
#[derive(Clone, Debug)]
pub struct ContinuousRotation {
    start: UnitQuaternion<f64>,
    /// Rotation vectors of every point of every branch; empty where no rotation is shown.
    branches: Vec<Vec<Vector3<f64>>>,
}

impl ContinuousRotation {
    /// No rotation: every result is zero.
    #[must_use]
    pub fn none() -> Self {
        Self {
            start: UnitQuaternion::identity(),
            branches: Vec::new(),
        }
    }

    /// Computes the rotation of all branches, the first of which starts the curve.
    #[must_use]
    pub fn of<E: CurveEquilibrium>(branches: &[Branch<E>], specials: &[Special<E>]) -> Self {
        let Some(start) = branches.first().and_then(|own| own.points.get(own.start)) else {
            return Self::none();
        };
        let place: &Pose = start.equilibrium.tool();
        let mut turns = Self {
            start: place.rotation,
            branches: Vec::new(),
        };
        for branch in branches {
            let points = &branch.points;
            // Point with a known number of turns: where the branch leaves another one, or nearest to the start.
            let crossing = branch.origin.and_then(|s| specials.get(s));
            let (anchor, known) = match crossing {
                Some(s) => (branch.start, turns.whole(branches, &s.point)),
                None => (
                    nearest(points, |p| {
                        (p.parameter - start.parameter).abs() + turns.within(p).norm()
                    }),
                    Vector3::zeros(),
                ),
            };
            let mut list = vec![Vector3::zeros(); points.len()];
            if let Some(first) = points.get(anchor) {
                list[anchor] = continued(turns.within(first), &known);
            }
            for i in anchor + 1..points.len() {
                list[i] = continued(turns.within(&points[i]), &list[i - 1]);
            }
            for i in (0..anchor).rev() {
                list[i] = continued(turns.within(&points[i]), &list[i + 1]);
            }
            turns.branches.push(list);
        }
        turns
    }

    /// Rotation vector within half a turn.
    fn within<E: CurveEquilibrium>(&self, p: &CurvePoint<E>) -> Vector3<f64> {
        (p.equilibrium.tool().rotation * self.start.inverse()).scaled_axis()
    }

    /// The continuous rotation vector of any equilibrium, as at the nearest point of a branch.
    fn whole<E: CurveEquilibrium>(
        &self,
        branches: &[Branch<E>],
        p: &CurvePoint<E>,
    ) -> Vector3<f64> {
        let here = self.within(p);
        let mut best = (f64::INFINITY, here);
        for (branch, list) in branches.iter().zip(&self.branches) {
            for (other, turn) in branch.points.iter().zip(list) {
                let d = other.apart(p);
                if d < best.0 {
                    best = (d, *turn);
                }
            }
        }
        continued(here, &best.1)
    }

    /// Whole turns of point `i` of branch `k`: its continuous rotation vector minus the one within half a turn; zero
    /// where no rotation is shown.
    #[must_use]
    pub fn of_point<E: CurveEquilibrium>(
        &self,
        branches: &[Branch<E>],
        k: usize,
        i: usize,
    ) -> Vector3<f64> {
        let whole = self.branches.get(k).and_then(|list| list.get(i));
        let point = branches.get(k).and_then(|b| b.points.get(i));
        match (whole, point) {
            (Some(whole), Some(point)) => whole - self.within(point),
            _ => Vector3::zeros(),
        }
    }

    /// Whole turns of any equilibrium.
    #[must_use]
    pub fn at<E: CurveEquilibrium>(
        &self,
        branches: &[Branch<E>],
        p: &CurvePoint<E>,
    ) -> Vector3<f64> {
        if self.branches.is_empty() {
            return Vector3::zeros();
        }
        self.whole(branches, p) - self.within(p)
    }
}

/// The rotation of `within` half a turn, by as many whole turns more as bring it next to `before`.
#[doc(hidden)]
#[must_use]
pub fn continued(within: Vector3<f64>, before: &Vector3<f64>) -> Vector3<f64> {
    // After whole turns the axis is lost in rounding: it is the last one.
    let axis = if within.norm() > 1e-5 {
        within.normalize()
    } else if before.norm() > 1e-5 {
        before.normalize()
    } else {
        return within;
    };
    within + axis * (TAU * ((before - within).dot(&axis) / TAU).round())
}

fn nearest<E: CurveEquilibrium>(
    points: &[CurvePoint<E>],
    off: impl Fn(&CurvePoint<E>) -> f64,
) -> usize {
    let off = points.iter().map(off).enumerate();
    off.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |b| b.0)
}
