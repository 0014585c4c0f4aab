//! The largest multiplier of a cut at one speed over the depth.

use std::cell::RefCell;

use nalgebra::DVector;

use crate::error::Result;
use crate::stability::krylov;
use crate::stability::multiplier::Multiplier;
use crate::stability::operator::Operator;
use crate::stability::period::Period;
use crate::stability::regeneration::Regeneration;

/// The logarithm of the largest multiplier's size over that of the depth, at one speed.
pub(crate) struct Along<'a> {
    regeneration: &'a Regeneration,
    pub(crate) speed_rpm: f64,
    /// Share of the usual points of collocation.
    pub(crate) fineness: f64,
    /// The period, where it does not depend on the depth.
    period: Option<Period>,
    /// Start vector of the search for the largest multiplier, from the previous depth.
    last: RefCell<Option<DVector<f64>>>,
}

impl<'a> Along<'a> {
    pub(crate) fn new(
        regeneration: &'a Regeneration,
        speed_rpm: f64,
        fineness: f64,
    ) -> Result<Self> {
        let period = match regeneration.cut().pieces_depend_on_depth() {
            true => None,
            false => Some(regeneration.period(speed_rpm, 0.0, fineness)?),
        };
        Ok(Self {
            regeneration,
            speed_rpm,
            fineness,
            period,
            last: RefCell::new(None),
        })
    }

    fn with<T>(&self, depth: f64, of: impl FnOnce(&Operator<'_>) -> Result<T>) -> Result<T> {
        match &self.period {
            Some(period) => of(&Operator::new(period, depth)),
            None => {
                let period = self
                    .regeneration
                    .period(self.speed_rpm, depth, self.fineness)?;
                of(&Operator::new(&period, depth))
            }
        }
    }

    pub(crate) fn logarithm(&self, depth: f64, accuracy: f64) -> Result<f64> {
        self.with(depth, |operator| {
            let value = operator.largest(accuracy, &mut self.last.borrow_mut())?.0;
            Ok(value.norm().ln())
        })
    }

    pub(crate) fn multiplier(&self, depth: f64) -> Result<Multiplier> {
        self.with(depth, |operator| {
            let (value, vector) =
                operator.largest(krylov::ACCURATE, &mut self.last.borrow_mut())?;
            let receptance = |w| self.regeneration.at(w);
            Ok(Multiplier::new(
                value,
                &vector,
                operator,
                depth,
                &receptance,
            ))
        })
    }
}
