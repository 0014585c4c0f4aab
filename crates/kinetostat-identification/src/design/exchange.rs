//! Exchanges of single postures (Fedorov 1972), with a bound that skips most pairs.

use nalgebra::DVector;

use super::linalg::pack;
use super::low_rank::LowRank;
use super::objective::Scratch;
use super::problem::Problem;

/// Relative decrease of the value below which an exchange is rounding.
const DECREASE: f64 = 1e-10;

/// Pairs after which an improvement is taken without looking for a better one.
const PAIRS: usize = 64;

/// Exchange of one posture, or addition of one.
struct Move {
    enters: usize,
    /// Index of the posture that leaves.
    leaves: Option<usize>,
    value: f64,
}

/// Search for the best single change of a set of postures.
pub(super) struct Exchange<'a> {
    problem: &'a Problem,
    scratch: Scratch,
    /// Packed information of the set after a change.
    changed: DVector<f64>,
    /// Packed derivative.
    gradient: DVector<f64>,
}

impl<'a> Exchange<'a> {
    pub(super) fn new(problem: &'a Problem) -> Self {
        let length = problem.fixed.len();
        Self {
            problem,
            scratch: Scratch::new(problem),
            changed: DVector::zeros(length),
            gradient: DVector::zeros(length),
        }
    }

    /// Value of a set with the information `base` added; `None` if the information is singular.
    pub(super) fn value(&mut self, base: &DVector<f64>, chosen: &[usize]) -> Option<f64> {
        let packed = self.problem.information_of(base, chosen);
        self.problem.value(packed.as_slice(), &mut self.scratch)
    }

    /// Adds the posture that lowers the value most until the set is complete. Returns false if `base` is singular.
    pub(super) fn complete(&mut self, base: &DVector<f64>, chosen: &mut Vec<usize>) -> bool {
        while chosen.len() < self.problem.count {
            let packed = self.problem.information_of(base, chosen);
            match self.best(&packed, chosen, false) {
                Some(next) => chosen.push(next.enters),
                None => return false,
            }
        }
        true
    }

    /// Exchanges postures until no single exchange lowers the value. Returns the value; `None` if the information is singular.
    pub(super) fn improve(&mut self, base: &DVector<f64>, chosen: &mut [usize]) -> Option<f64> {
        let mut value = self.value(base, chosen)?;
        loop {
            let packed = self.problem.information_of(base, chosen);
            let Some(next) = self.best(&packed, chosen, true) else {
                return Some(value);
            };
            let Some(place) = chosen.iter().position(|x| Some(*x) == next.leaves) else {
                return Some(value);
            };
            let before = std::mem::replace(&mut chosen[place], next.enters);
            // Computed anew, so that errors of the updates do not add up.
            match self.value(base, chosen) {
                Some(v) if v < value * (1.0 - DECREASE) => value = v,
                _ => {
                    chosen[place] = before;
                    return Some(value);
                }
            }
        }
    }

    /// Best exchange that lowers the value, or best addition.
    fn best(&mut self, packed: &DVector<f64>, chosen: &[usize], exchange: bool) -> Option<Move> {
        let problem = self.problem;
        let state = problem.state(packed)?;
        pack(&state.gradient, 2.0, self.gradient.as_mut_slice());
        let sensitivities = problem.information.tr_mul(&self.gradient);
        let mut members = chosen.to_vec();
        members.sort_unstable();
        let mut entering: Vec<usize> = (0..problem.rows.len())
            .filter(|x| problem.repeats || members.binary_search(x).is_err())
            .collect();
        entering.sort_by(|a, b| {
            sensitivities[*b]
                .total_cmp(&sensitivities[*a])
                .then(a.cmp(b))
        });
        members.dedup();
        members.sort_by(|a, b| {
            sensitivities[*a]
                .total_cmp(&sensitivities[*b])
                .then(a.cmp(b))
        });
        let leaving: Vec<Option<usize>> = if exchange {
            members.iter().copied().map(Some).collect()
        } else {
            vec![None]
        };
        let low = leaving[0].map_or(0.0, |x| sensitivities[x]);
        let mut updates = exchange
            .then(|| LowRank::new(problem, &state, &members))
            .flatten();
        let mut best: Option<Move> = None;
        let mut limit = if exchange { state.value } else { f64::INFINITY };
        let mut pairs = 0;
        for enters in entering {
            if exchange && pairs >= PAIRS && best.is_some() {
                break;
            }
            if state.bound(sensitivities[enters], low) >= limit {
                break;
            }
            let mut prepared = false;
            for (place, leaves) in leaving.iter().copied().enumerate() {
                let out = leaves.map_or(0.0, |x| sensitivities[x]);
                if state.bound(sensitivities[enters], out) >= limit {
                    break;
                }
                if leaves == Some(enters) {
                    continue;
                }
                pairs += 1;
                let value = match &mut updates {
                    Some(u) => {
                        if !prepared && !u.enter(enters) {
                            break;
                        }
                        prepared = true;
                        u.value(place)
                    }
                    None => {
                        self.changed.copy_from(packed);
                        self.changed += problem.information.column(enters);
                        if let Some(x) = leaves {
                            self.changed -= problem.information.column(x);
                        }
                        problem.value_below(self.changed.as_slice(), limit, &mut self.scratch)
                    }
                };
                if let Some(value) = value
                    && value < limit
                {
                    limit = value;
                    best = Some(Move {
                        enters,
                        leaves,
                        value,
                    });
                }
            }
        }
        best.filter(|b| !exchange || b.value < state.value * (1.0 - DECREASE))
    }
}
