//! One period of the cut at a speed: stretches of time with what a force on them does.

use std::f64::consts::TAU;

use crate::cut::Cut;
use crate::error::Result;
use crate::number::Complex64;
use crate::response::ToolResponse;
use crate::stability::cutting::Cutting;
use crate::stability::states::State;

/// A stretch of time without a tooth that comes or goes.
#[derive(Clone, Debug)]
pub(crate) struct Stretch {
    /// Time at which it begins, from the beginning of the period, s.
    pub(crate) begins: f64,
    /// Duration, s.
    pub(crate) duration: f64,
    /// Factor of each mode's state over the stretch, without force.
    pub(crate) decay: Vec<Complex64>,
    /// Response in the cut; `None` in air.
    pub(crate) cutting: Option<Cutting>,
}

/// One period.
#[derive(Clone, Debug)]
pub(crate) struct Period {
    /// Length, s.
    pub(crate) delay: f64,
    /// Turn of the spindle at which it begins, rad.
    pub(crate) starts: f64,
    pub(crate) states: Vec<State>,
    pub(crate) stretches: Vec<Stretch>,
}

impl Period {
    /// The period of a cut at a speed and, for helical teeth, a depth, with `fineness` times the usual points.
    pub(crate) fn new(
        (response, states): (&ToolResponse, Vec<State>),
        cut: &Cut,
        speed_rpm: f64,
        depth: f64,
        fineness: f64,
    ) -> Result<Self> {
        let delay = cut.delay(speed_rpm)?;
        let speed = TAU * speed_rpm / 60.0;
        let pieces = cut.pieces(depth);
        let starts = pieces.first().map_or(0.0, |piece| piece.start);
        let stretches = pieces
            .iter()
            .map(|piece| {
                let begins = (piece.start - starts) / speed;
                let duration = piece.length / speed;
                let decay = states
                    .iter()
                    .map(|state| (state.root * duration).exp())
                    .collect();
                let cutting = match piece.active.is_empty() {
                    true => None,
                    false => {
                        let of = (piece, begins, duration);
                        Some(Cutting::new(response, cut, of, &states, fineness)?)
                    }
                };
                Ok(Stretch {
                    begins,
                    duration,
                    decay,
                    cutting,
                })
            })
            .collect::<Result<Vec<_>>>()?;
        Ok(Self {
            delay,
            starts,
            states,
            stretches,
        })
    }

    /// Numbers of all nodes' differences.
    pub(crate) fn differences(&self) -> usize {
        self.stretches
            .iter()
            .filter_map(|stretch| stretch.cutting.as_ref())
            .map(|cutting| cutting.force.nrows())
            .sum()
    }
}
