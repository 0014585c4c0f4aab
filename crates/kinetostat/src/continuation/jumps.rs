//! Equilibria on the branches of a curve at one load or one displacement, and where the chain jumps
//! from its limit points.

use crate::continuation::bifurcation::SpecialKind;
use crate::continuation::branches::{CurvePoint, Curves};
use crate::continuation::reduced::{Reduced, Row};
use crate::continuation::state_distance::{distance, wrapped, wraps};
use crate::continuation::tracer::Tracer;
use crate::error::Result;

impl Curves<'_> {
    /// Equilibria at one value of the parameter, on all branches.
    ///
    /// # Errors
    /// None in practice: the problem was accepted when the curve was followed.
    pub fn at(&self, value: f64) -> Result<Vec<CurvePoint>> {
        self.crossings(value, true)
    }

    /// Equilibria at one value of the conjugate (force along the displacement, or displacement
    /// along the load pattern), on all branches.
    ///
    /// # Errors
    /// None in practice: the problem was accepted when the curve was followed.
    pub fn at_conjugate(&self, value: f64) -> Result<Vec<CurvePoint>> {
        self.crossings(value, false)
    }

    fn crossings(&self, value: f64, parameter: bool) -> Result<Vec<CurvePoint>> {
        let mut reduced =
            Reduced::new(&self.problem, Some(&self.parameter), &self.settings.solver)?.by_sweeps();
        reduced.start(&self.start.0, &self.start.1, self.start.2)?;
        let mut tracer = Tracer {
            reduced,
            settings: &self.settings,
            specials: Vec::new(),
        };
        let chain = self.problem.chain;
        let mut found: Vec<CurvePoint> = Vec::new();
        for pair in self.branches.iter().flat_map(|b| b.points.windows(2)) {
            let of = |p: &CurvePoint| (if parameter { p.parameter } else { p.conjugate }) - value;
            let (a, b) = (of(&pair[0]), of(&pair[1]));
            let slack = 1e-12 * (1.0 + value.abs());
            if a * b > 0.0 && a.abs() > slack && b.abs() > slack || a == b {
                continue;
            }
            let guess = &pair[0].z + (&pair[1].z - &pair[0].z) * (a / (a - b)).clamp(0.0, 1.0);
            let row = if parameter {
                Row::Parameter(value)
            } else {
                Row::Conjugate(value)
            };
            tracer.reduced.family = pair[0].family.clone().or_else(|| pair[1].family.clone());
            let Some(c) = tracer.reduced.correct(&guess, &row, 12) else {
                continue;
            };
            let far = (&c.z - &guess).norm() > (&pair[1].z - &pair[0].z).norm();
            let known = found
                .iter()
                .any(|p| distance(chain, &tracer.reduced, &p.z, &c.z) < 1e-7);
            if far || known {
                continue;
            }
            if let Some(t) = tracer.tangent(&c.matrix, &pair[0].tangent) {
                found.push(tracer.describe(&c, t.direction));
            }
        }
        Ok(found)
    }

    /// Where the chain goes from every limit point that a stable part of a branch runs into: stable
    /// equilibria on the computed branches at the same dead load (load limits) or at the same
    /// displacement (displacement limits), nearest first.
    ///
    /// # Errors
    /// None in practice: the problem was accepted when the curve was followed.
    pub fn jumps(&self) -> Result<Vec<Jump>> {
        let reduced = Reduced::new(&self.problem, Some(&self.parameter), &self.settings.solver)?;
        let is_load = reduced.is_load();
        let turns = wraps(self.problem.chain, &reduced);
        let offset = reduced.reactions();
        let mut jumps = Vec::new();
        for (index, special) in self.specials.iter().enumerate() {
            let by_load = match special.kind {
                SpecialKind::LoadLimit => true,
                SpecialKind::DisplacementLimit => false,
                _ => continue,
            };
            let verdict = |p: &CurvePoint| {
                if by_load {
                    p.dead.stable
                } else {
                    p.held.stable
                }
            };
            if !special.stable_side {
                continue;
            }
            let value = if by_load == is_load {
                special.point.parameter
            } else {
                special.point.conjugate
            };
            let mut to: Vec<(f64, CurvePoint)> = self
                .crossings(value, by_load == is_load)?
                .into_iter()
                .filter(|p| verdict(p))
                .map(|p| (wrapped(&p.z, &special.point.z, &turns, offset).norm(), p))
                .filter(|(d, _)| *d > 1e-3)
                .collect();
            to.sort_by(|a, b| a.0.total_cmp(&b.0));
            jumps.push(Jump {
                from: index,
                dead_load: by_load,
                to: to.into_iter().map(|(_, p)| p).collect(),
            });
        }
        Ok(jumps)
    }
}

/// A jump from a limit point.
#[derive(Clone, Debug)]
pub struct Jump {
    /// The limit point: index into [`Curves::specials`].
    pub from: usize,
    /// True under a dead load (at a load limit), false under prescribed motion.
    pub dead_load: bool,
    /// Stable equilibria at the same load (displacement), nearest first; empty if no computed
    /// branch holds one.
    pub to: Vec<CurvePoint>,
}
