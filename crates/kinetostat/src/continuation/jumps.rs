//! Equilibria on the branches of a curve at one load or one displacement, and where the chain jumps
//! from its limit points.

use crate::continuation::chain_system::ChainSystem;
use crate::continuation::corrector::Row;
use crate::continuation::curve::{CurvePoint, Curves, Jump, SpecialKind};
use crate::continuation::describe::{describe, tangent};
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
        let mut system =
            ChainSystem::new(&self.problem, Some(&self.parameter), &self.settings.solver)?
                .by_sweeps();
        system.start(&self.start.0, &self.start.1, self.start.2)?;
        let mut tracer = Tracer {
            system,
            settings: &self.settings,
            specials: Vec::new(),
        };
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
            tracer.system.family = pair[0].family.clone().or_else(|| pair[1].family.clone());
            let Some(c) = tracer.system.correct(&guess, &row, 12) else {
                continue;
            };
            let far = (&c.z - &guess).norm() > (&pair[1].z - &pair[0].z).norm();
            let known = found
                .iter()
                .any(|p| distance(&tracer.system, &p.z, &c.z) < 1e-7);
            if far || known {
                continue;
            }
            if let Some(t) = tangent(&tracer.system, &c.matrix, &pair[0].tangent) {
                found.push(describe(&mut tracer.system, &c, t.direction));
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
        let system = ChainSystem::new(&self.problem, Some(&self.parameter), &self.settings.solver)?;
        let is_load = system.is_load();
        let turns = wraps(&system);
        let offset = system.reactions();
        let mut jumps = Vec::new();
        for (index, special) in self.specials.iter().enumerate() {
            let by_load = match special.kind {
                SpecialKind::LoadLimit => true,
                SpecialKind::DisplacementLimit => false,
                _ => continue,
            };
            let stable = |p: &CurvePoint| {
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
                .filter(|p| stable(p))
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
