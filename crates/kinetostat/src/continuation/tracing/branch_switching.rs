//! The curve through a state with all branches that cross it, as far as they are wanted.

use std::sync::Arc;

use nalgebra::DVector;

use crate::continuation::curve::{Branch, BranchEnd, CurveEquilibrium, SpecialKind, Stop, join};
use crate::continuation::linear::family::Family;
use crate::continuation::tracing::describe::{describe, tangent};
use crate::continuation::tracing::system::{
    BranchOf, CurveSystem, HalfBranch, Point, Row, SpecialPoint, off_segment, wrapped,
};
use crate::continuation::tracing::tracer::Tracer;
use crate::error::Result;

/// Branches that were followed.
pub(crate) struct Traced<E: CurveEquilibrium> {
    pub branches: Vec<Branch<E>>,
    /// Some that cross were left out because there were too many.
    pub more: bool,
}

impl<E: CurveEquilibrium> Default for Traced<E> {
    fn default() -> Self {
        Self {
            branches: Vec::new(),
            more: false,
        }
    }
}

/// No first step away from a bifurcation converged.
struct NotFollowed;

/// Family of a branch close to the special point from which it starts.
fn beside_origin<S: CurveSystem>(
    branch: &BranchOf<S>,
    special: &SpecialPoint<S>,
) -> Option<Arc<Family>> {
    let apart = |p: &Point<S>| (&p.z - &special.point.z).norm();
    let beside = branch.points.iter().filter(|p| apart(p) > 0.0);
    beside
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
        .and_then(|p| p.family.clone())
}

impl<S: CurveSystem> Tracer<'_, S> {
    /// Follows the curve through a state in both directions, and the branches that cross it; false if the state lies on
    /// a branch that is known.
    pub fn grow(
        &mut self,
        z: &DVector<f64>,
        traced: &mut Traced<S::Equilibrium>,
        stop: Stop<'_, S::Equilibrium>,
    ) -> Result<bool> {
        let first = self.first_point(z)?;
        let branches = &mut traced.branches;
        if self.is_known(&first, branches) {
            return Ok(false);
        }
        let own = branches.len();
        let allowed = own + self.settings.branches.max(1);
        let mut next = self.specials.len();
        branches.push(self.both_directions(&first, own, stop));
        while next < self.specials.len() && stop.is_none() {
            self.branches_through(next, traced, allowed);
            next += 1;
        }
        Ok(true)
    }

    /// True if a point lies on one of the branches.
    fn is_known(&self, p: &Point<S>, branches: &[BranchOf<S>]) -> bool {
        let turns = self.system.full_turns();
        branches.iter().flat_map(|b| b.points.windows(2)).any(|w| {
            let step = (&w[1].z - &w[0].z).norm();
            off_segment(&p.z, &w[0].z, &w[1].z, &turns) < 0.02 * step
                && !(self.system).condensed_apart(
                    &p.equilibrium,
                    &w[0].equilibrium,
                    &w[1].equilibrium,
                )
        })
    }

    /// The curve through an ordinary point.
    fn both_directions(
        &mut self,
        first: &Point<S>,
        branch: usize,
        stop: Stop<'_, S::Equilibrium>,
    ) -> BranchOf<S> {
        let mut halves = Vec::new();
        for sign in [-1.0, 1.0] {
            // A search goes in one direction only: towards larger parameters.
            if sign < 0.0 && stop.is_some() {
                halves.push((vec![first.clone()], BranchEnd::Found));
                continue;
            }
            let mut point = first.clone();
            point.tangent *= sign;
            halves.push(self.run(point, true, branch, stop));
            if halves.first().is_some_and(|h| h.1 == BranchEnd::Closed) {
                halves.push((vec![first.clone()], BranchEnd::Closed));
                break;
            }
        }
        join(halves, None)
    }

    /// Follows the other branches through a special point, as long as fewer than `allowed` are known.
    fn branches_through(
        &mut self,
        index: usize,
        traced: &mut Traced<S::Equilibrium>,
        allowed: usize,
    ) {
        let branches = &mut traced.branches;
        let special = self.specials[index].clone();
        if special.kind == SpecialKind::StabilityChange {
            self.condensed_through(&special, index, traced, allowed);
            return;
        }
        let mut followed: Vec<(DVector<f64>, Arc<Family>)> = Vec::new();
        for direction in &special.directions {
            // One branch of a family stands for all.
            if followed.iter().any(|(d, f)| f.joins(d, direction)) {
                continue;
            }
            if branches.len() >= allowed {
                traced.more |= self.settings.branches > 1;
                break;
            }
            let mut halves = Vec::new();
            for sign in [-1.0, 1.0] {
                let half = self.switch(&special, &(direction * sign), branches, branches.len());
                let half = half.unwrap_or_else(|NotFollowed| {
                    self.specials[index].lost_branch = true;
                    None
                });
                let closed = half.as_ref().is_some_and(|h| h.1 == BranchEnd::Closed);
                halves.push(half);
                if closed {
                    halves.push(None);
                    break;
                }
            }
            if halves.iter().all(Option::is_none) {
                continue;
            }
            let middle = special.point.clone();
            let whole = halves
                .into_iter()
                .map(|h| h.unwrap_or((vec![middle.clone()], BranchEnd::Closed)))
                .collect();
            let branch = join(whole, Some(index));
            if let Some(family) = beside_origin::<S>(&branch, &special) {
                followed.push((direction.clone(), family));
            }
            self.specials[index].branches.push(branches.len());
            branches.push(branch);
        }
    }

    /// Follows the branches that leave where something condensed loses its stability.
    fn condensed_through(
        &mut self,
        special: &SpecialPoint<S>,
        index: usize,
        traced: &mut Traced<S::Equilibrium>,
        allowed: usize,
    ) {
        for arms in self.system.condensed_arms(&special.point) {
            let branch = traced.branches.len();
            let mut halves = Vec::new();
            for (z, equilibrium) in arms.into_iter().flatten() {
                self.system.set_family(None);
                self.system.start_from(&equilibrium);
                let Ok(mut second) = self.first_point(&z) else {
                    self.specials[index].lost_branch = true;
                    continue;
                };
                if self.is_known(&second, &traced.branches) {
                    continue;
                }
                if branch >= allowed {
                    traced.more |= self.settings.branches > 1;
                    return;
                }
                if second.tangent.dot(&(&second.z - &special.point.z)) < 0.0 {
                    second.tangent *= -1.0;
                }
                halves.push(self.run_from(special.point.clone(), second, branch));
            }
            if halves.is_empty() {
                continue;
            }
            if halves.len() == 1 {
                halves.push((vec![special.point.clone()], BranchEnd::Closed));
            }
            self.specials[index].branches.push(branch);
            traced.branches.push(join(halves, Some(index)));
        }
    }

    /// First point of another branch at a bifurcation, and the path from there; `None` where it is known already.
    fn switch(
        &mut self,
        special: &SpecialPoint<S>,
        direction: &DVector<f64>,
        branches: &[BranchOf<S>],
        branch: usize,
    ) -> std::result::Result<Option<HalfBranch<S>>, NotFollowed> {
        let mut middle = special.point.clone();
        middle.tangent.clone_from(direction);
        let usual = 0.3 * self.longest(direction);
        for h in [usual, 0.2 * usual, 0.04 * usual, 3.0 * usual] {
            self.system.resume(&special.point);
            let straight = &middle.z + direction * h;
            let offset = direction.dot(&straight);
            let predicted = self.system.followed(&middle.z, straight);
            let Some(c) = self
                .system
                .correct(&predicted, &Row::Plane(direction, offset), 10)
            else {
                continue;
            };
            if (&c.z - &predicted).norm() > 0.4 * h {
                continue;
            }
            let family = self.family_at(&c, direction);
            self.system.set_family(family);
            let Some(next) = tangent(&self.system, &c.matrix, direction) else {
                continue;
            };
            let turns = self.system.full_turns();
            let covered = branches.iter().any(|b| {
                b.points
                    .windows(2)
                    .any(|w| off_segment(&c.z, &w[0].z, &w[1].z, &turns) < 0.15 * h)
            });
            if covered {
                return Ok(None);
            }
            let second = describe(&mut self.system, &c, next.direction.clone());
            if self.beyond(&middle, &second).is_some() {
                return Ok(Some((vec![middle], BranchEnd::Range)));
            }
            return Ok(Some(self.run_from(middle, second, branch)));
        }
        Err(NotFollowed)
    }

    fn run_from(&mut self, middle: Point<S>, second: Point<S>, branch: usize) -> HalfBranch<S> {
        let origin = middle.z.clone();
        let (rest, mut end) = self.run_watching(second, branch, &origin);
        let mut points = vec![middle.clone()];
        points.extend(rest);
        if end == BranchEnd::Closed {
            // The last step went past the origin.
            points.pop();
            let mut last = middle;
            if let Some(before) = points.last() {
                last.tangent.clone_from(&before.tangent);
            }
            points.push(last);
        } else if points.len() < 2 {
            end = BranchEnd::Lost;
        }
        (points, end)
    }

    /// Traces like [`Self::run`] from an ordinary point; ends as closed where the path returns to `origin`.
    fn run_watching(
        &mut self,
        second: Point<S>,
        branch: usize,
        origin: &DVector<f64>,
    ) -> HalfBranch<S> {
        let home = origin.clone();
        let turns = self.system.full_turns();
        let first = second.z.clone();
        let came = std::cell::Cell::new(0_usize);
        let previous = std::cell::RefCell::new(first.clone());
        let returns = |p: &Point<S>| {
            came.set(came.get() + 1);
            let last = previous.replace(p.z.clone());
            let span = wrapped(&p.z, &last, &turns).norm();
            came.get() > 5 && off_segment(&home, &last, &p.z, &turns) < 0.05 * span
        };
        let (points, end) = self.run(second, true, branch, Some(&returns));
        let end = if end == BranchEnd::Found {
            BranchEnd::Closed
        } else {
            end
        };
        (points, end)
    }
}
